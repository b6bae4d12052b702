"""Lives of samples: set on the published epsilon6, scaled by strain, and scattered as their courses are."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest

from asphalt_nscd.reporting.figures import fig_fatigue
from asphalt_nscd.reporting.tables import fatigue


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


def test_figure_shows_each_sample_in_each_panel(courses, tmp_path):
    profile = tmp_path / "profile.csv"
    pd.DataFrame({"height_share": [0.25, 0.75], "damage": [0.1, 0.0], "lost": [0.1, 0.0]}).to_csv(
        profile, index=False
    )
    falls, wohler, height = fig_fatigue.draw(course=courses, profile=[profile, profile]).axes
    assert len(falls.lines) == len(height.lines) == 2
    assert falls.lines[0].get_xdata()[-1] == pytest.approx(
        1.5 * 2 * 0.25
    )  # million cycles, with the bonds set
    assert len(wohler.lines) == 2 + 3
