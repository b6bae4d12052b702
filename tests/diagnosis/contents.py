"""What every diagnosis.json holds, of tests with nothing in them; tests put theirs over it."""

from __future__ import annotations

SOUND = {
    "verdict": "nothing_to_explain",
    "tests": 72,
    "tested": True,
    "origin": "measured",
    "scatter": {"from_replicates": True},
    "ladder": [],
    "withdrawn": [],
    "estimates": {},
    "estimates_spread": 1.0,
    "discrepancy": [],
    "repeatability": None,
    "with_suspects": None,
    "without_doubtful": None,
    "instructions": {"costs": "", "orders": []},
    "trust": {"use": 72, "check": 0, "held_back": 0, "not_used": 0, "use_by_specimen": {}},
    "contradictory_isotherms": [],
    "one_sided": "",
    "odd_levels": [],
    "odd_phases": [],
    "odd_temperatures": [],
    "suspect_tests": [],
    "not_testable": [],
    "detection_limits": {},
    "lack_of_fit_p_value": 0.5,
    "largest_pattern_left": None,
    "unexplained": [],
    "notes": [],
    "provenance": {"scatter_stated": None},
}
SURE = {"as_good": [], "established": True, "taken_off": 1.0, "hangs_on": [], "doubts": []}  # of a rung
