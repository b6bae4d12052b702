"""From a case of the plan to what the diagnosis made of it: draw, seal, diagnose, open.

The diagnosis gets a file, the geometry and, where the plan says so, the static modulus; nothing else.
"""

from __future__ import annotations

import tempfile
from collections.abc import Collection, Iterator, Mapping
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from asphalt_nscd.diagnosis.causes import CATALOGUE as NAMEABLE
from asphalt_nscd.diagnosis.observed import reading
from asphalt_nscd.diagnosis.record import report
from asphalt_nscd.diagnosis.search.diagnose import diagnose
from asphalt_nscd.diagnosis.simulation.simulated import read_specimen
from asphalt_nscd.files.errors import InputError

from . import generator, score
from .causes import CATALOGUE
from .generator import Hidden
from .plan import AT_LIMIT, Case, design_of

KEPT = (
    "verdict", "ladder", "withdrawn", "indistinguishable", "detection_limits", "lack_of_fit_p_value",
    "largest_pattern_left", "scatter", "notes", "estimates", "suspect_tests",
)  # fmt: skip
# Some records of a wrong frequency are refused before any diagnosis, and an isotherm 8 K off that is stiffer than a
# colder one.
REFUSED = {"verdict": score.REFUSED, "ladder": [], "detection_limits": {}, "indistinguishable": []}
# What is physical: an isotherm is not further off, and no more mass is missing than there is.
LARGEST = {"temperature_bias": 8.0, "specimen_geometry": 0.7}
LARGEST_NEGATIVE = {"moving_mass": 0.3, "specimen_geometry": 0.7}

Limits = Mapping[str, Mapping[str, Any]]


def run(cases: list[Case]) -> Iterator[dict[str, Any]]:
    """One line for each case: the case, its seal and the diagnosis. Limits are those of the seed's empty case.

    A case whose cause has no limit, for it cannot be seen in this design and mix, comes without a seal, and so
    does an effect beyond the catalogue that cannot be made as visible as planned. A table that an effect makes absurd
    may be refused before any diagnosis: the effect then has no name.
    """
    limits: Limits = {}
    seed = None
    for case in cases:
        if case.seed != seed:
            limits, seed = {}, case.seed
        if case.needs_limits and not set(case.hidden) <= set(limits):
            yield {"case": asdict(case)}
            continue
        try:
            drawn, static = seal(case, limits)
        except ArithmeticError:  # however large, the effect is not as visible as planned
            yield {"case": asdict(case)}
            continue
        try:
            found = open_case(
                drawn.table, drawn.geometry, drawn.records, removed=(case.removed,), static_modulus=static
            )
        except InputError as error:
            if not case.hidden:
                raise
            found = REFUSED | {"notes": [str(error)]}
        except Exception as error:
            raise RuntimeError(f"the diagnosis failed on {case}") from error
        if case.suite == "limits":
            limits = found["detection_limits"]
        yield {"case": asdict(case), "seal": drawn.seal, "diagnosis": found}


def seal(case: Case, limits: Limits) -> tuple[generator.Case, float | None]:
    """The drawn case, and the static modulus [Pa] if the diagnosis may know it."""
    design = design_of(case)
    hidden = []
    for number, cause in enumerate(case.hidden):
        random = np.random.default_rng([case.seed, number])
        if case.needs_limits:
            hidden.append(at_limit(cause, case.ratio, limits, design, generator.GEOMETRY, random))
        else:
            hidden.append(Hidden(cause, visible_strength=case.ratio * AT_LIMIT))
    drawn = generator.draw(case.seed, hidden, design=design, law=case.shape, form=case.form)
    for effect in drawn.seal["effects"]:
        effect["ratio"] = case.ratio
    return drawn, drawn.seal["law"]["parameters"]["static"] if case.static_known else None


def at_limit(
    cause: str,
    ratio: float,
    limits: Limits,
    design: pd.DataFrame,
    geometry: Mapping[str, float],
    random: np.random.Generator,
) -> Hidden:
    """A cause at `ratio` times its detection limit at a place drawn from those where it can be seen."""
    limit = limits[cause]
    unit = limit["unit"]
    effect = CATALOGUE[cause]
    equivalents = {effect.unit: 1.0, **effect.others(1.0, design, dict(geometry))}
    where, value = None, limit["value"]
    if effect.confined is not None:
        most = LARGEST.get(cause, np.inf)
        # The same place for all ratios of a seed.
        places = [place for place, size in limit["places"].items() if 5.0 * size <= most]
        name = str(random.choice(places or [min(limit["places"], key=limit["places"].get)]))
        value = limit["places"][name]
        where = name if effect.confined == "specimen" else float(name)
    amplitude = ratio * value / equivalents[unit]
    one_sign = amplitude > LARGEST_NEGATIVE.get(cause, np.inf)
    return Hidden(cause, amplitude=amplitude, where=where, sign=1 if one_sign else None)


def open_case(
    table: pd.DataFrame,
    geometry: Mapping[str, float],
    records: Mapping[str, pd.DataFrame] | None = None,
    removed: Collection[str] = (),
    static_modulus: float | None = None,
    test_type: str = "bending",
    use_suspects: bool = False,
) -> dict[str, Any]:
    """The diagnosis of a table, by the functions behind `asphalt-nscd diagnose`, shortened to what is judged.

    removed: causes that it does not know.
    """
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "measured.csv")
        table.to_csv(path, index=False)
        for name, record in (records or {}).items():
            record.to_csv(path.with_name(name), index=False)
        observed, _ = reading.read_observations(path, dict(geometry), static_modulus)
    observed = replace(observed, test_type=test_type)
    catalogue = tuple(cause for cause in NAMEABLE if cause.name not in removed)
    content = report.as_json(
        diagnose(observed, catalogue=catalogue, use_suspects=use_suspects), read_specimen()
    )
    return {name: content[name] for name in KEPT if name in content}
