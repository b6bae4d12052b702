"""A diagnosis as a page that a pavement engineer can act on, readable in the report and offline."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import pandas as pd

from asphalt_nscd.diagnosis.simulation.bond_mapping import NAME as BOND_MAPPING
from asphalt_nscd.diagnosis.words import brief, sentences, table_rows, unexplained, verdict
from asphalt_nscd.diagnosis.written import (
    WIDE_SPREAD,
    limits_by_place,
    mean_averages,
    member_name,
    place_name,
    read_diagnosis,
    shown,
    three_digits,
)
from asphalt_nscd.files.csvinput import read_csv
from asphalt_nscd.files.store import atomic_path
from asphalt_nscd.files.words import specimen_named
from asphalt_nscd.measurements.tables import only_file
from asphalt_nscd.reporting.pages.charts import charts
from asphalt_nscd.reporting.pages.style import filled, typeset
from asphalt_nscd.reporting.pages.way import QUANTITIES, left_by_the_last, read_ladder

TEMPLATE, PAGE = "diagnosis_page.html", "diagnosis.html"
LEAST_P = 1e-6  # beyond which a chance is of no more use to a reader
INNER = "leave_one_isotherm_out"
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
TABLE4 = (
    "temperature_C",
    *(f"mre_{q}_{k}_percent" for q in ("E", "phase") for k in ("published", "simulated")),
)


def write_page(folder: Path, title: str) -> Path:
    """Write diagnosis.html from the files of a diagnosis; it links limits.csv and law.json where they are."""
    names = ("residuals.csv", "causality.csv", "diagnosis.json")
    residuals, causality, diagnosis = (folder / name for name in names)
    others = (folder / name for name in ("limits.csv", "law.json"))
    links = [path.name for path in (residuals, causality, *filter(Path.is_file, others), diagnosis)]
    curve = list(filter(Path.is_file, [folder / "master_curve.csv"]))
    content = render(sections([diagnosis], [residuals], [causality], curve=curve), title, links)
    with atomic_path(folder / PAGE) as path:
        path.write_text(content, encoding="utf-8")
    return folder / PAGE


def render(content: Mapping[str, Any], title: str, links: Sequence[str] = ()) -> str:
    """HTML of what `sections` gives; `links` are files beside the page that hold what it shows."""
    return filled(TEMPLATE, title=title, links=links, **content)


def sections(
    diagnosis: list[Path],
    residuals: list[Path],
    causality: list[Path],
    table4: Sequence[Path] = (),
    ladder: Sequence[Path] = (),
    curve: Sequence[Path] = (),
) -> dict[str, Any]:
    """What the page says, for its template: text, rows of text, and plots that name their tests.

    `table4` and `ladder` are tables of a study; `curve` is master_curve.csv.
    """
    content = read_diagnosis(diagnosis)
    rungs = content["ladder"]
    return {
        "first": first(content, ladder),
        "value": value(content["reported"]),
        "charts": charts(residuals, causality, diagnosis, curve),
        "origin": sentences.origin(content),
        "scatter": scatter(content),
        # Table 4 is of the paper's mix: beside measurements of another it says nothing.
        "table4": _table4(table4) if "reconstructed" in content["origin"] and table4 else [],
        "diagnosis": content,
        "ladder": [_rung(rung, content) | {"as_good": _members(rung["as_good"])} for rung in rungs],
        "way": _way(ladder) if ladder else None,
        "baseline": _baseline(content["baseline"]),
        "law": law(content),
        "unexplained": [_unexplained(row) for row in content["unexplained"]],
        "limits": _limits(content["detection_limits"]),
        "limits_caption": _limits_caption(content["estimates_spread"]),
        "not_testable": [(member_name(row["cause"]), row["needs"]) for row in content["not_testable"]],
        "alike": [_members(group) for group in content["indistinguishable"]],
        "notes": [*content["reading"]["notes"], *content["notes"]],
        "suspects": [_suspect(one) for one in content["suspect_tests"]],
        "withdrawn": _members(content["withdrawn"]),
        "confirmed_by": [
            (_cause(rung), rung["confirmed_by"]) for rung in rungs if rung["cause"] != BOND_MAPPING
        ],
    }


def first(content: Mapping[str, Any], ladder: Sequence[Path] = ()) -> dict[str, Any]:
    """What a laboratory reads first, as the terminal says it; of a study, with the errors of its own campaigns.

    `content` is that of diagnosis.json; `ladder` is the one ladder.csv of a study, empty for a table alone.
    """
    left = left_by_the_last(read_ladder(ladder)) if ladder else None
    none = {"orders": [], "costs": ""}
    # nobody can test again a specimen that never was
    found = none if "reconstructed" in content["origin"] else content["instructions"]
    return {
        "answer": brief.rows(content, left),
        "simulated": verdict.simulation_miss(content, left),
        "is_simulated": left is not None or verdict.bonded(content),
        "head": verdict.TWO_LAWS,
        "two_laws": [] if left is not None else verdict.two_laws(content),
        "with_suspects": sentences.suspect_change(content),
        "doubtful": sentences.doubtful_change(content),
        "law": sentences.law_of_the_mix(content),
        "of_intervals": sentences.interval_note(content),
        "causes": sentences.causes(content),
        "no_cause": unexplained.absence_note(content),
        "of_what_is_left": unexplained.OF_WHAT_IS_LEFT,
        "left": unexplained.left(content),
        "orders": found["orders"],
        "costs": found["costs"],
        "ranked": sentences.RANKED,
        "limits_head": table_rows.LIMITS_HEAD,
        "limits_stated": table_rows.LIMITS_STATED,
        "measured_limits": [[typeset(cell) for cell in row] for row in table_rows.measured_limits(content)],
        "scatter_caption": table_rows.SCATTER_CAPTION,
        "scatter_head": [typeset(name).replace("deg", "°") for name in table_rows.SCATTER_HEAD],
        "scatter": [[typeset(cell) for cell in row] for row in table_rows.scatter_rows(content)],
        "excess_caption": table_rows.EXCESS_CAPTION,
        "excess_head": [typeset(name).replace("deg", "°") for name in table_rows.EXCESS_HEAD],
        "excess": [[typeset(cell) for cell in row] for row in table_rows.excess_rows(content)],
    }


def value(reported: dict[str, Any]) -> str:
    """What a standard asks for first, with its 95 % intervals."""
    at = f"{reported['temperature_C']:g} °C, {reported['frequency_Hz']:g} Hz"
    modulus, phase = (
        [reported[f"{name}{end}_{unit}"] for end in ("", "_low", "_high")]
        for name, unit in (("E", "MPa"), ("phase", "deg"))
    )
    beyond = "" if reported.get("within_the_tests", True) else "; extrapolated, no test was made near it"
    return (
        f"|E*|({at}) = {modulus[0]:.0f} MPa ({modulus[1]:.0f} to {modulus[2]:.0f}), phase {phase[0]:.1f}° "
        f"({phase[1]:.1f} to {phase[2]:.1f}){beyond}"
    )


def law(content: Mapping[str, Any]) -> dict[str, Any] | None:
    """What a page shows of law.json: title, parameters with intervals, errors of all laws; None if none was fitted."""
    if not content["law_parameters"]:
        return None
    taken = next(one for one in content["laws"] if one["taken"])
    return {
        "title": taken["title"],
        "parameters": [_parameter(key, one) for key, one in content["law_parameters"].items()],
        "laws": [
            [
                f"{one['title']}{', in law.json' * one['taken']}",
                f"{one['parameters']}",
                _number(one["mre_E_percent"]),
                _number(one["mre_phase_percent"]),
            ]
            for one in content["laws"]
        ],
    }


def _parameter(key: str, one: Mapping[str, Any]) -> list[str]:
    """A row: name, value and 95 % interval, unit, and whether the tests determine it."""
    name, factor, unit = PARAMETERS.get(key, (key, 1.0, ""))
    low_high = one["interval_95"]
    interval = "" if low_high is None else " to ".join(_number(factor * end) for end in low_high)
    return [name, _number(factor * one["value"]), interval, unit, "yes" if one["determined"] else "no"]


def scatter(content: Mapping[str, Any]) -> str:
    """Paragraph on the scatter that one test is taken to have, in % of |E*| and degrees, and how it is known."""
    scatter = content["scatter"]
    sizes = (
        f"The scatter of one test is taken as {scatter['modulus_percent']:.2g} % of |E*| and "
        f"{scatter['phase_deg']:.2g}°"
    )
    if scatter["from_replicates"]:
        return f"{sizes} at all isotherms: within specimens, and what changes from one mounting to the next."
    if content["provenance"]["scatter_stated"]:
        return f"{sizes}, as was stated."
    return f"{sizes} as far as a smooth law can tell, for nothing was repeated."


def _table4(paths: Sequence[Path]) -> list[list[str]]:
    """Published and predicted errors by temperature; empty where nothing was published."""
    table = read_csv(only_file(paths, "table4"))
    if TABLE4[1] not in table.columns:
        return []
    table.require(TABLE4)
    frame = pd.DataFrame({name: table.numbers_or_nan(name) for name in TABLE4})
    return [[place_name(row[0]), *map(_number, row[1:])] for row in frame.itertuples(index=False)]


def _rung(rung: Mapping[str, Any], content: Mapping[str, Any]) -> dict[str, Any]:
    """A row of the ladder."""
    gain = rung["gain"]
    # How bonds carry the law is computed, and widened by no scatter of the tests.
    factor = 1.0 if rung["cause"] == BOND_MAPPING else sentences.widened(content)
    return {
        "cause": _cause(rung),
        "sentence": rung["sentence"],
        "p": _chance(rung["p_value"]),
        "evidence": rung["evidence"],
        "parameters": [_estimate(name, value, factor) for name, value in rung["parameters"].items()],
        "established": rung["established"],
        "hangs_on": rung["hangs_on"],
        "doubts": rung["doubts"],
        "in_sample": _gain(gain["in_sample"]),
        "held_out": {
            HELD_OUT[name]: _gain(gain["held_out"][name], name == INNER)
            for name in HELD_OUT
            if name in gain["held_out"]
        },
    }


def _way(paths: Sequence[Path]) -> dict[str, Any]:
    """Errors of each campaign by temperature and in the mean, the law's own and the scatter of one test below them."""
    ladder = read_ladder(paths)
    at = list(ladder["temperature_C"].unique())
    rows = []
    for quantity, words in QUANTITIES.items():
        shown = {f"{words}: {rung}": rung for rung in ladder["rung"].unique()}
        columns = dict.fromkeys(shown, f"mre_{quantity}_percent")
        first = next(iter(shown.values()))
        shown |= {f"{words}: the law's own, {first}": first, f"{words}: scatter of one test": first}
        columns |= dict(
            zip(list(shown)[-2:], (f"mre_{quantity}_law_percent", f"scatter_{quantity}_percent"), strict=True)
        )
        for label, rung in shown.items():
            errors = ladder[ladder["rung"] == rung].set_index("temperature_C")[columns[label]]
            rows.append([label, *(_number(errors[t]) for t in at), _number(errors.mean())])
    return {"head": ["", *map(place_name, at), "mean"], "rows": rows}


