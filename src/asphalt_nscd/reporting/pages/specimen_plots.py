"""Specimens side by side, and modulus against phase, as plots for a page from causality.csv."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import pandas as pd

from asphalt_nscd.diagnosis.written import read_causality, read_diagnosis, three_digits
from asphalt_nscd.files.words import counted, specimen_named
from asphalt_nscd.reporting.figures.numbers import celsius, minus
from asphalt_nscd.reporting.pages.svg import (
    MODULUS,
    PHASE,
    Axis,
    Cell,
    Chart,
    Frame,
    cells,
    colours,
    key,
    signed,
    svg,
    test,
)

CLEAR = 2.0  # standard errors, below which a difference says little
NONE = "No isotherm has the four tests needed to compare modulus and phase."
CROSS = '<path class="mark" d="M.06 .08L.2 .34M.06 .34L.2 .08"/>'
RING = '<ellipse class="mark" cx=".13" cy=".21" rx=".08" ry=".13"/>'
FLAG = '<path class="mark full" d="M.82 .26L.88 .08L.94 .26Z"/>'


def charts(causality: Sequence[Path], diagnosis: Sequence[Path]) -> list[Chart]:
    """Black diagram with master curves, and maps of measured phase less that of causality, by specimen."""
    content, tests = read_diagnosis(diagnosis), read_causality(causality)
    return [_side_by_side(tests, content), _against_phase(tests)]


def _side_by_side(tests: pd.DataFrame, content: dict) -> Chart:
    rung = next((one for one in content["ladder"] if "log10_shift" in one), None)
    shift = {float(t): value for t, value in rung["log10_shift"].items()} if rung else {}
    label = "frequency (Hz); no law common to all temperatures"
    if shift:
        label = f"reduced frequency (Hz), at {celsius(min(shift, key=lambda t: abs(shift[t])))}"
    reduced = tests["frequency_Hz"] * 10.0 ** tests["temperature_C"].map(shift).fillna(0.0)
    tests = tests.assign(reduced_Hz=reduced)
    x = Axis(label, lambda of, _end: of["reduced_Hz"], log=True)
    names = list(tests["specimen"].unique())
    looks = dict(zip(names, colours(len(names)), strict=True))
    plots = tuple(
        _points(title, tests, looks, *axes)
        for title, axes in (
            ("Black diagram", (PHASE, MODULUS)),
            ("|E*|", (x, MODULUS)),
            ("phase angle", (x, PHASE)),
        )
    )
    return Chart(
        "specimens",
        "Black diagram and master curves",
        "Tests of one material should lie on one curve. Hollow points mark suspect tests.",
        plots,
        [(name, *look) for name, look in looks.items()],
        of="Specimens",
    )


def _points(title: str, tests: pd.DataFrame, looks: dict[str, tuple[str, str]], x: Axis, y: Axis) -> str:
    frame = Frame(x, y, [(tests, "")])
    parts = frame.parts
    for name, (light, dark) in looks.items():
        own = tests[tests["specimen"] == name]
        parts.append(f'<g style="--light:{light};--dark:{dark}">')
        parts += [
            test(
                at,
                _words(row),
                key(name, row["temperature_C"], row["frequency_Hz"]),
                "test" if row["reasons"] else "test full",
            )
            for at, row in zip(frame.points(own), own.to_dict("records"), strict=True)
        ]
        parts.append("</g>")
    return svg(f"{title}, {counted(len(tests), 'test')}", parts)


def _against_phase(tests: pd.DataFrame) -> Chart:
    tests = tests.assign(difference=tests["phase_deg"] - tests["phase_required_deg"])
    # The size of one degree is seen on the worst table too.
    largest = max(float(tests["difference"].abs().max()), 1.0)
    plots = []
    for name in tests["specimen"].unique():
        # Amplitudes share a cell, which shows the worst.
        own = tests[(tests["specimen"] == name) & tests["difference"].notna()]
        worst = own.sort_values("difference", key=abs).drop_duplicates(
            ["temperature_C", "frequency_Hz"], keep="last"
        )
        worst = worst.sort_values(["temperature_C", "frequency_Hz"])
        every = [_cell(row) for row in worst.to_dict("records")]
        if every:
            label = f"{specimen_named(str(name))}, {counted(len(every), 'test')}"
            plots.append(cells(f"{name}: phase less phase required (°)", label, every, largest))
    return Chart(
        "causality",
        "Phase measured less the phase that |E*| requires",
        "In degrees. The required phase is computed from |E*| alone, and no delay or offset is taken off. The list of "
        "doubtful tests uses the phases at the other frequencies too, so its numbers differ. Grey numbers are "
        "within two standard errors. Cross: suspect, not used. Ring: suspect, used. Triangle: a quality limit is "
        "exceeded."
        if plots
        else NONE,
        tuple(plots),
        of="",
    )


def _cell(row: dict) -> Cell:
    value, suspect = row["difference"], bool(row["reasons"])
    mark = "" if not suspect else RING if row["used"] else CROSS
    return Cell(
        row["temperature_C"],
        row["frequency_Hz"],
        value,
        _words(row),
        str(row["specimen"]),
        abs(value) < CLEAR * row["std_error_deg"],
        mark + FLAG * bool(row["quality_flag"]),
    )


def _words(row: dict) -> str:
    modulus, phase = three_digits(float(row["E_MPa"])), minus(f"{row['phase_deg']:.1f}")
    words = (
        f"{specimen_named(str(row['specimen']))}, {celsius(row['temperature_C'])}, {row['frequency_Hz']:g} Hz: "
        f"|E*| {modulus} MPa, phase {phase}°"
    )
    if pd.notna(row["phase_required_deg"]):
        off = signed(row["phase_deg"] - row["phase_required_deg"])
        words += f"; {off}° from what |E*| alone requires (standard error {row['std_error_deg']:.1f}°)"
    if row["reasons"]:
        words += f"; suspect, {'used' if row['used'] else 'not used'}: {row['reasons']}"
    return words
