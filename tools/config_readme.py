"""Write config/README.md from the schema of a study: python tools/config_readme.py"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import yaml

ROOT = Path(__file__).resolve().parents[1]
HEAD = """\
# Studies

A study is one YAML file. `paper.yaml` is the paper, `smoke.yaml` the same chain at reduced size.
`asphalt-nscd new-study` writes one from your table of measurements (`docs/tutorial.md`).
Run your own with `make study CONFIG=my.yaml` or `snakemake --cores all --configfile my.yaml`.
Keys left out take their default, which is the paper's value; unknown keys are refused. Paths are
relative to the folder in which you call.

This file is made from `workflow/schemas/study.schema.yaml` by `python tools/config_readme.py`.

| key | meaning | default |
|---|---|---|
"""


def page() -> str:
    """The whole file."""
    schema = yaml.safe_load((ROOT / "workflow/schemas/study.schema.yaml").read_text(encoding="utf-8"))
    rows = (f"| `{key}` | {meaning} | {default} |" for key, meaning, default in _keys(schema, schema, ""))
    return HEAD + "\n".join(rows) + "\n"


def _keys(rule: dict[str, Any], schema: dict[str, Any], path: str) -> Iterator[tuple[str, str, str]]:
    for alternative in rule.get("anyOf", [rule]):
        if "$ref" in alternative:
            alternative = schema["$defs"][alternative["$ref"].rsplit("/", 1)[1]]
        for key, value in alternative.get("properties", {}).items():
            needed = key in alternative.get("required", ())
            yield path + key, value["description"], _default(value, needed)
            # the trapezoid's keys are explained where it first stands
            if path + key != "specimens.geometry":
                yield from _keys(value, schema, f"{path}{key}.")


def _default(rule: dict[str, Any], needed: bool) -> str:
    if "default" in rule and not isinstance(rule["default"], dict):
        return f"`{rule['default']}`"
    if "enum" in rule:
        return " or ".join(f"`{value}`" for value in rule["enum"])
    return "required" if needed else ""


if __name__ == "__main__":
    (ROOT / "config/README.md").write_text(page(), encoding="utf-8")
