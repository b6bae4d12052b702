"""The statements of the paper, sections 2 to 5, beside what we find; their words stand in statements.yaml."""

from collections.abc import Iterable, Mapping
from itertools import chain
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import yaml

from asphalt_nscd.cli import run_script
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.store import load, read_json, write_table
from asphalt_nscd.measurements.agreement import mean_relative_error
from asphalt_nscd.measurements.tables import isotherm_rows, read_measured
from asphalt_nscd.reporting.tables.table4 import read_errors
from asphalt_nscd.reporting.tables.time_steps import EXPLICIT
from asphalt_nscd.rheology.laws_io import read_law
from asphalt_nscd.rheology.published_laws import read_published
from asphalt_nscd.specimen.counts import read_counts
from studies.paper import equations, outcomes
from studies.paper.finding import DIFFERS, HOLDS, NOT_JUDGED, REPRODUCED, Finding

COLUMNS = "id where statement published ours unit verdict needs evidence otherwise".split()
TABLES = "simulations sensitivity readings bond_readings packing table4 time_steps".split()


def findings(paths: Mapping[str, Any]) -> Iterable[Finding]:
    """All findings. paths: files of each kind, as the rule `audit` names them."""
    table = {name: pd.read_csv(paths[name]) for name in TABLES}
    tests, readings = table["simulations"], table["bond_readings"]
    # In kPa: in the Pa that Table 3 prints, asphalt at -10 degC would be a rubber of 40 MPa.
    published = dict(zip(*read_published(paths["laws"], "kPa"), strict=True))
    pascal, blocked = _relative(table["readings"], tests)
    diameter, count = read_counts(paths["counts"])
    deposits = [load(path, "deposit") for path in paths["deposits"]]
    facets = pd.read_csv(paths["facets"][0]) if paths["facets"] else None
    design = pd.read_csv(paths["design"], comment="#")
    explicit = outcomes.longest_step(table["time_steps"], EXPLICIT)
    changed = table["sensitivity"]
    return chain(
        equations.laboratory(),
        equations.contact_law(published[15.0]),
        equations.calibration(published, pascal, explicit, design),
        equations.table_4(published, read_errors(paths["errors"])),
        equations.typical_numbers(diameter, count, outcomes.DENSITY),
        outcomes.bonds(readings),
        [
            outcomes.lattice(count),
            outcomes.grading(pd.read_csv(paths["grading"]), diameter, count),
            outcomes.contacts(tests),
            outcomes.reduction(tests),
            outcomes.waveform(load(paths["waveform"], "test")),
        ],
        outcomes.samples(
            [deposit.attributes for deposit in deposits],
            [load(path, "specimen").attributes for path in paths["specimens"]],
            np.array([outcomes.moved_on_top(deposit.arrays) for deposit in deposits]),
        ),
        outcomes.numerics(tests, table["time_steps"], pd.read_csv(paths["costs"])),
        outcomes.profile(load(paths["profile"], "test").arrays),
        outcomes.laws_and_samples(tests, table["packing"], readings, facets, list(blocked.values())),
        outcomes.agreement(table["table4"], _refit_errors(paths["fitted"], paths["measured"])),
        outcomes.sensitivity(changed, isotherm_rows(tests, float(changed["temperature_C"].iloc[0]))),
    )


def _relative(other: pd.DataFrame, tests: pd.DataFrame) -> tuple[dict[float, float], dict[float, float]]:
    """|E*| over its law by frequency [Hz], over that of the same sample in the study: in Pa, and with its head blocked.

    other: readings.csv; tests: simulations.csv.
    """
    whole = tests[(tests["specimen"] == str(other["specimen"].iloc[0])) & (tests["broken_bonds"] == 0)]
    level = float((whole["E_MPa"] / whole["E_law_MPa"]).mean())
    ratio = other["E_MPa"] / other["E_law_MPa"] / level
    pascal, blocked = (
        dict(zip(other.loc[rows, "frequency_Hz"], ratio[rows], strict=True))
        for rows in (other["law_source"] == "pascal", other["head"] == "blocked")
    )
    return pascal, blocked


