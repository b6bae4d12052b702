"""A table and a figure of ramps to failure, of any number of steps."""

from __future__ import annotations

import numpy as np
import pytest
from theory.specimens import jittered_beam

from asphalt_nscd.bending.condensing import condensed
from asphalt_nscd.bending.further_settings import Ramp
from asphalt_nscd.bending.model import model_of
from asphalt_nscd.bending.ramp import RAMP, ramp
from asphalt_nscd.bending.settings import Bonds
from asphalt_nscd.files.store import Record, save
from asphalt_nscd.reporting.figures import fig_ramp
from asphalt_nscd.reporting.tables import ramps
from asphalt_nscd.rheology.burgers import Burgers

LAW = Burgers(24.3e9, 0.06e9, 48.4e9, 0.077e9)


def test_ramps_stand_beside_each_other(tmp_path):
    specimen = jittered_beam(shape=(2, 2, 7), area="facets")
    beam = model_of(Record(*condensed(specimen, "beam", Bonds(yield_Pa=1e6), stand_by=0), ""))
    files = []
    for steps in (24, 12):
        files.append(tmp_path / f"{steps}.h5")
        save(files[-1], RAMP, *ramp(beam, LAW, Ramp(0.02, steps, displacement_m=8e-5, frames=2)))
    table = ramps.make(files).set_index("steps of")
    assert list(table) == ["1.66667 ms", "0.833333 ms"] and (table.loc["bonds broken in the end"] > 0).all()
    peak, change = table.loc["largest force, N"], table.loc["against twice the step, %"]
    assert np.isnan(change.iloc[0]) and change.iloc[1] == pytest.approx(
        100.0 * (peak.iloc[1] / peak.iloc[0] - 1.0)
    )
    assert table.loc["missed by the account of energy, % of the work"].abs().max() < 1e-6
    curve, bonds, work, place, *_ = fig_ramp.draw(ramp=files).axes
    assert [len(axes.lines) for axes in (curve, bonds, work, place)] == [2, 2, 4, 1]
    assert len(place.lines[0].get_xdata()) == table.loc["bonds broken in the end"].iloc[1]
