"""A diagnosis as a page that a pavement engineer can act on, readable in the report and offline."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import pandas as pd

from asphalt_nscd.diagnosis.simulation.bond_mapping import NAME as BOND_MAPPING
from asphalt_nscd.diagnosis.words import sentences
from asphalt_nscd.diagnosis.words.answer import Words
from asphalt_nscd.diagnosis.words.sentences import cause_words, spell_cause
from asphalt_nscd.diagnosis.words.tables import tables
from asphalt_nscd.diagnosis.written import WIDE_SPREAD, mean_averages, read_diagnosis, three_digits
from asphalt_nscd.files.csvinput import read_csv
from asphalt_nscd.files.store import atomic_path
from asphalt_nscd.files.words import specimen_named
from asphalt_nscd.measurements.tables import only_file
from asphalt_nscd.reporting.pages.charts import charts
from asphalt_nscd.reporting.pages.style import filled
from asphalt_nscd.reporting.pages.way import QUANTITIES, left_by_the_last, read_ladder

MADE_OF = {
    "diagnosis": "diagnosis.json",
    "residuals": "residuals.csv",
    "causality": "causality.csv",
    "curve": "master_curve.csv",
    "corrected": "corrected.csv",
}
FILES = {  # that may lie beside the page, and what they hold
    "report.pdf": "pages to hand on",
    "corrected.xlsx": "the tables in one workbook",
    "corrected.csv": "each test",
    "reported.csv": "values of the mix",
    "master_curve.csv": "its curve",
    "law.json": "its law, for other programs",
    "limits.csv": "limits tried",
    "residuals.csv": "each test less a Burgers law of each temperature (before) and less one law with causes (after)",
    "causality.csv": "phases that |E*| requires",
    "diagnosis.json": "all of it",
}
TEMPLATE, PAGE = "diagnosis_page.html", "diagnosis.html"
LEAST_P = 1e-6  # beyond which a chance is of no more use to a reader
HELD_OUT = {
    "leave_one_isotherm_out": "each temperature between others predicted from them",
    "leave_one_frequency_out": "each frequency predicted from the others",
}
PARAMETERS = {  # of a law as a reader knows it: name, how many of the unit shown are one of the key's, unit
    "E_static_Pa": ("E static", 1e-6, "MPa"),
    "E_glassy_Pa": ("E glassy", 1e-9, "GPa"),
    "tau_s": ("tau", 1.0, "s"),
    "wlf_C1": ("WLF C1", 1.0, "decades"),
    "wlf_C2_K": ("WLF C2", 1.0, "K"),
    "activation_energy_J_mol": ("activation energy", 1e-3, "kJ/mol"),
}
TABLE4 = [f"mre_{q}_{k}_percent" for q in ("E", "phase") for k in ("published", "simulated")]


def write_page(folder: Path, title: str) -> Path:
    """Write diagnosis.html from the files of a diagnosis; it links those that are there."""
    links = {name: words for name, words in FILES.items() if (folder / name).is_file()}
    made_of = {kind: [folder / name] for kind, name in MADE_OF.items()}
    content = render(sections(**made_of), title, links)
    with atomic_path(folder / PAGE) as path:
        path.write_text(content, encoding="utf-8")
    return folder / PAGE


def render(content: Mapping[str, Any], title: str, links: Mapping[str, str] | None = None) -> str:
    """HTML of what `sections` gives; `links` are files beside the page, and what they hold."""
    return filled(TEMPLATE, title=title, links=links, **content)


def sections(
    diagnosis: list[Path],
    residuals: list[Path],
    causality: list[Path],
    table4: Sequence[Path] = (),
    ladder: Sequence[Path] = (),
    curve: Sequence[Path] = (),
    corrected: Sequence[Path] = (),
) -> dict[str, Any]:
    """What the page says, for its template: text, rows of text, and plots that name their tests.

    `table4` and `ladder` are tables of a study; `curve` is master_curve.csv and `corrected` corrected.csv.
    """
    content = read_diagnosis(diagnosis)
    rungs, isotherms = content["ladder"], content["reading"]["isotherms_C"]
    return {
        "diagnosis": content,
        "words": words(content, ladder),
        "tables": tables(content),
        "charts": charts(residuals, causality, diagnosis, curve, corrected),
        # Table 4 is of the paper's mix: beside measurements of another it says nothing.
        "table4": _table4(table4) if "reconstructed" in content["origin"] and table4 else [],
        "way": _way(ladder) if ladder else None,
        "ladder": [row for rung in rungs for row in _rows(rung, sentences.widened(content))],
        "baseline": _baseline(content["baseline"]),
        "law": law(content),
        "unexplained": [_unexplained(row) for row in content["unexplained"]],
        "limits": [
            (name.replace("_", " "), sentences.limits(limit, isotherms))
            for name, limit in content["detection_limits"].items()
        ],
        "spread": content["estimates_spread"] if content["estimates_spread"] >= WIDE_SPREAD else None,
        "not_testable": [(spell_cause(row["cause"]), row["needs"]) for row in content["not_testable"]],
        "alike": [list(map(spell_cause, group)) for group in content["indistinguishable"]],
        "suspects": [_suspect(one) for one in content["suspect_tests"]],
    }


def words(content: Mapping[str, Any], ladder: Sequence[Path] = ()) -> Words:
    """What the terminal says of a diagnosis; of a study with the errors of its own campaigns, the one `ladder`."""
    return Words(content, left_by_the_last(read_ladder(ladder)) if ladder else None)


def law(content: Mapping[str, Any]) -> dict[str, Any] | None:
    """What a page shows of law.json: title, parameters with intervals, errors of all laws; None if none was fitted."""
    if not content["law_parameters"]:
        return None
    rows = [
        [
            f"{one['title']}{', in law.json' * one['taken']}",
            f"{one['parameters']}",
            _number(one["mre_E_percent"]),
            _number(one["off_phase_deg"]),
        ]
        for one in content["laws"]
    ]
    return {
        "title": next(one["title"] for one in content["laws"] if one["taken"]),
        "parameters": [_parameter(key, one) for key, one in content["law_parameters"].items()],
        "laws": rows,
    }


def _parameter(key: str, one: Mapping[str, Any]) -> list[str]:
    """A row: name, value and 95 % interval, unit, and whether the tests determine it."""
    name, factor, unit = PARAMETERS.get(key, (key, 1.0, ""))
    interval = " to ".join(_number(factor * end) for end in one["interval_95"] or ())
    return [name, _number(factor * one["value"]), interval, unit, "yes" if one["determined"] else "no"]


def _table4(paths: Sequence[Path]) -> list[list[str]]:
    """Published and predicted errors by temperature; empty where nothing was published."""
    table = read_csv(only_file(paths, "table4"))
    if TABLE4[0] not in table.columns:
        return []
    table.require(["temperature_C", *TABLE4])
    columns = [table.numbers_or_nan(name) for name in TABLE4]
    at = table.numbers("temperature_C")
    return [[_celsius(t), *map(_number, row)] for t, *row in zip(at, *columns, strict=True)]


def _rows(rung: Mapping[str, Any], factor: float) -> list[list[str]]:
    """Rows of one rung of the ladder: its sizes and chance, and errors before and after it, fitted and left out."""
    # How bonds carry the law is computed, and widened by no scatter of the tests.
    factor = 1.0 if rung["cause"] == BOND_MAPPING else factor
    sizes = [
        f"{name.replace('_', ' ')} {sentences.estimate(one, factor)}"
        for name, one in rung["parameters"].items()
    ]
    p = rung["p_value"]
    chance = "" if p is None else f"below {LEAST_P:g}" if p < LEAST_P else f"{p:.1g}"
    held = [
        ["", "", "", words, *_errors(rung["gain"]["held_out"][name], name == "leave_one_isotherm_out")]
        for name, words in HELD_OUT.items()
        if name in rung["gain"]["held_out"]
    ]
    fitted = _errors(rung["gain"]["in_sample"])
    return [[cause_words(rung), "; ".join(sizes), chance, "fitted", *fitted], *held]


def _errors(gain: Mapping[str, Any], inner: bool = False) -> list[str]:
    """Errors as in Table 4, mean over temperatures, and residuals over scatter; empty where these are none.

    inner: of temperatures between others only.
    """
    found = mean_averages(gain, inner)
    pairs = [found["mre_E_percent"], found["mre_phase_percent"], gain.get("rms_over_scatter", {})]
    return [" → ".join(map(_number, pair.values())) for pair in pairs]


def _way(paths: Sequence[Path]) -> dict[str, Any]:
    """Errors of each campaign by temperature and in the mean, the law's own and the scatter of one test below them."""
    ladder = read_ladder(paths)
    at, rungs, rows = list(ladder["temperature_C"].unique()), list(ladder["rung"].unique()), []
    for quantity, name in QUANTITIES.items():
        lines = [(rung, rung, f"mre_{quantity}_percent") for rung in rungs]
        lines.append((f"the law's own, {rungs[0]}", rungs[0], f"mre_{quantity}_law_percent"))
        lines.append(("scatter of one test", rungs[0], f"scatter_{quantity}_percent"))
        for label, rung, column in lines:
            errors = ladder[ladder["rung"] == rung].set_index("temperature_C")[column]
            rows.append([f"{name}: {label}", *(_number(errors[t]) for t in at), _number(errors.mean())])
    return {"head": ["", *map(_celsius, at), "mean"], "rows": rows}


def _suspect(one: Mapping[str, Any]) -> list[str]:
    where = [one["specimen"], _celsius(one["temperature_C"]), f"{one['frequency_Hz']:g} Hz"]
    return [*where, one["status"], "; ".join(one["reasons"]), one["decided_by"]]


def _baseline(baseline: Mapping[str, Any]) -> list[list[str]]:
    phase = baseline["mre_phase_percent"]
    rows = sorted(baseline["mre_E_percent"].items(), key=lambda row: float(row[0]))
    return [[_celsius(float(at)), _number(error), _number(phase[at])] for at, error in rows]


def _unexplained(row: Mapping[str, Any]) -> list[str]:
    numbers = ("frequency_Hz", "residual_E_percent", "residual_phase_deg", "z")
    specimen = f"{specimen_named(row['specimen'])}, set aside" if row["specimen"] else "mean"
    return [_celsius(row["temperature_C"]), *(_number(row[name]) for name in numbers), specimen]


def _celsius(temperature: float) -> str:
    return f"{temperature:g} degC"


def _number(value: float) -> str:
    return "" if pd.isna(value) else three_digits(value)
