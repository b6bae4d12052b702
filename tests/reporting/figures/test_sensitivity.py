"""Figs. 11-14: the right parameter, the right factors, against the right laws."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from tiny_results import LAWS, modulus

from asphalt_nscd.reporting.figures import SEVERAL, sensitivity, style

PARAMETERS = [of for module, of in SEVERAL.values() if module == "sensitivity"]
FIELDS = {"Em": "modulus_m", "eta_m": "viscosity_m", "Ek": "modulus_k", "eta_k": "viscosity_k"}


def inputs(results, parameters=("Em",), factors=(0.5, 1.5)):
    changed = []
    for parameter in parameters:
        for factor in factors:
            name = f"{parameter}{factor}"
            changed += results.simulations(
                ratios=lambda sample, factor=factor: factor, name=name, parameter=parameter, factor=factor
            )
    return {
        "sensitivity": changed,
        "simulations": results.simulations(),
        "measured": results.measured(),
        "laws": results.laws(20.0),
    }


@pytest.mark.parametrize("parameter", PARAMETERS)
def test_lines_are_the_law_with_this_parameter_changed(results, parameter):
    figure = sensitivity.figure_of(parameter)(**inputs(results, PARAMETERS))
    frequency = np.geomspace(3.0, 40.0, 200)
    for axes, column in zip(figure.axes, (0, 1), strict=True):
        laws = [line for line in axes.lines if len(line.get_xdata()) > 3]
        field, scale = FIELDS[parameter], (1e-3, 1.0)[column]
        for line, factor, dash in zip(laws, (0.5, 1.0, 1.5), ("long", "-", "short"), strict=True):
            law = replace(LAWS[20.0], **{field: factor * getattr(LAWS[20.0], field)})
            told = [scale * modulus(law, f)[column] for f in frequency]
            np.testing.assert_allclose(line.get_data(), [frequency, told], rtol=1e-9)
            dashes = {"long": style.DASHES[1], "short": style.DASHES[2]}.get(dash)
            assert dash == "-" or line._unscaled_dash_pattern[1] == dashes[1]


def test_points_labels_and_units(results):
    """Means of the samples, open ones measured, side by side; a name at the last point of each."""
    figure = sensitivity.figure_of("Em")(**inputs(results))
    expected = np.array([modulus(LAWS[20.0], f) for f in (3.0, 10.0, 40.0)]).T
    for axes, told in zip(figure.axes, ([1e-3, 0.0], [1.0, 0.01]), strict=True):
        column = expected[0] if axes is figure.axes[0] else expected[1]
        drawn = [bars[0] for bars in axes.containers if len(bars[0].get_xdata())]  # not the legend's
        measured, *simulated = drawn
        assert measured.get_markerfacecolor() == "white"
        np.testing.assert_allclose(measured.get_xydata().T, [np.array([3, 10, 40]) / 1.025, told[0] * column])
        for points, factor in zip(simulated, (0.5, 1.0, 1.5), strict=True):
            values = factor * told[0] * column if axes is figure.axes[0] else column + told[1]
            np.testing.assert_allclose(points.get_xydata().T, [1.025 * np.array([3, 10, 40]), values])
        ends = [text.xy[1] for text in axes.texts]
        assert ends == pytest.approx([points.get_ydata()[-1] for points in simulated])
        assert [text.get_color() for text in axes.texts] == [points.get_color() for points in simulated]
        names = [text.get_text() for text in axes.texts]
        assert names == ["$E_m$ \N{MINUS SIGN}50 %", "$E_m$", "$E_m$ +50 %"] and axes.get_ylim()[0] == 0.0
    assert [axes.get_ylabel() for axes in figure.axes] == ["|E*| (GPa)", "phase angle (°)"]
    legend = [text.get_text() for text in figure.legends[0].get_texts()]
    assert legend == ["reconstructed, 20 °C", "simulated", "Burgers law of the bonds"]
