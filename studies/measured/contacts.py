"""What grains that touch, open and slip do to a haversine test, in a small cylinder of poured stones.

Films between neighbours follow one power law; stiff enough, they and the stones have the |E*| of a mix, and some phase,
while all contacts stick. Nothing is fitted: pressure, friction and amplitudes are stated, and films are of two kinds,
as stiff in shear as normal to them or weak in it. The answer is ln of what is read over what would be read if no
contact slipped. In one mix stand beside it the same contacts, each moved as the mean strain of the test says: a cell
without a network.
"""

from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from itertools import product
from typing import Any, NamedTuple

import numpy as np
import pandas as pd
from scipy.sparse.linalg import spsolve

import asphalt_nscd as an
from asphalt_nscd.bending.bending_test import bond_law
from asphalt_nscd.bending.condensing import condensed
from asphalt_nscd.bending.cycles import CyclicTest, run_cycles, skeleton_of, stuck_stiffness
from asphalt_nscd.bending.model import Model, model_of
from asphalt_nscd.bending.settings import Bonds
from asphalt_nscd.cli import run_script
from asphalt_nscd.files.store import Record, write_table
from asphalt_nscd.measurements.tension import AMPT
from asphalt_nscd.nscd.bonds.system import BondedSystem
from asphalt_nscd.nscd.stepping.skeleton import Grip, Skeleton
from asphalt_nscd.rheology.as_run import Programme, modulus_as_read
from asphalt_nscd.rheology.chain import KelvinChain
from asphalt_nscd.rheology.conversion import kelvin_chain
from studies.measured.cylinder import BOX, SPHERES
from studies.measured.stated import AMPLITUDES, SEVERAL, SEVERAL_WEAK, WEAK

SHARE = 0.38  # of the volume of a cylinder of full size: some 500 stones
MODULI = 300e6, 500e6, 900e6, 1.8e9, 4e9, 9e9, 20e9  # Pa, of mixes of both populations but the softest
WITH_WEAK_FILMS = 300e6, 900e6, 4e9, 20e9
EXPONENTS = 0.1, 0.3, 0.6  # of the films, over frequency
HAVERSINE = Programme(haversine=True, cycles=6, read=3, drift=True, samples=24)
DOUBTS = (1e3, 0.5), (100e3, 0.5), (10e3, 0.3)  # pressure [Pa] and friction
PULLED = replace(HAVERSINE, haversine=False)
SHEARS = 1.0, 0.1, WEAK
FREQUENCY = 1.0  # Hz; another changes nothing but the scale of time
OMEGA = 2.0 * np.pi * FREQUENCY
FILM = 1e9  # Pa, |E*| of films before they are made stiffer


class Test(NamedTuple):
    """A mix of this |E*| [Pa] with its contacts stuck, the exponent of its films, and how it is tested.

    `shear`: stiffness of films in shear over that normal to them.
    """

    modulus: float
    exponent: float
    amplitude: float  # of strain
    programme: Programme = HAVERSINE
    shear: float = 1.0
    pressure: float = 10e3  # Pa, on the stones
    friction: float = 0.5
    cell: bool = False  # whether it is moved without a network too


def stones() -> dict[float, Model]:
    """The cylinder, bonded by facets, by the ratio of stiffness in shear."""
    side = SHARE ** (1.0 / 3.0)
    spheres = {size: round(SHARE * count) for size, count in SPHERES.items()}
    box = BOX[0] * side, BOX[1] * side, BOX[2] * side
    packing = an.pour(spheres, box, vibration=an.Vibration(duration=0.0), seed=1)
    shape = replace(AMPT, d=AMPT.d * side, h=AMPT.h * side, mass=AMPT.mass * SHARE)
    bonded = an.specimen(packing, shape.keys(), area="facets").bonded
    return {
        shear: model_of(Record(*condensed(bonded, "stones", Bonds(kt_over_kn=shear), stand_by=0), ""))
        for shear in sorted({test.shear for test in tests()})
    }


