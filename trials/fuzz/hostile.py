"""Packings made by hand that no pouring leaves, and what is asked of them: pour on, cut, bend, pull, let fall."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

import asphalt_nscd as an

Random = np.random.Generator
Arrays = dict[str, Any]
BOX = (0.04, 0.03, 0.12)  # m
SHAPES: list[dict[str, float]] = [
    {"b_mm": 16, "B_mm": 20, "e_mm": 20, "h_mm": 36, "mass_kg": 0.05, "mobile_mass_kg": 0.1},
    {"d_mm": 24, "h_mm": 30, "mass_kg": 0.03, "mobile_mass_kg": 0.0},
    {"L_mm": 38, "H_mm": 14, "B_mm": 20, "mass_kg": 0.03, "mobile_mass_kg": 0.0},
]
LAW = an.Law.burgers(Em_Pa=24.3e9, eta_m_Pa_s=3.71e9, Ek_Pa=48.4e9, eta_k_Pa_s=0.773e9, temperature_C=15.0)


def spheres(rng: Random) -> Arrays:
    """Spheres on a lattice, some of which touch."""
    pitch, radius = 8e-3, rng.uniform(2.5e-3, 4e-3)
    places = pitch * (np.indices((5, 3, rng.integers(3, 12))).reshape(3, -1).T + 0.5)
    places += rng.uniform(0.0, 0.3) * (0.5 * pitch - radius) * rng.normal(size=places.shape).clip(-1.0, 1.0)
    return {"position": places, "radius": radius * rng.uniform(0.6, 1.0, len(places))}


def coincident(made: Arrays, rng: Random) -> None:
    """Some or all spheres in one place."""
    share = rng.choice([0.02, 0.3, 1.0])
    chosen = rng.random(len(made["radius"])) < share
    chosen[:2] = True
    made["position"][chosen] = made["position"][0]


def overlapping(made: Arrays, rng: Random) -> None:
    """All spheres larger, to deep overlaps."""
    made["radius"] *= 10.0 ** rng.uniform(0.0, 1.5)


def pressed(made: Arrays, rng: Random) -> None:
    """All centres drawn to the middle along some axes."""
    squeezed = rng.random(3) < 0.6
    made["position"][:, squeezed] *= rng.choice([0.0, 1e-9, 0.1, 0.6])


def impossible(made: Arrays, rng: Random) -> None:
    """A number that is no place or no size."""
    value = rng.choice([np.nan, np.inf, -np.inf, 0.0, -4e-3, 1e-300, 1e300, 1e-12])
    name = str(rng.choice(["position", "radius"]))
    made[name][rng.integers(len(made[name]))] = value


def misshapen(made: Arrays, rng: Random) -> None:
    """Arrays that do not fit, or hold no numbers."""
    made |= [
        {"position": made["position"][:, :2]},
        {"position": made["position"].ravel()},
        {"position": made["position"][:-1]},
        {"radius": made["radius"][:, None]},
        {"radius": made["radius"][0]},
        {"position": np.empty((0, 3)), "radius": np.empty(0)},
        {"position": made["position"].astype(str)},
        {"position": made["position"] + 1j},
        {"radius": made["radius"].astype(object)},
        {"position": np.ma.masked_less(made["position"], 0.01)},
    ][rng.integers(10)]


def scaled(made: Arrays, rng: Random) -> None:
    """In another unit, or of sizes beyond all."""
    factor = 10.0 ** rng.choice([-30.0, -9.0, -3.0, 1.0, 3.0, 9.0, 200.0])
    made["position"], made["radius"] = made["position"] * factor, made["radius"] * factor


def few(made: Arrays, rng: Random) -> None:
    """One to four spheres, somewhere."""
    chosen = rng.choice(len(made["radius"]), rng.integers(1, 5), replace=False)
    made["position"], made["radius"] = made["position"][chosen], made["radius"][chosen]


def uneven(made: Arrays, rng: Random) -> None:
    """Radii that differ by decades."""
    made["radius"] *= 10.0 ** rng.uniform(-3.0, 0.0, made["radius"].shape)


def harmless(made: Arrays, rng: Random) -> None:
    """Nothing changed."""


# what does not fit comes last, since nothing more can be done to it
KINDS = harmless, coincident, overlapping, pressed, few, uneven, impossible, scaled, misshapen


def hostile(rng: Random) -> Callable[[], Any]:
    """A call on a hostile packing."""
    made = spheres(rng)
    for kind in sorted(rng.choice(len(KINDS), rng.integers(1, 3), replace=False)):
        KINDS[kind](made, rng)
    box = tuple(rng.choice([BOX, BOX, (0.2, 0.2, 0.6), (1.0, 1.0, 1.0)]).tolist())
    shape = SHAPES[rng.integers(3)]
    area, yield_Pa = str(rng.choice(["paper", "facets"])), 10.0 ** rng.uniform(2.0, 7.0)
    bonds = an.Bonds(yield_Pa=yield_Pa)
    load = an.Load(amplitude_m=10.0 ** rng.uniform(-7.0, -3.0), cycles=1.0)
    pulled = an.Ramp(duration_s=10.0 ** rng.uniform(-3.0, 1.0), steps=20)
    vibration = an.Vibration(duration=float(rng.choice([0.0, 0.05])), frequency=10.0 ** rng.uniform(0.0, 3.0))
    surfaces = an.Surfaces(friction=rng.choice([0.0, 0.3, 10.0]), restitution=rng.choice([0.0, 0.5]))
    what = rng.integers(4)

    def call() -> Any:
        packing = an.Packing({**made, "box": np.array(box)}, {}, "hostile")
        if what == 0:
            return an.pour(packing, box, vibration=vibration, surfaces=surfaces)
        specimen = an.specimen(packing, shape, area=area)
        if what == 1:
            return an.bend(specimen, LAW, 10.0, 15.0, load=load, bonds=bonds, numerics=an.Numerics(1e-3, 5))
        if what == 2:
            return an.ramp(specimen, LAW, 15.0, pulled=pulled, bonds=bonds)
        held = an.Hold(1.0, 20, force_N=10.0 ** rng.uniform(-2.0, 4.0))
        return an.hold(specimen, LAW, 15.0, held=held, bonds=bonds)

    return call
