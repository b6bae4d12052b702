"""The rule graph as a picture: `snakemake --rulegraph` on standard input, drawn without graphviz.

snakemake rule_graph --cores 1
"""

from __future__ import annotations

import re
import sys
from pathlib import Path

import matplotlib as mpl
from matplotlib.figure import Figure
from matplotlib.patches import FancyArrowPatch

# Rules of one kind are one box, else half of them would be figures and pages.
TABLES = r"table\d|samples|preparation|ladder|fracture|families|audit|smoothness|ensemble|time_steps|levels"
KINDS = [
    (rf"fig\w+|{TABLES}", "figures and tables"),
    (r"export_\w+", "export_abaqus, ..."),
    (r"(draw|reduce|diagnose)_family", "draw_, reduce_,\ndiagnose_family"),
    (r"\w+_page|pages|report|workflow_report|timings|provenance", "pages, report"),
    (r"simulate_(packed\w*|blocked|pascal)", "simulate_packed,\n_blocked, _pascal"),
    (r"(trim|condense)_facets", "trim_facets,\ncondense_facets"),
    (r"(trim|condense)_(part|likely)", "trim_part, _likely,\ncondense_part, ..."),
    (r"simulate_(step|part|sweeps)", "simulate_step,\n_part, _sweeps"),
    (r"simulate_likely|likely_simulations", "simulate_likely"),
    (r"packing|readings", "packing, readings"),
    (r"deposit_loose", "deposit"),
    (r"(published|pascal)_law", "published_law"),
]
LEFT_OUT = {"all", "compile", "study"}  # which every other rule leads to or comes from
COLOURS = {"figures and tables": "#d9ead3", "pages, report": "#fce5cd"}
PASSES = 20  # over the layers, in which boxes move to the middle of their neighbours
WIDTH, HEIGHT = 1.55, 0.62  # inches for each box


def edges_of(dot: str) -> set[tuple[str, str]]:
    """(before, after) of each arrow between boxes."""
    label = dict(re.findall(r'^\s*(\d+)\[label = "(\w+)', dot, re.MULTILINE))
    pairs = re.findall(r"^\s*(\d+) -> (\d+)", dot, re.MULTILINE)
    named = {(_box(label[first]), _box(label[second])) for first, second in pairs}
    named = {edge for edge in named if edge[0] != edge[1] and LEFT_OUT.isdisjoint(edge)}
    if not named:
        raise SystemExit("error: no arrows on standard input; pipe `snakemake --rulegraph` into this.")
    return _reduced(named)


def _box(rule: str) -> str:
    return next((name for pattern, name in KINDS if re.fullmatch(pattern, rule)), rule)


def _reduced(edges: set[tuple[str, str]]) -> set[tuple[str, str]]:
    """Without arrows that a longer way says already."""

    def reached(start: str, left_out: tuple[str, str]) -> set[str]:
        found, waiting = set(), [start]
        while waiting:
            here = waiting.pop()
            after = {b for a, b in edges if a == here and (a, b) != left_out} - found
            found |= after
            waiting += after
        return found

    return {edge for edge in edges if edge[1] not in reached(edge[0], edge)}


def places(edges: set[tuple[str, str]]) -> dict[str, tuple[float, int]]:
    """(column, layer from the top) of each box: below all that it is made from."""
    boxes = sorted({box for edge in edges for box in edge})
    layer = dict.fromkeys(boxes, 0)
    for _ in boxes:
        for first, second in edges:
            layer[second] = max(layer[second], layer[first] + 1)
    layers = [[box for box in boxes if layer[box] == number] for number in range(max(layer.values()) + 1)]
    column = {box: place - (len(row) - 1) / 2 for row in layers for place, box in enumerate(row)}
    for _ in range(PASSES):
        for row in layers:
            near = {box: [column[b if a == box else a] for a, b in edges if box in (a, b)] for box in row}
            row.sort(key=lambda box: sum(near[box]) / len(near[box]))  # noqa: B023
            column |= {box: place - (len(row) - 1) / 2 for place, box in enumerate(row)}
    return {box: (column[box], layer[box]) for box in boxes}


def draw(edges: set[tuple[str, str]]) -> Figure:
    """Layers from top to bottom."""
    place = places(edges)
    columns, layers = [x for x, _ in place.values()], max(y for _, y in place.values()) + 1
    figure = Figure(figsize=(WIDTH * (max(columns) - min(columns) + 1.2), HEIGHT * layers))
    axes = figure.add_axes((0, 0, 1, 1))
    axes.axis("off")
    axes.set(xlim=(min(columns) - 0.6, max(columns) + 0.6), ylim=(layers - 0.5, -0.5))
    for first, second in sorted(edges):
        (x, y), (u, v) = place[first], place[second]
        arrow = {"arrowstyle": "-|>", "mutation_scale": 7, "color": "0.6", "lw": 0.8}
        axes.add_patch(FancyArrowPatch((x, y + 0.2), (u, v - 0.2), **arrow))
    for box, (x, y) in place.items():
        style = {"boxstyle": "round,pad=0.3", "fc": COLOURS.get(box, "white"), "ec": "0.3", "lw": 0.8}
        axes.text(x, y, box, ha="center", va="center", fontsize=7, bbox=style)
    return figure


if __name__ == "__main__":
    mpl.rcParams |= {"svg.fonttype": "none", "svg.hashsalt": "rules"}
    draw(edges_of(sys.stdin.read())).savefig(Path(sys.argv[1]), metadata={"Date": None})
