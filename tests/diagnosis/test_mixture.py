"""The mix over explanations that a table leaves open, by the mixture of their distributions."""

from __future__ import annotations

from types import SimpleNamespace
from typing import NamedTuple

import numpy as np
import pytest
from scipy.stats import t as student

from asphalt_nscd.diagnosis.record import mixture
from asphalt_nscd.diagnosis.record.mixture import Mixture, averaged_over
from asphalt_nscd.diagnosis.search import hypotheses


class Known(NamedTuple):
    """A cause by its name and place."""

    key: tuple


def cause(name, place=None):
    return Known((name, place))


DELAY, OFFSET, CLAMP = cause("channel_delay"), cause("phase_offset"), cause("loose_clamp", "A")
SLOPES = [np.array([[1.0 + 0.5j, 0.2j], [0.5, 1.0 - 0.3j]]), np.array([[0.3, 0.1 + 0.2j], [0.4j, 0.6]])]
VALUES = [np.array([23.0 + 0.30j, 22.0 + 0.40j]), np.array([23.1 + 0.34j, 22.05 + 0.42j])]
COVARIANCES = [np.array([[4e-4, 1e-4], [1e-4, 9e-4]]), np.diag([1e-4, 25e-4])]


def explanation(probability, k, *causes):
    return SimpleNamespace(
        probability=probability,
        causes=causes,
        along=lambda *_: (VALUES[k], SLOPES[k]),
        covariance=COVARIANCES[k],
    )


MIX = Mixture(
    (explanation(0.7, 0, DELAY, CLAMP), explanation(0.3, 1, DELAY, OFFSET)), (10.0, 40.0), np.ones(2, bool)
)


def test_ends_of_an_interval_leave_a_fortieth_of_the_mixture_outside():
    values, errors = MIX.parts(None, None)
    assert values == pytest.approx(np.array(VALUES))
    assert errors[0].real == pytest.approx(np.sqrt([s @ COVARIANCES[0] @ s for s in SLOPES[0].real]))
    assert errors[1].imag == pytest.approx(np.sqrt([s @ COVARIANCES[1] @ s for s in SLOPES[1].imag]))
    low, high = MIX.interval_95(values, errors)
    for part, freedom in (("real", 10.0), ("imag", 40.0)):
        mean, size = getattr(values, part), getattr(errors, part)
        for end, share in ((low, 0.025), (high, 0.975)):
            below = np.array([0.7, 0.3]) @ student(freedom).cdf((getattr(end, part) - mean) / size)
            assert below == pytest.approx(np.full(2, share), abs=1e-9)


def test_specimens_that_lie_apart_widen_the_phase_alone():
    values, errors = MIX.parts(None, None)
    wide = Mixture(MIX.hypotheses, MIX.freedom, MIX.kept, specimens=0.5)
    low, high = wide.interval_95(values, errors)
    mean = 0.7 * VALUES[0].imag + 0.3 * VALUES[1].imag
    assert low.imag == pytest.approx(mean - 0.5) and high.imag == pytest.approx(mean + 0.5)
    assert low.real == pytest.approx(MIX.interval_95(values, errors)[0].real)


def test_the_covariance_is_that_within_explanations_and_between_them():
    apart = VALUES[0] - VALUES[1]
    between = 0.7 * 0.3 * np.outer(*2 * [np.concatenate([apart.real, apart.imag])])
    within = np.zeros((4, 4))
    for weight, slope, covariance in zip((0.7, 0.3), SLOPES, COVARIANCES, strict=True):
        both = np.vstack([slope.real, slope.imag])
        within += weight * both @ covariance @ both.T
    assert MIX.covariance(np.zeros(2), None) == pytest.approx(within + between)


def test_causes_do_to_a_test_what_they_do_in_the_mean(monkeypatch):
    monkeypatch.setattr(mixture, "Joint", lambda *given: given)
    joint = SimpleNamespace(base="base", noise="noise")
    each = [
        SimpleNamespace(
            probability=share, joint=joint, effect=lambda every, size=size: size * np.array([1.0, 1j])
        )
        for share, size in ((0.7, 0.1), (0.3, 0.0))
    ]
    assert Mixture(tuple(each), (9, 9), None).effect("tests") == pytest.approx([0.07, 0.07j])


