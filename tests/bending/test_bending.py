"""The bending test from files to a file, on a small beam that was not poured."""

from __future__ import annotations

from dataclasses import replace

import click
import numpy as np
import pytest
from theory.specimens import save_specimen

from asphalt_nscd.bending.bending_test import TestFiles, bond_law, run_test, simulate, unsettled
from asphalt_nscd.bending.case import LoadCase, RunOptions
from asphalt_nscd.bending.condensing import condense
from asphalt_nscd.bending.model import Model, read_model
from asphalt_nscd.bending.settings import Bonds, Numerics
from asphalt_nscd.cli import group
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.store import load
from asphalt_nscd.measurements.signals import harmonic_response, peak_response
from asphalt_nscd.measurements.twopoint import complex_modulus
from asphalt_nscd.nscd.bonds import implicit_operator as shifted
from asphalt_nscd.nscd.stepping.condensed import CondensedState, CondensedStepper
from asphalt_nscd.nscd.stepping.harmonic import driving_force
from asphalt_nscd.rheology.burgers import Burgers
from asphalt_nscd.rheology.laws_io import write_law
from asphalt_nscd.specimen.prism import static_ratio
from asphalt_nscd.specimen.system import bending_system

# 15 degC with viscosities lowered until transients die within two cycles at 40 Hz
LAW = Burgers(24.3e9, 0.06e9, 48.4e9, 0.077e9)
FREQUENCY, DT = 40.0, 1e-4
NONE = np.empty((0, 0))


@pytest.fixture(scope="module")
def folder(tmp_path_factory, beam):
    """A specimen file, its models with free and blocked head, and a law file."""
    folder = tmp_path_factory.mktemp("bending")
    save_specimen(folder / "beam.h5", beam)
    for head in ("free", "blocked"):
        condense(folder / "beam.h5", Bonds(head), folder / f"{head}.h5")
    write_law(folder / "law.json", LAW, source="fitted", temperature=15.0)
    return folder


@pytest.fixture(scope="module")
def model(folder) -> Model:
    return read_model(folder / "free.h5")


def run(model, method="reduced", amplitude=1e-6, cycles=2.0, rest=20, scheme="euler", **options):
    case, numerics = LoadCase(FREQUENCY, amplitude, cycles), Numerics(DT, rest, method, scheme)
    return run_test(model, bond_law(LAW), case, numerics, RunOptions(**options))


def small(cycles=1.0, amplitude=1e-6):
    return LoadCase(FREQUENCY, amplitude, cycles)


def files(folder, output, **others):
    return TestFiles(folder / "free.h5", folder / "law.json", folder / output, **others)


def test_condensing_tells_the_static_modulus(folder, beam, tmp_path, capsys):
    """From the basis, what a solution of the static equations gives."""
    group.main(
        ["condense", f"{folder / 'beam.h5'}", "--output", f"{tmp_path / 'm.h5'}"], standalone_mode=False
    )
    expected = static_ratio(bending_system(beam, 0.35, 2.7e6, 0.7), beam.geometry)
    assert f"static |E*| is {expected:.4g} of the modulus of the bonds" in capsys.readouterr().out
    assert condense(folder / "beam.h5", Bonds(), tmp_path / "m.h5")[1] == pytest.approx(expected, rel=1e-9)


def test_a_specimen_too_large_for_factors(folder, model, monkeypatch, tmp_path):
    """No directions are kept for breaks; the test is the same, broken bonds included."""
    monkeypatch.setattr(shifted, "LARGEST_FACTORED", 100)
    condense(folder / "beam.h5", Bonds(), tmp_path / "large.h5")
    large = read_model(tmp_path / "large.h5")
    assert model.stand_by is not None and large.stand_by is None
    for amplitude, breaks in ((1e-6, False), (4e-5, True)):
        expected, found = (
            run(model, amplitude=amplitude, cycles=1.0),
            run(large, amplitude=amplitude, cycles=1.0),
        )
        assert found.broken == expected.broken and bool(found.broken) == breaks
        np.testing.assert_allclose(
            found.force, expected.force, rtol=0, atol=1e-6 * np.abs(expected.force).max()
        )


def test_a_model_file_holds_the_system_of_its_specimen(folder, beam, model):
    system = bending_system(beam, 0.35, 2.7e6, 0.7)
    for name in ("weight", "mass", "load", "gap", "strength"):
        np.testing.assert_array_equal(getattr(model.system, name), getattr(system, name))
    assert (model.system.operator != system.operator).nnz == 0
    assert (model.system.driven, model.system.friction) == (system.driven, 0.7)
    assert model.geometry == beam.geometry and (model.name, model.head) == ("beam", "free")
    np.testing.assert_array_equal(model.sphere_height, beam.position[:, 2])
    blocked = read_model(folder / "blocked.h5")
    assert blocked.head == "blocked" and blocked.system.mass.size == system.mass.size - 3
    with pytest.raises(InputError, match="expected a model file; found a specimen file"):
        read_model(folder / "beam.h5")


