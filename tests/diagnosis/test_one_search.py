"""Causes in a table that holds more than its law, its causes and its scatter."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from test_doubts import CAUSES, LAW, SCATTER
from test_doubts import table as campaign

from asphalt_nscd.diagnosis.causes import CATALOGUE
from asphalt_nscd.diagnosis.model import discrepancy, fit_beside, laboratory, likelihood, start
from asphalt_nscd.diagnosis.model.joint import Candidate, Fitted, Joint
from asphalt_nscd.diagnosis.observed import scatter
from asphalt_nscd.diagnosis.observed.observations import Observations
from asphalt_nscd.diagnosis.search import limits as sizes
from asphalt_nscd.diagnosis.search import one_search
from asphalt_nscd.diagnosis.search.diagnose import diagnose

pytestmark = pytest.mark.slow

SECOND = CAUSES["secondary_process"]
CYLINDERS = (-10.0, 4.0, 21.0, 37.0, 54.0), (0.1, 0.5, 1.0, 5.0, 10.0, 25.0)
TRAPEZOIDS = (-10.0, 0.0, 10.0, 15.0, 20.0, 30.0), (3.0, 6.0, 10.0, 25.0, 30.0, 40.0)


def table(
    offset: float = 0.0, delay: float = 0.0, broken: float = 1.0, seed: int = 3, design: tuple = CYLINDERS
) -> Observations:
    """Three specimens; hot isotherms break causality, `broken` times; offset [deg] and delay [s] in every test."""

    def effect(omega, temperature):
        frequency = omega / (2.0 * np.pi)
        hot = np.where(temperature > 30.0, (temperature - 30.0) / 24.0, 0.0)
        departure = 0.08 * np.log(frequency) ** 2 - 1j * np.radians(4.0 * np.log(frequency / 0.1))
        return broken * hot * departure + 1j * (np.radians(offset) + omega * delay)

    return campaign(effect, seed, *design)


def fit(observed: Observations) -> tuple[Joint, Fitted]:
    return start.fit_spectrum(observed, scatter.stated(observed, *SCATTER, 0.03))


def begin(observed: Observations) -> fit_beside.State:
    """Beside the discrepancy and what a laboratory adds."""
    joint, fitted = fit(observed)
    return fit_beside.begin(laboratory.alone(joint), fitted)


@cache
def begun_with(**effects: object) -> fit_beside.State:
    """Of `table(**effects)`, which several tests ask for."""
    return begin(table(**effects))


def limits_of(state: fit_beside.State, survey: one_search.Survey) -> tuple:
    """Limits, causes without one, and what else `detection_limits` gives."""
    threshold = sizes.chance_threshold(state, survey, 500, np.random.default_rng(0))
    return sizes.detection_limits(state, survey, threshold)


@cache
def limits_with(**effects: object) -> tuple[one_search.Survey, dict, list]:
    """What it shows of each cause, limits, and causes without one."""
    state = begun_with(**effects)
    survey = one_search.survey(state, CATALOGUE)
    return survey, *limits_of(state, survey)[:2]


def climbed(observed: Observations) -> tuple[list, fit_beside.State, one_search.Survey]:
    return one_search.climb(begin(observed), CATALOGUE, 1000, np.random.default_rng(0))


@pytest.mark.parametrize("hidden", [{"offset": 3.0}, {"offset": -3.0}, {"delay": 6e-4}, {"delay": -6e-4}])
def test_an_effect_of_all_tests_is_found_beside_broken_isotherms(hidden):
    taken, state, survey = climbed(table(**hidden))
    name, size = (
        ("phase_offset", hidden["offset"]) if "offset" in hidden else ("channel_delay", hidden["delay"])
    )
    found = [one.candidate.cause.name for one in taken]
    assert name in found
    candidate = next(c for c in state.fitted.active if c.cause.name == name)
    value, error = sizes.estimates(state, survey)[candidate.key]
    assert abs(value - size) < 3.0 * error and error < 0.1 * abs(size)
    sizes_known = fit_beside.taken_amplitude(state, candidate).std_error * candidate.typical[0]
    assert sizes_known < error < 2.0 * sizes_known
    assert one_search.hangs_on(state, candidate) == []


def test_a_second_process_is_found_by_what_it_gains_however_uncertain_its_size():
    """Its strength alone is less than three standard errors once a part is left out: its exponent may stand for it."""
    observed = table(broken=0.0, design=TRAPEZOIDS)
    with_second = SECOND.apparent(observed.modulus, np.array([4e9, -2.0, 60.0, 0.6]), observed)
    taken, state, _ = climbed(replace(observed, modulus=with_second))
    assert [one.candidate.cause.name for one in taken] == ["secondary_process"]
    candidate = state.fitted.active[0]
    assert one_search.hangs_on(state, candidate) == []
    rows = np.flatnonzero(observed.isotherm != 20.0)
    assert fit_beside.taken_amplitude(state, candidate, rows).z < one_search.SURVIVES
    # What is judged in its place is no more than a step from the fit: it is the fit's own, and that of one anew.
    before = taken[0].before
    everything = np.arange(observed.size)
    gain = before.misfit - taken[0].after.misfit
    of = one_search._misfit_of
    assert of(before, everything) - of(taken[0].after, everything) == pytest.approx(gain, abs=0.5)


def test_a_second_process_that_one_isotherm_alone_asks_for_hangs_on_it():
    observed = table(broken=0.0, design=TRAPEZOIDS)
    with_second = SECOND.apparent(observed.modulus, np.array([4e9, -2.0, 60.0, 0.6]), observed)
    here = observed.isotherm == 20.0
    odd = replace(observed, modulus=np.where(here, with_second, observed.modulus))
    state = fit_beside.refit_causes(begin(odd), (Candidate(SECOND, None, (2e9, -2.0, 60.0, 0.6)),))
    assert "20 degC" in one_search.hangs_on(state, state.fitted.active[0])


def test_the_cost_of_shapes_is_that_of_an_integral_over_them():
    """Errors of 0.1, 0.2 and 0.5 typical sizes, whose starts span 2.1 decades, 30 of 30 kJ/mol, and nothing."""
    observed = table(broken=0.0, design=TRAPEZOIDS)
    candidate = Candidate(SECOND, None, (1e9, -2.0, 60.0, 0.6))
    law, errors = np.zeros(2), np.array([3.0, 0.1, 0.2, 0.5])
    turn = np.eye(4)
    turn[1:, 0] = 0.3  # shapes that go with the amplitude: what is left to them at its best counts
    precision = np.diag(np.concatenate([np.ones(2), np.zeros(4)]))
    precision[2:, 2:] = turn.T @ np.diag(errors**-2.0) @ turn
    fitted = Fitted(law, np.zeros(0), (candidate,), 0.0, law, law, np.zeros((1, 6)), precision, np.zeros(6))
    spans = np.ptp(np.array(SECOND.shapes(observed)), axis=0) / candidate.typical[1:]
    u = np.linspace(-4.0, 4.0, 161)
    share = 1.0
    for error, span in zip(errors[1:], spans, strict=True):
        even = 1.0 / (span + np.sqrt(2.0 * np.pi))  # density at the fit of a prior about each of even starts
        share *= np.trapezoid(even * np.exp(-0.5 * (u / error) ** 2), u)
    assert fit_beside.shape_cost(fitted, candidate, observed) == pytest.approx(-2.0 * np.log(share), rel=1e-3)
    single = Candidate(CAUSES["channel_delay"], None, (1e-4,))
    assert fit_beside.shape_cost(fitted, single, observed) == 0.0


def test_what_competes_for_a_name_has_a_size_and_shapes_of_its_own():
    begun = begun_with(delay=6e-5, broken=0.0, design=TRAPEZOIDS)

    def stands(name: str, *values: float) -> tuple[bool, bool]:
        state = fit_beside.refit_causes(begun, (Candidate(CAUSES[name], None, values),))
        taken = state.fitted.active[-1]
        return one_search.stands(begun, state, taken, fit_beside.taken_amplitude(state, taken)), bool(
            taken.pinned
        )

    assert stands("channel_delay", 6e-5) == (True, False)
    assert stands("guide_friction", 1e6)[0] is False  # its interval holds zero


@pytest.mark.parametrize("strength", [1e9, 2e9])
def test_a_second_process_that_shifts_as_fast_as_half_the_mix_is_found(strength):
    """From 30 and 60 kJ/mol with an exponent of 0.6 alone, its size seems to be below zero."""
    observed = table(broken=0.0)
    with_second = SECOND.apparent(observed.modulus, np.array([strength, -1.2, 82.0, 0.8]), observed)
    taken, state, survey = climbed(replace(observed, modulus=with_second))
    assert [one.candidate.cause.name for one in taken] == ["secondary_process"]
    candidate = state.fitted.active[0]
    value, error = sizes.estimates(state, survey)[candidate.key]
    assert abs(value - strength) < 2.0 * error and error < 0.5 * strength
    assert candidate.values[1:] == pytest.approx((-1.2, 82.0, 0.8), rel=0.1)


@pytest.mark.parametrize("likelier", ["secondary_process", "channel_delay"])
def test_of_causes_as_good_the_likelier_is_named_whatever_its_shapes(monkeypatch, likelier):
    odds = {"secondary_process": 0.0, "channel_delay": 0.0} | {likelier: 0.1}  # together possible, not alone
    monkeypatch.setattr(one_search, "shape_cost", lambda *_: 0.0)
    monkeypatch.setattr(one_search, "stands", lambda *_: True)
    monkeypatch.setattr(one_search, "log_odds", lambda candidate, *_: odds.get(candidate.cause.name, -20.0))
    begun = begun_with(delay=6e-5, broken=0.0, design=TRAPEZOIDS)
    found = one_search._next(begun, one_search.survey(begun, CATALOGUE), 500, np.random.default_rng(0))
    assert found.candidate.cause.name == likelier
    assert found.probability == pytest.approx(1.0 / (1.0 + 2.0 * np.exp(-0.1)), rel=1e-6)
    assert found.rivals


def test_the_limit_of_a_second_process_counts_wide_ones(monkeypatch):
    """With an exponent of 0.5 it takes about twice the strength of one of 0.8."""
    begun = begun_with(broken=0.0, design=TRAPEZOIDS)
    every = SECOND.shapes(begun.plain.observed)

    def limit(*exponents: float) -> float:
        shapes = tuple(shape for shape in every if shape[-1] in exponents)
        monkeypatch.setattr(type(SECOND), "shapes", lambda self, observed: shapes)
        surveyed = one_search.survey(begun, CATALOGUE)
        limits = limits_of(begun, surveyed)[0]
        return limits["secondary_process", None]

    narrow, wide, of_all = (limit(*exponents) for exponents in ((0.8,), (0.5,), (0.5, 0.65, 0.8)))
    assert wide > 1.9 * narrow
    assert 1.5 * narrow < of_all < wide


@pytest.mark.parametrize(
    ("values", "carried", "stands"),
    [
        ((1e9, -3.0, 30.0, 0.6), [], True),
        ((1e9, -3.0, 30.0, 0.6), ["10 Hz"], False),
        ((1e9, -3.0, 10.0, 0.6), [], False),  # its energy is at a bound
        ((1e9, -3.0, 30.0, 1.0), [], False),
    ],
)
def test_a_cause_with_shapes_competes_if_all_carry_it_and_no_shape_is_at_a_bound(
    monkeypatch, values, carried, stands
):
    monkeypatch.setattr(one_search, "hangs_on", lambda state, candidate, before: carried)
    own = likelihood.Estimate(np.zeros(0), 0.0, amplitude=9.0, std_error=1.0)
    assert one_search.stands(None, None, Candidate(SECOND, None, values), own) is stands


def test_a_cause_of_an_isotherm_is_no_hindrance_where_that_isotherm_is_left_out():
    """Its parameter is then spoken of by no test: the sizes of the other causes stay finite."""
    observed = table(offset=3.0)
    begun = begin(observed)
    active = (
        Candidate(CAUSES["phase_offset"], None, (2.0,)),
        Candidate(CAUSES["temperature_bias"], 21.0, (0.5,)),
    )
    state = fit_beside.settle(begun.plain, begun.model.processes, begun.fitted, active, begun.variances)
    rows = np.flatnonzero(observed.isotherm != 21.0)
    part = Joint(observed.subset(rows), state.plain.base, state.plain.noise.subset(rows))
    linear = part.linearise(state.fitted.law, state.fitted.scales, state.fitted.active)
    assert np.linalg.eigvalsh(linear.precision).min() > 1e-6
    found = fit_beside.taken_amplitude(state, state.fitted.active[0], rows)
    size, error = (x * active[0].typical[0] for x in (found.amplitude, found.std_error))
    assert error < 0.2 and abs(size - 3.0) < 4.0 * error


def test_broken_isotherms_alone_get_no_established_name():
    taken, state, _ = climbed(table())
    for one in taken:
        candidate = next(c for c in state.fitted.active if c.key == one.candidate.key)
        assert one_search.hangs_on(state, candidate), one.candidate.key


def test_what_breaks_the_hot_isotherms_is_sized_there_and_nowhere_else():
    state = begun_with(broken=1.0)
    sizes = dict(zip(state.model.processes.described, np.sqrt(state.variances), strict=True))

    def size(part, isotherm):
        return sizes[discrepancy.Process("isotherm", part, isotherm)]

    assert min(size("modulus", 54.0), size("phase", 54.0)) > 2.0
    assert max(size("modulus", -10.0), size("phase", -10.0), size("modulus", 4.0)) < 1.0


def test_the_reduced_likelihood_is_that_of_the_whole_covariance():
    """Woodbury against the dense covariance, differences between two sets of variances."""
    observed = table().subset(np.arange(0, 90, 3))
    joint, fitted = fit(observed)
    found = discrepancy.processes(joint, fitted)
    model = likelihood.reduce(found, fitted)
    j, law = fitted.jacobian, fitted.precision - fitted.jacobian.T @ fitted.jacobian
    u = found.factor
    differences = []
    for v in (np.full(len(found.described), 0.3), np.linspace(0.1, 2.0, len(found.described))):
        s = np.sqrt(v)[found.block]
        reduced = likelihood._point(model, None, np.log(v)).misfit - 2.0 * np.log1p(v / found.usual**2).sum()
        covariance = np.eye(u.shape[0]) + (u * s) @ (u * s).T
        inverse = np.linalg.inv(covariance)
        precision = j.T @ inverse @ j + law
        residual = fitted.residual
        pull = j.T @ inverse @ residual - (j.T @ residual - fitted.gradient)  # less the pull of the prior
        square = residual @ inverse @ residual - pull @ np.linalg.solve(precision, pull)
        dense = square + np.linalg.slogdet(covariance)[1] + np.linalg.slogdet(precision)[1]
        differences.append((reduced, dense))
    (one, one_dense), (two, two_dense) = differences
    assert one - two == pytest.approx(one_dense - two_dense, rel=1e-6)


def test_a_size_that_rounding_cannot_bear_ends_the_estimate_and_no_more():
    joint, fitted = fit(table())
    model = likelihood.reduce(discrepancy.processes(joint, fitted), fitted)
    absurd = np.full(len(model.processes.described), 1e40)
    assert not np.isfinite(likelihood._point(model, None, np.log(absurd)).objective)
    assert np.isfinite(likelihood.estimate(model, start=absurd).misfit)


def test_the_limit_of_a_cause_in_the_fit_is_its_standard_error_times_what_chance_reaches():
    _, state, survey = climbed(table(delay=6e-4))
    (candidate,) = (c for c in state.fitted.active if c.cause.name == "channel_delay")
    found, _, _ = limits_of(state, survey)
    own = fit_beside.taken_amplitude(state, candidate).std_error * candidate.typical[0]
    assert 4.0 < found[candidate.key] / own < 7.0


@pytest.mark.parametrize("broken", [0.4, 1.0])
def test_a_discrepancy_that_may_take_a_cause_up_raises_its_limit(broken):
    """Where it takes up as much as an error of temperature can be, the table shows none."""
    survey, found, unseen = limits_with(broken=broken)
    ratio = {
        one.key: found.get(one.key, np.inf) / (estimate.std_error * one.typical[0])
        for one, estimate in zip(survey.candidates, survey.estimates, strict=True)
    }
    assert ratio["temperature_bias", 37.0] > 1.25 * ratio["phase_offset", None]
    assert (("temperature_bias", 37.0) in [one.key for one in unseen]) == (broken == 1.0)


def test_a_spring_that_the_law_has_followed_gets_its_name():
    """Slow elements leave 1e-3 of its direction; the law's end is told by the loss modulus, which it does not move."""
    warm = table(broken=0.0, design=((10.0, 20.0, 30.0, 40.0, 50.0, 60.0), TRAPEZOIDS[1]))
    spring = 150e6
    observed = replace(
        warm,
        modulus=warm.modulus + spring,
        static_modulus=LAW.static_modulus,
        test_type="bending",
    )
    taken, state, _ = climbed(observed)
    (one,) = taken
    assert one.candidate.cause.name == "guide_stiffness"
    error = fit_beside.taken_amplitude(state, state.fitted.active[0]).std_error * 2e7
    assert abs(state.fitted.active[0].values[0] - spring) < 3.0 * error and error < 0.1 * spring


