"""ANSYS Mechanical APDL: MP,EX and MP,PRXY, TB,PRONY for shear and bulk, TB,SHIFT.

EX is the instantaneous modulus, and relative moduli alpha_i with relaxation times tau_i come six values
to a TBDATA. TB,SHIFT,,,,WLF takes Tr, C1, C2 of log10 A = C1 (T - Tr) / (C2 + T - Tr): A multiplies the
time there, so that it is 1 / a_T and the constants keep their sign.
"""

from __future__ import annotations

from pathlib import Path

from asphalt_nscd.exports.card import Card, Settings, number, write_card
from asphalt_nscd.exports.law import ExportedLaw
from asphalt_nscd.files.errors import InputError

MOST_TERMS = 100
ON_A_LINE = 3  # terms of a TBDATA
MATERIAL = "ASPHALT_MAT"


ENDINGS = (".inp", ".mac", ".dat", ".txt")


def write(law: ExportedLaw, settings: Settings, path: Path) -> str:
    """Write the law as Ansys commands; a line on it."""
    return write_card(law, settings, path, text, solid=True)


def text(card: Card) -> str:
    """The card as commented commands to be read within /PREP7; refuses more Prony terms than Ansys takes."""
    series = card.series
    terms = list(zip(series.weights, series.times, strict=True))
    if len(terms) > MOST_TERMS:
        raise InputError(
            f"{card.law.path}: {len(terms)} Prony terms, ANSYS takes {MOST_TERMS}; allow a larger --error-percent."
        )
    lines = [
        *card.comment("!"),
        "! Read within /PREP7 by /INPUT. In a command snippet of Mechanical write matid for the number:",
        # One place to change, where the model has a material 1 already.
        f"{MATERIAL} = 1",
        f"MP,EX,{MATERIAL},{number(card.settings.units.express(series.instantaneous))}",
        f"MP,PRXY,{MATERIAL},{number(card.poisson)}",
    ]
    # Bulk too: left elastic, it would let Poisson's ratio change with time.
    for part in ("SHEAR", "BULK"):
        lines.append(f"TB,PRONY,{MATERIAL},1,{len(terms)},{part}")
        for first in range(0, len(terms), ON_A_LINE):
            values = [number(value) for term in terms[first : first + ON_A_LINE] for value in term]
            lines.append(f"TBDATA,{2 * first + 1},{','.join(values)}")
    wlf = card.law.wlf()
    if wlf is not None:
        constants = (wlf.reference_temperature, wlf.c1, wlf.c2)
        lines += [
            f"TB,SHIFT,{MATERIAL},1,3,WLF",
            "TBDATA,1," + ",".join(number(value) for value in constants),
        ]
    return "\n".join(lines) + "\n"
