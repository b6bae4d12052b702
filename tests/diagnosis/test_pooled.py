"""Campaigns of one machine: what they share is found together, what each has of its own is not called the machine's."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.stats import chi2

from asphalt_nscd.diagnosis.causes import CATALOGUE
from asphalt_nscd.diagnosis.machine import pooled
from asphalt_nscd.diagnosis.machine.common_faults import Common, Part, Pooled
from asphalt_nscd.diagnosis.observed.observations import Observations
from asphalt_nscd.diagnosis.search.diagnose import diagnose
from asphalt_nscd.rheology.parabolic import HuetSayegh
from asphalt_nscd.rheology.shift import WLF

SCATTER = 0.01, np.radians(0.3)
OFFSET = next(cause for cause in CATALOGUE if cause.name == "phase_offset")


def campaign(k, offset=0.0, delay=0.0):
    """Mix k of its own, two specimens, phase off by offset [deg] or a delay [s]."""
    random = np.random.default_rng(20 + k)
    law = HuetSayegh(
        60e6,
        26e9 + 2e9 * k,
        k=0.2 + 0.01 * k,
        h=0.6,
        delta=2.3,
        tau=0.1 + 0.05 * k,
        shift=WLF(18.0, 140.0, 15.0),
    )
    grid = np.meshgrid(np.arange(2), [4.0, 20.0, 35.0, 50.0], [0.1, 1.0, 10.0, 25.0], indexing="ij")
    specimen, temperature, frequency = (one.ravel() for one in grid)
    omega = 2.0 * np.pi * frequency
    noise = SCATTER[0] * random.standard_normal(omega.size) + 1j * SCATTER[1] * random.standard_normal(
        omega.size
    )
    noise += 0.02 * random.standard_normal(2)[specimen] + 1j * (np.radians(offset) + delay * omega)
    return Observations(
        specimen, ("a", "b"), temperature, frequency, law.complex_modulus(omega, temperature) * np.exp(noise),
        np.ones(omega.size), np.zeros(omega.size), test_type="tension-compression",
    )  # fmt: skip


@cache
def diagnosed(k, offset=0.0, delay=0.0):
    return diagnose(campaign(k, offset, delay), SCATTER, draws=500)


def together(offsets, delay=0.0):
    found = {f"mix {k}": diagnosed(k, offset, delay) for k, offset in enumerate(offsets)}
    return found, pooled.pool(found, draws=1000)


def test_an_offset_that_no_campaign_shows_alone_is_named_by_five():
    alone, found = together([0.2] * 5)
    assert not any(rung for one in alone.values() for rung in one.ladder.rungs)
    (one,) = found.found
    assert one.cause.name == "phase_offset" and one.named
    assert abs(one.value - 0.2) < 3.0 * one.std_error < 0.2
    assert found.limits["phase_offset"] < 0.6 * min(
        one.ladder.limits["phase_offset", None] for one in alone.values()
    )
    assert "Machine: phase offset in all campaigns, 0." in str(found) and " deg (95 % interval)" in str(found)


def test_the_information_is_that_of_all_tests_in_one_model():
    """Second way: the offset by the pooled formula, and by a joint fit of each campaign with its value profiled."""
    _, found = together([1.5, 1.5])
    (one,) = found.found
    sizes = np.array([[part.value, part.std_error] for part in one.campaigns])
    weight = sizes[:, 1] ** -2.0
    assert one.value == pytest.approx(weight @ sizes[:, 0] / weight.sum(), rel=0.02)
    for k, part in enumerate(one.campaigns):
        rung = diagnosed(k, 1.5).ladder.rungs[0]
        error = np.sqrt(rung.after.covariance[-1, -1]) * rung.candidate.typical[0]
        assert part.value == pytest.approx(rung.candidate.values[0], abs=0.05)
        assert part.std_error == pytest.approx(error, rel=0.05)


def test_what_the_machine_does_is_no_reason_to_believe_a_campaign_less():
    """A mix whose estimates are spread by an offset is believed as the same mix without, once the offset is beside."""
    sound, off = (pooled._begin("a", diagnosed(4, offset)) for offset in (0.0, 0.4))
    assert sound.spread == 1.0 and off.spread > 1.3
    amplitude = np.array([0.4 / OFFSET.parameters[0].typical])
    assert off.judged_beside([OFFSET], amplitude).spread == 1.0


def test_of_many_isotherms_each_counts_though_all_are_uncertain():
    offset = next(cause for cause in CATALOGUE if cause.name == "phase_offset")
    parts = [Part(f"{k} degC", 0.01 * k, 0.06) for k in range(30)] + [Part("50 degC", np.nan, np.nan)]
    common = Common(offset, 1e-6, (), 0.15, 0.01, isotherms=tuple(parts), differs={"isotherms": 1e-4})
    said = str(Pooled((common,), {}, ()))
    assert "differs between isotherms from 0 deg (0 degC) to 0.29 deg (29 degC)." in said


def test_where_the_discrepancy_starts_does_not_change_the_evidence(seed=6, size=4.0):
    """From sizes far from the likeliest, one descent ends elsewhere: in this table with a score 46 % off.

    The likeliest of two is a little better from there: by 4 % of the score.
    """
    begun = pooled._begin("a", diagnosed(seed))
    state = begun.state
    astray = replace(begun, state=replace(state, variances=np.full_like(state.variances, size)))
    one, other = (pooled._evidence(each, [OFFSET]) for each in (begun, astray))
    assert other.information == pytest.approx(one.information, rel=5e-3)
    assert other.score == pytest.approx(one.score, rel=5e-2)
    less = pooled._evidence(replace(begun, spread=2.0), [OFFSET])  # whose errors are believed twice as large
    assert (less.information, less.score) == (0.25 * one.information, 0.25 * one.score)


def test_a_delay_is_not_called_an_offset():
    _, found = together([0.0] * 4, delay=6e-4)
    assert [one.cause.name for one in found.found] == ["channel_delay"] and found.found[0].named
    assert found.found[0].value == pytest.approx(6e-4, abs=4.0 * found.found[0].std_error)


def test_nothing_is_named_where_there_is_nothing_and_one_campaign_is_not_all():
    _, found = together([0.0] * 4)
    assert found.found == () and "Nothing common" in str(found)
    _, found = together([0.0, 0.0, 0.0, 3.0])
    assert not any(one.named for one in found.found)


def test_an_effect_of_two_sizes_is_common_but_has_no_name():
    def warm(one):
        phase = np.radians(np.where(one.temperature > 30.0, 3.0, 0.8))
        return replace(one, modulus=one.modulus * np.exp(1j * phase))

    found = pooled.pool(
        {f"{k}": diagnose(warm(campaign(k)), SCATTER, draws=500) for k in range(4)}, draws=1000
    )
    (one,) = found.found
    assert not one.named and "isotherms" in one.differs
    assert "without a name" in str(found)
    assert set(found.table["where"]) > {"all campaigns", "50 degC", "25 Hz", "3"}


def test_a_campaign_of_one_isotherm_is_left_out_and_said():
    whole = campaign(0)
    part = whole.subset(whole.temperature == 20.0)
    alone = {
        "one": diagnose(replace(part, whole=None), SCATTER, draws=500),
        "all": diagnosed(0),
    }
    found = pooled.pool(alone, draws=1000)
    assert found.left_out == ("one",) and "Not used for this: one" in str(found)


def test_campaigns_that_differ_widen_the_error_by_what_they_differ():
    """DerSimonian and Laird's variance between campaigns, and none where they agree as well as they say."""
    weight, value = np.array([400.0, 100.0, 100.0, 25.0]), np.array([0.0, 1.0, -0.6, 0.8])
    each = [pooled._Evidence(np.array([[w]]), np.array([w * v])) for w, v in zip(weight, value, strict=True)]
    found = pooled._together(each, np.zeros(0))
    mean = weight @ value / weight.sum()
    between = (weight @ (value - mean) ** 2 - 3.0) / (weight.sum() - weight @ weight / weight.sum())
    wide = 1.0 / (1.0 / weight + between)
    assert found.differ < 1e-6
    assert (
        found.std_error == pytest.approx(wide.sum() ** -0.5) and found.std_error > 5.0 * weight.sum() ** -0.5
    )
    assert found.value == pytest.approx(wide @ value / wide.sum())
    agree = [pooled._Evidence(np.array([[w]]), np.array([0.1 * w])) for w in weight]
    assert pooled._together(agree, np.zeros(0)).std_error == pytest.approx(weight.sum() ** -0.5, rel=0.05)


