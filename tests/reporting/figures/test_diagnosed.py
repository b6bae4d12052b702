"""Figures of the diagnosis: what is marked, which unit, which origin, and what stands where nothing can be drawn."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest
from matplotlib.container import ErrorbarContainer
from matplotlib.patches import Rectangle
from tiny_results import LAWS, modulus

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.store import read_json, write_json, write_table
from asphalt_nscd.reporting.figures import fig10_extended, fig_black, fig_limits, fig_master, fig_residual_map
from asphalt_nscd.rheology.parabolic import TwoS2P1D
from asphalt_nscd.rheology.shift import WLF
from asphalt_nscd.rheology.spectrum_io import write_spectrum


def texts_of(figure):
    legends = [
        text.get_text() for legend in figure.legends for text in (legend.get_title(), *legend.get_texts())
    ]
    return legends + [text.get_text() for axes in figure.axes for text in axes.texts]


def outlined(axes):
    return {patch.get_xy() for patch in axes.patches if isinstance(patch, Rectangle) and not patch.get_fill()}


def test_map_marks_what_scatter_does_not_explain(results):
    figure = fig_residual_map.draw(**results.diagnosis())
    before, after, phase_before, phase_after = figure.axes[:4]
    corners = {(k + 0.06, 1.06) for k in range(3)}  # the row of 20 degC
    assert outlined(before) == outlined(phase_before) == corners
    # 1 % is sqrt(2) standard deviations of the mean of two specimens.
    assert not outlined(after) and not outlined(phase_after)
    assert [text.get_text() for text in before.texts] == 3 * ["0.0"] + 3 * ["20"]
    assert [text.get_text() for text in phase_after.texts] == 6 * ["0.0"]
    norms = [axes.collections[0].norm for axes in figure.axes[:4]]
    assert norms[0].vmax == norms[1].vmax >= 20.0 and norms[2].vmax == norms[3].vmax
    assert "reconstructed data, means over specimens" in texts_of(figure)
    assert "|E*| reconstructed − simulated (%)" in [axes.get_xlabel() for axes in figure.axes]


def test_residual_of_three_standard_deviations_of_the_mean_is_the_edge(results):
    data = results.diagnosis()
    table = pd.read_csv(data["residuals"][0], dtype={"specimen": str})
    edge = 3.0 / np.sqrt(2.0)
    table["residual_E_after_percent"] = np.where(table["frequency_Hz"] == 3.0, 1.01 * edge, 0.99 * edge)
    write_table(data["residuals"][0], table)
    after = fig_residual_map.draw(**data).axes[1]
    assert outlined(after) == {(0.06, 0.06), (0.06, 1.06)}


def test_map_after_is_that_of_the_tests_simulated_again(results):
    """3 % too soft and 2 degrees too little, as the bars of the report have it, whatever the diagnosis modelled."""
    data, extended = results.diagnosis(), results.simulations(name="extended")
    table = pd.read_csv(extended[0])
    for temperature, law in LAWS.items():
        for frequency in (3.0, 10.0, 40.0):
            norm, phase = modulus(law, frequency)
            at = (table["temperature_C"] == temperature) & (table["frequency_Hz"] == frequency)
            table.loc[at, ["E_MPa", "phase_deg"]] = 0.97 * norm, phase - 2.0
    write_table(extended[0], table)
    before, after, _, phase_after = fig_residual_map.draw(**data, extended=extended).axes[:4]
    assert [text.get_text() for text in after.texts] == 6 * ["3.0"]
    assert [text.get_text() for text in phase_after.texts] == 6 * ["2.0"]
    assert [text.get_text() for text in before.texts] == 3 * ["0.0"] + 3 * ["20"]


def test_condition_that_was_not_simulated_is_empty_before(results):
    data = results.diagnosis()
    table = pd.read_csv(data["residuals"][0], dtype={"specimen": str})
    before = [name for name in table if "_before_" in name]
    table.loc[table["frequency_Hz"] == 3.0, before] = np.nan
    write_table(data["residuals"][0], table)
    assert [len(axes.texts) for axes in fig_residual_map.draw(**data).axes[:4]] == [4, 6, 4, 6]
    assert fig_residual_map.draw(**data).axes[0].collections[0].norm.vmax >= 20.0
    fig_black.draw(**data), fig_master.draw(**data)
    table.loc[0, "E_after_MPa"] = np.nan
    write_table(data["residuals"][0], table)
    with pytest.raises(InputError, match="E_after_MPa"):
        fig_residual_map.draw(**data)


def test_planes_hold_the_same_points(results):
    """Two specimens of the law's values; 20 degC was 20 % and 4 degrees too soft before, and 1 % after."""
    figure = fig_black.draw(**results.diagnosis(origin="measured"))
    black, cole = figure.axes

    def in_planes(size, phase):
        star = 1e-3 * size * np.exp(1j * np.radians(phase))
        return {black: (phase, 1e-3 * size), cole: (star.real, star.imag)}

    for number, (temperature, law) in enumerate(LAWS.items()):
        size, phase = np.array([modulus(law, f) for f in (3.0, 10.0, 40.0)]).T
        off, less, left = (0.2, 4.0, 0.01) if temperature == 20.0 else (0.0, 0.0, 0.0)
        before, after = in_planes(size * np.exp(-off), phase - less), in_planes(size * np.exp(-left), phase)
        for axes, told in in_planes(size, phase).items():
            points = axes.collections[number].get_offsets().T
            np.testing.assert_allclose(points, np.tile(told, 2), rtol=1e-8)
            dashed, solid = axes.lines[2 * number : 2 * number + 2]
            np.testing.assert_allclose(dashed.get_data(), before[axes], rtol=1e-8)
            np.testing.assert_allclose(solid.get_data(), after[axes], rtol=1e-8)
            assert (dashed.get_linestyle(), solid.get_linestyle()) == ("--", "-")
    assert {"measured", "simulated before", "simulated after", "0 °C", "20 °C"} <= set(texts_of(figure))
    legend = {line.get_label(): line.get_linestyle() for line in fig_black.keys("measured")[1:]}
    assert legend == {"simulated before": "--", "simulated after": "-"}
    labels = [(axes.get_xlabel(), axes.get_ylabel()) for axes in (black, cole)]
    assert labels == [
        ("phase angle (°)", "|E*| (GPa)"),
        ("storage modulus E1 (GPa)", "loss modulus E2 (GPa)"),
    ]