def test_the_law_of_a_bond_is_that_of_the_mix():
    law = bond_law(LAW)
    for omega in (1.0, 250.0):
        assert law.discrete_modulus(omega, 0.0) == pytest.approx(
            complex(LAW.complex_modulus(omega)), rel=1e-14
        )


def test_record_of_a_test(model):
    """Times start after the rest; the head follows A sin(2 pi f t) exactly."""
    record = run(model, cycles=1.5, rest=7)
    assert record.time.size == round(1.5 / FREQUENCY / DT) == record.force.size == record.displacement.size
    np.testing.assert_allclose(record.time, DT * np.arange(1, record.time.size + 1), rtol=1e-14)
    np.testing.assert_allclose(
        record.displacement, 1e-6 * np.sin(2 * np.pi * FREQUENCY * record.time), rtol=1e-12
    )
    assert record.velocity.shape == (record.time.size, model.layers.height.size)


def test_methods_agree(model):
    """Reduced and condensed to 1e-10 at every step; the steady oscillation to the step length, 1e-2;
    Gauss-Seidel stopped after 50 sweeps is far off."""
    reduced, condensed = run(model), run(model, "condensed")
    size = np.abs(condensed.force).max()
    np.testing.assert_allclose(reduced.force, condensed.force, rtol=0, atol=1e-10 * size)
    assert reduced.residual < 1e-6 and reduced.details["full_steps"] == 0 and reduced.broken == []
    steady = run(model, "harmonic")
    force = 1e-6 * driving_force(model.system, complex(LAW.complex_modulus(80 * np.pi)), 80 * np.pi)
    np.testing.assert_allclose(
        steady.force, (force * np.exp(80j * np.pi * steady.time)).imag, atol=1e-9 * abs(force)
    )
    last = slice(-250, None)
    assert np.abs(reduced.force[last] - steady.force[last]).max() < 2e-2 * size
    told = []
    stopped = run(model, "sweeps", progress=lambda *args: told.append(args))
    assert np.abs(stopped.force).max() < 0.7 * size
    assert stopped.details.keys() == {"sweeps", "tolerance", "most_sweeps"}
    said = unsettled({"method": "sweeps", "residual": stopped.residual} | stopped.details)
    assert f"a residual of {stopped.residual:.2g}, where 0.0001 was asked for" in said
    assert unsettled({"method": "sweeps", "residual": 1e-5} | stopped.details) == ""
    assert 25 * 520 < stopped.details["sweeps"] <= 50 * 520
    assert told[-1] == (520, 520)


@pytest.mark.parametrize("method", ["reduced", "condensed"])
def test_a_fitted_scheme_needs_a_hundred_steps_a_cycle(model, method):
    """|E*| within 1e-4 and phase within 0.01 deg of the exact law on the same specimen; bonds break alike."""
    law, case, dt = bond_law(LAW), LoadCase(FREQUENCY, 1e-6, 4.0), 1 / (100 * FREQUENCY)
    moduli = []
    for way in (method, "harmonic"):
        numerics = Numerics(dt, 20, way, "fitted" if way == method else "euler")
        record = run_test(model, law, case, numerics)
        found = harmonic_response(record.time, record.force, record.displacement, FREQUENCY, cycles=2)
        moduli.append(found.force_amplitude * np.exp(1j * found.phase))
    ratio = moduli[0] / moduli[1]
    assert abs(abs(ratio) - 1) < 1e-4 and abs(np.degrees(np.angle(ratio))) < 0.01


@pytest.mark.parametrize("scheme", ["euler", "fitted"])
def test_energy_account_of_a_run(model, scheme):
    """Bonds break, the account closes to 1e-11 by either method, and the two agree."""
    details = [
        run(model, method, amplitude=8e-5, cycles=1.0, scheme=scheme, energy=True).details
        for method in ("reduced", "condensed")
    ]
    assert all(abs(each["energy_error"]) < 1e-11 for each in details)
    for name in ("actuator", "springs", "dashpots", "fracture", "kinetic", "numerical"):
        reduced, condensed = (each[f"energy_{name}_J"] for each in details)
        assert reduced == pytest.approx(condensed, rel=1e-4) and reduced > 0.0


