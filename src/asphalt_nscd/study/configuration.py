"""The configuration of a study: validated against its schema, completed by the schema's defaults."""

from __future__ import annotations

import copy
import math
import re
from collections.abc import Iterator, Mapping
from functools import reduce
from operator import getitem
from pathlib import Path
from typing import Any

import yaml
from jsonschema import Draft202012Validator
from jsonschema.exceptions import ValidationError

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.paths import is_file, require_readable
from asphalt_nscd.files.schema_words import dotted, first_wrong, sentence_on
from asphalt_nscd.measurements.kinds import BENDING, PAPER_AMPLITUDE, usual_steps_per_cycle
from asphalt_nscd.study.schema import read_schema

# YAML 1.1 reads 5e-5 as text, and --config what stands in a list; where the schema wants a number it is one.
_NUMBER = re.compile(r"[-+]?\d+(\.\d*)?([eE][-+]?\d+)?")
# Folders of results/ that belong to no study.
RESERVED = tuple(
    "attack benchmark calls cluster excess fall fatigue faults forecast fuzz intervals layouts mapping measured "
    "mutants published ramp rigs verification".split()
)
POURED = ("seeds", "counts_table", "box_m")  # what pouring needs
_OPTIONAL = ("sensitivity", "time_step_study", "packing_study", "audit")


def complete_study(config: Mapping[str, Any], source: str) -> dict[str, Any]:
    """A new mapping of a study that is checked against its schema, with every default filled in."""
    rules = read_schema()
    study = copy.deepcopy(dict(config))
    # `test: tension-compression` is short for its type.
    if isinstance(study.get("test"), str):
        study["test"] = {"type": study["test"]}
    if not study:
        raise InputError(f"{source}: the study is empty; give one with --configfile config/paper.yaml.")
    for error in Draft202012Validator(rules).iter_errors(study):
        _convert(study, error)
    study = _rounded(_whole(study, rules))
    errors = [
        part
        for error in Draft202012Validator(rules).iter_errors(study)
        for part in (_nearest_alternative(error) if isinstance(error.instance, dict) else ()) or (error,)
    ]
    if errors:
        raise InputError(f"{source}: {sentence_on(first_wrong(errors), 'the study')}")
    if study["study"] in RESERVED:
        raise InputError(
            f"{source}: study {study['study']!r} is a folder of other results; give it another name."
        )
    # Before the defaults, behind which nobody could tell what the user gave.
    _settle_origin(study, source)
    steps_given = {"time_step_s", "steps_per_cycle"} & set(study.get("test", {}))
    _fill(study, rules, rules)
    if "packings" in study["specimens"]:
        # A default of pouring, and nothing is poured.
        del study["specimens"]["deposit"]
    _check(study, source)
    usual = usual_steps_per_cycle(study["test"]["type"])
    if usual and not steps_given:
        study["test"]["steps_per_cycle"] = usual
    return study


def refuse_repeated_keys(path: str | Path) -> None:
    """Refuse a study in which a key appears twice, of which YAML silently takes the last.

    Anchors are refused too: a few lines of them can stand for more than any memory holds.
    """

    class Strict(yaml.SafeLoader):
        def compose_node(self, parent: yaml.Node | None, index: int) -> yaml.Node | None:
            # Nested anchors may stand for more than memory holds; fuzzing found them.
            if self.check_event(yaml.AliasEvent):
                line = self.peek_event().start_mark.line + 1
                raise InputError(f"{path}, line {line}: refers to an anchor; write out what it stands for.")
            return super().compose_node(parent, index)

        def construct_mapping(self, node: yaml.MappingNode, deep: bool = False) -> dict[Any, Any]:
            seen = set()
            for name, _ in node.value:
                line = name.start_mark.line + 1
                if not isinstance(name, yaml.ScalarNode):
                    raise InputError(f"{path}, line {line}: a key is not a word; give the name of a key.")
                if name.value in seen:
                    raise InputError(
                        f"{path}, line {line}: key {name.value!r} appears twice; keep one of the two."
                    )
                seen.add(name.value)
            return super().construct_mapping(node, deep)

    require_readable(path, "check the path")
    try:
        yaml.load(Path(path).read_text(encoding="utf-8"), Strict)
    except (yaml.YAMLError, ValueError, RecursionError) as error:
        raise InputError(f"{path}: not valid YAML ({error}); compare it with config/paper.yaml.") from None


