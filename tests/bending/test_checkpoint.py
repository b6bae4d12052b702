"""A run stopped at any step goes on to the same bits; a checkpoint of another run is refused."""

from __future__ import annotations

import numpy as np
import pytest

from asphalt_nscd.bending import runs
from asphalt_nscd.bending.bending_test import run_test
from asphalt_nscd.bending.case import LoadCase, Numerics, RunOptions
from asphalt_nscd.bending.checkpoint import Checkpoint
from asphalt_nscd.bending.model import Model
from asphalt_nscd.files.errors import DamagedFile, InputError
from asphalt_nscd.nscd.bonds.implicit_operator import ShiftedOperator
from asphalt_nscd.nscd.stepping.break_modes import StandBy
from asphalt_nscd.nscd.stepping.reduced_model import ritz_basis, shifted_factor
from asphalt_nscd.specimen.system import bending_system


class Stopped(Exception):
    pass


@pytest.fixture(scope="module")
def model(make_beam):
    specimen = make_beam(shape=(4, 3, 8))
    system = bending_system(specimen, 0.35, 2.7e6, 0.7)
    shifted = shifted_factor(system)
    basis = ritz_basis(system, 12, shifted)
    stand_by = StandBy.of(system, basis, shifted)
    return Model(system, basis, specimen.geometry, specimen.position[:, 2], "beam", "free", stand_by)


def run(model, law, method, scheme, checkpoint=None, stop_at=None):
    def progress(done, total):
        if done == stop_at:
            raise Stopped

    options = RunOptions(progress, energy=True, checkpoint=checkpoint)
    return run_test(model, law, LoadCase(40.0, 8e-5, 1.0), Numerics(5e-4, 10, method, scheme), options)


def same_bits(one, other):
    for name in ("time", "displacement", "force", "velocity"):
        assert getattr(one, name).tobytes() == getattr(other, name).tobytes(), name
    assert one.broken == other.broken and one.details == other.details
    np.testing.assert_equal(one.residual, other.residual)


@pytest.mark.parametrize("most_enrichments", [30, 4])
@pytest.mark.parametrize("scheme", ["euler", "fitted"])
@pytest.mark.parametrize("method", ["condensed", "reduced"])
def test_goes_on_bit_for_bit(tmp_path, model, quick_law, method, scheme, most_enrichments, monkeypatch):
    """Stopped twice, before and after bonds broke; with few enrichments also after the full system took over."""
    make = runs._reduced_stepper

    def limited(*arguments):
        stepper = make(*arguments)
        stepper.most_enrichments = most_enrichments
        return stepper

    monkeypatch.setattr(runs, "_reduced_stepper", limited)
    whole = run(model, quick_law, method, scheme)
    assert len(whole.broken) > 5
    if method == "reduced":
        assert (whole.details["full_steps"] > 0) == (most_enrichments == 4)
    checkpoint = Checkpoint(tmp_path / "run.h5", 7, {"run": 1})
    for stop_at in (18, 37, 52):
        with pytest.raises(Stopped):
            run(model, quick_law, method, scheme, checkpoint, stop_at)
        assert checkpoint.resume()["force"].size == stop_at // 7 * 7
    same_bits(run(model, quick_law, method, scheme, checkpoint), whole)


def test_of_another_run_is_refused(tmp_path, model, quick_law):
    checkpoint = Checkpoint(tmp_path / "run.h5", 5, {"frequency_Hz": 40.0})
    with pytest.raises(Stopped):
        run(model, quick_law, "condensed", "euler", checkpoint, 6)
    other = Checkpoint(tmp_path / "run.h5", 5, {"frequency_Hz": 25.0})
    with pytest.raises(InputError, match=r"another run \(frequency_Hz is 40.0 there, 25.0 here\); delete it"):
        run(model, quick_law, "condensed", "euler", other)
    (tmp_path / "run.h5").write_bytes(b"cut")
    with pytest.raises(DamagedFile):
        run(model, quick_law, "condensed", "euler", checkpoint)


def test_columns_stay_columns(tmp_path):
    checkpoint = Checkpoint(tmp_path / "run.h5", 1, {})
    array = np.asfortranarray(np.arange(6.0).reshape(2, 3))
    checkpoint.keep({"by_columns": array, "by_rows": array.copy("C")})
    found = checkpoint.resume()
    assert found["by_columns"].flags.f_contiguous and found["by_rows"].flags.c_contiguous
    np.testing.assert_array_equal(found["by_columns"], array)
    checkpoint.drop()
    assert checkpoint.resume() is None


@pytest.mark.parametrize("together", [2, 7])
def test_removal_of_bonds_depends_on_their_list_alone(beam_system, together, monkeypatch):
    """Removed one by one, or some at a time, with factorisations in between."""
    monkeypatch.setattr(ShiftedOperator, "most_updates", 3)
    broken = [5, 17, 3, 40, 22, 8, 31, 12, 60, 2]
    one, some = (ShiftedOperator(beam_system, 1e-14) for _ in range(2))
    for count in range(1, len(broken) + 1):
        one.remove(broken[:count])
        if count % together == 0 or count == len(broken):
            some.remove(broken[:count])
    force = np.random.default_rng(0).normal(size=beam_system.free.size)
    assert one.solve(force).tobytes() == some.solve(force).tobytes()
    dense = beam_system.stiffness(one.weight).toarray()[np.ix_(beam_system.free, beam_system.free)]
    exact = np.linalg.solve(np.diag(beam_system.mass[beam_system.free]) + 1e-14 * dense, force)
    np.testing.assert_allclose(one.solve(force), exact, rtol=1e-8)
