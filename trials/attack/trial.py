"""One campaign attacked: without a fault, then with each of its cases, through what users call."""

from __future__ import annotations

import tempfile
import time
import traceback
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pandas as pd

import asphalt_nscd as an

from . import judge, measured, plan
from .faults import put
from .laboratory import Campaign, invented

FAILED = {"ladder": [], "detection_limits": {}, "indistinguishable": []}


def diagnosed(table: pd.DataFrame, bench: str) -> an.Diagnosis:
    """A table as a file, through what users call."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "measured.csv")
        table.to_csv(path, index=False)
        return an.diagnose(path, measured_in=bench)


def answered(table: pd.DataFrame, bench: str) -> tuple[dict[str, Any], str]:
    """Content of diagnosis.json and the answer on the screen. A refusal is an answer; a failure is told apart."""
    began = time.process_time()
    try:
        found = diagnosed(table, bench)
        content, answer = dict(found.content), str(found)
    except an.InputError as error:
        content, answer = {**FAILED, "verdict": "refused"}, str(error)
    except Exception as error:
        content, answer = {**FAILED, "verdict": "failed"}, failure(error)
    return content | {"cpu_s": round(time.process_time() - began, 2)}, answer


def failure(error: Exception) -> str:
    """Where it rose and what it says, without a path of the machine."""
    calls = traceback.extract_tb(error.__traceback__)
    places = [f"{Path(call.filename).name}:{call.lineno} {call.name}" for call in calls]
    return "\n".join([*places, f"{type(error).__name__}: {error}"])


@dataclass(frozen=True)
class Size:
    """How many campaigns are invented: with faults put in, and more without any; measured tables come after them."""

    tables: int = plan.TABLES
    empty: int = plan.EMPTY

    @property
    def all(self) -> int:
        return self.tables + self.empty + len(measured.paths())

    def campaign(self, number: int) -> tuple[Campaign, int]:
        """The campaign of a number, and its own number among those of its kind."""
        turn = number - self.tables - self.empty
        if turn < 0:
            return invented(number, plan.SEED), number
        return measured.campaign(measured.paths()[turn], f"measured {turn + 1}"), turn


def attacked(number: int, size: Size) -> Iterator[dict[str, Any]]:
    """A line for each case: its rows (`judge.judged`), its names (`judge.stated`), what a failure said."""
    under, turn = size.campaign(number)
    bare = plan.Case("nothing")
    content, answer = answered(put(under, ()), under.bench)
    named = judge.names(content) if "measured" in under.about else []
    own = [(e["cause"], str(e.get("where"))) for e in named]
    yield _line(under, bare, content, answer, own)
    if size.tables <= number < size.tables + size.empty:
        return
    limits = content["detection_limits"], content.get("detection_limits_of_one_place", {})
    for case in plan.cases(under, turn, *limits):
        content, answer = answered(put(under, case.faults), under.bench)
        yield _line(under, case, content, answer, own)


def _line(
    under: Campaign, case: plan.Case, content: dict[str, Any], answer: str, own: list
) -> dict[str, Any]:
    return {
        "rows": judge.judged(under, case, content, answer, own),
        "names": judge.stated(under, case, content, own),
        "failure": answer if content["verdict"] == "failed" else "",
    }
