"""How one step of a bending test is made and checked, as a picture for docs/stepping.md.

snakemake step_picture --cores 1
"""

from __future__ import annotations

import sys
from html import escape
from pathlib import Path

WIDTH, HEIGHT, ROW = 760, 450, 62
CHECKS = [  # what is looked at, what is done where it fails, and where the step then goes on
    ("coordinates within their envelope?", "widen it, list again the bonds that may yield or close"),
    ("full equations missed by 1e-6 or less?", "enrich the basis by the correction: 4, 8, then 16 vectors"),
    ("all gaps open?", "go on with the full equations, which know contacts"),
    ("all bonds below their strength?", "break the worst; its directions stand by, or are found"),
]
LEFT, RIGHT, BOX, SIDE = 30, 400, 310, 330


def drawn() -> str:
    """The picture, as SVG."""
    parts = [_box(LEFT, 10, BOX, "one step of the reduced equations, 26 coordinates", "#dce6f2")]
    for row, (asked, done) in enumerate(CHECKS):
        top = 10 + ROW * (row + 1) + 12 * (row + 1)
        parts += [
            _arrow(LEFT + BOX / 2, top - 24, LEFT + BOX / 2, top),
            _box(LEFT, top, BOX, asked, "#ffffff"),
            _arrow(LEFT + BOX, top + 25, RIGHT, top + 25, "no"),
            _box(RIGHT, top, SIDE, done, "#fbe9d7"),
        ]
        if row != 2:  # a closed gap leaves the reduced form for good
            parts.append(_line(RIGHT + SIDE, top + 25, RIGHT + SIDE + 14, top + 25))
    end = 10 + ROW * 5 + 12 * 5
    parts += [
        _arrow(LEFT + BOX / 2, end - 24, LEFT + BOX / 2, end),
        _box(LEFT, end, BOX, "accepted; its largest values go into the certificate", "#d9ead3"),
        _line(RIGHT + SIDE + 14, 10 + 25, RIGHT + SIDE + 14, end - 49),
        _arrow(RIGHT + SIDE + 14, 35, LEFT + BOX, 35, "the step is made again"),
    ]
    body = "\n".join(parts)
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" font-family="sans-serif" '
        'font-size="11">\n<defs><marker id="tip" markerWidth="8" markerHeight="8" refX="7" refY="3" orient="auto">'
        '<path d="M0,0 L7,3 L0,6 z"/></marker></defs>\n'
        f'<rect width="{WIDTH}" height="{HEIGHT}" fill="#ffffff"/>\n{body}\n</svg>\n'
    )


def _box(left: float, top: float, width: float, words: str, colour: str) -> str:
    return (
        f'<rect x="{left}" y="{top}" width="{width}" height="50" rx="6" fill="{colour}" stroke="#444"/>'
        f'<text x="{left + width / 2}" y="{top + 29}" text-anchor="middle">{escape(words)}</text>'
    )


def _line(x: float, y: float, to_x: float, to_y: float) -> str:
    return f'<path d="M{x},{y} L{to_x},{to_y}" stroke="#444" fill="none"/>'


def _arrow(x: float, y: float, to_x: float, to_y: float, words: str = "") -> str:
    line = f'<path d="M{x},{y} L{to_x},{to_y}" stroke="#444" fill="none" marker-end="url(#tip)"/>'
    beside = f'<text x="{(x + to_x) / 2}" y="{y - 6}" text-anchor="middle">{escape(words)}</text>'
    return line + beside if words else line


if __name__ == "__main__":
    Path(sys.argv[1]).write_text(drawn(), encoding="utf-8")
