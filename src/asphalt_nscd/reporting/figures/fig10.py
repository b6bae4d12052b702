"""Fig. 10: isotherms of the phase angle, simulated and measured."""

from __future__ import annotations

from pathlib import Path

from matplotlib.figure import Figure

from asphalt_nscd.reporting.figures.isotherms import draw_isotherms
from asphalt_nscd.reporting.figures.style import journal


@journal
def draw(simulations: list[Path], measured: list[Path], laws: list[Path]) -> Figure:
    """Means over samples with standard deviations, and the laws as lines."""
    return draw_isotherms("phase_deg", simulations, measured, laws)
