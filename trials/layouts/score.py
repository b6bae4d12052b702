"""Whether what was read of a file is what it holds: values, units and which tests belong to one specimen."""

from __future__ import annotations

from pathlib import Path

import numpy as np

import asphalt_nscd as an
from asphalt_nscd.api.tables import observed_in
from layouts.laboratory import Tests

MODULUS = 0.006  # relative, what three digits of GPa of a soft mix leave
PHASE = 0.06  # deg; of E1 and E2 too
TEMPERATURE = 0.06  # K, of a tenth of a degree Fahrenheit


def outcome(
    path: Path, tests: Tests, mix: str | None = None, columns: dict[str, str] | None = None
) -> tuple[str, str]:
    """read, refused or wrong, and why; refused too by what a diagnosis asks of a table before it begins."""
    try:
        table = an.read(path, mix=mix, columns=columns)
        observed_in(table)
    except an.InputError as error:
        return "refused", str(error)
    if len(table) != len(tests.values):
        return "wrong", f"{len(table)} tests in place of {len(tests.values)}"
    partners: dict[str, str] = {}
    for row in table.itertuples():
        same = [
            key
            for key in tests.values
            if abs(key[1] - row.temperature_C) < TEMPERATURE
            and np.isclose(key[2], row.frequency_Hz)
            and abs(tests.values[key][0] / row.E_MPa - 1.0) < MODULUS
            and abs(tests.values[key][1] - row.phase_deg) < PHASE
            and partners.get(str(row.specimen), key[0]) == key[0]
        ]
        if not same:
            return "wrong", f"no test {row}"
        if len(same) == 1:
            partners[str(row.specimen)] = same[0][0]
    if len(set(partners.values())) < len(partners) or len(partners) != len(tests.specimens):
        return "wrong", f"specimens {partners}"
    return "read", ""
