"""Exports whose name and header say two temperatures: their moduli beside those of the other specimens at each."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import exp, log
from statistics import median

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.table_import.several_files import Part
from asphalt_nscd.table_import.targets import FAR

OFF = log(1.3)  # of |E*|, by which specimens of a mix hardly differ
NEARER = 0.5  # of that, at the other temperature


def refuse_mislabelled(parts: Sequence[Part]) -> None:
    """Refuse an export whose moduli belong to the temperature that was not taken for it."""
    for part in parts:
        own = list(_tests(part))
        if not part.block.contested or not own:
            continue
        others = [one for one in parts if set(one.specimens).isdisjoint(part.specimens)]
        taken, contested = own[0][0], float(part.block.contested)
        off, other = _apart(part, others, taken), _apart(part, others, contested)
        if off is not None and other is not None and abs(off) > OFF and abs(other) < NEARER * abs(off):
            raise InputError(
                f"{part.path}: its name and its header say {contested:g} and {taken:g} degC, and the measured "
                f"temperature speaks for {taken:g} degC; but |E*| is {exp(off):.2f} times that of the other specimens "
                f"at {taken:g} degC and {exp(other):.2f} times at {contested:g} degC: correct header, readings or name."
            )


def _tests(part: Part) -> Iterator[tuple[float, float, float]]:
    """Temperature [degC], frequency [Hz] and ln |E*| of each test."""
    table = part.read.table
    target = "nominal_temperature_C" if "nominal_temperature_C" in table.columns else "temperature_C"
    columns = (table.numbers_or_nan(name) for name in (target, "frequency_Hz", "E_MPa"))
    yield from ((t, f, log(modulus)) for t, f, modulus in zip(*columns, strict=True) if modulus > 0.0)


def _apart(part: Part, others: Sequence[Part], at: float) -> float | None:
    """Median ln |E*| of a part over that of the others at a temperature; None if they were not tested there."""
    known: dict[float, list[float]] = {}
    for one in others:
        for t, f, modulus in _tests(one):
            if abs(t - at) <= FAR:
                known.setdefault(f, []).append(modulus)
    apart = [modulus - median(known[f]) for _, f, modulus in _tests(part) if f in known]
    # The median: one odd frequency decides nothing.
    return median(apart) if apart else None
