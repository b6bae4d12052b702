"""Parts of the search on their own: what is promising, named from, in doubt, established."""

from __future__ import annotations

from dataclasses import make_dataclass
from types import SimpleNamespace

import numpy as np
import pytest
from test_discrepancy import small

from asphalt_nscd.diagnosis.causes import EVERY
from asphalt_nscd.diagnosis.causes._cause import Setting
from asphalt_nscd.diagnosis.model import likelihood
from asphalt_nscd.diagnosis.model.discrepancy import Processes
from asphalt_nscd.diagnosis.model.joint import Candidate
from asphalt_nscd.diagnosis.model.likelihood import Direction, Estimate
from asphalt_nscd.diagnosis.observed.observations import Observations
from asphalt_nscd.diagnosis.search import doubts, ladder, limits, one_search
from asphalt_nscd.diagnosis.search.diagnose import Diagnosis

CAUSES = {cause.name: cause for cause in EVERY}


def candidate(name, *values, place=None):
    return Candidate(CAUSES[name], place, values or (0.0,))


def test_a_score_is_the_estimate_beside_processes_of_given_sizes():
    model, cause = small(np.random.default_rng(5))
    variances = np.array([0.4, 0.02, 1.3, 0.1])
    (found,) = one_search._scored(SimpleNamespace(model=model, variances=variances), cause)
    point = likelihood._point(model, cause, np.log(variances))
    assert (found.amplitude, found.std_error) == pytest.approx((point.amplitude, point.std_error))


@pytest.mark.parametrize(
    ("name", "z", "promising"),
    [
        ("phase_offset", 2.6, True), ("phase_offset", -2.6, True), ("phase_offset", 2.4, False),
        ("guide_friction", 2.6, True), ("guide_friction", -2.6, False),
        ("offset of one isotherm", 3.9, False), ("offset of one isotherm", -4.1, True),
    ],
)  # fmt: skip
def test_worth_an_estimate_is_what_is_far_from_none_where_nothing_of_its_place_hides_it(
    name, z, promising, monkeypatch
):
    """A fault of one place from four standard errors, any other cause from two and a half, of its own sign."""
    described = [SimpleNamespace(kind=kind, specimen=None, isotherm=t) for kind, t in
                 (("all", None), ("isotherm", 9.0), ("specimen times", None))]  # fmt: skip
    model = SimpleNamespace(processes=SimpleNamespace(described=described))
    monkeypatch.setattr(one_search, "lean", lambda found, variances: 0.5 * variances)
    used = []

    def weighed(model, pointing, variances):
        used.append(variances)
        return np.array([[4.0]]), np.array([2.0 * z])

    monkeypatch.setattr(likelihood, "weighed", weighed)
    state = SimpleNamespace(model=model, variances=np.array([7.0, 8.0, 9.0]))
    found = list(one_search._promising(state, [candidate(name)], None))
    assert found == [0] * promising and used[0] == pytest.approx([1e-4, 1e-4, 4.5])


def test_of_many_shapes_the_best_four_are_estimated(monkeypatch):
    described = [SimpleNamespace(kind="all", specimen=None, isotherm=None)]
    state = SimpleNamespace(
        model=SimpleNamespace(processes=SimpleNamespace(described=described)), variances=np.ones(1)
    )
    monkeypatch.setattr(one_search, "lean", lambda found, variances: variances)
    z = np.array([3.0, 9.0, 5.0, 4.0, 6.0, 7.0])
    monkeypatch.setattr(likelihood, "weighed", lambda *_: (np.eye(6), z))
    shapes = [candidate("secondary_process", 0.0, 0.1 * k, 30.0, 0.5) for k in range(6)]
    assert list(one_search._promising(state, shapes, None)) == [1, 5, 4, 2]


