"""Sentences of what the law misses, and where it must not be used."""

import pytest
from contents import SOUND, SURE
from test_sentences import content, part_left

from asphalt_nscd.diagnosis.words import verdict
from asphalt_nscd.diagnosis.words.unexplained import left
from asphalt_nscd.diagnosis.words.verdict import simulation_miss


def structure_left():
    """What stays on a table that no cause explains to within scatter."""
    return SOUND | {
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
    assert simulation_miss(found).startswith(said)


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
    found = structure_left() | {"ladder": [rung]}
    assert simulation_miss(found, after).endswith(
        f"more than scatter within specimens can explain, and no cause was found.{said}"
    )


@pytest.mark.parametrize("burgers,law", [(10.5, verdict.SIMPLER), (7.0, verdict.COMMON)])
def test_a_ladder_without_a_spectrum_says_which_law_it_begins_with(burgers, law):
    """Of one specimen no spectrum is told, but its causes are judged beside one."""
    errors = {name: {"before": 10.5, "after": 1.0} for name in ("mre_E_percent", "mre_phase_percent")}
    gain = {"in_sample": {"averages_by_temperature": {"20": errors}}}
    found = structure_left() | {
        "ladder": [SURE | {"cause": "phase_offset", "where": None, "gain": gain}],
        "baseline": {"mre_E_percent": {"20": burgers}},
    }
    assert simulation_miss(found) == (
        f"{law}, fitted together with a phase offset, misses the mean of the specimens by 1 % in |E*| and 1 % in the "
        "phase, more than scatter within specimens can explain. Without this cause it misses by 10 % and 10 %."
    )
    found["scatter"]["from_replicates"] = False
    assert simulation_miss(found).startswith(
        f"{law}, fitted together with a phase offset, misses the tests by 1 %"
    )
    alone = found | {"tested": False, "provenance": {"scatter_stated": None}}
    assert "% in the phase, and nobody knows how much of that is scatter. Without" in simulation_miss(alone)


def test_two_laws_are_told_by_two_names_with_their_weights():
    law = {"cause": "relaxation_spectrum", "where": None}
    offset = {"cause": "phase_offset", "where": None, "established": False}
    found = SOUND | {"ladder": [law, offset]}
    assert verdict.two_laws(found) == []
    found["law_misses"] = {"mre_E_percent": 1.97, "mre_phase_percent": 8.388}
    misses, weights = verdict.two_laws(found)
    assert misses == (
        "law.json misses the mean of the specimens by 2 % in |E*| and 8.4 % in the phase. A phase offset is not "
        "certain: law.json is the mean with it and without, by their probability."
    )
    assert weights.endswith("All these misfits are means over the temperatures.")
    aside = content(0, 1)["suspect_tests"]
    assert verdict.two_laws(found | {"suspect_tests": aside})[1].endswith("Tests left out are in neither.")
    found["ladder"] = [law, offset, offset | {"cause": "channel_delay"}]
    odd = [{"specimen": "A", "temperature_C": 35.0, "factor": 0.7}]
    then = found | {"odd_levels": odd, "trust": found["trust"] | {"held_back": 6}}
    assert verdict.two_laws(then)[1].endswith("those of law.json without specimen A at 35 degC.")
    bonds = {"cause": "bond_mapping", "where": None}
    assert (
        verdict.two_laws(found | {"ladder": [bonds, law]}) == verdict.two_laws(found | {"ladder": []}) == []
    )


def test_what_all_tests_share_is_not_at_a_place():
    found = SOUND | {"discrepancy": [part_left("all", "phase", 1.0)], "scatter": {"phase_deg": 0.5}}
    assert left(found) == ["0.5 deg in the phase of all tests"]
