"""What a file that breaks its JSON schema is told, in plain words."""

from __future__ import annotations

import difflib
import re
from collections.abc import Iterable
from typing import Any

from jsonschema.exceptions import ValidationError, best_match

_TYPES = {
    "object": "a mapping",
    "array": "a list",
    "string": "text",
    "number": "a number",
    "integer": "a whole number",
}


def first_wrong(errors: Iterable[ValidationError]) -> Any:
    """The error to tell first, None if there is none: most often a key is misspelt, which is then missing as well."""
    errors = list(errors)
    unknown = [error for error in errors if error.validator == "additionalProperties"]
    return (unknown or [best_match(errors)])[0]


def sentence_on(error: ValidationError, whole: str) -> str:
    """What is wrong, where and how to mend it; `whole` is what the file holds."""
    where, schema = dotted(error.absolute_path) or whole, error.schema
    if error.validator == "additionalProperties":
        key = next(key for key in error.instance if key not in schema["properties"])
        close = difflib.get_close_matches(str(key), schema["properties"], n=1)
        mend = f"did you mean {close[0]!r}?" if close else f"allowed are {', '.join(schema['properties'])}."
        return f"unknown key {key!r} in {where}; {mend}"
    if error.validator == "required":
        key = next(key for key in schema["required"] if key not in error.instance)
        return f"key {key!r} is missing from {where}; add it."
    if error.validator in ("minProperties", "maxProperties") and "properties" in schema:
        return f"{where} needs exactly one of {', '.join(schema['properties'])}."
    wanted = _wanted(error)
    if error.validator == "anyOf":
        wanted = " or ".join(
            dict.fromkeys(_TYPES[item.get("type", "object")] for item in error.validator_value)
        )
    meaning = f" ({schema['description'].rstrip('.')})" if "description" in schema else ""
    comma = isinstance(error.instance, str) and re.fullmatch(r"-?\d+,\d+", error.instance)
    mend = f"; write {error.instance.replace(',', '.')}" if comma else ""
    return f"{where} is {error.instance!r}, but must be {wanted}{meaning}{mend}."


def _wanted(error: ValidationError) -> str:
    """What a value must be, in words."""
    value = error.validator_value
    return {
        "type": lambda: _TYPES.get(value, value),
        "enum": lambda: "one of " + ", ".join(map(str, value)),
        "minimum": lambda: f"at least {value}",
        "exclusiveMinimum": lambda: f"greater than {value}",
        "maximum": lambda: f"at most {value}",
        "exclusiveMaximum": lambda: f"less than {value}",
        "minProperties": lambda: f"a mapping of at least {value}",
        "minItems": lambda: f"a list of at least {value}",
        "maxItems": lambda: f"a list of at most {value}",
        "uniqueItems": lambda: "a list without repetitions",
        # the one pattern of our schemas is that of names
        "pattern": lambda: "letters, digits, - and _, the first a letter",
    }.get(error.validator, lambda: f"{error.validator} {value}")()


def dotted(keys: Iterable[Any]) -> str:
    """A place in a file: `specimens.seeds[0]`."""
    path = ""
    for key in keys:
        path += f"[{key}]" if isinstance(key, int) else f".{key}" if path else str(key)
    return path
