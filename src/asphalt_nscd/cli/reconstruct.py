from __future__ import annotations

from pathlib import Path
from typing import Any

from asphalt_nscd.cli._options import GEOMETRY, OUTPUT, option, step
from asphalt_nscd.rheology.sampling import Sampling


@step
def command(
    laws_table: Path,
    *,
    geometry: Any = GEOMETRY,
    sampling: Sampling,
    law_output: Path | None = option("File for the law behind the table.", None),
    output: Path = OUTPUT,
) -> None:
    """Draw measurements about the smooth law behind a published table of Burgers laws."""
    from asphalt_nscd.rheology.reconstruct import reconstruct_table

    reconstruct_table(laws_table, geometry, output, sampling, law_output)
