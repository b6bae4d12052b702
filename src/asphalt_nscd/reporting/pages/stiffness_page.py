"""The page of tests without a phase: what was found, and the master curve with its band."""

from __future__ import annotations

from html import escape
from pathlib import Path

import pandas as pd

from asphalt_nscd.files.store import atomic_path
from asphalt_nscd.reporting.pages.diagnosis_page import typeset
from asphalt_nscd.reporting.pages.laboratory import PAGE
from asphalt_nscd.reporting.pages.style import SCRIPT, STYLE
from asphalt_nscd.reporting.pages.svg import HINT, MODULUS, Axis, Frame, colours, key, svg, test


def write_page(folder: Path, title: str, said: str) -> Path:
    """Write the page beside stiffness_residuals.csv and master_curve.csv; `said` holds a line for each label."""
    tests = pd.read_csv(folder / "stiffness_residuals.csv", dtype={"specimen": str})
    curve = pd.read_csv(folder / "master_curve.csv").rename(columns={"frequency_Hz": "reduced_frequency_Hz"})
    label = f"reduced frequency (Hz), at {curve['temperature_C'].iloc[0]:g} \N{DEGREE SIGN}C"
    across = Axis(label, lambda of, _: of["reduced_frequency_Hz"], log=True)
    up = Axis(MODULUS.label, lambda of, end: of[f"E{end}_MPa"], log=True)
    frame = Frame(across, up, [(tests, ""), (curve, "_low"), (curve, "_high")])
    band = [*frame.points(curve, "_low"), *frame.points(curve, "_high")[::-1]]
    paths = ["L".join(f"{x:.1f} {y:.1f}" for x, y in points) for points in (band, frame.points(curve))]
    (ink,) = colours(1)
    parts = [f'<g style="--light:{ink[0]};--dark:{ink[1]}"><path class="band" d="M{paths[0]}Z"/>']
    parts.append(f'<path class="law" d="M{paths[1]}"/></g>')
    for (_, own), (light, dark) in zip(
        tests.groupby("isotherm_C"), colours(tests["isotherm_C"].nunique()), strict=True
    ):
        parts.append(f'<g style="--light:{light};--dark:{dark}">')
        for at, row in zip(frame.points(own), own.to_dict("records"), strict=True):
            words = (
                f"specimen {row['specimen']}, {row['temperature_C']:g} \N{DEGREE SIGN}C, {row['frequency_Hz']:g} Hz: "
                f"|E*| {row['E_MPa']:.4g} MPa, {row['residual_percent']:+.1f} % off the curve"
            )
            parts.append(test(at, words, key(row["specimen"], row["isotherm_C"], row["frequency_Hz"])))
        parts.append("</g>")
    lines = (line.partition("  ") for line in said.splitlines())
    answer = "".join(
        f'<tr><th scope="row">{escape(name)}</th><td>{escape(typeset(text.strip()))}</td></tr>'
        for name, _, text in lines
    )
    # The heads of this table stand at its left, where those of page.css would stick to the top.
    content = f"""<!doctype html><html lang="en"><meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1"><title>{escape(title)}</title>
<style>{STYLE}th {{ position: static; vertical-align: top; }}</style><script>{SCRIPT}</script>
<h1>{escape(title)}</h1><table aria-label="Answer">{answer}</table>
<figure class="chart"><div class="plots">{svg(f"|E*|, {len(tests)} tests", frame.parts + parts)}</div>
<p class="said" role="status">{HINT}</p>
<figcaption><b>Master curve of |E*|.</b> Points: tests. Line and band: the mix, 95 %.</figcaption></figure></html>
"""
    with atomic_path(folder / PAGE) as path:
        path.write_text(content, encoding="utf-8")
    return folder / PAGE
