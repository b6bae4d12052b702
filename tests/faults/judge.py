"""One fault on a copy of a finished study: told in a sentence, mended by a rerun, without a changed result."""

from __future__ import annotations

import re
import shutil
from dataclasses import dataclass
from pathlib import Path

from comparison import differences

from faults.study import RESULTS, Missed, Study
from faults.table import Fault, Unable, last_line


@dataclass(frozen=True)
class Judged:
    fault: str
    verdict: str  # passed, not possible here, or what is wrong
    sentence: str


def judge(fault: Fault, finished: Study, folder: Path) -> Judged:
    for attempt in range(3):
        study = finished.copy(folder)
        study.targets = (f"{RESULTS}/{fault.target}",)
        try:
            met = fault.disturb(study)
            return Judged(fault.name, _wrong(fault, met, study, finished) or "passed", _shown(met, study))
        except Unable as error:
            return Judged(fault.name, "not possible here", str(error))
        except Missed as error:
            if attempt == 2:
                return Judged(fault.name, str(error), "")
        finally:
            shutil.rmtree(folder, ignore_errors=True)
    raise AssertionError


def _shown(met, study: Study) -> str:
    return last_line(met).replace(str(study.folder), ".")[-300:] if met.returncode else ""


def _wrong(fault: Fault, met, study: Study, finished: Study) -> str | None:
    """What is wrong, None if nothing."""
    if "Traceback" in met.stderr + met.stdout:
        return "a traceback was printed"
    if fault.said is None and met.returncode:
        return "the run failed"
    if fault.said is not None and met.returncode == 0:
        return "the run did not notice"
    if fault.said and not re.search(fault.said, last_line(met)):
        return f"not told as {fault.said}"
    again = study.finish()
    if again.returncode:
        return f"the rerun failed: {last_line(again)[-300:]}"
    different = differences(finished.results, study.results)
    return "; ".join(different) or None
