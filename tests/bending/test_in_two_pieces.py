"""A specimen that breaks in two ends its test with one sentence."""

from __future__ import annotations

import numpy as np
import pytest
from theory.specimens import QUICK_LAW

from asphalt_nscd.bending import runs
from asphalt_nscd.bending.bending_test import run_test
from asphalt_nscd.bending.case import LoadCase, RunOptions
from asphalt_nscd.bending.condensing import condensed
from asphalt_nscd.bending.model import Model, model_of
from asphalt_nscd.bending.rig import Rig
from asphalt_nscd.bending.settings import Bonds, Numerics
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.store import Record
from asphalt_nscd.measurements.fourpoint import Beam
from asphalt_nscd.measurements.twopoint import Geometry
from asphalt_nscd.nscd.bonds.head import HeadDevices
from asphalt_nscd.nscd.stepping.condensed import CondensedState


def model(make_beam, test: str = Geometry.test, **bonds: float) -> Model:
    area = "facets" if test == Beam.test else "paper"
    return model_of(
        Record(*condensed(make_beam(test=test, area=area), "beam", Bonds(**bonds), stand_by=0), "")
    )


@pytest.mark.parametrize(("test", "share"), [(Geometry.test, 0.5), (Beam.test, 0.5), (Beam.test, 0.15)])
def test_all_bonds_across_a_section_and_no_fewer_part_it(make_beam, test, share):
    beam = model(make_beam, test)
    plates = np.array([plate.height for plate in beam.geometry.plates])
    height = np.concatenate([beam.sphere_height, plates])
    below = height < share * beam.geometry.h
    across = np.flatnonzero(below[beam.shape["first"]] != below[beam.shape["second"]]).tolist()
    beam.require_whole([])
    beam.require_whole(across[1:])
    with pytest.raises(
        InputError, match=rf"beam: the specimen is in two pieces, {len(across)} of .*lower the"
    ):
        beam.require_whole(across)


def test_a_test_ends_once_a_fifth_of_the_bonds_broke_though_it_is_whole(make_beam):
    beam = model(make_beam, Beam.test)
    full = runs._full_stepper(
        beam, QUICK_LAW, 5e-4, CondensedState.rest_state(beam.system, QUICK_LAW), HeadDevices(), RunOptions()
    )
    every_sixth = list(range(0, beam.bonds, 6))
    full.on_break(every_sixth)
    more = sorted({*every_sixth, *range(1, beam.bonds, 12)})
    beam.require_whole(more)
    with pytest.raises(InputError, match=rf"the specimen fails, {len(more)} of {beam.bonds} bonds broke"):
        full.on_break(more)
    tenth = beam.bonds // 10
    full.on_contact(range(tenth))
    with pytest.raises(InputError, match=rf"is crushed, {tenth + 1} gaps of {beam.bonds} closed"):
        full.on_contact(range(tenth + 1))


@pytest.mark.parametrize("method", ["reduced", "condensed"])
@pytest.mark.parametrize("clamp", [0.0, 1e-8])
def test_a_test_that_breaks_all_bonds_ends(make_beam, method, clamp):
    beam = model(make_beam, yield_Pa=7.5)
    case = LoadCase(40.0, 2e-5, cycles=1.0, rig=Rig(clamp_compliance=clamp))
    with pytest.raises(InputError, match="in two pieces|the specimen fails"):
        run_test(beam, QUICK_LAW, case, Numerics(time_step=5e-4, method=method))


def test_a_record_ends_with_the_step_before_the_specimen_parts(make_beam, monkeypatch):
    """By the compiled kernel of the reduced form, which does not look for pieces, and by steps one by one."""
    beam = model_of(
        Record(*condensed(make_beam(shape=(2, 2, 9)), "beam", Bonds(yield_Pa=3e4), stand_by=0), "")
    )

    def tried(method: str, **options: bool) -> Record:
        numerics, case = Numerics(1e-4, 0, method), LoadCase(40.0, 2e-5, 1.0)
        return run_test(beam, QUICK_LAW, case, numerics, RunOptions(**options))

    whole = tried("condensed")
    monkeypatch.setattr(Model, "is_whole", lambda self, broken: len(broken) < 4)
    for method, energy in (("reduced", False), ("reduced", True), ("condensed", False)):
        record = tried(method, energy=energy, keeps_record=True)
        steps = record.force.size
        assert 0 < steps < 250 and "beam: the specimen is in two pieces, 4 of 80 bonds broke" in record.ended
        assert record.time.size == record.displacement.size == steps and record.broken == whole.broken[:4]
        np.testing.assert_allclose(record.force, whole.force[:steps], rtol=0, atol=1e-6 * whole.force.max())
        with pytest.raises(InputError, match="in two pieces"):
            tried(method, energy=energy)
