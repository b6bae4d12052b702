"""What figures and pages draw alike: maps of conditions with their marks, points, bands of colour, numbers."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest
from matplotlib.colors import to_rgba

from asphalt_nscd.reporting.figures import panels, style


def test_a_map_has_a_cell_for_each_condition():
    """Two temperatures and three frequencies, one of which has no value; 30 is dark, 1 is pale."""
    rows = pd.DataFrame(
        [
            (20.0, 1.0, 30.0, True),
            (-5.0, 1.0, 1.0, False),
            (20.0, 10.0, np.nan, True),
            (-5.0, 0.1, -30.0, False),
        ],
        columns=["temperature_C", "frequency_Hz", "value", "framed"],
    ).assign(words=["a", "b", "c", "d"])
    _, axes = style.new_figure(90, 60)
    image = panels.cells(axes, rows, panels.banded(30.0))
    corners = [tuple(path.vertices.min(axis=0)) for path in image.get_paths()]
    assert corners == [(1.0, 1.0), (1.0, 0.0), (0.0, 0.0)]  # column by frequency, row by temperature
    assert image.get_array().tolist() == [30.0, 1.0, -30.0] and image.get_urls() == ["a", "b", "d"]
    numbers = {text.get_position(): (text.get_text(), text.get_color()) for text in axes.texts}
    assert numbers == {
        (1.5, 1.5): ("30", "white"),
        (1.5, 0.5): ("1.0", style.INK),
        (0.5, 0.5): ("−30", "white"),
    }
    (frame,) = (patch for patch in axes.patches if not patch.get_fill())
    assert frame.get_xy() == (1.06, 1.06) and axes.get_xlim() == (0.0, 3.0) and axes.get_ylim() == (0.0, 2.0)
    assert [label.get_text() for label in axes.get_yticklabels()] == ["−5", "20"]
    assert [label.get_text() for label in axes.get_xticklabels()] == ["0.1", "1", "10"]
    assert axes.get_xticks().tolist() == [0.5, 1.5, 2.5]
    panels.marked(axes, rows.assign(marks=[["quality"], ["not used", "quality"], [], ["doubtful"]]))
    marks = [
        (round(line.get_xdata()[0], 2), round(line.get_ydata()[0], 2), line.get_marker())
        for line in axes.lines
    ]
    shown = [mark for mark in marks if mark[2] != "s"]
    assert shown == [(1.91, 1.84, "^"), (1.09, 0.84, "x"), (1.91, 0.84, "^"), (0.09, 0.84, "o")]
    assert [mark[:2] for mark in marks if mark[2] == "s"] == [mark[:2] for mark in shown]


def test_a_broad_map_has_no_numbers_and_every_other_label():
    rows = pd.DataFrame(
        {"temperature_C": 4.0, "frequency_Hz": np.arange(1.0, 10.0), "value": 1.0, "framed": False}
    )
    _, axes = style.new_figure(90, 60)
    panels.cells(axes, rows, panels.standard_errors())
    assert not axes.texts and axes.get_xticks().tolist() == [0.5, 2.5, 4.5, 6.5, 8.5]
    assert [label.get_text() for label in axes.get_xticklabels()] == ["1", "3", "5", "7", "9"]
    _, axes = style.new_figure(90, 60)
    panels.cells(axes, rows[:8], panels.standard_errors())
    assert len(axes.texts) == len(axes.get_xticks()) == 8


@pytest.mark.parametrize(
    ("largest", "edges"),
    [(20.0, [1, 2, 5, 10, 20]), (21.0, [2, 5, 10, 20, 50]), (0.3, [0.02, 0.05, 0.1, 0.2, 0.5])],
)
def test_bands_reach_the_largest_value(largest, edges):
    edges = np.array(edges, float)
    np.testing.assert_allclose(panels.banded(largest).boundaries, [*-edges[::-1], *edges])
    np.testing.assert_allclose(panels.standard_errors().boundaries, [-10, -5, -3, -2, -1, 1, 2, 3, 5, 10])


def test_numbers_have_two_digits_and_a_true_minus():
    assert [panels.rounded(x) for x in (9.94, 9.96, -0.04, -12.6)] == ["9.9", "10", "0.0", "−13"]
    assert panels.rounded(2.0, "+") == "+2.0"


def test_points_are_filled_where_nothing_is_against_them():
    rows = pd.DataFrame({"filled": [True, False], "words": ["a", "b"]})
    _, axes = style.new_figure(90, 60)
    panels.points(axes, [1.0, 2.0], [3.0, 4.0], (style.BLUE, "s"), rows)
    panels.points(axes, [1.0], [3.0], (style.BLUE, "s"), rows[["words"]][:1])
    first, bare = axes.collections
    assert first.get_offsets().tolist() == [[1.0, 3.0], [2.0, 4.0]] and first.get_urls() == ["a", "b"]
    assert np.allclose(first.get_facecolors(), [to_rgba(style.BLUE), to_rgba("white")])
    assert np.allclose(bare.get_facecolors(), [to_rgba("white")])
    assert panels.isotherm_of(pd.Series([-9.0, 3.9, 12.1]), [20.0, -10.0, 4.0]).tolist() == [-10.0, 4.0, 20.0]
    looks = panels.isotherm_looks([4.0, 20.0])
    assert sum(looks[4.0][0][:3]) < sum(looks[20.0][0][:3]) and looks[4.0][1] != looks[20.0][1]


def test_a_line_has_its_band():
    rows = pd.DataFrame({"f": [1.0, 2.0], "phase_after_deg": [5.0, 6.0], "phase_after_low_deg": [4.0, 5.5]})
    rows = rows.assign(phase_after_high_deg=[7.0, 8.0], E_MPa=[1e3, 2e3])
    _, axes = style.new_figure(90, 60)
    panels.line(axes, "f", "E", rows, style.BLUE)
    np.testing.assert_allclose(axes.lines[0].get_data(), [[1, 2], [1, 2]])  # GPa
    assert not axes.collections
