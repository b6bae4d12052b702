"""Specimens side by side: who stands where, suspects hollow, one axis of reduced frequency."""

from __future__ import annotations

import json

import pytest

from asphalt_nscd.reporting.figures import fig_specimens


def drawn(results, **changes):
    return fig_specimens.draw(
        causality=results.causality(), diagnosis=results.diagnosis(**changes)["diagnosis"]
    )


def points(axes, hollow):
    lines = [line for line in axes.lines if (line.get_markerfacecolor() == "white") == hollow]
    return {(float(x), float(y)) for line in lines for x, y in zip(*line.get_data(), strict=True)}


def test_suspects_are_hollow_and_all_others_full(results):
    black, _, _ = drawn(results).axes
    doubt, fault = sorted(points(black, hollow=True))
    assert doubt == (20.0, pytest.approx(25**0.2)) and fault == (25.0, pytest.approx((2 - 4 / 21) * 10**0.2))
    assert sum(len(line.get_xdata()) for line in black.lines) == 16


def test_specimens_differ_in_colour_and_marker(results):
    full = [line for line in drawn(results).axes[0].lines if line.get_markerfacecolor() != "white"]
    assert len({line.get_marker() for line in full}) == len({line.get_color() for line in full}) == 2


def test_frequencies_are_reduced_by_the_law_that_was_found(results):
    content = json.loads(results.diagnosis()["diagnosis"][0].read_text())
    ladder = [content["ladder"][0] | {"log10_shift": {"4": 2.0, "21": 0.0}}]
    _, modulus, phase = drawn(results, ladder=ladder).axes
    assert {x for x, _ in points(modulus, hollow=False)} >= {10.0, 100.0, 0.1, 25.0}
    assert phase.get_xlabel() == "reduced frequency (Hz), at 21 °C"


def test_without_a_common_law_frequencies_stand_as_they_are(results):
    _, modulus, _ = drawn(results, ladder=[], verdict="nothing_to_explain").axes
    assert {x for x, _ in points(modulus, hollow=False)} == {0.1, 1.0, 10.0, 25.0}
    assert "no law common" in modulus.get_xlabel()
    modulus.figure.canvas.draw()
    labels = [label.get_text() for label in modulus.get_xticklabels() + modulus.get_xticklabels(minor=True)]
    assert [label for label in labels if label] == ["0.1", "1", "10", "25"]
    assert "isotherms of" in modulus.get_title(loc="left")