def test_energy_account_where_the_full_system_takes_over(model):
    system = replace(
        model.system, gap=1e-3 * model.system.gap, strength=np.full_like(model.system.strength, np.inf)
    )
    narrow = replace(model, system=system)
    reduced, condensed = (
        run(narrow, method, 3e-5, cycles=0.2, scheme="fitted") for method in ("reduced", "condensed")
    )
    assert 5 < reduced.details["full_steps"] < 45
    assert abs(reduced.details["energy_error"]) < 1e-11 and reduced.details["energy_impact_J"] > 0.0
    np.testing.assert_allclose(
        reduced.force, condensed.force, rtol=0, atol=1e-6 * np.abs(condensed.force).max()
    )


def test_bonds_break_alike(model):
    """Beyond yield by either method: the same bonds, the same forces."""
    reduced, condensed = (
        run(model, method, amplitude=8e-5, cycles=1.0) for method in ("reduced", "condensed")
    )
    assert reduced.broken == condensed.broken != []
    assert reduced.details["enrichments"] > 0 and reduced.details["largest_utilisation"] <= 1.0
    for found, expected in ((reduced.force, condensed.force), (reduced.velocity, condensed.velocity)):
        np.testing.assert_allclose(found, expected, rtol=0, atol=1e-6 * np.abs(expected).max())


@pytest.mark.parametrize("rest", [0, 20])
def test_a_closing_gap_hands_over_to_the_full_system(model, rest):
    """Tiny gaps: the run goes on as the condensed one, says for how long, and is certified to its end."""
    system = replace(
        model.system, gap=1e-3 * model.system.gap, strength=np.full_like(model.system.strength, np.inf)
    )
    narrow = replace(model, system=system)
    reduced, condensed = (
        run(narrow, method, 3e-5, cycles=0.2, rest=rest) for method in ("reduced", "condensed")
    )
    full_steps = reduced.details["full_steps"]
    assert 5 < full_steps < 45
    np.testing.assert_allclose(
        reduced.force, condensed.force, rtol=0, atol=1e-6 * np.abs(condensed.force).max()
    )
    np.testing.assert_allclose(
        reduced.velocity, condensed.velocity, rtol=0, atol=1e-6 * np.abs(condensed.velocity).max()
    )
    assert reduced.details["smallest_gap_m"] <= 0.0
    assert 0.0 < reduced.residual < 1e-6


def test_step_of_the_full_system_that_misses_its_equations_is_refused(model, monkeypatch):
    """As one that was left half solved."""
    system = replace(
        model.system, gap=1e-3 * model.system.gap, strength=np.full_like(model.system.strength, np.inf)
    )
    narrow = replace(model, system=system)
    advance = CondensedStepper.advance

    def spoilt(self, driven_velocity):
        force = advance(self, driven_velocity)
        self.missing[self.system.free[0]] += 1e-3 * abs(force)
        return force

    monkeypatch.setattr(CondensedStepper, "advance", spoilt)
    with pytest.raises(ArithmeticError, match="a step of the full system misses its equations"):
        run(narrow, "reduced", 3e-5, cycles=0.2)


def test_result_file(folder, model):
    """The columns of simulations.csv, computed anew from the histories beside them."""
    simulate(files(folder, "test.h5", law_source="fitted"), 15.0, small(3.0), Numerics(DT, 50))
    record = load(folder / "test.h5", "test")
    columns, arrays = record.attributes, record.arrays
    expected = {
        "specimen": "beam", "temperature_C": 15.0, "frequency_Hz": 40.0, "spheres": model.sphere_height.size,
        "bonds": model.system.gap.size, "broken_bonds": 0, "steps": 750, "method": "reduced", "head": "free",
        "law_source": "fitted", "time_step_s": DT, "amplitude_m": 1e-6, "enrichments": 0, "full_steps": 0,
    }  # fmt: skip
    assert {name: columns[name] for name in expected} == expected
    assert 0.0 < columns["residual"] < 1e-6
    assert 0.0 < columns["largest_utilisation"] < 1.0
    law = complex(LAW.complex_modulus(80 * np.pi))
    assert columns["E_law_MPa"] == pytest.approx(abs(law) / 1e6, rel=1e-12)
    assert columns["phase_law_deg"] == pytest.approx(np.degrees(np.angle(law)), rel=1e-12)

    history = [*(arrays[name] for name in ("time_s", "force_N", "displacement_m")), FREQUENCY]
    fits = harmonic_response(*history, cycles=2), peak_response(*history, cycles=1)
    for suffix, fit in zip(("", "_peak"), fits, strict=True):
        star = complex_modulus(
            model.geometry, FREQUENCY, fit.force_amplitude, fit.displacement_amplitude, fit.phase
        )
        assert columns[f"E{suffix}_MPa"] == pytest.approx(abs(star) / 1e6, rel=1e-12)
        assert columns[f"phase{suffix}_deg"] == pytest.approx(np.degrees(np.angle(star)), rel=1e-10)
    # projection of the last two cycles, which are whole, instead of a least-squares fit
    last = slice(-500, None)
    carrier = np.exp(-80j * np.pi * arrays["time_s"][last])
    ratio = (arrays["force_N"][last] * carrier).sum() / (arrays["displacement_m"][last] * carrier).sum()
    modulus = complex_modulus(model.geometry, FREQUENCY, abs(ratio), 1.0, np.angle(ratio))
    assert columns["E_MPa"] == pytest.approx(abs(modulus) / 1e6, rel=1e-3)
    assert columns["phase_deg"] == pytest.approx(np.degrees(np.angle(modulus)), abs=0.05)
    assert columns["E_peak_MPa"] == pytest.approx(columns["E_MPa"], rel=0.02)
    assert columns["phase_peak_deg"] == pytest.approx(columns["phase_deg"], abs=2 * 360 * FREQUENCY * DT)
    # the beam is short, but its phase is the law's, up to the step length
    assert columns["phase_deg"] == pytest.approx(columns["phase_law_deg"], abs=1.0)
    assert arrays["broken"].size == 0