def row(model: Model, test: Test) -> dict[str, float]:
    """What a test reads; of a cell too, what contacts change by, over their share of the mix."""
    law = bond_law(_power_law(FILM, test.exponent, 0.0, test.programme))
    skeleton = skeleton_of(model, test.pressure, test.friction)
    size = model.geometry.form_factor()

    def films(stiffer: float) -> BondedSystem:
        return replace(model.system, weight=stiffer * model.system.weight)

    def shown(stiffer: float) -> float:
        return size * abs(stuck_stiffness(films(stiffer), law, skeleton, OMEGA))

    system = films(_stiffening(shown, test.modulus))
    stuck = stuck_stiffness(system, law, skeleton, OMEGA)
    force = abs(stuck) * test.amplitude * model.geometry.h
    ran = run_cycles(system, law, skeleton, FREQUENCY, force, test.programme)
    change = np.log(ran.stiffness / stuck) - log_read_alone(stuck, test.exponent, test.programme)
    told = {
        "E_MPa": size * abs(stuck) / 1e6,
        "exponent": test.exponent,
        "amplitude_1e6": 1e6 * test.amplitude,
        "haversine": int(test.programme.haversine),
        "shear": test.shear,
        "pressure_kPa": test.pressure / 1e3,
        "friction": test.friction,
        "phase_deg": float(np.degrees(np.angle(stuck))),
        "lnE": float(change.real),
        "change_deg": float(np.degrees(change.imag)),
        "energy_error": float(1.0 - ran.taken / ran.work),
    }
    if not test.cell:
        return told
    own = stuck * (np.exp(change) - 1.0) / _parts(stuck, test.exponent)[1]
    poisson = poisson_ratio(model, system, law, skeleton)
    affine = followed(model, skeleton, poisson, ran, test.programme)
    return told | {
        "poisson": poisson,
        "gain_percent": 100.0 * own.real,
        "loss_percent": 100.0 * own.imag,
        "cell_gain_percent": 100.0 * affine.real,
        "cell_loss_percent": 100.0 * affine.imag,
    }


def poisson_ratio(model: Model, system: BondedSystem, law: Any, skeleton: Skeleton) -> float:
    """Sideways over axial strain of the middle half of the stones, pressed slowly with their contacts stuck."""
    weight = system.weight * abs(law.discrete_modulus(OMEGA, 0.0))
    weight[skeleton.rows] += skeleton.stiffness(skeleton.overlap)
    matrix = system.stiffness(weight).tocsc()
    moved = np.zeros(matrix.shape[0])
    moved[system.driven] = 1.0
    moved[system.free] = -spsolve(matrix[system.free][:, system.free], (matrix @ moved)[system.free])
    place = model.shape["position_m"][: model.spheres]
    middle = np.abs(place[:, 2] - 0.5 * model.geometry.h) < 0.25 * model.geometry.h
    motion = moved[: 6 * model.spheres].reshape(-1, 6)[:, :3]
    known = np.column_stack([np.ones(middle.sum()), place[middle]])
    strain = np.diag(np.linalg.lstsq(known, motion[middle], rcond=None)[0][1:])
    return float(-strain[:2].mean() / strain[2])


def followed(
    model: Model, skeleton: Skeleton, poisson: float, ran: CyclicTest, programme: Programme
) -> complex:
    """Change of the stiffness of contacts over what it is stuck, grains moved as the strain of a test says."""
    first, second = (model.shape[end][skeleton.bonds] for end in ("first", "second"))
    apart = model.shape["position_m"][second] - model.shape["position_m"][first]
    strain = np.array([poisson, poisson, -1.0])
    length = np.linalg.norm(apart, axis=1)
    along = (apart**2 @ strain) / length
    across = np.sqrt(np.maximum(((apart * strain) ** 2).sum(axis=1) - along**2, 0.0))
    opening = np.column_stack([along, across, 0.0 * along]).ravel()
    grip, force = Grip.rest(skeleton), np.zeros_like(ran.displacement)
    pressed = ran.displacement / model.geometry.h
    for step, size in enumerate(pressed):
        reaction, grip = grip.moved(skeleton, size * opening)
        force[step] = -reaction @ opening
    stuck = skeleton.stiffness(skeleton.overlap) @ opening**2
    return programme.phasor(force, ran.angle) / programme.phasor(pressed, ran.angle) / stuck - 1.0


