"""Effects put into a table do what their closed form says, and keep everything else of the table."""

import json

import numpy as np
import pandas as pd
import pytest
from blind.backgrounds import AMPLITUDE, Background
from blind.causes import CATALOGUE
from blind.design import GEOMETRY, factorial, form_factor
from blind.fitted import fit_law, shift_rate
from blind.generator import draw
from blind.outside import OUTSIDE
from blind.strength import Scatter

GAMMA = form_factor(GEOMETRY)
SEED = 4


def background(known: bool = True, scatter: Scatter | None = None, **design) -> Background:
    """A table with scatter, whose mix is known or is to be fitted."""
    tests = factorial(specimens="ABC", temperatures=(-10.0, 5.0, 20.0, 35.0), **design)
    case = draw(SEED, design=tests, form="moduli", law="two_s2p1d", scatter=scatter)
    return Background(case.table, _law() if known else None)


def _law():
    from blind.generator import draw_law

    seed = np.random.SeedSequence(SEED).spawn(4)[0]
    return draw_law(np.random.default_rng(seed), "two_s2p1d")


def put(base: Background, cause: str, amplitude: float, **how):
    """Moduli before and after [Pa], and the seal."""
    table, seal = base.put(cause, amplitude, **how)
    return base.modulus, Background(table).modulus, seal


def omega(base: Background) -> np.ndarray:
    return 2.0 * np.pi * base.table["frequency_Hz"].to_numpy()


@pytest.mark.parametrize("sign", [-1.0, 1.0])
def test_channels_turn_the_phase_and_keep_the_modulus(sign):
    base = background()
    before, after, _ = put(base, "phase_offset", sign * 1.5)
    assert np.degrees(np.angle(after / before)) == pytest.approx(sign * 1.5, rel=1e-9)
    assert np.abs(after) == pytest.approx(np.abs(before), rel=1e-12)
    before, after, seal = put(base, "channel_delay", sign * 0.2, unit="ms")
    assert np.angle(after / before) == pytest.approx(sign * 0.2e-3 * omega(base), rel=1e-9)
    assert np.abs(after) == pytest.approx(np.abs(before), rel=1e-12)
    assert seal["amplitude"] == pytest.approx(sign * 0.2e-3) and seal["unit"] == "s"


@pytest.mark.parametrize("sign", [-1.0, 1.0])
def test_a_mass_takes_gamma_m_omega_squared_from_the_real_part(sign):
    base = background()
    before, after, _ = put(base, "moving_mass", sign * 0.1)
    assert after - before == pytest.approx(-sign * GAMMA * 0.1 * omega(base) ** 2 + 0j, rel=1e-6)


def test_a_slider_and_a_spring_add_loss_and_storage():
    base = background()
    before, after, _ = put(base, "guide_friction", 60.0, unit="MPa")
    assert after - before == pytest.approx(60e6j, rel=1e-6)
    before, after, seal = put(base, "guide_friction", 0.1)
    assert (after - before).imag == pytest.approx(GAMMA * 0.4 / (np.pi * AMPLITUDE), rel=1e-6)
    assert seal["equivalents"]["Pa"] == pytest.approx(GAMMA * 0.4 / (np.pi * AMPLITUDE))
    before, after, _ = put(base, "guide_stiffness", 50.0, unit="MPa")
    assert after - before == pytest.approx(50e6 + 0j, rel=1e-6)


def test_one_specimen_gets_a_compliance_or_another_size_and_the_others_stay():
    base = background()
    own = (base.table["specimen"] == "B").to_numpy()
    before, after, seal = put(base, "loose_clamp", 1.5e-12, where="B", unit="1/Pa")
    assert (1.0 / after - 1.0 / before)[own] == pytest.approx(1.5e-12 + 0j, rel=1e-6)
    assert after[~own] == pytest.approx(before[~own], rel=1e-12) and seal["where"] == "B"
    before, after, _ = put(base, "specimen_geometry", -0.12, where="B")
    assert after / before == pytest.approx(np.where(own, 0.88, 1.0) + 0j, rel=1e-12)


@pytest.mark.parametrize("known", [True, False])
@pytest.mark.parametrize("shift", [-1.5, 0.4, 3.0])
def test_a_warmer_isotherm_moves_along_the_law(known, shift):
    base = background(known)
    before, after, seal = put(base, "temperature_bias", shift, where=20.0)
    own = (base.table["temperature_C"] == 20.0).to_numpy()
    truth = _law().modulus(omega(base), 20.0 + shift) / _law().modulus(omega(base), 20.0)
    moved, asked = np.log(after / before)[own], np.log(truth)[own]
    assert after[~own] == pytest.approx(before[~own], rel=1e-12) and seal["where"] == 20.0
    assert moved == pytest.approx(asked, abs=1e-9 if known else 0.08 * np.abs(asked).max())
    assert np.sign(moved.real) == pytest.approx(-np.sign(shift))


def test_self_heating_is_largest_at_the_test_that_dissipates_most():
    base = background(scatter=Scatter(0.0, 0.0, 0.0, 0.0))
    before, after, _ = put(base, "self_heating", 2.0)
    temperature = base.table["temperature_C"].to_numpy()
    # Temperature of each test, by Newton's method on the modulus it shows.
    warm = temperature.copy()
    for _ in range(40):
        slope = (_law().modulus(omega(base), warm + 1e-4) - _law().modulus(omega(base), warm)) / 1e-4
        warm += ((after - _law().modulus(omega(base), warm)) / slope).real
    power = omega(base) * after.imag
    assert warm - temperature == pytest.approx(2.0 * power / power.max(), abs=1e-6)


