from __future__ import annotations

import os
import time

from asphalt_nscd.workflow_support.clock import LONG_AGO, TOLERANCE, mistrust_future


def test_only_what_is_dated_in_the_future_is_dated_back(tmp_path):
    now = time.time()
    dates = {"past": now - 1e6, "skew": now + 0.5 * TOLERANCE, "future": now + 2.0 * TOLERANCE}
    for name, date in dates.items():
        (tmp_path / name).mkdir()
        (tmp_path / name / "file").touch()
        os.utime(tmp_path / name / "file", (date, date))
    assert mistrust_future(tmp_path) == 1
    dates["future"] = LONG_AGO
    assert {name: (tmp_path / name / "file").stat().st_mtime for name in dates} == dates
    assert mistrust_future(tmp_path / "none") == 0
