"""Creep and relaxation, and tests whose force is commanded: against the law, and through files and commands."""

from __future__ import annotations

import numpy as np
import pytest
from click.testing import CliRunner
from theory.specimens import jittered_beam

import asphalt_nscd as an
from asphalt_nscd.bending.bending_test import bond_law, run_test
from asphalt_nscd.bending.case import LoadCase, load_case
from asphalt_nscd.bending.condensing import condensed
from asphalt_nscd.bending.further_settings import Hold
from asphalt_nscd.bending.hold import doubt, hold, told
from asphalt_nscd.bending.model import Model, model_of
from asphalt_nscd.bending.settings import Bonds, Numerics
from asphalt_nscd.cli import simulate as simulate_command
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.store import Record, load, save
from asphalt_nscd.measurements.fourpoint import Beam
from asphalt_nscd.measurements.twopoint import PAPER
from asphalt_nscd.rheology.burgers import Burgers
from asphalt_nscd.rheology.chain import KelvinChain
from asphalt_nscd.rheology.laws_io import write_law
from asphalt_nscd.specimen.prism import static_ratio

QUICK = Burgers(24.3e9, 0.06e9, 48.4e9, 0.077e9)  # transients of milliseconds
CONTENT = condensed(jittered_beam(shape=(3, 2, 13), area="facets", test=Beam.test), "prism", Bonds())


@pytest.fixture(scope="module")
def prism() -> Model:
    return model_of(Record(*CONTENT, ""))


@pytest.mark.parametrize("law", [QUICK, KelvinChain(30e9, np.inf, (40e9, 90e9), (0.05e9, 0.4e9))])
@pytest.mark.parametrize("what", [{"force_N": -0.2}, {"displacement_m": 2e-8}])
def test_the_law_is_found_again_at_all_times(prism, law, what):
    """All bonds have one law, so force over motion is that of the law times a constant, that of statics."""
    table = hold(prism, law, Hold(10e-3, 4000, **what))
    static = static_ratio(prism.system, prism.geometry)
    name = "D_1_GPa" if "force_N" in what else "E_MPa"
    stem, _, unit = name.partition("_")
    found = table[name] / table[f"{stem}_law_{unit}"] * (static if stem == "D" else 1.0 / static)
    late = found[table["time_s"] > 4e-3]  # once the clamps have ceased to swing
    np.testing.assert_allclose(late, 1.0, atol=2e-3)
    if "force_N" in what:
        np.testing.assert_allclose(table["force_N"], -0.2, rtol=1e-5)
        assert (table["displacement_m"] < 0.0).all()
    else:
        assert (table["displacement_m"] == 2e-8).all() and table["force_N"].iloc[-1] > 0.0
    assert table.attrs["broken_bonds"] == 0 and table.attrs["residual"] < 1e-6


def test_the_band_is_where_elements_that_relax_in_these_times_lose_most():
    held = Hold(10.0, 500)
    for hertz, time in zip(held.band, (10.0, 0.02), strict=True):
        lag = 2j * np.pi * time * hertz * np.array([0.99, 1.0, 1.01])
        assert np.argmax((lag / (1.0 + lag)).imag) == 1


def test_steps_too_long_for_the_law_are_told(prism):
    """Implicit Euler relaxes by 1 / (1 + x) a step, the law by exp(-x): far out that is another modulus."""
    fading = KelvinChain(24.3e9, 3.71e9, (), ())  # by 1 / 0.15 s
    for steps, doubtful in ((200, True), (20_000, False)):
        table = hold(prism, fading, Hold(1.5, steps, displacement_m=2e-8))
        off = table.attrs["error_at_end"]
        x = 1.5 / steps * 24.3 / 3.71
        assert off == pytest.approx((1.0 + x) ** -steps * np.exp(steps * x) - 1.0, rel=0.02)
        assert (doubt(table) != "") == doubtful
    assert doubt(hold(prism, fading, Hold(1.5, 20, displacement_m=2e-8))).startswith("hold: at its end E is")


