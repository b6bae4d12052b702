"""Write config/README.md from the schema of a study: python tools/config_readme.py"""

from __future__ import annotations

import textwrap
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from asphalt_nscd.study.schema import read_schema

ROOT = Path(__file__).resolve().parents[1]
WIDTH = 120
HEAD = """\
# Configuration

A study is one YAML file. `paper.yaml` is the paper; `smoke.yaml` is the same chain at reduced size.
`asphalt-nscd new-study` writes a study from your table of measurements ([tutorial](../docs/tutorial.md)).
Run it with `make study CONFIG=my.yaml` or `snakemake --cores all --configfile my.yaml`.

A key that is left out takes its default, which is the paper's value. An unknown key is refused. Paths are relative to
the folder in which you call.

This page is made from `src/asphalt_nscd/study/study.schema.yaml`, and the options that it names, by
`python tools/config_readme.py`.
"""


def page() -> str:
    """The whole file: a section for each key of the first level, a line for each key."""
    schema = read_schema()
    text, section = HEAD, ""
    for key, meaning, default in _keys(schema, schema, ""):
        if key.split(".")[0] != section:
            section = key.split(".")[0]
            text += f"\n## {section}\n\n"
        text += _line(key, meaning, default) + "\n"
    return text


def _line(key: str, meaning: str, default: str) -> str:
    line = f"* `{key}`{f' ({default})' if default else ''}: {meaning}"
    return textwrap.fill(line, WIDTH, subsequent_indent="  ", break_long_words=False, break_on_hyphens=False)


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
        return f"default `{rule['default']}`"
    if "enum" in rule:
        return " or ".join(f"`{value}`" for value in rule["enum"])
    return "required" if needed else "optional"


if __name__ == "__main__":
    (ROOT / "config/README.md").write_text(page(), encoding="utf-8")
