"""What the report opens with: the numbers of its first page, whose sentences stand in first_page.html."""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pandas as pd

from asphalt_nscd.diagnosis.words.facts import LAW
from asphalt_nscd.diagnosis.words.sentences import cause_words
from asphalt_nscd.diagnosis.written import read_diagnosis, three_digits
from asphalt_nscd.files.csvinput import read_csv
from asphalt_nscd.measurements.tables import only_file
from asphalt_nscd.reporting.pages.diagnosis_page import words
from asphalt_nscd.reporting.pages.way import LIKELIEST, QUANTITIES, held_out, means, read_ladder

ENOUGH = 5000  # spheres
ELSEWHERE = (
    "Tests",
    "Note",
    "Scatter",
    "Not visible",
    "Next tests",
)  # rows of the answer with a card of their own
ONE_LAW = "one law for all temperatures in place of a Burgers law at each"
LEFT_OUT = (
    "temperatures between the ends",
    "coldest and warmest",
    "frequencies between the ends",
    "lowest and highest",
)
NUMBERS = ("temperature_C", "frequency_Hz", "E_MPa", "phase_deg", "spheres", "bonds", "E_over_law")


def first_page(
    measured: Sequence[Path],
    simulations: Sequence[Path],
    samples: Sequence[Path],
    diagnosis: list[Path],
    pictures: list[Path],
    ladder: Sequence[Path],
    beside: Sequence[Path] = (),
) -> dict[str, Any]:
    """What the template of the first page asks for.

    Each sequence holds one file; the PNG in `pictures` opens the page. `ladder` is ladder.csv, the errors of each
    campaign. `beside` holds rivals.csv, the errors of tests left out, ensemble.csv, the gain on data that meet the
    paper's tables, and audit.csv, the verdicts on its statements.
    """
    content = read_diagnosis(diagnosis)
    said = words(content, ladder)
    way = read_ladder(ladder)
    moduli, tests, specimens = (
        _frame(paths, name)
        for paths, name in ((measured, "measured"), (simulations, "simulations"), (samples, "samples"))
    )
    rungs = list(dict.fromkeys(way["rung"]))
    # The likeliest reading, which one sample alone was tested by, stands below the rung that the ladder begins with.
    begin = way[way["rung"] == rungs[1 if rungs[0] == LIKELIEST else 0]]
    gained = _gained(way)
    longest = [max(float(row[n]) for row in gained) for n in (1, 2)]
    left_out = _left_out(way, [path for path in beside if path.stem == "rivals"])
    audit = [path for path in beside if path.stem == "audit"]
    return {
        "content": content,
        "words": said,
        "found": [(label, items) for label, items in said.rows() if label not in ELSEWHERE],
        "named": {
            sure: [
                ONE_LAW if rung["cause"] == LAW else cause_words(rung)
                for rung in content["ladder"]
                if rung["established"] == sure
            ]
            for sure in (True, False)
        },
        "invented": "reconstructed" in content["origin"],
        "tests": moduli,
        "range": {name: _range(moduli[name]) for name in NUMBERS[:4]},
        "simulated": tests,
        "conditions": len(tests[["temperature_C", "frequency_Hz"]].drop_duplicates()),
        "samples": specimens,
        "range_of_samples": {name: _range(specimens[name]) for name in ("spheres", "E_over_law")},
        "small": specimens["spheres"].max() < ENOUGH,
        "misses": begin.mean(numeric_only=True),
        "worst": {
            q: _number(begin.set_index("temperature_C")[f"mre_{q}_percent"].idxmax()) for q in QUANTITIES
        },
        "likeliest": way[way["rung"] == LIKELIEST].mean(numeric_only=True) if rungs[0] == LIKELIEST else None,
        "gained": gained,
        "bars": {
            name: [(row[0], row[n], 100.0 * float(row[n]) / longest[n - 1]) for row in gained]
            for n, name in enumerate(QUANTITIES.values(), 1)
        },
        "left_out": left_out,
        "held_out": [] if left_out else [held_out(way, ends) for ends in (False, True)],
        "elsewhere": _ensemble([path for path in beside if path.stem == "ensemble"]),
        "verdicts": dict(_frame(audit, "audit")["verdict"].value_counts()) if audit else {},
        "pictures": [b64encode(path.read_bytes()).decode() for path in pictures],
    }


def _frame(paths: Sequence[Path], name: str) -> pd.DataFrame:
    table = read_csv(only_file(paths, name))
    # Only these: a specimen called 01 is no number.
    columns = table.columns.items()
    return pd.DataFrame({key: table.numbers(key) if key in NUMBERS else values for key, values in columns})


def _gained(way: pd.DataFrame) -> list[tuple[str, ...]]:
    """Errors after each rung, mean over temperatures; last the scatter of one test."""
    errors = means(way)
    rows = [
        (rung, *(three_digits(row[f"mre_{q}_percent"]) for q in QUANTITIES))
        for rung, row in errors.iterrows()
    ]
    scatter = (three_digits(errors[f"scatter_{q}_percent"].iloc[0]) for q in QUANTITIES)
    return [*rows, ("scatter of one test", *scatter)]


def _left_out(way: pd.DataFrame, rivals: Sequence[Path]) -> list[tuple[str, ...]]:
    """Errors of the one law at tests left out of its fit: temperatures from the ladder, frequencies from the rivals."""
    errors = [held_out(way, ends) for ends in (False, True)]
    if not rivals or not all(errors):
        return []
    table = read_csv(only_file(rivals, "rivals"))
    for kind in ("inner", "end"):
        errors.append({q: table.numbers_or_nan(f"{kind}_frequencies_{q}_percent")[0] for q in QUANTITIES})
    rows = zip(LEFT_OUT, errors, strict=True)
    return [(name, *(three_digits(error[q]) for q in QUANTITIES)) for name, error in rows]


def _ensemble(ensemble: Sequence[Path]) -> dict[str, str] | None:
    """Errors of one law and of the Burgers laws on data of which the paper's laws are the fit."""
    if not ensemble:
        return None
    table = read_csv(only_file(ensemble, "ensemble"))
    names = [f"{kind}_{q}" for kind in ("mean", "burgers") for q in QUANTITIES]
    return {name: three_digits(table.numbers_or_nan(f"{name}_percent")[0]) for name in names}


def _range(values: pd.Series) -> str:
    low, high = (_number(value) for value in (values.min(), values.max()))
    return low if low == high else f"{low} to {high}"


def _number(value: float) -> str:
    """Four digits, or all before the point."""
    return f"{value:.0f}" if abs(value) >= 1e4 else f"{value:.4g}"