def label(value: float) -> str:
    """Temperature [degC] or frequency [Hz] as in file names: 15, -10, 12.5; ten digits, as in tables."""
    return f"{value:.10g}"


def _convert(study: dict[str, Any], error: ValidationError) -> None:
    """Turn a text into the number that the schema asks for in its place, if it is one."""
    for part in (error, *error.context):
        if (
            part.validator == "type"
            and part.validator_value in ("number", "integer")
            and isinstance(part.instance, str)
        ):
            *keys, last = part.absolute_path
            if _NUMBER.fullmatch(part.instance):
                whole = part.instance.lstrip("+-").isdecimal()
                reduce(getitem, keys, study)[last] = (int if whole else float)(part.instance)


def _whole(value: Any, schema: Mapping[str, Any]) -> Any:
    """2.0 as 2, where the schema asks for a whole number: it takes both, and file names and steps do not."""
    if isinstance(value, dict):
        return {key: _whole(item, schema.get("properties", {}).get(key, {})) for key, item in value.items()}
    if isinstance(value, list):
        return [_whole(item, schema.get("items", {})) for item in value]
    asked = schema.get("type") == "integer" and isinstance(value, float) and value.is_integer()
    return int(value) if asked else value


def _rounded(value: Any) -> Any:
    """Numbers with the digits that file names and tables keep, so that all of them match."""
    if isinstance(value, Mapping):
        return {key: _rounded(item) for key, item in value.items()}
    if isinstance(value, list):
        return [_rounded(item) for item in value]
    return float(label(value)) if isinstance(value, float) else value


def _nearest_alternative(error: ValidationError) -> list[ValidationError]:
    """Errors of the alternative mapping that fails by the fewest; none where mappings are no alternatives."""
    alternatives = error.validator_value if error.validator == "anyOf" else ()
    parts = [part for part in error.context if "$ref" in alternatives[part.schema_path[0]]]
    places = [part.schema_path[0] for part in parts]
    nearest = min(places, key=places.count, default=None)
    return [part for part, place in zip(parts, places, strict=True) if place == nearest]


def _fill(value: Any, schema: Mapping[str, Any], root: Mapping[str, Any]) -> None:
    """Put the schema's defaults where `value` has nothing."""
    if "$ref" in schema:
        schema = root["$defs"][schema["$ref"].rsplit("/", 1)[1]]
    if isinstance(value, dict):
        for key, rule in schema.get("properties", {}).items():
            if "default" in rule:
                value.setdefault(key, copy.deepcopy(rule["default"]))
            if key in value:
                _fill(value[key], rule, root)


def _settle_origin(study: dict[str, Any], source: str) -> None:
    """Require samples that are poured or given, not both; given ones are numbered from 1, as if by seeds."""
    specimens = study["specimens"]
    if "packings" not in specimens:
        for key in POURED:
            if key not in specimens:
                raise InputError(
                    f"{source}: key {key!r} is missing from specimens; add it, or give packings instead."
                )
        for key in ("packing_unit", "packing_up"):
            if key in specimens:
                raise InputError(f"{source}: specimens.{key} is for packings; leave it out.")
        return
    numbers = list(range(1, len(specimens["packings"]) + 1))
    for key in (*POURED, "deposit"):
        if key in specimens and (key, specimens[key]) != ("seeds", numbers):  # as of a study completed before
            raise InputError(
                f"{source}: specimens.{key} is for pouring, and packings are poured already; leave out one of them."
            )
    for key in ("packing_study", "published"):
        if key in study:
            raise InputError(f"{source}: {key} needs spheres that the study pours; leave out it or packings.")
    specimens["seeds"] = numbers


