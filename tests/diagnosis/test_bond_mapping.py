"""bond_mapping is judged by simulations alone, and its errors are those of the campaigns."""

from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest

from asphalt_nscd.diagnosis.simulation.bond_mapping import bond_mapping, ratio_to_law, simulated, void


@pytest.fixture
def campaign(tmp_path):
    def make(name, *ratios):
        rows = [
            (f"s{k}", t, f, ratio * 1000.0 * (1 + t), 20.0 + t, 1000.0 * (1 + t), 20.0 + t, 0)
            for k, ratio in enumerate(ratios, 1)
            for t in (0.0, 20.0)
            for f in (3.0, 10.0)
        ]
        columns = [
            "specimen",
            "temperature_C",
            "frequency_Hz",
            "E_MPa",
            "phase_deg",
            "E_law_MPa",
            "phase_law_deg",
        ]
        pd.DataFrame(rows, columns=[*columns, "broken_bonds"]).to_csv(path := tmp_path / name, index=False)
        return path

    return make


def test_ratio_names_the_rung_not_the_errors(campaign):
    rung, said = bond_mapping(campaign("p.csv", 1.05, 1.11), campaign("f.csv", 1.001, 1.002), {})
    assert rung["cause"] == "bond_mapping" and rung["p_value"] is None and rung["established"]
    assert rung["parameters"]["modulus_over_law"]["value"] == pytest.approx(1.08)
    assert rung["parameters"]["modulus_over_law"]["std_error"] == pytest.approx(0.06 / np.sqrt(2))
    assert (
        "in 2 packings: |E*| is 1.050 to 1.110 of the law as in the paper, 1.001 to 1.002 with facets" in said
    )
    softer, _ = bond_mapping(campaign("p.csv", 0.55), campaign("f.csv", 0.985), {})
    assert softer["parameters"]["modulus_over_law"]["std_error"] is None


def test_bonds_that_return_their_law_are_no_rung(campaign):
    rung, said = bond_mapping(campaign("p.csv", 0.995, 1.009), campaign("f.csv", 1.001, 1.0), {})
    assert rung is None and said.startswith("No rung bond_mapping")
    assert "0.985 of the law" in void(campaign("p.csv", 0.985))


def test_tests_that_break_bonds_do_not_count(campaign):
    path = campaign("p.csv", 1.1)
    table = pd.read_csv(path)
    table.loc[0, ["E_MPa", "broken_bonds"]] = 1.0, 5
    table.to_csv(path, index=False)
    assert ratio_to_law(path)["s1"] == pytest.approx(1.1)
    table.assign(broken_bonds=1).to_csv(path, index=False)
    rung, said = bond_mapping(path, path, {})
    assert rung is None and "not judged" in said


def test_each_measured_test_meets_the_condition_nearest_to_it(campaign):
    observed = SimpleNamespace(
        temperature=np.array([0.3, 19.6, 19.6, 10.0]), frequency=np.array([3.1, 9.8, 5.0, 3.0])
    )
    shown = simulated(campaign("p.csv", 1.0, 1.2), observed)
    assert np.exp(shown[:2].real) == pytest.approx([1.1e9, 21 * 1.1e9])
    assert np.degrees(shown[:2].imag) == pytest.approx([20.0, 40.0])
    assert np.isnan(shown[2:].real).all() and np.isnan(shown[2:].imag).all()
