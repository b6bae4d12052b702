"""What a rig does to the modulus that a simulated test reports, against Eqs. (1)-(2) and the devices' own effects."""

from __future__ import annotations

from dataclasses import asdict, replace

import numpy as np
import pytest
from theory.specimens import save_specimen

from asphalt_nscd.bending.bending_test import TestFiles, run_test, simulate
from asphalt_nscd.bending.case import LoadCase, RunOptions, require_possible
from asphalt_nscd.bending.condensing import condense
from asphalt_nscd.bending.further_settings import Cycling, Fall, FatigueLaw, Hold, Ramp
from asphalt_nscd.bending.model import read_model
from asphalt_nscd.bending.rig import KEYS, Rig, write_rig
from asphalt_nscd.bending.settings import Bonds, Fitted, Load, Numerics
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.store import load
from asphalt_nscd.measurements.twopoint import form_factor, mass_factor
from asphalt_nscd.nscd.bonds.law import BondLaw
from asphalt_nscd.rheology.chain import KelvinChain
from asphalt_nscd.rheology.laws_io import write_chain

CHAIN = KelvinChain(24.3e9, 0.06e9, (48.4e9, 90e9), (0.077e9, 0.02e9))
FREQUENCY, DT, OMEGA = 40.0, 2.5e-5, 80 * np.pi
LINEAR = Rig(
    clamp_compliance=1e-6, guide_stiffness=5e4, head_mass=0.5, channel_delay=3e-4, phase_offset=-0.15
)


@pytest.fixture(scope="module")
def folder(tmp_path_factory, beam):
    """A model and the file of a chain law."""
    folder = tmp_path_factory.mktemp("rig")
    save_specimen(folder / "beam.h5", beam)
    condense(folder / "beam.h5", Bonds(), folder / "model.h5")
    write_chain(folder / "law.json", CHAIN, source="", temperature=15, error=0.0, lowest_hz=3, highest_hz=40)
    return folder


@pytest.fixture(scope="module")
def model(folder):
    return read_model(folder / "model.h5")


def simulated(folder, rig, method, amplitude=1e-6, cycles=4.0):
    """(E* [Pa], attributes) of a simulated test."""
    if rig is not None:
        write_rig(folder / "rig.json", rig)
    files = TestFiles(
        folder / "model.h5",
        folder / "law.json",
        folder / "test.h5",
        rig=None if rig is None else folder / "rig.json",
    )
    simulate(files, 15.0, LoadCase(FREQUENCY, amplitude, cycles), Numerics(DT, 20, method))
    columns = load(folder / "test.h5", "test").attributes
    return columns["E_MPa"] * 1e6 * np.exp(1j * np.radians(columns["phase_deg"])), columns


def apparent(modulus, rig, model, amplitude=1e-6):
    """E* that the reduction takes for that of the specimen."""
    gamma, mu = form_factor(model.geometry), mass_factor(model.geometry)
    head = modulus / gamma - mu * OMEGA**2 + rig.guide_stiffness - rig.head_mass * OMEGA**2
    head += 4j * rig.guide_friction / (np.pi * amplitude)
    stiffness = 1 / (rig.clamp_compliance + 1 / head)
    return gamma * (stiffness * np.exp(1j * (OMEGA * rig.channel_delay + rig.phase_offset)) + mu * OMEGA**2)


@pytest.mark.parametrize(
    "rig",
    [
        *(Rig(**{name: value}) for name, value in asdict(LINEAR).items() if value),
        LINEAR,
        replace(LINEAR, channel_delay=-3e-4, phase_offset=0.15),
        Rig(head_mass=-0.2),
    ],
)
@pytest.mark.parametrize(("method", "accuracy"), [("harmonic", 1e-9), ("reduced", 3e-3)])
def test_apparent_modulus(folder, model, rig, method, accuracy):
    """In the frequency domain exactly, in time to the step length; each rig counts for 3 % and more."""
    bare, _ = simulated(folder, None, method)
    found, columns = simulated(folder, rig, method)
    expected = apparent(bare, rig, model)
    assert abs(expected / bare - 1) > 0.03
    assert abs(found / expected - 1) < accuracy
    assert {name: columns[name] for name in rig.columns()} == rig.columns()


def test_slider_on_a_rigid_clamp(folder, model):
    """Describing function i 4 F_s / (pi z0), to the step length."""
    bare, _ = simulated(folder, None, "reduced")
    found, _ = simulated(folder, Rig(guide_friction=0.02), "reduced")
    expected = apparent(bare, Rig(guide_friction=0.02), model)
    assert abs(expected / bare - 1) > 0.03
    assert abs(found / expected - 1) < 3e-3


