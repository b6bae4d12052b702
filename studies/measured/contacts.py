"""What grains that touch, open and slip do to a haversine test, in the stones of the forecast's recipe.

A network of stones and films with one power law stands for a mix of |E*| and of the phase that it has while all
contacts stick. Nothing is fitted: the pressure on the stones is that of the forecast (`forecasting.forecast.Settings`),
their friction 0.5, and the amplitudes are half of what the standards of the two populations ask for. The answer is
ln of what is read over what would be read if no contact slipped.
"""

from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from asphalt_nscd.bending.bending_test import bond_law
from asphalt_nscd.bending.cycles import run_cycles, stuck_stiffness
from asphalt_nscd.cli import run_script
from asphalt_nscd.files.store import write_table
from asphalt_nscd.forecasting.forecast import Settings, kept_in, physics_of
from asphalt_nscd.forecasting.levels import levels_of
from asphalt_nscd.forecasting.network import bond_stiffness, contents_of, films_of
from asphalt_nscd.forecasting.recipe import read_recipe
from asphalt_nscd.nscd.bonds.system import BondedSystem
from asphalt_nscd.nscd.stepping.skeleton import Skeleton
from asphalt_nscd.rheology.as_run import Programme, modulus_as_read
from asphalt_nscd.rheology.conversion import kelvin_chain
from asphalt_nscd.specimen.prism import pulled_system

MODULI = (
    300e6,
    500e6,
    900e6,
    1.8e9,
    4e9,
    9e9,
    20e9,
)  # Pa, of the mix: those of both populations, but the softest
EXPONENTS = 0.1, 0.3, 0.6  # of the films, over frequency
AMPLITUDES = {"ncat": 35e-6, "mixes50": 50e-6}
"""Half of 70e-6 (50 to 75e-6 from peak to peak, AASHTO TP 132) and of 100e-6 (50 to 150e-6, AASHTO TP 62)."""
HAVERSINE = Programme(haversine=True, cycles=6, read=3, drift=True, samples=24)
PULLED = replace(HAVERSINE, haversine=False)
FREQUENCY = 1.0  # Hz; another changes nothing but the scale of time
SEVERAL = 75e-6, 200e-6  # amplitudes of the fatigue tests that are compared
DOUBTS = {"pressure 1 kPa": (1e3, 0.5), "pressure 100 kPa": (100e3, 0.5), "friction 0.3": (10e3, 0.3)}
FILM = 1e9  # Pa, to which the weights of films refer


