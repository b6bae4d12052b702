"""Sentences of the verdict: which tests can be used, what they carry, what the law misses."""

import pytest
from test_sentences import content

from asphalt_nscd.diagnosis import verdict
from asphalt_nscd.diagnosis.unexplained import left
from asphalt_nscd.diagnosis.verdict import mixes, on_data, on_simulation


def structure_left():
    """What stays on a table that no cause explains to within scatter."""
    return {
        "verdict": "unexplained_structure",
        "tested": True,
        "numerics": {"largest_modulus_percent": 0.1},
        "scatter": {"modulus_percent": 1.0, "from_replicates": True},
        "largest_pattern_left": None,
        "lack_of_fit_p_value": 1e-9,
    }


@pytest.mark.parametrize(
    "specimens,replicated,said",
    [
        (["A"], False, "One specimen cannot judge a law: nothing was found, but the scatter from test to "
         "test is not known. Test a second one at the same conditions, or state the scatter."),
        (["A", "B"], False, "Specimens without a common temperature and frequency cannot judge a law"),
        (["A", "B"], True, "Two frequencies cannot judge a law"),
    ],
)  # fmt: skip
def test_what_cannot_judge_the_simulation_says_why_and_what_to_add(specimens, replicated, said):
    found = content(0, 0, verdict="nothing_to_explain", tested=False, provenance={"scatter_stated": None})
    found |= {"ladder": [], "reading": {"specimens": specimens}, "scatter": {"from_replicates": replicated}}
    assert on_simulation(found).startswith(said)


def spread(percent, phase):
    return {"repeatability": {"between": {"E_percent": percent, "phase_deg": phase}}}


def test_specimens_that_are_hardly_of_one_mix_are_the_first_sentence():
    found = content(0, 0, tests=72) | {"ladder": []}
    two = found | spread(32.9, 2.8)
    assert mixes(two) == (
        "Specimens scatter by 32.9 % in |E*| and 2.8 deg in phase, more than those of one mix do: are there two mixes? "
        "Then diagnose each alone."
    )
    assert on_data(two) == "All 72 tests can be used."
    one = found | spread(3.3, 0.2)
    assert mixes(one) == "" == mixes(found)
    assert on_data(one) == (
        "All 72 tests can be used. Specimens scatter by 3.3 % in |E*| and 0.2 deg in phase."
    )


@pytest.mark.parametrize(
    "where,sure,said",
    [
        (None, True, "All tests show a phase offset of 1.5 +- 0.2 deg: subtract 1.5 deg from their phases."),
        (None, False, "Perhaps all tests show a phase offset of 1.5 +- 0.2 deg (not certain; the reason is below)."),
        (21.0, True, "The tests at 21 degC show a phase offset of 1.5 +- 0.2 deg: subtract 1.5 deg from their phases."),
        ("A", False, "Perhaps specimen A shows a phase offset of 1.5 +- 0.2 deg (not certain; the reason is below)."),
    ],
)  # fmt: skip
def test_a_fault_is_told_as_surely_as_it_is_known(where, sure, said):
    offset = {"value": 1.5, "std_error": 0.1, "unit": "deg"}
    rung = {
        "cause": "phase_offset",
        "where": where,
        "parameters": {"phase_offset": offset},
        "established": sure,
    }
    corrected = " after correction" if sure and where is None else ""
    assert (
        on_data(content(0, 0, tests=72) | {"ladder": [rung]})
        == f"All 72 tests can be used{corrected}. {said}"
    )


@pytest.mark.parametrize(
    "after,said",
    [
        ({"E": 3.2, "phase": 20.0}, ""),
        ({"E": 21.9, "phase": 20.0}, " That is more than before in |E*|: do not use this law."),
        ({"E": 21.9, "phase": 40.9}, " That is more than before in |E*| and the phase: do not use this law."),
        ({"E": 10.6, "phase": 30.1}, ""),
    ],
)
def test_a_law_that_misses_more_than_before_is_not_to_be_used(after, said):
    errors = {
        "mre_E_percent": {"before": 10.5, "after": 1.0},
        "mre_phase_percent": {"before": 30.0, "after": 1.0},
    }
    rung = {
        "cause": "relaxation_spectrum",
        "where": None,
        "gain": {"in_sample": {"averages_by_temperature": {"20": errors}}},
    }
    found = {
        "ladder": [rung],
        **structure_left(),
    }
    assert on_simulation(found, after).endswith(
        f"more than scatter within specimens can explain, and no cause was found.{said}"
    )


