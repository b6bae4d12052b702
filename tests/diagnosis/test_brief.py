"""The answer on one screen: each row says what the content holds, and rows with nothing to say are left out."""

import pytest
from contents import SOUND, SURE
from test_sentences import content

from asphalt_nscd.diagnosis.words.brief import AVERAGED, MOST, WIDTH, rows, text

CHECKED = " It was fitted to all tests, doubtful ones too."


def found(ladder=(), **then):
    """Content of tests with nothing in them but what is given."""
    found = content(then.pop("used", 0), out := then.pop("out", 0)) | {"ladder": list(ladder)} | then
    trust = {"use": found["tests"], "check": 0, "held_back": 0, "not_used": out, "use_by_specimen": {}}
    read = SOUND["reading"] | then.get("reading", {})
    return found | {"trust": SOUND["trust"] | trust | then.get("trust", {}), "reading": read}


def answer(ladder=(), **then):
    """Rows by label."""
    return dict(rows(found(ladder, **then)))


def rung(cause, value, unit, std_error=0.1, **then):
    size = {"value": value, "std_error": std_error, "unit": unit}
    gain = {"in_sample": {"averages_by_temperature": {}}, "held_out": {}}
    return SURE | {
        "probability": 0.97,
        "cause": cause,
        "where": None,
        "parameters": {cause: size},
        "gain": gain,
        **then,
    }


def faults(*found, **then):
    """Rows of faults and data: the law is told by `law_misses`, so that no gains are needed."""
    misses = {"mre_E_percent": 1.0, "mre_phase_percent": 2.0}
    told = answer(found, law_misses=misses, scatter={"from_replicates": True}, **then)
    return told.get("Fault"), told.get("Possible fault"), told["Data"]


def test_of_sound_tests_little_is_said():
    assert answer() == {
        "Tests": ["Two-point bending of trapezoids: specimen A at 4, 12, 20 and 35 degC."],
        "Data": ["All 72 tests can be used."],
        "Fault": ["None found."],
        "Law": ["One Burgers law for each temperature fits these tests to within their scatter; nothing is left to "
                "explain."],
    }  # fmt: skip


@pytest.mark.parametrize(
    "use,check,out,said",
    [
        (72, 0, 0, "All 72 tests can be used."),
        (65, 6, 1, "65 of 72 tests can be used, 6 only if a check clears them, 1 cannot."),
        (71, 0, 1, "71 of 72 tests can be used, 1 cannot."),
        (0, 72, 0, "None of 72 tests can be used, 72 only if a check clears them."),
    ],
)
def test_how_far_each_test_can_be_used_is_one_answer(use, check, out, said):
    trust = {"use": use, "check": check, "not_used": out}
    assert answer(out=out, tests=72 - out, trust=trust)["Data"] == [said]


def test_a_certain_fault_comes_with_its_correction():
    sure, possible, data = faults(rung("channel_delay", 0.8e-3, "s", 1e-5, established=True))
    assert sure == [
        "Channel delay in all tests, 0.800 +- 0.020 ms. The displacement is recorded after the force. Correction: "
        "subtract 0.288 deg per Hz from the phase."
    ]
    assert possible is None and data == ["All 72 tests can be used after correction."]


@pytest.mark.parametrize(
    "then,said,weighed",
    [
        ({}, "", "both, with it and without"),
        (
            {"as_good": ["film_softening"]},
            " Not certain: film softening fits as well.",
            "it, film softening and neither, by probability",
        ),
    ],
)
def test_a_fault_that_is_not_certain_is_a_possible_one_with_its_probability(then, said, weighed):
    unsure = rung("phase_offset", 1.5, "deg", established=False, **then) | {"probability": 0.72}
    sure, possible, data = faults(unsure)
    first = "Phase offset in all tests, 1.50 +- 0.20 deg. If so, the measured phases are too large."
    assert possible == [f"{first}{said} Its probability is 72 %: {AVERAGED.format(weighed)}"]
    assert sure == ["None is certain."] and data == ["All 72 tests can be used."]


@pytest.mark.parametrize(
    "cause,where,value,unit,told",
    [
        ("channel_delay", None, -0.8e-3, "s", "add 0.288 deg per Hz to the phase"),
        ("phase_offset", None, 1.5, "deg", "subtract 1.5 deg from the phase"),
        ("temperature_bias", 20.0, 1.84, "K", "take 21.8 degC as their temperature"),
        ("specimen_geometry", "A", 0.358, "1", "if its dimensions prove wrong, divide its |E*| by 1.36"),
    ],
)
def test_how_to_be_rid_of_a_fault_is_told(cause, where, value, unit, told):
    ((sure,), _, _) = faults(rung(cause, value, unit, None, where=where, established=True))
    assert sure.endswith(f" Correction: {told}.")


