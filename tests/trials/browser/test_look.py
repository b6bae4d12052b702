"""What the look at a page and its use find, and that pages of ours have none of it."""

from __future__ import annotations

from base64 import b64encode
from io import BytesIO

import pytest
from browser.chromium import Page, find
from browser.look import WIDTHS, look
from browser.use import show, use
from matplotlib.figure import Figure

from asphalt_nscd.reporting.pages.assemble import Entry, assemble
from asphalt_nscd.reporting.pages.diagnosis_page import render, sections
from asphalt_nscd.reporting.pages.first_page import first_page
from asphalt_nscd.reporting.pages.style import SCRIPT, STYLE
from asphalt_nscd.reporting.pages.style import page as page_of

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(
        find() is None, reason="no Chromium on PATH (Debian: apt install chromium); CHROMIUM names another"
    ),
]


def png(colour="white", width=4):
    figure = Figure(figsize=(width, 3), facecolor=colour)
    figure.add_subplot(facecolor=colour).plot([1, 2])
    figure.savefig(stream := BytesIO())
    return stream.getvalue()


@pytest.fixture(scope="module")
def browser():
    with Page(find()) as page:
        yield page


@pytest.fixture
def found(browser):
    return lambda path, width=WIDTHS[0], how=look: how(browser.anew(), path, width)


@pytest.mark.parametrize("width", WIDTHS)
def test_report_has_nothing_to_complain_of(found, browser, results, tmp_path, width):
    for name, text in {"a.png": "figure", "t.html": "table", "diagnosis.html": "diagnosis"}.items():
        (tmp_path / name.replace("html", "rst").replace("png", "rst")).write_text(
            f"**{text}**\n\nWith |E*| and ``code``.\n"
        )
    (tmp_path / "a.png").write_bytes(png(width=14))
    row = "".join(f"<td>{number}</td>" for number in range(1000, 1040))
    for name in ("t", "diagnosis"):
        (tmp_path / f"{name}.html").write_text(
            f"<html><body><table><caption>{name}</caption><tr>{row}</tr></table></body></html>"
        )
    (tmp_path / "workflow.html").touch()
    (picture := tmp_path / "map.png").write_bytes(png())
    (samples := tmp_path / "samples.csv").write_text("sample,spheres,E_over_law\ns1,90,1.1\ns2,110,1.2\n")
    page = first_page(
        results.measured(),
        results.simulations(("s1", "s2"), ratios=lambda sample: 1.1),
        [samples],
        results.diagnosis()["diagnosis"],
        [picture],
        results.ladder(),
    )
    entries = [
        Entry(f"{place} Part {place}", tmp_path / name) for place, name in enumerate(("a.png", "t.html"))
    ]
    (tmp_path / "report.html").write_text(
        assemble(
            "tiny", page, [*entries, Entry("2 Last", tmp_path / "diagnosis.html")], tmp_path.glob("*.rst")
        )
    )
    assert found(tmp_path / "report.html", width) == []
    assert found(tmp_path / "report.html", width, use) == []
    # a broad figure keeps its letters and scrolls in its own box
    show(browser.anew(), tmp_path / "report.html", width, "light")
    assert browser.evaluate("document.querySelector('#a img').getBoundingClientRect().width") > 500


@pytest.mark.parametrize("width", WIDTHS)
def test_page_of_a_diagnosis_can_be_used(found, results, tmp_path, width):
    made = results.diagnosis() | {"causality": results.causality()}
    for name in ("residuals.csv", "diagnosis.json"):
        assert (tmp_path / name).exists()
    (tmp_path / "page.html").write_text(
        render(sections(**made), "A diagnosis", {"residuals.csv": "each test"})
    )
    assert found(tmp_path / "page.html", width) == []
    assert found(tmp_path / "page.html", width, use) == []


