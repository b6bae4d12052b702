from __future__ import annotations

from pathlib import Path

from asphalt_nscd.cli import _data
from asphalt_nscd.cli._options import OUTPUT, option, step


@step
def command(
    data: _data.Pairs = _data.PAIRS, *, title: str = option("Title of the page."), output: Path = OUTPUT
) -> None:
    """Show a diagnosis as an HTML page, from diagnosis=JSON, residuals=CSV, causality=CSV.

    table4=CSV and ladder=CSV, of a study, may be added.
    """
    from asphalt_nscd.files.store import atomic_path
    from asphalt_nscd.reporting.pages.diagnosis_page import render, sections

    content = render(_data.made_from(data, sections), title)
    with atomic_path(output) as path:
        path.write_text(content, encoding="utf-8")
