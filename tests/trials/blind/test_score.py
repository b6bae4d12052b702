"""The scorer on diagnoses written by hand."""

import numpy as np
import pytest
from blind.generator import Hidden, draw
from blind.score import (
    ELSEWHERE,
    NOTHING,
    TRUE_OF_ALL,
    UNEXPLAINED,
    clopper_pearson,
    efficiency,
    isolation_matrix,
    outcomes,
    summary,
)
from scipy.stats import binom

DELAY, CLAMP = "channel_delay", "loose_clamp"


def entry(cause, value=1.0, unit="ms", where=None, std_error=0.1, gain=2.0):
    errors = {name: {"before": gain, "after": 1.0} for name in ("mre_E_percent", "mre_phase_percent")}
    parameters = {"amplitude": {"value": value, "std_error": std_error, "unit": unit}}
    return {
        "cause": cause,
        "where": where,
        "parameters": parameters,
        "gain": {"held_out": {"leave_one_isotherm_out": errors, "leave_one_frequency_out": errors}},
    }


def diagnosis(*entries, verdict="explained", groups=()):
    limits = {DELAY: {"value": 0.1, "unit": "ms"}}
    spectrum = {"cause": TRUE_OF_ALL, "where": None}
    return {
        "verdict": verdict,
        "ladder": [spectrum, *entries],
        "indistinguishable": list(groups),
        "detection_limits": limits,
    }


def seal(*hidden):
    return draw(1, hidden).seal


LATE = seal(Hidden(DELAY, amplitude=3e-4, sign=1))
LOOSE = seal(Hidden(CLAMP, amplitude=5e-8, where="B"))
STEP = seal(Hidden("modulus_step", strength=10.0))
EMPTY = seal()


def only(a_seal, a_diagnosis):
    return outcomes([(a_seal, a_diagnosis)]).iloc[0]


def test_a_rightly_named_cause():
    row = only(LATE, diagnosis(entry(DELAY, 0.35)))
    assert (
        row["outcome"] == DELAY and row["named"] and row["found"] and not row["grouped"] and row["wrong"] == 0
    )
    assert row["ratio"] == pytest.approx(3.0) and row["error_sigma"] == pytest.approx(0.5)
    assert row["covered"] and row["gained"]
    assert not only(LATE, diagnosis(entry(DELAY, 0.55)))["covered"]
    assert not only(LATE, diagnosis(entry(DELAY, 0.35, gain=0.9)))["gained"]


def test_the_wrong_sign_is_not_covered():
    assert not only(LATE, diagnosis(entry(DELAY, -0.3)))["covered"]


def test_an_unknown_unit_is_refused():
    with pytest.raises(ValueError, match="furlong"):
        only(LATE, diagnosis(entry(DELAY, unit="furlong")))


def test_the_place_counts():
    right, wrong = (diagnosis(entry(CLAMP, 5e-8, "m/N", where=w)) for w in "BC")
    assert only(LOOSE, right)["named"]
    assert not only(LOOSE, diagnosis(entry(CLAMP, 5e-8, "m/N")))["named"]
    assert not only(LATE, diagnosis(entry(DELAY, where="B")))["named"]
    row = only(LOOSE, wrong)
    assert not row["named"] and row["outcome"] == ELSEWHERE and row["wrong"] == 1
    bias = seal(Hidden("temperature_bias", amplitude=1.0, where=10.0))
    assert only(bias, diagnosis(entry("temperature_bias", 1.0, "K", where="10")))["named"]


def test_a_group_that_holds_truth_and_name_counts():
    grouped = diagnosis(entry("moving_mass", unit="kg"), groups=[["moving_mass", DELAY]])
    row = only(LATE, grouped)
    assert row["named"] and row["grouped"] and row["wrong"] == 0 and row["covered"] is None
    assert not only(LATE, diagnosis(entry("moving_mass", unit="kg"), groups=[["moving_mass", CLAMP]]))[
        "named"
    ]


def test_a_group_names_places():
    right, wrong = (diagnosis(entry(DELAY), groups=[[DELAY, f"{CLAMP} @ {w}"]]) for w in "BC")
    assert only(LOOSE, right)["named"] and not only(LOOSE, wrong)["named"]
    bias = seal(Hidden("temperature_bias", amplitude=1.0, where=10.0))
    assert only(bias, diagnosis(entry(DELAY), groups=[["temperature_bias @ 10.0", DELAY]]))["named"]
    # The named clamp sits on another specimen than the one in the group.
    other = diagnosis(entry(CLAMP, unit="m/N", where="A"), groups=[[f"{CLAMP} @ C", DELAY]])
    assert not only(LATE, other)["named"]