@pytest.mark.parametrize("width", WIDTHS)
def test_a_wide_table_scrolls_inside_its_own_box(found, browser, tmp_path, width):
    """A table of its own page, of 40 columns and a cell of many words: the page stays as wide as the window."""
    names = ",".join(["T", *(f"column_{number}" for number in range(39))])
    cells = ",".join(["s1 at rest", *["12345.6"] * 38, "a sentence of many words " * 12])
    (tmp_path / "t.csv").write_text(f"# a note\n#  that goes on\n{names}\n" + f"{cells}\n" * 60)
    (tmp_path / "t.html").write_text(page_of(tmp_path / "t.csv", "A table"))
    assert found(tmp_path / "t.html", width) == []
    show(browser.anew(), tmp_path / "t.html", width, "light")
    assert browser.evaluate("document.querySelector('td.words').getBoundingClientRect().width") > 200
    lines = "(r => { r.selectNodeContents(document.querySelector('td')); return r.getClientRects().length; })"
    # a short cell is not torn on a telephone
    assert width > 600 or browser.evaluate(f"{lines}(document.createRange())") == 1
    browser.evaluate("document.querySelector('.wide').scrollTop = 500")
    top = "document.querySelector('SELECT').getBoundingClientRect().top"
    assert browser.evaluate(top.replace("SELECT", "th")) == browser.evaluate(top.replace("SELECT", ".wide"))


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
def test_what_is_wrong_is_found(found, tmp_path, body, told):
    for name, colour in {"DARK": "black", "LIGHT": "white"}.items():
        body = body.replace(name, b64encode(png(colour)).decode())
    path = tmp_path / "page.html"
    path.write_text(f"<!DOCTYPE html><html><body style='margin: 0'>{body}</body></html>")
    assert any(told in one for one in found(path)), found(path)


TABLE = (
    "<table aria-label='t'><thead><tr><th scope='col'>a</th><th scope='col'>b</th></tr></thead><tbody>"
    "<tr><td>2</td><td></td></tr><tr><td>10</td><td></td></tr><tr><td>1</td><td></td></tr></tbody></table>"
)
CHART = (
    "<figure class='chart'><svg aria-label='c' tabindex='0' width='300' height='90'>POINTS</svg>"
    "<p class='said'></p></figure>"
)
POINTS = "".join(
    f"<circle cx='{40 * n + 20}' cy='40' r='9'><title>{n} °C, 3 Hz</title></circle>" for n in range(5)
)


@pytest.mark.parametrize(
    ("body", "script", "told"),
    [
        ("<p style='color: #999'>pale</p>", SCRIPT, "light: contrast 2.8 of 'pale'"),
        ("<p style='color: #444'>dim</p>", SCRIPT, "dark: contrast"),
        ("<style>body { background: #fff !important }</style>", SCRIPT, "the page is not dark"),
        ("<table><tr><td>1</td></tr></table>", SCRIPT, "a table has no name"),
        ("<h1>a</h1><h3>b</h3>", SCRIPT, "a heading 3 below 1"),
        ("<input type='checkbox'>", SCRIPT, "no label"),
        ("<p id='a'></p><p id='a'></p>", SCRIPT, "a second id"),
        (TABLE, SCRIPT.replace("x - y", "y - x"), "a column sorted ascending says 'ascending' and reads [10, 2"),
        (TABLE, SCRIPT.replace("x - y", "a.localeCompare(b)"), "a column sorted ascending"),
        (TABLE, SCRIPT.replace('"aria-sort", down', '"data-sort", down'), "says None"),
        (TABLE, SCRIPT.replace('join("\\t")', 'join(" ")'), "a copied table of 2 columns: 'Copied', 1 columns"),
        (CHART.replace("POINTS", POINTS), SCRIPT.replace("at + 1", "at + 2"), "ArrowRight says '1 °C"),
        (CHART.replace("POINTS", POINTS), SCRIPT.replace("pointerover", "nothing"), "the pointer at '3 °C"),
        (CHART.replace("POINTS", POINTS.replace("°C", "deg")), SCRIPT, "ArrowRight says '0 deg"),
        ("<div style='height: 4000px'>long</div>", SCRIPT, "prints on"),
    ],
)  # fmt: skip
def test_what_fails_in_use_is_found(found, tmp_path, body, script, told):
    path = tmp_path / "page.html"
    path.write_text(
        f"<!DOCTYPE html><html lang='en'><style>{STYLE}</style><script>{script}</script><body>{body}</body></html>"
    )
    said = found(path, how=use)
    assert any(told in one for one in said), said