def test_what_breaks_is_told(prism):
    table = hold(prism, QUICK, Hold(1e-3, 20, displacement_m=1e-5))
    assert table.attrs["broken_bonds"] > 0 and "broke" in told(table)
    whole = hold(prism, QUICK, Hold(1e-3, 20, displacement_m=1.5e-8))
    assert table["E_MPa"].iloc[-1] < 0.9 * whole["E_MPa"].iloc[-1]
    usual = hold(prism, QUICK, Hold(1e-3, 10))
    assert (usual["displacement_m"] == prism.geometry.usual_amplitude()).all()
    shown = prism.geometry.form_factor() * usual["force_N"] / usual["displacement_m"] / 1e6
    np.testing.assert_allclose(usual["E_MPa"], shown, rtol=1e-12)
    assert f"after 0.001 s: E = {shown.iloc[-1]:.4g} MPa, law {usual['E_law_MPa'].iloc[-1]:.4g} MPa" in told(
        usual
    )


def test_a_crushed_specimen_is_told_before_its_contacts_are_solved():
    """Hundreds of contacts a step would take minutes."""
    specimen = jittered_beam(shape=(3, 2, 13), area="facets", test=Beam.test)
    strong = model_of(Record(*condensed(specimen, "strong", Bonds(yield_Pa=1e15)), ""))
    assert hold(strong, QUICK, Hold(1e-3, 10, displacement_m=1e-8)).attrs["broken_bonds"] == 0
    with pytest.raises(InputError, match=r"strong: the specimen is crushed, \d+ gaps of \d+ closed; strains"):
        hold(strong, QUICK, Hold(1e-3, 10, displacement_m=1))


def test_a_commanded_force_gives_the_modulus_of_a_commanded_motion(prism):
    numerics = Numerics(1e-2 / 100, 500, scheme="fitted")
    for method in ("reduced", "condensed", "harmonic"):
        scheme = "euler" if method == "harmonic" else "fitted"
        numerics = Numerics(1e-2 / 100, 500, method, scheme)
        ratios = []
        for case in (LoadCase(100.0, 2e-8, 4.0), LoadCase(100.0, 0.2, 4.0, by_force=True)):
            record = run_test(prism, bond_law(QUICK), case, numerics)
            last = slice(-100, None)
            turned = np.exp(-2j * np.pi * 100.0 * record.time[last])
            force, motion = (turned * record.force[last]).sum(), (turned * record.displacement[last]).sum()
            ratios.append(force / motion)
        assert ratios[1] == pytest.approx(ratios[0], rel=2e-3), method
        assert abs(force) / 50.0 == pytest.approx(0.2, rel=1e-5)
        assert not any(name.startswith("energy") for name in record.details)


@pytest.mark.parametrize(
    ("held", "share"),
    [({"force_N": 100.0}, 0.09), ({"force_N": -1e4}, 0.02), ({"displacement_m": 1e-4}, 0.02)],
)
def test_a_load_beyond_the_strength_ends_in_a_sentence_long_before_each_bond_broke(
    prism, held, share, monkeypatch
):
    monkeypatch.setattr("asphalt_nscd.bending.hold.MOST_BROKEN", share)
    with pytest.raises(
        InputError, match=r"prism: the specimen fails, \d+ of 338 bonds broke; lower the load"
    ) as told:
        hold(prism, QUICK, Hold(10e-3, 40, **held))
    broken = int(str(told.value).split("fails, ")[1].split()[0])
    assert share * 338 < broken < 0.1 * 338