@pytest.mark.parametrize("burgers,law", [(10.5, verdict.SIMPLER), (7.0, verdict.COMMON)])
def test_a_ladder_without_a_spectrum_says_which_law_it_begins_with(burgers, law):
    """Of one specimen no spectrum is told, but its causes are judged beside one."""
    errors = {name: {"before": 10.5, "after": 1.0} for name in ("mre_E_percent", "mre_phase_percent")}
    found = {
        "ladder": [
            {
                "cause": "phase_offset",
                "where": None,
                "gain": {"in_sample": {"averages_by_temperature": {"20": errors}}},
            }
        ],
        "baseline": {"mre_E_percent": {"20": burgers}},
        **structure_left(),
    }
    assert on_simulation(found) == (
        f"{law}, with a phase offset, misses the mean of the specimens by 1 % of |E*| and 1 % of the phase, more than "
        "scatter within specimens can explain. Without this cause by 10.5 % and 10.5 %."
    )
    found["scatter"]["from_replicates"] = False
    assert on_simulation(found).startswith(f"{law}, with a phase offset, misses the tests by 1 % of |E*|")
    alone = found | {"tested": False, "provenance": {"scatter_stated": None}}
    assert "% of the phase, and nobody knows how much of that is scatter. Without" in on_simulation(alone)


@pytest.mark.parametrize(
    "exceeded,said",
    [
        (
            36,
            " 36 of 72 exceed the limit of phase uniformity (3 deg): 30 of specimen A and 6 of specimen B. "
            "So the gauges and the ends of the specimens are in doubt.",
        ),
        (35, ""),
    ],
)
def test_a_quality_limit_that_half_of_the_tests_exceed_stands_in_the_verdict(exceeded, said):
    above = [{"column": "phase_uniformity_deg", "specimen": "A" if k < 30 else "B"} for k in range(exceeded)]
    reading = {"limits_exceeded": above}
    found = content(0, 0, tests=72, reading=reading) | {"ladder": []}
    assert on_data(found) == f"All 72 tests can be used.{said}"
    some = found | {"trust": {"use": 36, "check": 36, "not_used": 0, "use_by_specimen": {"A": 10, "B": 26}}}
    pass_them = "36 of 72 tests pass the limits of the standard"
    assert on_data(some).startswith(f"{pass_them}; 36 are" if said else "36 of 72 tests can be used; 36 are")
    of_one = some | {"trust": some["trust"] | {"use_by_specimen": {"A": 0, "B": 36}}}
    assert (f"{pass_them}, and all 36 are of specimen B; 36 are" in on_data(of_one)) == bool(said)


def test_a_fault_of_one_isotherm_stands_in_the_verdict():
    bias = {"value": -3.65, "std_error": 0.66, "unit": "K"}
    rung = {"cause": "temperature_bias", "where": 24.0, "established": False, "parameters": {"bias": bias}}
    assert on_data(content(0, 0, tests=72) | {"ladder": [rung]}) == (
        "All 72 tests can be used. Perhaps the tests at 24 degC show a temperature bias of -3.65 +- 1.3 K (not "
        "certain; the reason is below)."
    )
    left_in = rung | {"taken_off": False}
    assert on_data(content(0, 0, tests=72) | {"ladder": [left_in]}).endswith(
        " (not certain, and left in the data; the reason is below)."
    )


def test_what_all_tests_share_is_not_at_a_place():
    found = {"discrepancy": {"all tests, phase": 1.0}, "scatter": {"phase_deg": 0.5}}
    assert left(found) == ["0.5 deg in the phase of all tests"]


@pytest.mark.parametrize(
    "use,check,out,said",
    [
        (72, 0, 0, "All 72 tests can be used."),
        (
            65,
            6,
            1,
            "65 of 72 tests can be used; 6 are doubtful: use them only after a check (the law here is fitted with "
            "them); 1 not to be used (specimen A, 4 degC, 25 Hz).",
        ),
        (71, 0, 1, "71 of 72 tests can be used; 1 not to be used (specimen A, 4 degC, 25 Hz)."),
        (
            0,
            72,
            0,
            "None of 72 tests can be used; 72 are doubtful: use them only after a check (the law here is fitted "
            "with them).",
        ),
    ],
)
def test_how_far_each_test_can_be_used_is_one_answer(use, check, out, said):
    found = content(0, out, tests=72 - out, trust={"use": use, "check": check, "not_used": out}) | {
        "ladder": []
    }
    assert on_data(found) == said


def test_what_to_check_and_what_is_missing_stands_in_the_verdict():
    odd = [{"specimen": "A", "temperature_C": 35.0, "factor": 0.7}]
    broken = [{"temperature_C": 54.0, "sentence": "x"}]
    found = content(0, 0, tests=72, odd_levels=odd, contradictory_isotherms=broken)
    found |= {"ladder": [], "reading": {"not_tested": ["specimen B at 4 degC"]}}
    assert on_data(found) == (
        "All 72 tests can be used. Specimen A at 35 degC: |E*| 0.70 times what its other temperatures and the other "
        "specimens say: check gauges, gain, unit and entered dimensions of these tests. At 54 degC modulus and "
        "phase contradict each other: check strain and machine there. Specimen B at 4 degC has no test here."
    )


