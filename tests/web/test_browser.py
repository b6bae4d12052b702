"""From drop to download in a real browser, at the width of a desk and of a phone, in the light and in the dark."""

from __future__ import annotations

import base64
import cmath
import io
import math
import os
import re
import threading
import time
import urllib.request
from pathlib import Path

import openpyxl
import pytest
from browser.chromium import Page, find
from browser.served import connect, drop, sized, until
from pypdf import PdfReader

pytest.importorskip("flask")
pytestmark = [pytest.mark.slow, pytest.mark.skipif(find() is None, reason="no Chromium on this machine")]

EVIL = "<img src=x onerror=\"document.title='owned'\">"


@pytest.fixture
def address():
    from werkzeug.serving import make_server

    from asphalt_nscd.web.app import create_app

    app = create_app()
    server = make_server("127.0.0.1", 0, app, threaded=True)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    yield f"http://127.0.0.1:{server.server_port}/{app.config['TOKEN']}/"
    server.shutdown()
    app.config["DESKS"].close()


@pytest.fixture
def page():
    with Page(find()) as opened:
        connect(opened)
        yield opened


def workbook(path, name_of_moduli="Result [GPa]", stiffer=1.0):
    """A row for each test; the name of the column with moduli may say nothing of them, and cells hold HTML."""
    book = openpyxl.Workbook()
    sheet = book.active
    sheet.append([EVIL])
    sheet.append(["Specimen", "Temp. (°C)", "Freq. (Hz)", name_of_moduli, "Phase (°)", EVIL])
    for name, scale in (("A", 1.0), ("B", 1.03), ("C", 0.98)):
        for t in (4.0, 12.0, 20.0, 35.0):
            for f in (0.1, 1.0, 5.0, 10.0, 25.0):
                reduced = 1j * 6.28 * f * 0.15 * 10 ** (-9.0 * (t - 15.0) / (110.0 + t - 15.0))
                star = stiffer * scale * (0.06 + 33.0 / (1.0 + 2.2 * reduced**-0.21 + reduced**-0.6))
                phase = math.degrees(cmath.phase(star)) + 5.0 * (scale - 1.0)
                sheet.append([name, t, f, round(abs(star), 4), round(phase, 2), EVIL])
    book.save(path)
    return path


def test_moduli_without_a_phase_give_a_curve(page, address, tmp_path):
    path = tmp_path / "flat.csv"
    rows = [f"{t},{f},{3e4 / (1 + 0.05 * t * t / f**0.4):.1f}" for t in (4, 21, 37) for f in (0.1, 1, 10)]
    path.write_text("Temperature (C),Frequency (Hz),E* (MPa)\n" + "\n".join(rows), encoding="utf-8")
    page.open(address, 1280)
    drop(page, path)
    until(
        page, "document.getElementById('go').offsetParent !== null"
    )  # the part that holds it is hidden at first
    page.evaluate("document.getElementById('go').click()")
    until(page, "!document.getElementById('result').hidden")
    assert page.evaluate("document.getElementById('value').textContent").endswith("), no phase")
    look(page, "no-phase", 390, dark=True)


def look(page, name, width, dark):
    """No part wider than the window; a picture where SCREENSHOTS names a folder."""
    sized(page, width, dark)
    time.sleep(0.5)
    assert page.evaluate("document.documentElement.scrollWidth") <= width
    if folder := os.environ.get("SCREENSHOTS"):
        taken = page.call("Page.captureScreenshot", format="png")["data"]
        (Path(folder) / f"{name}-{width}-{'dark' if dark else 'light'}.png").write_bytes(
            base64.b64decode(taken)
        )


def choose(page, selector, value):
    page.evaluate(f"(m => {{ m.value = {value!r}; m.dispatchEvent(new Event('change')); }})({selector})")


def compared(page, folder):
    """Another mix dropped beside the first; then the answer to the first is looked at again."""
    other = folder / "other.csv"
    rows = [
        f"A,{t},{f},{3e4 / (1 + 0.05 * t * t / f**0.4):.1f},{8 + 0.6 * t - f**0.5:.2f}"
        for t in (4, 12, 20, 35)
        for f in (0.1, 1, 10)
    ]
    other.write_text("specimen,T (C),f (Hz),E (MPa),phi (deg)\n" + "\n".join(rows), encoding="utf-8")
    drop(page, other, field="#others")
    until(page, "document.getElementById('full').src.endsWith('comparison.html')")
    look(page, "compared", 1280, dark=False)
    assert "both mixes" in page.evaluate("document.getElementById('take').textContent")


def matrices(path):
    """|E*| and phase over temperature and frequency, in words that the reader does not know."""
    book = openpyxl.Workbook()
    for specimen in "AB":
        sheet = book.create_sheet(specimen)
        for name, unit, scale in (("Kompleksimoduuli", "MPa", 1e3), ("Vaihekulma", "°", 1.0)):
            sheet.append([f"{name} ({unit})"])
            sheet.append(["Lämpötila (°C)", *(f"{f} Hz" for f in (0.1, 1, 10))])
            for t in (4, 12, 20, 35):
                sheet.append(
                    [t, *(round(scale * (15 - 0.3 * t + n + (specimen == "B")), 1) for n in (0, 1, 2))]
                )
            sheet.append([])
    book.save(path)
    return path


