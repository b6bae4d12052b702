"""What a diagnosis leaves, as plots for a page: residual map, master curve and Black diagram."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from html import escape
from pathlib import Path

import numpy as np
import pandas as pd

from asphalt_nscd.diagnosis.criteria import NOTABLE
from asphalt_nscd.diagnosis.written import (
    BEFORE_AFTER,
    RESIDUALS,
    conditions,
    read_diagnosis,
    read_residuals,
    three_digits,
)
from asphalt_nscd.files.csvinput import read_csv
from asphalt_nscd.files.words import counted, specimen_named
from asphalt_nscd.measurements.tables import only_file
from asphalt_nscd.reporting.figures.numbers import celsius, minus
from asphalt_nscd.reporting.pages.svg import (
    HINT,
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

ISOTHERM = "isotherm_C"
FRAMED = '<rect class="axis thin" x=".06" y=".1" width=".88" height=".8"/>'


def charts(residuals: Sequence[Path], diagnosis: Sequence[Path]) -> list[Chart]:
    """Residual map, master curve (isotherms where no law is common to all temperatures) and Black diagram."""
    content = read_diagnosis(diagnosis)
    shift = next((rung["log10_shift"] for rung in content["ladder"] if "log10_shift" in rung), None)
    tests = read_residuals(residuals)
    tests[ISOTHERM] = _isotherms(
        tests["temperature_C"], shift or content.get("reading", {}).get("isotherms_C")
    )
    # The arrow keys step through the tests in this order, along an isotherm.
    tests = tests.sort_values([ISOTHERM, "frequency_Hz", "specimen"])
    means = conditions(tests.assign(temperature_C=tests[ISOTHERM]), content["scatter"])
    means[ISOTHERM] = means["temperature_C"]
    isotherms = sorted(tests[ISOTHERM].unique())
    keys = [(celsius(at), *of) for at, of in zip(isotherms, colours(len(isotherms)), strict=True)]
    shown = "Points: tests. Lines: modelled with all causes, means over specimens."
    return [
        Chart(
            "residuals",
            "Residual map",
            "Measured less modelled, means over specimens. A frame: beyond "
            f"{NOTABLE:g} standard deviations of replicates.",
            tuple(_map(tests, means, quantity, when) for quantity in RESIDUALS for when in BEFORE_AFTER),
            hint=HINT.replace("test", "condition"),
        ),
        _master(tests, means, shift, (shown, keys)),
        Chart(
            "black",
            "Black diagram",
            shown,
            (_curves("|E*| against phase", tests, means, PHASE, MODULUS),),
            keys,
        ),
    ]


def law_chart(title: str, curve: Sequence[Path]) -> Chart:
    """|E*| and phase of the law and the free master curve, with 95 % bands, at the reference temperature."""
    table = read_csv(only_file(curve, "master curve"))
    names = [name for name in table.columns if name != "temperature_C"]
    frame = pd.DataFrame({name: table.numbers(name) for name in names})
    at = celsius(float(table.numbers("temperature_C")[0]))
    looks = dict(zip((title, "free master curve"), colours(2), strict=True))
    plots = []
    for label, stem, unit, log in (("|E*| (MPa)", "E", "MPa", True), ("phase (°)", "phase", "deg", False)):
        columns = {title: f"law_{stem}", "free master curve": stem}
        ends = [(frame, name) for name in frame.columns if f"{stem}_" in name and name.endswith(unit)]
        y = Axis(label, lambda of, end: of[end], log=log)
        drawn = Frame(Axis(f"frequency (Hz) at {at}", lambda of, _end: of["frequency_Hz"], log=True), y, ends)
        parts = drawn.parts
        for name, column in columns.items():
            light, dark = looks[name]
            parts.append(f'<g style="--light:{light};--dark:{dark}">')
            if f"{column}_low_{unit}" in frame:
                # Along the lower edge and back along the upper one.
                low, high = (drawn.points(frame, f"{column}_{side}_{unit}") for side in ("low", "high"))
                parts.append(f'<path class="band" d="M{_path([*low, *high[::-1]])}Z"/>')
            line = _path(drawn.points(frame, f"{column}_{unit}"))
            parts.append(f'<path class="law" d="M{line}"><title>{escape(name)}</title></path></g>')
        plots.append(svg(f"{label} of {title} and of the free master curve", parts))
    return Chart(
        "law",
        "The law and the free master curve",
        "Bands: 95 %, what scatter, specimens and named causes leave open; of the law, the misfit of its form too.",
        tuple(plots),
        [(name, *look) for name, look in looks.items()],
        of="Curves",
        hint="",
    )


def _path(points: Iterable[tuple[float, float]]) -> str:
    return "L".join(f"{a:.1f} {b:.1f}" for a, b in points)


def _isotherms(temperature: pd.Series, stated: Iterable[float | str] | None) -> np.ndarray:
    """Isotherm [degC] of each test (n,): of those stated the nearest to the temperature measured in the specimen."""
    nominal = np.array(sorted(float(at) for at in stated or temperature.unique()))
    return nominal[np.abs(temperature.to_numpy()[:, None] - nominal).argmin(axis=1)]


def _master(
    tests: pd.DataFrame,
    means: pd.DataFrame,
    shift: dict[str, float] | None,
    explained: tuple[str, list[tuple[str, str, str]]],
) -> Chart:
    """explained: what is shown, and the colours of isotherms."""
    shown, keys = explained
    factors = {float(at): 10.0**value for at, value in (shift or {}).items()}

    def frequency(of: pd.DataFrame, _end: str) -> pd.Series:
        return of["frequency_Hz"] * (of[ISOTHERM].map(factors) if factors else 1.0)

    label, title = "frequency (Hz)", "Isotherms"
    if factors:
        reference = min(factors, key=lambda at: abs(np.log10(factors[at])))
        label, title = f"reduced frequency (Hz), at {celsius(reference)}", "Master curve"
    else:
        shown += " No law common to all temperatures was taken, so there are no shift factors."
    x = Axis(label, frequency, log=True)
    return Chart(
        "master",
        title,
        shown,
        (_curves("|E*|", tests, means, x, MODULUS), _curves("phase angle", tests, means, x, PHASE)),
        keys,
    )


def _curves(title: str, tests: pd.DataFrame, means: pd.DataFrame, x: Axis, y: Axis) -> str:
    """A group for each isotherm: the line of the simulation, then the tests."""
    frame = Frame(x, y, [(tests, ""), (means, "_after")])
    parts = frame.parts
    temperatures = sorted(tests[ISOTHERM].unique())
    for temperature, (light, dark) in zip(temperatures, colours(len(temperatures)), strict=True):
        rows = tests[tests[ISOTHERM] == temperature]
        line = means[means[ISOTHERM] == temperature].sort_values("frequency_Hz")
        path = _path(frame.points(line, "_after"))
        parts.append(f'<g style="--light:{light};--dark:{dark}"><path class="law" d="M{path}"/>')
        parts += [
            test(at, _words(row), key(row["specimen"], temperature, row["frequency_Hz"]))
            for at, row in zip(frame.points(rows), rows.to_dict("records"), strict=True)
        ]
        parts.append("</g>")
    return svg(f"{title}, {counted(len(tests), 'test')}", parts)


def _map(tests: pd.DataFrame, means: pd.DataFrame, quantity: str, when: str) -> str:
    """A cell for each condition, coloured by its mean residual; one scale for before and after."""
    column, unit = RESIDUALS[quantity].format(when), "%" if quantity == "E" else "°"
    name = "|E*|" if quantity == "E" else "phase"
    columns = [RESIDUALS[quantity].format(one) for one in BEFORE_AFTER]
    largest = float(means[columns].abs().max().max()) or 1.0
    every = []
    for row in means.sort_values(["temperature_C", "frequency_Hz"]).to_dict("records"):
        value = row[column]
        # A condition that was not simulated has no error before.
        if pd.isna(value):
            continue
        own = tests[(tests[ISOTHERM] == row[ISOTHERM]) & (tests["frequency_Hz"] == row["frequency_Hz"])]
        each = ", ".join(
            f"{one} {signed(off)}" for one, off in zip(own["specimen"], own[column], strict=True)
        )
        words = (
            f"{celsius(row['temperature_C'])}, {row['frequency_Hz']:g} Hz: {name} measured less modelled "
            f"{when}, mean {signed(value)} {unit}; specimens: {each}"
        )
        beyond = abs(row[f"z_{column}"]) > NOTABLE
        every.append(
            Cell(row["temperature_C"], row["frequency_Hz"], value, words, mark=FRAMED if beyond else "")
        )
    return cells(f"{name}, {when} ({unit})", f"{name} {when}, {len(means)} conditions", every, largest)


def _words(test: dict[str, float | str]) -> str:
    modulus, phase = (f"{three_digits(float(test[name]))}" for name in ("E_MPa", "phase_deg"))
    return (
        f"{specimen_named(str(test['specimen']))}, {celsius(float(test['temperature_C']))}, "
        f"{test['frequency_Hz']:g} Hz: |E*| {modulus} MPa, phase {minus(phase)}°; measured less modelled "
        f"{signed(float(test['residual_E_after_percent']))} %, {signed(float(test['residual_phase_after_deg']))}°"
    )
