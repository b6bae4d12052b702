"""A fall: its table, its pieces as they are drawn, and where its energy goes."""

from __future__ import annotations

import numpy as np
import pytest
from matplotlib.colors import to_rgb

from asphalt_nscd.bending.fall import PARTS
from asphalt_nscd.files.store import save
from asphalt_nscd.reporting.figures import fig_fall, style
from asphalt_nscd.reporting.tables import falls


def test_pieces_at_four_instants_and_shares_of_the_energy(tmp_path, monkeypatch):
    """Start, first impact, the last instant with a fifth of the largest motion, end."""
    seen = []
    monkeypatch.setattr(fig_fall, "side_view", lambda axes, *spheres: seen.append(spheres))
    start, radius = np.array([[0.0, 0.0, 0.02], [0.01, 0.0, 0.02]]), np.array([0.002, 0.003])
    down = np.array([0.0, -0.004, -0.01, -0.014, -0.016, -0.017])
    moved = np.zeros((6, 2, 3))
    moved[:, :, 2], moved[:, 1, 0] = down[:, None], 0.001 * np.arange(6)
    arrays = {
        "time_s": 0.01 * np.arange(6),
        "frames/position_m": start,
        "frames/radius_m": radius,
        "frames/displacement_m": moved,
        "frames/fragment": np.array([[0, 0], [0, 0], [0, 1], [0, 1], [1, 2], [4, 2]]),
        "load_J": np.array([0.0, -1.0, -2.0, -3.0, -4.0, -5.0]),
        "kinetic_J": np.array([0.0, 1.0, 1.5, 0.4, 0.2, 0.1]),
        "impact_J": np.array([0.0, 0.0, 0.5, 2.0, 3.0, 3.5]),
        "friction_J": np.array([0.0, 0.0, 0.0, 0.5, 0.7, 0.9]),
        "numerical_J": np.array([0.0, 0.0, 0.0, 0.1, 0.1, 0.5]),
    }
    save(tmp_path / "f.h5", "fall", arrays, {})
    figure = fig_fall.draw(fall=[tmp_path / "f.h5"])
    colours = np.array([to_rgb(one) for one in (style.BLUE, style.ORANGE, style.INK)])
    for (position, size, colour), k, panel in zip(seen, (0, 2, 3, 5), figure.axes):
        np.testing.assert_allclose(position, start + moved[k])
        np.testing.assert_allclose(colour, colours[arrays["frames/fragment"][k] % 3])
        assert size is not None and panel.get_title(loc="left").endswith(f"{10 * k} ms")
        assert panel.get_xlim() == pytest.approx((-2.0, 18.0)) and panel.get_ylim() == pytest.approx(
            (-2.0, 23.0)
        )
    account = figure.axes[4]
    for line, name in zip(account.lines, ("kinetic", "impact", "friction", "numerical"), strict=True):
        assert line.get_label() == name
        np.testing.assert_allclose(line.get_data(), [10.0 * np.arange(6), 20.0 * arrays[f"{name}_J"]])
    assert (account.get_xlabel(), account.get_ylabel()) == ("time (ms)", "share of the energy (%)")
    assert [line.get_linestyle() for line in account.lines] == ["-", "-", "-", "--"]


def test_falls_stand_beside_each_other_the_longest_step_first(tmp_path):
    files = []
    for step in (2e-4, 4e-4):
        told = {f"{part}_percent": n * 1e4 * step for n, part in enumerate(PARTS, 1)}
        told |= {"time_step_s": step, "energy_J": 20 * step, "error_percent": 0.1, "fragments": 3}
        told |= {"broken_bonds": 11, "speed_m_s": 0.5}
        files.append(tmp_path / f"{step}.h5")
        save(files[-1], "fall", {"time_s": np.zeros(1)}, told)
    table = falls.make(files).set_index("steps of")
    assert list(table) == ["0.4 ms", "0.2 ms"]
    assert table.loc["energy set free, mJ"].tolist() == pytest.approx([8.0, 4.0])
    assert table.loc["springs, %"].tolist() == pytest.approx([8.0, 4.0])
    rest = ["missing, %", "pieces", "bonds broken by the fall", "fastest sphere at the end, m/s"]
    assert table.loc[rest, "0.2 ms"].tolist() == [0.1, 3, 11, 0.5]
