"""Mean relative errors as in Table 4."""

import pandas as pd
import pytest

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.measurements.agreement import mean_relative_error

COLUMNS = ["temperature_C", "frequency_Hz", "E_MPa", "phase_deg"]
MEASURED = pd.DataFrame(
    [(15, 3, 90, 19), (15, 3, 110, 21), (15, 10, 200, 10), (15, 25, 300, 8), (0, 3, 400, 5), (0, 10, 500, 4)],
    columns=COLUMNS,
)


def test_averages_over_specimens_are_compared_point_by_point():
    simulated = pd.DataFrame(
        [(15, 10, 190, 10.5), (15, 3, 103, 16), (15, 3, 99, 18), (15, 25, 333, 6), (0, 3, 404, 4)],
        columns=COLUMNS,
    )
    errors = mean_relative_error(MEASURED, simulated)
    assert list(errors["temperature_C"]) == [0, 15]
    assert list(errors["mre_E_percent"]) == pytest.approx([1.0, (1 + 5 + 11) / 3])
    assert list(errors["mre_phase_percent"]) == pytest.approx([20.0, (15 + 5 + 25) / 3])


def test_simulation_without_measurement_is_refused():
    with pytest.raises(InputError, match="no measurement at 30 degC, 3 Hz"):
        mean_relative_error(MEASURED, pd.DataFrame([(30, 3, 1, 1)], columns=COLUMNS))
    with pytest.raises(InputError, match="table of simulations is empty"):
        mean_relative_error(MEASURED, MEASURED.iloc[:0])


def test_a_phase_of_zero_is_nothing_to_divide_by():
    """And one below zero, of a delayed channel, is relative to its size."""
    measured = pd.DataFrame([(15, 3, 70e3, 0.0), (20, 3, 70e3, -2.0)], columns=COLUMNS)
    simulated = pd.DataFrame([(15, 3, 70e3, -0.1), (20, 3, 70e3, -1.0)], columns=COLUMNS)
    errors = mean_relative_error(measured, simulated, least_phase_deg=0.5)
    assert list(errors["mre_phase_percent"]) == pytest.approx([20.0, 50.0])
