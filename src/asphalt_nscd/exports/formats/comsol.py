"""COMSOL: the branches of a generalised Maxwell model, as its table loads them, under a readme.

Three columns without heading: branch number, shear modulus, relaxation time. The readme, in lines that
begin with %, holds what is entered by hand: the elastic parent material and the shift.
"""

from __future__ import annotations

from pathlib import Path

from asphalt_nscd.exports.card import write_card
from asphalt_nscd.exports.law import ExportedLaw
from asphalt_nscd.exports.settings import ExportSettings

ENDINGS = (".txt",)


def write(law: ExportedLaw, settings: ExportSettings, path: Path) -> str:
    """Write the law as a table with a readme; a line on it."""
    return write_card(law, settings, path, "comsol.j2", solid=True)
