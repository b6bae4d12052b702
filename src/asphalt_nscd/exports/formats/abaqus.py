"""ABAQUS: a *MATERIAL with *ELASTIC, *VISCOELASTIC, TIME=PRONY and *TRS.

Conventions of the Abaqus Keywords Reference: g_i and k_i are shares of the instantaneous shear and bulk
modulus, followed by tau_i; *TRS, DEFINITION=WLF takes theta_0, C1, C2 of
log10 A = -C1 (theta - theta_0) / (C2 + theta - theta_0), and the reduced time is t / A.
"""

from __future__ import annotations

import re
from pathlib import Path

from asphalt_nscd.exports.card import Card, Settings, number, write_card
from asphalt_nscd.exports.law import ExportedLaw
from asphalt_nscd.files.errors import InputError

LONGEST_NAME = 80  # characters of a label


ENDINGS = (".inp",)


def write(law: ExportedLaw, settings: Settings, path: Path) -> str:
    """Write the law as an Abaqus input file; a line on it."""
    return write_card(law, settings, path, text, solid=True)


def text(card: Card) -> str:
    """The card as commented lines of an Abaqus input file; refuses a name that Abaqus does not take."""
    name, series = card.settings.name, card.series
    # A comma in a keyword line begins the next parameter, and the name comes from the user.
    if not re.fullmatch(r"[A-Za-z][A-Za-z0-9_-]*", name) or len(name) > LONGEST_NAME:
        raise InputError(
            f"material name {name!r}: give at most {LONGEST_NAME} characters, first a letter, then letters, digits, "
            "- and _."
        )
    lines = [
        *card.comment("**"),
        f"*MATERIAL, NAME={name}",
        # Said, because the default is the long-term modulus, and the weights are shares of the instantaneous one.
        "*ELASTIC, MODULI=INSTANTANEOUS",
        f"{number(card.settings.units.express(series.instantaneous))}, {number(card.poisson)}",
        "*VISCOELASTIC, TIME=PRONY",
        *(
            # Shear and bulk relax alike, so that Poisson's ratio stays what was stated.
            f"{number(weight)}, {number(weight)}, {number(time)}"
            for weight, time in zip(series.weights, series.times, strict=True)
        ),
    ]
    wlf = card.law.wlf()
    if wlf is not None:
        lines += [
            "*TRS, DEFINITION=WLF",
            ", ".join(number(value) for value in (wlf.reference_temperature, wlf.c1, wlf.c2)),
        ]
    return "\n".join(lines) + "\n"
