"""Tiny result files for figures and tables."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path

import numpy as np
import pandas as pd
from scipy.sparse import csr_matrix

from asphalt_nscd.files.store import save, write_json, write_table
from asphalt_nscd.rheology.burgers import Burgers
from asphalt_nscd.rheology.laws_io import write_law

LAWS = {0.0: Burgers(35.5e9, 22.6e9, 295e9, 3.46e9), 20.0: Burgers(20.2e9, 1.79e9, 27.2e9, 0.461e9)}


def modulus(law: Burgers, frequency: float) -> tuple[float, float]:
    value = complex(law.complex_modulus(2.0 * np.pi * frequency))
    return abs(value) / 1e6, float(np.degrees(np.angle(value)))


def band_of(axes, number: int = 0) -> np.ndarray:
    """x, lower and upper edge (3, n) of a band that `fill_between` made."""
    x, y = axes.collections[number].get_paths()[0].vertices.T
    at = np.unique(x)
    return np.array([at, [y[x == one].min() for one in at], [y[x == one].max() for one in at]])


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
        self,
        samples: Iterable[str] = ("s1",),
        frequencies: Iterable[float] = (3.0, 10.0, 40.0),
        ratios: Callable[[str], float] = lambda sample: 1.0,
        name: str = "simulations",
        **columns: object,
    ) -> list[Path]:
        """Every sample gives `ratios(sample)` times the law, at 0 and 20 degC."""
        rows = []
        for sample in samples:
            for temperature, law in LAWS.items():
                for frequency in frequencies:
                    norm, phase = modulus(law, frequency)
                    rows.append(
                        {
                            "specimen": sample,
                            "temperature_C": temperature,
                            "frequency_Hz": frequency,
                            "E_MPa": ratios(sample) * norm,
                            "phase_deg": phase + 0.01,
                            "E_law_MPa": norm,
                            "phase_law_deg": phase,
                            "broken_bonds": 2 if temperature == 0.0 else 0,
                            **columns,
                        }
                    )
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
        self,
        name: str = "test",
        lead: float = 0.3,
        cycles: int = 3,
        force: float = 40.0,
        **attributes: object,
    ) -> list[Path]:
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
            "initial_position": position,
            "poured_position": position * [1.0, 1.0, 0.12],
            "position": position * [1.0, 1.0, 0.1],
            "radius": radius,
            "box": box,
            "course/time": np.array([2.0, 2.5, 3.25]),
            "course/height": np.array([0.024, 0.021, 0.0203]),
        }
        heights = {"poured_layer_height_m": 0.024, "layer_height_m": 0.0203}
        save(path := self.folder / "deposit.h5", "deposit", arrays, heights)
        return [path]

    def specimen(self) -> list[Path]:
        position = np.array([[0.0, 0.0, 0.03], [0.003, 0.0004, 0.03], [0.0, 0.02, 0.03], [0.0, 0.0, 0.055]])
        radius = np.array([1e-3, 1e-3, 2.5e-3, 1e-3]) * 0.9 ** (1.0 / 3.0)
        # The last bond leads to a plate, which comes after the spheres.
        arrays = {
            "position": position,
            "radius": radius,
            "network/first": np.array([0, 0, 0]),
            "network/second": np.array([1, 2, 4]),
            "network/point": np.array([[0.0015, 0.0002, 0.03], [0.0, 0.001, 0.03], [0.0, 0.0, 0.0]]),
        }
        shape = {
            "geometry": "bending",
            "b": 0.01,
            "B": 0.02,
            "e": 0.01,
            "h": 0.06,
            "mass": 0.021,
            "mobile_mass": 0.008,
        }
        save(path := self.folder / "specimen.h5", "specimen", arrays, shape | {"volume_reduction": 0.1})
        return [path]

    def model(self, name: str = "specimen") -> list[Path]:
        """Of the specimen: spheres 0 and 1 move by 0.5 and 0.75 along x, the head by one; normals along x."""
        deflection = np.zeros((5, 6))
        deflection[:, 0] = 0.5, 0.75, 0.0, 0.0, 1.0
        operator = np.zeros((9, 30))
        for row, (first, second) in zip((0, 3, 6), ((0, 1), (0, 2), (0, 4)), strict=True):
            operator[row, 6 * first], operator[row, 6 * second] = -1.0, 1.0
        sparse = csr_matrix(operator)
        arrays = {
            "basis": deflection.reshape(-1, 1),
            "mass": np.ones(30),
            "weight": np.repeat([6.0, 2.0, 2.0], 3),
            **{f"operator/{part}": getattr(sparse, part) for part in ("data", "indices", "indptr")},
        }
        save(path := self.folder / "model.h5", "model", arrays, {"name": name})
        return [path]

    def diagnosis(self, **changes: object) -> dict[str, list[Path]]:
        """Two specimens at two temperatures: before 20 % and 4 degrees too soft at 20 degC, scatter 1 % and 0.5 deg.

        After, nothing is left at 0 degC and 1 % at 20 degC. Specimen 2 has a loose clamp.
        """
        rows = []
        for specimen in ("1", "2"):
            for temperature, law in LAWS.items():
                for frequency in (3.0, 10.0, 40.0):
                    norm, phase = modulus(law, frequency)
                    off = (20.0, 4.0, 1.0, 0.0) if temperature == 20.0 else (0.0, 0.0, 0.0, 0.0)
                    rows.append(
                        {
                            "specimen": specimen, "temperature_C": temperature, "frequency_Hz": frequency,
                            "E_MPa": norm, "phase_deg": phase,
                            "E_before_MPa": norm * np.exp(-off[0] / 100), "phase_before_deg": phase - off[1],
                            "residual_E_before_percent": off[0], "residual_phase_before_deg": off[1],
                            "E_after_MPa": norm * np.exp(-off[2] / 100), "phase_after_deg": phase - off[3],
                            "residual_E_after_percent": off[2], "residual_phase_after_deg": off[3],
                        }
                    )  # fmt: skip
        write_table(residuals := self.folder / "residuals.csv", pd.DataFrame(rows))
        pair = {"before": 8.0, "after": 2.0}
        gain = {
            "mre_E_percent": pair,
            "mre_phase_percent": pair,
            "rms_over_scatter": pair,
            "averages_by_temperature": {
                at: {"mre_E_percent": pair, "mre_phase_percent": pair, "off_phase_deg": pair}
                for at in ("0", "20")
            },
        }
        rung = {"where": None, "p_value": 1e-9, "as_good": [], "sentence": "s", "confirmed_by": "c"}
        rung |= {"established": True, "hangs_on": [], "doubts": [], "probability": None, "taken_off": 0.0}
        rung |= {"evidence": "", "log10_shift": {}}
        rung["gain"] = {"in_sample": gain, "held_out": {"leave_one_frequency_out": gain}}
        spectrum = {"wlf_C1": {"value": 12.0, "std_error": None, "unit": "1"}}
        clamp = {"compliance": {"value": 3e-12, "std_error": 2e-13, "unit": "1/Pa"}}
        places = {"confined_to": "specimen", "places": {"1": 9e-13, "2": 8e-13}}
        errors = {"0": 1.0, "20": 2.0}
        parameters = {"Em_Pa": 2e10, "eta_m_Pa_s": 1e9, "Ek_Pa": 3e10, "eta_k_Pa_s": 1e8}
        content = {
            "schema_version": 3, "verdict": "explained", "tests": 12, "tested": True, "origin": "reconstructed",
            "scatter": {"modulus_percent": 1.0, "phase_deg": 0.5, "specimens_percent": 3.0, "from_replicates": True,
                        "air_voids": None},
            "averaged_over": [{"causes": [], "probability": 1.0}],
            "numerics": {
                "specimen": "s1", "modulus_over_law": 1.002, "largest_modulus_percent": 0.1, "largest_phase_deg": 0.02,
            },
            "baseline": {
                "law": "burgers", "p_value": 0.0, "parameters": {"0": parameters, "20": parameters},
                "mre_E_percent": errors, "mre_phase_percent": errors,
            },
            "ladder": [
                rung | {"cause": "relaxation_spectrum", "parameters": spectrum, "log10_shift": {"0": 2.0, "20": 0.0}},
                rung | {"cause": "loose_clamp", "where": "2", "parameters": clamp, "taken_off": 1.0,
                        "probability": 0.97},
            ],
            "withdrawn": [], "indistinguishable": [["loose_clamp of all specimens", "relaxation_spectrum"]],
            "not_testable": [{"cause": "damage", "needs": "the order of the tests"}],
            "detection_limits": {
                "channel_delay": {"value": 3e-5, "unit": "s"},
                "loose_clamp": {"value": 8e-13, "unit": "1/Pa", **places},
                "temperature_bias": {
                    "value": 0.3, "unit": "K", "confined_to": "temperature_C", "places": {"0.0": 0.9, "20.0": 0.3},
                },
            },
            "lack_of_fit_p_value": 0.4, "largest_pattern_left": None, "unexplained": [], "notes": [],
            "provenance": {
                "git_commit": "c", "python": "3", "packages": {}, "measurements": "m.csv", "draws": 500, "seed": 0,
                "scatter_stated": None,
            },
            "estimates": {}, "estimates_spread": 1.0, "discrepancy": [], "repeatability": None, "with_suspects": None,
            "without_doubtful": None, "instructions": {"costs": "", "orders": []}, "contradictory_isotherms": [],
            "trust": {"use": 12, "check": 0, "held_back": 0, "not_used": 0, "check_at_C": [], "check_of": [],
                      "use_by_specimen": {}},
            "one_sided": "", "highest_frequency": None, "law_misses": None, "laws": [], "law_parameters": {},
            "undetermined": "", "measured_limits": {}, "excess_phase": [],
            "odd_levels": [],
            "odd_phases": [], "odd_temperatures": [], "suspect_tests": [], "detection_limits_of_one_place": {},
            "reported": {
                "temperature_C": 15.0, "frequency_Hz": 10.0, "E_MPa": 9e3, "E_low_MPa": 8e3, "E_high_MPa": 1e4,
                "phase_deg": 20.0, "phase_low_deg": 19.0, "phase_high_deg": 21.0, "within_the_tests": True,
            },
            "reading": {
                "test_type": "bending", "specimens": ["1", "2"], "isotherms_C": [0.0, 20.0],
                "frequencies_Hz": [1.0, 25.0], "quality_columns": [],
                "limits_exceeded": [], "notes": [], "off_target": [], "not_tested": [], "files_without_tests": [],
            },
        }  # fmt: skip
        write_json(path := self.folder / "diagnosis.json", content | changes)
        return {"residuals": [residuals], "diagnosis": [path]}

    def ladder(self) -> list[Path]:
        """10.2 and 12 % of |E*| as in the paper, 2 and 3 % with facets, 0.5 and 0.7 % with the spectrum as well."""
        rungs = {"as in the paper": (10.2, 12.0), "facets": (2.0, 3.0), "spectrum": (0.5, 0.7)}
        rows = [
            {
                "rung": rung,
                "temperature_C": temperature,
                "compared_with": "reconstructed",
                "mre_E_percent": error,
                "mre_E_law_percent": error if rung == "spectrum" else 2.1,
                "mre_E_held_out_percent": 0.9 if rung == "spectrum" else np.nan,
                "scatter_E_percent": 1.0,
                "mre_phase_percent": 5.0,
                "mre_phase_law_percent": 4.9,
                "mre_phase_held_out_percent": 1.5 if rung == "spectrum" else np.nan,
                "scatter_phase_percent": 4.0,
            }
            for rung, errors in rungs.items()
            for temperature, error in zip((0.0, 20.0), errors, strict=True)
        ]
        write_table(path := self.folder / "ladder.csv", pd.DataFrame(rows))
        return [path]

    def causality(self) -> list[Path]:
        """Two specimens at 4 and 21 degC: 5 deg too much for specimen 2 at 4 degC, 10 Hz (out), a flag and a doubt."""
        rows = []
        for specimen in ("1", "2"):
            for temperature in (4.0, 21.0):
                for frequency in (0.1, 1.0, 10.0, 25.0):
                    fault = specimen == "2" and temperature == 4.0 and frequency == 10.0
                    doubt = specimen == "1" and temperature == 21.0 and frequency == 25.0
                    rows.append(
                        {
                            "specimen": specimen,
                            "temperature_C": temperature,
                            "frequency_Hz": frequency,
                            "E_MPa": 1e3 * (2.0 - temperature / 21.0) * frequency**0.2,
                            "phase_deg": 20.0 + 5.0 * fault,
                            "phase_required_deg": 20.2,
                            "std_error_deg": 1.0,
                            "quality_flag": int(fault),
                            "reasons": "phase; twice" if fault or doubt else "",
                            "status": "left out" if fault else "doubtful" if doubt else "used",
                        }
                    )
        write_table(path := self.folder / "causality.csv", pd.DataFrame(rows))
        return [path]