@pytest.mark.parametrize("seed,delay", [(4, 1.6e-4), (6, -1.6e-4), (7, -1.6e-4), (8, 1.6e-4)])
def test_a_law_that_followed_a_delay_gives_it_back(seed, delay):
    """Of three isotherms and frequencies a rough law follows a delay: none of these had its name at one roughness."""
    observed = campaign(
        lambda omega, temperature: 1j * delay * omega, seed, (-5.0, 10.0, 25.0), (3.0, 10.0, 30.0)
    )
    ladder = diagnose(observed, draws=200).ladder
    (rung,) = ladder.rungs
    assert rung.candidate.cause.name == "channel_delay" and rung.probability > 0.95
    assert (
        abs(rung.candidate.values[0] - delay) < 3.0 * ladder.std_errors(rung.candidate)[0] < 0.8 * abs(delay)
    )


def test_misfits_of_laws_of_different_roughness_compare():
    observed = campaign(frequencies=(1.0, 5.0, 25.0))
    joint, fitted = fit(observed)
    found = discrepancy.processes(joint, fitted)
    none = np.full(len(found.described), discrepancy.LEAST)
    both = []
    for roughness in (0.1, 0.8):
        one = Joint(observed, replace(joint.spectrum, roughness=roughness), joint.noise)
        state = fit_beside.settle(one, found, fitted, (), none)
        both.append((state.misfit, -2.0 * start.marginal_likelihood(state.wide, state.fitted)))
    (smooth, as_smooth), (rough, as_rough) = both
    assert rough - smooth > 10.0 and rough - smooth == pytest.approx(as_rough - as_smooth, abs=1.0)