def test_a_size_of_campaigns_of_which_one_in_ten_is_astray_is_the_likeliest():
    """By a search on the likelihood of the mixture, one campaign three of its errors off."""
    weight, value = np.array([400.0, 100.0, 100.0, 25.0]), np.array([0.30, 0.31, 0.60, 0.2])

    def likelihoods(mean):
        return 0.9 * np.exp(-0.5 * weight * (value - mean) ** 2), 0.04 * np.exp(
            -0.08 * weight * (value - mean) ** 2
        )

    grid = np.linspace(0.2, 0.5, 30001)
    heights = [np.log(np.sum(likelihoods(one), axis=0)).sum() for one in grid]
    best = grid[np.argmax(heights)]
    each = [pooled._Evidence(np.array([[w]]), np.array([w * v])) for w, v in zip(weight, value, strict=True)]
    found = pooled._together(each, np.zeros(0))
    assert found.value == pytest.approx(best, abs=2e-5)
    sound, astray = likelihoods(best)
    believed = weight * (sound + astray / 6.25) / (sound + astray)
    assert found.std_error == pytest.approx(believed.sum() ** -0.5, rel=1e-4)
    none = np.log(np.sum(likelihoods(0.0), axis=0)).sum()
    assert found.z == pytest.approx(np.sqrt(2.0 * (max(heights) - none)), rel=1e-6)
    square = weight @ (value - weight @ value / weight.sum()) ** 2
    assert found.differ == pytest.approx(chi2(3).sf(square))


