"""ABAQUS: a *MATERIAL with *ELASTIC, *VISCOELASTIC, TIME=PRONY and *TRS.

Conventions of the Abaqus Keywords Reference: g_i and k_i are shares of the instantaneous shear and bulk
modulus, followed by tau_i; *TRS, DEFINITION=WLF takes theta_0, C1, C2 of
log10 A = -C1 (theta - theta_0) / (C2 + theta - theta_0), and the reduced time is t / A.
"""

from __future__ import annotations

import re
from pathlib import Path

from asphalt_nscd.exports.card import write_card
from asphalt_nscd.exports.law import ExportedLaw
from asphalt_nscd.exports.settings import ExportSettings
from asphalt_nscd.files.errors import InputError

LONGEST_NAME = 80  # characters of a label
ENDINGS = (".inp",)


def write(law: ExportedLaw, settings: ExportSettings, path: Path) -> str:
    """Write the law as an Abaqus input file; a line on it. Refuses a name that Abaqus does not take."""
    name = settings.name
    # A comma in a keyword line begins the next parameter, and the name comes from the user.
    if not re.fullmatch(r"[A-Za-z][A-Za-z0-9_-]*", name) or len(name) > LONGEST_NAME:
        raise InputError(
            f"material name {name!r}: give at most {LONGEST_NAME} characters, first a letter, then letters, digits, "
            "- and _."
        )
    return write_card(law, settings, path, "abaqus.j2", solid=True)