def test_a_hold_that_breaks_keeps_its_table(prism):
    """The steps before are those of a hold of the same steps that ends there."""
    table = hold(prism, QUICK, Hold(2e-4, 40, force_N=60.0))
    steps = len(table)
    assert 5 < steps < 40 and table["time_s"].iloc[-1] == pytest.approx(steps * 5e-6)
    told = f"hold: the record ends after {steps * 5e-6:.4g} of 0.0002 s: prism: the specimen fails, "
    assert doubt(table).startswith(told)
    before = hold(prism, QUICK, Hold(10 * 5e-6, 10, force_N=60.0))
    assert before.attrs["ended"] == ""
    np.testing.assert_allclose(table["displacement_m"][:10], before["displacement_m"], rtol=1e-12)


@pytest.mark.parametrize("method", ["reduced", "condensed"])
def test_a_test_that_breaks_writes_its_record_and_no_modulus(prism, common, tmp_path, method):
    output = tmp_path / "test.h5"
    test = f"--frequency-hz 100 --amplitude-n 160 --cycles 2 --time-step-s 1e-4 --rest-steps 10 --method {method}"
    done = CliRunner().invoke(simulate_command.command, [*common, *test.split(), "--output", str(output)])
    assert isinstance(done.exception, InputError)
    kept = an.read(output)
    steps = len(kept.history)
    assert (
        f"15 degC, 100 Hz: the record ends after {steps * 1e-4:.4g} of 0.02 s: prism: the specimen fails, "
        in str(done.exception)
    )
    assert 10 < steps < 50 and np.isnan(kept.E_MPa) and kept.attributes["broken_bonds"] > 60
    sine = 160.0 * np.sin(2e2 * np.pi * kept.history["time_s"])
    np.testing.assert_allclose(kept.history["force_N"], sine, rtol=2e-4)  # the clamp is soft
    assert "the record ends" in repr(kept) and kept.plot() is not None


def test_nonsense_is_refused():
    for wrong, sentence in (
        (
            {"force_N": 1.0, "displacement_m": 1e-6},
            "hold: give force_N or displacement_m",
        ),
        ({"force_N": 0.0}, "hold: nothing moves"),
        ({"duration_s": 0.0}, "duration_s = 0; give a number at least 1e-06"),
        ({"steps": 5}, "steps = 5; give a number at least 10"),
    ):
        with pytest.raises(InputError, match=sentence):
            Hold(**wrong)
    beam = jittered_beam().geometry
    with pytest.raises(InputError, match="give amplitude_m or amplitude_N"):
        load_case(an.Load(amplitude_m=1e-6, amplitude_N=1.0), 10.0, beam)


@pytest.fixture
def common(tmp_path) -> list[str]:
    """What commands on the prism begin with."""
    save(tmp_path / "model.h5", "model", *CONTENT)
    write_law(tmp_path / "law.json", QUICK, source="stated", temperature=15.0)
    return [str(tmp_path / "model.h5"), "--law", str(tmp_path / "law.json"), "--temperature-c", "15"]


def test_a_commanded_force_is_written_with_the_motion_that_it_causes(tmp_path, common, prism):
    test = [*common, "--frequency-hz", "100", "--amplitude-n", "0.2", "--steps-per-cycle", "100"]
    done = CliRunner().invoke(
        simulate_command.command, [*test, "--output", str(tmp_path / "test.h5")], catch_exceptions=False
    )
    assert done.exit_code == 0, done.output
    said = load(tmp_path / "test.h5", "test").attributes
    assert said["amplitude_N"] == 0.2
    assert said["amplitude_m"] == pytest.approx(
        0.2 * prism.geometry.form_factor() / (1e6 * said["E_MPa"]), rel=1e-2
    )
    assert said["phase_deg"] == pytest.approx(said["phase_law_deg"], abs=0.1)
    assert said["time_step_s"] == pytest.approx(1e-4) and said["scheme"] == "fitted"


def test_other_tests_than_the_papers_are_stepped_by_the_fitted_scheme(prism):
    assert Numerics.usual(50.0, PAPER) == Numerics()
    assert Numerics.usual(50.0, prism.geometry) == Numerics(1e-4, scheme="fitted")
