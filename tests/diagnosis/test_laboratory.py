"""What every laboratory adds: sized from the table, and no fault."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from test_diagnose import LAW, table

from asphalt_nscd.diagnosis.model import fit_beside, laboratory, likelihood, start
from asphalt_nscd.diagnosis.model.joint import Joint
from asphalt_nscd.diagnosis.observed import scatter
from asphalt_nscd.diagnosis.search.diagnose import diagnose

NOISE = 0.01, np.radians(0.3), 0.03


def warmed(kelvin, seed=3):
    """A table whose isotherms, or specimens' isotherms, are off by kelvin (4, 6), not told."""
    temperatures = np.array([-10.0, 0, 10, 15, 20, 30])

    def effect(modulus, specimen, temperature, omega):
        at = np.searchsorted(temperatures, temperature)
        return LAW.complex_modulus(omega, temperature + np.broadcast_to(kelvin, (4, 6))[specimen, at])

    return table(seed, effect)


def slowed(times, seed=3):
    """A table whose specimens (4,) have relaxation times longer by this much of ln time."""

    def effect(modulus, specimen, temperature, omega):
        return LAW.complex_modulus(omega * np.exp(np.asarray(times)[specimen]), temperature)

    return table(seed, effect)


def fitted(observed):
    return start.fit_spectrum(observed, scatter.stated(observed, *NOISE))


def begun(joint, fit):
    return fit_beside.begin(laboratory.alone(joint), fit)


@cache
def still():
    """Of a table in which nothing moved."""
    return begun(*fitted(table(3)))


def sizes(state):
    return laboratory.inferred(state.model.processes, state.variances).sizes


def test_a_column_is_what_one_kelvin_or_one_mounting_does():
    observed = table(0)
    joint, fit = fitted(observed)
    roots = laboratory._roots(joint, fit, joint.noise.block)
    first = observed.isotherm == observed.isotherms[1]
    warmer = np.where(first, 0.5, 0.0)
    change = np.log(
        joint.base.modulus(fit.law, observed.omega, observed.temperature + warmer)[0]
        / joint.base.modulus(fit.law, observed.omega, observed.temperature - warmer)[0]
    )
    of_isotherms = roots["isotherm temperature"]
    column = of_isotherms[:, 1]
    assert np.allclose(column, change, atol=3e-3 * np.abs(change).max()) and not column[~first].any()
    of_mountings = roots["specimen temperature"]
    assert of_mountings.shape == (observed.size, 24)
    assert np.allclose(of_mountings.sum(axis=1), of_isotherms.sum(axis=1))
    assert np.allclose(roots["mounting, phase"], 1j * roots["mounting, modulus"])
    mine = observed.specimen == 1
    slower = np.log(
        joint.base.modulus(fit.law, observed.omega * np.exp(0.1 * mine), observed.temperature)[0]
        / joint.base.modulus(fit.law, observed.omega * np.exp(-0.1 * mine), observed.temperature)[0]
    )
    times = 0.2 * roots["specimen times"][:, 1]
    assert np.allclose(times, slower, atol=3e-3 * np.abs(slower).max()) and not times[~mine].any()
    alone = joint.observed.subset(np.flatnonzero(mine))
    single = Joint(
        replace(alone, names=alone.names[1:2], specimen=alone.specimen - 1), joint.base, joint.noise
    )
    assert "specimen times" not in laboratory._roots(single, fit, np.zeros(alone.size, np.int64))


@pytest.mark.parametrize("kind", ["specimen temperature", "mounting, modulus"])
def test_sizes_follow_the_table(kind):
    random = np.random.default_rng(5)
    drawn = random.standard_normal((4, 6))
    observed = table(3)
    block = observed.specimen, np.searchsorted(observed.isotherms, observed.isotherm)
    moved = (
        warmed(1.0 * drawn)
        if kind == "specimen temperature"
        else replace(observed, modulus=observed.modulus * np.exp(0.04 * drawn[block]))
    )
    small, large = (sizes(state)[kind] for state in (still(), begun(*fitted(moved))))
    usual, drawn_size = (
        laboratory.LABORATORY[kind].size,
        {"specimen temperature": 1.0}.get(kind, 0.04) * drawn.std(),
    )
    assert (
        small < usual and 0.7 * drawn_size < large < 1.1 * drawn_size
    )  # drawn to the usual size by its prior


