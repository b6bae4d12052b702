"""Figs. 9 and 10: what is drawn for each temperature, and what the legend says it is."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest
from tiny_results import LAWS, modulus

from asphalt_nscd.reporting.figures.isotherms import figure_of

fig09, fig10 = figure_of("E_MPa"), figure_of("phase_deg")


def legend_of(figure):
    return [text.get_text() for legend in figure.legends for text in legend.get_texts()]


def points_of(axes):
    """Markers by (open?, temperature in drawing order): x, y."""
    drawn = [bars[0] for bars in axes.containers]
    return {
        kind: [line for line in drawn if (line.get_markerfacecolor() == "white") == (kind == "open")]
        for kind in ("open", "filled")
    }


def test_one_law_line_and_two_sets_of_points_per_temperature(results):
    figure = fig09(
        simulations=results.simulations(), measured=results.measured(), laws=results.laws(0.0, 20.0)
    )
    (axes,) = figure.axes
    points = points_of(axes)
    assert len(points["open"]) == len(points["filled"]) == len(LAWS)
    assert sum(line.get_marker() == "None" and len(line.get_xdata()) > 3 for line in axes.lines) == len(LAWS)
    assert axes.get_ylabel() == "|E*| (GPa)" and axes.get_xlabel() == "frequency (Hz)"
    assert [text.get_text() for text in axes.texts] == ["0 °C", "20 °C"]


def test_points_are_means_over_samples_with_standard_deviations(results):
    simulations = results.simulations(samples=("s1", "s2"), ratios={"s1": 1.0, "s2": 1.2}.get)
    figure = fig09(simulations=simulations, measured=results.measured(), laws=results.laws(0.0, 20.0))
    bars = figure.axes[0].containers[1]  # of 0 degC, simulated
    expected = np.array([modulus(LAWS[0.0], f)[0] / 1e3 for f in (3.0, 10.0, 40.0)])
    assert bars[0].get_ydata() == pytest.approx(1.1 * expected, rel=1e-9)
    (segments,) = (collection.get_segments() for collection in bars[2])
    half = [0.5 * (segment[1, 1] - segment[0, 1]) for segment in segments]
    assert half == pytest.approx(0.1 * np.sqrt(2.0) * expected, rel=1e-9)
    assert "simulated, mean ± s.d. of 2 samples" in legend_of(figure)


def test_law_line_is_the_law(results):
    figure = fig10(
        simulations=results.simulations(), measured=results.measured(), laws=results.laws(0.0, 20.0)
    )
    (axes,) = figure.axes
    law = next(line for line in axes.lines if line.get_marker() == "None" and len(line.get_xdata()) > 3)
    assert (law.get_xdata()[0], law.get_ydata()[0]) == pytest.approx((3.0, modulus(LAWS[0.0], 3.0)[1]))
    assert (law.get_xdata()[-1], law.get_ydata()[-1]) == pytest.approx((40.0, modulus(LAWS[0.0], 40.0)[1]))
    assert axes.get_ylabel() == "phase angle (°)"


def test_one_sample_and_one_specimen_have_no_bars(results):
    figure = fig09(
        simulations=results.simulations(), measured=results.measured(specimens=("A",)), laws=results.laws(0.0)
    )
    assert all(not bars.has_yerr for bars in figure.axes[0].containers)
    assert "reconstructed, one specimen" in legend_of(figure)


def test_many_frequencies_without_laws(results):
    simulations = results.simulations(frequencies=np.geomspace(0.1, 30.0, 20))
    figure = fig10(simulations=simulations, measured=results.measured("measured"), laws=[])
    figure.draw_without_rendering()
    labels = [label.get_text() for label in figure.axes[0].get_xticklabels()]
    assert "1" in labels and len(labels) < 8
    assert "Burgers law of the bonds" not in legend_of(figure)


def test_temperature_without_measurement_is_drawn_without(results):
    (measured,) = results.measured()
    table = pd.read_csv(measured)
    table[table["temperature_C"] == 0.0].to_csv(measured, index=False)
    figure = fig09(simulations=results.simulations(), measured=[measured], laws=results.laws(0.0))
    sizes = [len(line.get_xdata()) for line in points_of(figure.axes[0])["open"]]
    assert sizes == [3, 0]
    table.assign(temperature_C=table["temperature_C"] + 55.0).to_csv(measured, index=False)
    figure = fig09(simulations=results.simulations(), measured=[measured], laws=results.laws(0.0))
    assert legend_of(figure) == ["simulated, one sample", "Burgers law of the bonds"]
