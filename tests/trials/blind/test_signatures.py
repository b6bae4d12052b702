"""Each effect in a noise-free case against its analytic signature on the apparent modulus."""

from dataclasses import replace

import numpy as np
import pytest
from blind.causes import CATALOGUE
from blind.design import GEOMETRY, apparent_modulus, factorial, form_factor, head_stiffness
from blind.generator import Case, Hidden, draw
from blind.laws import draw_law
from blind.outside import OUTSIDE
from blind.strength import Scatter, strength, visible_strength

QUIET = Scatter(1e-12, 1e-12, 1e-12, 0.0)
STRAINS = factorial(amplitudes=(20e-6, 63e-6))
AGED = factorial(order="shuffled")
GAMMA = form_factor(GEOMETRY)
DESIGNS = {"strain_softening": STRAINS, "damage": AGED}


def moduli(case: Case) -> np.ndarray:
    table = case.table
    ratio = table["F0_N"] / table["z0_m"] * np.exp(1j * np.radians(table["psi_deg"]))
    return apparent_modulus(case.geometry, table["frequency_Hz"], ratio)


def pair(cause: str, amplitude: float, where=None, sign=1, design=None):
    """(design, E* without, E* with the effect) of one noise-free mix."""
    design = factorial() if design is None else design
    hidden = Hidden(cause, amplitude=amplitude, where=where, sign=sign)
    plain, hit = (quiet_moduli(design, effects) for effects in ([], [hidden]))
    return design, plain, hit


def quiet_moduli(design, hidden):
    case = draw(11, hidden, design=design, scatter=QUIET)
    return moduli(case)


def test_form_factor_is_the_paper_s():
    assert pytest.approx(25.0958e3, rel=1e-5) == GAMMA  # 1/m


def test_reduction_adds_the_moving_mass():
    # mu = 0.135 * 0.6 kg + 0.235 kg = 0.316 kg
    inertia = GAMMA * 0.316 * (2.0 * np.pi * 40.0) ** 2
    assert apparent_modulus(GEOMETRY, 40.0, 1e5 + 0j) == pytest.approx(GAMMA * 1e5 + inertia)


def test_reduction_inverts_itself():
    modulus = np.array([20e9 * np.exp(0.1j), 1e9 * np.exp(0.7j)])
    assert apparent_modulus(GEOMETRY, [3.0, 40.0], head_stiffness(GEOMETRY, [3.0, 40.0], modulus)) == (
        pytest.approx(modulus)
    )


@pytest.mark.parametrize("sign", [1, -1])
def test_delay_and_offset_turn_the_measured_ratio(sign):
    design, plain, hit = pair("channel_delay", 2e-4, sign=sign)
    f = design["frequency_Hz"].to_numpy()
    turned = head_stiffness(GEOMETRY, f, hit) / head_stiffness(GEOMETRY, f, plain)
    assert turned == pytest.approx(np.exp(sign * 2e-4 * 2j * np.pi * f), rel=1e-9)
    design, plain, hit = pair("phase_offset", 1.0, sign=sign)
    turned = head_stiffness(GEOMETRY, f, hit) / head_stiffness(GEOMETRY, f, plain)
    assert np.degrees(np.angle(turned)) == pytest.approx(np.full(len(f), sign * 1.0), abs=1e-8)


def test_mass_spring_and_slider_add_to_the_modulus():
    design, plain, hit = pair("moving_mass", 0.03)
    omega = 2.0 * np.pi * design["frequency_Hz"].to_numpy()
    assert (hit - plain).real == pytest.approx(-GAMMA * 0.03 * omega**2, rel=1e-6)
    assert np.abs((hit - plain).imag).max() < 1.0
    _, plain, hit = pair("guide_stiffness", 4e3)
    assert hit - plain == pytest.approx(np.full(len(hit), GAMMA * 4e3 + 0j), rel=1e-6)
    _, plain, hit = pair("guide_friction", 0.2)
    assert hit - plain == pytest.approx(np.full(len(hit), 4j * GAMMA * 0.2 / (np.pi * 63e-6)), rel=1e-6)


def test_temperature_bias_is_the_law_at_the_true_temperature_of_one_isotherm():
    design, plain, hit = pair("temperature_bias", 10.0, where=10.0)
    at = design["temperature_C"].to_numpy()
    assert hit[at != 10.0] == pytest.approx(plain[at != 10.0], rel=1e-9)
    assert hit[at == 10.0] == pytest.approx(plain[at == 20.0], rel=1e-9)
    assert np.all(
        np.abs(pair("temperature_bias", 1.0, where=10.0, sign=-1)[2][at == 10.0]) > abs(plain[at == 10.0])
    )


