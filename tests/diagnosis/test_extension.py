"""What a diagnosis named stands in the bond laws and the rig of the extended simulation."""

import json
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from asphalt_nscd.bending.rig import read_rig
from asphalt_nscd.diagnosis.observed.reading import PAPER_GEOMETRY
from asphalt_nscd.diagnosis.record.law import left_to_priors
from asphalt_nscd.diagnosis.simulation.extension import Sample, extend
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.measurements.twopoint import Geometry, form_factor
from asphalt_nscd.rheology.fitting import Fit
from asphalt_nscd.rheology.laws_io import read_bond_law
from asphalt_nscd.rheology.parabolic import TwoS2P1D
from asphalt_nscd.rheology.shift import WLF
from asphalt_nscd.rheology.spectrum_io import write_spectrum

LAW = TwoS2P1D(1e6, 42e9, 0.2, 0.6, 1.6, 0.14, 28.0, WLF(11.7, 80.0, 15.0))
GAMMA = form_factor(Geometry(b=0.025, B=0.056, e=0.025, h=0.25, mass=0.6, mobile_mass=0.235))
OMEGA = 2 * np.pi * np.array([3.0, 10.0, 40.0])


def rung(cause, where=None, **values):
    parameters = {k: {"value": v} for k, v in values.items()}
    return {"cause": cause, "where": where, "parameters": parameters, "taken_off": 1.0}


@pytest.fixture
def folder(tmp_path):
    rows = [
        (name, t, f, 1e3, 20.0, f) for name in "ab" for t in (-10.0, 15.0, 30.0) for f in (3.0, 10.0, 40.0)
    ]
    columns = ["specimen", "temperature_C", "frequency_Hz", "E_MPa", "phase_deg", "cycles"]
    pd.DataFrame(rows, columns=columns).to_csv(tmp_path / "measured.csv", index=False)
    write_spectrum(tmp_path / "law.json", LAW, source="fitted", rms_log_residual=0.0)
    return tmp_path


def extended(folder, ladder, number=0):
    """(E* of the bonds at 15 degC, rig)."""
    (folder / "diagnosis.json").write_text(json.dumps({"ladder": ladder}))
    tests = [(15.0, f, folder / f"f{f:g}.json") for f in (3.0, 10.0, 40.0)]
    extend(
        folder / "diagnosis.json",
        folder / "law.json",
        folder / "measured.csv",
        PAPER_GEOMETRY,
        Sample(number, 63e-6, tests),
        folder / "rig.json",
    )
    moduli = [read_bond_law(path).complex_modulus(2 * np.pi * f) for _, f, path in tests]
    return np.array(moduli), read_rig(folder / "rig.json")


def test_the_law_alone(folder):
    bonds = rung("bond_mapping", modulus_over_law=1.1)  # is put right by facets, not by the law
    modulus, rig = extended(folder, [bonds, rung("relaxation_spectrum", wlf_C1=11.7)])
    assert np.abs(np.log(modulus / LAW.complex_modulus(OMEGA, 15.0))).max() < 1.1e-3
    assert rig.is_rigid and rig.channel_delay == 0.0
    band = json.loads(
        (folder / "f10.json").read_text()
    )  # of 3 to 40 Hz, and a factor of two for the transient
    assert (band["lowest_Hz"], band["highest_Hz"], band["temperature_C"]) == (1.5, 80.0, 15.0)
    edge = 2.0 * np.pi * np.array([1.5, 80.0])
    chain = read_bond_law(folder / "f10.json").complex_modulus(edge)
    assert np.abs(np.log(chain / LAW.complex_modulus(edge, 15.0))).max() < 1.1e-3


def test_causes_of_the_mix_change_the_law_and_those_of_the_rig_the_rig(folder):
    ladder = [
        rung("temperature_bias", 15.0, temperature_rise=2.0),
        rung("channel_delay", delay=-1e-4),
        rung("damage", loss_at_last_test=0.2),
        rung("specimen_geometry", "b", relative_modulus=0.3),
        rung("loose_clamp", "b", compliance=2e-12),
        rung("guide_friction", loss_modulus=1e8),
    ]
    warm = LAW.complex_modulus(OMEGA, 17.0) * (1 - 0.2 * (OMEGA / (2 * np.pi) - 3) / 37)
    modulus, rig = extended(folder, ladder)
    assert np.abs(np.log(modulus / warm)).max() < 1.1e-3
    assert rig.channel_delay == -1e-4 and rig.clamp_compliance == 0.0
    assert 4 * rig.guide_friction / (np.pi * 63e-6) * GAMMA == pytest.approx(1e8)
    modulus, rig = extended(folder, ladder, number=3)  # a fourth sample stands for b as the second does
    assert np.abs(np.log(modulus / warm / 1.3)).max() < 1.1e-3
    assert rig.clamp_compliance == pytest.approx(2e-12 * GAMMA)


def test_a_possible_cause_is_simulated_as_large_as_the_law_is_free_of_it(folder):
    possible = rung("channel_delay", delay=1e-3) | {"taken_off": 0.8}
    modulus, rig = extended(folder, [possible])
    assert np.abs(np.log(modulus / LAW.complex_modulus(OMEGA, 15.0))).max() < 1.1e-3
    assert rig.channel_delay == pytest.approx(0.8e-3)
    assert extended(folder, [possible | {"taken_off": 0.0}])[1].channel_delay == 0.0


def test_self_heating_warms_the_fast_tests_most(folder):
    modulus, _ = extended(folder, [rung("self_heating", largest_temperature_rise=5.0)])
    rise = 5.0 * OMEGA / OMEGA.max()
    assert np.abs(np.log(modulus / LAW.complex_modulus(OMEGA, 15.0 + rise))).max() < 1.1e-3


def test_a_file_that_is_no_diagnosis_is_refused(folder):
    with pytest.raises(InputError, match="not a diagnosis of this version"):
        extended(folder, [{"cause": "witchcraft"}])


def test_what_the_tests_do_not_determine_is_said():
    fit = Fit(LAW, None, 0.0, 10)
    assert left_to_priors(fit) == ("", [])
    assert left_to_priors(replace(fit, unseen=("glassy_modulus",), from_prior=("glassy_modulus",))) == (
        "These tests do not determine the glassy modulus of law.json.",
        [
            "These tests do not determine the glassy modulus of law.json; there it has usual values of published "
            "asphalt concretes: glassy modulus 42 GPa."
        ],
    )
    three = ("static_modulus", "c1", "c2")
    _, (said,) = left_to_priors(replace(fit, unseen=three, from_prior=three))
    assert "do not determine the static modulus, C1 and C2 of law.json" in said
    assert said.endswith("asphalt concretes: static modulus 1 MPa, C1 12, C2 80 K.")
    long = replace(fit, law=replace(LAW, beta=506.0), unseen=("beta",), from_prior=("beta",))
    assert "beta 510." in left_to_priors(long)[1][0]


def test_an_interval_of_a_factor_of_four_determines_nothing():
    fit = Fit(LAW, {"k": 0.01, "static_modulus": 0.4 * LAW.static_modulus}, 0.0, 10)
    assert left_to_priors(fit) == ("These tests do not determine the static modulus of law.json.", [])