@pytest.mark.parametrize("few", [False, True])
def test_what_reaches_one_isotherm_alone_has_its_number(few):
    """Also where two tests of the last isotherm are left, of two specimens that another one has each."""
    whole = table(0)
    last, other = whole.isotherm == whole.isotherms[-1], whole.isotherms[whole.specimen % 3]
    at_one = (whole.isotherm == other) | (whole.specimen > 1)
    kept = np.where(last, (whole.frequency == whole.frequencies[0]) & (whole.specimen < 2), at_one)
    observed = whole.subset(np.flatnonzero(kept)) if few else whole
    found = laboratory.processes(*fitted(observed))
    kinds = np.array([one.kind for one in found.described])[found.block]
    place = np.tile(observed.isotherm, 2)
    held = observed.held_isotherms
    assert held.size == 6 - few
    reached = np.array([found.factor[place == t].any(axis=0) for t in held])
    alone = np.where(reached.sum(axis=0) == 1, reached.argmax(axis=0), -1)
    assert (found.isotherm == alone).all()
    if not few:
        assert set(kinds[alone < 0]) == {"spectrum", "specimen", "specimen times", "all"}
    mixed = (
        (found.isotherm >= 0) & (found.isotherm[:, None] >= 0) & (found.isotherm[:, None] != found.isotherm)
    )
    assert not found.gram[mixed].any()


def test_the_scatter_holds_every_effect_once():
    """Two tests of one mounting share its level, its phase and its temperature; of one isotherm, the temperature."""
    joint, fit = fitted(table(3))
    joint = Joint(joint.observed, joint.base, replace(joint.noise, shared=0.5 * joint.noise.within))
    state = begun(joint, fit)
    with_it, found = state.everyday, laboratory.inferred(state.model.processes, state.variances)
    fit = state.fitted
    assert not with_it.noise.shared.any()
    n, observed = joint.observed.size, joint.observed
    per_kelvin, per_time = (
        of(joint, fit.law) for of in (laboratory._temperature_slope, laboratory._time_slope)
    )
    same = observed.isotherm[:, None] == observed.isotherm
    own = observed.specimen[:, None] == observed.specimen
    mounted = same & own
    sizes = found.sizes
    kelvin = sizes["isotherm temperature"] ** 2 * same + sizes["specimen temperature"] ** 2 * mounted
    covariance = with_it.noise.discrepancy @ with_it.noise.discrepancy.T
    for part, name in enumerate(("modulus", "phase")):
        rows = slice(part * n, (part + 1) * n)
        along, slower = ((per_kelvin.real, per_time.real), (per_kelvin.imag, per_time.imag))[part]
        expected = np.outer(along, along) * kelvin + found.sizes[f"mounting, {name}"] ** 2 * mounted
        expected += np.outer(slower, slower) * found.sizes["specimen times"] ** 2 * own
        assert np.allclose(covariance[rows, rows], expected, rtol=1e-9, atol=1e-15)


def test_limits_of_a_careful_laboratory_do_not_grow():
    """In K, 1/Pa, deg and s, a tenth above what they were in 2026; with fixed sizes the isotherms had 1.5 K."""
    limits = diagnose(table(3), draws=500).ladder.limits
    most = {
        ("temperature_bias", 10.0): 0.93, ("temperature_bias", 15.0): 0.82, ("temperature_bias", 20.0): 0.87,
        ("loose_clamp", "a"): 2.58e-12, ("loose_clamp", "d"): 2.47e-12, ("phase_offset", None): 0.53,
        ("channel_delay", None): 2.9e-5, ("moving_mass", None): 0.15, ("self_heating", None): 0.35,
    }  # fmt: skip
    assert not {key: limits[key] for key, value in most.items() if limits[key] > value}


def test_a_laboratory_that_holds_its_specimens_alike_holds_its_isotherms():
    """The size is that of the drawn isotherms where specimens scatter as much, and small where they do not."""
    random = np.random.default_rng(4)
    together = random.uniform(-0.3, 0.3, 6)
    careless = sizes(begun(*fitted(warmed(together + random.uniform(-0.3, 0.3, (4, 6))))))
    careful = sizes(still())
    assert careful["isotherm temperature"] < 0.08
    assert 0.08 < careless["isotherm temperature"] < 0.4