def test_of_two_causes_the_last_is_told_beside_the_first_and_knows_that_it_is_free():
    information = np.array([[100.0, 60.0], [60.0, 400.0]])
    each = [pooled._Evidence(information, information @ [0.5, size]) for size in (0.2, 0.21, 0.19)]
    found = pooled._together(each, np.array([0.5]))
    alone = [one.conditional([1], {0: 0.5}) for one in each]
    assert [one.score[0] / one.information[0, 0] for one in alone] == pytest.approx([0.2, 0.21, 0.19])
    assert found.value == pytest.approx(0.2)
    assert found.std_error == pytest.approx((3.0 * (400.0 - 60.0**2 / 100.0)) ** -0.5, rel=0.05)
    assert pooled._all_together(each, np.zeros(2)) == pytest.approx([0.5, 0.2])
    assert pooled._gain(each, np.array([0.5])) == pytest.approx(400.0 * (0.2**2 + 0.21**2 + 0.19**2))
    unseen = pooled._Evidence(np.diag([4.0, 0.0]), np.array([2.0, 0.0]))
    assert pooled._together([unseen], np.array([0.5])) == pooled._Whole()
    assert pooled._gain([*each, unseen], np.array([0.5])) == pooled._gain(each, np.array([0.5]))
    assert pooled._all_together([unseen], np.array([9.0, 7.0])) == pytest.approx([0.5, 7.0])


def test_the_likelier_cause_has_one_size_or_pays_for_each_of_several():
    """Four campaigns: sizes of their own cost two each but for the first."""
    one, several = (cause for cause in CATALOGUE if cause.name in ("channel_delay", "phase_offset"))
    for gain, likelier in ((30.9, one), (31.1, several)):
        wholes = {one: pooled._Whole(z=5.0, differ=0.003), several: pooled._Whole(z=9.0, differ=0.0029)}
        assert pooled._likeliest(wholes, {one: 99.0, several: gain}, 4) is likelier


