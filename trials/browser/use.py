"""What a reader does with a page: sorts and copies tables, points at tests, reads it in the dark, prints it."""

from __future__ import annotations

import re
from base64 import b64decode
from pathlib import Path

from browser.chromium import Page
from browser.look import OPEN_ALL

SCHEMES = ("light", "dark")
MOST_PAGES = 2  # to hand on
LEAST_CONTRAST = 4.5  # of text to what is behind it, WCAG 2.2 AA

CONTRAST = """(() => {
  const parse = colour => (colour.match(/[\\d.]+/g) || []).map(Number);
  const light = ([r, g, b]) => [r, g, b].map(c => c / 255)
    .map(c => c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4)
    .reduce((sum, c, i) => sum + c * [0.2126, 0.7152, 0.0722][i], 0);
  const behind = element => {
    for (let at = element; at; at = at.parentElement) {
      const colour = parse(getComputedStyle(at).backgroundColor);
      if (colour.length === 3 || colour[3] > 0.5) return colour;
    }
    return matchMedia('(prefers-color-scheme: dark)').matches ? [18, 18, 18] : [255, 255, 255];
  };
  const found = [], walk = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  while (walk.nextNode()) {
    const text = walk.currentNode.textContent.trim(), element = walk.currentNode.parentElement;
    if (!text || !element.getClientRects().length || element.closest('svg, title, script, style, .skip')) continue;
    const style = getComputedStyle(element);
    const a = light(parse(style.color)), b = light(behind(element));
    const ratio = (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05);
    if (ratio < LEAST) found.push([text.slice(0, 40), ratio]);
  }
  return found;
})()"""
PAPER = "(getComputedStyle(document.body).backgroundColor.match(/\\d+/g) || [255]).map(Number)[0]"
NAMELESS = """(() => {
  const found = [], say = (what, element) => found.push(`${what}: ${element.outerHTML.slice(0, 60)}`);
  if (!document.documentElement.lang) found.push('the page does not say its language');
  for (const table of document.querySelectorAll('table'))
    if (!(table.caption || table.getAttribute('aria-label'))) say('a table has no name', table);
  for (const one of document.querySelectorAll('button, a[href], summary'))
    if (!(one.textContent.trim() || one.getAttribute('aria-label'))) say('nothing names', one);
  for (const one of document.querySelectorAll('input')) if (!one.labels.length) say('no label', one);
  for (const one of document.querySelectorAll('svg')) if (!one.getAttribute('aria-label')) say('no label', one);
  for (const one of document.querySelectorAll('thead th')) if (one.scope !== 'col') say('a heading of no column', one);
  const seen = new Set();
  for (const one of document.querySelectorAll('[id]')) seen.has(one.id) ? say('a second id', one) : seen.add(one.id);
  let last = 0;
  for (const one of document.querySelectorAll('h1, h2, h3, h4, h5, h6')) {
    const level = Number(one.tagName[1]);
    if (level > last + 1) say(`a heading ${level} below ${last}`, one);
    last = level;
  }
  return found;
})()"""
# The first table with a column of different numbers; what stands in that column.
SORTED = """(() => {
  const one = /^[−-]?\\d+(\\.\\d+)?(e[+-]?\\d+)?$/i;
  const number = text => Number((one.exec(text.trim()) || ['x'])[0].replace('−', '-'));
  const headings = [...document.querySelectorAll('thead th')].map(th => [th.closest('table'), th.cellIndex, th]);
  for (const [table, k, th] of headings) {
    if (!th.querySelector('button')) continue;
    const values = [...table.tBodies[0].rows].map(row => number(row.cells[k].textContent));
    if (values.some(Number.isNaN) || new Set(values).size < 2) continue;
    if (FOCUS) th.querySelector('button').focus();
    return [th.getAttribute('aria-sort'), values];
  }
  return null;
})()"""
COPIED = """(async () => {
  const button = document.querySelector('button.copy');
  if (!button) return null;
  button.click();
  await new Promise(done => setTimeout(done, 300));
  const first = [...document.querySelectorAll('table')].find(one => one.tHead).rows[0].cells.length;
  return [button.textContent, (await navigator.clipboard.readText()).split('\\n')[0].split('\\t').length, first];
})()"""
SAID = "document.querySelectorAll('figure.chart')[N].querySelector('.said').textContent"
TITLE = "document.querySelectorAll('figure.chart')[N].querySelectorAll('title')[K].textContent"
PLACE = """(() => {
  const point = document.querySelectorAll('figure.chart')[N].querySelectorAll('title')[K].parentNode;
  point.scrollIntoView({block: 'center'});
  const box = point.getBoundingClientRect();
  return [box.x + box.width / 2, box.y + box.height / 2];
})()"""