def test_velocity_profile(folder, model, beam):
    """Mean velocities of layers against those of the spheres in the full system."""
    simulate(files(folder, "profile.h5"), 15.0, small(1.24), Numerics(DT, 0))
    arrays = load(folder / "profile.h5", "test").arrays
    assert arrays["profile/time_s"][[0, -1]] == pytest.approx([0.24 / FREQUENCY + DT, 1.24 / FREQUENCY])
    height, speed = arrays["profile/height_m"], arrays["profile/velocity_m_s"]
    assert height.size == 50 and speed.shape == (arrays["profile/time_s"].size, height.size)
    assert arrays["profile/spheres"].sum() == beam.radius.size
    edges = np.linspace(0, beam.geometry.h, height.size + 1)
    np.testing.assert_allclose(height, (edges[1:] + edges[:-1]) / 2)

    driven = np.diff(arrays["displacement_m"], prepend=0.0) / DT
    stepper = CondensedStepper(
        model.system, bond_law(LAW), DT, CondensedState.rest_state(model.system, bond_law(LAW))
    )
    for n, velocity in enumerate(driven):
        stepper.advance(velocity)
        sample = np.flatnonzero(np.abs(arrays["profile/time_s"] - (n + 1) * DT) < 1e-9)
        if not sample.size or n % 40:
            continue
        along = stepper.state.velocity[: 6 * beam.radius.size : 6]
        for layer in range(height.size):
            members = (beam.position[:, 2] >= edges[layer]) & (beam.position[:, 2] < edges[layer + 1])
            assert arrays["profile/spheres"][layer] == members.sum()
            mean = along[members].mean() if members.any() else np.nan
            near = 1e-9 * np.abs(driven).max()
            assert speed[sample[0], layer] == pytest.approx(mean, abs=near, nan_ok=True)


@pytest.mark.parametrize(
    ("cycles", "time_step", "message"),
    [
        (0.5, 1e-4, "needs a whole cycle"),
        (3.0, 1.3e-3, "fewer than 20 steps per cycle at 40 Hz; give at most 0.00125 s"),
    ],
)
def test_tests_that_cannot_be_reduced(folder, cycles, time_step, message):
    with pytest.raises(InputError, match=message):
        simulate(files(folder, "no.h5"), 15.0, small(cycles), Numerics(time_step, 0))
    assert not (folder / "no.h5").exists()


def test_an_account_that_no_method_keeps(model):
    for case, method in (
        (small(), "sweeps"),
        (small(), "harmonic"),
        (replace(small(), by_force=True), "reduced"),
    ):
        with pytest.raises(
            InputError, match="^energy: of a commanded force, and by the methods sweeps and harmonic"
        ):
            run_test(model, bond_law(LAW), case, Numerics(DT, 0, method), RunOptions(energy=True))


