"""Figures beside the paper's: ratio to the law, packing, readings that fail."""

from __future__ import annotations

import matplotlib
import numpy as np
import pandas as pd
import pytest
from matplotlib.colors import to_rgba
from tiny_results import LAWS, modulus

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.store import load, save
from asphalt_nscd.measurements.geometry import read_shape
from asphalt_nscd.reporting.figures import (
    fig_compaction,
    fig_forces,
    fig_mapping,
    fig_packing,
    fig_ratio,
    style,
)
from studies.paper import fig_readings

CYLINDER = {"d_mm": 20, "h_mm": 60, "mass_kg": 0.04, "mobile_mass_kg": 0}


def test_ratio_and_phase_difference_of_every_test(results):
    """Two groups of width 0.8, in each a run for 0 and one for 20 degC; at 0 degC bonds broke."""
    simulations = results.simulations(samples=("s1", "s2"), ratios={"s1": 1.02, "s2": 0.98}.get)
    figure = fig_ratio.draw(simulations=simulations)
    runs = [-0.4 + run + 0.4 * (0.5 + np.arange(3)) / 3.5 for run in (0.0, 0.4)]
    for axes, values, zero in zip(figure.axes, ([1.02, 0.98], [0.01, 0.01]), (1.0, 0.0), strict=True):
        *drawn, level = axes.lines
        # of each temperature a line for each sample, and the points of both
        for number, run in enumerate(runs):
            *lines, points = drawn[3 * number : 3 * number + 3]
            for sample, (line, value) in enumerate(zip(lines, values, strict=True)):
                np.testing.assert_allclose(line.get_data(), [sample + run, 3 * [value]], atol=1e-8)
            assert sorted(points.get_xdata()) == pytest.approx([*run, *(1.0 + run)])
            assert set(np.round(points.get_ydata(), 8)) == set(values)
            face = "white" if number == 0 else points.get_color()
            assert points.get_markerfacecolor() == face and lines[0].get_color() == points.get_color()
        assert level.get_ydata() == [zero, zero]
    assert [axes.get_ylabel() for axes in figure.axes] == [
        "|E*| simulated / law",
        "phase, simulated − law (°)",
    ]
    assert [label.get_text() for label in figure.axes[1].get_xticklabels()] == ["sample s1", "sample s2"]
    assert figure.axes[1].get_xlabel() == "in each run of points 3 to 40 Hz from left to right"
    legend = figure.legends[0]
    assert [text.get_text() for text in legend.get_texts()] == ["0 °C", "20 °C", "bonds broken"]
    keys = [handle.get_color() for handle in legend.legend_handles[:2]]
    assert keys == [figure.axes[0].lines[n].get_color() for n in (2, 5)]


def test_without_broken_bonds_no_marker_is_open(results):
    (path,) = results.simulations()
    pd.read_csv(path).assign(broken_bonds=0).to_csv(path, index=False)
    figure = fig_ratio.draw(simulations=[path])
    assert "bonds broken" not in [text.get_text() for text in figure.legends[0].get_texts()]
    assert not any(line.get_markerfacecolor() == "white" for line in figure.axes[0].lines)


def test_packing_one_point_per_deposit(results):
    """Facets are open, and stand with the friction of their deposit."""
    rows = [("a", 0.2, 0.65, 1.1, "paper"), ("b", 0.5, 0.62, 0.9, "paper"), ("c", 0.5, 0.62, 1.0, "facets")]
    for mapped in (True, False):
        packing = []
        for name, friction, fraction, ratio, mapping in rows if mapped else rows[:2]:
            more = {"friction": friction, "solid_fraction": fraction} | (
                {"mapping": mapping} if mapped else {}
            )
            packing += results.simulations(name=name, frequencies=[3.0], ratios=lambda s, r=ratio: r, **more)
        (axes,) = fig_packing.draw(packing=packing).axes
        level, *lines = axes.lines
        assert level.get_ydata() == [1.0, 1.0]
        drawn = [(line.get_xdata()[0], line.get_ydata()[0]) for line in lines]
        np.testing.assert_allclose(drawn, [row[2:4] for row in rows[: len(drawn)]])
        open_points = [line.get_markerfacecolor() == "white" for line in lines]
        assert open_points == ([False, False, True] if mapped else [False, False])
        assert len({line.get_color() for line in lines}) == 2
        texts = [text.get_text() for text in axes.get_legend().get_texts()]
        assert texts == ["0.2", "0.5", *(["areas of Eqs. (30)-(33)", "facets"] if mapped else [])]
    faces = [handle.get_markerfacecolor() for handle in axes.get_legend().legend_handles]
    assert faces == [line.get_markerfacecolor() for line in lines]
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("solid fraction of the deposit", "|E*| simulated / law")