def test_self_heating_reaches_its_amplitude_where_most_is_dissipated():
    design, plain, hit = pair("self_heating", 2.0)
    drop = np.log(np.abs(hit / plain))
    assert np.all(drop < 0)
    power = 2.0 * np.pi * design["frequency_Hz"].to_numpy() * hit.imag
    hottest = int(np.argmax(power))
    # The same mix measured two kelvin warmer at that isotherm must agree with the hottest test.
    _, _, warm = pair("temperature_bias", 2.0, where=float(design["temperature_C"][hottest]))
    assert hit[hottest] == pytest.approx(warm[hottest], rel=1e-7)


def test_loose_clamp_is_a_compliance_of_one_specimen():
    design, plain, hit = pair("loose_clamp", 3e-8, where="B")
    loose = (design["specimen"] == "B").to_numpy()
    assert hit[~loose] == pytest.approx(plain[~loose], rel=1e-9)
    softer = (1.0 / hit - 1.0 / plain)[loose]
    slow = (design["frequency_Hz"] == 3.0).to_numpy()[loose]
    assert softer[slow] == pytest.approx(np.full(slow.sum(), 3e-8 / GAMMA + 0j), rel=5e-3)  # inertia: < 0.5 %


def test_geometry_softening_and_damage_scale_the_modulus():
    design, plain, hit = pair("specimen_geometry", 0.1, where="D", sign=-1)
    assert hit / plain == pytest.approx(np.where(design["specimen"] == "D", 0.9, 1.0), rel=1e-9)
    design, plain, hit = pair("strain_softening", 1000.0, design=STRAINS)
    assert hit / plain == pytest.approx(1.0 - 1000.0 * design["amplitude_m"].to_numpy(), rel=1e-9)
    design, plain, hit = pair("damage", 0.05, design=AGED)
    last = int(design["cycles"].argmax())
    assert (hit / plain)[last] == pytest.approx(0.95, rel=1e-9)
    first = design["order"].to_numpy() == 1
    assert (hit / plain)[first] == pytest.approx(1.0, rel=1e-9)


def test_secondary_process_adds_a_bump_of_half_its_strength_times_its_width():
    hidden = [Hidden("secondary_process", amplitude=1e9)]
    case = draw(11, hidden, scatter=QUIET)
    details = case.seal["effects"][0]["details"]
    added = moduli(case) - quiet_moduli(factorial(), [])
    top = 0.5 * 1e9 * np.tan(0.25 * np.pi * details["exponent"])  # Cole & Cole (1941) at omega tau = 1
    assert 0.5 * top < added.imag.max() <= top * (1 + 1e-6)
    assert np.all(added.imag > 0) and np.all(added.real > 0)


def test_single_frequency_gain_and_phase_of_one_isotherm_touch_nothing_else():
    design, plain, hit = pair("gain_at_frequency", 0.02, where=10.0)
    assert hit / plain == pytest.approx(np.where(design["frequency_Hz"] == 10.0, 1.02, 1.0), rel=1e-9)
    design, plain, hit = pair("isotherm_phase", 0.5, where=0.0)
    turned = np.degrees(np.angle(hit / plain))
    assert turned == pytest.approx(np.where(design["temperature_C"] == 0.0, 0.5, 0.0), abs=1e-8)


def test_patterns_outside_the_catalogue():
    design, plain, hit = pair("alternating_phase", 0.3)
    turned = np.degrees(np.angle(hit / plain)).reshape(24, 5)
    assert turned == pytest.approx(np.tile([0.3, -0.3, 0.3, -0.3, 0.3], (24, 1)), abs=1e-8)
    design, plain, hit = pair("modulus_step", 0.02)
    assert np.log(np.abs(hit / plain)).reshape(24, 5)[0] == pytest.approx(
        [-0.01, -0.01, -0.01, 0.01, 0.01], abs=1e-9
    )
    design, plain, hit = pair("rough_hot_gain", 0.03)
    rough = np.log(np.abs(hit / plain)).reshape(4, 6, 5)[0, :, 0]
    assert rough == pytest.approx([0, 0, 0, -0.01, 0.02, -0.03], abs=1e-9)
    design, plain, hit = pair("specimen_frequency", 0.01)
    table = np.log(np.abs(hit / plain)).reshape(4, 6, 5)
    assert np.ptp(table, axis=1).max() < 1e-9  # the same at every temperature
    assert table.mean(axis=0) == pytest.approx(0.0, abs=1e-9) and table.std() == pytest.approx(0.01, rel=1e-6)


