import numpy as np

from asphalt_nscd.diagnosis.observed.observations import Observations
from asphalt_nscd.diagnosis.observed.quality import COLUMNS, LIMITS, Exceeded, exceeded
from asphalt_nscd.diagnosis.words import facts
from asphalt_nscd.table_import.quantities import QUALITY


def observed(**quality):
    ones = np.ones(3)
    return Observations(
        np.zeros(3, int),
        ("A",),
        ones,
        ones,
        ones * 1e9 + 0j,
        ones,
        ones,
        quality={name: np.array(values, float) for name, values in quality.items()},
    )


def test_limits_of_the_standard():
    assert {name: limit.limit for name, limit in LIMITS.items()} == {
        "load_standard_error_percent": 10.0,
        "deformation_standard_error_percent": 10.0,
        "deformation_uniformity_percent": 30.0,
        "phase_uniformity_deg": 3.0,
    }
    assert {limit.unit for name, limit in LIMITS.items() if name.endswith("_deg")} == {"deg"}


def test_only_values_above_the_limit_are_named_by_row_then_column():
    tests = observed(
        phase_uniformity_deg=[3.0, 3.1, np.nan],
        load_standard_error_percent=[10.1, 11.0, 0.2],
        load_drift_percent=[500.0, -500.0, 0.0],
    )
    assert exceeded(tests) == [
        Exceeded(0, "load_standard_error_percent", 10.1, 10.0),
        Exceeded(1, "load_standard_error_percent", 11.0, 10.0),
        Exceeded(1, "phase_uniformity_deg", 3.1, 3.0),
    ]


def test_rows_of_a_subset_are_its_own():
    tests = observed(phase_uniformity_deg=[0.1, 7.9, 0.1]).subset(np.array([1, 2]))
    assert [one.row for one in exceeded(tests)] == [0]


def test_drift_is_kept_without_a_limit():
    assert "deformation_drift_percent" in COLUMNS and "deformation_drift_percent" not in LIMITS


def test_the_import_keeps_every_column_that_is_judged():
    assert set(QUALITY) == set(COLUMNS)


def test_values_of_one_column_are_told_together_from_least_to_largest():
    about = {"specimen": "A", "temperature_C": 4.0}
    tests = [
        {**about, "frequency_Hz": hertz, "reasons": ["x", f"deformation uniformity {value} % (limit 30)"]}
        for hertz, value in ((10.0, "31.2"), (1.0, "104"), (25.0, "56.7"))
    ]
    ((*_, reasons, frequencies),) = facts.grouped_tests(tests)
    assert reasons == ["x", "deformation uniformity 31.2 to 104 % (limit 30)"]
    assert frequencies == [1.0, 10.0, 25.0]
