"""The numerical samples, and how each returns the modulus of the law it is given."""

from __future__ import annotations

from pathlib import Path

import pandas as pd

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.store import load
from asphalt_nscd.measurements.tables import read_tests


def make(simulations: list[Path], deposits: list[Path]) -> pd.DataFrame:
    """One row for each sample. Ratio and phase are those of the tests in which no bond broke.

    packing: file of the packing, where another program poured it.
    """
    tests = read_tests(simulations, numbers=["spheres", "bonds", "broken_bonds"])
    layers = {path.stem: load(path, "deposit").attributes for path in deposits}
    rows = []
    for specimen, of_sample in tests.groupby("specimen"):
        if specimen not in layers:
            raise InputError(f"no deposit {specimen}.h5 among the deposits; give it too.")
        whole = of_sample[of_sample["broken_bonds"] == 0]
        ratio = whole["E_MPa"] / whole["E_law_MPa"]
        apart = (whole["phase_deg"] - whole["phase_law_deg"]).abs()
        layer = layers[specimen]
        rows.append(
            {
                "sample": specimen,
                **({"packing": layer["source"]} if "source" in layer else {}),
                "spheres": int(of_sample["spheres"].iloc[0]),
                "bonds": int(of_sample["bonds"].iloc[0]),
                "solid_fraction": layer["solid_fraction"],
                "E_over_law": ratio.mean(),
                "E_over_law_lowest": ratio.min(),
                "E_over_law_highest": ratio.max(),
                "largest_phase_difference_deg": apart.max(),
                "tests": len(of_sample),
                "tests_with_broken_bonds": len(of_sample) - len(whole),
            }
        )
    return pd.DataFrame(rows)
