"""A law file in the format of another program, and one line on what was written."""

from __future__ import annotations

from pathlib import Path

from asphalt_nscd.exports.formats import FORMATS, format_of
from asphalt_nscd.exports.law import ExportedLaw
from asphalt_nscd.exports.settings import ExportSettings
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.store import atomic_path


def export_law(law: ExportedLaw, settings: ExportSettings, form: str, output: str | Path) -> str:
    """Write a law in one of FORMATS; returns a line on what was written and how well it follows the law."""
    output = Path(output)
    require_form(form, output)
    with atomic_path(output) as path:
        told = format_of(form).write(law, settings, path)
    return f"{output}: {told}"


def require_form(form: str, output: Path) -> None:
    """Refuse an unknown format, and an output whose ending is not of the format."""
    if form == "vtk":
        raise InputError(
            f"format 'vtk' is for spheres and tests (HDF5); give a law one of {', '.join(FORMATS)}."
        )
    if form not in FORMATS:
        raise InputError(f"format {form!r} is not known; give one of {', '.join(FORMATS)}.")
    endings = format_of(form).ENDINGS
    if output.suffix.lower() not in endings:
        raise InputError(
            f"{output}: a file of format {form} ends in {' or '.join(endings)}; rename the output."
        )
