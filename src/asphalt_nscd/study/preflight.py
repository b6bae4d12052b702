"""A study against the files it names: what cannot work is refused before anything is poured.

Every check is that of the step which would fail; only the key of the study is added.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from asphalt_nscd.bending.case import LoadCase, RunOptions, require_possible
from asphalt_nscd.bending.settings import Numerics
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.measurements.geometry import read_geometry, read_shape, require_joined, require_within
from asphalt_nscd.measurements.reduction import require_enough, tests_measured
from asphalt_nscd.measurements.signals import require_steps
from asphalt_nscd.reporting.tables import table2, table4
from asphalt_nscd.rheology.published_laws import read_published
from asphalt_nscd.specimen.counts import read_counts

KEYS = {"temperatures_C": "temperature_C", "frequencies_Hz": "frequency_Hz"}


def require_feasible(study: Mapping[str, Any], source: str) -> None:
    """Refuse a complete study (`complete_study`) of which a step would fail later, and name the key."""
    if isinstance(study["geometry"], Mapping):
        with _prefix_errors(source):
            read_geometry(study["geometry"], [])
    _check_specimens(study["specimens"], source)
    _check_time_steps(study, source)
    if "published" in study["laws"]:
        _check_laws(study, source)
    if "table" in study["measurements"]:
        _check_measurements(study, source)
    else:
        _check_reconstruction(study, source)
    if "published" in study:
        paths = {key: [Path(path)] for key, path in study["published"].items()}
        poured = [Path(study["specimens"]["counts_table"])]
        # For its refusals alone: the report would meet them after all pouring and testing.
        table2.make(paths["grading_table"], paths["counts_table"], poured)
        table4.read_errors(study["published"]["errors_table"])


@contextmanager
def _prefix_errors(where: str) -> Iterator[None]:
    try:
        yield
    except InputError as error:
        raise InputError(f"{where}: {error}") from None


def _check_specimens(specimens: Mapping[str, Any], source: str) -> None:
    """Require a geometry that fits into the box or the packings, and counts that can be read."""
    with _prefix_errors(f"{source}: specimens"):
        geometry = read_shape(specimens["geometry"])
        require_joined(geometry, specimens["bonds"]["area"])
    for path in specimens.get("packings", []):
        # Only here, for it loads the compiled core, which no other study needs before its first job.
        from asphalt_nscd.packings.incoming import deposit_content, read_packing

        with _prefix_errors(f"{source}: specimens.packings"):
            given, _ = deposit_content(
                read_packing(path), specimens.get("packing_unit"), specimens.get("packing_up", "z")
            )
        with _prefix_errors(f"{source}: specimens.packings: {path}"):
            require_within(geometry, given[0]["box"].tolist())
    if "packings" in specimens:
        return
    with _prefix_errors(f"{source}: specimens"):
        require_within(geometry, specimens["box_m"])
    with _prefix_errors(f"{source}: specimens.counts_table"):
        read_counts(specimens["counts_table"])


def _check_time_steps(study: Mapping[str, Any], source: str) -> None:
    """Require enough time steps in a cycle of the highest frequency, and not too many in a test at the lowest."""
    test, slowest = study["test"], min(study["frequencies_Hz"])
    with _prefix_errors(f"{source}: test.time_step_s"):
        require_steps(test["time_step_s"], max(study["frequencies_Hz"]))
    step = 1.0 / (slowest * test["steps_per_cycle"]) if "steps_per_cycle" in test else test["time_step_s"]
    with _prefix_errors(f"{source}: test at {slowest:g} Hz"):
        _require_few_steps(slowest, test["cycles"], step, test["rest_steps"])
    stepping = study.get("time_step_study")
    if stepping:
        with _prefix_errors(f"{source}: time_step_study.time_steps_s"):
            require_steps(max(stepping["time_steps_s"]), stepping["frequency_Hz"])
            # as `simulate_step` of cases.smk has it
            _require_few_steps(stepping["frequency_Hz"], 1, min(stepping["time_steps_s"]), test["rest_steps"])


def _require_few_steps(frequency: float, cycles: int, time_step: float, rest_steps: int) -> None:
    """Refuse more steps than a test takes, which else would be known when all samples are poured."""
    require_possible(
        LoadCase(frequency, cycles=cycles), Numerics(time_step, rest_steps=rest_steps), RunOptions()
    )


def _check_laws(study: Mapping[str, Any], source: str) -> None:
    """Require a law in the table for every temperature, where these are simulated or measurements drawn from them."""
    path = study["laws"]["published"]["table"]
    with _prefix_errors(f"{source}: laws.published.table"):
        available = read_published(path, study["laws"]["published"]["unit"])[0]
    if study["laws"]["simulate"] == "published" or "reconstruct" in study["measurements"]:
        _require_all(study["temperatures_C"], available, f"{source}: temperatures_C", path)
    elif "audit" in study:
        _require_all([study["audit"]["temperature_C"]], available, f"{source}: audit.temperature_C", path)


def _check_measurements(study: Mapping[str, Any], source: str) -> None:
    """Require a measurement for every test, and a geometry for every specimen where it is needed."""
    path = study["measurements"]["table"]
    with _prefix_errors(f"{source}: measurements.table"):
        tests, form = tests_measured(path)
    for key, column in KEYS.items():
        _require_all(study[key], tests[column], f"{source}: {key}", path)
    for temperature in study["temperatures_C"]:
        there = tests.loc[_agrees(tests["temperature_C"], temperature), "frequency_Hz"]
        for frequency in study["frequencies_Hz"]:
            if not _agrees(there, frequency).any():
                raise InputError(
                    f"{source}: {path} has no test at {temperature:g} degC, {frequency:g} Hz; add it, or "
                    "leave one of them out of temperatures_C or frequencies_Hz."
                )
    with _prefix_errors(f"{source}: {path}"):
        require_enough(len(tests), tests["frequency_Hz"].nunique())
    if form != "moduli":
        read_geometry(study["geometry"], tests["specimen"])


def _check_reconstruction(study: Mapping[str, Any], source: str) -> None:
    """Require as many tests as a diagnosis needs, and a geometry for every specimen."""
    # As `reconstruct` names its specimens.
    names = [str(number + 1) for number in range(study["measurements"]["reconstruct"]["specimens"])]
    frequencies = len(study["frequencies_Hz"])
    with _prefix_errors(f"{source}: frequencies_Hz"):
        require_enough(len(names) * len(study["temperatures_C"]) * frequencies, frequencies)
    if isinstance(study["geometry"], str):
        read_geometry(study["geometry"], names)


def _require_all(values: Sequence[float], available: Any, where: str, path: str) -> None:
    for value in values:
        if not _agrees(available, value).any():
            listed = ", ".join(f"{there:.10g}" for there in np.unique(available))
            raise InputError(f"{where}: {value:.10g} is not in {path}, which has {listed}; use these.")


def _agrees(values: Any, value: float) -> np.ndarray:
    """Which agree in the digits that tables keep."""
    return np.isclose(np.asarray(values, float), value, rtol=1e-9, atol=0.0)