def test_sought_is_what_is_not_taken_yet_and_what_the_law_leaves_a_share_of(monkeypatch):
    """Three thousandths of its square, or of what a fit decides a millionth: a fault of one specimen, a spring."""
    left = {
        candidate("channel_delay"): 3.1e-3, candidate("moving_mass"): 2.9e-3,
        candidate("guide_stiffness"): 1.1e-6, candidate("guide_friction"): 1e-4,
        candidate("loose_clamp", place="A"): 1.1e-6, candidate("loose_clamp", place="B"): 0.9e-6,
        candidate("temperature_bias", place=9.0): 1e-4, candidate("phase_offset"): 1.0,
        candidate("offset of one isotherm", place=9.0): 1.0,
    }  # fmt: skip
    own = 4.0 * np.array(list(left.values()))[:-2]
    monkeypatch.setattr(one_search.chance, "catalogue_candidates", lambda *_: list(left))
    monkeypatch.setattr(one_search.chance, "candidate_directions", lambda *given: np.ones((4, len(given[2]))))
    pointing = Direction(np.arange(7.0)[None], np.diag(own), np.arange(7.0))
    monkeypatch.setattr(likelihood, "directions", lambda *_: pointing)
    state = SimpleNamespace(
        plain=SimpleNamespace(observed=None, noise=SimpleNamespace(whiten=lambda d: d)), model=None, linear=None,
        fitted=SimpleNamespace(active=[candidate("phase_offset", 1.0)]),
    )  # fmt: skip
    found, kept = one_search._pointing(state, None)
    assert [one.key for one in found] == [
        ("channel_delay", None),
        ("guide_stiffness", None),
        ("loose_clamp", "A"),
    ]
    assert kept.along.tolist() == [0.0, 2.0, 4.0] and np.diag(kept.own) == pytest.approx(own[[0, 2, 4]])


@pytest.mark.parametrize(("z", "competes"), [(1.97, True), (-1.97, True), (1.95, False)])
def test_a_size_whose_interval_holds_zero_competes_for_no_name(z, competes):
    assert (
        one_search.stands(None, None, candidate("phase_offset", 1.0), Estimate(None, 0.0, 2.0 * z, 2.0))
        is competes
    )


@pytest.mark.parametrize(("size", "least"), [(1.0, 3.0), (-1.0, -3.0)])
def test_a_cause_hangs_on_what_leaves_it_less_than_three_standard_errors(size, least, monkeypatch):
    grid = np.array([(s, t, f) for s in (0, 1) for t in (0.0, 9.0, 20.0) for f in (1.0, 5.0)])
    observed = Observations(
        grid[:, 0].astype(int),
        ("A", "B"),
        grid[:, 1],
        grid[:, 2],
        np.ones(12) + 0j,
        np.ones(12),
        np.zeros(12),
    )

    def amplitude(state, named, rows):
        carries = not (observed.isotherm[rows] == 9.0).any() or not (observed.specimen[rows] == 1).any()
        return Estimate(None, 0.0, (0.97 if carries else 1.03) * least, 1.0)

    monkeypatch.setattr(one_search, "taken_amplitude", amplitude)
    state = SimpleNamespace(plain=SimpleNamespace(observed=observed))
    assert one_search.hangs_on(state, candidate("phase_offset", size)) == ["9 degC", "specimen B"]
    # Without its isotherm there is no bias to be seen; one frequency of two would be left.
    assert one_search.hangs_on(state, candidate("temperature_bias", size, place=9.0)) == ["specimen B"]


def test_so_many_causes_are_taken_and_so_many_faults_of_one_place(monkeypatch):
    monkeypatch.setattr(one_search, "survey", lambda *_: None)
    monkeypatch.setattr(one_search, "smoothed", lambda state: state)
    for fault in (True, False):
        kind = SimpleNamespace(candidate=SimpleNamespace(cause=SimpleNamespace(told=fault)), after=None)
        monkeypatch.setattr(one_search, "_next", lambda *_, kind=kind: kind)
        assert len(one_search.climb(None, (), 1, None)[0]) == 4


@pytest.mark.parametrize(
    ("isotherms", "frequencies", "specimens", "enough"),
    [
        (2, 2, 1, [True, True, True]),
        (1, 2, 2, [False, True, True]),
        (2, 1, 2, [True, False, True]),
        (2, 2, 0, [True, True, False]),
    ],
)
def test_what_is_left_still_is_a_table(isotherms, frequencies, specimens, enough):
    rest = SimpleNamespace(
        isotherms=np.zeros(isotherms), frequencies=np.zeros(frequencies), specimen=np.arange(specimens)
    )
    assert [one_search._enough(rest, name) for name in ("isotherm", "frequency", "specimen")] == enough


