"""E* of a mix: a differential scheme through all sizes of its grains, whose contacts bear too.

**Volumes.** Grains are put into the binder from the finest up, each in what all finer ones have made of it (McLaughlin,
Int. J. Eng. Sci. 15 (1977) 237; spheres). Filler crowds itself: rigid, a share phi of it in a liquid stiffens that by
(1 - phi / m)^(-2.5 m), m the share of grains in its dry packing (Krieger & Dougherty, Trans. Soc. Rheol. 3 (1959) 137;
1 - m are the voids of Rigden). Air goes in with the grains that are coarser than filler, since it lies among them.
Where the binder is stiff this alone gives the modulus.

**Contacts.** Compacted grains all but touch. Each grain that goes in adds contacts with grains of its size, lubricated
by what fits in their gap (`contact.py`): the mix of all grains finer than the gap. A share of them has air in place of
binder. They set in between FILLER, which has none, and TOUCHING, so that no sieve parts the two. With `contacts` of
mean stiffness k on each sphere of radius r, a volume fraction f of them has

    K = f n k / (6 pi r),   G = f n k / (10 pi r)

if all move as the mean strain says (Digby, J. Appl. Mech. 48 (1981) 803, without shear in a contact). What goes in
later stiffens this as it stiffens all else. A mix near the modulus of its grains has no contacts: they count with
(1 - G / G_grain)^2, as layers in series with grains do.

**Skeleton.** When the binder has relaxed, grains press on each other dry. Their contacts (Hertz, Mindlin) carry the
mean pressure of the test; K and G by Walton (J. Mech. Phys. Solids 35 (1987) 213), all grains together, with
the same share of contacts that move as the mean strain says.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.forecasting.contact import Complex, Vector, contact_stiffness, gaps
from asphalt_nscd.forecasting.recipe import Recipe
from asphalt_nscd.forecasting.solid import Solid

FILLER, FINEST = (
    63e-6,
    1e-6,
)  # m: the largest grain of filler, and the finest; between them evenly over log of size
SIZES = np.concatenate([np.geomspace(FINEST, FILLER, 8), FILLER * 10.0 ** (np.arange(1, 46) / 14.0)])
"""Sizes (s,) [m] between which grains are put in; the same for all recipes, so that none jumps."""
TOUCHING = 90e-6  # m: coarser grains have all their contacts
SUBSTEP = 0.03  # of -ln(1 - fraction), of the differential equation
LEAST_FREE = 0.02  # of mastic: binder outside the voids of its filler
FRICTIONAL = 4.0  # contacts of a dry sphere: as many as rigid grains with friction need to stand


@dataclass(frozen=True)
class Settings:
    """What the forecast takes for granted (docs/forecast.md says why, and from where).

    `contacts` of each grain that move as the mean strain says, and the `gap` [m] in them, are set on measured mixes;
    `pressure` [Pa] in the skeleton; `binder_bulk`: K [Pa].
    """

    contacts: float = 1.4
    gap: float = 10e-9
    pressure: float = 10e3
    binder_bulk: float = 2.5e9


USUAL = Settings()


def modulus_of_mix(recipe: Recipe, binder: np.ndarray, settings: Settings = USUAL) -> Complex:
    """E* of the mix (n,) [Pa] for E* of the binder (n,) [Pa]."""
    bulk, shear = _filled(recipe, binder, settings)
    skeleton = _skeleton(recipe, settings)
    bulk = bulk + skeleton[0] * (1.0 - bulk / recipe.aggregate.bulk) ** 2
    shear = shear + skeleton[1] * (1.0 - shear / recipe.aggregate.shear) ** 2
    return 9.0 * bulk * shear / (3.0 * bulk + shear)


def _filled(recipe: Recipe, binder: np.ndarray, settings: Settings) -> tuple[Complex, Complex]:
    """K and G (n,) [Pa] of the mix without its dry skeleton."""
    young = np.asarray(binder, complex)
    bulk = np.full(young.shape, settings.binder_bulk, complex)
    shear = 3.0 * bulk * young / (9.0 * bulk - young)
    stone, grains, air = recipe.aggregate, *volumes(recipe)
    liquid = binder_volume(recipe)
    finer = [(bulk, shear)]
    for k in range(1, SIZES.size):
        more = grains[k] - grains[k - 1]
        if SIZES[k] <= FILLER:
            packed = 1.0 - recipe.rigden_voids
            free = 1.0 - grains[k - 1 : k + 1] / packed / (liquid + grains[k - 1 : k + 1])
            room = np.log(np.maximum(free, LEAST_FREE))
            bulk, shear = _put_in(bulk, shear, stone, 0.0, packed * float(room[0] - room[1]))
        elif more > 0.0:
            put = more + air[k] - air[k - 1]
            total = liquid + grains[k] + air[k]
            added = _contacts(k, finer, stone, settings) * more / total * liquid / (liquid + recipe.voids)
            bulk, shear = _put_in(bulk, shear, stone, 1.0 - more / put, float(-np.log1p(-put / total)))
            bulk = bulk + added / 6.0 * (1.0 - bulk / stone.bulk) ** 2
            shear = shear + added / 10.0 * (1.0 - shear / stone.shear) ** 2
        finer.append((bulk, shear))
    return bulk, shear


def volumes(recipe: Recipe) -> tuple[Vector, Vector]:
    """Grains and air (s,), of the volume of the mix, that are in when all grains finer than each of SIZES are."""
    passing = recipe.grading.passing_at(SIZES)
    filler = float(recipe.grading.passing_at(FILLER))
    fine = SIZES <= FILLER
    passing[fine] = filler * np.log(SIZES[fine] / FINEST) / np.log(FILLER / FINEST)
    coarser = np.maximum(passing - filler, 0.0) / max(1.0 - filler, 1e-9)
    return (1.0 - recipe.voids) * recipe.aggregate_fraction * passing, recipe.voids * coarser


def binder_volume(recipe: Recipe) -> float:
    """Share of the binder in the volume of the mix."""
    return (1.0 - recipe.voids) * (1.0 - recipe.aggregate_fraction)


def require_free_binder(recipe: Recipe) -> None:
    """Refuse a mix whose filler has more voids than the binder fills."""
    filler = float(volumes(recipe)[0][SIZES <= FILLER][-1])
    mastic = filler + binder_volume(recipe)
    if filler / (1.0 - recipe.rigden_voids) > (1.0 - LEAST_FREE) * mastic:
        raise InputError(
            f"{recipe.file}: grading: the filler is {100 * filler / mastic:.0f} % of filler and binder, so its voids "
            f"({100 * recipe.rigden_voids:.0f} %, Rigden) hold all binder; correct grading or binder_percent_by_mass."
        )


def _put_in(
    bulk: Complex, shear: Complex, stone: Solid, air: float, amount: float
) -> tuple[Complex, Complex]:
    """K and G with grains, a share `air` of them voids, put in by -ln(1 - fraction) = `amount`, to second order."""
    steps = max(1, int(np.ceil(amount / SUBSTEP)))

    def rate(soft: Complex, shear: Complex) -> tuple[Complex, Complex]:
        # In compliance, since a void in a nearly incompressible matrix is a stiff equation.
        flow = 4.0 / 3.0 * shear
        around = shear * (9.0 + 8.0 * shear * soft) / (6.0 + 12.0 * shear * soft)
        grain = (1.0 - stone.bulk * soft) * (1.0 + flow * soft) / (stone.bulk + flow)
        void = 1.0 / flow + soft
        stiffer = (stone.shear - shear) * (shear + around) / (stone.shear + around)
        weaker = -shear * (shear + around) / around
        return (1.0 - air) * grain + air * void, (1.0 - air) * stiffer + air * weaker

    soft, step = 1.0 / bulk, amount / steps
    for _ in range(steps):
        first = rate(soft, shear)
        second = rate(soft + 0.5 * step * first[0], shear + 0.5 * step * first[1])
        soft, shear = soft + step * second[0], shear + step * second[1]
    return 1.0 / soft, shear


def _contacts(
    k: int, finer: list[tuple[Complex, Complex]], stone: Solid, settings: Settings
) -> Complex | float:
    """n k / (pi r) (m,) [Pa] of the grains from SIZES k - 1 to k.

    `finer` has K and G (m,) [Pa] of the binder with all grains up to each smaller size.
    """
    if not settings.contacts:
        return 0.0
    size = float(np.sqrt(SIZES[k - 1] * SIZES[k]))
    touching = min(1.0, np.log(size / FILLER) / np.log(TOUCHING / FILLER))
    curvature = 0.25 * size  # of two spheres of radius r it is r / 2
    gap = settings.gap / curvature
    edge, middle = (curvature * at for at in gaps(gap))
    bulk, shear = np.array(finer).transpose(1, 0, 2)
    confined = bulk + 4.0 / 3.0 * shear
    there = [
        _interpolated(np.log(at), np.log(of)) / stone.plane for at, of in ((edge, shear), (middle, confined))
    ]
    stiffness = contact_stiffness(there[0], there[1], gap) * stone.plane
    return settings.contacts * touching * stiffness / (2.0 * np.pi)


def _interpolated(size: Vector, log: Complex) -> Complex:
    """Moduli (m, n) [Pa] with grains up to ln of size (n,), by logarithms (s, m) at SIZES and straight between them."""
    known = np.log(SIZES[: len(log)])
    place = np.interp(size, known, np.arange(len(log)))
    low = np.minimum(place.astype(int), len(log) - 2)
    part = (place - low)[:, None]
    return np.exp((1.0 - part) * log[low] + part * log[low + 1]).T


def _skeleton(recipe: Recipe, settings: Settings) -> tuple[float, float]:
    """K and G [Pa] of dry grains that stick under a pressure: force by Love and Weber, contacts by Hertz, Mindlin."""
    stone, grains = recipe.aggregate, volumes(recipe)[0]
    solid = float(grains[-1] - grains[SIZES <= FILLER][-1])
    if not solid:
        return 0.0, 0.0
    # of spheres of radius 1: p = f n F / (4 pi), spot a^3 = 3 F (1/2) / (4 E'), k = 2 E' a
    force = 4.0 * np.pi * settings.pressure / (solid * FRICTIONAL)
    stiffness = 2.0 * stone.plane * float(np.cbrt(0.375 * force / stone.plane))
    sliding = 2.0 * (1.0 - stone.poisson) / (2.0 - stone.poisson)
    share = solid * settings.contacts * stiffness / np.pi
    return share / 6.0, share * (1.0 + 1.5 * sliding) / 10.0
