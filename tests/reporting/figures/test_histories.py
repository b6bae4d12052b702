"""Figs. 6, 7 and 8: what is taken from a test file and how it is named."""

from __future__ import annotations

import numpy as np
import pytest

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.store import Record, load, save
from asphalt_nscd.measurements.geometry import shape_of
from asphalt_nscd.reporting.figures import fig06, fig07, fig08, numbers
from asphalt_nscd.reporting.figures.records import last_cycle


def legend_of(axes):
    return [text.get_text() for text in axes.get_legend().get_texts()]


def test_last_cycle_begins_where_the_displacement_rises_through_zero(results):
    (path,) = results.test(cycles=3)
    time, displacement, force = last_cycle(load(path, "test"))
    assert time.size in (1000, 1001) and time[-1] == pytest.approx(0.5)
    assert displacement[-1] == pytest.approx(0.0, abs=1e-12)
    assert displacement[np.argmin(np.abs(time - 0.125))] == pytest.approx(50e-6)
    assert force[-1] == pytest.approx(40.0 * np.sin(0.3))


def test_broken_last_cycle_is_left_out(results):
    (path,) = results.test(cycles=3)
    record = load(path, "test")
    for name in ("time_s", "displacement_m", "force_N"):
        record.arrays[name] = record.arrays[name][:2700]
    time, displacement, _ = last_cycle(record)
    assert time[-1] == pytest.approx(0.5) and displacement[-1] == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize(("frequency", "step"), [(3.0, 2e-5), (3.0, 2e-4), (6.0, 1e-4), (40.0, 5e-5)])
def test_last_cycle_where_the_time_step_does_not_divide_it(frequency, step):
    time = step * np.arange(1, round(2.0 / frequency / step) + 1)
    angle = 2.0 * np.pi * frequency * time
    arrays = {
        "time_s": time,
        "displacement_m": np.sin(angle),
        "force_N": np.where(time * frequency < 1.0, 1, 2),
    }
    cycle, displacement, force = last_cycle(Record(arrays, {"frequency_Hz": frequency}, digest=""))
    assert cycle[0] < 1.01 * step and cycle[-1] > 1.0 / frequency - 1.01 * step
    assert (force[1:] == 2).all()
    assert displacement == pytest.approx(np.sin(2.0 * np.pi * frequency * cycle), abs=1e-9)


def steps_of(results, name, tests, **attributes):
    return [
        results.test(f"{name}{step}", force=force, time_step_s=step, E_MPa=100.0 * force, **attributes)[0]
        for step, force in tests.items()
    ]


def test_time_steps_solved_and_swept_each_over_its_own_solution(results):
    part = steps_of(results, "p", {5e-5: 20.0})
    stopped = steps_of(results, "a", {1e-4: 2.0, 2e-4: 1.0}, tolerance=1e-4)
    stopped += steps_of(results, "b", {1e-4: 10.0, 2e-4: 5.0}, tolerance=1e-5)
    figure = fig06.draw(solved=steps_of(results, "c", {2e-4: 40.0, 2e-5: 40.4}), part=part, stopped=stopped)
    left, middle, right = figure.axes
    cycle = np.linspace(0.0, 500.0, 1001)  # ms, of 2 Hz
    # amplitudes over that of the shortest step; and of the finest tolerance alone, over that of the part, solved
    for axes, amplitudes, steps in ((left, (40 / 40.4, 1.0), (200, 20)), (middle, (0.25, 0.5), (200, 100))):
        assert legend_of(axes) == [f"{step} µs" for step in steps]
        for line, amplitude in zip(axes.lines, amplitudes):
            time, force = line.get_data()
            assert time[0] == 0.0 and time[-1] == pytest.approx(cycle[-1], abs=0.6)
            assert force == pytest.approx(amplitude * np.sin(4e-3 * np.pi * time + 0.3), abs=0.01 * amplitude)
        assert axes.lines[0].get_linewidth() > axes.lines[1].get_linewidth()
        assert (axes.get_xlabel(), axes.get_ylabel()) == (
            "time from rest (ms)",
            "force over solved amplitude",
        )
    assert legend_of(right) == [numbers.power(1e-4), numbers.power(1e-5), "solved"]
    of_tolerances = [(line.get_xdata().tolist(), line.get_ydata().tolist()) for line in right.lines[:2]]
    assert of_tolerances == [([1e-4, 2e-4], [0.1, 0.05]), ([1e-4, 2e-4], [0.5, 0.25])]
    assert right.lines[2].get_ydata() == [1.0, 1.0] and right.get_xscale() == right.get_yscale() == "log"
    assert [label.get_text() for label in right.get_xticklabels()] == ["100", "200"]
    assert right.get_ylim()[0] < 0.05 and right.get_ylim()[1] > 1.0
    assert (right.get_xlabel(), right.get_ylabel()) == ("time step $dt$ (µs)", "|E*| over solved")


