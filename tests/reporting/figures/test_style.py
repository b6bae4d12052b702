"""Style: series that differ in grey, labels that do not overlap, a figure of the size asked for."""

from __future__ import annotations

import numpy as np
import pytest
from matplotlib.colors import to_rgb

from asphalt_nscd.reporting.figures import style


def lightness(colour):
    return np.array(to_rgb(colour)) @ [0.299, 0.587, 0.114]


@pytest.mark.parametrize("count", [2, 3, 6, 8])
def test_series_grow_lighter_and_have_their_own_markers(count):
    looks = style.series(count)
    grey = [lightness(colour) for colour, _ in looks]
    assert min(np.diff(grey)) > 0.5 * (grey[-1] - grey[0]) / (count - 1)
    assert grey[-1] < 0.75  # still seen on white
    assert len({marker for _, marker in looks}) == count


@pytest.mark.parametrize("seed", range(5))
def test_spread_keeps_distance_order_and_mean(seed):
    places = np.random.default_rng(seed).uniform(0.0, 10.0, 7)
    moved = style.separate(places, 1.5)
    assert np.diff(np.sort(moved)).min() > 1.5 - 1e-9
    assert (np.argsort(moved) == np.argsort(places)).all()
    assert moved.mean() == pytest.approx(places.mean())


def test_frequency_ticks_are_the_tested_frequencies_where_few():
    figure, axes = style.new_figure(90, 60)
    style.frequency_axis(axes, [40, 3, 6, 3])
    figure.draw_without_rendering()
    assert [label.get_text() for label in axes.get_xticklabels()] == ["3", "6", "40"]
    assert axes.get_xlabel() == "frequency (Hz)"


def test_labels_at_ends_are_in_the_order_of_the_lines_and_apart():
    figure, axes = style.new_figure(90, 60)
    axes.set_xlim(0.0, 1.0)
    axes.set_ylim(0.0, 1.0)
    style.label_ends(axes, 1.0, [0.5, 0.505, 0.1], ["upper?", "upper", "low"], ["k", "k", "k"])
    figure.draw_without_rendering()
    low, high, bottom = sorted((text.get_window_extent() for text in axes.texts), key=lambda box: -box.y0)
    assert low.y0 >= high.y1 - 2.0 and high.y0 > bottom.y1
    assert [text.get_text() for text in sorted(axes.texts, key=lambda t: t.get_window_extent().y0)] == [
        "low",
        "upper?",
        "upper",
    ]


def test_axes_stand_where_the_last_bit_of_the_layout_does_not_show():
    figure, panels = style.new_figure(style.SINGLE, 120.0, rows=7)
    for _ in range(2):  # PDF, then PNG
        figure.draw_without_rendering()
        bounds = np.array([axes.get_position().bounds for axes in panels])
        assert np.abs(bounds - np.round(bounds, 9)).max() < 1e-14
    assert 0.0 < bounds[:, 0].max() < 0.2 and np.all(np.diff(bounds[:, 1]) < 0.0)