@pytest.mark.parametrize(
    ("of_square", "odds", "least"),
    [
        (0.5, -1.0, 3.7),  # gains 6.8 where chance is passed: a name asks for 6
        (0.25, -1.0, np.sqrt(6.0 / 0.25)),
        (0.25, -4.0, np.sqrt(8.0 / 0.25)),  # and for even odds
    ],
)
def test_a_name_is_got_from_where_a_discrepancy_cannot_take_the_effect_up(
    of_square, odds, least, monkeypatch
):
    """Of two standard errors and one of its own in the table; seen is what 19 of 20 cases see at least."""
    amounts = []

    def moved(model, direction, amount):
        amounts.append(amount)
        return amount + 1.0, None

    def estimate(model, cause, start):
        return SimpleNamespace(misfit=0.0 if start == "own" else of_square * (model / 2.0) ** 2, variances=0)

    monkeypatch.setattr(likelihood, "moved", moved)
    monkeypatch.setattr(likelihood, "estimate", estimate)
    monkeypatch.setattr(limits, "answers", lambda model, _: [estimate(model, None, None)])
    priors = []

    def log_odds(present, observed, gain, std_error):
        priors.append((present.values[0], gain, std_error))
        return odds

    monkeypatch.setattr(limits, "log_odds", log_odds)
    surveyed = SimpleNamespace(
        candidates=[candidate("phase_offset")], estimates=[Estimate("own", 0.0, 1.0, 2.0)],
        pointing=SimpleNamespace(column=lambda k: None),
    )  # fmt: skip
    state = SimpleNamespace(model=None, variances=None, plain=SimpleNamespace(observed=None))
    found = limits._named_from(state, surveyed, 0, 3.7)
    assert 2.0 * (least + 1.645) <= found * (1.0 + 1e-9) and found <= 2.0 * (1.06 * least + 1.645)
    assert amounts[0] == pytest.approx(2.0 * 3.7 - 1.0)
    assert priors[0] == (pytest.approx(0.5 * 2.0 * 5.345), 0.0, 1.0)  # typical is half a degree


def test_estimates_of_all_causes_are_in_their_units_and_of_shapes_the_best_seen(monkeypatch):
    """With the error of the discrepancy's sizes; a fault of one place only where it is one frequency's."""
    monkeypatch.setattr(
        limits, "taken_amplitude", lambda state, one, sizes_too: Estimate(None, 0.0, 3.0, 0.4)
    )
    monkeypatch.setattr(
        likelihood,
        "widen_error",
        lambda model, direction, one: Estimate(None, 0.0, one.amplitude, one.std_error + 1.0),
    )
    survey = SimpleNamespace(
        candidates=[
            candidate("channel_delay"), candidate("secondary_process", 0.0, -1.0, 30.0, 0.5),
            candidate("secondary_process", 0.0, -2.0, 60.0, 0.8), candidate("offset of one specimen", place="A"),
            candidate("offset at one frequency", place=Setting(25.0)),
        ],
        estimates=[Estimate(None, 0.0, a, e) for a, e in ((2.0, 0.5), (9.0, 4.0), (7.0, 3.0), (8.0, 0.1), (6.0, 0.2))],
        pointing=SimpleNamespace(column=lambda k: k),
    )  # fmt: skip
    state = SimpleNamespace(model=None, fitted=SimpleNamespace(active=[candidate("phase_offset", 1.0)]))
    assert limits.estimates(state, survey) == {
        ("phase_offset", None): pytest.approx((1.5, 0.2)),
        ("channel_delay", None): pytest.approx((2e-4, 1.5e-4)),
        ("secondary_process", None): pytest.approx((14e8, 8e8)),
        ("offset at one frequency", Setting(25.0)): pytest.approx((3.0, 0.6)),
    }


@pytest.mark.parametrize(
    ("size", "error", "turns", "as_of_mixes"),
    [
        (2.0, 0.3, 1.4, True),  # 1.4 deg times 0.706
        (2.0, 0.3, 1.5, False),
        (-2.0, 0.3, 1.5, False),
        (2.0, 1.1, 9.0, True),  # of a size that may be none
    ],
)
def test_a_fault_that_turns_most_phases_by_less_than_a_degree_may_be_a_mix_s(size, error, turns, as_of_mixes):
    """By the least that its interval holds, at nine of ten tests; the last is turned by far more."""
    named = candidate("phase_offset", size)
    turned = np.radians(np.append(np.full(18, turns), [turns, 99.0]))
    joint = SimpleNamespace(apparent=lambda law, active: (np.exp(1j * turned) if active else np.ones(20),))
    fitted = SimpleNamespace(active=[named], law=None)
    found = SimpleNamespace(ladder=SimpleNamespace(joint=joint, fitted=fitted, std_errors=lambda _: [error]))
    rung = SimpleNamespace(candidate=named)
    assert Diagnosis._is_as_of_mixes(found, rung) is as_of_mixes
    fitted.active = [candidate("channel_delay", size)]  # no mix has a delay
    assert not Diagnosis._is_as_of_mixes(found, SimpleNamespace(candidate=fitted.active[0]))


