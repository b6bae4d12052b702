"""What grains that touch, open and slip do to a haversine test, in a small cylinder of poured stones.

Films between neighbours follow one power law; stiff enough, they and the stones have the |E*| of a mix, and some phase,
while all contacts stick. Nothing is fitted: pressure, friction and amplitudes are stated. The answer is ln of what is
read over what would be read if no contact slipped.
"""

from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from typing import Any

import numpy as np
import pandas as pd

import asphalt_nscd as an
from asphalt_nscd.bending.bending_test import bond_law
from asphalt_nscd.bending.condensing import condensed
from asphalt_nscd.bending.cycles import run_cycles, skeleton_of, stuck_stiffness
from asphalt_nscd.bending.model import Model, model_of
from asphalt_nscd.bending.settings import Bonds
from asphalt_nscd.cli import run_script
from asphalt_nscd.files.store import Record, write_table
from asphalt_nscd.measurements.tension import AMPT
from asphalt_nscd.nscd.bonds.system import BondedSystem
from asphalt_nscd.rheology.as_run import Programme, modulus_as_read
from asphalt_nscd.rheology.chain import KelvinChain
from asphalt_nscd.rheology.conversion import kelvin_chain
from studies.measured.cylinder import BOX, SPHERES
from studies.measured.stated import AMPLITUDES, SEVERAL

SHARE = 0.38  # of the volume of a cylinder of full size: some 500 stones
MODULI = 300e6, 500e6, 900e6, 1.8e9, 4e9, 9e9, 20e9  # Pa, of mixes of both populations but the softest
EXPONENTS = 0.1, 0.3, 0.6  # of the films, over frequency
USUAL = 10e3, 0.5  # pressure on the stones [Pa] and their friction
DOUBTS = (1e3, 0.5), (100e3, 0.5), (10e3, 0.3)
HAVERSINE = Programme(haversine=True, cycles=6, read=3, drift=True, samples=24)
PULLED = replace(HAVERSINE, haversine=False)
FREQUENCY = 1.0  # Hz; another changes nothing but the scale of time
OMEGA = 2.0 * np.pi * FREQUENCY
FILM = 1e9  # Pa, |E*| of films before they are made stiffer
Test = tuple[float, float, float, Programme, tuple[float, float]]


def stones() -> Model:
    """The cylinder, bonded by facets: its films alone show their own law."""
    side = SHARE ** (1.0 / 3.0)
    spheres = {size: round(SHARE * count) for size, count in SPHERES.items()}
    box = BOX[0] * side, BOX[1] * side, BOX[2] * side
    packing = an.pour(spheres, box, vibration=an.Vibration(duration=0.0), seed=1)
    shape = replace(AMPT, d=AMPT.d * side, h=AMPT.h * side, mass=AMPT.mass * SHARE)
    specimen = an.specimen(packing, shape.keys(), area="facets")
    return model_of(Record(*condensed(specimen.bonded, "stones", Bonds(), stand_by=0), ""))


def row(model: Model, test: Test) -> dict[str, float]:
    """One test of a mix of this |E*| [Pa] with its contacts stuck, exponent, amplitude of strain."""
    modulus, exponent, amplitude, programme, pressed = test
    law, skeleton = bond_law(_power_law(FILM, exponent, 0.0, programme)), skeleton_of(model, *pressed)
    size = model.geometry.form_factor()

    def films(stiffer: float) -> BondedSystem:
        return replace(model.system, weight=stiffer * model.system.weight)

    def shown(stiffer: float) -> float:
        return size * abs(stuck_stiffness(films(stiffer), law, skeleton, OMEGA))

    system = films(_stiffening(shown, modulus))
    stuck = stuck_stiffness(system, law, skeleton, OMEGA)
    force = abs(stuck) * amplitude * model.geometry.h
    ran = run_cycles(system, law, skeleton, FREQUENCY, force, programme)
    change = np.log(ran.stiffness / stuck) - log_read_alone(stuck, exponent, programme)
    return {
        "E_MPa": size * abs(stuck) / 1e6,
        "exponent": exponent,
        "amplitude_1e6": 1e6 * amplitude,
        "haversine": int(programme.haversine),
        "pressure_kPa": pressed[0] / 1e3,
        "friction": pressed[1],
        "phase_deg": float(np.degrees(np.angle(stuck))),
        "lnE": float(change.real),
        "change_deg": float(np.degrees(change.imag)),
        "energy_error": float(1.0 - ran.taken / ran.work),
    }


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
    films = stiffness.imag / np.sin(0.5 * np.pi * exponent)
    springs = stiffness.real - films * np.cos(0.5 * np.pi * exponent)
    chain = _power_law(films, exponent, springs, programme)
    return complex(np.log(modulus_as_read(chain, [FREQUENCY], programme)[0] / stiffness))


def _power_law(films: float, exponent: float, springs: float, programme: Programme) -> KelvinChain:
    """A Kelvin chain near films (i f)^exponent + springs."""
    return kelvin_chain(
        lambda w: np.asarray(films * (1j * w / OMEGA) ** exponent + springs, complex),
        OMEGA / (3.0 * programme.cycles),
        3.0 * OMEGA,
    )[0]


def tests() -> Iterator[Test]:
    """What is simulated: the grid of both populations, several amplitudes, and doubts about pressure and friction."""
    for amplitude in AMPLITUDES.values():
        for modulus in MODULI:
            for exponent in EXPONENTS:
                yield modulus, exponent, amplitude, HAVERSINE, USUAL
    for programme in (HAVERSINE, PULLED):
        for amplitude in SEVERAL:
            yield 6e9, 0.3, amplitude, programme, USUAL
    for pressed in DOUBTS:
        for modulus in (900e6, 4e9):
            yield modulus, 0.3, AMPLITUDES["ncat"], HAVERSINE, pressed


def run(job: Any) -> None:
    """contacts.csv."""
    model, asked = stones(), list(tests())
    with ProcessPoolExecutor(job.threads) as pool:
        rows = list(pool.map(row, [model] * len(asked), asked))
    write_table(job.output[0], pd.DataFrame(rows))


if __name__ == "__main__":
    run_script(globals()["snakemake"], run)