def _check(study: dict[str, Any], source: str) -> None:
    """What a schema cannot say: values against each other, and files."""
    for path, value in _leaves(study):
        # YAML writes .nan and .inf, and a schema takes both for numbers.
        if isinstance(value, float) and not math.isfinite(value):
            raise InputError(f"{source}: {dotted(path)} is {value}, but must be a finite number.")
    _check_geometry(study, source)
    published = study["laws"].get("published")
    users = {
        "laws.simulate": study["laws"]["simulate"] == "published",
        "measurements.reconstruct": "reconstruct" in study["measurements"],
        "audit": "audit" in study,
    }
    if not published and any(users.values()):
        user = next(name for name, uses in users.items() if uses)
        raise InputError(f"{source}: laws.published is missing, but {user} needs it; add its table and unit.")
    choices = {
        "seed": ("specimens.seeds", study["specimens"]["seeds"]),
        "temperature_C": ("temperatures_C", study["temperatures_C"]),
        "frequency_Hz": ("frequencies_Hz", study["frequencies_Hz"]),
    }
    for section in _OPTIONAL:
        for key, (where, allowed) in choices.items():
            chosen = study.get(section, {}).get(key)
            if chosen is not None and chosen not in allowed:
                raise InputError(f"{source}: {section}.{key} {chosen:g} is not in {where}; use one of them.")
    for where, path in {
        "measurements.table": study["measurements"].get("table"),
        "geometry": study["geometry"] if isinstance(study["geometry"], str) else None,
        "laws.published.table": published and published["table"],
        "specimens.counts_table": study["specimens"].get("counts_table"),
        **{f"specimens.packings[{n}]": path for n, path in enumerate(study["specimens"].get("packings", []))},
        **{f"published.{key}": path for key, path in study.get("published", {}).items()},
        **{
            f"tables_beside.tables[{n}]": path
            for n, path in enumerate(study.get("tables_beside", {}).get("tables", []))
        },
    }.items():
        if path is not None and not is_file(path):
            raise InputError(f"{source}: {where} is {path!r}, but there is no such file; check the path.")


def _check_geometry(study: dict[str, Any], source: str) -> None:
    """Fill in what is simulated: the measured specimen if that is one for all, or the usual one of the test named."""
    # Modules that need numpy are imported where they are used: Snakemake alone plans a bending study without it.
    kind = study["test"].get("type")
    if "geometry" not in study["specimens"] and kind not in (None, BENDING):
        from asphalt_nscd.measurements.geometry import (
            USUAL,
        )  # with numpy, which planning the paper does without

        study["specimens"]["geometry"] = USUAL[kind].keys()
    if "geometry" not in study["specimens"]:
        if isinstance(study["geometry"], str):
            raise InputError(
                f"{source}: geometry is a table, which does not say what to simulate; add specimens.geometry."
            )
        study["specimens"]["geometry"] = dict(study["geometry"])
    for where, holder in (("geometry", study), ("specimens.geometry", study["specimens"])):
        shape = holder["geometry"]
        if isinstance(shape, dict) and "b_mm" in shape and not shape["b_mm"] <= shape["B_mm"]:
            raise InputError(
                f"{source}: {where}.b_mm must not be larger than B_mm; exchange them if they are swapped."
            )
    geometry, simulated = study["specimens"]["geometry"], BENDING
    if "b_mm" not in geometry:
        from asphalt_nscd.measurements.geometry import read_shape, test_of

        simulated = test_of(geometry)
    if kind not in (None, simulated):
        raise InputError(
            f"{source}: test.type is {kind!r}, but specimens.geometry has the keys of {simulated!r}; leave out one of "
            "the two."
        )
    study["test"]["type"] = simulated
    if "amplitude_m" not in study["test"]:
        study["test"]["amplitude_m"] = PAPER_AMPLITUDE
        if simulated != BENDING:
            usual = read_shape(geometry).usual_amplitude()
            study["test"]["amplitude_m"] = float(label(usual))


def _leaves(value: Any, path: tuple[Any, ...] = ()) -> Iterator[tuple[tuple[Any, ...], Any]]:
    """(place, value) of each value in nested mappings and lists."""
    if isinstance(value, (dict, list)):
        for key, item in value.items() if isinstance(value, dict) else enumerate(value):
            yield from _leaves(item, (*path, key))
    else:
        yield path, value
