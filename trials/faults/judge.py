"""One fault on a copy of a finished study: told in a sentence, mended by a rerun, without a changed result."""

from __future__ import annotations

import re
import shutil
from dataclasses import dataclass, replace
from pathlib import Path

from comparison import differences

from faults.fault import Fault, Unable, last_line
from faults.study import RESULTS, Missed, Run, Study

PASSED, IMPOSSIBLE = "passed", "not possible here"


@dataclass(frozen=True)
class Judged:
    kind: str
    fault: str
    verdict: str  # passed, not possible here, or what is wrong
    sentence: str

    def spoilt(self, wrong: str) -> Judged:
        """The same with something wrong that showed later."""
        return replace(self, verdict=wrong if self.verdict == PASSED else f"{self.verdict}; {wrong}")


def judge(kind: str, fault: Fault, finished: Study, folder: Path) -> Judged:
    for attempt in range(3):
        study = finished.copy(folder)
        study.targets = (f"{RESULTS}/{fault.target}",) if fault.target else ()
        try:
            met = fault.disturb(study)
            verdict = _wrong(fault, met, study, finished) or PASSED
            return Judged(kind, fault.name, verdict, _shown(fault, met, study))
        except Unable as error:
            return Judged(kind, fault.name, IMPOSSIBLE, str(error))
        except Missed as error:
            if attempt == 2:
                return Judged(kind, fault.name, str(error), "")
        finally:
            shutil.rmtree(folder, ignore_errors=True)
    raise AssertionError


def _shown(fault: Fault, met: Run, study: Study) -> str:
    """The line in which the user reads of it, if there is one."""
    lines = [line for line in last_line(met).splitlines() if fault.said and re.search(fault.said, line)]
    return lines[-1].replace(str(study.folder), ".")[:300] if lines else ""


def _wrong(fault: Fault, met: Run, study: Study, finished: Study) -> str | None:
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