def test_master_curve_stands_on_frequency_times_shift_factor(results):
    figure = fig_master.draw(**results.diagnosis())
    norm, lag, shifts = figure.axes
    for number, (law, places) in enumerate(zip(LAWS.values(), ([300, 1000, 4000], [3, 10, 40]), strict=True)):
        size, phase = np.array([modulus(law, f) for f in (3.0, 10.0, 40.0)]).T
        for axes, told in ((norm, 1e-3 * size), (lag, phase)):
            points = axes.collections[number].get_offsets().T
            np.testing.assert_allclose(points, [2 * places, np.tile(told, 2)], rtol=1e-8)
            after = told * np.exp(-0.01 * number) if axes is norm else told
            np.testing.assert_allclose(axes.lines[number].get_data(), [places, after], rtol=1e-8)
            assert axes.lines[number].get_color() == shifts.lines[number].get_color()
    assert [(*line.get_xdata(), *line.get_ydata()) for line in shifts.lines] == [(0.0, 2.0), (20.0, 0.0)]
    assert "reconstructed" in texts_of(figure) and "modelled" in texts_of(figure)
    assert norm.get_xlabel() == lag.get_xlabel() == "reduced frequency (Hz), at 20 °C"
    labels = [axes.get_ylabel() for axes in figure.axes]
    assert labels == ["|E*| (GPa)", "phase angle (°)", "log10 shift factor"]


