"""Fig. 4: reaction of a bond that is opened and closed, as the core steps and breaks it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from asphalt_nscd.bending.bending_test import bond_law
from asphalt_nscd.files.store import read_json
from asphalt_nscd.measurements.tables import only_file
from asphalt_nscd.nscd.bonds.strength import utilisations
from asphalt_nscd.reporting.figures import numbers, style
from asphalt_nscd.rheology.laws_io import read_law

RATES = (1e-3, 1e-2, 1e-1)  # opening velocity over l0, 1/s
LARGEST = 3e-4  # opening over l0
STEPS = 600


@style.journal
def draw(laws: list[Path], study: list[Path]) -> Figure:
    """Draw (a) normal and (b) tangential reaction per area of a bond against its opening over l0, at three rates."""
    path = only_file(laws, "laws")
    law, temperature = bond_law(read_law(path)), read_json(path)["temperature_C"]
    bonds = read_json(only_file(study, "study"))["specimens"]["bonds"]
    strength, share = float(bonds["yield_Pa"]), 0.5 / (1.0 + float(bonds["poisson"]))
    figure, panels = style.new_figure(style.WIDE, 64.0, columns=2, sharey=True)
    for axes, letter, words, normal, tangential in (
        (panels[0], "a", "normal", 1.0, 0.0),
        (panels[1], "b", "tangential", 0.0, share),
    ):
        for rate, (colour, _) in zip(RATES, style.series(len(RATES))[::-1], strict=True):
            for side in (1.0, -1.0):
                opening, stress = _pulled(law, side * rate)
                reaction = np.stack([normal * stress, tangential * stress, 0.0 * stress])
                used = utilisations(reaction.T.ravel(), np.full(stress.shape, strength))
                # At a constant rate the stress never falls, so that a bond stays broken.
                shown = np.where(used > 1.0, 0.0, reaction.sum(axis=0)) / 1e6
                axes.plot(1e6 * opening, shown, color=colour, label=f"{rate:g}/s" if side > 0 else None)
        for line in (axes.axhline, axes.axvline):
            line(0.0, color=style.PALE, lw=0.5, zorder=0)
        for side in (-1.0, 1.0) if tangential else (-1.0,):
            axes.axhline(side * strength / 1e6, color=style.GREY, lw=0.5, ls=style.DASHES[1], zorder=0)
        axes.set_xlabel("opening over $l_0$ (10$^{-6}$)" if normal else "sliding over $l_0$ (10$^{-6}$)")
        style.letter(axes, letter, f"{words}, {numbers.celsius(temperature)}")
    panels[0].set_ylabel(r"reaction over $\pi r_{min}^2$ (MPa)")
    panels[0].legend(title="rate", title_fontsize=7.0, loc="upper right")
    return figure


def _pulled(law, rate: float) -> tuple[np.ndarray, np.ndarray]:  # type: ignore[no-untyped-def]
    """Opening over l0 (n,) and reaction per area [Pa] of a bond that opens at a constant rate [1/s] from rest."""
    dt = LARGEST / abs(rate) / STEPS
    step = law.step(dt)
    sigma, kelvin = np.zeros(1), np.zeros((law.kelvin_springs.size, 1))
    found = [0.0]
    for _ in range(STEPS):
        sigma, kelvin = step.update(step.explicit_part(sigma, kelvin), np.full(1, rate), kelvin)
        found.append(float(sigma[0]))
    return rate * dt * np.arange(STEPS + 1), np.array(found)