def test_limits_of_a_place_come_before_the_least_one():
    limited = diagnosis()
    limited["detection_limits"][CLAMP] = {"value": 1e-8, "unit": "m/N", "places": {"A": 1e-8, "B": 2e-8}}
    assert only(LOOSE, limited)["ratio"] == pytest.approx(2.5)


def test_nothing_held_out_is_no_gain_and_no_loss():
    short = entry(DELAY, 0.3)
    short["gain"]["held_out"] = {}
    assert only(LATE, diagnosis(short))["gained"] is None


def test_what_is_not_named():
    assert only(LATE, diagnosis(verdict=UNEXPLAINED))["outcome"] == UNEXPLAINED
    assert only(LATE, diagnosis())["outcome"] == NOTHING and not only(LATE, diagnosis())["found"]
    assert only(LATE, diagnosis(entry("phase_offset", unit="deg")))["outcome"] == "phase_offset"


def test_the_spectrum_is_no_false_alarm_and_every_other_name_is():
    assert only(EMPTY, diagnosis())["wrong"] == 0
    assert only(EMPTY, diagnosis(entry(DELAY)))["wrong"] == 1


def test_in_pairs_each_effect_is_judged_and_the_other_s_name_is_not_wrong():
    both = seal(Hidden(DELAY, amplitude=3e-4, sign=1), Hidden(CLAMP, amplitude=5e-8, where="B"))
    table = outcomes([(both, diagnosis(entry(DELAY, 0.3)))])
    assert table["named"].tolist() == [True, False] and table["wrong"].tolist() == [0, 0]
    assert table["outcome"].tolist() == [DELAY, NOTHING] and set(table["suite"]) == {"pair"}


def test_a_name_given_as_established_is_a_confident_one_whatever_is_left():
    sure = entry(DELAY) | {"established": True}
    doubted = entry(DELAY) | {"established": False}
    for one, confident in ((sure, 1), (doubted, 0)):
        table = outcomes([(STEP, diagnosis(one, verdict=UNEXPLAINED))])
        assert table["wrong"].tolist() == [1] and table["confident"].tolist() == [confident]
        figures = summary(table)
        assert figures["outside_confidently_named"]["hits"] == confident
        assert figures["outside_unexplained"]["hits"] == 1 - confident


def test_summary_efficiency_and_matrix():
    named, missed = diagnosis(entry(DELAY, 0.3)), diagnosis()
    cases = (
        [(LATE, named)] * 3 + [(LATE, missed)] + [(EMPTY, missed)] * 9 + [(EMPTY, diagnosis(entry(DELAY)))]
    )
    cases += [(STEP, diagnosis(verdict=UNEXPLAINED))] * 4 + [(STEP, named)] * 2
    cases += [(STEP, diagnosis(entry(DELAY), verdict=UNEXPLAINED))]
    table = outcomes(cases)
    figures = summary(table)
    assert figures["found"]["rate"] == 0.75 and figures["named"]["rate"] == 1.0
    assert figures["false_alarm"]["hits"] == 1 and figures["false_alarm"]["n"] == 10
    assert figures["outside_unexplained"]["hits"] == 5 and figures["outside_unexplained"]["n"] == 7
    assert figures["outside_named"]["hits"] == 3 and figures["outside_confidently_named"]["hits"] == 2
    assert figures["covered"] == figures["gained"] and figures["covered"]["n"] == 3
    curve = efficiency(table)
    assert curve[["cause", "ratio", "n", "found"]].values.tolist() == [[DELAY, 3.0, 4, 0.75]]
    matrix = isolation_matrix(table)
    assert matrix.loc[DELAY, DELAY] == 3 and matrix.loc[DELAY, NOTHING] == 1
    assert matrix.loc["modulus_step", UNEXPLAINED] == 4 and matrix.loc[NOTHING, DELAY] == 1


def test_clopper_pearson_bounds_leave_the_stated_tails():
    low, high = clopper_pearson(3, 100)
    assert binom.sf(2, 100, low) == pytest.approx(0.025) and binom.cdf(3, 100, high) == pytest.approx(0.025)
    assert clopper_pearson(0, 60)[0] == 0.0 and clopper_pearson(60, 60)[1] == 1.0
    assert clopper_pearson(0, 60)[1] == pytest.approx(1 - 0.025 ** (1 / 60))
    assert np.all(np.array(clopper_pearson(0, 0)) == (0.0, 1.0))
