"""Figs. 6, 7 and 8: what is taken from a test file and how it is named."""

from __future__ import annotations

import numpy as np
import pytest

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.store import Record, load, save
from asphalt_nscd.reporting.figures import fig06, fig07, fig08
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
    assert legend_of(left) == ["200 µs", "20 µs"]
    # the finest tolerance alone, over the amplitude of the solved smaller specimen
    largest = [line.get_ydata().max() for line in middle.lines[:2]]
    assert largest == pytest.approx([0.25, 0.5], rel=1e-4)
    assert left.lines[1].get_ydata().max() == pytest.approx(1.0, rel=1e-4)
    of_tolerances = [(line.get_xdata().tolist(), line.get_ydata().tolist()) for line in right.lines[:2]]
    assert of_tolerances == [([1e-4, 2e-4], [0.1, 0.05]), ([1e-4, 2e-4], [0.5, 0.25])]


def test_displacement_and_force_with_their_amplitudes(results):
    figure = fig07.draw(test=results.test(lead=0.3))
    upper, lower = figure.axes
    assert upper.get_ylabel() == "displacement (µm)" and lower.get_ylabel() == "force (N)"
    assert upper.lines[0].get_ydata().max() == pytest.approx(50.0)
    assert lower.lines[0].get_ydata().max() == pytest.approx(40.0, rel=1e-4)
    assert [text.get_text() for text in upper.texts] == ["$z_0$ = 50 µm"]
    assert [text.get_text().strip() for text in lower.texts] == [
        "$F_0$ = 40 N",
        f"$\\Psi$ = {np.degrees(0.3):.1f}°",
    ]
    # the crest of the force and that of the displacement, ms
    crests = [line.get_xdata()[0] for line in lower.lines[-2:]]
    assert crests == pytest.approx([125.0 - 1e3 * 0.3 / (4.0 * np.pi), 125.0], abs=0.6)


def test_profiles_at_instants_and_histories_at_heights(results):
    figure = fig08.draw(test=results.test(), specimen=results.specimen())
    left, right = figure.axes
    assert left.get_xlabel() == "mean velocity of the spheres (mm/s)"
    assert [text.get_text() for text in left.texts] == ["0", "T/8", "T/4", "3T/8", "T/2"]
    profiles = [line for line in left.lines if line.get_marker() != "None" and len(line.get_xdata()) > 1]
    assert len(profiles) == 5
    head = 1e3 * 2.0 * np.pi * 2.0 * 50e-6
    # The empty layer in the middle is left out; the last instant is half a cycle after the first.
    assert profiles[0].get_ydata() == pytest.approx([10.0, 30.0, 70.0, 90.0])
    assert profiles[0].get_xdata() == pytest.approx(head * np.array([0.1, 0.3, 0.7, 0.9]), rel=2e-3)
    assert profiles[-1].get_xdata() == pytest.approx(-head * np.array([0.1, 0.3, 0.7, 0.9]), rel=2e-3)
    assert right.texts[-1].get_text() == "90 mm"


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
