"""What is not known of the sizes of a discrepancy widens the standard error of a cause (Kackar and Harville 1984)."""

from __future__ import annotations

from dataclasses import make_dataclass
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.optimize import approx_fprime
from test_discrepancy import small

from asphalt_nscd.diagnosis.causes._cause import Setting, Sweep
from asphalt_nscd.diagnosis.model import fit_beside, likelihood
from asphalt_nscd.diagnosis.model.discrepancy import LEAST, Process
from asphalt_nscd.diagnosis.search import told


def test_the_variance_added_is_slope_times_covariance_times_slope():
    """Slope of the amplitude and curvature of the objective along ln v, both by differences."""
    model, cause = small(np.random.default_rng(5))
    found = likelihood.estimate(model, cause)
    wide = likelihood.widen_error(model, cause, found)
    log_v = np.log(found.variances)

    def slope(at):
        return approx_fprime(at, lambda x: likelihood._point(model, cause, x).objective, 1e-5)

    step = 1e-3 * np.eye(log_v.size)
    curvature = np.array([slope(log_v + e) - slope(log_v - e) for e in step]) / 2e-3
    value, vector = np.linalg.eigh(0.25 * (curvature + curvature.T))
    along = approx_fprime(log_v, lambda x: likelihood._point(model, cause, x).amplitude, 1e-6)
    covariance = vector / (np.maximum(value, 0.0) + likelihood.UNKNOWN**-2) @ vector.T
    added = along @ covariance @ along
    assert added > 0.02 * found.std_error**2
    assert wide.std_error**2 - found.std_error**2 == pytest.approx(added, rel=0.02)
    assert wide.amplitude == found.amplitude


DESCRIBED = (
    Process("all", "phase"),
    Process("isotherm", "phase", 10.0),
    Process("isotherm", "modulus", 30.0),
    Process("specimen", "phase", None, "B"),
    Process("isotherm temperature", "both"),  # a laboratory's
    Process("mounting, phase", "both"),
)
VARIANCES, USUAL = np.array([4.0, 5.0, 6.0, 7.0, 8.0, 0.1]), np.array([0.1, 0.5, 0.5, 0.3, 0.6, 1.0])


@pytest.mark.parametrize(
    ("place", "there"),
    [
        (None, []), ("B", [3]), ("A", []), (10.0, [1]), (Sweep("B", 30.0), [2, 3]), (Sweep("A", 10.0), [1]),
        (Setting(25.0), [0]),
    ],
)  # fmt: skip
def test_what_a_cause_at_its_place_may_have_enlarged_is_begun_without_it(place, there):
    """The discrepancy of that place from none, errors of the laboratory at their usual size at most."""
    expected = np.array([4.0, 5.0, 6.0, 7.0, 0.36, 0.1])
    expected[there] = LEAST
    found = SimpleNamespace(described=DESCRIBED, usual=USUAL)
    assert fit_beside.lean(found, VARIANCES, place) == pytest.approx(expected)


def test_a_likelihood_is_sought_from_several_starts_and_the_least_misfit_is_taken(monkeypatch):
    """As it is, without what all tests have in common, without what a laboratory enlarged, and usual ones."""
    started = []

    def estimate(model, cause, start):
        started.append(start)
        return likelihood.Estimate(np.array([len(started)]), misfit=abs(len(started) - 2.9))

    monkeypatch.setattr(likelihood, "estimate", estimate)
    model = SimpleNamespace(processes=SimpleNamespace(described=DESCRIBED, usual=USUAL))
    assert fit_beside.likeliest(model, VARIANCES).variances == 3
    less = np.array([LEAST, 5.0, 6.0, 7.0, 8.0, 0.1])
    assert len(started) == 4 and started[3] is None
    for one, expected in zip(started, (VARIANCES, less, [4.0, 5.0, 6.0, 7.0, 0.36, 0.1]), strict=False):
        assert one == pytest.approx(expected)
    started.clear()
    assert len(list(fit_beside.answers(model, VARIANCES, "cause", 10.0))) == 2
    assert started[0] == pytest.approx([4.0, LEAST, 6.0, 7.0, 0.36, 0.1]) and started[1] is None
    state = SimpleNamespace(model=model, variances=VARIANCES)
    assert fit_beside.State.hidden.fget(state) == pytest.approx([4.0, 5.0, 6.0, 7.0, 0.0, 0.0])


def test_a_fit_made_afresh_begins_with_the_best_of_several_laws_and_sizes_it_has_known(monkeypatch):
    objective = {"last": 5.0, "first": 3.0, "second": 4.0}
    plain = SimpleNamespace(
        fit=lambda law, *_: SimpleNamespace(objective=objective[law], law=law, active=("cause",))
    )
    sizes = make_dataclass("Sizes", ["usual", "spread"])
    state = SimpleNamespace(
        plain=plain,
        fitted=SimpleNamespace(law="last", scales=None),
        model=SimpleNamespace(processes=sizes(1, 2)),
    )
    monkeypatch.setattr(fit_beside, "first_laws", lambda _: ["first", "second"])
    monkeypatch.setattr(fit_beside.laboratory, "processes", lambda *_: sizes(8, 9))
    monkeypatch.setattr(likelihood, "reduce", lambda *given: given)
    monkeypatch.setattr(likelihood, "estimate", lambda _: SimpleNamespace(variances="start"))
    monkeypatch.setattr(fit_beside, "settle", lambda *given: given)
    _, found, at, active, variances = fit_beside.afresh(state, ("cause",))
    assert (found, at.law, active, variances) == (sizes(1, 2), "first", ("cause",), "start")


@pytest.mark.parametrize(
    ("variance", "lost", "torn"),
    [(0.26, 25.1, [10.0]), (0.26, 24.9, []), (0.24, 99.0, [])],
)
def test_an_isotherm_is_torn_if_its_own_discrepancy_gains_25(variance, lost, torn, monkeypatch):
    """Of half the scatter of a test at least; the other isotherm has none of its own."""

    def estimate(model, cause, start):
        return SimpleNamespace(misfit=7.0 if model == "whole" else 7.0 + lost * (model == "without"))

    monkeypatch.setattr(told.likelihood, "estimate", estimate)
    variances = VARIANCES.copy()
    variances[1:3] = variance, 0.01

    class Model(str):
        processes = SimpleNamespace(described=DESCRIBED)

        def selected(self, kept):
            assert kept.tolist() == [True, False, True, True, True, True]
            return "without"

    observed = SimpleNamespace(held_isotherms=np.array([10.0, 20.0, 30.0]))
    state = SimpleNamespace(
        model=Model("whole"), variances=variances, plain=SimpleNamespace(observed=observed)
    )
    assert told.torn_isotherms(state) == torn
