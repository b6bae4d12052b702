"""A specimen pulled until it fails: the curve is kept, the account closes, and steps and methods agree."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from click.testing import CliRunner
from theory.specimens import QUICK_LAW, jittered_beam

import asphalt_nscd as an
from asphalt_nscd.bending.condensing import condensed
from asphalt_nscd.bending.further_settings import Ramp
from asphalt_nscd.bending.model import Model, model_of
from asphalt_nscd.bending.ramp import ramp, told
from asphalt_nscd.bending.settings import Bonds
from asphalt_nscd.bending.taring import tared
from asphalt_nscd.cli import ramp as command
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.store import Record, save
from asphalt_nscd.nscd.stepping.condensed import CondensedState, CondensedStepper
from asphalt_nscd.packings.outgoing import export_result
from asphalt_nscd.rheology.burgers import Burgers
from asphalt_nscd.rheology.laws_io import write_law

QUICK = Burgers(24.3e9, 0.06e9, 48.4e9, 0.077e9)
PULLED = Ramp(duration_s=0.02, steps=80, displacement_m=8e-5)


def content():
    return condensed(jittered_beam(shape=(3, 3, 9), area="facets"), "beam", Bonds(yield_Pa=1e6), stand_by=0)


@pytest.fixture(scope="module")
def beam() -> Model:
    return model_of(Record(*content(), ""))


@pytest.fixture(scope="module")
def pulled(beam):
    return ramp(beam, QUICK, PULLED)


def test_the_record_goes_on_beyond_the_break(beam, pulled):
    arrays, columns = pulled
    assert arrays["force_N"].shape == (80,) and columns["ended"] == ""
    assert 20 <= columns["broken_bonds"] < beam.bonds and "of 399 bonds broke" in told(columns)
    peak = int(np.argmax(np.abs(arrays["force_N"])))
    assert 5 < peak < 20 and abs(arrays["force_N"][-1]) < 0.02 * columns["peak_force_N"]
    at_peak = [columns[name] for name in ("peak_force_N", "displacement_at_peak_m", "broken_at_peak")]
    assert at_peak == [arrays[name][peak] for name in ("force_N", "displacement_m", "broken_bonds")]
    assert columns["in_two"] == (not beam.is_whole(arrays["broken"])) and columns["time_step_s"] == 2.5e-4
    assert f"at {1e6 * at_peak[1]:.4g} um" in told(columns)
    assert "misses 0.2 %" in told({**columns, "energy_error": -0.002})
    assert (np.diff(arrays["broken_bonds"]) >= 0).all() and arrays["broken"].size == columns["broken_bonds"]
    np.testing.assert_allclose(arrays["displacement_m"], np.linspace(1e-6, 8e-5, 80), rtol=1e-12)
    assert abs(columns["energy_error"]) < 1e-9 and columns["residual"] < 1e-6
    assert columns["energy_fracture_J"] > 0.0


def test_the_peak_of_a_push_is_its_most_negative_force(beam, pulled):
    arrays, columns = ramp(beam, QUICK, Ramp(duration_s=2.5e-3, steps=10, displacement_m=-1e-5))
    assert columns["peak_force_N"] == arrays["force_N"].min() < -0.9 * pulled[1]["peak_force_N"]


def test_each_break_is_that_of_an_exact_stepper(beam, pulled):
    """One after another, the most overstressed first, each step solved anew by factors updated for every bond."""
    system = tared(beam).system
    stepper = CondensedStepper(
        system, QUICK_LAW, PULLED.time_step, CondensedState.rest_state(system, QUICK_LAW)
    )
    places = np.linspace(0.0, 8e-5, 81)
    force = [stepper.move(start, end) for start, end in zip(places, places[1:])]
    assert stepper.state.broken == pulled[0]["broken"].tolist()
    np.testing.assert_allclose(pulled[0]["force_N"], force, rtol=0, atol=1e-8 * np.abs(force).max())


def test_the_peak_at_half_the_step(beam, pulled):
    _, finer = ramp(beam, QUICK, Ramp(duration_s=0.02, steps=160, displacement_m=8e-5))
    assert finer["peak_force_N"] == pytest.approx(pulled[1]["peak_force_N"], rel=0.02)


def test_who_states_no_end_pulls_by_twenty_usual_amplitudes(beam):
    strong = replace(beam, system=replace(beam.system, strength=np.full_like(beam.system.strength, np.inf)))
    arrays, columns = ramp(strong, QUICK, Ramp(duration_s=0.02, steps=10))
    usual = beam.geometry.usual_amplitude()
    np.testing.assert_allclose(arrays["displacement_m"], 2.0 * usual * np.arange(1, 11), rtol=1e-12)
    assert columns["broken_bonds"] == 0 and not columns["in_two"]


def test_a_force_that_is_commanded_ends_at_the_break(beam, pulled):
    most = pulled[1]["peak_force_N"]
    arrays, columns = ramp(beam, QUICK, Ramp(duration_s=0.02, steps=80, force_N=2.0 * most))
    steps = arrays["force_N"].size
    assert (
        columns["broken_bonds"] == arrays["broken"].size > arrays["broken_bonds"][-1]
    )  # in the step that did not end
    assert columns["ended"] and columns["ended"] in told(columns) and 20 < steps < 80
    np.testing.assert_allclose(arrays["force_N"], most / 40.0 * np.arange(1, steps + 1), rtol=1e-4)
    assert columns["peak_force_N"] == pytest.approx(most, rel=0.15)
    work = arrays["force_N"] @ np.diff(arrays["displacement_m"], prepend=0.0)
    # on the specimen, not on the soft clamp
    assert columns["energy_actuator_J"] == pytest.approx(work, rel=1e-6)
    assert columns["energy_devices_J"] == 0.0 and abs(columns["energy_error"]) < 1e-9


def test_a_force_goes_on_while_the_specimen_bears_it(beam, pulled):
    """One bond alone can break: springs hold more than moves, and the record is whole."""
    first = int(pulled[0]["broken"][0])
    strength = np.full_like(beam.system.strength, np.inf)
    strength[first] = 0.2 * beam.system.strength[first]
    weak = replace(beam, system=replace(beam.system, strength=strength))
    arrays, columns = ramp(
        weak, QUICK, Ramp(duration_s=0.02, steps=40, force_N=0.5 * pulled[1]["peak_force_N"])
    )
    assert (arrays["broken"].tolist(), arrays["force_N"].size, columns["ended"]) == ([first], 40, "")


def test_by_command_and_in_files(tmp_path):
    save(tmp_path / "model.h5", "model", *content())
    write_law(tmp_path / "law.json", QUICK, source="stated", temperature=15.0)
    output = tmp_path / "ramp.h5"
    arguments = (
        f"{tmp_path}/model.h5 --law {tmp_path}/law.json --temperature-c 15 --duration-s 0.02 --steps 40"
    )
    done = CliRunner().invoke(
        command.command,
        [*arguments.split(), "--displacement-m", "8e-5", "--frames", "3", "--output", str(output)],
    )
    assert done.exit_code == 0 and "the largest force is" in done.output, done.output
    read = an.read(output)
    assert list(read.history)[:4] == ["time_s", "displacement_m", "force_N", "broken_bonds"]
    export_result(output, "csv", tmp_path / "curve.csv")
    pd.testing.assert_frame_equal(
        pd.read_csv(tmp_path / "curve.csv"), read.history, rtol=1e-9, check_dtype=False
    )
    assert read.arrays["frames/displacement_m"].shape[0] == 3 and read.plot() is not None


@pytest.mark.parametrize(
    ("what", "words"),
    [({"force_N": 1.0, "displacement_m": 1.0}, "give force_N or"), ({"force_N": 0.0}, "nothing")],
)
def test_what_cannot_be_pulled_is_refused(what, words):
    with pytest.raises(InputError, match=f"ramp: {words}"):
        Ramp(**what)
