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
from asphalt_nscd.files.store import Record, load, save
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
    runs = [load(path, RAMP) for path in files]
    told, arrays = runs[0].attributes, runs[0].arrays  # of the shorter step
    force, moved = arrays["force_N"], 1e6 * arrays["displacement_m"]
    top = int(force.argmax())
    own = table["0.833333 ms"]
    assert own["largest force, N"] == force[top] and own["displacement there, um"] == pytest.approx(
        moved[top]
    )
    assert own["bonds broken there"] == arrays["broken_bonds"][top]
    assert own["bonds"] == len(specimen.network.first) and own["CPU time, s"] == told["cpu_s"]
    work = np.trapezoid(force, moved) + 0.5 * force[0] * moved[0]  # uJ, of a straight path between steps
    broken = 1e6 * arrays["energy_fracture_J"][-1]
    assert own["taken by breaks, % of the work"] == pytest.approx(100.0 * broken / work, rel=0.1)
    figure = fig_ramp.draw(ramp=files)
    curve, bonds, account, place, *_ = figure.axes
    for number, run in enumerate(runs):
        moved = 1e6 * run.arrays["displacement_m"]
        np.testing.assert_allclose(curve.lines[number].get_data(), [moved, run.arrays["force_N"]])
        np.testing.assert_allclose(bonds.lines[number].get_data(), [moved, run.arrays["broken_bonds"]])
        assert curve.lines[number].get_label() == f"{moved.size} steps"
    for line, name in zip(account.lines, ("springs", "fracture", "dashpots", "numerical"), strict=True):
        assert line.get_label() == name
        np.testing.assert_allclose(
            line.get_data(), [1e6 * arrays["displacement_m"], 1e3 * arrays[f"energy_{name}_J"]]
        )
    points = 1e3 * arrays["frames/point_m"][arrays["broken"]]
    np.testing.assert_allclose(place.lines[0].get_data(), points[:, [0, 2]].T)
    assert [axes.get_xlabel() for axes in (curve, bonds, account)] == 3 * ["displacement (µm)"]
    assert [axes.get_ylabel() for axes in (curve, bonds, account)] == [
        "force (N)",
        "broken bonds",
        "energy (mJ)",
    ]