SETTLED = "new Promise(done => setTimeout(done, 150))"  # scrolled and drawn


def use(page: Page, path: Path, width: int) -> list[str]:
    """All that fails when the page, of the project's own, is used at a width."""
    found = []
    for scheme in SCHEMES:
        show(page, path, width, scheme)
        paper = page.evaluate(PAPER)
        if (paper < 128) != (scheme == "dark"):
            found.append(f"the page is not {scheme} where the reader asks for it")
        faint = page.evaluate(CONTRAST.replace("LEAST", str(LEAST_CONTRAST)))
        found += [f"{scheme}: contrast {ratio:.1f} of {text!r}" for text, ratio in faint[:3]]
    found += page.evaluate(NAMELESS)[:3] + _tables(page) + _charts(page)
    pages = len(re.findall(rb"/Type\s*/Page\b", printed(page, path)))
    if pages > MOST_PAGES:
        found.append(f"prints on {pages} pages, not on {MOST_PAGES}")
    return [f"{path.name} at {width} px: {one}" for one in found]


def show(page: Page, path: Path, width: int, scheme: str) -> None:
    """The page with all its parts open, light or dark."""
    set_scheme(page, scheme)
    page.events.clear()
    page.open(path.resolve().as_uri(), width)
    page.evaluate(OPEN_ALL)


def set_scheme(page: Page, scheme: str) -> None:
    """As a reader asks for it."""
    page.call("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": scheme}])


def printed(page: Page, path: Path) -> bytes:
    """PDF of the page as a reader prints it, who has opened nothing."""
    page.events.clear()
    page.open(path.resolve().as_uri(), 1280)
    page.decode_images()
    return b64decode(page.call("Page.printToPDF", preferCSSPageSize=True, printBackground=False)["data"])


def _tables(page: Page) -> list[str]:
    """By keyboard: a column sorts up and down and says so, and a table is copied."""
    found = []
    for way, down in (("ascending", False), ("descending", True)):
        before = page.evaluate(SORTED.replace("FOCUS", "true"))
        if before is None:
            break
        page.press("Enter", 13)
        said, values = page.evaluate(SORTED.replace("FOCUS", "false"))
        if said != way or values != sorted(values, reverse=down):
            found.append(f"a column sorted {way} says {said!r} and reads {values[:5]}")
    page.call("Browser.grantPermissions", permissions=["clipboardReadWrite", "clipboardSanitizedWrite"])
    copied = page.evaluate(COPIED)
    if copied is not None and (copied[0] != "Copied" or copied[1] != copied[2]):
        found.append(f"a copied table of {copied[2]} columns: {copied[0]!r}, {copied[1]} columns")
    return found


def _charts(page: Page) -> list[str]:
    """Each chart says what is under the pointer, and steps through its tests by keyboard."""
    found = []
    for n in range(page.evaluate("document.querySelectorAll('figure.chart').length")):
        of = {"N": str(n)}

        def ask(script: str, k: int, of: dict[str, str] = of) -> object:
            for name, value in (of | {"K": str(k)}).items():
                script = re.sub(rf"\b{name}\b", value, script)
            return page.evaluate(script)

        page.call("Input.dispatchMouseEvent", type="mouseMoved", x=0, y=0)
        ask("document.querySelectorAll('figure.chart')[N].querySelector('svg').focus()", 0)
        page.evaluate(SETTLED)
        page.press("Escape", 27)
        for k, key in enumerate(("ArrowRight", "ArrowRight")):
            page.press(key, 39)
            said, title = ask(SAID, k), ask(TITLE, k)
            if said != title or "°C" not in str(title) or "Hz" not in str(title):
                found.append(f"chart {n + 1}: {key} says {said!r}, not {title!r}")
        ask(PLACE, 3)
        page.evaluate(SETTLED)
        x, y = ask(PLACE, 3)
        page.call("Input.dispatchMouseEvent", type="mouseMoved", x=x, y=y)
        page.evaluate(SETTLED)
        titles = page.evaluate(
            f"[...document.elementsFromPoint({x}, {y})].map(element => "
            "element.closest('svg *:has(> title)')?.querySelector('title').textContent)"
        )
        if ask(SAID, 0) not in [title for title in titles if title]:
            found.append(f"chart {n + 1}: the pointer at {titles[0]!r} says {ask(SAID, 0)!r}")
    return found