def test_usual_errors_are_those_of_the_standard_and_of_measured_campaigns():
    """In K, relative, rad and ln time, with the spread of their logarithm between laboratories."""
    assert {name: (one.size, one.spread) for name, one in laboratory.LABORATORY.items()} == {
        "isotherm temperature": (0.15, 1.0), "specimen temperature": (0.2, 0.7), "mounting, modulus": (0.01, 0.6),
        "mounting, phase": (pytest.approx(np.radians(0.15)), 0.6), "specimen times": (0.1, 1.0),
    }  # fmt: skip


def test_one_control_holds_isotherms_and_specimens():
    """Logarithms of both sizes spread by 1 and 0.7 and go together by 0.7; the usual is one."""
    for of_specimens in (1.0, 0.5, 3.0):
        size, spread = laboratory._same_control(of_specimens**2)
        assert size == pytest.approx(of_specimens) and spread == pytest.approx(np.sqrt(1.0 - 0.49))


def test_a_typical_variance_is_that_of_the_posterior():
    """Of one process and one direction the integral is done by the trapezoid."""
    state = still()
    found = state.model.processes
    k = [one.kind for one in found.described].index("isotherm temperature")
    columns = found.factor[:, found.block == k]
    free = [likelihood.directions(state.model, state.linear, columns[:, [at]]) for at in (1, 2)]
    logarithm = np.linspace(-4.0, 4.0, 401)
    weight = np.zeros(401)
    for one in free:
        for at, away in enumerate(logarithm):
            v = np.where(np.arange(state.variances.size) == k, np.exp(2.0 * away), state.variances)
            point = likelihood._point(state.model, one, np.log(v)).objective - found.prior(v)[0]
            weight[at] += np.exp(-0.5 * (point + away**2))
    expected = np.exp((weight * 2.0 * logarithm).sum() / weight.sum())
    told = likelihood.typical_variance(state.model, free, k, (1.0, 1.0), state.variances)
    assert told == pytest.approx(expected, rel=0.1)


def test_a_size_without_one_is_the_root_of_its_least_variance():
    """Of specimens, any one of which may be at fault; it is known then, and has no spread."""
    state = still()
    found = laboratory.processes(state.plain, state.linear)  # those of the state are known already
    k = [one.kind for one in found.described].index("specimen times")
    known = laboratory.sizes_beside_fault(found, state.linear, state.variances)
    model, least = likelihood.reduce(found, state.linear), np.inf
    columns = found.factor[:, found.block == k]
    every = likelihood.directions(model, state.linear, columns)
    for at in range(columns.shape[1]):
        free = every.column(at)
        least = min(least, likelihood.estimate(model, free, state.variances).variances[k])
    assert known.usual[k] ** 2 == pytest.approx(least, rel=1e-9) and known.spread[k] == 0.0


def test_isotherms_within_the_tolerance_of_the_standard_are_no_fault():
    """Each seems far off by the scatter of the tests alone."""
    found = diagnose(warmed(np.array([0.3, -0.4, 0.2, -0.3, 0.4, -0.2])), draws=500)
    assert not found.ladder.rungs and found.verdict == "explained"


def test_an_isotherm_far_outside_is_one():
    found = diagnose(warmed(np.array([0.0, 0.0, 3.0, 0.0, 0.0, 0.0])), draws=500)
    (rung,) = found.ladder.rungs
    assert rung.candidate.key == ("temperature_bias", 10.0) and rung.probability > 0.95
    low, high = (
        rung.candidate.values[0] + side * 1.96 * found.ladder.std_errors(rung.candidate)[0]
        for side in (-1, 1)
    )
    assert low < 3.0 < high


def test_specimens_whose_times_differ_have_no_loose_clamp():
    """The coldest tests of the slower ones look as if a clamp gave way."""
    found = diagnose(slowed((0.03, -0.08, -0.06, -0.37), seed=2), draws=500)
    estimates = [found.ladder.estimates["loose_clamp", name] for name in found.observed.names]
    assert max(abs(value / error) for value, error in estimates) < 3.0
    assert not found.ladder.rungs and found.verdict == "explained"