@pytest.mark.parametrize(
    "coldest,inner,told,where",
    [
        (9.0, 8.0, "", ""),
        (
            58.3,
            8.0,
            "58 % at -4 degC, 9 % at 37 degC and 8 % at 21 degC.",
            "beyond the tested temperatures",
        ),
        (
            9.0,
            17.1,
            "9 % at -4 degC, 9 % at 37 degC and 17 % at 21 degC.",
            "at temperatures that were not tested",
        ),
    ],
)
def test_a_law_that_predicts_badly_is_warned_of(coldest, inner, told, where):
    """Between the tested temperatures, or only beyond them."""
    by = {
        t: {name: {"before": 2.0, "after": error} for name in ("mre_E_percent", "mre_phase_percent")}
        for t, error in (("37", 9.0), ("-4", coldest), ("21", inner))
    }
    held_out = {"leave_one_isotherm_out": {"averages_by_temperature": by}}
    found = {"ladder": [{"gain": {"in_sample": {}, "held_out": held_out}}]}
    said = " ".join(verdict.beyond_the_tests(found))
    assert said.endswith(told) and bool(said) == bool(told)
    assert verdict._predicted_badly(found) == where
    one = {"leave_one_isotherm_out": {"averages_by_temperature": {"21": by["21"]}}}
    alone = verdict.beyond_the_tests({"ladder": [{"gain": {"in_sample": {}, "held_out": one}}]})
    assert bool(alone) == (inner > 10.0)  # one temperature is both ends
    assert verdict.beyond_the_tests({"ladder": []}) == []
    assert verdict.predicts_badly(held_out["leave_one_isotherm_out"], inner=True) == (inner > 10.0)


def test_causes_of_a_bench_that_nobody_stated_do_not_lead_the_verdict():
    mass = {"value": -0.227, "std_error": 0.01, "unit": "kg"}
    rung = {"cause": "moving_mass", "where": None, "parameters": {"mass": mass}}
    found = content(0, 0, tests=72) | {"ladder": [rung]}
    assert "moving mass" in on_data(found)
    assert on_data(found | {"reading": {"bench_assumed": True}}) == "All 72 tests can be used."


@pytest.mark.parametrize(
    "cause,where,value,unit,told",
    [
        ("channel_delay", None, 0.8e-3, "s", "subtract 0.288 deg per Hz from their phases"),
        ("temperature_bias", 20.0, 1.84, "K", "enter 21.8 degC for them"),
        ("moving_mass", None, 0.1, "kg", "correct them for it"),
        ("loose_clamp", "A", 3e-12, "1/Pa", "correct its tests for it"),
        ("specimen_geometry", "A", 0.358, "1", "if its dimensions prove wrong, divide its |E*| by 1.36"),
    ],
)
def test_how_to_be_rid_of_a_fault_is_told(cause, where, value, unit, told):
    rung = {
        "cause": cause,
        "where": where,
        "parameters": {"size": {"value": value, "std_error": None, "unit": unit}},
    }
    assert on_data(content(0, 0, tests=72) | {"ladder": [rung]}).endswith(f": {told}.")


def test_a_table_without_quality_columns_is_said_to_be_judged_by_its_curves_alone():
    reading = {"test_type": "tension-compression", "quality_columns": [], "isotherms_C": [4.0, 21.0]}
    found = content(0, 0, tests=72, reading=reading) | {"ladder": []}
    assert on_data(found) == (
        "All 72 tests can be used; judged by modulus and phase alone, for there are no quality columns."
    )
    flagged = found | {"reading": reading | {"quality_columns": ["phase_uniformity_deg"]}}
    some = flagged | {"trust": {"use": 60, "check": 12, "not_used": 0, "use_by_specimen": {"A": 30, "B": 30}}}
    assert on_data(some).startswith(
        "60 of 72 tests can be used; 12 are doubtful: use them only after a check"
    )
    assert on_data(flagged) == on_data(found | {"reading": {}}) == "All 72 tests can be used."


def test_an_error_of_temperature_is_told_with_the_isotherm_that_fits_as_well():
    bias = {"value": -3.0, "std_error": 0.18, "unit": "K"}
    rung = {"cause": "temperature_bias", "where": 38.0, "established": False, "parameters": {"bias": bias}}
    rivals = ["temperature_bias @ 50.0", "damage"]
    said = on_data(content(0, 0, tests=72) | {"ladder": [rung | {"as_good": rivals}]})
    assert "of -3 +- 0.35 K (not certain; temperature bias at 50 degC fits as well)." in said


def test_what_to_do_first_is_told_with_its_hours_and_its_reason():
    order = {
        "text": "0.6 h: test metal, 0.1 and 25 Hz.",
        "why": ["32 of 54 lie above. Metal has none.", "More."],
        "hours": 0.6,
    }
    again = {"text": "2.5 h: test specimen A again.", "why": ["It is odd."], "hours": 2.5}
    both = {"instructions": {"orders": [order, again]}}
    assert verdict.first_order(both) == "First: test metal, 0.1 and 25 Hz (0.6 h). 32 of 54 lie above."
    assert verdict.then(both) == ["Then, 2.5 h: test specimen A again."]
    at_once = order | {"text": "0.0 h: run this again.", "hours": 0.0}
    assert verdict.first_order({"instructions": {"orders": [at_once]}}).startswith(
        "First: run this again. 32"
    )
    nothing = {"instructions": {"orders": []}}
    assert verdict.first_order(nothing) == verdict.first_order({}) == ""
    assert verdict.then(nothing) == verdict.then({}) == []
