"""COMSOL: the branches of a generalised Maxwell model, as its table loads them, under a readme.

Three columns without heading: branch number, shear modulus, relaxation time. The readme, in lines that
begin with %, holds what is entered by hand: the elastic parent material and the shift.
"""

from __future__ import annotations

from pathlib import Path

from asphalt_nscd.exports.card import Card, Settings, number, write_card
from asphalt_nscd.exports.law import ExportedLaw
from asphalt_nscd.rheology.shift import ZERO_CELSIUS

ENDINGS = (".txt",)


def write(law: ExportedLaw, settings: Settings, path: Path) -> str:
    """Write the law as a table with a readme; a line on it."""
    return write_card(law, settings, path, text, solid=True)


def text(card: Card) -> str:
    """The card as a table with a readme, whose lines begin with %."""
    series, nu, units = card.series, card.poisson, card.settings.units
    shear, bulk = 0.5 / (1.0 + nu), 1.0 / (3.0 * (1.0 - 2.0 * nu))
    stress = f"[{units.stress}]"
    lines = [
        *card.comment("%"),
        "%",
        "% Parameters to enter (Solid Mechanics > Linear Elastic Material, the long-term branch):",
        f"% E_long {number(units.express(series.long_term))}{stress}",
        f"% nu {number(nu)}",
        "% Viscoelasticity > Generalized Maxwell, viscoelastic strains: volumetric and deviatoric.",
        f"% Bulk modulus of each branch: Km = {number(bulk / shear)}*Gm, same relaxation time.",
        "% Bulk strains left elastic would make Poisson's ratio change with time.",
    ]
    wlf = card.law.wlf()
    if wlf is not None:
        lines += [
            "% Thermal effects > Williams-Landel-Ferry, relaxation times times 10^(-C1WLF*(T-Tref)/(C2WLF+T-Tref)):",
            f"% Tref {number(wlf.reference_temperature + ZERO_CELSIUS)}[K]",
            f"% C1WLF {number(wlf.c1)}",
            f"% C2WLF {number(wlf.c2)}[K]",
        ]
    lines.append(f"% Columns: branch, shear modulus Gm {stress}, relaxation time taum [s]")
    lines += [
        f"{branch} {number(units.express(shear * modulus))} {number(time)}"
        for branch, (modulus, time) in enumerate(zip(series.moduli, series.times, strict=True), start=1)
    ]
    return "\n".join(lines) + "\n"