@pytest.mark.parametrize("rig", [LINEAR, replace(LINEAR, guide_friction=1.0)])
def test_reduced_and_condensed_agree(model, rig):
    law = BondLaw(24.3e9, 0.06e9, np.array([48.4e9, 90e9]), np.array([0.077e9, 0.02e9]))
    one, two = (
        run_test(model, law, LoadCase(FREQUENCY, 1e-4, 1.0, rig), Numerics(1e-4, 20, method))
        for method in ("reduced", "condensed")
    )
    assert one.broken == two.broken != []
    np.testing.assert_allclose(one.force, two.force, rtol=0, atol=1e-6 * np.abs(two.force).max())
    np.testing.assert_array_equal(one.displacement, two.displacement)
    assert one.residual < 1e-6


def test_a_closing_gap_hands_over_to_the_full_system(model):
    """Tiny gaps: the full system goes on with the actuator where it is."""
    strength = np.full_like(model.system.strength, np.inf)
    narrow = replace(model, system=replace(model.system, gap=1e-3 * model.system.gap, strength=strength))
    law = BondLaw(24.3e9, 0.06e9, np.array([48.4e9]), np.array([0.077e9]))
    one, two = (
        run_test(narrow, law, LoadCase(FREQUENCY, 8e-5, 0.2, LINEAR), Numerics(1e-4, 20, method))
        for method in ("reduced", "condensed")
    )
    assert 5 < one.details["full_steps"] < 45
    np.testing.assert_allclose(one.force, two.force, rtol=0, atol=1e-6 * np.abs(two.force).max())


def test_chain_law_gives_the_ratio_of_burgers(folder, model):
    """Simulated over analytic modulus is the packing's alone: that of a chain and that of one element."""
    ratio = []
    for law in (CHAIN, KelvinChain(24.3e9, 0.06e9, (48.4e9,), (0.077e9,))):
        write_chain(
            folder / "law.json", law, source="", temperature=15, error=0.0, lowest_hz=3, highest_hz=40
        )
        modulus, columns = simulated(folder, None, "harmonic")
        analytic = columns["E_law_MPa"] * 1e6 * np.exp(1j * np.radians(columns["phase_law_deg"]))
        assert analytic == pytest.approx(law.complex_modulus(OMEGA), rel=1e-12)
        ratio.append(modulus / analytic)
    write_chain(folder / "law.json", CHAIN, source="", temperature=15, error=0.0, lowest_hz=3, highest_hz=40)
    assert ratio[0] == pytest.approx(ratio[1], rel=1e-3)


def test_before_the_channel_catches_up_it_shows_rest(model):
    law = BondLaw(24.3e9, 0.06e9, np.array([48.4e9]), np.array([0.077e9]))
    case = LoadCase(FREQUENCY, 1e-6, 1.0, Rig(channel_delay=1.05e-3))
    record = run_test(model, law, case, Numerics(1e-4, 5))
    assert not record.displacement[:10].any() and record.displacement[10:12].all()
    assert record.force[:10].all()
    delayed = 1e-6 * np.sin(OMEGA * (record.time[10:] - 1.05e-3))
    np.testing.assert_allclose(record.displacement[10:], delayed, rtol=1e-12)


MOST = 5_000_000
IMPOSSIBLE = {
    "friction in harmonics": ({"rig": Rig(guide_friction=1.0)}, {"method": "harmonic"}, 0, "is not harmonic"),
    "devices in sweeps": ({"rig": Rig(head_mass=1.0)}, {"method": "sweeps"}, 0, "cannot simulate devices"),
    "scheme of sweeps": ({}, {"method": "sweeps", "scheme": "fitted"}, 0, "sweeps has no scheme 'fitted'"),
    "scheme of harmonics": ({}, {"method": "harmonic", "scheme": "fitted"}, 0, "harmonic has no scheme"),
    "frames of harmonics": ({}, {"method": "harmonic"}, 2, "harmonic keeps no frames"),
    "force on a rig": ({"by_force": True, "rig": Rig(channel_delay=1e-3)}, {}, 0, "commanded force goes without"),
    "force in sweeps": ({"by_force": True}, {"method": "sweeps"}, 0, "commanded force goes without"),
    "steps": ({"cycles": 1.0}, {"time_step": 1e-7, "rest_steps": MOST - 250_000 + 1}, 0, "5e.06 steps of 1e-07 s"),
}  # fmt: skip


@pytest.mark.parametrize("name", IMPOSSIBLE)
def test_what_a_method_cannot_do_is_refused(name):
    """Beside it, what differs in one thing: another method, or no rig, or one step fewer, is taken."""
    case, numerics, frames, words = IMPOSSIBLE[name]
    asked, how = LoadCase(FREQUENCY, 1e-6, **case), Numerics(**numerics)
    with pytest.raises(InputError, match=words):
        require_possible(asked, how, RunOptions(frames=frames))
    fewer = replace(how, method="reduced", rest_steps=how.rest_steps - 1)
    require_possible(replace(asked, rig=Rig()) if asked.by_force else asked, fewer, RunOptions(frames=frames))


