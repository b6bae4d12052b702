"""Each fault changes what it says, by what it says, and nothing else."""

import ast
from dataclasses import replace
from pathlib import Path

import attack
import numpy as np
import pytest
from attack import plan
from attack.faults import CATALOGUE, CHAIN, FORM_FACTOR, PEN, Chain, Fault, put
from attack.laboratory import Campaign, invented

BENDING, CYLINDER = 2, 1  # tables with two amplitudes, and with an order


@pytest.fixture(scope="module")
def bending():
    return invented(BENDING, seed=1)


@pytest.fixture(scope="module")
def cylinder():
    return invented(CYLINDER, seed=1)


def recorded(campaign, *faults):
    """ln E* before rounding."""
    chain = Chain(campaign)
    for fault in faults:
        CHAIN[fault.kind](chain, fault)
    return chain.log_modulus()


def change(campaign, *faults):
    return recorded(campaign, *faults) - recorded(campaign)


def test_nothing_comes_from_the_package_under_attack():
    for name in ("mixes", "laboratory", "faults", "measured", "plan"):
        path = Path(attack.__file__).with_name(f"{name}.py")
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            names = [alias.name for alias in node.names] if isinstance(node, ast.Import) else []
            if isinstance(node, ast.ImportFrom) and not node.level:
                names = [node.module]
            assert not any(one.split(".")[0] == "asphalt_nscd" for one in names), path.name


def test_one_number_one_table():
    first, again, other = (put(invented(5, seed), ()) for seed in (1, 1, 2))
    assert first.equals(again) and not first.equals(other)


def test_a_table_without_a_fault_is_the_mix_with_everyday_errors(bending):
    table = put(bending, ())
    modulus = np.exp(bending.unmoved())
    np.testing.assert_allclose(table["E_MPa"], 1e-6 * np.abs(modulus), rtol=6e-4)
    np.testing.assert_allclose(table["phase_deg"], np.degrees(np.angle(modulus)), atol=0.006)


def test_scatter_is_shared_by_the_tests_of_a_mounting():
    """Between mountings |E*| differs more than tests within one do."""
    own = [invented(4 * n, seed=7) for n in range(12)]
    between, within = [], []
    for campaign in own:
        for s in campaign.specimens:
            level = []
            for t in campaign.isotherms:
                rows = campaign.at(s, t)
                f = np.log(campaign.tests.loc[rows, "frequency_Hz"])
                line = np.polynomial.Polynomial.fit(f, campaign.own[rows].real, 1)
                within.append(np.std(campaign.own[rows].real - line(f), ddof=2))
                level.append(line(f.mean()))
            between.append(np.std(level, ddof=1))
    assert 1.5 < np.sqrt(np.mean(np.square(between))) / np.sqrt(np.mean(np.square(within))) < 4.0
    assert all(abs(campaign.warmer).max() <= 0.5 for campaign in own)


def test_channels(cylinder):
    omega = cylinder.omega
    assert change(cylinder, Fault("channel_delay", 2e-4)) == pytest.approx(2e-4j * omega)
    turned = np.full(omega.size, -1j * np.radians(1.5))
    assert change(cylinder, Fault("phase_offset", -1.5)) == pytest.approx(turned)
    slow, ratio = change(cylinder, Fault("low-pass filter", 200.0)), omega / 2.0 / np.pi / 200.0
    assert slow.imag == pytest.approx(np.arctan(ratio))
    assert np.exp(slow.real) == pytest.approx(np.hypot(1.0, ratio))


def test_head_and_clamp(bending):
    before = np.exp(recorded(bending))
    massive = np.exp(recorded(bending, Fault("moving_mass", 0.2)))
    assert massive - before == pytest.approx(-FORM_FACTOR * 0.2 * bending.omega**2, rel=1e-9)
    clamped = np.exp(recorded(bending, Fault("loose_clamp", 4e-12, specimen="S2")))
    mine = bending.at("S2")
    assert 1.0 / clamped - 1.0 / before == pytest.approx(4e-12 * mine, abs=1e-20)
    rubbed = np.exp(recorded(bending, Fault("guide_friction", 5e7))) - before
    amplitude = bending.tests["amplitude_m"].to_numpy()
    constant = np.full(amplitude.size, 5e7 * np.median(amplitude))
    assert rubbed.imag * amplitude == pytest.approx(constant, rel=1e-9)
    assert abs(rubbed.real).max() < 1.0


def test_form_factor_is_that_of_beam_theory():
    """A cantilever of width b(x), clamped at the wide end: deflection by P x of the moment, integrated."""
    x = np.linspace(0.0, 0.25, 20001)
    width = 0.025 + (0.056 - 0.025) * x / 0.25
    inertia = 0.025 * width**3 / 12.0
    assert pytest.approx(np.trapezoid(x**2 / inertia, x), rel=1e-6) == FORM_FACTOR


def test_heat_and_wrong_temperatures_move_tests_along_the_law(cylinder):
    warm = change(cylinder, Fault("temperature_bias", 0.8, temperature=20.0))
    rows = cylinder.at(None, 20.0)
    n = rows.size
    moved = cylinder.response(np.full(n, 0.8), np.ones(n)) - cylinder.response(np.zeros(n), np.ones(n))
    assert warm[rows] == pytest.approx(moved[rows]) and not warm[~rows].any()
    assert (warm[rows].real < 0.0).all()
    heated = Chain(cylinder)
    CHAIN["self_heating"](heated, Fault("self_heating", 3.0))
    power = cylinder.omega * np.exp(recorded(cylinder)).imag
    assert heated.warming == pytest.approx(3.0 * power / power.max())