@pytest.mark.parametrize("test, mobile_mass", [("four-point bending", 2e-3), ("bending", 0.0)])
def test_bodies_that_sweeps_cannot_move(make_beam, test, mobile_mass):
    """Of clamps some motions are held; and what has no mass has infinite mobility: forces were NaN, told as settled."""
    beam = make_beam(shape=(2, 2, 6), test=test, area="facets")
    beam = replace(beam, geometry=replace(beam.geometry, mobile_mass=mobile_mass))
    held = Model(
        bending_system(beam, 0.35, 2.7e6, 0.7), NONE, beam.geometry, beam.position[:, 2], "beam", "free"
    )
    with pytest.raises(
        InputError, match="^beam: the method sweeps moves spheres and one head that has a mass"
    ):
        run_test(held, bond_law(LAW), small(), Numerics(DT, 0, "sweeps"))


def test_tests_of_one_command_are_those_made_one_by_one(folder):
    """Same numbers to the last bit, one law for all or one for each; what does not pair is refused."""
    write_law(folder / "soft.json", Burgers(2e9, 4e8, 5e9, 8e7), source="fitted", temperature=15.0)
    laws, frequencies = [folder / "law.json", folder / "soft.json"], [FREQUENCY, 2 * FREQUENCY]
    fixed = ["simulate", str(folder / "free.h5"), "--temperature-c", "15", "--amplitude-m", "1e-6"]
    fixed += ["--cycles", "1", "--time-step-s", str(DT), "--rest-steps", "10"]

    def command(frequencies, laws, outputs):
        words = {"--frequency-hz": frequencies, "--law": laws, "--output": outputs}
        return [
            *fixed,
            *(str(word) for name, values in words.items() for value in values for word in (name, value)),
        ]

    def forces(outputs):
        return [load(path, "test").arrays["force_N"].tobytes() for path in outputs]

    together, alone = ([folder / f"{name}{n}.h5" for n in (0, 1)] for name in ("together", "alone"))
    group.main(command(frequencies, laws, together), standalone_mode=False)
    for test in zip(frequencies, laws, alone, strict=True):
        group.main(command(*([value] for value in test)), standalone_mode=False)
    assert forces(together) == forces(alone)
    group.main(command(frequencies, laws[:1], together), standalone_mode=False)
    assert forces(together)[0] == forces(alone)[0] and forces(together)[1] != forces(alone)[1]
    for wrong in (command(frequencies, laws, together[:1]), command(frequencies[:1], laws, together[:1])):
        with pytest.raises(click.UsageError, match="give an --output for each frequency"):
            group.main(wrong, standalone_mode=False)


def test_frames_are_the_same_by_the_reduced_and_by_the_full_equations(model):
    small, full = (run(model, method, frames=4).frames for method in ("reduced", "condensed"))
    assert len(small) == len(full) == 4
    for one, other in zip(small, full, strict=True):
        for name in ("displacement", "velocity", "reaction"):
            expected = getattr(other, name)
            assert np.allclose(getattr(one, name), expected, atol=1e-5 * np.abs(expected).max())


def test_broken_bonds_carry_nothing_in_a_frame(model):
    record = run(model, amplitude=3e-4, cycles=1.0, frames=3)
    assert record.broken
    assert not record.frames[-1].reaction.reshape(-1, 3)[record.broken].any()
    assert record.frames[-1].reaction.any()


def test_the_command_scales_the_amplitude_and_says_what_came_of_it(folder, capsys):
    """Without --amplitude-m the strain is the paper's, as in Python; a test that breaks bonds warns."""
    fixed = ["simulate", str(folder / "free.h5"), "--law", str(folder / "law.json"), "--temperature-c", "15"]
    fixed += [
        "--frequency-hz",
        f"{FREQUENCY:g}",
        "--cycles",
        "1",
        "--time-step-s",
        str(DT),
        "--rest-steps",
        "10",
    ]
    geometry = read_model(folder / "free.h5").geometry
    group.main([*fixed, "--output", str(folder / "usual.h5")], standalone_mode=False)
    said = load(folder / "usual.h5", "test").attributes
    assert said["amplitude_m"] == pytest.approx(
        63e-6 * (geometry.h**2 / geometry.B) / (0.25**2 / 0.056), rel=1e-12
    )
    out, _ = capsys.readouterr()
    assert (
        f"15 degC, {FREQUENCY:g} Hz: |E*| = {said['E_MPa']:.4g} MPa, phase {said['phase_deg']:.2f} deg; law "
        in out
    )
    assert "broke" not in out
    group.main([*fixed, "--amplitude-m", "1e-3", "--output", str(folder / "torn.h5")], standalone_mode=False)
    broken = load(folder / "torn.h5", "test").attributes["broken_bonds"]
    out, err = capsys.readouterr()
    assert broken and f"{broken} of " in out
    assert "warning: " in err and "E* is that of a damaged specimen; lower the amplitude" in err
