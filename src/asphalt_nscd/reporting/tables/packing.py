"""How dense a sample is packed, and what that makes of its modulus."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import pandas as pd

from asphalt_nscd.bending.collect import collect
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.store import load

OF_THE_DEPOSIT = ["friction", "solid_fraction", "layer_height_m", "coordination"]


def make(tests: list[Path], deposits: list[Path], facets: Sequence[Path] = ()) -> pd.DataFrame:
    """Tests on samples with what is known of the deposits that these were cut from, by name.

    tests: with the bonds of the study; facets: the same with bonds that are facets, where that is another mapping.
    """
    layers = {path.stem: load(path, "deposit").attributes for path in deposits}
    table = collect([*tests, *facets])
    if facets:
        table["mapping"] = ["paper"] * len(tests) + ["facets"] * len(facets)
    for specimen in table["specimen"]:
        if specimen not in layers:
            raise InputError(f"no deposit {specimen}.h5 among the deposits; give it too.")
    for name in OF_THE_DEPOSIT:
        table[name] = [layers[specimen][name] for specimen in table["specimen"]]
    return table
