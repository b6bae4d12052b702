"""Fig. 12: influence of the Maxwell viscosity on |E*| and phase."""

from __future__ import annotations

from pathlib import Path

from matplotlib.figure import Figure

from asphalt_nscd.reporting.figures.sensitivity import draw_sensitivity
from asphalt_nscd.reporting.figures.style import journal


@journal
def draw(sensitivity: list[Path], simulations: list[Path], measured: list[Path], laws: list[Path]) -> Figure:
    """One panel each; the law of the temperature of the study says which base to take."""
    return draw_sensitivity("eta_m", sensitivity, simulations, measured, laws)
