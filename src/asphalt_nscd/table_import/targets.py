"""The temperature that a machine's export was tested at: its header, names that say one and the readings decide."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.measurements.campaign import OFF_TARGET
from asphalt_nscd.table_import.cells import Row
from asphalt_nscd.table_import.names import celsius, specimen_of

FAR = 3.0  # K between two targets, or a name and the readings
# K between a target and the readings, above which nobody can go on without an answer. Between OFF_TARGET, which T 378
# allows, and this the readings are believed, and the tests are to be checked first. Where the readings are wrong, as in
# the tutorial's exports with one file recorded too warm, 0.8 K changes no name and 0.9 K may.
OFF = 2.0
COLDEST = 30.0  # K below zero, further than mixes are tested; a hyphen before more is no minus
_NUMBER = re.compile(r"[-−]?\d+(?:[.,]\d+)?")


@dataclass(frozen=True)
class Header:
    """The target temperature in the header of an export, in `unit` "C", "F" or "K"."""

    text: str
    unit: str
    column: str

    @property
    def value(self) -> float:
        """The temperature [degC]."""
        return celsius(self.text, self.unit)


@dataclass(frozen=True)
class Target:
    """The target temperature taken; `contested` is what a name or the header says beside it [degC]."""

    text: str
    column: str
    contested: str = ""


def median_reading(rows: Sequence[Row], place: int | None, unit: str | None) -> float | None:
    """The median temperature measured [degC]; None if a cell is no number, or no unit is known."""
    unit = (unit or "")[-1:]
    if place is None or unit not in ("C", "F", "K"):
        return None
    texts = [row[place] for _, row in rows]
    if not texts or not all(_NUMBER.fullmatch(text) for text in texts):
        return None  # refused further on
    measured = sorted(celsius(text.replace("−", "-"), unit) for text in texts)
    # A median, which one wrong reading does not move.
    return measured[len(measured) // 2]


def decided(
    path: Path, header: Header | None, names: Sequence[str], measured: float | None, notes: list[str]
) -> Target | None:
    """The target of an export; a name or a header that is far from the readings gives way to the other.

    `measured` is the middle reading [degC]; appends to `notes`. None if there is neither a target nor a name that must
    stand for one. Refused where no reading decides between two that are far apart, or the reading fits neither.
    """
    if header is None:
        return _headerless_target(path, names, measured, notes)
    other = _contradicting(path, header, names)
    if other is None:
        if measured is not None and abs(measured - header.value) > OFF:
            named = any(specimen_of(text, header.value).temperature for text in names)
            raise InputError(
                f"{path}: the target temperature is {header.text} {_unit(header)}{', as the name says,' * named} and "
                f"{measured:.3g} degC was measured: which is right? If the measured one, write it as the target"
                f"{' and into the name' * named}; if the target, leave the cells of the readings empty. If nobody "
                f"knows, leave the file out and repeat its tests: AASHTO T 378 allows {OFF_TARGET:g} K."
            )
        return Target(header.text, header.column)
    text, said = other
    both = f"the name {text!r} says {said} degC and the header {header.text} {_unit(header)}"
    # Read by its header with a note alone, a K10_21C whose header said 4 gave a phase offset that was not there.
    if measured is None and abs(float(said) - header.value) > FAR:
        raise InputError(
            f"{path}: {both}, and no measured temperature decides between them; rename the file and its specimen, or "
            "correct the header."
        )
    if measured is None:
        notes.append(f"{both}; the header is taken")
        return Target(header.text, header.column)
    of_name, of_header = abs(measured - float(said)), abs(measured - header.value)
    if min(of_name, of_header) > OFF:
        raise InputError(
            f"{path}: {both}, but {measured:.3g} degC was measured; correct the name and the header, or leave the "
            "file out."
        )
    if of_header <= of_name:
        notes.append(f"{both}; {measured:.3g} degC was measured, so the header is taken")
        return Target(header.text, header.column, said)
    notes.append(f"{both}; {measured:.3g} degC was measured, so the name is taken")
    return Target(said, "target temperature (°C)", f"{header.value:.4g}")


def _unit(header: Header) -> str:
    return {"C": "degC", "F": "degF"}.get(header.unit, header.unit)


def _headerless_target(
    path: Path, names: Sequence[str], measured: float | None, notes: list[str]
) -> Target | None:
    """The target that names tell where no header does; None where readings stand for it. Refuses names that differ."""
    told = [(text, said) for text in names if (said := specimen_of(text, None).temperature) is not None]
    if measured is not None:
        for text, said in told:
            if specimen_of(text, measured).contradicts and abs(float(said) - measured) > FAR:
                notes.append(
                    f"the name {text!r} says {said} degC; {measured:.3g} degC was measured and is taken"
                )
        return None
    if not told:
        raise InputError(
            f"{path}: no temperature; add a line 'Target test temperature (°C)' above the frequencies."
        )
    told.sort(key=lambda one: specimen_of(one[0], None).hyphened)  # one with a clear sign first
    (text, said), *others = told
    for other, value in others:
        if specimen_of(other, float(said)).contradicts:
            raise InputError(
                f"{path}: the name {text!r} says {said} degC and the name {other!r} {value} degC, and no measured "
                "temperature decides between them; rename the file or its specimen."
            )
    doubtful = specimen_of(text, None).hyphened and abs(float(said)) <= COLDEST
    notes.append(
        f"{said} degC taken from the name {text!r}"
        + f", its hyphen as a separator; if -{said} degC was meant, write that into the header" * doubtful
    )
    return Target(said, "target temperature (°C)")


def _contradicting(path: Path, header: Header, names: Sequence[str]) -> tuple[str, str] | None:
    """The first name that says another temperature than the header, and that temperature [degC]."""
    for text in names:
        name = specimen_of(text, header.value)
        if not name.contradicts or name.temperature is None:
            continue
        # A zero says nothing of its unit.
        fahrenheit = header.unit == "C" and float(header.text.replace(",", ".")) != 0.0
        # A machine set to degF may leave out the unit: `70` in the header, `21C` in the name.
        if fahrenheit and not specimen_of(text, celsius(header.text, "F")).contradicts:
            raise InputError(
                f"{path}: the name {text!r} says {name.temperature} degC and the header {header.text}, which is the "
                "same in degrees Fahrenheit; write the unit (F) behind the temperature in the header."
            )
        return text, name.temperature
    return None
