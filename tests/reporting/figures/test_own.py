"""Figures beside the paper's: ratio to the law, packing, readings that fail."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest
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
)
from studies.paper import fig_readings

CYLINDER = {"d_mm": 20, "h_mm": 60, "mass_kg": 0.04, "mobile_mass_kg": 0}


def test_ratio_and_phase_difference_of_every_test(results):
    simulations = results.simulations(samples=("s1", "s2"), ratios={"s1": 1.02, "s2": 0.98}.get)
    figure = fig_ratio.draw(simulations=simulations)
    ratio, lead = figure.axes
    points = [line for line in ratio.lines if line.get_marker() != "None"]
    assert sum(len(line.get_ydata()) for line in points) == 2 * 2 * 3
    values = sorted({round(float(value), 9) for line in points for value in line.get_ydata()})
    assert values == [0.98, 1.02]
    for line in (line for line in lead.lines if line.get_marker() != "None"):
        assert line.get_ydata() == pytest.approx(0.01, abs=1e-8)
    assert ratio.get_ylabel() == "|E*| simulated / law" and lead.get_ylabel().endswith("(°)")
    assert [label.get_text() for label in lead.get_xticklabels()] == ["sample s1", "sample s2"]


def test_broken_bonds_are_open_markers(results):
    figure = fig_ratio.draw(simulations=results.simulations())
    open_points = [line for line in figure.axes[0].lines if line.get_markerfacecolor() == "white"]
    (points,) = open_points
    # Those of 0 degC, which stand left of the sample's middle.
    assert len(points.get_xdata()) == 3 and points.get_xdata().max() < 0.0
    assert "bonds broken" in [text.get_text() for text in figure.legends[0].get_texts()]
    intact = results.simulations(name="intact")
    table = pd.read_csv(intact[0]).assign(broken_bonds=0)
    table.to_csv(intact[0], index=False)
    legend = fig_ratio.draw(simulations=intact).legends[0]
    assert "bonds broken" not in [text.get_text() for text in legend.get_texts()]


def test_packing_one_point_per_deposit(results):
    packing = results.simulations(name="a", frequencies=[3.0], friction=0.2, solid_fraction=0.65)
    packing += results.simulations(
        name="b", frequencies=[3.0], ratios=lambda s: 0.9, friction=0.5, solid_fraction=0.62
    )
    (axes,) = fig_packing.draw(packing=packing).axes
    points = {
        float(line.get_xdata()[0]): line.get_ydata()[0] for line in axes.lines if line.get_marker() != "None"
    }
    assert points == pytest.approx({0.65: 1.0, 0.62: 0.9})
    assert [text.get_text() for text in axes.get_legend().get_texts()] == ["0.2", "0.5"]
    assert axes.get_xlabel() == "solid fraction of the deposit"


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
    # 4 x (0.75 - 0.5), 2 x (0 - 0.5), 2 x (1 - 0.5), whose mean size is one.
    assert force == pytest.approx([1.0, -1.0, 1.0])


def test_chains_leave_out_plates_and_what_lies_off_the_middle(results):
    pulled, pushed, *_ = fig_forces.draw(model=results.model(), specimen=results.specimen()).axes
    (chains,) = pulled.collections
    assert np.asarray(chains.get_segments()) == pytest.approx(np.array([[[0.0, 30.0], [3.0, 30.0]]]))
    (chains,) = pushed.collections
    assert np.asarray(chains.get_segments()) == pytest.approx(np.array([[[0.0, 30.0], [0.0, 30.0]]]))


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
    assert size.get_xscale() == "log" and density.get_xlabel() == "solid fraction of the deposit"