def test_a_cause_of_one_sign_is_not_there_with_the_other():
    friction = next(cause for cause in CATALOGUE if cause.name == "guide_friction")
    assert (
        pooled._z(friction, pooled._Whole(z=-4.0)) == 0.0 and pooled._z(OFFSET, pooled._Whole(z=-4.0)) == 4.0
    )
    assert {
        "phase_offset",
        "channel_delay",
        "moving_mass",
        "guide_friction",
        "guide_stiffness",
    } == pooled.MACHINE


def test_chance_of_the_last_causes_is_that_beside_those_taken(monkeypatch):
    """What the first takes of the second and third leaves them correlated."""
    information = np.array([[4.0, 1.0, 2.0], [1.0, 9.0, 3.0], [2.0, 3.0, 16.0]])
    monkeypatch.setattr(pooled, "_evidence", lambda *_: pooled._Evidence(information, None))
    monkeypatch.setattr(pooled.chance, "largest_by_chance", lambda *given: given)
    noise = SimpleNamespace(plain=SimpleNamespace(noise=SimpleNamespace(freedom=7)))
    causes = [
        next(c for c in CATALOGUE if c.name == n) for n in ("channel_delay", "phase_offset", "guide_friction")
    ]
    correlation, one_sided, freedom, draws, _ = pooled._largest_by_chance(
        [SimpleNamespace(state=noise)] * 2, causes, 1, 500, None
    )
    left = np.linalg.inv(np.linalg.inv(information)[1:, 1:])
    assert correlation == pytest.approx(left / np.sqrt(np.outer(np.diag(left), np.diag(left))))
    assert one_sided.tolist() == [False, True] and (freedom, draws) == (14, 500)


def test_parts_of_the_campaigns_are_told_apart_where_one_amplitude_does_not_fit(monkeypatch):
    """By isotherm, of one campaign that has both and one that has the first: what they say of each adds up."""
    tables = [np.array([0.0, 30.0]), np.array([0.0])]
    states = [
        SimpleNamespace(state=SimpleNamespace(plain=SimpleNamespace(observed=SimpleNamespace(
            isotherm=t, frequencies=np.arange(3), test_type="bending")))) for t in tables
    ]  # fmt: skip
    shared = np.array([[4.0, 1.0], [1.0, 9.0]])
    said = [
        pooled._Evidence(shared, shared @ [2.0, 3.0]),
        pooled._Evidence(np.diag([5.0, 0.0]), np.array([10.0, 0.0])),
    ]
    asked = []

    def evidence(state, causes, parts):
        asked.append(parts)
        return said[len(asked) - 1]

    monkeypatch.setattr(pooled, "_evidence", evidence)
    told, chance = pooled._apart(states, [OFFSET], lambda of: of.isotherm, "degC")
    assert [one.tolist() for one in asked] == [[[1.0, 0.0], [0.0, 1.0]], [[1.0, 0.0]]]
    precision = shared + np.diag([5.0, 0.0])
    covariance, unit = np.linalg.inv(precision), OFFSET.parameters[0].typical
    assert [one.where for one in told] == ["0 degC", "30 degC"]
    assert [one.value for one in told] == pytest.approx([2.0 * unit, 3.0 * unit])
    assert [one.std_error for one in told] == pytest.approx(unit * np.sqrt(np.diag(covariance)))
    difference = 1.0 / np.sqrt(covariance[0, 0] + covariance[1, 1] - 2.0 * covariance[0, 1])
    assert chance == pytest.approx(chi2(1).sf(difference**2))
    assert pooled._part("a", pooled._Evidence(np.array([[4.0]]), np.array([6.0])), 0.5) == Part(
        "a", 0.75, 0.25
    )
    assert np.isnan(pooled._part("a", pooled._Evidence(np.zeros((1, 1)), np.zeros(1)), 0.5).value)
