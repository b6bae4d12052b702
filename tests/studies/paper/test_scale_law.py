from __future__ import annotations

import pytest

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.rheology.burgers import Burgers
from asphalt_nscd.rheology.laws_io import read_law, write_law
from studies.paper.scale_law import scale_law

LAW = Burgers(2.02e10, 1.79e9, 2.72e10, 4.61e8)


@pytest.fixture
def law(tmp_path):
    write_law(tmp_path / "law.json", LAW, source="published", temperature=20.0)
    return tmp_path / "law.json"


@pytest.mark.parametrize(
    ("parameter", "field"),
    [("Em", "modulus_m"), ("eta_m", "viscosity_m"), ("Ek", "modulus_k"), ("eta_k", "viscosity_k")],
)
def test_one_parameter_changes_and_no_other(law, tmp_path, parameter, field):
    content = scale_law(law, parameter, 1.5, tmp_path / "scaled.json")
    scaled = read_law(tmp_path / "scaled.json")
    for name in ("modulus_m", "viscosity_m", "modulus_k", "viscosity_k"):
        assert getattr(scaled, name) == getattr(LAW, name) * (1.5 if name == field else 1.0)
    assert content["scaled"] == {"parameter": parameter, "factor": 1.5}
    assert content["source"] == "published" and content["temperature_C"] == 20.0


@pytest.mark.parametrize("factor", [0.0, -1.0, float("nan"), float("inf"), 1e300, 1e-7])
def test_factor_that_leaves_no_law(law, tmp_path, factor):
    with pytest.raises(InputError, match="give a number from 1e-06 to 1e\\+06"):
        scale_law(law, "Em", factor, tmp_path / "scaled.json")
    assert not (tmp_path / "scaled.json").exists()
