"""`new-study`: a table understood, spheres and box chosen, and the configuration that says so."""

from __future__ import annotations

import json
import re
import shutil
from collections.abc import Mapping, Sequence
from dataclasses import astuple, dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import yaml

from asphalt_nscd.files.csvinput import Table
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.store import atomic_path, write_table
from asphalt_nscd.files.words import counted
from asphalt_nscd.measurements.campaign import Campaign, isotherm_notes, nominal_temperatures
from asphalt_nscd.measurements.geometry import read_geometry
from asphalt_nscd.measurements.limits import LIMITS
from asphalt_nscd.measurements.reduction import FORMS, KEYS, reduced_frame, require_enough
from asphalt_nscd.measurements.twopoint import Geometry
from asphalt_nscd.study.configuration import RESERVED, complete_study
from asphalt_nscd.study.preflight import require_feasible
from asphalt_nscd.table_import.campaign import read_campaign
from asphalt_nscd.table_import.duration import duration
from asphalt_nscd.table_import.grid import grid
from asphalt_nscd.table_import.spheres import PAPER, Spheres, read_grading, spheres_for

SCHEMA = Path(__file__).resolve().parents[3] / "workflow/schemas/study.schema.yaml"
TAKEN = (*RESERVED, "blind")

AMPLITUDE = 63e-6  # m, of the paper's head
STEPS_PER_CYCLE = 500  # of the paper's highest frequency, 40 Hz
COARSEST_STEP = 2e-4  # s, of those in Fig. 6

# The smoke study's specimen: some hundred spheres.
SMALL = Geometry(b=0.01, B=0.02, e=0.01, h=0.06, mass=0.021, mobile_mass=0.008)
SMALL_SPHERES = Spheres(pd.Series({2.0: 600, 3.0: 200, 4.0: 90}), (0.06, 0.01, 0.2))


@dataclass(frozen=True)
class Wishes:
    """What the user says beside the table; None where nothing."""

    geometry: Mapping[str, float] | Path | None = None
    grading: Path | None = None
    measured_in: str | None = None  # test that gave the moduli, one of TEST_TYPES
    small: bool = False
    sheet: str | None = None
    columns: Mapping[str, str] | None = None


