"""Sentences of what the law misses, and where it must not be used."""

import pytest
from contents import SOUND
from test_sentences import part_left

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


def test_what_all_tests_share_is_not_at_a_place():
    found = SOUND | {"discrepancy": [part_left("all", "phase", 1.0)], "scatter": {"phase_deg": 0.5}}
    assert left(found) == ["0.5 deg in the phase of all tests"]