def _suspect(one: Mapping[str, Any]) -> list[str]:
    where = [one["specimen"], place_name(one["temperature_C"]), f"{one['frequency_Hz']:g} Hz"]
    return [*where, one["status"], typeset("; ".join(one["reasons"])), one["decided_by"]]


def _members(names: list[str]) -> list[str]:
    return [member_name(name) for name in names]


def _cause(rung: Mapping[str, Any]) -> str:
    place = place_name(rung["where"])
    return _words(rung["cause"]) + (f" ({place})" if place else "")


def _estimate(name: str, estimate: Mapping[str, Any], factor: float) -> str:
    return typeset(f"{name.replace('_', ' ')} {sentences.estimate(estimate, factor)}")


def _gain(gain: Mapping[str, Any], inner: bool = False) -> list[str]:
    """Errors as in Table 4, mean over temperatures, and residuals over scatter; empty where these are none.

    inner: of temperatures between others only.
    """
    pairs = [*mean_averages(gain, inner).values(), gain.get("rms_over_scatter", {})]
    return [" → ".join(map(_number, pair.values())) for pair in pairs]


def _baseline(baseline: Mapping[str, Any]) -> list[list[str]]:
    phase = baseline["mre_phase_percent"]
    rows = sorted(baseline["mre_E_percent"].items(), key=lambda row: float(row[0]))
    return [[place_name(float(at)), _number(error), _number(phase[at])] for at, error in rows]