def test_wrong_frequency_is_the_mix_at_another_frequency():
    design = factorial(frequencies=(10.0, 20.0))
    _, plain, hit = pair("wrong_frequency", 1.0, where=10.0, design=design)
    label, true = (
        head_stiffness(GEOMETRY, design["frequency_Hz"], values).reshape(-1, 2) for values in (hit, plain)
    )
    assert label[:, 0] == pytest.approx(true[:, 1], rel=1e-9)


def test_resonance_turns_its_phase_across_its_frequency():
    hidden = [Hidden("rig_resonance", amplitude=1e-3, sign=1)]
    case = draw(11, hidden, design=factorial(frequencies=np.geomspace(1, 100, 60)), scatter=QUIET)
    plain = quiet_moduli(factorial(frequencies=np.geomspace(1, 100, 60)), [])
    f = case.table["frequency_Hz"].to_numpy()[:60]
    effect = (head_stiffness(GEOMETRY, f, moduli(case)[:60]) / head_stiffness(GEOMETRY, f, plain[:60])) - 1.0
    details = case.seal["effects"][0]["details"]
    below, above = f < 0.8 * details["frequency_Hz"], f > 1.25 * details["frequency_Hz"]
    assert np.all(effect.real[below] > 0) and np.all(effect.real[above] < 0) and np.all(effect.imag < 0)


def test_amplitudes_in_other_units():
    cases = {
        "channel_delay": (1e-4, {"s": 1e-4, "ms": 0.1, "us": 100.0}),
        "phase_offset": (1.0, {"deg": 1.0, "rad": np.pi / 180}),
        "moving_mass": (0.03, {"kg": 0.03, "g": 30.0}),
        "temperature_bias": (0.5, {"K": 0.5, "degC": 0.5}),
        "self_heating": (0.5, {"K": 0.5, "degC": 0.5}),
        "guide_stiffness": (4e3, {"N/m": 4e3, "Pa": 1.003832e8, "MPa": 100.3832, "GPa": 0.1003832}),
        "guide_friction": (0.1, {"N": 0.1, "Pa": 5.071895e7, "MPa": 50.71895, "GPa": 0.05071895}),
        "loose_clamp": (
            5e-8,
            {"m/N": 5e-8, "1/Pa": 1.992365e-12, "1/MPa": 1.992365e-6, "1/GPa": 1.992365e-3},
        ),
        "specimen_geometry": (0.1, {"1": 0.1, "%": 10.0}),
        "strain_softening": (1000.0, {"1/m": 1000.0, "1": 0.063, "%": 6.3, "1/um": 1e-3}),
        "damage": (0.05, {"1": 0.05, "%": 5.0}),
        "secondary_process": (5e8, {"Pa": 5e8, "MPa": 500.0, "GPa": 0.5}),
    }
    assert cases.keys() == CATALOGUE.keys()
    for cause, (amplitude, expected) in cases.items():
        hidden = Hidden(cause, amplitude=amplitude, sign=1)
        case = draw(1, [hidden], design=DESIGNS.get(cause))
        found = case.seal["effects"][0]["equivalents"]
        assert found == pytest.approx(expected, rel=1e-5), cause


@pytest.mark.parametrize("cause", [*CATALOGUE, *OUTSIDE])
def test_asked_strength_is_given(cause):
    for asked in ({"strength": 8.0}, {"visible_strength": 5.0}):
        case = draw(3, [Hidden(cause, **asked)], design=DESIGNS.get(cause), law="huet_sayegh")
        (name, value), effect = *asked.items(), case.seal["effects"][0]
        assert effect[name] == pytest.approx(value, rel=1e-5)
        assert effect["visible_strength"] <= effect["strength"] * (1 + 1e-9)


def test_strength_counts_standard_deviations():
    effect = np.array([0.03, 0.0, np.radians(1.2) * 1j])
    assert strength(effect, Scatter(modulus=0.01, phase_deg=0.3)) == pytest.approx(5.0)


def test_what_a_mix_or_its_specimens_may_do_is_hardly_visible():
    design, law = factorial(), draw_law(np.random.default_rng(2))
    omega, temperature = 2.0 * np.pi * design["frequency_Hz"], design["temperature_C"]
    modulus = law.modulus(omega, temperature)
    faster = replace(law, parameters=law.parameters | {"log10_tau": law.parameters["log10_tau"] + 0.05})
    on_one = 0.03 * (design["specimen"] == "C").to_numpy() + 0j
    rough = 0.03 * (design["frequency_Hz"] == 10.0).to_numpy() + 0j
    smooth = np.log(faster.modulus(omega, temperature) / modulus)
    shares = [
        visible_strength(e, law, design, Scatter()) / strength(e, Scatter()) for e in (smooth, on_one, rough)
    ]
    assert shares[0] < 0.05 and shares[1] < 0.1 and 0.7 < shares[2] < 1.0
