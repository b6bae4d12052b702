"""What a reader would stumble over in a page: each a sentence."""

from __future__ import annotations

from pathlib import Path
from urllib.parse import unquote, urlsplit

from browser.chromium import Page

WIDTHS = (1280, 390)  # of a desk and of a telephone, px
LEAST_FONT = 11.0  # px
OPEN_ALL = "document.querySelectorAll('details').forEach(one => one.open = true)"
IMAGES = """Promise.all([...document.images].map(async image => {
  await image.decode().catch(() => null);
  if (!image.naturalWidth) return {alt: image.alt, broken: true};
  const canvas = document.createElement('canvas'), n = 64;
  canvas.width = canvas.height = n;
  const context = canvas.getContext('2d');
  context.fillStyle = '#fff'; context.fillRect(0, 0, n, n); context.drawImage(image, 0, 0, n, n);
  const data = context.getImageData(0, 0, n, n).data, edge = [], all = [];
  for (let i = 0; i < n * n; i++) {
    const light = (0.299 * data[4 * i] + 0.587 * data[4 * i + 1] + 0.114 * data[4 * i + 2]) / 255;
    all.push(light);
    const x = i % n, y = (i - x) / n;
    if (x < 2 || y < 2 || x >= n - 2 || y >= n - 2) edge.push(light);
  }
  const mean = values => values.reduce((a, b) => a + b, 0) / values.length;
  const box = image.getBoundingClientRect();
  return {alt: image.alt, mean: mean(all), edge: mean(edge), shown: box.width};
}))"""
FONTS = """(() => {
  const small = [], walk = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  while (walk.nextNode()) {
    const node = walk.currentNode;
    const plot = node.parentElement.ownerSVGElement;
    const scale = plot ? plot.getBoundingClientRect().width / plot.viewBox.baseVal.width : 1;
    const size = scale * parseFloat(getComputedStyle(node.parentElement).fontSize);
    const seen = node.parentElement.getClientRects().length > 0;
    if (node.textContent.trim() && size < LEAST && seen) small.push(node.textContent.trim().slice(0, 40));
  }
  return small;
})()"""
ANCHORS = """[...document.querySelectorAll('a[href]')].map(a => [a.getAttribute('href'),
  a.getAttribute('href').startsWith('#') ? !!document.getElementById(a.getAttribute('href').slice(1)) : null])"""
WIDE = "document.documentElement.scrollWidth"  # a telephone's window grows with what is too wide


def look(page: Page, path: Path, width: int) -> list[str]:
    """All that is wrong with the page at a width: network, console, images, width, letters, links."""
    page.open(path.resolve().as_uri(), width)
    page.evaluate(OPEN_ALL)
    found = _images(page)
    if (over := page.evaluate(WIDE) - width) > 1:
        found.append(f"{over:g} px wider than the window")
    small = page.evaluate(FONTS.replace("LEAST", str(LEAST_FONT)))
    found += [f"small letters: {text!r}" for text in small[:3]]
    found += _links(page, path)
    page.evaluate("new Promise(done => setTimeout(done, 100))")  # what comes late to the console
    return [f"{path.name} at {width} px: {one}" for one in found + told(page)]


def told(page: Page) -> list[str]:
    """Errors in the console, and whatever was asked of a network."""
    found = []
    for event in page.events:
        name, content = event.get("method"), event.get("params", {})
        if name == "Runtime.exceptionThrown":
            found.append(f"exception: {content['exceptionDetails'].get('text')}")
        elif name == "Runtime.consoleAPICalled" and content["type"] in ("error", "assert"):
            found.append(f"console: {[word.get('value') for word in content['args']]}")
        elif name == "Log.entryAdded" and content["entry"]["level"] == "error":
            found.append(f"console: {content['entry']['text']}")
        elif name == "Network.requestWillBeSent":
            address = content["request"]["url"]
            if urlsplit(address).scheme not in ("file", "data", "blob", "about"):
                found.append(f"asks the network for {address}")
    return found


def _images(page: Page) -> list[str]:
    found = []
    for image in page.evaluate(IMAGES):
        if image.get("broken"):
            found.append(f"image {image['alt']!r} does not load")
        elif not image["alt"]:
            found.append("an image has no words for who cannot see it")
        elif image["mean"] < 0.5 or image["edge"] < 0.8:
            found.append(f"image {image['alt']!r} is dark")
        elif image["shown"] < 200:
            found.append(f"image {image['alt']!r} is shown {image['shown']:g} px wide")
    return found


def _links(page: Page, path: Path) -> list[str]:
    found = []
    for address, inside in page.evaluate(ANCHORS):
        parts = urlsplit(address)
        if inside is False:
            found.append(f"link {address} leads nowhere")
        elif inside is None and not parts.scheme and not (path.parent / unquote(parts.path)).exists():
            found.append(f"link {address} leads to no file")
    return found
