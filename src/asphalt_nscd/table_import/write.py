"""`new-study`: a table understood, spheres and box chosen, and the configuration that says so."""

from __future__ import annotations

import json
import re
import shutil
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, TypeGuard

import numpy as np
import pandas as pd
import yaml
from numpy.typing import NDArray

from asphalt_nscd.bending.settings import MOST_STEPS
from asphalt_nscd.files.csvinput import Table
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.store import atomic_path, write_table
from asphalt_nscd.files.templates import template
from asphalt_nscd.files.words import counted
from asphalt_nscd.measurements.campaign import Campaign, isotherm_notes, nominal_temperatures
from asphalt_nscd.measurements.geometry import read_geometry, read_shape
from asphalt_nscd.measurements.kinds import BENDING, FITTED_STEPS, UNKNOWN
from asphalt_nscd.measurements.limits import LIMITS
from asphalt_nscd.measurements.reduction import FORMS, KEYS, reduced_frame, require_enough
from asphalt_nscd.measurements.shape import Shape
from asphalt_nscd.measurements.tension import AMPT, Cylinder
from asphalt_nscd.measurements.twopoint import Geometry
from asphalt_nscd.study.configuration import RESERVED, complete_study
from asphalt_nscd.study.preflight import require_feasible
from asphalt_nscd.study.schema import read_schema
from asphalt_nscd.table_import.campaign import read_campaign
from asphalt_nscd.table_import.duration import duration, steps_of_a_test
from asphalt_nscd.table_import.grid import grid
from asphalt_nscd.table_import.spheres import PAPER, SMALLEST_MM, Spheres, read_grading, spheres_for

_DEVICE = re.compile("con|prn|aux|nul|(com|lpt)[0-9]", re.IGNORECASE)
STEPS_PER_CYCLE = 500  # of the paper's highest frequency, 40 Hz
COARSEST_STEP = 2e-4  # s, of those in Fig. 6

# The smoke study's specimen, and a cylinder of as many spheres: some hundred.
SMALL = Geometry(b=0.01, B=0.02, e=0.01, h=0.06, mass=0.021, mobile_mass=0.008)
SMALL_CYLINDER = Cylinder(d=0.018, h=0.032, mass=0.0195, mobile_mass=0.0)
SMALL_SPHERES = Spheres(pd.Series({2.0: 600, 3.0: 200, 4.0: 90}), (0.06, 0.01, 0.2))


@dataclass(frozen=True)
class StudyOptions:
    """What the user says beside the table, None where nothing; `measured_in` is one of ALL_KINDS."""

    geometry: Mapping[str, float] | Path | None = None
    grading: Path | None = None
    measured_in: str | None = None
    small: bool = False
    sheet: str | None = None
    columns: Mapping[str, str] | None = None
    mix: str | None = None


