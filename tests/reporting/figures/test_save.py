from __future__ import annotations

import matplotlib
import numpy as np
from matplotlib.figure import Figure

from asphalt_nscd.reporting.figures.save import save_figure


def drawing():
    figure = Figure()
    axes = figure.subplots()
    axes.plot(np.arange(3), label="a")
    axes.fill_between([0, 1], [0, 1], hatch="/")
    axes.legend()
    return figure


def test_three_files_that_are_the_same_each_time(tmp_path):
    for folder in ("first", "second"):
        save_figure(drawing(), tmp_path / folder / "fig")
    for kind in ("pdf", "png", "svg"):
        first, second = ((tmp_path / folder / f"fig.{kind}").read_bytes() for folder in ("first", "second"))
        assert first and first == second, kind


def test_the_users_own_settings_do_not_show(tmp_path):
    save_figure(drawing(), tmp_path / "plain")
    with matplotlib.rc_context({"savefig.facecolor": "red", "savefig.bbox": "tight", "svg.fonttype": "none"}):
        save_figure(drawing(), tmp_path / "own")
    for kind in ("pdf", "png", "svg"):
        assert (tmp_path / f"plain.{kind}").read_bytes() == (tmp_path / f"own.{kind}").read_bytes(), kind
