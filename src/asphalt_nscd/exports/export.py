"""A law file in the format of another program, and one line on what was written."""

from __future__ import annotations

from importlib import import_module
from pathlib import Path

from asphalt_nscd.exports.card import Card, Settings, make_card
from asphalt_nscd.exports.formats import FORMATS, SOLIDS
from asphalt_nscd.exports.law import ExportedLaw
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.store import atomic_path

FAR_OFF = 0.15  # of ln |E*|, root mean square: a law that is no law of these tests


def export_law(law: ExportedLaw, settings: Settings, form: str, output: str | Path) -> str:
    """Write a law in one of FORMATS; returns a line on what was written and how well it follows the law."""
    output = Path(output)
    require_form(form, output)
    # By name: only a workbook loads openpyxl.
    module = import_module(f"asphalt_nscd.exports.{FORMATS[form][0]}")
    if form == "mepdg":
        table = module.make_table(law)
        content, said = module.text(table), module.said(table)
    else:
        card = make_card(law, settings)
        card = card.solid() if form in SOLIDS else card
        if form == "xlsx":
            with atomic_path(output) as path:
                module.write(card, path)
            return f"{output}: {_said(card)}"
        content, said = module.text(card), _said(card)
    with atomic_path(output) as path:
        path.write_text(content, encoding="utf-8")
    return f"{output}: {said}"


def require_form(form: str, output: Path) -> None:
    """Refuse an unknown format, and an output whose ending is not of the format."""
    if form == "vtk":
        raise InputError(
            f"format 'vtk' is for spheres and tests (HDF5); give a law one of {', '.join(FORMATS)}."
        )
    if form not in FORMATS:
        raise InputError(f"format {form!r} is not known; give one of {', '.join(FORMATS)}.")
    endings = FORMATS[form][1]
    if output.suffix.lower() not in endings:
        raise InputError(
            f"{output}: a file of format {form} ends in {' or '.join(endings)}; rename the output."
        )


def _said(card: Card) -> str:
    shift = "" if card.law.shift else ", no shift"
    off = card.law.rms_log_residual or 0.0
    far = (
        f" The law itself misses its tests by {100.0 * off:.0f} %: do not rely on it."
        if off > FAR_OFF
        else ""
    )
    return f"{card.achieved()} over {card.law.band}{shift}; {card.poisson_said()}.{far}"
