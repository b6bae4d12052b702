"""Sentences on tests that are doubtful, and on what another choice of tests would name."""

import pytest

from asphalt_nscd.diagnosis import sentences, verdict
from asphalt_nscd.diagnosis.fixed_orders import named
from asphalt_nscd.diagnosis.sentences import (
    cause_words,
    causes,
    law_of_the_mix,
    left,
    on_doubtful,
    with_suspects,
)
from asphalt_nscd.diagnosis.verdict import mixes, on_data, on_simulation


def content(used: int, out: int, **then):
    tests = [{"specimen": "A", "temperature_C": 4.0, "frequency_Hz": 25.0, "reasons": ["x"]}] * (used + out)
    suspect = [{**one, "used": k < used} for k, one in enumerate(tests)]
    ladder = [{"cause": "phase_offset", "where": None}]
    return {"suspect_tests": suspect, "ladder": ladder, **then}


@pytest.mark.parametrize(
    "used,out,told",
    [
        (0, 2, ""),
        (1, 1, "Doubtful but used: specimen A, 4 degC, 25 Hz (x)."),
        (
            5,
            0,
            f"Doubtful but used: {'specimen A, 4 degC, 25 Hz (x); ' * 3}and 2 more, see suspect_tests "
            "in diagnosis.json.",
        ),
    ],
)
def test_doubtful_tests_are_named(used, out, told):
    assert on_doubtful(content(used, out)) == told


@pytest.mark.parametrize(
    "named,changed",
    [
        (
            [{"cause": "phase_offset", "where": None}],
            "If it were left out, the diagnosis would name the same causes.",
        ),
        ([], "If it were left out, the diagnosis would no longer name a phase offset."),
        (
            [{"cause": "phase_offset", "where": None}, {"cause": "channel_delay", "where": None}],
            "If it were left out, the diagnosis would also name a channel delay.",
        ),
        (
            [{"cause": "loose_clamp", "where": "A"}],
            "If it were left out, the diagnosis would name a loose clamp of specimen A and no longer "
            "name a phase offset.",
        ),
    ],
)
def test_what_is_named_without_the_doubtful_tests_is_told(named, changed):
    then = {"verdict": "explained", "causes": named}
    assert on_doubtful(content(1, 0, without_doubtful=then)).endswith(f"(x). {changed}")
    assert with_suspects(content(1, 1, with_suspects=then)) == changed.replace(
        "If it were left out", "If these tests were kept"
    )


def test_a_bench_that_nobody_stated_is_said_with_what_hangs_on_it():
    read = {"test_type": "bending", "specimens": ["A", "B"], "isotherms_C": [4.0, 20.0]}
    mass = {"value": -0.227, "std_error": 0.01, "unit": "kg"}
    rung = {
        "cause": "moving_mass",
        "where": None,
        "parameters": {"moving_mass": mass},
        "p_value": 1e-9,
        "as_good": [],
        "confirmed_by": "weighing it",
    }
    stated, assumed = ({"ladder": [rung], "reading": read | more} for more in ({}, {"bench_assumed": True}))
    assert (
        verdict.test_type(stated) == "two-point bending of a trapezoidal specimen, 2 specimens, 4 and 20 degC"
    )
    assert verdict.test_type(assumed) == (
        "taken for two-point bending of the paper's specimen, since neither --measured-in nor --geometry was given; "
        "for a cylinder give --measured-in tension-compression. 2 specimens, 4 and 20 degC"
    )
    (plain,), (conditional,) = causes(stated), causes(assumed)
    assert conditional[0] == f"{plain[0]}, if this was two-point bending"
    offset = rung | {"cause": "phase_offset"}
    assert "bending" not in causes(assumed | {"ladder": [offset]})[0][0]


def test_the_same_causes_in_another_order_are_the_same():
    found = content(0, 1, with_suspects={"verdict": "explained", "causes": []})
    found["ladder"] = [{"cause": name, "where": None} for name in ("phase_offset", "channel_delay")]
    found["with_suspects"]["causes"] = found["ladder"][::-1]
    assert with_suspects(found) == "If these tests were kept, the diagnosis would name the same causes."


