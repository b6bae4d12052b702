"""Figs. 2 to 4: what they draw is what the core computes."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from tiny_results import LAWS

from asphalt_nscd.files.store import write_json
from asphalt_nscd.reporting.figures import fig02, fig03, fig04, numbers


@pytest.fixture
def study(tmp_path):
    path = tmp_path / "study.json"
    write_json(path, {"specimens": {"bonds": {"friction": 0.7, "poisson": 0.35, "yield_Pa": 2.7e6}}})
    return [path]


def test_a_contact_opens_or_holds_and_sticks_or_slips(study):
    normal, tangential = fig02.draw(study=study).axes
    curve = max(normal.lines, key=lambda line: len(line.get_xdata()))
    opening, reaction = curve.get_xydata().T
    assert (opening >= -1e-12).all() and (reaction >= 0.0).all() and np.abs(opening * reaction).max() < 1e-12
    curve = max(tangential.lines, key=lambda line: len(line.get_xdata()))
    sliding, reaction = curve.get_xydata().T
    assert np.abs(reaction).max() == pytest.approx(0.7)
    slips = np.abs(sliding) > 1e-9
    assert reaction[slips] == pytest.approx(-0.7 * np.sign(sliding[slips]))  # against the motion
    assert np.ptp(reaction[~slips]) > 1.0


def test_the_element_has_the_stiffness_of_a_bond(results, study, monkeypatch, tmp_path):
    network = SimpleNamespace(form=np.array([1e-3, 2e-3, 9e-3]))
    monkeypatch.setattr(fig03, "read_specimen", lambda path: SimpleNamespace(network=network))
    figure = fig03.draw(laws=results.laws(20.0), specimen=[tmp_path], study=study)
    normal, tangential = ([text.get_text() for text in axes.texts] for axes in figure.axes)
    assert len(normal) == len(tangential) == 4
    assert normal[0] == f"$K_{{m}}^{{n}}$ = {numbers.power(2e-3 * 20.2e9)} N/m"
    assert tangential[0] == f"$K_{{m}}^{{t}}$ = {numbers.power(2e-3 * 20.2e9 / 2.7)} N/m"
    assert all("^{n}" in text for text in normal) and all("^{t}" in text for text in tangential)


def test_a_bond_breaks_in_tension_at_its_strength_and_not_in_compression(results, study):
    normal, _ = fig04.draw(laws=results.laws(20.0), study=study).axes
    curves = [line.get_xydata().T for line in normal.lines if len(line.get_xdata()) > 2]
    for opening, reaction in curves:
        if opening[-1] > 0.0:
            assert reaction.min() > -2.7
        else:
            assert (np.diff(reaction) > 0.0).all()
    fastest_opening, fastest_reaction = curves[-2]
    assert fastest_reaction[-1] == 0.0 and fastest_reaction.min() < -2.6
    # at once the element is the spring Em
    slope = -fastest_reaction[1] * 1e6 / (fastest_opening[1] * 1e-6)
    assert slope == pytest.approx(LAWS[20.0].modulus_m, rel=0.05)
