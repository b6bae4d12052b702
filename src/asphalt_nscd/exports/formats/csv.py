"""CSV: the Prony series as a table, under comment lines that say what it is."""

from __future__ import annotations

from pathlib import Path

import pandas as pd

from asphalt_nscd.exports.card import Card, comment, make_card
from asphalt_nscd.exports.law import ExportedLaw
from asphalt_nscd.exports.settings import ExportSettings

ENDINGS = (".csv",)


def write(law: ExportedLaw, settings: ExportSettings, path: Path) -> str:
    """Write the law as a table of branches; a line on it. Lines that begin with # are comment."""
    card = make_card(law, settings)
    table = frame(card).to_csv(index=False, float_format="%.10g", lineterminator="\n")
    path.write_text(f"{comment('#', card.statements())}\n{table}", encoding="utf-8")
    return card.told()


def frame(card: Card) -> pd.DataFrame:
    """The series as a table of one row a branch, half_95 being half of the 95 % interval.

    Row 0 is the long-term modulus, whose relaxation time is infinite.
    """
    series, units = card.series, card.units
    moduli, half = [series.long_term, *series.moduli], card.half_widths
    known = {} if half is None else {f"half_95_{units.stress}": [units.express(one) for one in half]}
    return pd.DataFrame(
        {
            "branch": range(len(moduli)),
            f"modulus_{units.stress}": [units.express(modulus) for modulus in moduli],
            **known,
            # The long-term branch is a spring, which never relaxes.
            "relaxation_time_s": [float("inf"), *series.times],
            "share_of_instantaneous": [modulus / series.instantaneous for modulus in moduli],
        }
    )