@pytest.mark.parametrize(
    "hangs_on,as_good,sure",
    [
        (
            ["4 degC", "specimen B"],
            [],
            "Not certain: it is no longer found if 4 degC or specimen B is left out.",
        ),
        (
            ["4 degC"],
            [],
            "Not certain: it is no longer found if 4 degC is left out.",
        ),
        (
            [],
            ["temperature_bias @ 21.0"],
            "Not certain: temperature bias at 21 degC fits as well; these tests do not say which.",
        ),
        (
            [],
            ["loose_clamp @ B"],
            "Not certain: loose clamp at B fits as well; these tests do not say which.",
        ),
    ],
)
def test_why_a_name_is_only_likely(hangs_on, as_good, sure):
    bias = {"value": 8.0, "std_error": 0.4, "unit": "K"}
    rung = {
        "cause": "temperature_bias",
        "where": 4.0,
        "parameters": {"temperature_rise": bias},
        "p_value": 1e-9,
        "as_good": as_good,
        "hangs_on": hangs_on,
        "confirmed_by": "a thermometer",
    }
    ((told, meaning),) = causes({"ladder": [rung]})
    assert told == "temperature bias at 4 degC: 8 K or more (the search ends there)"
    assert meaning.endswith(f"{sure} To confirm it: a thermometer.")


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
        (None, True, "All of them carry a phase offset of 1.5 +- 0.2 deg: subtract 1.5 deg from their phases; "
         "law.json is the law of the mix without it."),
        (None, False, "Perhaps all of them carry a phase offset of 1.5 +- 0.2 deg (not certain; the reason is below); "
         "law.json is the law of the mix without it."),
        (21.0, True, "Those at 21 degC carry a phase offset of 1.5 +- 0.2 deg: subtract 1.5 deg from their phases; "
         "law.json is the law of the mix without it."),
        ("A", False, "Perhaps specimen A carries a phase offset of 1.5 +- 0.2 deg (not certain; the reason is below); "
         "law.json is the law of the mix without it."),
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
    corrected = ", once corrected" if sure and where is None else ""
    assert (
        on_data(content(0, 0, tests=72) | {"ladder": [rung]})
        == f"All 72 tests can be used{corrected}. {said}"
    )


def test_a_specimen_called_specimen_is_not_called_so_twice():
    rung = {"cause": "loose_clamp", "where": "Specimen 1"}
    assert cause_words(rung) == "loose clamp of Specimen 1"
    assert cause_words(rung | {"where": "S1"}) == "loose clamp of specimen S1"
    found = {"specimen Specimen 1, spectrum": 2.0, "specimen S2, modulus": 1.5, "37 degC, phase": 1.0}
    scatter = {"modulus_percent": 1.0, "phase_deg": 0.5}
    assert left({"discrepancy": found, "scatter": scatter}) == [
        "2.0 % in |E*| of Specimen 1: the form of its master curve differs from the common one",
        "1.5 % in |E*| of specimen S2, changing with frequency and temperature",
        "0.5 deg in the phase at 37 degC",
    ]
    few, many = (
        {"reading": {"specimens": [*"ABCDE"][:n]}, "discrepancy": found, "scatter": scatter} for n in (3, 5)
    )
    assert left(few)[3:] == ["Among 3 specimens it is not certain which of them departs"]
    assert left(many)[3:] == left(few | {"discrepancy": {"37 degC, phase": 1.0}})[1:] == []
    assert [named(names) for names in (["Specimen 1", "Specimen 2"], ["A", "B"], ["A"], ["Specimen 1"])] == [
        "Specimen 1 and Specimen 2",
        "specimens A and B",
        "specimen A",
        "Specimen 1",
    ]


def test_a_doubt_and_the_law_of_the_mix_are_told_for_what_they_are():
    size = {"value": 1.5, "std_error": 0.1, "unit": "deg"}
    rung = {
        "cause": "phase_offset",
        "where": None,
        "parameters": {"phase_offset": size},
        "p_value": 1e-9,
        "as_good": [],
        "doubts": ["Beside a smooth error its size is 2.5", "It was found after a name that is in doubt"],
        "confirmed_by": "metal",
    }
    constants = {
        "wlf_C1": size | {"unit": ""},
        "wlf_C2": size | {"value": 173.0, "unit": "K"},
        "reference_temperature": {"value": 20.0, "std_error": None, "unit": "degC"},
    }
    law = rung | {"cause": "relaxation_spectrum", "doubts": [], "parameters": constants, "established": False}
    (doubt,) = causes({"ladder": [law, rung]})
    assert doubt[1].endswith(
        "Not certain: beside a smooth error its size is 2.5. It was found after a name that is in doubt. To confirm "
        "it: metal."
    )
    assert law_of_the_mix({"ladder": [law, rung]}) == (
        "relaxation spectrum: WLF C1 1.5 +- 0.2, WLF C2 173 +- 0.2 K, at 20 degC",
        "Not certain: certainty takes four temperatures, three frequencies and two specimens.",
    )
    assert law_of_the_mix({"ladder": [rung]}) is None


