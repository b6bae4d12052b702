"""Fig. 2: Signorini's condition and Coulomb's law, as the core solves one contact."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from asphalt_nscd.files.store import read_json
from asphalt_nscd.measurements.tables import only_file
from asphalt_nscd.nscd.contacts.coulomb import one_contact
from asphalt_nscd.reporting.figures import style

PUSH = 1.0  # approach of the two bodies without a reaction, in the unit of the axes


@style.journal
def draw(study: list[Path]) -> Figure:
    """Draw the contact law, (a) normal and (b) tangential: reactions to free velocities, for bodies of unit mass."""
    friction = float(read_json(only_file(study, "study"))["specimens"]["bonds"]["friction"])
    figure, (left, right) = style.new_figure(style.WIDE, 56.0, columns=2)
    free = np.linspace(-PUSH, PUSH, 17)
    normal = np.array([_opening(q, 0.0, friction) for q in free])
    _graph(left, normal[:, 0], normal[:, 1], "opening velocity $U_n$", "reaction $R_n$")
    style.letter(left, "a", "normal: a closed gap")
    sliding = np.linspace(-2.0 * PUSH, 2.0 * PUSH, 33)
    tangential = np.array([_opening(-PUSH, q, friction) for q in sliding])
    _graph(right, tangential[:, 2], tangential[:, 3], "sliding velocity $U_t$", "reaction $R_t$")
    for side, words in ((1.0, r"$\mu R_n$"), (-1.0, r"$-\mu R_n$")):
        right.axhline(side * friction * PUSH, color=style.GREY, lw=0.5, ls=style.DASHES[1], zorder=0)
        right.annotate(
            words,
            (side * PUSH, side * friction * PUSH),
            xytext=(0.0, 3.0 * side),
            textcoords="offset points",
            ha="center",
            va="bottom" if side > 0 else "top",
        )
    right.margins(y=0.25)
    style.letter(right, "b", rf"tangential, $\mu$ = {friction:g}")
    return figure


def _opening(normal: float, tangential: float, friction: float) -> tuple[float, float, float, float]:
    """(Un, Rn, Ut, Rt) after a contact of unit inertia that would move with these velocities."""
    reaction = one_contact(np.eye(3), normal, tangential, 0.0, friction)
    return normal + reaction[0], reaction[0], tangential + reaction[1], reaction[1]


def _graph(axes: Axes, velocity: np.ndarray, reaction: np.ndarray, across: str, up: str) -> None:
    """Draw reactions over velocities (n,), with axes of these names."""
    for line in (axes.axhline, axes.axvline):
        line(0.0, color=style.PALE, lw=0.5, zorder=0)
    axes.plot(velocity, reaction, color=style.BLUE, marker="o", ms=2.6)
    axes.set_xlabel(across)
    axes.set_ylabel(up)
    axes.set_xticks([0.0])
    axes.set_yticks([0.0])
