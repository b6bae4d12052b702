"""Figs. 2 to 4: what they draw is what the core computes."""

from __future__ import annotations

from itertools import product
from types import SimpleNamespace

import numpy as np
import pytest
from tiny_results import LAWS

from asphalt_nscd.files.store import write_json
from asphalt_nscd.reporting.figures import fig02, fig03, fig04, numbers
from asphalt_nscd.rheology.maxwell import series_of


@pytest.fixture
def study(tmp_path):
    path = tmp_path / "study.json"
    write_json(path, {"specimens": {"bonds": {"friction": 0.7, "poisson": 0.35, "yield_Pa": 2.7e6}}})
    return [path]


def test_a_contact_opens_or_holds_and_sticks_or_slips(study):
    """Of a unit mass: the gap takes what opens, the reaction what closes; friction takes 0.7 of that at most."""
    normal, tangential = fig02.draw(study=study).axes
    free, slide = np.linspace(-1.0, 1.0, 17), np.linspace(-2.0, 2.0, 33)
    drag = np.clip(-slide, -0.7, 0.7)
    for axes, told in (
        (normal, [np.maximum(free, 0.0), np.maximum(-free, 0.0)]),
        (tangential, [slide + drag, drag]),
    ):
        curve = max(axes.lines, key=lambda line: len(line.get_xdata()))
        np.testing.assert_allclose(curve.get_data(), told, atol=1e-12)
    bounds = {text.get_text(): text.xy[1] for text in tangential.texts}
    assert bounds == pytest.approx({r"$\mu R_n$": 0.7, r"$-\mu R_n$": -0.7})
    levels = [line.get_ydata()[0] for line in tangential.lines if line.get_linestyle() == "--"]
    assert levels == pytest.approx([0.7, -0.7])
    assert (normal.get_xlabel(), normal.get_ylabel()) == ("opening velocity $U_n$", "reaction $R_n$")
    assert (tangential.get_xlabel(), tangential.get_ylabel()) == ("sliding velocity $U_t$", "reaction $R_t$")


def test_the_element_has_the_stiffness_of_a_bond(results, study, monkeypatch, tmp_path):
    """Of the median bond, 2e-3 m; a tangential component has 1 / 2 (1 + nu) of it."""
    network = SimpleNamespace(form=np.array([1e-3, 2e-3, 9e-3]))
    monkeypatch.setattr(fig03, "read_specimen", lambda path: SimpleNamespace(network=network))
    figure = fig03.draw(laws=results.laws(20.0), specimen=[tmp_path], study=study)
    for axes, index, share in zip(figure.axes, "nt", (2e-3, 2e-3 / 2.7), strict=True):
        for text, (name, value, unit) in zip(
            axes.texts,
            (
                ("K_{m}", 20.2e9, "N/m"),
                ("C_{m}", 1.79e9, "N s/m"),
                ("K_{k}", 27.2e9, "N/m"),
                ("C_{k}", 0.461e9, "N s/m"),
            ),
            strict=True,
        ):
            assert text.get_text() == f"${name}^{{{index}}}$ = {numbers.power(share * value)} {unit}"
        wires = [line.get_xydata() for line in axes.lines]
        springs = [wire for wire in wires if len(wire) > 5]  # over the Maxwell element, and above the dashpot
        assert [wire[0].tolist() for wire in springs] == [[0.0, 0.0], [3.0, 0.42]]
        ends = {tuple(end) for wire in wires for end in (wire[0], wire[-1])}
        assert {(-0.35, 0.0), (5.35, 0.0), (4.6, 0.42), (4.6, -0.42), (3.0, -0.42), (1.4, 0.0)} <= ends
    assert figure.axes[1].get_title(loc="left").endswith("tangential, 20 °C")


def test_a_bond_breaks_in_tension_at_its_strength_and_not_in_compression(results, study):
    """At a constant rate each Maxwell branch bears rate x viscosity x (1 - exp(-t / tau)), until the bond breaks."""
    figure = fig04.draw(laws=results.laws(20.0), study=study)
    branches = series_of(LAWS[20.0].kelvin_form())
    for axes, share, levels in zip(figure.axes, (1.0, 1.0 / 2.7), ([-2.7], [-2.7, 2.7]), strict=True):
        curves = [line for line in axes.lines if len(line.get_xdata()) > 2]
        assert [line.get_label() for line in curves[::2]] == ["0.001/s", "0.01/s", "0.1/s"]
        for curve, (rate, side) in zip(curves, product((1e-3, 1e-2, 1e-1), (1.0, -1.0)), strict=True):
            opening, stress = curve.get_data()
            assert opening == pytest.approx(side * np.linspace(0.0, 300.0, 601))  # 1e-6
            pulled = -side * sum(
                1e-6 * share * rate * modulus * tau * -np.expm1(-np.abs(opening) * 1e-6 / rate / tau)
                for modulus, tau in zip(branches.moduli, branches.times, strict=True)
            )
            broken = (np.abs(pulled) if share < 1.0 else -pulled) > 2.7
            near = np.abs(np.abs(pulled) - 2.7) < 0.03
            told = np.where(np.maximum.accumulate(broken), 0.0, pulled)
            assert np.abs(stress - told)[~near].max() < 0.015 * max(2.7, np.abs(told).max())
        dashed = [line.get_ydata()[0] for line in axes.lines if line.get_linestyle() == "--"]
        assert dashed == pytest.approx(levels)
    assert [axes.get_xlabel() for axes in figure.axes] == [
        "opening over $l_0$ (10$^{-6}$)",
        "sliding over $l_0$ (10$^{-6}$)",
    ]
    assert figure.axes[0].get_ylabel() == r"reaction over $\pi r_{min}^2$ (MPa)"


@pytest.mark.parametrize(
    ("value", "digits", "told"),
    [(2.4e7, 2, "$2.4\\times10^{7}$"), (1e-4, 2, "$1\\times10^{-4}$"), (0.09876, 3, "$9.88\\times10^{-2}$")],
)
def test_a_number_as_a_power_of_ten(value, digits, told):
    assert numbers.power(value, digits) == told


def test_decades_are_written_out_where_they_are_short():
    shown = [numbers.plain(10.0**n) for n in (-4, -3, 0, 4, 5)]
    assert shown == ["1e−4", "0.001", "1", "10000", "1e5"] and numbers.celsius(-4.5) == "−4.5 °C"