def test_loss_of_stiffness_follows_amplitude_and_order(bending, cylinder):
    amplitude = bending.tests["amplitude_m"].to_numpy()
    softened = np.exp(change(bending, Fault("strain_softening", 0.1)))
    assert softened == pytest.approx(1.0 - 0.1 * amplitude / amplitude.max())
    worn = np.exp(change(cylinder, Fault("damage", 0.2)))
    order = cylinder.tests["order"]
    assert worn[order.argmax()] == pytest.approx(0.8) and worn[order.argmin()] == pytest.approx(1.0)


def test_a_secondary_process_peaks_where_it_is_said(cylinder):
    peak = -np.log(2.0 * np.pi * 1.0)  # 1 Hz at 20 degC
    fault = Fault("secondary_process", 5e8, shape=(peak, 60e3, 1.0))
    extra = np.exp(recorded(cylinder, fault)) - np.exp(recorded(cylinder))
    there = cylinder.at(None, 20.0) & (cylinder.tests["frequency_Hz"] == 1.0).to_numpy()
    assert extra[there] == pytest.approx(np.full(there.sum(), 2.5e8 + 2.5e8j), rel=1e-9)


@pytest.mark.parametrize("kind", [kind for kind in (*CHAIN, *PEN) if kind not in CATALOGUE])
def test_what_is_outside_the_catalogue_hits_its_own_tests_alone(kind):
    campaign = next(c for c in map(lambda n: invented(n, seed=4), range(8)) if len(c.specimens) > 2)
    rng = np.random.default_rng(2)
    drawn = plan._slip if kind in (*plan.SLIPS, "masked pair of bad tests") else plan._outside
    fault = drawn(campaign, kind, {}, rng) if drawn is plan._outside else drawn(campaign, kind, rng)
    before, after = put(campaign, ()), put(campaign, (fault,))
    rows = fault.rows(campaign)
    if kind in ("exchanged specimens", "copied block"):
        rows |= campaign.at(fault.other, fault.temperature)
    if kind == "exchanged isotherms":
        rows |= campaign.at(fault.specimen, fault.other)
    differ = (before != after).any(axis=1).to_numpy()
    assert differ.any() and not (differ & ~rows).any()
    assert np.isfinite(after[["E_MPa", "phase_deg"]]).all(axis=None)


def test_broken_isotherms_break_causality_beyond_scatter():
    """Less modulus in slow tests is a steeper line, which asks for more phase; they have less."""
    campaign = invented(3, seed=1)
    assert campaign.broken == campaign.isotherms[-1]
    whole = replace(campaign, own=np.zeros(len(campaign.tests), complex))
    change = (campaign.unmoved() - whole.unmoved())[campaign.at("S1", campaign.broken)]
    assert change[0].real < -0.1
    assert np.degrees(change[0].imag) < -2.0
    assert abs(change[-1].imag) < np.radians(1.5)


def test_a_cause_comes_at_multiples_of_its_limit_in_its_place(bending):
    sizes = {"S1": 2e-12, "S2": 1e-12}
    limits = {
        "loose_clamp": {"value": 1e-12, "unit": "1/Pa", "confined_to": "specimen", "places": sizes},
        "phase_offset": {"value": 0.4, "unit": "deg"},
        "guide_friction": {"value": 1e7, "unit": "N"},  # of another unit: not taken for pascals
    }  # fmt: skip
    drawn = [case for number in range(40) for case in plan.cases(bending, number, limits, {})]
    singles = [case for case in drawn if case.suite == "catalogue"]
    assert {case.faults[0].kind for case in singles} == {"loose_clamp", "phase_offset"}
    for case in singles:
        fault = case.faults[0]
        limit = sizes[fault.specimen] if fault.kind == "loose_clamp" else 0.4
        assert abs(fault.size) == pytest.approx(case.ratio * limit)
    assert {case.ratio for case in singles} == {1.0, 2.0, 3.0}
    assert any(case.faults[0].size < 0.0 for case in singles if case.faults[0].kind == "phase_offset")
    assert {f.kind for case in drawn if case.suite == "outside" for f in case.faults} == set(plan.OUTSIDE)


def test_a_fault_of_one_place_comes_at_three_of_its_own_limits_where_that_is_physical(bending):
    where, t = {"specimen": "S1", "temperature_C": None}, bending.isotherms[0]
    offsets = [where | {"value": 0.7}, where | {"specimen": "S2", "value": 4.0}]
    temperatures = [where | {"temperature_C": t, "value": 3.0}]
    limits = {
        "offset of one specimen": {"places": offsets},
        "temperature of one specimen on one isotherm": {"places": temperatures},
    }
    drawn = [case for number in range(40) for case in plan.cases(bending, number, {}, limits)]
    faults = [case.faults[0] for case in drawn if case.suite == "place"]
    assert {(fault.kind, fault.specimen) for fault in faults} == {("offset of one specimen", "S1")}
    assert all(abs(fault.size) == pytest.approx(2.1) for fault in faults)


def test_no_table_is_handed_over_with_phases_below_zero():
    tests, limits = invented(0, 1).tests, {"phase_offset": {"value": 0.5, "unit": "deg"}}
    flat = Campaign("flat", "bending", tests, lambda w, t: np.full(w.size, 23.0 + 0.02j), 0.0, 0.0)
    for number in range(6):
        for case in plan.cases(flat, number, limits, {}):
            if case.suite == "catalogue":
                assert put(flat, case.faults)["phase_deg"].min() > 0.2
