"""Which tables the part `real` of the campaign takes, and which causes it puts into each.

Real tables are the nine NCAT states that are shipped, then those of the folder that the environment variable
ASPHALT_NSCD_TABLES names, and of the folders in it. Tables of cylinders lie in a folder called tension-compression.
Light, since every job of the workflow reads it.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from . import reallike
from .backgrounds import SHIPPED, Background
from .causes import CATALOGUE
from .laws import SHAPES
from .plan import RATIOS, SEED

FOLDER = "ASPHALT_NSCD_TABLES"
# Judged at six times the limit too: channels are what every machine has.
RATIOS_OF = {"phase_offset": (*RATIOS, 6.0), "channel_delay": (*RATIOS, 6.0)}
# A spring in parallel shows only where the static modulus is known; a table of moduli does not say it.
CAUSES = tuple(cause for cause in CATALOGUE if cause != "guide_stiffness")
# With these numbers and the shipped tables the part takes some 700 diagnoses of about a second.
TABLES_OF_A_KIND = 3  # into which causes are put
CAUSES_OF_A_TABLE = 2
BARE_OF_A_KIND = 6  # diagnosed as they are
PARTS = 2  # jobs that share a real table
HIDING, BARE = 2, 16  # drawn tables a job takes: with causes to put in, and as they are


@dataclass(frozen=True)
class Task:
    """One background and the causes to put in. alias: its name in what is published; path: of a real table."""

    alias: str
    kind: str
    causes: tuple[str, ...] = ()
    path: str = ""
    seed: int = 0
    shape: str = ""
    both_signs: bool = False
    counted: bool = True  # whether its untouched diagnosis is a row of its own


def real_tables() -> list[Path]:
    """Tables of moduli that are shipped, then those of the folder, each by name; other files are passed over."""
    folders = [SHIPPED, Path(given)] if (given := os.environ.get(FOLDER)) else [SHIPPED]
    return [path for folder in folders for path in sorted(folder.rglob("*.csv")) if _is_table(path)]


def _is_table(path: Path) -> bool:
    try:
        Background.read(path)
    except (ValueError, OSError):  # also what pandas or the encoding says of machine exports
        return False
    return True


def tasks(seed: int = SEED) -> list[list[Task]]:
    """All tasks, in the groups that are run as jobs."""
    chunks = [[task] for number, path in enumerate(real_tables()) for task in _real(number, path)]
    drawn = list(_real_like(seed))
    first = TABLES_OF_A_KIND * len(reallike.KINDS)
    for part, size in ((drawn[:first], HIDING), (drawn[first:], BARE)):
        chunks += [part[n : n + size] for n in range(0, len(part), size)]
    return chunks


def _real(number: int, path: Path) -> Iterator[Task]:
    """One real table: a shipped one goes by its name, and each cause gets one sign."""
    shipped = path.parent == SHIPPED
    alias = path.stem if shipped else f"real table {number + 1}"
    for part in range(PARTS):
        yield Task(alias, "real", CAUSES[part::PARTS], str(path), number, "", not shipped, part == 0)


def _real_like(seed: int) -> Iterator[Task]:
    """Those into which causes are put, then the bare ones."""
    number = 0
    for turn in range(TABLES_OF_A_KIND + BARE_OF_A_KIND):
        for kind in reallike.KINDS:
            own = int(np.random.SeedSequence([seed, 13, number]).generate_state(1)[0])
            first = CAUSES_OF_A_TABLE * number
            causes = tuple(CAUSES[(first + k) % len(CAUSES)] for k in range(CAUSES_OF_A_TABLE))
            shape = list(SHAPES)[number % len(SHAPES)]
            hiding = turn < TABLES_OF_A_KIND
            yield Task(f"drawn table {number + 1}", kind, causes if hiding else (), "", own, shape)
            number += 1