def test_a_rival_that_was_named_too_is_no_alternative():
    size = {"value": 1.5, "std_error": 0.1, "unit": "deg"}
    rung = {
        "cause": "phase_offset",
        "where": None,
        "parameters": {"phase_offset": size},
        "p_value": 1e-9,
        "as_good": ["channel_delay"],
        "confirmed_by": "metal",
    }
    assert "Not certain: channel delay fits as well" in causes({"ladder": [rung]})[0][1]
    both = causes({"ladder": [rung, rung | {"cause": "channel_delay", "as_good": []}]})
    assert "Not certain: before channel delay was named too, that fitted as well. To" in both[0][1]


def test_a_relative_size_is_told_in_percent():
    size = {"value": -0.316, "std_error": 0.07, "unit": "1"}
    rung = {"cause": "specimen_geometry", "where": "A", "parameters": {"relative_modulus": size}}
    assert sentences.size(rung, {}) == "-31.6 +- 14 %"


def test_one_temperature_has_no_slope_over_it():
    found = {
        "verdict": "unexplained_structure", "scatter": {}, "lack_of_fit_p_value": 1e-9,
        "largest_pattern_left": {"pattern": "specimen X, slope over temperature, modulus", "z": 6.18, "p_value": 1e-9},
        "reading": {"isotherms_C": [20.0]},
        "unexplained": [{
            "temperature_C": 20.0, "frequency_Hz": 10.0, "residual_E_percent": -6.21, "residual_phase_deg": 0.31,
            "z": 6.2,
        }],
    }  # fmt: skip
    assert left(found) == ["6.2 % in |E*| and 0.3 deg in the phase at 20 degC, 10 Hz"]
    found["reading"]["isotherms_C"].append(30.0)
    assert left(found) == ["specimen X, slope over temperature, modulus: 6.18 times its standard error"]


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
        "verdict": "unexplained_structure",
        "tested": True,
        "numerics": {"largest_modulus_percent": 0.1},
        "scatter": {"modulus_percent": 1.0, "from_replicates": True},
        "largest_pattern_left": None,
        "lack_of_fit_p_value": 1e-9,
    }
    assert on_simulation(found, after).endswith(f"more than scatter within specimens can explain.{said}")


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
        "verdict": "unexplained_structure",
        "tested": True,
        "numerics": {"largest_modulus_percent": 0.1},
        "scatter": {"modulus_percent": 1.0, "from_replicates": True},
        "largest_pattern_left": None,
        "lack_of_fit_p_value": 1e-9,
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
            " 36 of 72 exceed the limit of phase uniformity (3 deg), 30 of specimen A, 6 of specimen B: check the "
            "gauges and the ends of the specimens.",
        ),
        (35, ""),
    ],
)
def test_a_quality_limit_that_half_of_the_tests_exceed_stands_in_the_verdict(exceeded, said):
    above = [{"column": "phase_uniformity_deg", "specimen": "A" if k < 30 else "B"} for k in range(exceeded)]
    reading = {"limits_exceeded": above}
    found = content(0, 0, tests=72, reading=reading) | {"ladder": []}
    assert on_data(found) == f"All 72 tests can be used.{said}"


def test_a_fault_of_one_isotherm_stands_in_the_verdict():
    bias = {"value": -3.65, "std_error": 0.66, "unit": "K"}
    rung = {"cause": "temperature_bias", "where": 24.0, "established": False, "parameters": {"bias": bias}}
    assert on_data(content(0, 0, tests=72) | {"ladder": [rung]}) == (
        "All 72 tests can be used. Perhaps those at 24 degC carry a temperature bias of -3.65 +- 1.3 K (not "
        "certain; the reason is below); law.json is the law of the mix without it."
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
            "65 of 72 tests can be used, 6 only after a check (the law here rests on them too), "
            "1 not at all.",
        ),
        (71, 0, 1, "71 of 72 tests can be used, 1 not at all."),
        (
            0,
            72,
            0,
            "None of 72 tests can be used, 72 only after a check (the law here rests on them too).",
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
        "specimens say: check dimensions, gain and unit of these tests. At 54 degC modulus and phase contradict each "
        "other: check strain and machine there. Specimen B at 4 degC was not tested."
    )