def test_tests_left_out_stand_with_their_reasons_and_many_are_counted():
    each = [f"Specimen A, {4 + k} degC, 25 Hz: x." for k in range(MOST + 2)]
    assert answer(out=2)["Leave out"] == each[:2]
    assert answer(out=MOST + 2)["Leave out"] == [*each[: MOST - 1], "3 more: see the reasons."]


@pytest.mark.parametrize(
    "exceeded,where",
    [(36, "30 tests of specimen A, in 6 of specimen B at 4 degC"), (18, "18 tests of specimen A"), (17, "")],
)
def test_a_quality_limit_that_half_of_a_specimen_s_tests_exceed_is_checked_first(exceeded, where):
    above = [
        {
            "column": "phase_uniformity_deg",
            "specimen": "A" if k < 30 else "B",
            "temperature_C": 4.0 + 17.0 * (k % 2) * (k < 30),
            "frequency_Hz": 25.0 if k == 0 else 10.0,
        }
        for k in range(exceeded)
    ]
    read = {"specimens": ["A", "B"], "isotherms_C": [4.0], "test_type": "bending", "limits_exceeded": above}
    said = "Phase uniformity is above 3 deg in {}. Check the gauges and the ends of the specimens."
    assert answer(reading=read).get("Check first") == ([said.format(where)] if where else None)
    if exceeded == 36:
        whole = {"limits_exceeded": [one | {"specimen": "A"} for one in above]}
        assert answer(reading=read | whole)["Check first"] == [said.format("all tests of specimen A")]


def test_what_is_odd_or_contradicts_itself_is_checked_first():
    told = answer(
        used=1,
        odd_levels=[{"specimen": "A", "temperature_C": 35.0, "factor": 0.7}],
        contradictory_isotherms=[
            {"temperature_C": 54.0, "sentence": "x", "worst_Hz": 25.0, "worst_deg": -19.1}
        ],
        reading={
            "specimens": ["A"],
            "isotherms_C": [54.0],
            "test_type": "bending",
            "off_target": [{"specimen": "A", "temperature_C": 54.0, "measured_C": 57.0}],
        },
    )
    assert told["Check first"] == [
        "At 54 degC the phase is up to 19.1 deg (at 25 Hz) lower than |E*| requires (about 90 deg times the slope of "
        "log |E*| against log f). Check strain level, load control and gauges, then test there again. If phase and "
        "slope then agree, use the new tests in place of the old.",
        "Specimen A at 54 degC: measured at 57 degC, 3 K off its target (AASHTO T 378 allows 0.5 K). Look for a slip "
        "in the record, else test again.",
        "Specimen A at 35 degC: |E*| 0.70 times what its other temperatures and the other specimens say: check gauges, "
        "gain, unit and entered dimensions of these tests.",
        "Specimen A, 4 degC, 25 Hz: x.",
    ]


OTHERS = (
    "doubtful test after the check. If both agree within 13 % in |E*| and 1.6 deg in phase, keep the old one, else use "
    "the new."
)


@pytest.mark.parametrize(
    "broken,check_at,said",
    [
        ([], None, [f"Repeat a {OTHERS}"]),
        ([54.0], [54.0], []),
        ([37.0, 54.0], None, [f"Repeat any other {OTHERS}"]),
    ],
)
def test_what_clears_a_doubtful_test_is_said(broken, check_at, said):
    trust = {"use": 60, "check": 12, "not_used": 0} | ({"check_at_C": check_at} if check_at else {})
    at = [{"temperature_C": t, "worst_Hz": 25.0, "worst_deg": 9.0} for t in broken]
    scatter = {"between": None, "within": {"E_percent": 4.5, "phase_deg": 0.58}}
    told = answer(trust=trust, contradictory_isotherms=at, repeatability=scatter)["Check first"]
    assert told[bool(broken) :] == said


def test_a_highest_frequency_that_is_off_is_checked_first():
    off = {
        "frequency_Hz": 25.0,
        "modulus_percent": 0.4,
        "modulus_interval_95": [-0.6, 1.4],
        "phase_deg": 6.0,
        "phase_interval_95": [5.8, 6.2],
    }
    check = "Check that this frequency is the true one and that a cycle has enough samples, then test there again."
    told = answer(highest_frequency=off)
    assert told["Fault"] == ["None found beside what is to be checked first."]
    assert told["Check first"] == [
        f"In all tests at 25 Hz the phase is 6.00 +- 0.20 deg above what the other frequencies ask for. {check}"
    ]
    off |= {"modulus_percent": -8.0, "modulus_interval_95": [-9.0, -7.0], "phase_interval_95": [-0.1, 12.1]}
    assert answer(highest_frequency=off)["Check first"] == [
        f"In all tests at 25 Hz |E*| is 8.0 +- 1.0 % below what the other frequencies ask for. {check}"
    ]