@pytest.mark.parametrize(
    ("rivals", "doubted", "hangs_on", "undisputed"),
    [
        ([], {}, [], True),
        (["x"], {}, [], False),
        ([], {("phase_offset", None): []}, [], False),
        ([], {}, ["4 degC"], False),
    ],
)
def test_a_name_is_established_if_nothing_speaks_against_it(
    rivals, doubted, hangs_on, undisputed, monkeypatch
):
    rung = SimpleNamespace(candidate=candidate("phase_offset"), rivals=rivals, probability=0.95)
    found = Diagnosis.__new__(Diagnosis)
    found.ladder = SimpleNamespace(doubts=doubted, hangs_on={rung.candidate.key: hangs_on})
    for too_few, as_of_mixes, probability, stays in (
        ("", False, 0.95, True), ("why", False, 0.95, False), ("", True, 0.95, False), ("", False, 0.949, False),
    ):  # fmt: skip
        found.too_few, rung.probability = too_few, probability
        monkeypatch.setattr(Diagnosis, "_is_as_of_mixes", lambda *_, answer=as_of_mixes: answer)
        assert found.established(rung) is (undisputed and stays)


def test_faults_of_one_place_are_told_with_82_percent_at_most_and_rivals_of_a_name_are_causes(monkeypatch):
    sure, fault = candidate("phase_offset", 1.0), candidate("offset of one specimen", 2.0, place="A")
    rival, other = candidate("channel_delay", 1e-4), candidate("offset of one isotherm", 1.0, place=4.0)
    monkeypatch.setattr(ladder.limits, "estimates", lambda *_: {sure.key: (1.1, 0.2), fault.key: (2.0, 0.3)})
    states = [SimpleNamespace(fitted=name) for name in ("first", "second")]
    end = SimpleNamespace(wide=None, fitted=SimpleNamespace(active=[sure, fault]))
    found = [
        one_search.Found(sure, 0.001, states[0], None, (other, rival), 0.9, (0.03, 0.05)),
        one_search.Found(fault, 0.002, states[1], None, (), 0.97, ()),
    ]
    climbed = ladder.Ladder(None, None)
    ladder._take(climbed, SimpleNamespace(fitted="start"), found, end, None)
    (rung,), (odd,) = climbed.rungs, climbed.odd
    assert (rung.before, rung.after, rung.probability) == ("first", "second", 0.9)
    assert (rung.rivals, rung.shares) == ((rival,), (0.05,)) and climbed.start == "start"
    assert climbed.doubts == {sure.key: ["A fault of one specimen, isotherm or frequency fits as well"]}
    assert (odd.candidate, odd.std_error, odd.probability) == (fault, 0.3, 0.82)
    assert climbed.estimates == {sure.key: (1.1, 0.2)} and climbed.at_highest is None


@pytest.mark.parametrize(
    ("name", "places", "specimens", "told"),
    [
        ("specimen_geometry", "AB", 4, "It is named at 2 of 4 specimens"), ("specimen_geometry", "AB", 5, ""),
        ("specimen_geometry", "A", 2, ""), ("temperature_bias", (0.0, 9.0, 20.0), 3, "It is named at 3 isotherms"),
        ("temperature_bias", (0.0, 9.0), 3, ""),
    ],
)  # fmt: skip
def test_a_fault_of_one_that_most_would_have_to_share_is_in_doubt(name, places, specimens, told):
    named = [candidate(name, place=place) for place in places] + [candidate("channel_delay")]
    said = list(doubts._shared_doubts(named[0], named, specimens))
    assert len(said) == bool(told) and all(one.startswith(told) for one in said)