def new_study(name: str, measurements: Sequence[Path], wishes: Wishes) -> tuple[Path, list[str]]:
    """Write config/NAME.yaml, and below data/NAME/ the table in our columns and the spheres.

    Returns the path of the configuration, and what was understood. Nothing is replaced, and what was
    written is taken away again where the study would be refused.
    """
    config, folder = Path("config", f"{name}.yaml"), Path("data", name)
    _require_free(name, config, folder)
    if wishes.small and wishes.grading is not None:
        raise InputError("--small takes spheres of its own; leave out --grading or --small.")
    campaign, form = read_campaign(measurements, wishes.sheet, wishes.columns, wishes.measured_in)
    source = ", ".join(map(str, measurements))
    direct = campaign.test_type == "tension-compression"
    read, notes = for_study(campaign, form)
    geometry = _geometry(form, direct, wishes)
    frame = reduced_frame(read, geometry)
    temperatures, frequencies, outside = grid(frame, read.path)
    notes += outside
    try:
        require_enough(len(frame), frame["frequency_Hz"].nunique())
    except InputError as error:
        raise InputError(f"{source}: {error}") from None
    shape = read_geometry(geometry, frame["specimen"])[frame["specimen"].iloc[0]]
    simulated = SMALL if wishes.small else shape
    spheres = SMALL_SPHERES if wishes.small else _spheres(simulated, wishes)
    seeds = [1] if wishes.small else [1, 2, 3, 4]
    amplitude, why = _amplitude(read.columns.get("z0_m"), simulated, wishes.small)
    step = float(f"{min(COARSEST_STEP, 1.0 / (STEPS_PER_CYCLE * max(frequencies))):.2g}")
    table, counts = folder / "measurements.csv", folder / "counts.csv"
    text = _render(
        name=name,
        source=json.dumps(source, ensure_ascii=False),
        config=config,
        table=table.as_posix(),
        counts_table=counts.as_posix(),
        notes=[" ".join(note.split()) for note in notes],
        form=form,
        direct=direct,
        small=wishes.small,
        seeds=seeds,
        temperatures=temperatures,
        geometry=_flow(geometry if isinstance(geometry, Mapping) else str(geometry)),
        frequencies=frequencies,
        spheres=_words(spheres, wishes),
        box=list(spheres.box),
        amplitude=f"{amplitude:.3e}",
        amplitude_why=why,
        simulated=_flow(_as_mapping(simulated)) if wishes.small or not isinstance(geometry, Mapping) else "",
        simulated_why="Smaller than measured" if wishes.small else "That of the first specimen in the table",
        time_step=f"{step:.2e}",
        steps_per_cycle=round(1.0 / (step * max(frequencies))),
        middle=temperatures[len(temperatures) // 2],
        duration=duration(int(spheres.counts.sum()), len(seeds), len(temperatures), frequencies, step),
    )
    try:
        write_table(table, pd.DataFrame(read.columns))
        write_table(counts, spheres.counts.rename_axis("diameter_mm").rename("count").reset_index())
        study = complete_study(yaml.safe_load(text), str(config), SCHEMA)
        require_feasible(study, str(config))
        with atomic_path(config) as temporary:
            temporary.write_text(text, encoding="utf-8")
    except BaseException:
        shutil.rmtree(folder, ignore_errors=True)
        raise
    return config, notes


def _require_free(name: str, config: Path, folder: Path) -> None:
    if not SCHEMA.is_file():
        raise InputError(
            "new-study: a study runs in a clone of the repository, not from an installed package; clone it, and run "
            "the command there."
        )
    pattern = yaml.safe_load(SCHEMA.read_text(encoding="utf-8"))["properties"]["study"]["pattern"]
    if not re.fullmatch(pattern.strip("^$"), name) or name in TAKEN or yaml.safe_load(name) != name:
        raise InputError(
            f"NAME {name!r}: give letters, digits, - and _, the first a letter, and none of "
            f"{', '.join(TAKEN)}, and no word with a meaning of its own in YAML, such as true or null."
        )
    for path in (config, folder):
        if path.exists():
            raise InputError(f"{path} exists already; choose another NAME, or remove it.")


def for_study(campaign: Campaign, form: str) -> tuple[Table, list[str]]:
    """The columns of a campaign that a study takes, with the temperature of the isotherm, and notes on them.

    A study fits one Burgers law for each isotherm, so that all tests of one must have the same temperature.
    """
    table, notes = campaign.table, list(campaign.notes)
    if form == "records":
        raise InputError(
            f"{table.path}: holds records; first reduce them to moduli with `asphalt-nscd reduce`."
        )
    columns = {name: table.columns[name] for name in ("specimen", *KEYS, *FORMS[form])}
    if "origin" in table.columns:
        columns["origin"] = table.columns["origin"]
    if "replicate" in table.columns:
        pairs = zip(table.columns["specimen"], table.columns["replicate"], strict=True)
        columns["specimen"] = [f"{one}-{two}" for one, two in pairs]
        notes.append("each replicate of a specimen is taken as a specimen")
    measured = table.numbers("temperature_C", LIMITS["temperature_C"])
    nominal = nominal_temperatures(table, measured)
    if (changed := nominal != measured).any():
        columns["temperature_C"] = [
            f"{value:.10g}" if other else text
            for value, other, text in zip(nominal, changed, columns["temperature_C"], strict=True)
        ]
        notes += isotherm_notes(measured, nominal)
        notes.append("each test has the temperature of its isotherm, because a study has one law for each")
    return replace(table, columns=columns), notes


def _geometry(form: str, direct: bool, wishes: Wishes) -> Mapping[str, float] | Path:
    if form == "peaks" and direct:
        raise InputError(
            "forces and displacements of a direct test are not reduced here; give moduli, E (MPa) and phi (deg)."
        )
    if wishes.geometry is not None:
        return wishes.geometry
    if form == "peaks":
        given = ",".join(f"{key}={value:g}" for key, value in _as_mapping(PAPER).items())
        raise InputError(
            f"forces and displacements need the geometry of the specimens; give it, the paper's as --geometry {given}."
        )
    return _as_mapping(PAPER)


def _as_mapping(geometry: Geometry) -> dict[str, float]:
    b, foot, e, h, mass, mobile = astuple(geometry)
    lengths = {"b_mm": b, "B_mm": foot, "e_mm": e, "h_mm": h}
    return {key: float(f"{1e3 * value:.10g}") for key, value in lengths.items()} | {
        "mass_kg": mass,
        "mobile_mass_kg": mobile,
    }


def _spheres(geometry: Geometry, wishes: Wishes) -> Spheres:
    return spheres_for(geometry, None if wishes.grading is None else read_grading(wishes.grading))


def _words(spheres: Spheres, wishes: Wishes) -> str:
    origin = "Table 2 of the paper, scaled to the volume of the specimen"
    if wishes.small:
        origin = "a few, of sizes that fit into the small specimen"
    elif wishes.grading is not None:
        origin = f"from the sieve table {json.dumps(str(wishes.grading))}, down to 2 mm as in the paper"
    return f"{counted(spheres.counts.sum(), 'sphere')}: {origin}."


def _amplitude(measured: list[str] | None, simulated: Geometry, small: bool) -> tuple[float, str]:
    """Of the simulated head [m]: as measured, or giving the strain of the paper's."""
    if measured is not None and not small:
        return float(np.median(np.array(measured, float))), "median of those measured"
    # Strain of a cantilever's flank goes with width times deflection over height squared.
    return AMPLITUDE * (
        simulated.h / PAPER.h
    ) ** 2 * PAPER.B / simulated.B, "the strain of the paper's 63e-6 m"


def _flow(value: Any) -> str:
    return (
        yaml.safe_dump(value, default_flow_style=True, sort_keys=False, width=10**6)
        .removesuffix("...\n")
        .strip()
    )


def _render(**values: Any) -> str:
    from jinja2 import Environment, PackageLoader, StrictUndefined

    environment = Environment(
        loader=PackageLoader("asphalt_nscd", "table_import"),
        undefined=StrictUndefined,
        keep_trailing_newline=True,
        autoescape=False,  # YAML, no HTML
    )
    return environment.get_template("study.yaml.j2").render(**values)
