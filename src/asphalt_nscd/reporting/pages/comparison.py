"""The page and the figure of several mixes beside each other."""

from __future__ import annotations

from html import escape
from io import StringIO
from pathlib import Path
from typing import TYPE_CHECKING

import pandas as pd

from asphalt_nscd.files.store import atomic_path
from asphalt_nscd.reporting.figures.style import journal

if TYPE_CHECKING:
    from matplotlib.figure import Figure

STYLE = """
:root { color-scheme: light dark; --page: #fff; --ink: #1a1a1a; --line: #ccc; }
@media (prefers-color-scheme: dark) { :root { --page: #16181b; --ink: #e6e6e6; --line: #444; } }
body { font: 15px/1.45 system-ui, sans-serif; margin: 1rem auto; max-width: 68rem; padding: 0 1rem;
  background: var(--page); color: var(--ink); }
.wide { overflow-x: auto; } table { border-collapse: collapse; white-space: nowrap; }
td, th { padding: .25rem .6rem; border-bottom: 1px solid var(--line); text-align: right; }
td:first-child, th:first-child, td:last-child, th:last-child { text-align: left; }
figure { margin: 1rem 0; background: #fff; } svg { max-width: 100%; height: auto; }
"""


@journal
def curves_figure(curves: pd.DataFrame) -> Figure:
    """|E*| and phase of each mix at one temperature, with 95 % bands."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(9.0, 4.2), layout="constrained")
    axes = figure.subplots(1, 2)
    for n, (mix, curve) in enumerate(curves.groupby("mix", sort=False)):
        colour = f"C{n % 10}"
        for one, name, unit in ((axes[0], "E", "MPa"), (axes[1], "phase", "deg")):
            low, high = curve[f"{name}_low_{unit}"], curve[f"{name}_high_{unit}"]
            one.fill_between(curve["frequency_Hz"], low, high, color=colour, alpha=0.2, linewidth=0)
            one.plot(
                curve["frequency_Hz"],
                curve[f"{name}_{unit}"],
                color=colour,
                label=mix,
                linestyle="-" if n < 10 else "--",
            )
    at = f"frequency at {curves['temperature_C'].iloc[0]:g} °C [Hz]"
    axes[0].set(xscale="log", yscale="log", xlabel=at, ylabel="|E*| [MPa]")
    axes[1].set(xscale="log", xlabel=at, ylabel="phase [°]")
    axes[0].legend(fontsize=7, frameon=False)
    return figure


def write_page(path: Path, table: pd.DataFrame, curves: pd.DataFrame) -> None:
    """Write the page: ranking, curves, and a link to the diagnosis of each mix beside it."""
    drawn = StringIO()
    curves_figure(curves).savefig(drawn, format="svg", metadata={"Date": None})
    svg = drawn.getvalue()
    first = table.iloc[0]
    lines = [
        f"<tr><td><a href='{escape(row.mix, quote=True)}/diagnosis.html'>{escape(row.mix)}</a></td>"
        f"<td>{row.rank_low}{f' to {row.rank_high}' if row.rank_high > row.rank_low else ''}</td>"
        f"<td>{row.E_MPa:.0f}</td><td>{row.E_low_MPa:.0f} to {row.E_high_MPa:.0f}</td>"
        f"<td>{row.phase_deg:.1f}</td><td>{row.phase_low_deg:.1f} to {row.phase_high_deg:.1f}</td>"
        f"<td>{row.tests}</td><td>{row.left_out}</td><td>{escape(row.causes.replace('_', ' ')) or 'none'}</td></tr>"
        for row in table.itertuples()
    ]
    content = f"""<!doctype html><html lang="en"><meta charset="utf-8">
<meta name="viewport" content="width=device-width"><title>{len(table)} mixes</title><style>{STYLE}</style>
<h1>{len(table)} mixes</h1>
<p>Stiffest at {first.temperature_C:g} °C and {first.frequency_Hz:g} Hz: {escape(first.mix)}, {first.E_MPa:.0f} MPa
(95 % interval {first.E_low_MPa:.0f} to {first.E_high_MPa:.0f}). All values are of the mix, after the named corrections.
A rank of several places says that the tests do not tell these mixes apart.</p>
<div class="wide"><table><tr><th>mix</th><th>rank</th><th>|E*| [MPa]</th><th>95 %</th><th>phase [°]</th><th>95 %</th>
<th>tests</th><th>left out</th><th>corrected for</th></tr>{"".join(lines)}</table></div>
<figure>{svg[svg.index("<svg") :]}</figure></html>
"""
    with atomic_path(path) as temporary:
        temporary.write_text(content, encoding="utf-8")
