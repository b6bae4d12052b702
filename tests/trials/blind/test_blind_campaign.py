"""The plan holds what the campaign promises, and its tables count what the seals say."""

from collections import Counter
from itertools import chain

import numpy as np
import pandas as pd
import pytest
from blind import plan, tables
from blind.causes import CATALOGUE
from blind.laws import SHAPES
from blind.outside import OUTSIDE
from blind.plan import JUDGED, Case

ALL = list(chain.from_iterable(plan.chunks()))


def test_plan_holds_every_cause_at_every_ratio_pairs_outside_and_empty_cases():
    suites = Counter(case.suite for case in ALL)
    assert len(ALL) >= 400 and suites["limits"] + suites["empty"] >= 150 and suites["pair"] >= 30
    for cause in CATALOGUE:
        shapes = {case.shape for case in ALL if case.hidden == (cause,)}
        assert shapes == set(SHAPES)
        for ratio in plan.RATIOS:
            assert sum(case.hidden == (cause,) and case.ratio == ratio for case in ALL) >= 10
    assert {case.hidden[0] for case in ALL if case.suite == "outside"} == set(OUTSIDE)
    assert sum(case.form == "records" for case in ALL) >= 30


def test_cases_of_a_seed_stay_together_after_the_empty_one_that_scales_them():
    for part in plan.chunks():
        for n, case in enumerate(part):
            if case.needs_limits:
                first = next(k for k, other in enumerate(part) if other.seed == case.seed)
                assert part[first].suite == "limits" and first < n
    seeds = [case.seed for case in ALL if case.suite in ("limits", "empty")]
    assert len(set(seeds)) == len(seeds)


def test_another_seed_draws_other_cases():
    assert not {case.seed for case in ALL} & {case.seed for part in plan.chunks(1) for case in part}


def line(suite, hidden, named, verdict, ratio=JUDGED, kind="catalogue", covered=True):
    effects = [
        {
            "cause": cause,
            "kind": kind,
            "where": None,
            "amplitude": 1.0,
            "unit": "s",
            "equivalents": {"s": 1.0},
            "strength": 1.0,
            "ratio": ratio,
        }
        for cause in hidden
    ]
    error = {
        "mre_E_percent": {"before": 2.0, "after": 1.0},
        "mre_phase_percent": {"before": 1.0, "after": 1.5},
        "rms_over_scatter": {"before": 2.0, "after": 1.0},
        "averages_by_temperature": {
            t: {
                "mre_E_percent": {"before": 1.0, "after": 1.0},
                "mre_phase_percent": {"before": 1.0, "after": size},
            }
            for t, size in (("0", 0.5), ("10", 2.5))
        },
    }
    ladder = [
        {
            "cause": cause,
            "where": None,
            "gain": {"in_sample": error, "held_out": {"frequency": error}},
            "parameters": {"delay": {"value": 1.1 if covered else 2.0, "std_error": 0.1, "unit": "s"}},
        }
        for cause in named
    ]
    case = Case(1, suite, tuple(hidden), ratio, shape="huet_sayegh")
    seal = {"seed": 1, "effects": effects}
    diagnosis = {"verdict": verdict, "ladder": ladder, "indistinguishable": [], "detection_limits": {}}
    return {"case": vars(case), "seal": seal, "diagnosis": diagnosis}


@pytest.fixture
def opened():
    explained, structure = "explained", "unexplained_structure"
    delay, offset = ["channel_delay"], ["phase_offset"]
    return tables.cases(
        [
            *[line("single", delay, delay, explained)] * 8,
            line("single", delay, offset, explained),
            line("single", delay, [], explained),
            line("single", delay, delay, explained, covered=False),
            *[line("limits", [], [], explained, np.nan)] * 9,
            line("empty", [], delay, explained, np.nan),
            line("outside", ["specimen_phase"], [], structure, kind="outside"),
            line("outside", ["specimen_phase"], delay, explained, kind="outside"),
            line("removal", delay, [], structure),
            line("removal", delay, offset, explained),
            line("single", delay, [], explained, ratio=1.0),
        ]
    )


def test_rates_are_those_of_the_seals(opened):
    rates = tables.summary(opened).set_index("what")["percent"]
    at = "at 3 times the limit"
    assert rates[f"found, {at}"] == pytest.approx(100 * 10 / 11, abs=0.05)
    assert rates[f"named rightly among the found, {at}"] == pytest.approx(90.0)
    assert rates["false alarms of empty cases"] == pytest.approx(10.0)
    assert rates[f"outside the catalogue: unexplained, {at}"] == 50.0
    assert rates[f"outside the catalogue: confident wrong name, {at}"] == 50.0
    assert rates["amplitude within its 95 % interval"] == pytest.approx(100 * 8 / 9, abs=0.05)
    assert rates["held-out error of single tests falls where named"] == 100.0
    assert rates["the same of averages over specimens, for causes that reach all of them"] == 0.0
    met = tables.summary(opened).set_index("what")["met"]
    assert (
        met["held-out error of single tests falls where named"] == "yes"
        and met["false alarms of empty cases"] == "no"
    )


def test_averages_judge_no_cause_of_one_specimen(opened):
    """The clamp of one specimen in four leaves the average where it was; an error of temperature moves it."""
    rows = opened[opened["gain_of_averages"].notna()]
    one = rows.assign(cause="loose_clamp", where="A", gain_of_averages=-0.01)
    every = rows.assign(cause="temperature_bias", where="20.0", gain_of_averages=0.5)
    rest = opened[opened["suite"].isin(("removal", "outside"))]
    told = tables.summary(pd.concat([one, every, rest])).set_index("what")
    judged = told.loc["the same of averages over specimens, for causes that reach all of them"]
    assert (judged["percent"], judged["of"], judged["met"]) == (100.0, len(every), "yes")
    reported = told.loc["the same for causes of one specimen, which averages hide"]
    assert (reported["percent"], reported["of"], reported["met"]) == (0.0, len(one), "")


def test_removal_and_efficiency_are_counted_apart(opened):
    removed = tables.removal(opened).set_index("cause").loc["channel_delay"]
    assert removed["n"] == 2 and removed["unexplained"] == removed["confidently_named"] == 0.5
    found = tables.efficiency(opened).set_index(["cause", "ratio"])["found"]
    assert found["channel_delay", 1.0] == 0.0 and found["all", 3.0] == pytest.approx(10 / 11)
    isolation = tables.isolation(opened).set_index("cause")
    assert isolation.loc["channel_delay", "phase_offset"] == 1 and isolation.loc["nothing", "nothing"] == 9
