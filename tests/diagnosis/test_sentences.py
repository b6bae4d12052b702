"""Sentences on tests that are doubtful, and on what another choice of tests would name."""

import numpy as np
import pytest
from contents import SOUND, SURE

from asphalt_nscd.diagnosis.next_tests.fixed_orders import named
from asphalt_nscd.diagnosis.words import sentences, unexplained
from asphalt_nscd.diagnosis.words.sentences import (
    cause_words,
    causes,
    doubtful_change,
    estimate,
    law_of_the_mix,
    suspect_change,
)
from asphalt_nscd.diagnosis.words.unexplained import left
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


@pytest.mark.parametrize(
    "named,changed",
    [
        (
            [{"cause": "phase_offset", "where": None}],
            "If the doubtful tests were left out, the diagnosis would name the same causes.",
        ),
        ([], "If the doubtful tests were left out, the diagnosis would no longer name a phase offset."),
        (
            [{"cause": "phase_offset", "where": None}, {"cause": "channel_delay", "where": None}],
            "If the doubtful tests were left out, the diagnosis would also name a channel delay.",
        ),
        (
            [{"cause": "loose_clamp", "where": "A"}],
            "If the doubtful tests were left out, the diagnosis would name a loose clamp of specimen A and no longer "
            "name a phase offset.",
        ),
    ],
)
def test_what_is_named_without_the_doubtful_tests_is_told(named, changed):
    then = {"verdict": "explained", "causes": named}
    assert doubtful_change(content(1, 0, without_doubtful=then)) == changed
    assert suspect_change(content(1, 1, with_suspects=then)) == changed.replace(
        "If the doubtful tests were left out", "If the tests left out were kept"
    )


def test_the_same_causes_in_another_order_are_the_same():
    found = content(0, 1, with_suspects={"verdict": "explained", "causes": []})
    found["ladder"] = [{"cause": name, "where": None} for name in ("phase_offset", "channel_delay")]
    found["with_suspects"]["causes"] = found["ladder"][::-1]
    assert (
        suspect_change(found) == "If the tests left out were kept, the diagnosis would name the same causes."
    )


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
            "Not certain: loose clamp of specimen B fits as well; these tests do not say which.",
        ),
    ],
)
def test_why_a_name_is_only_likely(hangs_on, as_good, sure):
    bias = {"value": 8.0, "std_error": 0.4, "unit": "K"}
    rung = SURE | {
        "cause": "temperature_bias",
        "where": 4.0,
        "parameters": {"temperature_rise": bias},
        "p_value": 1e-9,
        "as_good": as_good,
        "hangs_on": hangs_on,
        "confirmed_by": "a thermometer",
    }
    ((told, meaning),) = causes(SOUND | {"ladder": [rung]})
    assert told == "temperature bias at 4 degC: 8 K or more (the search ends there)"
    assert meaning.endswith(f"{sure} To confirm it: a thermometer.")


def part_left(kind, part, size, temperature_C=None, specimen=None):
    """A part of what no cause explains, as in diagnosis.json."""
    return {"kind": kind, "part": part, "temperature_C": temperature_C, "specimen": specimen, "size": size}


def test_a_specimen_called_specimen_is_not_called_so_twice():
    rung = {"cause": "loose_clamp", "where": "Specimen 1"}
    assert cause_words(rung) == "loose clamp of Specimen 1"
    assert cause_words(rung | {"where": "S1"}) == "loose clamp of specimen S1"
    hot = part_left("isotherm", "phase", 1.0, temperature_C=37.0)
    found = [
        part_left("spectrum", "both", 2.0, specimen="Specimen 1"),
        part_left("specimen", "modulus", 1.5, specimen="S2"),
        hot,
    ]
    scatter = {"modulus_percent": 1.0, "phase_deg": 0.5}
    assert left(SOUND | {"discrepancy": found, "scatter": scatter}) == [
        "2.0 % in |E*| of Specimen 1: its master curve has another shape than the common one",
        "1.5 % in |E*| of specimen S2, changing with frequency and temperature",
        "0.5 deg in the phase at 37 degC",
    ]
    few, many = (
        SOUND | {"reading": {"specimens": [*"ABCDE"][:n]}, "discrepancy": found, "scatter": scatter}
        for n in (3, 5)
    )
    assert left(few)[3:] == ["3 specimens are too few to tell which one is odd"]
    assert left(many)[3:] == left(few | {"discrepancy": [hot]})[1:] == []
    assert [named(names) for names in (["Specimen 1", "Specimen 2"], ["A", "B"], ["A"], ["Specimen 1"])] == [
        "Specimen 1 and Specimen 2",
        "specimens A and B",
        "specimen A",
        "Specimen 1",
    ]


def test_a_doubt_and_the_law_of_the_mix_are_told_for_what_they_are():
    size = {"value": 1.5, "std_error": 0.1, "unit": "deg"}
    rung = SURE | {
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
    (doubt,) = causes(SOUND | {"ladder": [law, rung]})
    assert doubt[1].endswith(
        "Not certain: beside a smooth error its size is 2.5. It was found after a name that is in doubt. To confirm "
        "it: metal."
    )
    assert law_of_the_mix(SOUND | {"ladder": [law, rung]}) == (
        "Time-temperature shift of the free master curve: WLF C1 1.50 +- 0.20, WLF C2 173.00 +- 0.20 K, reference "
        "temperature 20 degC",
        "Not certain: certainty takes four temperatures, three frequencies and two specimens.",
    )
    assert law_of_the_mix(SOUND | {"ladder": [rung]}) is None
    sure = law | {"established": True}
    assert (
        law_of_the_mix(SOUND | {"ladder": [sure]})[1] == ""
    )  # Burgers laws are told of where they were simulated
    bonds = rung | {"cause": "bond_mapping"}
    assert law_of_the_mix(SOUND | {"ladder": [bonds, sure]})[1] == (
        "Established: a Burgers law at each temperature is not enough. The chance that scatter alone makes it miss by "
        "so much is below one in a million."
    )


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


def test_one_temperature_has_no_slope_over_it():
    found = SOUND | {
        "verdict": "unexplained_structure", "scatter": {}, "lack_of_fit_p_value": 1e-9,
        "largest_pattern_left": {"pattern": "specimen X, slope over temperature, modulus", "z": 6.18, "p_value": 1e-9},
        "reading": {"isotherms_C": [20.0], "specimens": ["A"]},
        "unexplained": [{
            "specimen": None, "temperature_C": 20.0, "frequency_Hz": 10.0, "residual_E_percent": -6.21,
            "residual_phase_deg": 0.31,
            "z": 6.2,
        }],
    }  # fmt: skip
    assert left(found) == ["6.2 % in |E*| and 0.3 deg in the phase at 20 degC, 10 Hz"]
    found["reading"]["isotherms_C"].append(30.0)
    assert left(found) == ["specimen X, slope over temperature, modulus: 6.18 times its standard error"]


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
