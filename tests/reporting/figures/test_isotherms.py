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


@pytest.mark.parametrize(
    ("figure_of", "column", "unit", "more", "label"),
    [(fig09, 0, 1e-3, 0.0, "|E*| (GPa)"), (fig10, 1, 1.0, 0.01, "phase angle (°)")],
)
def test_one_law_line_and_two_sets_of_points_per_temperature(results, figure_of, column, unit, more, label):
    figure = figure_of(
        simulations=results.simulations(), measured=results.measured(), laws=results.laws(0.0, 20.0)
    )
    (axes,) = figure.axes
    points, fine = points_of(axes), np.geomspace(3.0, 40.0, 200)
    lines = [line for line in axes.lines if len(line.get_xdata()) == 200]
    for number, law in enumerate(LAWS.values()):
        told = unit * np.array([modulus(law, f)[column] for f in (3.0, 10.0, 40.0)])
        for kind, by, off in (("open", 1 / 1.025, 0.0), ("filled", 1.025, more)):
            drawn = points[kind][number]
            np.testing.assert_allclose(
                drawn.get_xydata().T, [by * np.array([3, 10, 40]), told + off], rtol=1e-9
            )
            assert drawn.get_color() == lines[number].get_color() == axes.texts[number].get_color()
        np.testing.assert_allclose(
            lines[number].get_data(), [fine, [unit * modulus(law, f)[column] for f in fine]], rtol=1e-9
        )
        assert axes.texts[number].xy == pytest.approx((40.0 * 1.025, told[-1] + more))
    assert axes.get_ylabel() == label and axes.get_xlabel() == "frequency (Hz)"
    assert axes.get_yscale() == ("log" if column == 0 else "linear")
    assert [text.get_text() for text in axes.texts] == ["0 °C", "20 °C"]
    faces = [line.get_markerfacecolor() for line in figure.legends[0].legend_handles]
    assert faces[0] == "white" != faces[1]
    assert legend_of(figure)[1:] == ["simulated, one sample", "Burgers law of the bonds"]


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