def test_both_of_the_channel_may_be_chance_once_in_two_hundred_tables(monkeypatch):
    """Of a thousand draws, four may be as large as these effects and six may not."""
    observed = campaign(
        lambda omega, _: 1j * (3e-4 * omega - np.radians(3.4)),
        3,
        (0.0, 10.0, 20.0, 30.0),
        (1.0, 3.0, 10.0, 30.0),
    )
    begun = begin(observed)
    surveyed = one_search.survey(begun, CATALOGUE)
    for larger, named in ((4, 2), (6, 0)):
        draws = np.repeat([0.0, 1e3], [1000 - larger, larger])
        monkeypatch.setattr(one_search, "largest_by_chance", lambda *_, draws=draws: draws)
        found = one_search._both_of_the_channel(begun, surveyed, 1000, None)
        assert len(found) == named and all(one.p_value < 0.01 for one in found)


@pytest.mark.parametrize("sign,seed", [(1.0, 3), (1.0, 5), (-1.0, 4)])
def test_an_offset_and_a_delay_that_a_discrepancy_takes_up_together_both_get_their_names(sign, seed):
    """At a few frequencies neither gains anything alone."""

    def both(omega, temperature):
        return sign * 1j * (3e-4 * omega - np.radians(3.4))

    ladder = diagnose(campaign(both, seed, (0.0, 10.0, 20.0, 30.0), (1.0, 3.0, 10.0, 30.0)), draws=200).ladder
    found = {rung.candidate.cause.name: rung for rung in ladder.rungs}
    assert set(found) == {"channel_delay", "phase_offset"}
    for name, size in (("channel_delay", 3e-4), ("phase_offset", -3.4)):
        error = ladder.std_errors(found[name].candidate)[0]
        (value,) = [one.values[0] for one in ladder.fitted.active if one.cause.name == name]
        assert abs(value - sign * size) < 3.0 * error < 0.5 * abs(size) and found[name].probability > 0.95
        assert found[name].p_value < 0.01  # once 0.5, of one that its family had let in
