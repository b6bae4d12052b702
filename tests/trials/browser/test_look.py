"""What the look at a report finds, and that a report of ours has none of it."""

from __future__ import annotations

from base64 import b64encode
from io import BytesIO

import pytest
from browser.chromium import Page, find
from browser.look import WIDTHS, look
from matplotlib.figure import Figure

from asphalt_nscd.reporting.pages.assemble import Entry, assemble

pytestmark = pytest.mark.skipif(
    find() is None, reason="no Chromium on PATH (Debian: apt install chromium); CHROMIUM names another"
)


def png(colour="white"):
    figure = Figure(figsize=(4, 3), facecolor=colour)
    figure.add_subplot(facecolor=colour).plot([1, 2])
    figure.savefig(stream := BytesIO())
    return stream.getvalue()


def found(path, width=WIDTHS[0]):
    with Page(find()) as page:
        return look(page, path, width)


@pytest.mark.parametrize("width", WIDTHS)
def test_report_has_nothing_to_complain_of(tmp_path, width):
    for name, text in {"a.png": "figure", "t.html": "table", "diagnosis.html": "diagnosis"}.items():
        (tmp_path / name.replace("html", "rst").replace("png", "rst")).write_text(
            f"**{text}**\n\nWith |E*| and ``code``.\n"
        )
    (tmp_path / "a.png").write_bytes(png())
    row = "".join(f"<td>{number}</td>" for number in range(1000, 1040))
    for name in ("t", "diagnosis"):
        (tmp_path / f"{name}.html").write_text(f"<html><body><table><tr>{row}</tr></table></body></html>")
    (tmp_path / "workflow.html").touch()
    sentence = ["A sentence about 120 moduli."]
    page = {
        "measured": sentence, "simulated": sentence, "wrong": sentence, "not_used": sentence, "orders": sentence,
        "found": {"data": "Good.", "simulation": "Right.", "causes": [("a cause", "Established.")],
                  "left": sentence, "with_suspects": "The same causes."},
        "notes": sentence, "gained": [("error of |E*|, %", "2", "1")], "held_out": None,
        "map": b64encode(png()).decode(),
    }  # fmt: skip
    entries = [Entry(f"{place} Part", tmp_path / name) for place, name in enumerate(("a.png", "t.html"))]
    (tmp_path / "report.html").write_text(
        assemble("tiny", page, [*entries, Entry("2 Last", tmp_path / "diagnosis.html")], tmp_path)
    )
    assert found(tmp_path / "report.html", width) == []


@pytest.mark.parametrize(
    ("body", "told"),
    [
        ("<script>console.error('no')</script>", "console: ['no']"),
        ("<script>throw Error('no')</script>", "exception: Uncaught"),
        ("<img alt='a' src='gone.png'>", "image 'a' does not load"),
        ("<img alt='a' src='https://example.org/a.png'>", "asks the network for https://example.org/a.png"),
        ("<img alt='a' src='data:image/png;base64,DARK'>", "image 'a' is dark"),
        ("<img src='data:image/png;base64,LIGHT'>", "an image has no words"),
        ("<div style='width: 2000px'>wide</div>", "720 px wider than the window"),
        ("<p style='font-size: 8px'>tiny</p>", "small letters: 'tiny'"),
        ("<a href='#gone'>a</a>", "link #gone leads nowhere"),
        ("<a href='gone.html'>a</a>", "link gone.html leads to no file"),
        ("<details><img alt='a' src='gone.png'></details>", "image 'a' does not load"),
    ],
)
def test_what_is_wrong_is_found(tmp_path, body, told):
    for name, colour in {"DARK": "black", "LIGHT": "white"}.items():
        body = body.replace(name, b64encode(png(colour)).decode())
    path = tmp_path / "page.html"
    path.write_text(f"<!DOCTYPE html><html><body style='margin: 0'>{body}</body></html>")
    assert any(told in one for one in found(path)), found(path)
