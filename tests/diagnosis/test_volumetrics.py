"""Air voids beside the levels of the specimens, and VMA and VFA of the mix."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from asphalt_nscd.diagnosis.record.volumetrics import Volumetrics, explained, read_volumetrics
from asphalt_nscd.files.csvinput import read_csv


def table(tmp_path, header, *rows):
    path = tmp_path / "t.csv"
    path.write_text("\n".join([f"specimen,{header}", *rows]) + "\n")
    return read_csv(path)


def test_the_mix_has_the_mean_of_its_specimens_and_what_is_said_comes_first(tmp_path):
    given = table(
        tmp_path, "air_voids_percent,vma_percent,vfa_percent", "A,4,16,70", "A,5,16,", "B,7,18,60", "B,,,60"
    )
    found = read_volumetrics(given)
    assert found.of_mix == (17.0, 65.0) and found.air_voids == {"A": 4.5, "B": 7.0}
    assert read_volumetrics(given, vfa=80.0).of_mix == (17.0, 80.0)
    assert found.note == [
        "VMA 17 % and VFA 65 %: the glassy modulus of law.json is held near 22.2 GPa, the limiting modulus of AASHTO "
        "R 84."
    ]
    voids = read_volumetrics(table(tmp_path, "air_voids_percent", "A,4", "B,"))
    assert voids == Volumetrics(None, {"A": 4.0}) and voids.note == []
    assert (
        read_volumetrics(None, 15.0, 70.0) == Volumetrics((15.0, 70.0))
        and read_volumetrics(None, 15.0) == Volumetrics()
    )


def test_air_voids_explain_levels_by_a_slope_drawn_to_the_usual_one():
    """Of the third specimen none are known; the slope by least squares beside -6 +- 3 % for each percent of voids."""
    scales = np.array([0.10, -0.02, 5.0, -0.11])
    diagnosis = SimpleNamespace(
        observed=SimpleNamespace(names=("A", "B", "C", "D")),
        law_of_all=lambda: (None, SimpleNamespace(scales=scales)),
        noise=SimpleNamespace(scale=0.03),
    )
    air = {"A": 4.0, "B": 6.0, "D": 8.0}
    level, away = scales[[0, 1, 3]] + 0.01, np.array([-2.0, 0.0, 2.0])
    rows = np.append(away / 0.03, 1.0 / 0.03)
    data = np.append(level / 0.03, -0.06 / 0.03)
    slope, error = rows @ data / (rows @ rows), (rows @ rows) ** -0.5
    assert explained(diagnosis, Volumetrics(None, air)) == {
        "slope_percent": pytest.approx(100.0 * slope),
        "std_error_percent": pytest.approx(100.0 * error),
        "specimens_percent": pytest.approx(100.0 * np.sqrt((level @ level) / 2.0)),
        "left_percent": pytest.approx(100.0 * np.sqrt(((level - slope * away) ** 2).sum() / 2.0)),
        "lowest_percent": 4.0,
        "highest_percent": 8.0,
    }
    assert explained(diagnosis, Volumetrics(None, {"A": 4.0})) is None
    assert explained(diagnosis, Volumetrics(None, {"A": 4.0, "B": 4.0})) is None