def test_orders_stand_with_purpose_and_hours():
    order = {
        "half_strain": True,
        "act": "test specimen A again",
        "frequencies_Hz": [0.1, 0.5, 1.0, 5.0, 10.0, 25.0],
        "purpose": "to replace the doubtful test",
        "hours": 2.5,
    }
    few = order | {"half_strain": False, "frequencies_Hz": [1.0], "hours": 0.5}
    assert answer(instructions={"orders": [order, few]})["Next tests"] == [
        "1. Test specimen A again, all frequencies, at half the strain, to replace the doubtful test (2.5 h).",
        "2. Test specimen A again, 1 Hz, to replace the doubtful test (0.5 h).",
    ]


def test_text_keeps_to_the_width_and_to_its_columns():
    read = {"specimens": [f"S{k}" for k in range(6)], "isotherms_C": [1.0] * 30, "test_type": "bending"}
    lines = text(found(reading=read)).splitlines()
    assert max(map(len, lines)) <= WIDTH and lines[0].startswith(
        "Tests           Two-point bending of trapezoids: "
    )
    assert lines[1].startswith(" " * 16) and lines[1][16] != " "


@pytest.mark.parametrize(
    "tested,lacks", [([4.0], "is 1"), ([4.0, 21.0, 37.0], "are 3"), ([4.0, 21.0, 37.0, 54.0], "")]
)
def test_too_few_temperatures_prove_no_fault(tested, lacks):
    told = answer(reading={"specimens": ["A"], "isotherms_C": tested, "test_type": "bending"})["Fault"]
    assert told == [
        "None found"
        + (f", and none could be proved: that takes 4 temperatures, and there {lacks}." if lacks else ".")
    ]


def test_a_cause_that_makes_the_fit_worse_is_not_in_the_answer():
    fits = {
        "in_sample": {"averages_by_temperature": {}, "rms_over_scatter": {"before": 2.0, "after": 3.0}},
        "held_out": {},
    }
    worse = rung("phase_offset", 1.5, "deg", established=False) | {"gain": fits}
    assert faults(worse)[:2] == (["None found."], None)
    better = {
        "in_sample": {"averages_by_temperature": {}, "rms_over_scatter": {"before": 3.0, "after": 2.0}},
        "held_out": {},
    }
    assert faults(worse | {"gain": better})[0] == ["None is certain."]


def test_an_established_effect_of_the_mix_is_told_with_its_size():
    warm = rung("self_heating", 3.42, "K", established=True, sentence="the specimens warm themselves")
    misses = {"mre_E_percent": 1.0, "mre_phase_percent": 2.0}
    told = answer([warm], law_misses=misses, scatter={"from_replicates": True})
    assert told["Effect"] == [
        "Self heating in all tests, 3.42 +- 0.20 K. The specimens warm themselves. law.json is free of it."
    ]
    assert told["Fault"] == ["None found beside the effect below."]
    assert told["Law"][0].endswith(" It was fitted to the corrected tests.")
    perhaps = answer([warm | {"established": False}], law_misses=misses, scatter={"from_replicates": True})
    assert "Effect" not in perhaps and perhaps["Fault"] == ["None found."]
    assert perhaps["Possible effect"][0].startswith("Self heating in all tests, 3.42 +- 0.20 K. If so, the")


EFFECT = rung("film_softening", 2.5, "deg", sentence="the mix is not linear", probability=0.6)


@pytest.mark.parametrize(
    "rival,said", [("phase_offset", "None is certain."), ("drifting_reading", "None found.")]
)
def test_an_effect_that_a_fault_rivals_leaves_a_fault_possible(rival, said):
    assert faults(EFFECT | {"established": False, "as_good": [rival]})[0] == [said]


def test_an_established_effect_stays_in_the_corrected_tests():
    misses = {"mre_E_percent": 1.0, "mre_phase_percent": 2.0}
    told = answer([EFFECT], law_misses=misses, scatter={"from_replicates": True})
    assert told["Effect"][0].endswith("law.json is free of it; corrected tests keep it.")
    assert "corrected" not in told["Law"][0] and told["Data"] == ["All 72 tests can be used."]