def test_limits_stand_in_units_of_use_beside_what_was_found(results):
    figure = fig_limits.draw(diagnosis=results.diagnosis()["diagnosis"])
    delay, clamp, bias = figure.axes
    assert [axes.get_title(loc="left") for axes in figure.axes] == [
        "channel delay (ms)",
        "loose clamp (1/TPa)",
        "temperature bias (K)",
    ]
    assert [bar.get_width() for bar in delay.patches] == pytest.approx([0.03])
    assert [bar.get_width() for bar in clamp.patches] == pytest.approx([0.9, 0.8])
    assert [label.get_text() for label in clamp.get_yticklabels()] == ["specimen 1", "specimen 2"]
    assert [label.get_text() for label in bias.get_yticklabels()] == ["0 °C", "20 °C"]
    found, *others = [c for axes in figure.axes for c in axes.containers if isinstance(c, ErrorbarContainer)]
    assert not others and found in clamp.containers
    assert (found[0].get_xdata()[0], found[0].get_ydata()[0]) == pytest.approx((3.0, 1))
    (bar,) = found[2][0].get_segments()
    assert bar[:, 0] == pytest.approx([3.0 - 1.96 * 0.2, 3.0 + 1.96 * 0.2])
    assert "reconstructed data" in texts_of(figure)


def test_what_was_found_at_0_degC_stands_at_its_isotherm(results):
    (path,) = results.diagnosis()["diagnosis"]
    content = read_json(path)
    bias = {"bias": {"value": 1.5, "std_error": 0.1, "unit": "K"}}
    content["ladder"].append(
        content["ladder"][0] | {"cause": "temperature_bias", "where": 0.0, "parameters": bias}
    )
    write_json(path, content)
    axes = fig_limits.draw(diagnosis=[path]).axes[2]
    (found,) = [bars for bars in axes.containers if isinstance(bars, ErrorbarContainer)]
    assert (found[0].get_xdata()[0], found[0].get_ydata()[0]) == pytest.approx((1.5, 0))


def test_before_and_after_share_their_axes(results, tmp_path):
    after = results.simulations(name="after", samples=("s1", "s2"))
    table = pd.read_csv(after[0]).assign(phase_deg=lambda frame: frame["phase_deg"] + 5.0)
    write_table(after[0], table)
    law = TwoS2P1D(30e6, 36e9, k=0.2, h=0.58, delta=2.2, tau=0.06, beta=250.0, shift=WLF(24.0, 160.0, 15.0))
    common = tmp_path / "law.json"
    write_spectrum(common, law, source="stated", rms_log_residual=0.0)
    figure = fig10_extended.draw(
        simulations=results.simulations(),
        extended=after,
        measured=results.measured(),
        laws=results.laws(*LAWS),
        common=[common],
    )
    first, second = figure.axes
    assert first.get_ylim() == second.get_ylim() and first.get_ylim()[0] <= 0.0
    filled = [[bars[0].get_ydata() for bars in axes.containers][1::2] for axes in (first, second)]
    for before, later in zip(*filled, strict=True):
        assert later - before == pytest.approx(5.0)
    assert {"reconstructed", "simulated", "law of the bonds"} <= set(texts_of(figure))
    # the laws as they are between the tested frequencies, with the bump of Burgers' law
    frequency = np.geomspace(3.0, 40.0, 200)
    burgers, smooth = (
        next(line for line in axes.lines if len(line.get_xdata()) == 200) for axes in (first, second)
    )
    assert burgers.get_ydata() == pytest.approx(
        np.degrees(np.angle(LAWS[0.0].complex_modulus(2 * np.pi * frequency)))
    )
    assert smooth.get_ydata() == pytest.approx(
        np.degrees(np.angle(law.complex_modulus(2 * np.pi * frequency, 0.0)))
    )


@pytest.mark.parametrize("draw", [fig_residual_map.draw, fig_black.draw, fig_master.draw])
def test_table_without_a_column_is_refused(results, draw):
    data = results.diagnosis()
    data["residuals"][0].write_text(data["residuals"][0].read_text().replace("E_after_MPa", "after"))
    with pytest.raises(InputError, match="column 'E_after_MPa' is missing"):
        draw(**data)