def test_displacement_and_force_with_their_amplitudes(results):
    figure = fig07.draw(test=results.test(lead=0.3))
    upper, lower = figure.axes
    assert upper.get_ylabel() == "displacement (µm)" and lower.get_ylabel() == "force (N)"
    for axes, amplitude, lead in ((upper, 50.0, 0.0), (lower, 40.0, 0.3)):
        time, value = axes.lines[0].get_data()
        assert value == pytest.approx(amplitude * np.sin(4e-3 * np.pi * time + lead), abs=1e-3 * amplitude)
        assert axes.get_ylim() == pytest.approx((-1.25 * amplitude, 1.25 * amplitude), rel=1e-3)
        # the crest of the force and that of the displacement, ms, each in the colour of its curve
        crests = {line.get_color(): line.get_xdata()[0] for line in axes.lines[-2:]}
        colours = lower.lines[0].get_color(), upper.lines[0].get_color()
        expected = [125.0 - 1e3 * 0.3 / (4.0 * np.pi), 125.0]
        assert [crests[colour] for colour in colours] == pytest.approx(expected, abs=0.6)
    assert lower.get_xlim() == (0.0, 500.0) and lower.get_xlabel() == "time in the last cycle (ms)"
    assert [text.get_text() for text in upper.texts] == ["$z_0$ = 50 µm"]
    assert [text.get_text().strip() for text in lower.texts] == [
        "$F_0$ = 40 N",
        f"$\\Psi$ = {np.degrees(0.3):.1f}°",
    ]


def test_profiles_at_instants_and_histories_at_heights(results):
    """The empty layer in the middle is left out; theory is that of the beam, times the velocity of the head."""
    left, right = fig08.draw(test=results.test(), specimen=results.specimen()).axes
    heights, shares = np.array([10.0, 30.0, 70.0, 90.0]), np.array([0.1, 0.3, 0.7, 0.9])
    head = 1e3 * 2.0 * np.pi * 2.0 * 50e-6 * np.cos(np.pi * np.arange(5) / 4.0)  # mm/s, at eighths of a cycle
    theory, spheres = left.lines[:10:2], left.lines[1:10:2]
    beam = shape_of(load(results.specimen()[0], "specimen").attributes)
    for velocity, line, points in zip(head, theory, spheres, strict=True):
        assert points.get_marker() != "None" and points.get_ydata() == pytest.approx(heights)
        assert points.get_xdata() == pytest.approx(velocity * shares, abs=0.02)
        along, height = line.get_data()
        assert height == pytest.approx(np.linspace(0.0, 60.0, 200))
        assert along == pytest.approx(velocity * beam.line(1e-3 * height), abs=0.02)
    assert (
        legend_of(left) == ["spheres", "beam theory"] and left.lines[11].get_color() == theory[0].get_color()
    )
    assert [text.get_text() for text in left.texts] == ["0", "T/8", "T/4", "3T/8", "T/2"]
    assert [text.xy[0] for text in left.texts] == pytest.approx(head, abs=0.02)
    assert left.get_ylim() == (0.0, 60.0) and right.get_xlim() == (0.0, 0.5)
    # layers nearest to fifths of the uppermost, over half a cycle
    for line, share in zip(right.lines, (0.1, 0.3, 0.7, 0.7, 0.9)):
        cycles, velocity = line.get_data()
        assert cycles[0] == pytest.approx(0.0, abs=2e-3) and cycles[-1] == pytest.approx(0.5, abs=5e-3)
        assert velocity == pytest.approx(share * head[0] * np.cos(2.0 * np.pi * cycles), abs=1e-6)
    assert [text.get_text() for text in right.texts] == [f"{mm} mm" for mm in (10, 30, 70, 70, 90)]
    assert right.get_xlabel() == r"time in the last cycle, $t/T$"
    assert right.get_ylabel() == left.get_xlabel() == "mean velocity of the spheres (mm/s)"


def test_last_cycle_that_begins_a_step_early(results):
    (path,) = results.test()
    record = load(path, "test")
    arrays = record.arrays | {
        "profile/time_s": record.arrays["profile/time_s"] - 1.5 * record.arrays["time_s"][0]
    }
    save(path, "test", arrays, record.attributes)
    _, right = fig08.draw(test=[path], specimen=results.specimen()).axes
    assert right.lines[0].get_xdata()[0] == pytest.approx(-0.0005, abs=1e-9)


def test_test_without_velocities_is_refused(results):
    (path,) = results.test()
    record = load(path, "test")
    arrays = {name: value for name, value in record.arrays.items() if not name.startswith("profile")}
    save(path, "test", arrays, record.attributes)
    with pytest.raises(InputError, match="holds no velocities"):
        fig08.draw(test=[path], specimen=results.specimen())