def test_a_possible_cause_is_one_that_another_explanation_lacks():
    assert [MIX.possible(one) for one in MIX.hypotheses] == [(CLAMP,), (OFFSET,)]
    assert averaged_over(MIX) == "loose clamp of specimen A 70 %, phase offset 30 %"
    sure = Mixture((explanation(0.6, 0, DELAY), explanation(0.4, 1, DELAY, OFFSET)), (9, 9), None)
    assert averaged_over(sure) == "no possible cause 60 %, phase offset 40 %"
    assert averaged_over(Mixture(sure.hypotheses[:1], (9, 9), None)) == "one hypothesis"


@pytest.mark.parametrize(
    ("of_noise", "specimens", "freedom"), [(50, 3, (10, 50)), (6, 3, (6, 6)), (50, 1, (8, 50))]
)
def test_a_modulus_is_as_uncertain_as_few_specimens_leave_it(of_noise, specimens, freedom, monkeypatch):
    """Worth eight degrees of freedom, what is usual, and one less than there are specimens."""
    monkeypatch.setattr(mixture, "_apart", lambda one: 0.1)
    tests = SimpleNamespace(observed=SimpleNamespace(specimen=np.arange(specimens)))
    found = SimpleNamespace(
        hypotheses=[SimpleNamespace(joint=tests)], noise=SimpleNamespace(freedom=of_noise)
    )
    assert mixture.mixture(found, np.ones(specimens, bool)).freedom == freedom


def test_the_mean_phase_is_uncertain_by_what_specimens_differ_by_beyond_what_is_usual():
    """Two mountings of 0.2 deg make 0.3 deg; three specimens, Student's t of two."""
    levels = np.radians([0.0, 1.0, -2.0])
    specimen = np.repeat([0, 1, 2], 2)
    off = levels[specimen] + np.tile([0.01, -0.01], 3)
    observed = SimpleNamespace(specimen=specimen, logarithm=0.2j + 1j * off, omega=None, temperature=None)
    one = SimpleNamespace(
        joint=SimpleNamespace(observed=observed), along=lambda *_: (0.15j * np.ones(6), None),
        effect=lambda _: 0.05j * np.ones(6),
    )  # fmt: skip
    beyond = np.var(levels, ddof=1) - np.radians(0.3) ** 2
    assert mixture._apart(one) == pytest.approx(student(2).ppf(0.975) * np.sqrt(beyond / 3.0))
    observed.specimen = np.repeat([0, 4], 3)  # of two, the mean of a difference of 2/3 deg
    of_two = np.diff([off[:3].mean(), off[3:].mean()])[0] ** 2 / 2.0 - np.radians(0.3) ** 2
    assert mixture._apart(one) == pytest.approx(student(1).ppf(0.975) * np.sqrt(of_two / 2.0))
    observed.logarithm = 0.2j + 0.001j * np.arange(6)
    assert mixture._apart(one) == 0.0
    observed.specimen = np.zeros(6, int)
    assert mixture._apart(one) == 0.0


@pytest.mark.parametrize(
    ("stated", "odds", "causes"),
    [
        (0.7, [1.0, 0.1, 0.23 / 0.7], [["x", "y"], ["x", "z"], ["x"]]),
        (0.885, [1.0, 0.1], [["x", "y"], ["x", "z"]]),  # that none holds is below 3 %
    ],
)
def test_explanations_have_the_odds_of_a_name_its_rival_and_neither(stated, odds, causes, monkeypatch):
    """Of the name's 0.9, its rival had 0.09; the share of both shrinks with what is stated, and the rest is neither."""
    first, second, rival = (cause(name) for name in "xyz")
    rung = SimpleNamespace(candidate=second, probability=0.9, rivals=[rival], shares=[0.09])
    monkeypatch.setattr(
        hypotheses, "refit_causes", lambda state, active: SimpleNamespace(wide=None, fitted=active)
    )
    end = SimpleNamespace(fitted=SimpleNamespace(active=(first, second)), wide=None)
    ladder = SimpleNamespace(end=end, rungs=[rung])
    found = hypotheses.hypotheses(ladder, {second.key: stated})
    told = [list("xy") if one.fitted is end.fitted else [c.key[0] for c in one.fitted] for one in found]
    order = np.argsort([-one for one in odds], kind="stable")
    assert told == [causes[k] for k in order]
    assert [one.probability for one in found] == pytest.approx([odds[k] / sum(odds) for k in order])