class Stones:
    """The stones of a recipe between two plates."""

    def __init__(self, recipe: str | Path, packings: str | Path) -> None:
        self.recipe, settings = read_recipe(recipe), Settings()
        self.pressure = settings.skeleton_pressure
        self.level = levels_of(self.recipe)[-1]
        self.contents = contents_of(kept_in(packings)(self.level, 1))
        self.physics = replace(
            physics_of(self.recipe, settings, self.level, last=True), skeleton_pressure=0.0
        )
        self.bulk = settings.binder_bulk
        self.touching = np.flatnonzero(films_of(self.contents, self.level, self.physics)[1])

    def system(self, matrix: float) -> BondedSystem:
        """Films of a matrix of this modulus [Pa]; weights over FILM."""
        grain = self.recipe.aggregate
        ratio = np.array([matrix / grain.modulus])
        stiffness = bond_stiffness(self.contents, self.level, grain, self.bulk, self.physics, ratio)[0].real
        return pulled_system(self.contents.prism, stiffness / FILM)

    def skeleton(self, pressure: float, friction: float) -> Skeleton:
        """Its contacts, preloaded."""
        prism, grain = self.contents.prism, self.recipe.aggregate
        one, two = (prism.radius[ends[self.touching]] for ends in (prism.network.first, prism.network.second))
        volume = prism.geometry.width * prism.geometry.thickness * prism.geometry.h
        length = prism.network.length[self.touching]
        return Skeleton.preloaded(
            self.touching,
            one * two / (one + two),
            length,
            volume,
            pressure,
            (grain.modulus, grain.poisson),
            friction,
        )

    def row(
        self,
        modulus: float,
        exponent: float,
        amplitude: float,
        programme: Programme,
        pressed: tuple[float, float],
    ) -> dict[str, float]:
        """One test of a mix of this |E*| [Pa] with its contacts stuck; `pressed`: pressure [Pa] and friction."""
        omega, prism = 2.0 * np.pi * FREQUENCY, self.contents.prism.geometry
        chain, _ = kelvin_chain(
            lambda w: np.asarray(FILM * (1j * w / omega) ** exponent, complex),
            omega / (3.0 * programme.cycles),
            3.0 * omega,
        )
        law, skeleton = bond_law(chain), self.skeleton(*pressed)
        size = prism.h / (prism.width * prism.thickness)  # modulus over stiffness
        # secants of the logarithms; the skeleton alone may be stiffer than the softest mix
        matrix = [modulus / 30.0, modulus / 10.0]
        shown: list[float] = []
        for _ in range(8):
            shown.append(size * abs(stuck_stiffness(self.system(matrix[len(shown)]), law, skeleton, omega)))
            if abs(shown[-1] / modulus - 1.0) < 0.01:
                break
            if len(shown) > 1:
                slope = np.log(shown[-1] / shown[-2]) / np.log(matrix[-1] / matrix[-2])
                matrix.append(float(matrix[-1] * (modulus / shown[-1]) ** (1.0 / max(slope, 0.2))))
        area = prism.width * prism.thickness
        system = self.system(matrix[len(shown) - 1])
        test = run_cycles(system, law, skeleton, FREQUENCY, shown[-1] * amplitude * area, programme)
        stuck = complex(size * test.stuck)
        change = np.log(test.stiffness / test.stuck) - log_read_alone(stuck, exponent, programme)
        return {
            "E_MPa": float(size * abs(test.stuck) / 1e6),
            "exponent": exponent,
            "amplitude_1e6": 1e6 * amplitude,
            "haversine": int(programme.haversine),
            "pressure_kPa": pressed[0] / 1e3,
            "friction": pressed[1],
            "phase_deg": float(np.degrees(np.angle(test.stuck))),
            "lnE": float(change.real),
            "change_deg": float(np.degrees(change.imag)),
            "energy_error": float(1.0 - test.taken / test.work),
        }


def log_read_alone(modulus: complex, exponent: float, programme: Programme) -> complex:
    """ln of what is read over E* [Pa] of a mix whose contacts stick, films of a power law beside springs.

    A haversine from rest leaves an error of the drift's bend that is not the contacts'.
    """
    omega = 2.0 * np.pi * FREQUENCY
    films = modulus.imag / np.sin(0.5 * np.pi * exponent)
    springs = modulus.real - films * np.cos(0.5 * np.pi * exponent)
    chain, _ = kelvin_chain(
        lambda w: np.asarray(films * (1j * w / omega) ** exponent + springs, complex),
        omega / (3.0 * programme.cycles),
        3.0 * omega,
    )
    return complex(np.log(modulus_as_read(chain, [FREQUENCY], programme)[0] / modulus))


def tests(pressure: float) -> Iterator[tuple[float, float, float, Programme, tuple[float, float]]]:
    """What is simulated: the grid of both populations, several amplitudes, and doubts about pressure and friction."""
    usual = pressure, 0.5
    for amplitude in AMPLITUDES.values():
        for modulus in MODULI:
            for exponent in EXPONENTS:
                yield modulus, exponent, amplitude, HAVERSINE, usual
    for programme in (HAVERSINE, PULLED):
        for amplitude in SEVERAL:
            yield 6e9, 0.3, amplitude, programme, usual
    for pressed in DOUBTS.values():
        for modulus, exponent in ((900e6, 0.3), (4e9, 0.3)):
            yield modulus, exponent, AMPLITUDES["ncat"], HAVERSINE, pressed


def run(job: Any) -> None:
    """contacts.csv."""
    stones = Stones(job.input.recipe, job.input.packings)
    with ProcessPoolExecutor(job.threads) as pool:
        rows = list(pool.map(stones.row, *zip(*tests(stones.pressure), strict=True)))
    write_table(job.output[0], pd.DataFrame(rows))


if __name__ == "__main__":
    run_script(globals()["snakemake"], run)