def _stiffening(shown: Any, modulus: float) -> float:
    """Of films, so that the mix shows this |E*| [Pa]: secants of logarithms, within a percent where it can be."""
    # the skeleton alone may be stiffer than the softest mix
    tried = [modulus / FILM / 3.0, modulus / FILM]
    seen: list[float] = []
    for _ in range(8):
        seen.append(shown(tried[len(seen)]))
        if abs(seen[-1] / modulus - 1.0) < 0.01:
            break
        if len(seen) > 1:
            slope = np.log(seen[-1] / seen[-2]) / np.log(tried[-1] / tried[-2])
            tried.append(float(tried[-1] * (modulus / seen[-1]) ** (1.0 / max(slope, 0.2))))
    return tried[len(seen) - 1]


def log_read_alone(stiffness: complex, exponent: float, programme: Programme) -> complex:
    """ln of what is read over a stiffness whose contacts stick, films of a power law beside springs.

    A haversine from rest leaves an error of the drift's bend that is not the contacts'.
    """
    films, springs = _parts(stiffness, exponent)
    chain = _power_law(films, exponent, springs, programme)
    return complex(np.log(modulus_as_read(chain, [FREQUENCY], programme)[0] / stiffness))


def _parts(stiffness: complex, exponent: float) -> tuple[float, float]:
    """Norm of the films' share of a stiffness, and the springs beside it."""
    films = stiffness.imag / np.sin(0.5 * np.pi * exponent)
    return films, stiffness.real - films * np.cos(0.5 * np.pi * exponent)


def _power_law(films: float, exponent: float, springs: float, programme: Programme) -> KelvinChain:
    """A Kelvin chain near films (i f)^exponent + springs."""
    return kelvin_chain(
        lambda w: np.asarray(films * (1j * w / OMEGA) ** exponent + springs, complex),
        OMEGA / (3.0 * programme.cycles),
        3.0 * OMEGA,
    )[0]


def tests() -> Iterator[Test]:
    """What is simulated: the grid of both populations, several amplitudes, and what may decide the answer."""
    for amplitude, modulus, exponent in product(AMPLITUDES.values(), MODULI, EXPONENTS):
        yield Test(modulus, exponent, amplitude)
    for programme, amplitude in product((HAVERSINE, PULLED), SEVERAL):
        yield Test(6e9, 0.3, amplitude, programme)
    for amplitude in SEVERAL_WEAK:
        yield Test(6e9, 0.3, amplitude, PULLED, WEAK)
    for (pressure, friction), modulus in product(DOUBTS, (900e6, 4e9)):
        yield Test(modulus, 0.3, AMPLITUDES["ncat"], pressure=pressure, friction=friction)
    for amplitude, modulus, exponent in product(AMPLITUDES.values(), WITH_WEAK_FILMS, EXPONENTS):
        yield Test(modulus, exponent, amplitude, shear=WEAK)
    usual = Test(900e6, 0.3, AMPLITUDES["ncat"], shear=WEAK)
    yield usual._replace(pressure=100e3)
    yield usual._replace(friction=0.3)
    for shear, programme in product(SHEARS, (HAVERSINE, PULLED)):
        yield usual._replace(shear=shear, programme=programme, cell=True)


def run(job: Any) -> None:
    """contacts.csv, and sign.csv of the tests that stand beside a cell."""
    models, asked = stones(), list(tests())
    with ProcessPoolExecutor(job.threads) as pool:
        table = pd.DataFrame(pool.map(row, [models[test.shear] for test in asked], asked))
    beside = np.array([test.cell for test in asked])
    write_table(job.output.table, table[~beside].dropna(axis=1))
    write_table(job.output.sign, table[beside])


if __name__ == "__main__":
    run_script(globals()["snakemake"], run)
