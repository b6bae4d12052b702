"""law.json of what the tests hold less their causes, and the tests as they are written after correction."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest

from asphalt_nscd.diagnosis.causes import CATALOGUE
from asphalt_nscd.diagnosis.model.joint import Candidate
from asphalt_nscd.diagnosis.observed.observations import Observations
from asphalt_nscd.diagnosis.record import law, reported
from asphalt_nscd.rheology.parabolic import HuetSayegh
from asphalt_nscd.rheology.shift import WLF

LAW = HuetSayegh(60e6, 33e9, k=0.21, h=0.6, delta=2.3, tau=0.15, shift=WLF(18.0, 150.0, 15.0))
CAUSES = {cause.name: cause for cause in CATALOGUE}


def tests_at(*isotherms):
    grid = np.array([(t, f) for t in isotherms for f in (1.0, 10.0)])
    one = np.ones(len(grid))
    modulus = LAW.complex_modulus(2.0 * np.pi * grid[:, 1], grid[:, 0])
    return Observations(np.zeros(len(grid), int), ("A",), *grid.T, modulus, one, 0.0 * one)


tests_at.__test__ = False


@pytest.mark.parametrize(
    ("isotherms", "reference", "shift"),
    [
        ((0.0, 20.0, 30.0), 20.0, "wlf"),
        ((0.0, 20.0), 20.0, "arrhenius"),
        ((0.0, 10.0, 20.0, 30.0), 20.0, "wlf"),
    ],
)
def test_the_law_is_fitted_to_tests_less_their_causes_and_errs_by_its_form_too(
    isotherms, reference, shift, monkeypatch
):
    """Two explanations of the free curve, which lie off the law by a mean of 3 % and 0.01 rad."""
    tests = tests_at(*isotherms)
    n, known = tests.size, np.eye(2 * tests.size)
    free = np.log(tests.modulus) - np.array([[0.05 + 0.02j], [0.01 + 0.0j]])
    mix = SimpleNamespace(
        tests=tests, effect=lambda of: np.full(of.size, 0.1 + 0.2j), weights=np.array([0.5, 0.5]),
        parts=lambda omega, t: (free, None), covariance=lambda omega, t: known,
    )  # fmt: skip
    asked = []

    def fit(*given, prior):
        asked.append(given)
        return SimpleNamespace(
            law=LAW, restate=lambda covariance: SimpleNamespace(law=LAW, covariance=covariance)
        )

    monkeypatch.setattr(law, "fit_spectrum", fit)
    found = law.law_of_mix(mix, "huet-sayegh")
    omega, temperature, modulus, at, form = asked[0]
    assert (at, form.law, form.shift) == (reference, "huet-sayegh", shift)
    assert modulus == pytest.approx(tests.modulus * np.exp(-0.1 - 0.2j)) and (omega == tests.omega).all()
    assert found.misfit_of_form == pytest.approx((0.03, 0.01))
    assert found.fit.covariance == pytest.approx(known + np.diag(np.repeat([9e-4, 1e-4], n)))
    for sigma, far in (((0.031, 0.0096), True), ((0.031, 0.0098), False), ((0.02, 0.02), True)):
        told = found.notes(SimpleNamespace(noise=SimpleNamespace(sigma=sigma), replicated=True))
        assert bool(told) is far and all("differ by 3 % in |E*| and 0.6 deg in phase" in one for one in told)
    assert found.notes(
        SimpleNamespace(noise=SimpleNamespace(sigma=(1e-9, 1e-9)), replicated=False), ["x"]
    ) == ["law.json and reported.csv are fitted without x."]


def test_parameters_of_the_law_are_its_numbers_with_their_intervals():
    content = {"law": "x", "k": 0.2, "c1": 18.0, "reference_temperature_C": 15.0, "rms_log_residual": 0.1,
               "interval_95": {"k": [0.1, 0.3]}, "unseen": ["c1"]}  # fmt: skip
    assert law.law_parameters(content) == {
        "k": {"value": 0.2, "interval_95": [0.1, 0.3], "determined": True},
        "c1": {"value": 18.0, "interval_95": None, "determined": False},
    }


def test_each_test_is_written_as_recorded_and_less_what_is_established_of_its_faults():
    """Of a table of which one test is left out: a delay is sure, an offset is not, and films are the mix's own."""
    tests = tests_at(0.0, 20.0)
    whole = Observations(
        **vars(tests) | {"nominal_temperature": tests.temperature, "temperature": tests.temperature + 0.5}
    )
    names = "channel_delay", "film_softening", "phase_offset"
    delay, film, offset = named = [Candidate(CAUSES[name], None, (1.0,)) for name in names]
    turned = 2.0 * np.exp(0.1j)

    def apparent(of_law, active):
        assert active in ((delay,), ()) and of_law == "last"
        return (np.full(3, turned) if active else np.ones(3, complex),)

    ladder = SimpleNamespace(
        rungs=[SimpleNamespace(candidate=one) for one in named], joint=SimpleNamespace(apparent=apparent),
        fitted=SimpleNamespace(active=tuple(named), law="last"),
    )  # fmt: skip
    kept = np.array([0, 2, 3])
    diagnosis = SimpleNamespace(
        ladder=ladder, established=lambda rung: rung.candidate is not offset,
        observed=SimpleNamespace(modulus=whole.modulus[kept]),
    )  # fmt: skip
    mix = SimpleNamespace(base=SimpleNamespace(log_shift=lambda x, t: (0.1 * (20.0 - t), None)), law=None)
    record = pd.DataFrame({
        "specimen": "A", "status": ["used", "left out", "doubtful", "used"], "reasons": [[], ["a; b", "c"], ["d"], []],
        "decided_by": ["", "x", "y", ""],
    })  # fmt: skip
    found = reported.corrected(diagnosis, whole, mix, record)
    after = np.where(np.arange(4) == 1, np.nan, whole.modulus / turned)
    expected = {
        "nominal_temperature_C": [0.0, 0.0, 20.0, 20.0],
        "temperature_C": [0.5, 0.5, 20.5, 20.5],
        "frequency_Hz": [1.0, 10.0, 1.0, 10.0],
        "E_MPa": np.abs(after) * 1e-6,
        "phase_deg": np.degrees(np.angle(after)),
        "recorded_E_MPa": np.abs(whole.modulus) * 1e-6,
        "recorded_phase_deg": np.degrees(np.angle(whole.modulus)),
        "reduced_frequency_Hz": whole.frequency * np.exp([1.95, 1.95, -0.05, -0.05]),
    }
    for name, values in expected.items():
        assert found[name].to_numpy() == pytest.approx(np.array(values), nan_ok=True), name
    assert found["corrected_for"].tolist() == ["channel_delay", "", "channel_delay", "channel_delay"]
    assert found["not_corrected_for"].tolist() == [
        "film_softening + phase_offset" * (k != 1) for k in range(4)
    ]
    assert found["reasons"].tolist() == ["", "a, b, c", "d", ""] and found["decided_by"].tolist() == [
        "",
        "x",
        "y",
        "",
    ]


def test_a_law_has_its_band_and_no_mix_leads_its_load():
    band = SimpleNamespace(
        half=lambda of, omega, t: np.array([0.1 + 0.5j, 0.2 + 0.01j]) * (omega == 2.0 * np.pi)
    )
    t, f = np.array([0.0, 20.0]), np.ones(2)
    value, low, high = reported.law_with_band(LAW, band, t, f)
    star = LAW.complex_modulus(2.0 * np.pi * f, t)
    assert np.exp(value) == pytest.approx(star) and np.isnan(reported.law_with_band(LAW, None, t, f)[1]).all()
    table = reported.table_of(t, f, (value, low, high))
    assert table["E_low_MPa"].to_numpy() == pytest.approx(np.abs(star) * 1e-6 * np.exp([-0.1, -0.2]))
    assert table["E_high_MPa"].to_numpy() == pytest.approx(np.abs(star) * 1e-6 * np.exp([0.1, 0.2]))
    phase = np.degrees(np.angle(star))
    assert table["phase_high_deg"].to_numpy() == pytest.approx(phase + np.degrees([0.5, 0.01]))
    assert table["phase_low_deg"].to_numpy() == pytest.approx([0.0, phase[1] - np.degrees(0.01)])
