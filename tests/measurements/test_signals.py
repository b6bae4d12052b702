"""Reduction of records: exact where it can be, refused where it would mislead."""

import numpy as np
import pytest

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.measurements.signals import harmonic_response, peak_response, require_steps

FREQUENCY, FORCE, DISPLACEMENT, PHASE = 10.0, 80.0, 63e-6, np.radians(14.2)


def record(duration=2.0, step=5e-4, frequency=FREQUENCY, phase=PHASE):
    time = np.arange(round(duration / step)) * step
    omega = 2 * np.pi * frequency
    return time, FORCE * np.sin(omega * time + phase), DISPLACEMENT * np.sin(omega * time)


def assert_response(response, rel, degrees):
    assert response.force_amplitude == pytest.approx(FORCE, rel=rel)
    assert response.displacement_amplitude == pytest.approx(DISPLACEMENT, rel=rel)
    assert np.degrees(response.phase - PHASE) == pytest.approx(0, abs=degrees)


@pytest.mark.parametrize("frequency", [3.0, 7.3, 40.0])
@pytest.mark.parametrize("cycles", [None, 1, 3])
def test_harmonic_fit_is_exact_under_offset_and_drift(frequency, cycles):
    time, force, displacement = record(frequency=frequency)
    response = harmonic_response(
        time + 100, force + 300 - 45 * time, displacement + 1e-3 + 2e-4 * time, frequency, cycles
    )
    assert_response(response, 1e-9, 1e-7)


def test_peak_picking_is_as_good_as_the_sampling():
    step = 5e-5
    time, force, displacement = record(step=step)
    response = peak_response(time, force + 300.0, displacement - 1e-3, FREQUENCY)
    assert_response(response, 1e-5, 0.51 * 360 * FREQUENCY * step)
    assert response.phase == pytest.approx(PHASE, abs=2 * np.pi * FREQUENCY * step)


def test_peak_picking_keeps_drift_that_the_harmonic_fit_removes():
    time, force, displacement = record()
    force = force + 400 * time  # N/s: half a force amplitude in each cycle
    assert abs(peak_response(time, force, displacement, FREQUENCY).force_amplitude / FORCE - 1) > 0.05
    assert_response(harmonic_response(time, force, displacement, FREQUENCY), 1e-9, 1e-7)


@pytest.mark.parametrize("shift", np.linspace(0, 0.1, 9))
def test_peak_phase_does_not_depend_on_where_the_record_ends(shift):
    time = np.arange(0, 2, 1e-4) + shift
    force, displacement = (np.sin(2 * np.pi * FREQUENCY * time + p) for p in (PHASE, 0.0))
    assert np.degrees(peak_response(time, force, displacement, FREQUENCY).phase) == pytest.approx(
        14.2, abs=0.4
    )


def test_only_the_last_cycles_count():
    time, force, displacement = record()
    early = time < 1.5 - 1e-9
    spoilt = np.where(early, 5 * force**2, force)
    for reduce in (harmonic_response, peak_response):
        whole, spoilt_response = (reduce(time, f, displacement, FREQUENCY, 5) for f in (force, spoilt))
        assert spoilt_response == whole
        assert reduce(time, spoilt, displacement, FREQUENCY, 6) != whole


def test_default_window_is_the_last_ten_seconds():
    time, force, displacement = record(duration=30, step=2e-3)
    spoilt = np.where(time < 20 - 1e-9, 3 * force, force)
    assert_response(harmonic_response(time, spoilt, displacement, FREQUENCY), 1e-9, 1e-7)
    spoilt = np.where(time < 20.1, 3 * force, force)
    assert harmonic_response(time, spoilt, displacement, FREQUENCY).force_amplitude > 1.005 * FORCE


@pytest.mark.parametrize(("overtone", "share"), [(0.32, ""), (0.35, "89")])
def test_nine_tenths_of_the_displacement_are_a_sinusoid(overtone, share):
    """Of cos + a cos 2, without its drift, the sinusoid is 1 / (1 + a^2): 0.907 and 0.891."""
    time, force, displacement = record()
    bent = displacement + overtone * DISPLACEMENT * np.sin(4 * np.pi * FREQUENCY * time) + 3e-4 * time
    if share:
        with pytest.raises(InputError, match=f"explains only {share} % of the variation"):
            harmonic_response(time, force, bent, FREQUENCY)
    else:
        assert_response(harmonic_response(time, force, bent, FREQUENCY), 1e-3, 0.01)


def test_times_rounded_in_print_are_no_gaps():
    """To a millisecond, of steps of 2.5: they come as 2 and 3."""
    time, force, displacement = record(step=2.5e-3)
    assert_response(harmonic_response(np.round(time, 3), force, displacement, FREQUENCY), 1e-2, 0.5)


def changed(name, value, index=100):
    columns = dict(zip(("time", "force", "displacement"), record(), strict=True))
    columns[name] = columns[name].copy()
    columns[name][index] = value
    return tuple(columns.values())


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ((*record(duration=0.05), FREQUENCY), "lasts 0.50 cycles"),
        ((*record(duration=0.25), FREQUENCY, 3), "lasts 2.50 cycles"),
        ((*record(), FREQUENCY, 0), "at least one"),
        ((*record(step=0.02), FREQUENCY), "5.0 samples per cycle"),
        ((*record(), 0.0), "not positive"),
        ((*record(), -3.0), "not positive"),
        ((*record(), np.nan), "not positive"),
        ((*record(), 11.0), "a sinusoid of 11 Hz explains only"),
        ((*changed("force", np.nan), FREQUENCY), "force of sample 101 is not a finite number"),
        ((*changed("time", np.inf), FREQUENCY), "time of sample 101 is not a finite number"),
        ((*changed("time", 0.0), FREQUENCY), "does not increase at sample 101"),
        (
            tuple(np.delete(column, 100) for column in record()) + (FREQUENCY,),
            "not sampled evenly at sample 101",
        ),
        ((record()[0], record()[1] * 0, record()[2], FREQUENCY), "the force does not vary"),
        ((record()[0][:-1], *record()[1:], FREQUENCY), "differ in length"),
        (tuple(column[:3] for column in record()) + (FREQUENCY,), "holds 3 samples"),
    ],
)
def test_records_that_cannot_be_reduced_are_refused(arguments, words):
    with pytest.raises(InputError, match=words) as caught:
        harmonic_response(*arguments)
    assert "\n" not in str(caught.value)


def test_the_largest_time_step_is_said_at_any_frequency():
    for frequency, most in ((40.0, "0.00125"), (3.0, "0.0166"), (1e5, "5e-07")):
        with pytest.raises(InputError, match=f"give at most {most} s"):
            require_steps(1.0, frequency)
        require_steps(float(most), frequency)
