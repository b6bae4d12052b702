"""Figs. 11-14: the right parameter, the right factors, against the right laws."""

from __future__ import annotations

from dataclasses import replace

import pytest
from tiny_results import LAWS, modulus

from asphalt_nscd.reporting.figures import SEVERAL, sensitivity

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
    for axes, column in zip(figure.axes, (0, 1), strict=True):
        laws = [line for line in axes.lines if len(line.get_xdata()) > 3]
        field, scale = FIELDS[parameter], (1e-3, 1.0)[column]
        for line, factor in zip(laws, (0.5, 1.0, 1.5), strict=True):
            law = replace(LAWS[20.0], **{field: factor * getattr(LAWS[20.0], field)})
            assert line.get_ydata()[0] == pytest.approx(scale * modulus(law, 3.0)[column], rel=1e-9)


def test_points_labels_and_units(results):
    figure = sensitivity.figure_of("Em")(**inputs(results))
    left, right = figure.axes
    assert left.get_ylabel() == "|E*| (GPa)" and right.get_ylabel() == "phase angle (°)"
    drawn = [bars[0] for bars in left.containers if bars[0].get_markerfacecolor() != "white"]
    filled = [points.get_ydata()[0] for points in drawn if len(points.get_ydata())]  # not the legend's
    expected = modulus(LAWS[20.0], 3.0)[0] / 1e3
    assert filled == pytest.approx([0.5 * expected, expected, 1.5 * expected], rel=1e-9)
    assert [text.get_text() for text in left.texts] == ["$E_m$ \N{MINUS SIGN}50 %", "$E_m$", "$E_m$ +50 %"]
    legend = [text.get_text() for text in figure.legends[0].get_texts()]
    assert legend[0] == "reconstructed, 20 °C"
