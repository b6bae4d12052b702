"""Rows of the verification are judged in the tests that compute them; `--verification` writes them to a table."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pandas as pd
import pytest

from asphalt_nscd.files.store import provenance, write_json, write_table
from asphalt_nscd.files.words import counted
from theory.rows import COLUMNS, PASSED, THEMES, judged, summarised


def pytest_addoption(parser):
    parser.addoption("--verification", type=Path, metavar="FOLDER", help="Write the table of all rows there.")


def pytest_configure(config):
    folder = config.getoption("verification", None)
    if folder and not hasattr(config, "workerinput"):  # of xdist, whose workers send what they found
        config.pluginmanager.register(Tables(folder))


@pytest.fixture
def row(request) -> Callable[..., None]:
    """`judged`, in the table of rows under the name of the file, and asserted."""

    def judge(*values, **options) -> None:
        found = judged(*values, **options)
        theme = request.path.stem.removeprefix("test_")
        request.node.user_properties.append(("row", {"theme": theme} | found))
        assert found["verdict"] == PASSED, "{name}: {found:.10g}, not {expected:.10g}".format(**found)

    return judge


class Tables:
    """All rows, their number by theme, and from which commit; tests that failed are named last."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.rows: list[dict] = []
        self.failed: list[str] = []

    def pytest_runtest_logreport(self, report):
        if report.when == "call":
            self.rows += [row for name, row in report.user_properties if name == "row"]
        if report.failed:
            self.failed.append(report.nodeid)

    def pytest_sessionfinish(self):
        self.rows.sort(key=lambda row: THEMES.index(row["theme"]))
        table = pd.DataFrame(self.rows, columns=["theme", *COLUMNS])
        write_table(self.folder / "verification.csv", table)
        write_table(self.folder / "summary.csv", summarised(table))
        write_json(self.folder / "provenance.json", provenance())

    def pytest_unconfigure(self):
        if self.failed:
            print(f"error: {counted(len(self.failed), 'test')} of theory failed: {'; '.join(self.failed)}")
