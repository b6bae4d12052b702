"""The page of several mixes beside each other."""

from __future__ import annotations

from html import escape
from pathlib import Path

import pandas as pd

from asphalt_nscd.files.store import atomic_path
from asphalt_nscd.reporting.pages.style import STYLE
from asphalt_nscd.reporting.pages.svg import Axis, Frame, colours, svg


def curves(of_mixes: pd.DataFrame) -> list[str]:
    """Two SVG charts, |E*| and phase of each mix at one temperature, with 95 % bands.

    `of_mixes` has mix, frequency_Hz, temperature_C, E_MPa and phase_deg with their bounds _low and _high.
    """
    at = f"frequency (Hz), at {of_mixes['temperature_C'].iloc[0]:g} °C"
    across = Axis(at, lambda of, _: of["frequency_Hz"], log=True)
    mixes = list(of_mixes.groupby("mix", sort=False))
    drawn = []
    for label, name, unit, log in (("|E*| (MPa)", "E", "MPa", True), ("phase (°)", "phase", "deg", False)):
        up = Axis(label, lambda of, end, name=name, unit=unit: of[f"{name}{end}_{unit}"], log)  # type: ignore[misc]
        frame = Frame(across, up, [(of_mixes, "_low"), (of_mixes, "_high")])
        for (mix, curve), (light, dark) in zip(mixes, colours(len(mixes)), strict=True):
            band = [*frame.points(curve, "_low"), *frame.points(curve, "_high")[::-1]]
            frame.parts.append(
                f'<g style="--light:{light};--dark:{dark}"><title>{escape(str(mix))}</title>'
                f'<path class="band" d="{_path(band)}Z"/><path class="law" d="{_path(frame.points(curve))}"/></g>'
            )
        drawn.append(svg(f"{label} of {len(mixes)} mixes", frame.parts))
    return drawn


def _path(points: list[tuple[float, float]]) -> str:
    return "M" + "L".join(f"{x:.1f} {y:.1f}" for x, y in points)


def write_page(path: Path, table: pd.DataFrame, of_mixes: pd.DataFrame, machine: str = "") -> None:
    """Write the page: ranking, curves, and a link to the diagnosis of each mix in a folder beside it.

    `table` has a row for each mix, the stiffest first, with its ranks; `of_mixes` is as in `curves`; `machine` says
    what one machine does to all mixes, a sentence a line, if that was asked.
    """
    first = table.iloc[0]
    lines = [
        # quote: the name of a mix stands within an attribute too.
        f"<tr><td><a href='{escape(row.mix, quote=True)}/diagnosis.html'>{escape(row.mix)}</a></td>"
        f"<td>{row.rank_low}{f' to {row.rank_high}' if row.rank_high > row.rank_low else ''}</td>"
        f"<td>{row.E_MPa:.0f}</td><td>{row.E_low_MPa:.0f} to {row.E_high_MPa:.0f}</td>"
        f"<td>{row.phase_deg:.1f}</td><td>{row.phase_low_deg:.1f} to {row.phase_high_deg:.1f}</td>"
        f"<td>{row.tests}</td><td>{row.left_out}</td><td>{escape(row.causes) or 'none'}</td>"
        f"<td>{escape(row.possible_causes) or 'none'}</td></tr>"
        for row in table.itertuples()
    ]
    names = list(of_mixes["mix"].unique())
    keys = "".join(
        f'<li><span style="--light:{light};--dark:{dark}"></span>{escape(name)}</li>'
        for name, (light, dark) in zip(names, colours(len(names)), strict=True)
    )
    of_machine = "".join(f"<p>{escape(line)}</p>" for line in machine.splitlines())
    content = f"""<!doctype html><html lang="en"><meta charset="utf-8">
<meta name="viewport" content="width=device-width"><title>{len(table)} mixes</title><style>{STYLE}</style>
<h1>{len(table)} mixes</h1>
<p class="note">Stiffest at {first.temperature_C:g} °C and {first.frequency_Hz:g} Hz: {escape(first.mix)},
{first.E_MPa:.0f} MPa (95 % interval {first.E_low_MPa:.0f} to {first.E_high_MPa:.0f}).
All values are of the mix: the effects of all causes in the table are taken off, of the possible ones too.
A rank of several places says that the tests do not tell these mixes apart.</p>
<div class="wide"><table><tr><th>mix</th><th>rank</th><th>|E*| [MPa]</th><th>95 %</th><th>phase [°]</th><th>95 %</th>
<th>tests</th><th>left out</th><th>certain causes</th><th>possible causes</th></tr>{"".join(lines)}</table></div>
{f"<h2>The machine</h2>{of_machine}" * bool(machine)}
<div class="plots">{"".join(curves(of_mixes))}</div><ul class="keys">{keys}</ul></html>
"""
    with atomic_path(path) as temporary:
        temporary.write_text(content, encoding="utf-8")