@pytest.mark.parametrize(
    "coldest,inner,warned",
    [
        (9.0, 8.0, []),
        (
            58.3,
            8.0,
            ["58 % at -4 degC, 9 % at 37 degC and 8 % between them. Do not use the law beyond the tested "],
        ),
        (
            9.0,
            17.1,
            [
                "9 % at -4 degC, 9 % at 37 degC and 17 % between them. Do not use the law at temperatures that "
            ],
        ),
    ],
)
def test_a_law_that_predicts_badly_is_warned_of(coldest, inner, warned):
    """Between the tested temperatures, or only beyond them."""
    by = {
        t: {name: {"before": 2.0, "after": error} for name in ("mre_E_percent", "mre_phase_percent")}
        for t, error in (("37", 9.0), ("-4", coldest), ("21", inner))
    }
    held_out = {"leave_one_isotherm_out": {"averages_by_temperature": by}}
    said = verdict.beyond_the_tests({"ladder": [{"gain": {"in_sample": {}, "held_out": held_out}}]})
    assert len(said) == len(warned) and all(part in one for part, one in zip(warned, said, strict=True))
    assert verdict.beyond_the_tests({"ladder": []}) == []
    assert verdict.predicts_badly(held_out["leave_one_isotherm_out"], inner=True) == (inner > 10.0)


def test_causes_of_a_bench_that_nobody_stated_do_not_lead_the_verdict():
    mass = {"value": -0.227, "std_error": 0.01, "unit": "kg"}
    rung = {"cause": "moving_mass", "where": None, "parameters": {"mass": mass}}
    found = content(0, 0, tests=72) | {"ladder": [rung]}
    assert "moving mass" in on_data(found)
    assert on_data(found | {"reading": {"bench_assumed": True}}) == "All 72 tests can be used."


def test_intervals_hold_the_spread_of_a_table_whose_tests_lie_far_from_the_fit():
    size = {"value": 1.5, "std_error": 0.5, "unit": "deg"}
    rung = {
        "cause": "phase_offset",
        "where": None,
        "parameters": {"offset": size},
        "p_value": 1e-9,
        "as_good": ["channel_delay"],
        "confirmed_by": "metal",
    }
    near, far = ({"ladder": [rung], "estimates_spread": spread} for spread in (1.0, 2.0))
    assert sentences.size(rung, near) == "1.5 +- 0.98 deg" and sentences.size(rung, far) == "1.5 +- 2 deg"
    assert (
        "holds zero" not in causes(near)[0][1]
        and "Its 95 % interval, as widened below, holds zero. To" in causes(far)[0][1]
    )
    worse = rung | {"gain": {"in_sample": {"rms_over_scatter": {"before": 2.2, "after": 3.1}}}}
    assert "With it the law fits these tests worse" in causes({"ladder": [worse]})[0][1]
    assert "fits these tests worse" not in causes(near)[0][1]
    assert sentences.of_intervals(near) == "+- is the 95 % interval."
    assert sentences.of_intervals(far).startswith("+- is the 95 % interval, widened 2.0 times since")
    assert sentences.of_intervals({"ladder": []}) == ""


@pytest.mark.parametrize(
    "cause,where,value,unit,told",
    [
        ("channel_delay", None, 0.8e-3, "s", "subtract 0.288 deg per Hz from their phases"),
        ("temperature_bias", 20.0, 1.84, "K", "enter 21.8 degC for them"),
        ("moving_mass", None, 0.1, "kg", "correct them for it"),
        ("loose_clamp", "A", 3e-12, "1/Pa", "correct its tests for it"),
    ],
)
def test_how_to_be_rid_of_a_fault_is_told(cause, where, value, unit, told):
    rung = {
        "cause": cause,
        "where": where,
        "parameters": {"size": {"value": value, "std_error": None, "unit": unit}},
    }
    assert f": {told}; law.json is" in on_data(content(0, 0, tests=72) | {"ladder": [rung]})


def test_a_table_without_quality_columns_is_said_to_be_judged_by_its_curves_alone():
    reading = {"test_type": "tension-compression", "quality_columns": [], "isotherms_C": [4.0, 21.0]}
    found = content(0, 0, tests=72, reading=reading) | {"ladder": []}
    assert on_data(found) == (
        "All 72 tests can be used (judged by modulus and phase alone: no quality columns)."
    )
    flagged = found | {"reading": reading | {"quality_columns": ["phase_uniformity_deg"]}}
    some = flagged | {"trust": {"use": 60, "check": 12, "not_used": 0}}
    assert on_data(some).startswith("60 of 72 tests pass all checks, 12 can be used only after a check")
    assert on_data(flagged) == on_data(found | {"reading": {}}) == "All 72 tests can be used."
