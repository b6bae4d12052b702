"""A workbook dropped on `serve`, read, diagnosed, taken in all formats and printed, and how long each takes.

PYTHONPATH=trials python -m browser.timed data/ncat/N1-1_RH.csv

A CSV table becomes a workbook first. Each width and scheme has its own server, started as a user does; nothing is warm.
The exit status is 1 where a run takes more than two minutes of wall time.
"""

from __future__ import annotations

import argparse
import re
import signal
import subprocess
import sys
import tempfile
import time
import urllib.request
from base64 import b64decode
from pathlib import Path

import pandas as pd

from browser.chromium import Page, find
from browser.served import connect, drop, sized, until

MOST = 120.0  # s
WAYS = [(width, dark) for width in (1300, 390) for dark in (False, True)]
PIECES = ("dropped and read", "diagnosed", "exported", "printed")


def run(page: Page, address: str, workbook: Path, way: tuple[int, bool], folder: Path) -> list[float]:
    """Seconds of each of PIECES; what a user takes lies in the folder afterwards, with a picture."""
    width, dark = way
    sized(page, width, dark)
    page.open(address, width)
    at = [time.monotonic()]
    drop(page, workbook)
    until(page, "document.getElementById('go').offsetParent !== null")
    at.append(time.monotonic())
    page.evaluate("document.getElementById('go').click()")
    until(page, "!document.getElementById('result').hidden")
    at.append(time.monotonic())
    for link in page.evaluate("[...document.querySelectorAll('#take a')].map(one => one.href)"):
        name = re.sub(r"\?.*", "", link.rpartition("/")[2])
        with urllib.request.urlopen(link) as answer:
            (folder / name).write_bytes(answer.read())
    assert {"report.pdf", "law_abaqus.inp", "law_xlsx.xlsx"} <= {path.name for path in folder.iterdir()}
    at.append(time.monotonic())
    shown = page.evaluate("document.getElementById('full').src")
    page.open(shown, width)
    paper = page.call("Page.printToPDF", preferCSSPageSize=True, printBackground=False)["data"]
    (folder / "print.pdf").write_bytes(b64decode(paper))
    at.append(time.monotonic())
    shot = page.call("Page.captureScreenshot", format="png", captureBeyondViewport=True)["data"]
    (folder / "page.png").write_bytes(b64decode(shot))
    return [after - before for before, after in zip(at[:-1], at[1:], strict=True)]


def main() -> int:
    parser = argparse.ArgumentParser()
    parser.add_argument("table", type=Path)
    parser.add_argument("--output", type=Path, help="folder for what was taken, with pictures")
    given = parser.parse_args()
    program = find()
    if program is None:
        print("skipped: no Chromium on PATH (Debian: apt install chromium); CHROMIUM names another.")
        return 0
    output = given.output or Path(tempfile.mkdtemp(prefix="timed-"))
    output.mkdir(parents=True, exist_ok=True)
    workbook = given.table
    if workbook.suffix == ".csv":
        workbook = output / f"{given.table.stem}.xlsx"
        pd.read_csv(given.table, dtype={"specimen": str}, comment="#").to_excel(workbook, index=False)
    rows = {}
    for width, dark in WAYS:
        folder = output / f"{width}-{'dark' if dark else 'light'}"
        folder.mkdir(exist_ok=True)
        command = [sys.executable, "-u", "-m", "asphalt_nscd.cli", "serve", "--no-browser"]
        server = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
        try:
            assert server.stdout is not None
            address = re.search(r"http://\S+", server.stdout.readline())
            assert address is not None
            with Page(program) as page:
                connect(page)
                rows[folder.name] = run(page, address.group(), workbook, (width, dark), folder)
        finally:
            server.send_signal(signal.SIGTERM)
            server.wait(60)
    table = pd.DataFrame.from_dict(rows, orient="index", columns=PIECES).assign(
        all=lambda one: one.sum(axis=1)
    )
    print(f"Seconds of wall time; what was taken lies in {output}.\n{table.round(1).to_string()}")
    return int((table["all"] > MOST).any())


if __name__ == "__main__":
    sys.exit(main())
