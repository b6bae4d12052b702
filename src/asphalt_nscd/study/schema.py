"""The schema of a study. Of a key that is an option of a step, its field says help, type, range and default."""

from __future__ import annotations

from dataclasses import MISSING
from importlib import import_module
from pathlib import Path
from typing import Any

import yaml

from asphalt_nscd.files.options import options_of

SCHEMA = Path(__file__).parent / "study.schema.yaml"
_LIMITS = {"above": "exclusiveMinimum", "low": "minimum", "below": "exclusiveMaximum", "high": "maximum"}
_TYPES = {float: "number", int: "integer", str: "string"}


def read_schema(path: str | Path = SCHEMA) -> dict[str, Any]:
    """The schema of a study, with `option: specimen.settings.Surfaces.friction` replaced by what that field states.

    Keywords beside `option` replace those of the field; a limit among them replaces all limits of the field.
    """
    made: dict[str, Any] = _completed(yaml.safe_load(Path(path).read_text(encoding="utf-8")))
    return made


def _completed(rule: Any) -> Any:
    """A part of the schema, with what the fields state in place of each `option` in it."""
    if isinstance(rule, list):
        return [_completed(part) for part in rule]
    if not isinstance(rule, dict):
        return rule
    stated = {key: _completed(value) for key, value in rule.items() if key != "option"}
    if not isinstance(rule.get("option"), str):
        return {key: _completed(value) for key, value in rule.items()}
    of_field, limits = _schema_keywords(rule["option"]), set(_LIMITS.values())
    replaced = limits if limits & set(stated) else set()
    return {key: value for key, value in of_field.items() if key not in replaced} | stated


def _schema_keywords(place: str) -> dict[str, Any]:
    """Keywords of the schema for `specimen.settings.Surfaces.friction`, in the unit of its key."""
    module, kind, field = place.rsplit(".", 2)
    declared = options_of(getattr(import_module(f"asphalt_nscd.{module}"), kind))[field]
    made: dict[str, Any] = {"description": declared.help}
    made |= {"enum": list(declared.choices)} if declared.choices else {"type": _TYPES[declared.annotation]}
    made |= {_LIMITS[name]: _short(declared.given(limit)) for name, limit in declared.range.limits.items()}
    return (
        made
        if declared.default in (None, MISSING)
        else made | {"default": _short(declared.given(declared.default))}
    )


def _short(value: Any) -> Any:
    """A number as one writes it: 6 for 6.0, but not a million and more."""
    return int(value) if isinstance(value, float) and value.is_integer() and abs(value) < 1e6 else value
