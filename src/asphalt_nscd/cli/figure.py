from __future__ import annotations

from pathlib import Path

from asphalt_nscd.cli import _data
from asphalt_nscd.cli._options import option, step


@step
def command(
    name: str,
    data: _data.Pairs = _data.PAIRS,
    *,
    output_stem: Path = option("Path without .pdf, .png, .svg."),
) -> None:
    """Draw figure NAME from DATA, each kind=path, as PDF, PNG and SVG."""
    from asphalt_nscd.reporting.figures import SEVERAL
    from asphalt_nscd.reporting.figures.save import save_figure

    module, *of = SEVERAL.get(name, [name])
    drawn = _data.part("reporting.figures", module)
    draw = drawn.figure_of(*of) if of else drawn.draw
    save_figure(_data.made_from(data, draw), output_stem)