def _unexplained(row: Mapping[str, Any]) -> list[str]:
    numbers = ("frequency_Hz", "residual_E_percent", "residual_phase_deg", "z")
    specimen = f"{specimen_named(row['specimen'])}, set aside" if row["specimen"] else "mean"
    return [place_name(row["temperature_C"]), *(_number(row[name]) for name in numbers), specimen]


def _limits_caption(spread: float) -> str:
    caption = "Found with 95 % probability if at least this large; a smaller effect may be there"
    if spread < WIDE_SPREAD:
        return caption
    return f"{caption}. A factor {spread:.1f} is included, by which these tests lie farther from the fit than assumed"


def _limits(limits: dict[str, Any]) -> list[tuple[str, str]]:
    """Cause, and its limit in words; places that share one stand together."""
    rows = []
    for cause, limit in limits.items():
        places: dict[str, list[str]] = {}
        for place, value in limits_by_place(cause, limit).items():
            size, unit = shown(value, limit["unit"])
            places.setdefault(f"{_number(size)} {unit}".rstrip(), []).append(place)
        words = (size + (f" ({', '.join(names)})" if any(names) else "") for size, names in places.items())
        rows.append((_words(cause), "; ".join(words)))
    return rows


def _words(name: str) -> str:
    return name.replace("_", " ")


def _number(value: float) -> str:
    return "" if pd.isna(value) else three_digits(value).replace("-", "\N{MINUS SIGN}")


def _chance(p: float | None) -> str:
    """Empty for bond_mapping, which no measurement is asked about."""
    if p is None:
        return ""
    return f"below {LEAST_P:g}" if p < LEAST_P else f"{p:.1g}"