def new_study(name: str, measurements: Sequence[Path], options: StudyOptions) -> tuple[Path, list[str]]:
    """Write config/NAME.yaml, and below data/NAME/ the table in our columns and the spheres.

    Returns the configuration and what was understood. Nothing is replaced, and what was written is taken away again
    where the study would be refused.
    """
    config, folder = Path("config", f"{name}.yaml"), Path("data", name)
    _require_free(name, config, folder)
    if options.small and options.grading is not None:
        raise InputError("--small takes spheres of its own; leave out --grading or --small.")
    campaign, form = read_campaign(
        measurements, options.sheet, options.columns, options.measured_in, options.mix
    )
    source = ", ".join(map(str, measurements))
    direct = campaign.test_type == "tension-compression"
    read, notes = study_table(campaign, form)
    geometry = _geometry(form, direct, options)
    frame = reduced_frame(read, geometry)
    temperatures, frequencies, outside = grid(frame, read.path)
    notes += outside
    try:
        require_enough(len(frame), frame["frequency_Hz"].nunique())
    except InputError as error:
        raise InputError(f"{source}: {error}") from None
    shape = read_geometry(geometry, frame["specimen"])[frame["specimen"].iloc[0]]
    simulated, why_simulated = _simulated(shape, direct, options)
    spheres = _spheres(simulated, options)
    seeds = [1] if options.small else [1, 2, 3, 4]
    amplitude, why = _amplitude(
        read.numbers("z0_m") if "z0_m" in read.columns else None, simulated, options.small
    )
    step = float(f"{min(COARSEST_STEP, 1.0 / (STEPS_PER_CYCLE * max(frequencies))):.2g}")
    # In steps for its highest frequency, a test at its lowest may take more of them than a test can have.
    fitted = direct or steps_of_a_test(min(frequencies), step) > MOST_STEPS
    table, counts = folder / "measurements.csv", folder / "counts.csv"
    text = template("table_import/study.yaml.j2").render(
        name=name,
        # A string of JSON is one of YAML: no file name can add a key.
        source=json.dumps(source, ensure_ascii=False),
        config=config,
        table=table.as_posix(),
        counts_table=counts.as_posix(),
        # Notes become comments, which a line break would end.
        notes=[" ".join(note.split()) for note in notes],
        form=form,
        direct=direct,
        measured_in="" if campaign.test_type in (BENDING, UNKNOWN) else campaign.test_type,
        small=options.small,
        seeds=seeds,
        temperatures=temperatures,
        geometry=_flow(geometry if isinstance(geometry, Mapping) else str(geometry)),
        frequencies=frequencies,
        spheres=_words(spheres, options),
        box=list(spheres.box),
        amplitude=f"{amplitude:.3e}",
        amplitude_why=why,
        simulated=_flow(simulated.keys()) if simulated != shape or not isinstance(geometry, Mapping) else "",
        simulated_why=why_simulated,
        test_type=simulated.test,
        fitted_steps=FITTED_STEPS if fitted else None,
        test="two-point bending" if simulated.test == "bending" else simulated.test,
        time_step=f"{step:.2e}",
        steps_per_cycle=round(1.0 / (step * max(frequencies))),
        middle=temperatures[len(temperatures) // 2],
        duration=duration(
            int(spheres.counts.sum()),
            len(seeds),
            len(temperatures),
            frequencies,
            None if fitted else step,
        ),
    )
    try:
        write_table(table, pd.DataFrame(read.columns))
        write_table(counts, spheres.counts.rename_axis("diameter_mm").rename("count").reset_index())
        # What was written is read and checked as the workflow will do, before the configuration stands.
        study = complete_study(yaml.safe_load(text), str(config))
        require_feasible(study, str(config))
        with atomic_path(config) as temporary:
            temporary.write_text(text, encoding="utf-8")
    # Ctrl-C too: half a study would refuse the same NAME the next time.
    except BaseException:
        shutil.rmtree(folder, ignore_errors=True)
        raise
    return config, notes


def _require_free(name: str, config: Path, folder: Path) -> None:
    """Refuse a NAME that is not one, is taken, or is no name of a file on Windows."""
    pattern = read_schema()["properties"]["study"]["pattern"]
    # NAME is written bare, and bare `on` or `null` is no text in YAML.
    if not re.fullmatch(pattern.strip("^$"), name) or name in RESERVED or yaml.safe_load(name) != name:
        raise InputError(
            f"NAME {name!r}: give letters, digits, - and _, the first a letter, and none of "
            f"{', '.join(RESERVED)}, and no word with a meaning of its own in YAML, such as true or null."
        )
    if _DEVICE.fullmatch(name):
        raise InputError(
            f"NAME {name!r} is a device on Windows, where nobody could open the study; choose another NAME."
        )
    for path in (config, folder):
        if path.exists():
            raise InputError(f"{path} exists already; choose another NAME, or remove it.")


def study_table(campaign: Campaign, form: str) -> tuple[Table, list[str]]:
    """The columns of a campaign that a study takes, with the temperature of the isotherm, and notes on changes.

    A study fits one Burgers law for each isotherm, so that all tests of one must have the same temperature. A replicate
    of a specimen becomes a specimen of its own. `form` is "moduli" or "peaks"; "records" must be reduced first.
    """
    table, notes = campaign.table, list(campaign.notes)
    if form == "records":
        raise InputError(
            f"{table.path}: holds records; first reduce them to moduli with `asphalt-nscd reduce`."
        )
    if form not in FORMS:
        raise InputError(
            f"{table.path}: has no phases, which a study needs to fit its laws; add a column phase_deg, or let "
            "`asphalt-nscd diagnose` take |E*| alone."
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
    if (nominal != measured).any():
        columns["temperature_C"] = nominal
        notes += isotherm_notes(measured, nominal)
        notes.append("each test has the temperature of its isotherm, because a study has one law for each")
    return replace(table, columns=columns), notes


def _geometry(form: str, direct: bool, options: StudyOptions) -> Mapping[str, float] | Path:
    """Geometry of the measured specimens: as given, else the paper's, which counts for moduli alone."""
    if form == "peaks" and direct:
        raise InputError(
            "forces and displacements of a direct test are not reduced here; give moduli, E (MPa) and phi (deg)."
        )
    if _is_cylinder(options.geometry):
        if not direct:
            raise InputError(
                "--geometry of a cylinder is for tests in tension-compression; say --measured-in tension-compression, "
                "or give b_mm, B_mm, e_mm and h_mm."
            )
        return PAPER.keys()
    if options.geometry is not None:
        return options.geometry
    if form == "peaks":
        given = ",".join(f"{key}={value:g}" for key, value in PAPER.keys().items())
        raise InputError(
            f"forces and displacements need the geometry of the specimens; give it, the paper's as --geometry {given}."
        )
    return PAPER.keys()


def _is_cylinder(geometry: Mapping[str, float] | Path | None) -> TypeGuard[Mapping[str, float]]:
    return isinstance(geometry, Mapping) and "d_mm" in geometry


def _simulated(measured: Shape, direct: bool, options: StudyOptions) -> tuple[Shape, str]:
    """The specimen to simulate, and why: the one measured, the cylinder of direct tests, or a small one of its kind."""
    if options.small:
        return SMALL_CYLINDER if direct else SMALL, "Smaller than measured"
    if _is_cylinder(options.geometry):
        return read_shape(options.geometry), "As given"
    if direct and options.geometry is None:
        return AMPT, "The cylinder of AASHTO T 378 and EN 12697-26 annex D"
    return measured, "That of the first specimen in the table"


def _spheres(shape: Shape, options: StudyOptions) -> Spheres:
    if options.small:
        return replace(SMALL_SPHERES, box=(shape.h, shape.thickness, SMALL_SPHERES.box[2]))
    return spheres_for(shape, None if options.grading is None else read_grading(options.grading))


def _words(spheres: Spheres, options: StudyOptions) -> str:
    """How many spheres a study has, and where their sizes come from."""
    coarser = "" if spheres.smallest_mm == SMALLEST_MM else " at twice its sizes"
    origin = f"Table 2 of the paper{coarser}, scaled to the volume of the specimen"
    if options.small:
        origin = "a few, of sizes that fit into the small specimen"
    elif options.grading is not None:
        origin = (
            f"from the sieve table {json.dumps(str(options.grading))}, down to {spheres.smallest_mm:g} mm"
        )
        origin += "" if coarser else " as in the paper"
    return f"{counted(spheres.counts.sum(), 'sphere')}: {origin}."


def _amplitude(measured: NDArray[np.float64] | None, simulated: Shape, small: bool) -> tuple[float, str]:
    """Amplitude of the simulated head [m], and why: the median of those measured, or that of a usual strain."""
    if measured is not None and not small:
        return float(np.median(measured)), "median of those measured"
    why = (
        "the strain of the paper's 63e-6 m"
        if simulated.test == "bending"
        else "a strain of 50e-6, as in T 378"
    )
    return simulated.usual_amplitude(), why


def _flow(value: Any) -> str:
    return (
        # So wide that it never breaks the line, of whose indentation the template knows nothing.
        yaml.safe_dump(value, default_flow_style=True, sort_keys=False, width=10**6)
        .removesuffix("...\n")
        .strip()
    )
