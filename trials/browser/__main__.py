"""Look at a report or the page of a diagnosis in Chromium, and use it; each trouble is a line, and the exit status 1.

PYTHONPATH=trials python -m browser results/smoke/report.html
PYTHONPATH=trials python -m browser results/paper/report.html --picture first-page.png
PYTHONPATH=trials python -m browser results/smoke/report.html --pictures /tmp/pictures
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from browser.chromium import Page, find
from browser.look import WIDTHS, look
from browser.use import SCHEMES, printed, show, use

BELOW = "document.querySelector('nav, .details').getBoundingClientRect().top + scrollY"  # the picture ends


def main() -> int:
    parser = argparse.ArgumentParser()
    parser.add_argument("report", type=Path)
    parser.add_argument("--picture", type=Path, help="PNG file for a picture of the first page")
    parser.add_argument("--pictures", type=Path, help="folder for the page in all looks, and for its print")
    given = parser.parse_args()
    program = find()
    if program is None:
        print("skipped: no Chromium on PATH (Debian: apt install chromium); CHROMIUM names another.")
        return 0
    found = []
    for width in WIDTHS:
        with Page(program) as page:
            found += look(page, given.report, width)
            found += use(page, given.report, width)
    if given.picture:
        picture(program, given.report, given.picture)
    if given.pictures:
        pictures(program, given.report, given.pictures)
    print("\n".join(found) or f"{given.report}: nothing to complain of at {WIDTHS[0]} and {WIDTHS[1]} px.")
    return 1 if found else 0


def picture(program: str, report: Path, output: Path) -> None:
    """What stands above the navigation of the report, as a picture."""
    with Page(program) as page:
        page.open(report.resolve().as_uri(), WIDTHS[0])
        page.evaluate("document.fonts.ready.then(() => true)")
        page.decode_images()
        height = page.evaluate(BELOW)
        clip = {"x": 0, "y": 0, "width": WIDTHS[0], "height": height, "scale": 1}
        output.write_bytes(page.picture(clip=clip))


def pictures(program: str, report: Path, folder: Path) -> None:
    """The whole page at each width, light and dark, and its print (PDF): for eyes."""
    folder.mkdir(parents=True, exist_ok=True)
    with Page(program) as page:
        for width in WIDTHS:
            for scheme in SCHEMES:
                show(page, report, width, scheme)
                page.decode_images()
                (folder / f"{report.stem}-{width}-{scheme}.png").write_bytes(page.picture())
        (folder / f"{report.stem}.pdf").write_bytes(printed(page, report))


if __name__ == "__main__":
    sys.exit(main())