def _refit_errors(fitted: Iterable[str], measured: Iterable[str]) -> pd.DataFrame:
    """Mean relative errors of the refitted Burgers laws against the data that they were fitted to."""
    data = read_measured(list(map(Path, measured)))
    frames = []
    for path in fitted:
        points = isotherm_rows(data, read_json(path)["temperature_C"])[["temperature_C", "frequency_Hz"]]
        points = points.drop_duplicates()
        modulus = read_law(path).complex_modulus(2.0 * np.pi * points["frequency_Hz"].to_numpy())
        frames.append(points.assign(E_MPa=np.abs(modulus) / 1e6, phase_deg=np.degrees(np.angle(modulus))))
    return mean_relative_error(data, pd.concat(frames, ignore_index=True))


def told(statements: str | Path, found: Iterable[Finding]) -> pd.DataFrame:
    """All statements in the order of the paper, each with its judgement or the reason why there is none.

    Raises InputError for a finding without a statement that waits for one, or the other way round.
    """
    listed = yaml.safe_load(Path(statements).read_text(encoding="utf-8"))
    by_id = {finding.id: finding for finding in found}
    waiting = {row["id"] for row in listed if not {"not_judged", "ours"} & row.keys()}
    for id in sorted(waiting ^ by_id.keys()):
        raise InputError(
            f"{statements}: of {id} there is a statement or a finding alone; mend the list or the audit."
        )
    rows = [judged(row, by_id.get(row["id"])) for row in listed]
    return pd.DataFrame(rows, columns=COLUMNS).map(_rounded)


def judged(row: Mapping[str, Any], finding: Finding | None) -> dict[str, Any]:
    """One statement with its verdict, and its texts filled with what was found."""
    if "not_judged" in row:
        empty = dict.fromkeys(COLUMNS, "") | {"verdict": NOT_JUDGED, "evidence": row["not_judged"]}
        return empty | {name: row[name] for name in ("id", "where", "statement", "needs")}
    finding = finding or Finding(row["id"], row["ours"])
    values = {"published": row.get("published"), **row, **finding.values}
    agrees = finding.verdict if finding.verdict is not None else row.get("verdict")
    if agrees is None:
        agrees = _within(float(finding.ours), values)
    if isinstance(agrees, bool | np.bool_):
        agrees = (HOLDS if row["needs"] == "text" else REPRODUCED) if agrees else DIFFERS
    text = {name: _filled(row.get(name, ""), agrees, values) for name in ("unit", "evidence", "otherwise")}
    if "tolerance" in row:
        side = "within" if agrees == DIFFERS else "beyond"
        text["otherwise"] = f"A number {side} {100.0 * row['tolerance']:g} % of the paper's."
    return {**row, **text, "published": values["published"], "ours": finding.ours, "verdict": agrees}


def _within(ours: float, values: Mapping[str, Any]) -> bool:
    """Whether a number keeps the bounds of its statement: `tolerance`, relative to the paper's, `above` and `below`."""
    if "tolerance" in values:
        return abs(ours - values["published"]) <= values["tolerance"] * abs(values["published"])
    return values.get("above", -np.inf) < ours < values.get("below", np.inf)


def _filled(text: Any, verdict: str, values: Mapping[str, Any]) -> str:
    """A text of statements.yaml: of sentences, those whose values are known; of a choice, that of the verdict."""
    if isinstance(text, dict):
        return _filled(text.get(verdict, text["else"]), verdict, values)
    if isinstance(text, list):
        return " ".join(filter(None, (_filled(sentence, verdict, values) for sentence in text)))
    known = {name: value for name, value in values.items() if value is not None}
    try:
        return str(text).format(**known)
    except KeyError as missing:
        if values.get(missing.args[0], "") is None:
            return ""
        raise


def _rounded(value: object) -> object:
    # Six digits, which another processor gives too.
    return float(f"{value:.6g}") if isinstance(value, float) else value


def run(job: Any) -> None:
    """From the files of the rule to its table."""
    write_table(job.output[0], told(job.input.statements, findings(dict(job.input.items()))))


if __name__ == "__main__":
    run_script(globals()["snakemake"], run)
