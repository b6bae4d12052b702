"""Numerics of a campaign told apart: time stepping, broken bonds, peak picking."""

import numpy as np
import pandas as pd
import pytest

from asphalt_nscd.diagnosis.simulation.numerics import numerical_errors
from asphalt_nscd.files.errors import InputError


def test_departures_from_law_and_ratio(tmp_path):
    tests = pd.DataFrame(
        {
            "specimen": np.repeat(["s1", "s2"], 5),
            "temperature_C": 15.0,
            "frequency_Hz": np.tile([1, 2, 3, 4, 5], 2),
            "E_law_MPa": 1000.0,
            "phase_law_deg": 20.0,
            "broken_bonds": 0,
            "E_MPa": np.repeat([1100.0, 1050.0], 5),
            "phase_deg": 20.0,
        }
    )
    tests.loc[2, ["E_MPa", "phase_deg"]] = 1100.0 * np.exp(0.002), 19.9
    tests.loc[7, ["E_MPa", "phase_deg", "broken_bonds"]] = 1050.0 * np.exp(-0.03), 20.5, 4
    tests["E_peak_MPa"], tests["phase_peak_deg"] = tests["E_MPa"] * np.exp(-0.001), tests["phase_deg"] + 0.3
    tests.to_csv(tmp_path / "simulations.csv", index=False)
    found = numerical_errors(tmp_path / "simulations.csv", np.array([15.2]), np.array([3.0]))
    assert found == {
        "tests": 10,
        "tests_with_broken_bonds": 1,
        "time_stepping_modulus_percent": pytest.approx(0.2),
        "time_stepping_phase_deg": pytest.approx(0.1),
        "broken_bonds_modulus_percent": pytest.approx(3.0),
        "broken_bonds_phase_deg": pytest.approx(0.5),
        "peak_picking_modulus_percent": pytest.approx(0.1),
        "peak_picking_phase_deg": pytest.approx(0.3),
    }
    with pytest.raises(
        InputError, match="simulations.csv: no test at a temperature and frequency that was measured"
    ):
        numerical_errors(tmp_path / "simulations.csv", np.array([15.0, 20.0]), np.array([10.0, 3.0]))
