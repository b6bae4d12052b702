"""What figures and reports make of a diagnosis that was written, and entries of it that are made of the ladder."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest

from asphalt_nscd.diagnosis import written
from asphalt_nscd.diagnosis.causes import EVERY
from asphalt_nscd.diagnosis.model.joint import Candidate
from asphalt_nscd.diagnosis.record import report
from asphalt_nscd.diagnosis.record.measured_limits import stated_power
from asphalt_nscd.diagnosis.search.told import Odd

CAUSES = {cause.name: cause for cause in EVERY}


def test_residuals_of_a_condition_are_means_over_the_scatter_of_a_mean():
    numbers = {name: 1.0 for name in written._NUMBERS}
    rows = [
        {**numbers, "specimen": name, "temperature_C": 20.0, "frequency_Hz": f, "residual_E_after_percent": r,
         "residual_phase_before_deg": -r}
        for name, f, r in (("A", 1.0, 2.0), ("B", 1.0, 4.0), ("A", 10.0, 5.0))
    ]  # fmt: skip
    found = written.conditions(pd.DataFrame(rows), {"modulus_percent": 0.5, "phase_deg": 0.25})
    found = found.sort_values("frequency_Hz")
    assert found["residual_E_after_percent"].tolist() == [3.0, 5.0] and found["count"].tolist() == [2, 1]
    assert found["z_residual_E_after_percent"].to_numpy() == pytest.approx([6.0 * np.sqrt(2.0), 10.0])
    assert found["z_residual_phase_before_deg"].to_numpy() == pytest.approx([-12.0 * np.sqrt(2.0), -20.0])


def test_errors_are_means_over_temperatures_in_the_order_of_their_numbers():
    def errors(value):
        return {name: {"before": value, "after": 2.0 * value} for name in
                ("mre_E_percent", "mre_phase_percent", "off_phase_deg")}  # fmt: skip

    gain = {"averages_by_temperature": {"20": errors(3.0), "100": errors(9.0), "-10": errors(6.0)}}
    assert written.mean_averages(gain)["off_phase_deg"] == {"before": 6.0, "after": 12.0}
    assert written.mean_averages(gain, inner=True)["mre_E_percent"] == {"before": 3.0, "after": 6.0}
    two = {"averages_by_temperature": {"0": errors(1.0), "9": errors(2.0)}}
    assert written.mean_averages(two, inner=True)["mre_E_percent"]["before"] == 1.5  # both are ends


@pytest.mark.parametrize(
    ("value", "unit", "shown"),
    [(2e-3, "s", (2.0, "ms")), (3e6, "Pa", (3.0, "MPa")), (2e-12, "1/Pa", (2.0, "1/TPa")), (0.2, "kg", (200.0, "g")),
     (0.1, "1", (10.0, "%")), (1.5, "K", (1.5, "K")), (0.6, "-", (0.6, "")), (4.0, "deg", (4.0, "°"))],
)  # fmt: skip
def test_sizes_are_shown_in_units_of_their_size(value, unit, shown):
    assert written.shown(value, unit) == (pytest.approx(shown[0]), shown[1])


def test_intervals_widen_from_a_spread_of_1_2_on():
    assert written.widening(1.19) == 1.0 and written.widening(1.2) == 1.2
    assert written.interval_95(2.0, 0.5, 2.0) == pytest.approx([0.04, 3.96])
    low, high = written.interval_95(2.0, 0.5, 2.0, of_logarithm=True)
    assert high / 2.0 == pytest.approx(2.0 / low) and high == pytest.approx(2.0 * np.exp(2.0 * 1.96 * 0.25))


def diagnosis(spread=1.0, **ladder):
    return SimpleNamespace(ladder=SimpleNamespace(estimates_spread=spread, **ladder))


def test_a_limit_is_the_least_of_its_places_and_those_of_one_place_are_physical():
    limits = {("temperature_bias", 4.0): 1.5, ("temperature_bias", 20.0): 0.9, ("phase_offset", None): 0.5,
              ("temperature_bias", 40.0): 1.2, ("temperature_bias", 50.0): 7.0}  # fmt: skip
    assert report._limits(diagnosis(1.5, limits=limits)) == {
        "temperature_bias": {
            "value": pytest.approx(1.35), "unit": "K", "confined_to": "temperature_C",
            "places": {"4.0": pytest.approx(2.25), "20.0": pytest.approx(1.35), "40.0": pytest.approx(1.8)},
        },
        "phase_offset": {"value": pytest.approx(0.75), "unit": "deg"},
    }  # fmt: skip
    name = "offset of one specimen"
    odd = [
        Odd(Candidate(CAUSES[name], place, (size,)), 0.1)
        for place, size in (("A", 2.0), ("B", 1.0), ("C", 21.0))
    ]
    assert report._limits_of_one_place(diagnosis(1.5, smallest=odd)) == {
        name: {
            "value": 1.5, "unit": "deg",
            "places": [{"specimen": one, "temperature_C": None, "value": v} for one, v in (("A", 3.0), ("B", 1.5))],
        }
    }  # fmt: skip
    estimates = {("phase_offset", None): (1.0, 0.2), ("temperature_bias", 4.0): (-2.0, 0.5)}
    assert report._estimates(diagnosis(estimates=estimates)) == {
        "phase_offset": {"places": {"all": {"value": 1.0, "std_error": 0.2, "unit": "deg"}}},
        "temperature_bias": {"places": {"4.0": {"value": -2.0, "std_error": 0.5, "unit": "K"}}},
    }


@pytest.mark.parametrize(("z", "told"), [([9.0, 3.1, 2.9], [9.0, 3.1]), ([2.0, 1.0, 0.5], [2.0])])
def test_conditions_beyond_three_deviations_are_told_or_the_largest(z, told, monkeypatch):
    """Largest first; then tests set aside, by the larger part of what the law leaves of them."""
    mean = np.array([0.01 + 0.02j, 0.03, 0.04])
    monkeypatch.setattr(report, "cell_residuals", lambda _: (mean, np.array(z)))
    predicted = np.array([0.5 + 0.1j, 0.2 + 0.3j])
    monkeypatch.setattr(report, "Joint", lambda *_: SimpleNamespace(predict=lambda _: predicted))
    tests = SimpleNamespace(
        cell=np.array([2, 0, 1]), isotherm=np.array([20.0, 0.0, 10.0]), frequency=np.array([3.0, 1.0, 2.0])
    )
    aside = SimpleNamespace(
        size=2, logarithm=predicted + np.array([0.06 - 0.01j, -0.01 + 0.02j]), names=("A", "B"),
        specimen=np.array([1, 0]), isotherm=np.array([5.0, 6.0]), frequency=np.array([7.0, 8.0]),
    )  # fmt: skip
    found = SimpleNamespace(
        observed=tests, verdict="unexplained_structure", set_aside=aside, noise=SimpleNamespace(sigma=(0.02, 0.01)),
        ladder=SimpleNamespace(joint=SimpleNamespace(base=None, noise=None), fitted=None),
    )  # fmt: skip
    *conditions, first, second = report._unexplained(found)
    assert [one["z"] for one in conditions] == told
    names = "temperature_C", "frequency_Hz", "residual_E_percent", "residual_phase_deg"
    assert [conditions[0][name] for name in names] == pytest.approx([0.0, 1.0, 1.0, np.degrees(0.02)])
    assert (first["specimen"], first["frequency_Hz"], first["z"]) == ("B", 7.0, pytest.approx(3.0))
    assert second["specimen"] == "A" and second["residual_E_percent"] == pytest.approx(-1.0)
    assert second["z"] == pytest.approx(2.0)
    found.verdict, aside.size = "explained", 0
    assert report._unexplained(found) == []


def test_the_power_at_a_multiple_of_a_limit_is_that_of_a_normal_score():
    """Found where it exceeds 3.7 standard errors; at the limit it has 5.345."""
    drawn = np.random.default_rng(1).standard_normal(400_000)
    for multiple in (0.5, 0.8, 1.0):
        assert stated_power(multiple) == pytest.approx(np.mean(drawn + multiple * 5.345 > 3.7), abs=3e-3)
