"""Figures of a forecast: what is drawn is what its tables hold, over the axis that says so."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest
from forecasting.conftest import CONTENT
from tiny_results import band_of

from asphalt_nscd.forecasting.forecast import forecast
from asphalt_nscd.forecasting.recipe import recipe_of
from asphalt_nscd.forecasting.written import PARTS, amplification, composition
from asphalt_nscd.reporting.figures import fig_forecast, forecast_panels, style
from asphalt_nscd.rheology.shift import WLF

COLD = 316.22776601683796  # a_T at 0 degC: 10 ** (10 * 20 / (100 - 20))
RIVALS = {"Hirsch": 2.0, "Witczak 1-40D": 3.0, "volumes alone": 0.5}


@pytest.fixture
def tables():
    """Points by temperature, which along the reduced frequency are the last two and then the first two."""
    points = pd.DataFrame(
        {
            "temperature_C": [0.0, 0.0, 20.0, 20.0],
            "frequency_Hz": [1.0, 10.0, 1.0, 10.0],
            "E_MPa": [4000.0, 8000.0, 500.0, 2000.0],
            "phase_deg": [30.0, 20.0, 50.0, 40.0],
        }
    )
    rivals = points[["temperature_C", "frequency_Hz"]].copy()
    for name, title in forecast_panels.TITLES.items():
        rivals[f"{name}_E_MPa"] = RIVALS[title] * points["E_MPa"]
        if name != "witczak":
            rivals[f"{name}_phase_deg"] = RIVALS[title] + points["phase_deg"]
    low, high = (
        {f"{q}_{end}_{unit}": by * points[f"{q}_{unit}"] for q, unit in (("E", "MPa"), ("phase", "deg"))}
        for end, by in (("low", 0.8), ("high", 1.25))
    )
    return points.assign(**low, **high), rivals


def found(shifted=True):
    binder = SimpleNamespace(shift=WLF(10.0, 100.0, 20.0))
    return SimpleNamespace(
        recipe=SimpleNamespace(binder=binder, shifted=shifted, temperature=np.array([0.0, 20.0]))
    )


def test_modulus_and_phase_stand_over_reduced_frequency_and_over_each_other(tables):
    points, rivals = tables
    measured = points.iloc[[0]].assign(E_MPa=4400.0, phase_deg=27.0)
    figure = forecast_panels.curves(found(), points, rivals, measured)
    modulus, phase, black = figure.axes
    x, e, p = [1.0, 10.0, COLD, 10 * COLD], np.array([500, 2000, 4000, 8000]), np.array([50, 40, 30, 20])
    named = {line.get_label(): line for line in modulus.lines}
    for title, by in ({"forecast": 1.0} | RIVALS | {"measured": None}).items():
        told = [[COLD], [4400.0]] if by is None else [x, by * e]
        np.testing.assert_allclose(named[title].get_data(), told)
    rows = [[x, p], [x, 2.0 + p], [x, 0.5 + p], [[COLD], [27.0]]]
    for line, told in zip(phase.lines, rows, strict=True):
        np.testing.assert_allclose(line.get_data(), told)
    rows = [[p, e], [2.0 + p, 2 * e], [0.5 + p, 0.5 * e], [[27.0], [4400.0]]]
    for line, told in zip(black.lines, rows, strict=True):
        np.testing.assert_allclose(line.get_data(), told)
    for axes, values in ((modulus, e), (phase, p)):
        np.testing.assert_allclose(band_of(axes), [x, 0.8 * values, 1.25 * values])
        assert axes.get_xlabel() == "reduced frequency (Hz)\n0 to 20 °C, at 20 °C"
        assert axes.get_xscale() == "log"
    assert [axes.get_ylabel() for axes in figure.axes] == ["|E*| (MPa)", "phase angle (°)", "|E*| (MPa)"]
    assert black.get_xlabel() == "phase angle (°)" and [a.get_yscale() for a in figure.axes] == [
        "log",
        "linear",
        "log",
    ]
    assert modulus.get_ylim() == black.get_ylim() == pytest.approx((80.0, 20000.0))
    assert phase.get_ylim() == black.get_xlim() == (0.0, 90.0)
    alone = forecast_panels.curves(found(shifted=False), points, rivals).axes
    assert alone[0].get_xlabel() == "frequency (Hz)" and len(alone[1].lines) == 3


def test_grading_volumes_and_what_each_part_amplifies():
    made = forecast(recipe_of(CONTENT))
    figure = forecast_panels.parts(made)
    grading, volumes, over = figure.axes
    np.testing.assert_allclose(
        grading.lines[0].get_data(), [[0.063, 2, 4, 6, 10], [8.77, 41.238, 56.062, 72.324, 100]]
    )
    bars = {
        label.get_text(): bar.get_width() for label, bar in zip(volumes.get_yticklabels(), volumes.patches)
    }
    assert bars == pytest.approx({name: 100 * share for name, share in composition(made.recipe).items()})
    lines = {line.get_label(): line.get_data() for line in over.lines}
    assert list(lines) == list(PARTS)
    for name, (binder, ratio) in lines.items():
        assert (binder[0], binder[-1]) == pytest.approx((1e-3, 1e3))
        np.testing.assert_allclose(ratio, amplification(made, name, 1e6 * binder))
    assert [axes.get_xlabel() for axes in figure.axes] == [
        "sieve (mm)",
        "volume of the mix (%)",
        "|E*| of the binder (MPa)",
    ]
    assert grading.get_ylabel() == "passing (%)" and over.get_ylabel() == "mix over binder"


def test_the_strongest_input_stands_on_top_and_the_model_below():
    (axes,) = forecast_panels.inputs({"a": 2.0, "b": -5.0}, {"c": -1.0, "d": 0.5}).axes
    names = [label.get_text() for label in axes.get_yticklabels()]
    bars = [(bar.get_width(), bar.get_facecolor()) for bar in axes.patches]
    grey, blue = (style.matplotlib.colors.to_rgba(colour) for colour in (style.GREY, style.BLUE))
    assert names == ["d", "c", "a", "b"]
    assert bars == [(0.5, grey), (-1.0, grey), (2.0, blue), (-5.0, blue)]
    assert axes.get_xlabel() == "mean change of |E*| (%)"


def test_each_mix_has_a_column_with_measured_points_and_lines_of_forecasts(tmp_path):
    rows = [
        (
            mix,
            name,
            omega,
            100.0 * n * omega,
            10.0 * n + omega,
            7.0 * omega,
            60.0 - omega + 10 * (mix == "M2"),
        )
        for mix in ("M1", "M2")
        for n, name in enumerate(fig_forecast.SHOWN, 1)
        for omega in (1.0, 2.0)
    ]
    columns = ["mix", "forecast", "omega_rad_s", "E_MPa", "phase_deg", "measured_E_MPa", "measured_phase_deg"]
    pd.DataFrame(rows, columns=columns).to_csv(tmp_path / "points.csv", index=False)
    figure = fig_forecast.draw(points=[tmp_path / "points.csv"])
    for column, (norm, phase) in enumerate(zip(figure.axes[:2], figure.axes[2:], strict=True)):
        top = [line.get_data() for line in norm.lines]
        below = [line.get_data() for line in phase.lines]
        np.testing.assert_allclose(top, [[[1, 2], y] for y in ([7, 14], [100, 200], [200, 400], [300, 600])])
        own = np.array([59.0, 58.0]) + 10 * column
        np.testing.assert_allclose(below, [[[1, 2], y] for y in (own, [11, 12], [21, 22], [31, 32])])
        assert norm.get_title() == f"M{column + 1}" and phase.get_xlabel() == "ω (rad/s)"
    named = [line.get_label() for line in figure.axes[0].lines]
    assert named == ["measured (published law)", "forecast", "Hirsch", "volumes alone"]
    assert figure.axes[0].get_ylabel() == "|E*| (MPa)" and figure.axes[2].get_ylabel() == "phase angle (°)"