def test_words_of_a_layout_are_said_in_menus(page, address, tmp_path):
    page.open(address, 1280)
    drop(page, matrices(tmp_path / "t.xlsx"))
    until(page, "!document.getElementById('error').hidden")
    for name, quantity in (
        ("Lämpötila", "temperature_C"),
        ("Kompleksimoduuli", "E_MPa"),
        ("Vaihekulma", "phase_deg"),
    ):
        row = f"[...document.querySelectorAll('#columns tr')].find(r => r.textContent.startsWith('{name}'))"
        until(page, f"Boolean({row})")
        choose(page, f"{row}.querySelector('select')", quantity)
        until(page, "document.getElementById('reading').hidden")
    until(page, "!document.getElementById('go').hidden")
    assert "24 tests of 2 specimens (A, B)" in page.evaluate("document.getElementById('what').textContent")


def test_two_tabs_diagnose_at_once_and_keep_their_own_answers(page, address, tmp_path):
    tabs = {}
    for name, stiffer in (("soft", 1.0), ("stiff", 1.5)):
        if tabs:
            page._session = None  # to open a second tab of the same browser
            page._attach(page.call("Target.createTarget", url="about:blank")["targetId"])
            connect(page)
        tabs[name] = page._session
        page.open(address, 1280)
        drop(page, workbook(tmp_path / f"{name}.xlsx", "|E*| [GPa]", stiffer))
        until(page, "document.getElementById('go').offsetParent !== null")
    for page._session in tabs.values():
        page.evaluate("document.getElementById('go').click()")
    states = [None]
    while None in states:  # a click has not come to the server yet
        states = []
        for page._session in tabs.values():
            states.append(page.evaluate("fetch('job').then(answer => answer.json()).then(job => job.state)"))
    assert states == ["running", "running"]
    values = {}
    for name, page._session in tabs.items():
        until(page, "!document.getElementById('result').hidden")
        page.load("Page.reload")
        until(page, "document.getElementById('result')?.hidden === false")
        assert f"in {name}.xlsx" in page.evaluate("document.getElementById('what').textContent")
        shown = page.evaluate("document.getElementById('value').textContent")
        values[name] = float(re.search(r"Hz: (\d+) MPa", shown)[1])
        assert (
            f"tests from {name}.xlsx"
            in PdfReader(io.BytesIO(taken(page, "report.pdf"))).pages[0].extract_text()
        )
    assert values["stiff"] == pytest.approx(1.5 * values["soft"], rel=0.03)


def taken(page, name):
    """A file that the page offers."""
    (link,) = page.evaluate(
        f"[...document.querySelectorAll('#take a')].map(a => a.href).filter(a => a.includes('{name}'))"
    )
    with urllib.request.urlopen(link) as answer:
        return answer.read()


def test_from_drop_to_download(page, address, tmp_path):
    page.open(address, 1280)
    drop(page, workbook(tmp_path / "t.xlsx"))
    until(page, "!document.getElementById('error').hidden")
    assert "'Result' is not known" in page.evaluate("document.getElementById('error').textContent")
    row = "[...document.querySelectorAll('#columns tr')].find(r => r.textContent.startsWith('Result [GPa]'))"
    choose(page, f"{row}.querySelector('select')", "E_GPa")
    until(page, "!document.getElementById('go').hidden && document.getElementById('error').hidden")
    assert page.evaluate(f"{row}.cells[2].textContent") == "E in GPa, as you chose"
    assert (
        page.evaluate("document.getElementById('what').textContent")
        == "60 tests of 3 specimens (A, B, C) in t.xlsx"
    )
    choose(page, "document.getElementById('kind')", "tension-compression")
    until(page, "!document.getElementById('notes').textContent.includes('is not said')")
    for width in (1280, 390):
        look(page, "read", width, dark=width == 390)
    page.evaluate("document.getElementById('go').click()")
    until(page, "!document.getElementById('result').hidden")
    files = page.evaluate("[...document.querySelectorAll('#take a')].map(a => a.href)")
    names = {one.rpartition("/")[2].partition("?")[0] for one in files}
    assert {"report.pdf", "corrected.xlsx", "corrected.csv", "diagnosis.html", "law.json"} <= names
    assert taken(page, "report.pdf").startswith(b"%PDF-")
    assert {"law_abaqus.inp", "law_ansys.inp", "law_comsol.txt", "law_mepdg.csv", "law_xlsx.xlsx"} <= names
    for width in (1280, 390):
        for dark in (False, True):
            sized(page, width, dark)
            page.load("Page.reload")  # keeps the answer
            until(page, "document.getElementById('result')?.hidden === false")
            look(page, "result", width, dark)
    assert page.evaluate("document.title") == "asphalt-nscd"  # HTML in cells stayed text
    assert "MPa" in page.evaluate("document.getElementById('value').textContent")
    desk = page.evaluate("location.href")
    compared(page, tmp_path)
    page.open(f"{desk}results/diagnosis.html", 1280)
    assert page.evaluate("document.querySelector('svg').getBoundingClientRect().bottom") < 900
    one = "[...document.querySelectorAll('[data-test]')].find(c => c.dataset.test === 'B|12|5')"
    page.evaluate(f"{one}.querySelector('path, use').dispatchEvent(new Event('click', {{bubbles: true}}))")
    marked = page.evaluate("[...document.querySelectorAll('.on')].map(m => m.dataset.test)")
    # Two master curves, two plots of specimens, the specimen's map; and the condition in four maps.
    assert sorted(marked) == ["B|12|5"] * 5 + ["|12|5"] * 4
