"""ANSYS Mechanical APDL: MP,EX and MP,PRXY, TB,PRONY for shear and bulk, TB,SHIFT.

EX is the instantaneous modulus, and relative moduli alpha_i with relaxation times tau_i come six values
to a TBDATA. TB,SHIFT,,,,WLF takes Tr, C1, C2 of log10 A = C1 (T - Tr) / (C2 + T - Tr): A multiplies the
time there, so that it is 1 / a_T and the constants keep their sign.
"""

from __future__ import annotations

from pathlib import Path

from asphalt_nscd.exports.card import make_card, write_card
from asphalt_nscd.exports.law import ExportedLaw
from asphalt_nscd.exports.settings import ExportSettings
from asphalt_nscd.files.errors import InputError

MOST_TERMS = 100
ENDINGS = (".inp", ".mac", ".dat", ".txt")


def write(law: ExportedLaw, settings: ExportSettings, path: Path) -> str:
    """Write the law as Ansys commands to be read within /PREP7; a line on it. Refuses more terms than Ansys takes."""
    terms = len(make_card(law, settings).solid().series.moduli)
    if terms > MOST_TERMS:
        raise InputError(
            f"{law.path}: {terms} Prony terms, ANSYS takes {MOST_TERMS}; allow a larger --error-percent."
        )
    return write_card(law, settings, path, "ansys.j2", solid=True)