def test_a_second_process_adds_a_loss_bump_of_the_details_in_the_seal():
    base = background()
    before, after, seal = put(base, "secondary_process", 400.0, unit="MPa", seed=3)
    details = seal["details"]
    kelvin = base.table["temperature_C"].to_numpy() + 273.15
    tau = np.exp(details["energy_J_mol"] / 8.314462618 * (1 / kelvin - 1 / (273.15 + details["centre_C"])))
    s = (1j * omega(base) * tau / (2.0 * np.pi * details["centre_Hz"])) ** details["exponent"]
    assert after - before == pytest.approx(4e8 * s / (1.0 + s), rel=1e-6)
    assert put(base, "secondary_process", 4e8, seed=4)[2]["details"] != details


def test_softening_and_damage_go_by_amplitude_and_cycles():
    base = background(amplitudes=(30e-6, 60e-6))
    before, after, _ = put(base, "strain_softening", 1000.0)
    assert after / before == pytest.approx(1.0 - 1000.0 * base.table["amplitude_m"].to_numpy() + 0j)
    base = background(order="shuffled")
    before, after, _ = put(base, "damage", 0.05)
    cycles = base.table["cycles"].to_numpy(float)
    assert after / before == pytest.approx(1.0 - 0.05 * cycles / cycles.max() + 0j)


@pytest.mark.parametrize("cause", [*CATALOGUE, *OUTSIDE])
def test_no_amplitude_changes_nothing_and_small_ones_are_linear(cause):
    how = {"strain_softening": {"amplitudes": (3e-5, 6e-5)}, "damage": {"order": "shuffled"}}.get(cause, {})
    base = background(**how)
    effect = base.effect(cause)
    where = None if effect.confined is None else base.design[effect.confined].iloc[-1]
    none, small, double = (
        put(base, cause, a, where=where)[1] for a in (0.0, 1e-3 * effect.step, 2e-3 * effect.step)
    )
    assert none == pytest.approx(base.modulus, rel=1e-12)
    change = small - base.modulus
    assert np.abs(change).max() > 0.0
    assert double - base.modulus == pytest.approx(2.0 * change, abs=2e-3 * np.abs(change).max())


def test_the_seal_says_it_all_in_json_and_a_seed_repeats_it():
    base = background()
    table, seal = base.put("secondary_process", 2e8, seed=8)
    again, same = base.put("secondary_process", 2e8, seed=8)
    pd.testing.assert_frame_equal(table, again)
    assert seal == same == json.loads(json.dumps(seal))
    assert list(table.columns) == list(base.table.columns)


def test_what_a_table_cannot_hold_is_refused():
    base = background()
    for cause, column in (("damage", "cycles"), ("strain_softening", "amplitude_m")):
        with pytest.raises(ValueError, match=column):
            base.put(cause, 0.01)
    with pytest.raises(ValueError, match="no specimen 'Z'"):
        base.put("loose_clamp", 1e-12, where="Z")
    with pytest.raises(ValueError, match="no temperature_C 12"):
        base.put("temperature_bias", 1.0, where=12.0)


def test_measured_mean_temperatures_belong_to_their_isotherm():
    base = background()
    jitter = np.random.default_rng(1).uniform(-0.3, 0.3, len(base.table))
    mean = Background(base.table.assign(temperature_C=base.table["temperature_C"] + jitter), base.known_law)
    moved = np.abs(
        np.log(Background(mean.put("temperature_bias", 1.0, where="20")[0]).modulus / mean.modulus)
    )
    assert ((moved > 1e-6) == (base.table["temperature_C"] == 20.0)).all()


def test_a_table_is_read_with_its_usual_names(tmp_path):
    path = tmp_path / "table.csv"
    path.write_text("# a remark\nreplicate,T_C,f_Hz,E_MPa,phi_deg\n1,-10,25.0,20000,5\n2,-10,25.0,21000,6\n")
    base = Background.read(path)
    assert base.table["specimen"].tolist() == ["1", "2"] and np.abs(base.modulus[0]) == pytest.approx(2e10)
    path.write_text("a,b\n1,2\n")
    with pytest.raises(ValueError, match="no column specimen"):
        Background.read(path)


def test_a_broken_isotherm_does_not_bend_the_fitted_law():
    base = background(known=False)
    broken = base.table["temperature_C"] == 35.0
    table = base.table.assign(phase_deg=base.table["phase_deg"] - np.where(broken, 15.0, 0.0))
    rates = [shift_rate(law, 5.0) for law in (_law(), fit_law(table))]
    assert rates[1] == pytest.approx(rates[0], rel=0.15) and rates[0] < 0.0


def test_tables_of_cylinders_lie_in_a_folder_of_their_own(tmp_path):
    for folder, test_type in (("mine", "bending"), ("tension-compression", "tension-compression")):
        path = tmp_path / folder / "mix.csv"
        path.parent.mkdir()
        background().table.to_csv(path, index=False)
        assert Background.read(path).test_type == test_type