def test_who_states_nothing_tests_as_all_published_results_were_made():
    assert Bonds() == Bonds("free", 0.35, 1.0, 2.7e6, 0.7)
    assert Numerics() == Numerics(5e-5, 1000, "reduced", "euler", 1e-4, 50)
    assert Load() == Load(None, 5.0, Rig(), 0, None) and LoadCase(1.0) == LoadCase(
        1.0, 63e-6, 5.0, Rig(), False
    )
    assert Hold() == Hold(10.0, 1000, None, None) and Ramp() == Ramp(0.1, 400, None, None, 0)
    assert Cycling() == Cycling(None, 10e3, 0.5, True, 10, 5, True, 32)
    assert Fall() == Fall(0.02, 75.0, 0.5, 0.5, 2e-4, 50, 0.0) and FatigueLaw() == FatigueLaw(100e-6, 5.0)


@pytest.mark.parametrize(
    ("kind", "name", "inside", "outside"),
    [
        *((kind, "force_N", sign * 1e9, sign * 1.01e9) for kind in (Hold, Ramp) for sign in (1, -1)),
        *((kind, "displacement_m", sign * 1.0, sign * 1.01) for kind in (Hold, Ramp) for sign in (1, -1)),
        *((kind, "duration_s", *ends) for kind in (Hold, Ramp) for ends in ((1e-6, 9e-7), (1e9, 1.1e9))),
        *((kind, "steps", *ends) for kind in (Hold, Ramp) for ends in ((10, 9), (MOST, MOST + 1))),
        (Ramp, "frames", 10_000, 10_001), (Ramp, "frames", 0, -1), (Cycling, "amplitude_m", 1e-12, 9e-13),
        (Cycling, "amplitude_m", 1e-3, 1.1e-3), (Cycling, "pressure_Pa", 1, 0.9), (Cycling, "pressure_Pa", 1e7, 1.1e7),
        (Cycling, "skeleton_friction", 0.0, -0.1), (Cycling, "skeleton_friction", 10.0, 10.1),
        (Cycling, "all_cycles", 1000, 1001), (Cycling, "all_cycles", 5, 4), (Cycling, "read_cycles", 1, 0),
        (Cycling, "steps_in_cycle", 20, 19), (Cycling, "steps_in_cycle", 1000, 1001), (Fall, "height", 0.0, -1e-9),
        (Fall, "height", 10.0, 10.1), (Fall, "tilt", 180.0, 181.0), (Fall, "tilt", -180.0, -181.0),
        (Fall, "sawn", 0.0, -0.1), (Fall, "sawn", 0.99, 1.0), (Fall, "duration", 1e-9, 0.0),
        (Fall, "duration", 100.0, 101.0), (Fall, "time_step", 1e-6, 9e-8), (Fall, "time_step", 1e-2, 1.1e-2),
        (Fall, "frames", 2, 1), (Fall, "frames", 10_000, 10_001), (Fall, "rolling_friction", 10.0, 10.1),
        (FatigueLaw, "endured", 1e-8, 9e-9), (FatigueLaw, "endured", 0.1, 0.11), (FatigueLaw, "exponent", 1.0, 0.9),
        (FatigueLaw, "exponent", 20.0, 21.0), (Bonds, "poisson", -0.99, -1.0), (Bonds, "poisson", 0.5, 0.51),
        (Bonds, "kt_over_kn", 1e-4, 9e-5), (Bonds, "kt_over_kn", 10.0, 10.1), (Bonds, "yield_Pa", 1.0, 0.9),
        (Bonds, "friction", 0.0, -0.1), (Bonds, "friction", 100.0, 101.0), (Numerics, "time_step", 1e-12, 0.0),
        (Numerics, "rest_steps", 0, -1), (Numerics, "rest_steps", MOST, MOST + 1), (Numerics, "tolerance", 0.0, -1e-9),
        (Numerics, "most_sweeps", 1, 0), (Numerics, "most_sweeps", 10**5, 100_001), (Fitted, "steps_per_cycle", 20, 19),
        (Load, "amplitude_m", 1e-15, 9e-16), (Load, "amplitude_m", 1.0, 1.1), (Load, "cycles", 1.0, 0.9),
        (Load, "frames", 10_000, 10_001), (Load, "frames", 0, -1), (Load, "amplitude_N", 1e-9, 9e-10),
        (Load, "amplitude_N", 1e9, 1.1e9), (Rig, "guide_stiffness", 1e15, 1.1e15), (Rig, "guide_friction", 0.0, -1e-9),
        (Rig, "clamp_compliance", 0, -1e-9), (Rig, "head_mass", -1e15, -1.1e15), (Rig, "phase_offset", -1e15, -1.1e15),
    ],
)  # fmt: skip
def test_the_last_value_of_a_range_is_taken_and_the_next_is_not(kind, name, inside, outside):
    kind(**{name: inside})
    with pytest.raises(InputError, match=rf"{name}|{KEYS.get(name, name)}|read of"):
        kind(**{name: outside})
