"""What every diagnosis.json holds, of tests with nothing in them; tests put theirs over it."""

from __future__ import annotations

SOUND = {
    "verdict": "nothing_to_explain",
    "tests": 72,
    "tested": True,
    "origin": "measured",
    "scatter": {"from_replicates": True, "modulus_percent": 1.0, "phase_deg": 0.5},
    "numerics": {"largest_modulus_percent": 0.1},
    "ladder": [],
    "withdrawn": [],
    "estimates": {},
    "estimates_spread": 1.0,
    "discrepancy": [],
    "repeatability": None,
    "with_suspects": None,
    "without_doubtful": None,
    "instructions": {"costs": "", "orders": []},
    "trust": {
        "use": 72,
        "check": 0,
        "held_back": 0,
        "not_used": 0,
        "check_at_C": [],
        "check_of": [],
        "use_by_specimen": {},
    },
    "reading": {
        "test_type": "bending",
        "specimens": ["A"],
        "isotherms_C": [4.0, 12.0, 20.0, 35.0],
        "frequencies_Hz": [0.1, 0.5, 1.0, 5.0],
        "quality_columns": [],
        "limits_exceeded": [],
        "notes": [],
        "off_target": [],
        "not_tested": [],
        "files_without_tests": [],
    },
    "highest_frequency": None,
    "law_misses": None,
    "laws": [],
    "law_parameters": {},
    "undetermined": "",
    "measured_limits": {},
    "excess_phase": [],
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
SURE = {
    "as_good": [],
    "established": True,
    "taken_off": 1.0,
    "hangs_on": [],
    "doubts": [],
    "probability": 0.97,
    "where": None,
    "evidence": "",
    "log10_shift": {},
    "p_value": 1e-9,
    "sentence": "s",
    "confirmed_by": "metal",
    "gain": {"in_sample": {"averages_by_temperature": {}}, "held_out": {}},
}  # of a rung
LAW_MISSES = {
    "mre_E_percent": 1.0,
    "mre_phase_percent": 2.0,
    "off_phase_deg": 0.5,
}  # told, so that no gains of rungs are needed


def named(cause, value, unit, std_error=0.1, **then):
    """A rung of a cause with its size."""
    return (
        SURE
        | {"cause": cause, "parameters": {cause: {"value": value, "std_error": std_error, "unit": unit}}}
        | then
    )


def of_suspects(used, out):
    """Suspect tests, some of them used and some left out."""
    status = ["doubtful"] * used + ["left out"] * out
    about = {"specimen": "A", "frequency_Hz": 25.0, "reasons": ["x"], "decided_by": "its own isotherm"}
    return [{**about, "temperature_C": 4.0 + k, "status": told} for k, told in enumerate(status)]
