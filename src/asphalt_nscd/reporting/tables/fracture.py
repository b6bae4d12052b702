"""Which bonds break, by either mapping: the yield stress acts on pi rmin^2 or on the facet."""

from __future__ import annotations

from pathlib import Path

import pandas as pd

from asphalt_nscd.measurements.tables import read_tests

COUNTS = ["broken_bonds", "bonds", "largest_utilisation"]


def make(simulations: list[Path], facets: list[Path]) -> pd.DataFrame:
    """One row for each mapping and temperature of the campaigns.

    broken_bonds: in all tests, and in the test that breaks most; largest_utilisation: stress over yield stress in the
    bond that came nearest, an upper bound, of the tests without broken bonds.
    """
    rows = []
    for mapping, paths in (("paper", simulations), ("facets", facets)):
        for temperature, tests in read_tests(paths, COUNTS).groupby("temperature_C"):
            broken = tests["broken_bonds"]
            rows.append(
                {
                    "temperature_C": temperature,
                    "mapping": mapping,
                    "tests": len(tests),
                    "tests_with_broken_bonds": int((broken > 0).sum()),
                    "broken_bonds": int(broken.sum()),
                    "most_broken_bonds": int(broken.max()),
                    # Bonds are of the sample, which several tests share.
                    "bonds_mean": tests.groupby("specimen")["bonds"].first().mean(),
                    "largest_utilisation": tests.loc[broken == 0, "largest_utilisation"].max(),
                }
            )
    return pd.DataFrame(rows).sort_values("temperature_C", kind="stable", ignore_index=True)
