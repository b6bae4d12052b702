"""Tiny result files for figures and tables."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path

import numpy as np
import pandas as pd

from asphalt_nscd.rheology.burgers import Burgers
from asphalt_nscd.rheology.laws_io import write_law
from asphalt_nscd.store import save, write_table

LAWS = {0.0: Burgers(35.5e9, 22.6e9, 295e9, 3.46e9), 20.0: Burgers(20.2e9, 1.79e9, 27.2e9, 0.461e9)}


def modulus(law: Burgers, frequency: float) -> tuple[float, float]:
    value = complex(law.complex_modulus(2.0 * np.pi * frequency))
    return abs(value) / 1e6, float(np.degrees(np.angle(value)))


class Results:
    """Writes result files into a folder; each method returns the paths as a figure is given them."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    def laws(self, *temperatures: float) -> list[Path]:
        paths = []
        for temperature in temperatures:
            paths.append(self.folder / f"T{temperature:g}.json")
            write_law(paths[-1], LAWS[temperature], source="published", temperature=temperature)
        return paths

    def simulations(
        self, samples: Iterable[str] = ("s1",), frequencies: Iterable[float] = (3.0, 10.0, 40.0),
        ratios: Callable[[str], float] = lambda sample: 1.0, name: str = "simulations", **columns: object,
    ) -> list[Path]:  # fmt: skip
        """Every sample gives `ratios(sample)` times the law, at 0 and 20 degC."""
        rows = []
        for sample in samples:
            for temperature, law in LAWS.items():
                for frequency in frequencies:
                    norm, phase = modulus(law, frequency)
                    rows.append(
                        {
                            "specimen": sample, "temperature_C": temperature, "frequency_Hz": frequency,
                            "E_MPa": ratios(sample) * norm, "phase_deg": phase + 0.01, "E_law_MPa": norm,
                            "phase_law_deg": phase, "broken_bonds": 2 if temperature == 0.0 else 0, **columns,
                        }
                    )  # fmt: skip
        write_table(path := self.folder / f"{name}.csv", pd.DataFrame(rows))
        return [path]

    def measured(self, origin: str = "reconstructed", specimens: Iterable[str] = ("1", "2")) -> list[Path]:
        rows = [
            (specimen, temperature, frequency, origin, *modulus(law, frequency))
            for specimen in specimens
            for temperature, law in LAWS.items()
            for frequency in (3.0, 10.0, 40.0)
        ]
        columns = ["specimen", "temperature_C", "frequency_Hz", "origin", "E_MPa", "phase_deg"]
        write_table(path := self.folder / "measured.csv", pd.DataFrame(rows, columns=columns))
        return [path]

    def test(
        self, name: str = "test", lead: float = 0.3, cycles: int = 3, force: float = 40.0,
        **attributes: object,
    ) -> list[Path]:  # fmt: skip
        """A sine of 2 Hz, 50 um and `force` [N] that leads by `lead` [rad]; a linear velocity profile."""
        frequency, amplitude = 2.0, 50e-6
        time = np.arange(1, 1000 * cycles + 1) / 1000.0 / frequency
        angle = 2.0 * np.pi * frequency * time
        height = np.linspace(0.01, 0.09, 5)
        last = slice(-1000, None, 5)
        head = 2.0 * np.pi * frequency * amplitude * np.cos(angle[last])
        arrays = {
            "time_s": time,
            "displacement_m": amplitude * np.sin(angle),
            "force_N": force * np.sin(angle + lead),
            "profile/height_m": height,
            "profile/time_s": time[last],
            "profile/spheres": np.array([3, 3, 0, 3, 3]),
            "profile/velocity_m_s": np.outer(head, height / 0.1),
        }
        kept = {"frequency_Hz": frequency, "amplitude_m": amplitude, "time_step_s": time[0], "spheres": 12}
        save(path := self.folder / f"{name}.h5", "test", arrays, kept | attributes)
        return [path]

    def deposit(self) -> list[Path]:
        rng = np.random.default_rng(1)
        radius = np.repeat([1e-3, 2.5e-3], [30, 6])
        box = np.array([0.06, 0.01, 0.2])
        position = rng.uniform(0.0, 1.0, (36, 3)) * box
        arrays = {
            "initial_position": position, "poured_position": position * [1.0, 1.0, 0.12],
            "position": position * [1.0, 1.0, 0.1], "radius": radius, "box": box,
        }  # fmt: skip
        heights = {"poured_height_m": 0.024, "layer_height_m": 0.0203}
        save(path := self.folder / "deposit.h5", "deposit", arrays, heights)
        return [path]

    def specimen(self) -> list[Path]:
        position = np.array([[0.0, 0.0, 0.03], [0.003, 0.0004, 0.03], [0.0, 0.02, 0.03], [0.0, 0.0, 0.055]])
        radius = np.array([1e-3, 1e-3, 2.5e-3, 1e-3]) * 0.9 ** (1.0 / 3.0)
        # The last bond leads to a plate, which comes after the spheres.
        arrays = {
            "position": position, "radius": radius,
            "network/first": np.array([0, 0, 0]), "network/second": np.array([1, 2, 4]),
        }  # fmt: skip
        shape = {"b": 0.01, "B": 0.02, "e": 0.01, "h": 0.06, "mass": 0.021, "mobile_mass": 0.008}
        save(path := self.folder / "specimen.h5", "specimen", arrays, shape | {"volume_reduction": 0.1})
        return [path]