def test_rivals_stand_beside_all_processes_with_sizes_of_which_nothing_is_known(monkeypatch):
    """From either side: as small as a twentieth, and the usual sizes; the better of both."""
    found = Processes(
        ("x", "y"),
        ("X", "Y"),
        np.ones((4, 3)),
        np.array([0, 0, 1]),
        np.array([0.5, 0.1]),
        np.array([0.7, 0.0]),
    )
    monkeypatch.setattr(likelihood, "reduce", lambda every, rest: every)
    monkeypatch.setattr(likelihood, "directions", lambda model, rest, direction: direction)
    begun = []

    def estimate(model, along, start):
        begun.append((model, along, start))
        return Estimate(None, float(len(begun)))

    monkeypatch.setattr(likelihood, "estimate", estimate)
    plain = SimpleNamespace(noise=SimpleNamespace(whiten=lambda root: 2.0 * root))
    state = SimpleNamespace(
        model=SimpleNamespace(processes=found), plain=plain, variances=np.array([3.0, 4.0])
    )
    roots = [np.full((4, 2), 5.0), np.full((4, 1), 6.0)]
    assert doubts._estimate_beside(state, None, "along", roots).misfit == 1.0
    (every, along, first), (_, _, second) = begun
    assert along == "along" and first == pytest.approx([3.0, 4.0, 0.0025, 0.0025]) and second is None
    assert every.block.tolist() == [0, 0, 1, 2, 2, 3] and every.factor[0].tolist() == [1, 1, 1, 10, 10, 12]
    assert every.usual.tolist() == [0.5, 0.1, 1.0, 1.0] and every.spread.tolist() == [
        0.7,
        0.0,
        np.inf,
        np.inf,
    ]
    assert every.described == ("x", "y", doubts.RIVAL, doubts.RIVAL) and every.roots[:2] == ("X", "Y")


def test_shapes_of_known_errors_and_smooth_effects_have_the_size_of_a_test_s_scatter():
    modulus = np.array([9e9 + 1e9j, 4e9 + 2e9j, 1e9 + 1e9j, 5e8 + 4e8j])
    t, f = np.array([0.0, 0.0, 30.0, 30.0]), np.array([1.0, np.exp(1.5), 1.0, np.exp(1.5)])
    logarithm = np.log(modulus)
    observed = SimpleNamespace(
        modulus=modulus, logarithm=logarithm, temperature=t, isotherm=t, isotherms=np.unique(t), frequency=f
    )
    plain = SimpleNamespace(observed=observed, noise=SimpleNamespace(sigma=(0.02, 0.005)))
    size = np.abs(modulus)
    expected = [
        [0.005 * 1j * logarithm.imag], [0.02 * size], [0.02 / size, 0.02 / size**2], [0.02 * (t - 15.0)],
    ]  # fmt: skip
    for (_, roots), shapes in zip(doubts._shaped(plain), expected, strict=True):
        for root, shape in zip(roots, shapes, strict=True):
            unit = np.sqrt(np.mean(np.abs(shape) ** 2)) / (0.005 if root.imag.any() else 0.02)
            assert root[:, 0] == pytest.approx(shape / unit)
    same, changing = (root @ root.T for root in doubts._smooth(observed))
    along = 0.25 + np.where(f[:, None] == f, 1.0, np.exp(-0.5))
    assert same == pytest.approx(along, rel=5e-3)
    assert changing == pytest.approx(along * np.where(t[:, None] == t, 1.0, np.exp(-2.0)), rel=0.02, abs=2e-3)


def test_a_cause_taken_out_of_a_fit_leaves_what_it_did_in_the_data():
    """Its direction in typical units times its size; the gradient by the rest of the law too."""
    random = np.random.default_rng(2)
    jacobian, residual = random.standard_normal((8, 3)), random.standard_normal(8)
    named = candidate("phase_offset", 1.5)

    class Linear:
        active, law, scales = (named,), None, None
        place_of = staticmethod(lambda key: 2)
        fixed = staticmethod(lambda columns: rest if list(columns) == [2] else None)

    linear = Linear()
    linear.jacobian, linear.residual = jacobian, residual
    rest = make_dataclass("Rest", ["jacobian", "residual", "gradient"])(
        jacobian[:, :2], residual, np.array([1.0, 2.0])
    )
    plain = SimpleNamespace(direction=lambda *given: np.array([2.0, 3.0j]) if given[3:] == (0, 0) else None)
    out, direction, effect = doubts._drop_cause(SimpleNamespace(linear=linear, plain=plain), named)
    assert (direction == jacobian[:, [2]]).all() and effect == pytest.approx([6.0, 9.0j])
    assert out.residual == pytest.approx(residual + 3.0 * jacobian[:, 2])
    assert out.gradient == pytest.approx([1.0, 2.0] + 3.0 * jacobian[:, :2].T @ jacobian[:, 2])