def test_compaction_from_the_start_of_the_vibration(results):
    (axes,) = fig_compaction.draw(deposit=results.deposit()).axes
    curve, last = axes.lines
    np.testing.assert_allclose(curve.get_xydata(), [[0.0, 24.0], [0.5, 21.0], [1.25, 20.3]])
    np.testing.assert_allclose(last.get_xydata(), [[1.25, 20.3]])
    assert axes.get_ylabel().endswith("(mm)") and axes.get_xlabel().endswith("(s)")
    assert [text.get_text() for text in axes.get_legend().get_texts()] == ["sample deposit"]


def readings(results):
    pascal = results.simulations(name="p", ratios=lambda s: 0.4, head="free", law_source="pascal")
    blocked = results.simulations(name="b", ratios=lambda s: 2.2, head="blocked", law_source="published")
    for path in (*pascal, *blocked):  # of one temperature, as the audit's tests are
        table = pd.read_csv(path)
        table[table["temperature_C"] == 20.0].to_csv(path, index=False)
    return [*pascal, *blocked]


def test_readings_are_told_apart(results):
    figure = fig_readings.draw(
        readings=readings(results), simulations=results.simulations(law_source="published")
    )
    left, right = figure.axes
    drawn = {line.get_label(): line for line in left.lines}
    expected = {
        "Table 3 in kPa, head free": 1.0,
        "Table 3 in Pa, head free": 0.4,
        "Table 3 in kPa, head blocked": 2.2,
    }
    for label, ratio in expected.items():
        assert drawn[label].get_ydata() == pytest.approx([ratio] * 3)
    law = next(line for line in right.lines if line.get_label().startswith("Burgers law"))
    assert law.get_ydata() == pytest.approx([modulus(LAWS[20.0], f)[1] for f in (3.0, 10.0, 40.0)])
    assert left.get_ylabel() == "|E*| simulated / law" and right.get_ylabel() == "phase angle (°)"


def test_stretched_bonds_pull_and_the_head_moves_by_one(results):
    speed, force = fig_forces.slow_deflection(load(results.model()[0], "model"))
    assert speed == pytest.approx([0.5, 0.75, 0.0, 0.0, 1.0])
    # 6 x (0.75 - 0.5), 2 x (0 - 0.5), 2 x (1 - 0.5), over their mean size.
    assert force == pytest.approx(np.array([1.5, -1.0, 1.0]) * 6 / 7)


