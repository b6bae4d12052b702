"""The causality map: sign, scale, marks, and what stands where nothing is judged."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.store import write_table
from asphalt_nscd.reporting.figures import fig_causality_map


def drawn(results, causality=None):
    return fig_causality_map.draw(
        causality=causality or results.causality(), diagnosis=results.diagnosis()["diagnosis"]
    )


def places(axes, look):
    """Column and row of the cells with a mark."""
    lines = [line for line in axes.lines if line.get_marker() == look["marker"]]
    return [(int(x), int(y)) for line in lines for x, y in zip(*line.get_data(), strict=True)]


def test_each_specimen_has_a_panel_with_measured_less_required(results):
    first, second, bar = drawn(results).axes
    assert [axes.get_title() for axes in (first, second)] == ["specimen 1", "specimen 2"]
    assert [text.get_text() for text in second.texts] == ["\N{MINUS SIGN}0.2"] * 2 + ["4.8"] + [
        "\N{MINUS SIGN}0.2"
    ] * 5
    assert [text.get_text() for text in first.texts] == ["\N{MINUS SIGN}0.2"] * 8
    norm = first.collections[0].norm
    assert norm is second.collections[0].norm and norm.vmax == -norm.vmin == 5.0
    assert "scale ±5°" in bar.get_xlabel()


def test_marks_stand_where_tests_are_suspect_or_flagged(results):
    first, second, _ = drawn(results).axes
    assert places(second, fig_causality_map.OUT) == places(second, fig_causality_map.FLAG) == [(2, 0)]
    assert not places(first, fig_causality_map.OUT) and not places(second, fig_causality_map.IN_USE)
    assert places(first, fig_causality_map.IN_USE) == [(3, 1)]


def test_numbers_beyond_two_standard_errors_are_bold(results):
    _, second, _ = drawn(results).axes
    clear = {text.get_text() for text in second.texts if text.get_fontweight() == "bold"}
    assert clear == {"4.8"}


def test_test_that_was_not_judged_has_no_number(results):
    (path,) = results.causality()
    table = pd.read_csv(path, dtype={"specimen": str})
    table.loc[0, ["phase_required_deg", "std_error_deg"]] = np.nan
    write_table(path, table)
    assert len(drawn(results, [path]).axes[0].texts) == 7


def test_a_sentence_stands_where_no_test_is_judged(results):
    (path,) = results.causality()
    table = pd.read_csv(path, dtype={"specimen": str})
    table[["phase_required_deg", "std_error_deg"]] = np.nan
    write_table(path, table)
    assert [text.get_text() for text in drawn(results, [path]).texts] == [fig_causality_map.NONE]


def test_table_without_a_column_is_refused(results):
    (path,) = results.causality()
    path.write_text(path.read_text().replace("phase_required_deg", "required"))
    with pytest.raises(InputError, match="column 'phase_required_deg' is missing"):
        drawn(results, [path])
