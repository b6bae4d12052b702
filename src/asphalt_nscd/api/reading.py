"""One reader for everything: measurements, laws, diagnoses, result files."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pandas as pd

from asphalt_nscd.api.arguments import checked
from asphalt_nscd.api.diagnosis import Diagnosis
from asphalt_nscd.api.laws import Law
from asphalt_nscd.api.tables import Measurements, campaign_in
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.store import kind_of, read_json
from asphalt_nscd.table_import.frames import frame_of

if TYPE_CHECKING:  # they need the compiler of the core, which a reader of tables need not have
    from asphalt_nscd.api.bending import Test
    from asphalt_nscd.api.ramp import Failure
    from asphalt_nscd.api.specimens import Packing, Specimen


@checked
def read(
    source: Measurements,
    *,
    sheet: str | None = None,
    columns: Mapping[str, str] | None = None,
    measured_in: str | None = None,
    mix: str | None = None,
) -> pd.DataFrame | Law | Diagnosis | Packing | Specimen | Test | Failure:
    """Read what a file, a folder or a DataFrame holds.

    * Measurements (CSV, TSV, workbooks, exports of testing machines, or a folder of them, or a DataFrame with columns
      that are named so): a DataFrame with one row for each test: specimen, temperature_C, frequency_Hz, E_MPa and
      phase_deg (or F0_N, z0_m and psi_deg), and what else the machine gave. `attrs["notes"]` says how it was read.
    * A folder with a diagnosis.json, or that file: a Diagnosis.
    * A law (JSON): a Law.
    * A result file of the simulation (HDF5): a Packing, a Specimen, a Test or a Failure.

    Parameters
    ----------
    source : path, folder, several of them, or DataFrame
        What is read.
    sheet : str, optional
        Of a workbook; else every sheet that holds tests.
    columns : mapping, optional
        What a column holds where its name does not say it, {"E_GPa": "Steifigkeit"}.
    measured_in : str, optional
        "bending", "tension-compression", "four-point bending" or "indirect tension"; else what the files say.
    mix : str, optional
        The only one to read of files with a column of mixes.

    Returns
    -------
    DataFrame, Law, Diagnosis, Packing, Specimen, Test or Failure
        By what the source holds, as above.

    Raises
    ------
    InputError
        With one sentence that names file, row and mend.

    Examples
    --------
    >>> table = read("data/tutorial/exports")
    >>> len(table), table.attrs["test_type"]
    (72, 'tension-compression')
    >>> print(table[["specimen", "temperature_C", "frequency_Hz", "E_MPa", "phase_deg"]].head(2))
      specimen  temperature_C  frequency_Hz    E_MPa  phase_deg
    0    Mix-A           20.0          25.0  11336.0      24.12
    1    Mix-A           20.1          10.0   9315.0      23.09
    """
    if isinstance(source, str | Path):
        path = Path(source)
        if path.is_dir() and (path / "diagnosis.json").is_file():
            return Diagnosis.read(path)
        if path.suffix.lower() in (".h5", ".hdf5"):
            from asphalt_nscd.api.bending import Test
            from asphalt_nscd.api.ramp import Failure
            from asphalt_nscd.api.specimens import Packing, Specimen

            kinds = {result.kind: result for result in (Packing, Specimen, Test, Failure)}
            kind = kind_of(path)
            if kind not in kinds:
                raise InputError(f"{path}: holds {kind!r}; give a file with one of {', '.join(kinds)}.")
            return kinds[kind].read(path)
        if path.suffix.lower() == ".json":
            content: Any = read_json(path)
            # Only a diagnosis has one; everything else in JSON is taken for a law, and refused if it is none.
            if isinstance(content, dict) and "schema_version" in content:
                return Diagnosis.read(path.parent)
            return Law(content, path)
    return frame_of(campaign_in(source, sheet, columns, measured_in, mix))