def test_chains_leave_out_plates_and_what_lies_off_the_middle(results, monkeypatch):
    seen = []
    picture = fig_forces.picture
    monkeypatch.setattr(fig_forces, "picture", lambda *given: seen.append(given) or picture(*given))
    figure = fig_forces.draw(model=results.model(), specimen=results.specimen())
    pulled, pushed, field, spread, *_ = figure.axes
    for axes, colour, ends, force in (
        (pulled, style.ORANGE, [[0.0, 30.0], [3.0, 30.0]], 9 / 7),
        (pushed, style.BLUE, [[0.0, 30.0], [0.0, 30.0]], 6 / 7),
    ):
        (chains,) = axes.collections
        assert np.asarray(chains.get_segments()) == pytest.approx(np.array([ends]))
        assert chains.get_linewidth() == pytest.approx([fig_forces.WIDTH * force])
        assert np.allclose(chains.get_color(), to_rgba(colour))
    # speeds 0.5, 0.75, 0 and 0 of the head's, as shades of one map from 0 to 1
    assert seen[0][2] == pytest.approx(matplotlib.colormaps["viridis"]([0.5, 0.75, 0.0, 0.0])[:, :3])
    extent = np.array(field.images[0].get_extent())
    assert np.diff(extent)[::2] == pytest.approx([6.0, 27.0], rel=0.2)  # mm
    assert figure.axes[4].get_xlabel() == "over that of the head"
    # two of three bonds in tension, one in compression, in bins of 0.2 over the mean force
    assert [step.get_label() for step in spread.patches] == ["tension", "compression"]
    shares = {1.2: 1 / 3, 0.8: 1 / 3}, {0.8: 1 / 3}
    for step, share, colour in zip(spread.patches, shares, (style.ORANGE, style.BLUE), strict=True):
        values, edges, _ = step.get_data()
        told = {round(edges[n], 6): values[n] * 0.2 for n in np.flatnonzero(np.isfinite(values))}
        assert told == pytest.approx(share) and step.get_edgecolor() == to_rgba(colour)
    assert spread.get_yscale() == "log" and spread.get_xlim() == (0.0, 12.0)
    assert spread.get_xlabel() == "normal force over its mean"


def test_chains_of_a_cylinder_are_those_about_its_middle(results, tmp_path):
    """Whose thickness is its diameter: it has no e."""
    cut, shape = load(results.specimen()[0], "specimen"), read_shape(CYLINDER)
    other = {name: value for name, value in cut.attributes.items() if name not in ("b", "B", "e")}
    path = tmp_path / results.specimen()[0].name
    save(path, "specimen", cut.arrays, other | shape.attributes())
    pulled, *_ = fig_forces.draw(model=results.model(), specimen=[path]).axes
    (chains,) = pulled.collections
    assert len(chains.get_segments()) >= 1


def test_model_of_another_specimen_is_refused(results):
    with pytest.raises(InputError, match="belongs to another specimen"):
        fig_forces.draw(model=results.model("s2"), specimen=results.specimen())


def test_mappings_by_size_and_packing(tmp_path):
    """Facets with equal stiffnesses and the paper's bonds; the right panel holds the size of most packings."""
    rows = [
        ("paper", 0.37, 1000, 600, 0.60, 0.55),
        ("paper", 0.37, 14160, 9000, 0.67, 1.06),
        ("paper", 0.37, 14160, 9100, 0.65, 1.03),
        ("paper", 0.37, 30000, 20000, 0.69, 1.2),
        ("facets", 1.0, 1000, 600, 0.60, 0.98),
        ("facets", 1.0, 14160, 9000, 0.67, 1.002),
        ("facets", 0.37, 14160, 9000, 0.67, 0.99),
        ("facets with moments", 1.0, 14160, 9000, 0.67, 1.006),
    ]
    columns = ["mapping", "kt_over_kn", "spheres", "spheres_in_specimen", "solid_fraction", "E_over_law"]
    pd.DataFrame(rows, columns=columns).to_csv(tmp_path / "mapping.csv", index=False)
    size, density = fig_mapping.draw(mapping=[tmp_path / "mapping.csv"]).axes
    seen = [
        [line.get_ydata().tolist() for line in axes.lines if line.get_marker() != "None"]
        for axes in (size, density)
    ]
    assert seen == [[[0.55, 1.06, 1.03, 1.2], [0.98, 1.002]], [[1.06, 1.03], [1.002]]]
    assert [line.get_xdata().tolist() for line in size.lines[:2]] == [[600, 9000, 9100, 20000], [600, 9000]]
    assert [line.get_xdata().tolist() for line in density.lines[:2]] == [[0.67, 0.65], [0.67]]
    assert [line.get_label() for line in size.lines[:2]] == ["Eqs. (30)-(33)", "facets, $k_t = k_n$"]
    assert size.lines[2].get_ydata() == density.lines[2].get_ydata() == [1.0, 1.0]
    assert density.get_title(loc="left").endswith("14160 spheres poured") and size.get_xscale() == "log"
    assert (size.get_xlabel(), size.get_ylabel()) == ("spheres in the specimen", "|E*| simulated / law")
    assert density.get_xlabel() == "solid fraction of the deposit"
