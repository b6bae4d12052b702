"""Sentences on tests that are doubtful, and on what another choice of tests would name."""

import numpy as np
import pytest
from contents import SOUND, SURE

from asphalt_nscd.diagnosis.words import sentences, unexplained
from asphalt_nscd.diagnosis.words.sentences import (
    causes,
    estimate,
    suspect_change,
)
from asphalt_nscd.diagnosis.written import interval_95


def content(used: int, out: int, **then):
    tests = [
        {"specimen": "A", "temperature_C": 4.0 + k, "frequency_Hz": 25.0, "reasons": ["x"]}
        for k in range(used + out)
    ]
    status = ["doubtful"] * used + ["left out"] * out
    suspect = [{**one, "status": told, "decided_by": "its own isotherm"} for one, told in zip(tests, status)]
    ladder = [{"cause": "phase_offset", "where": None}]
    return SOUND | {"suspect_tests": suspect, "ladder": ladder, **then}


def test_the_same_causes_in_another_order_are_the_same():
    found = content(0, 1, with_suspects={"verdict": "explained", "causes": []})
    found["ladder"] = [{"cause": name, "where": None} for name in ("phase_offset", "channel_delay")]
    found["with_suspects"]["causes"] = found["ladder"][::-1]
    assert (
        suspect_change(found) == "If the tests left out were kept, the diagnosis would name the same causes."
    )


def part_left(kind, part, size, temperature_C=None, specimen=None):
    """A part of what no cause explains, as in diagnosis.json."""
    return {"kind": kind, "part": part, "temperature_C": temperature_C, "specimen": specimen, "size": size}


def test_a_rival_that_was_named_too_is_no_alternative():
    size = {"value": 1.5, "std_error": 0.1, "unit": "deg"}
    rung = SURE | {
        "cause": "phase_offset",
        "where": None,
        "parameters": {"phase_offset": size},
        "p_value": 1e-9,
        "as_good": ["channel_delay"],
        "confirmed_by": "metal",
    }
    assert "Not certain: channel delay fits as well" in causes(SOUND | {"ladder": [rung]})[0][1]
    both = causes(SOUND | {"ladder": [rung, rung | {"cause": "channel_delay", "as_good": []}]})
    assert "Not certain: channel delay would have fitted as well before both were named. To" in both[0][1]


def test_a_relative_size_is_told_in_percent():
    size = {"value": -0.316, "std_error": 0.07, "unit": "1"}
    rung = {"cause": "specimen_geometry", "where": "A", "parameters": {"relative_modulus": size}}
    assert sentences.size(rung, SOUND) == "-32 +- 14 %"


def test_intervals_hold_the_spread_of_a_table_whose_tests_lie_far_from_the_fit():
    size = {"value": 1.5, "std_error": 0.5, "unit": "deg"}
    rung = SURE | {
        "cause": "phase_offset",
        "where": None,
        "parameters": {"offset": size},
        "p_value": 1e-9,
        "as_good": ["channel_delay"],
        "confirmed_by": "metal",
    }
    near, far = (SOUND | {"ladder": [rung], "estimates_spread": spread} for spread in (1.0, 2.0))
    assert sentences.size(rung, near) == "1.50 +- 0.98 deg" and sentences.size(rung, far) == "1.5 +- 2.0 deg"
    worse = rung | {"gain": {"in_sample": {"rms_over_scatter": {"before": 2.2, "after": 3.1}}}}
    hidden = (
        " It is not in the answer above: if all tests count alike, they fit worse with it than without it. To"
    )
    assert hidden in causes(SOUND | {"ladder": [worse | {"established": False}]})[0][1]
    assert "not in the answer" not in causes(SOUND | {"ladder": [worse]})[0][1] + causes(near)[0][1]
    assert sentences.interval_note(near) == "+- is the 95 % interval."
    assert sentences.interval_note(far).endswith("so it was widened 2.0 times.")
    assert sentences.interval_note(SOUND | {"ladder": []}) == ""


LIMITS = {
    "phase_offset": {"value": 0.5, "unit": "deg"},
    "temperature_bias": {
        "value": 0.9,
        "unit": "K",
        "confined_to": "temperature_C",
        "places": {"20.0": 1.24, "35.0": 0.883},
    },
}


@pytest.mark.parametrize(
    "isotherms,never,said",
    [
        (
            [20.0, 35.0],
            [],
            [
                "A common phase offset smaller than 0.5 deg.",
                "A temperature error at one isotherm smaller than 1.2 K at 20 degC and 0.88 K at 35 degC.",
            ],
        ),
        (
            [4.0, 20.0, 35.0],
            [],
            [
                "A common phase offset smaller than 0.5 deg.",
                "A temperature error at one isotherm smaller than 1.2 K at 20 degC and 0.88 K at 35 degC, and of any "
                "size at 4 degC.",
            ],
        ),
        (
            [20.0, 35.0],
            ["channel_delay", "strain_softening"],
            [
                "A common phase offset smaller than 0.5 deg.",
                "A delay of all tests, of any size.",
                "A temperature error at one isotherm smaller than 1.2 K at 20 degC and 0.88 K at 35 degC.",
                "A softening with strain, of any size.",
            ],
        ),
    ],
)
def test_what_would_not_be_seen_is_told(isotherms, never, said):
    content = {
        "ladder": [],
        "detection_limits": LIMITS,
        "not_testable": [{"cause": name} for name in never],
        "reading": {"isotherms_C": isotherms},
    }
    assert sorted(unexplained.unseen(content)) == sorted(said)
    named = content | {"ladder": [{"cause": "temperature_bias"}]}
    assert "emperature" not in " ".join(unexplained.unseen(named))


def test_a_size_uncertain_by_a_factor_has_its_ends_beside_it():
    strength = {"value": 2e9, "std_error": 1e9, "unit": "Pa", "interval_95": interval_95(2e9, 1e9, 1.0, True)}
    assert strength["interval_95"][0] > 0.0
    assert np.sqrt(np.prod(strength["interval_95"])) == pytest.approx(2e9)
    assert estimate(strength) == "2000 (751 to 5330) MPa"
    even = strength | {"interval_95": interval_95(2e9, 1e9)}
    assert estimate(even) == "2000 +- 2000 MPa"
