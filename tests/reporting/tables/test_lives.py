"""Lives of samples: set on the published epsilon6, scaled by strain, and scattered as their courses are."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest

from asphalt_nscd.measurements.twopoint import Geometry
from asphalt_nscd.reporting.figures import fig_fatigue
from asphalt_nscd.reporting.tables import fatigue, fatigue_summary


@pytest.fixture
def courses(tmp_path):
    """Two samples that fail after 2e6 and 8e6 cycles of the reference."""
    paths = []
    for name, last in (("s1", 2e6), ("s2", 8e6)):
        table = {
            "cycles": [0.0, last / 2, 1.5 * last],
            "stiffness": [1.0, 0.75, 0.25],
            "lost_bonds": [0, 1, 2],
        }
        paths.append(tmp_path / f"{name}.csv")
        pd.DataFrame(table).to_csv(paths[-1], index=False)
    return paths


def test_bonds_are_set_on_the_mean_of_log_life(courses):
    assert [fatigue.life(path) for path in courses] == pytest.approx([2e6, 8e6])
    # 4e6 in the mean becomes a million: bonds that endure less strain, as the fifth root
    assert fatigue.fatigue_law(courses).endured == pytest.approx(100e-6 * 0.25**0.2)


def test_lives_at_three_strains_follow_the_slope(courses):
    table = fatigue.make(courses).pivot(index="strain_1e-6", columns="sample", values="cycles")
    assert list(table.index) == pytest.approx([90.0, 120.0, 150.0])
    assert np.log10(table).mean(axis=1).to_numpy() == pytest.approx(6.0 - 5.0 * np.log10([0.9, 1.2, 1.5]))
    assert (table["s2"] / table["s1"]).to_numpy() == pytest.approx(4.0)


@pytest.fixture
def profiles(tmp_path):
    """Damage over the height, most of it at a third and at a half."""
    paths = []
    for name, damage in (("p1", [0.1, 0.4, 0.0]), ("p2", [0.0, 0.1, 0.3])):
        paths.append(tmp_path / f"{name}.csv")
        table = {"height_share": [0.2, 1 / 3, 0.5], "damage": damage, "lost": 0.0}
        pd.DataFrame(table).to_csv(paths[-1], index=False)
    return paths


def test_figure_shows_falls_lives_and_damage(courses, profiles):
    falls, wohler, height = fig_fatigue.draw(course=courses, profile=profiles).axes
    for number, last in enumerate((2.0, 8.0)):  # million cycles, of which the bonds as set bear a quarter
        np.testing.assert_allclose(
            falls.lines[number].get_data(), [[0.0, 0.125 * last, 0.375 * last], [1.0, 0.75, 0.25]]
        )
        strains = np.array([90.0, 120.0, 150.0])
        lives = 0.25e6 * last * (strains / 100.0) ** -5.0
        np.testing.assert_allclose(wohler.lines[number].get_data(), [lives, strains])
        assert wohler.lines[number].get_marker() != "None"
    np.testing.assert_allclose(height.lines[0].get_data(), [[0.1, 0.4, 0.0], [0.2, 1 / 3, 0.5]])
    cycles, strain = np.array([5e4, 5e6]), 100.0 * np.array([0.05, 5.0]) ** -0.2
    for line, factor in zip(wohler.lines[2:], (1.0, 10**-0.25, 10**0.25), strict=True):
        np.testing.assert_allclose(line.get_data(), [factor * cycles, strain])
    labels = [(axes.get_xlabel(), axes.get_ylabel()) for axes in (falls, wohler, height)]
    assert labels == [
        ("million cycles at 100·10⁻⁶", "|E*| over the first"),
        ("cycles to half of |E*|", "strain (10⁻⁶)"),
        ("mean damage of bonds", "height over h"),
    ]
    assert wohler.get_xscale() == wohler.get_yscale() == "log"


def test_the_summary_holds_each_number_beside_what_it_is_held_against(
    courses, profiles, tmp_path, monkeypatch
):
    """Lives of a small sample by jumps, by finer ones, and stepped; a trapezoid of 56 over 25 mm, 250 mm high."""
    shape = Geometry(0.025, 0.056, 0.025, 0.25, 0.6, 0.2)
    monkeypatch.setattr(fatigue_summary, "read_specimen", lambda path: SimpleNamespace(geometry=shape))
    check = []
    for cycles in (100.0, 104.0, 105.0):
        check.append(tmp_path / f"{cycles:g}.csv")
        pd.DataFrame({"cycles": [0.0, 2 * cycles], "stiffness": [1.0, 0.0]}).to_csv(check[-1], index=False)
    table = fatigue_summary.make(courses, profiles, check, [tmp_path]).set_index("what")
    here, beside = table["here"].to_list(), table["beside"].to_list()
    thickest = 2.0 - 56.0 / 31.0  # where the width is twice the head's
    assert here == pytest.approx(
        [100 * 0.25**0.2, 100, -0.2, np.log10(4.0) / np.sqrt(2.0), 1 / 3, 0.5, 100, 104]
    )
    assert beside == pytest.approx([np.nan, 100, -0.2, 0.25, thickest, thickest, 105, 105], nan_ok=True)
