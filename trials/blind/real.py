"""Causes put into real tables and tables like them: what the diagnosis makes of each, as scored rows.

Of each table the diagnosis gives its own limits, names and estimates first; then every cause is put in at
multiples of its limit and the table is diagnosed again. Real tables need not be redistributable: a row holds
an alias, a ratio to a limit, and what was found of what was hidden; no value, law, name or place of the table.
"""

from __future__ import annotations

import time
from collections.abc import Collection, Iterator, Mapping
from typing import Any

import numpy as np
import pandas as pd

from asphalt_nscd.files.errors import InputError

from . import real_score, reallike, sealed
from .backgrounds import Background
from .causes import CATALOGUE
from .plan import RATIOS
from .real_plan import RATIOS_OF, Task

NAMEABLE = frozenset(cause.name for cause in sealed.NAMEABLE)
# The untouched table on other tests or beside other causes: by the tests that it lacks, and the causes it may hold.
Alike = dict[tuple[frozenset, frozenset[str]], Mapping[str, Any]]


def run(group: list[Task]) -> Iterator[dict[str, Any]]:
    """Rows of all tasks of a group; see `real_score.row`."""
    for task in group:
        background, odd = _background(task)
        own = _diagnosed(background, background.table)
        alike: Alike = {}
        if task.counted:
            # What a real table holds is not known, so that none of its names is known to be false.
            unknown = {"wrong": None} if task.path else {}
            yield _common(task) | real_score.untouched(own, odd) | unknown
        for cause in task.causes:
            limit = own["detection_limits"].get(cause)
            if limit is None or background.lacks(cause):
                yield _common(task) | {"cause": cause, "not_drawn": "no limit"}
                continue
            yield from _hidden(task, background, own, alike, cause, odd)


def _background(task: Task) -> tuple[Background, str | None]:
    if task.path:
        return Background.read(task.path), None
    columns = {CATALOGUE[cause].needs for cause in task.causes} - {None}
    background, seal = reallike.draw(task.seed, task.kind, columns, task.shape)
    return background, seal["odd"]


def _common(task: Task) -> dict[str, Any]:
    return {"table": task.alias, "kind": task.kind, "seed": None if task.path else task.seed}


def _hidden(
    task: Task,
    background: Background,
    own: Mapping[str, Any],
    alike: Alike,
    cause: str,
    odd: str | None,
) -> Iterator[dict[str, Any]]:
    """One row for each amplitude of a cause, at a place drawn among those where five limits are physical."""
    effect, limit = background.effect(cause), own["detection_limits"][cause]
    rng = np.random.default_rng([task.seed, list(CATALOGUE).index(cause)])
    most = sealed.LARGEST.get(cause, np.inf)
    where, value = None, limit["value"]
    if effect.confined is not None:
        within = [place for place, size in limit["places"].items() if max(RATIOS) * size <= most]
        where = str(rng.choice(within or [min(limit["places"], key=limit["places"].get)]))
        value = limit["places"][where]
    signs = (-1.0, 1.0) if effect.signed else (1.0,)
    if effect.signed and not task.both_signs:
        signs = (float(rng.choice(signs)),)
    details = int(rng.integers(2**31))
    for ratio in RATIOS_OF.get(cause, RATIOS):
        for sign in signs:
            size = sign * ratio * value
            row = _common(task) | {"cause": cause, "ratio": ratio, "sign": int(sign)}
            if ratio * value > (most if sign > 0.0 else sealed.LARGEST_NEGATIVE.get(cause, most)):
                yield row | {"not_drawn": "not physical"}
                continue
            try:
                table, seal = background.put(cause, size, where, limit["unit"], details)
            except ArithmeticError:  # the warmth of self-heating does not settle
                yield row | {"not_drawn": "not physical"}
                continue
            after = _diagnosed(background, table)
            left_out, held = real_score.left_out(after), _causes(after) | {cause}
            same = own
            if left_out != real_score.left_out(own) or not _causes(own) <= held:
                if (left_out, held) not in alike:
                    tests = background.without(left_out)
                    alike[left_out, held] = _diagnosed(background, tests, True, NAMEABLE - held)
                same = alike[left_out, held]
            yield row | real_score.row(seal, limit["unit"], value, own, after, odd, same)


def _causes(diagnosis: Mapping[str, Any]) -> frozenset[str]:
    return frozenset(entry["cause"] for entry in real_score.names(diagnosis))


def _diagnosed(
    background: Background, table: pd.DataFrame, use_suspects: bool = False, removed: Collection[str] = ()
) -> dict[str, Any]:
    """The diagnosis of a table, with its CPU seconds; a refusal or a failure is one without names."""
    began = time.process_time()
    try:
        found = sealed.open_case(
            table,
            sealed.generator.GEOMETRY,
            removed=removed,
            test_type=background.test_type,
            use_suspects=use_suspects,
        )
    except InputError:
        found = dict(sealed.REFUSED)
    except Exception as error:  # counted, and to be mended in the diagnosis
        found = sealed.REFUSED | {"verdict": "failed", "error": type(error).__name__}
    return found | {"cpu_s": time.process_time() - began}
