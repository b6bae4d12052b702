"""Orders to a laboratory: which test is asked for, and that carrying it out does what was promised."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from test_diagnose import SCATTER
from test_diagnose import table as of_four

from asphalt_nscd.diagnosis.causes.temperature_bias import TemperatureBias
from asphalt_nscd.diagnosis.model.discrepancy import Process
from asphalt_nscd.diagnosis.model.joint import Candidate
from asphalt_nscd.diagnosis.next_tests import choice, fixed_orders
from asphalt_nscd.diagnosis.next_tests.further_tests import possible
from asphalt_nscd.diagnosis.next_tests.information import Knowledge, Question
from asphalt_nscd.diagnosis.next_tests.sweeps import METAL, NEW, Costs, Sweep
from asphalt_nscd.diagnosis.observed.observations import Observations
from asphalt_nscd.diagnosis.record import instructions
from asphalt_nscd.diagnosis.search.diagnose import Diagnosis, diagnose
from asphalt_nscd.diagnosis.words import order_words
from asphalt_nscd.diagnosis.words.sentences import spell_cause

pytestmark = pytest.mark.slow

BIAS = TemperatureBias()


def table(seed, effect=lambda modulus, specimen, temperature, omega: modulus) -> Observations:
    """Of three specimens, which tell an odd one from the others."""
    whole = of_four(seed, effect)
    return replace(whole.subset(whole.specimen < 3), names=whole.names[:3], whole=None)


def few(observed: Observations, *isotherms: float) -> Observations:
    """Of these isotherms [degC] alone, whose diagnosis takes half the time."""
    return replace(observed.subset(np.isin(observed.isotherm, isotherms)), whole=None)


@pytest.fixture(scope="module")
def delayed() -> Diagnosis:
    return diagnose(table(3, lambda e, s, t, w: e * np.exp(1.5e-4j * w)), draws=1000)


@pytest.fixture(scope="module")
def empty() -> Diagnosis:
    return diagnose(table(4), draws=1000)


def test_limits_of_the_linear_model_are_those_of_the_diagnosis(empty):
    """Two ways to the same standard error: a score test of the whole table, and information of all tests."""
    model = possible(empty, Costs())
    information = Knowledge(model.linear, [model.old]).information
    of_metal = np.arange(model.linear.nuisance.shape[0]) >= model.table.size  # its level is known to 3 %
    assert (model.linear.nuisance[:, -1] == of_metal).all()
    assert model.linear.precision[-1, -1] == pytest.approx(0.03**-2)
    everything = np.ones(model.linear.nuisance.shape[0], bool)
    for k, candidate in enumerate(model.candidates):
        limit = empty.ladder.limits.get(candidate.key)
        if limit is None or len(candidate.values) > 1 or candidate.key[0] == "temperature_bias":
            continue
        error = empty.ladder.estimates[candidate.key][1] / candidate.typical[0]
        strength = Question(k, error, (), 1e9, everything).strength(information)
        assert np.sqrt(strength) == pytest.approx(1.0, rel=0.08), candidate.key
        # raised where processes would take the effect up
        assert 0.9 < limit / candidate.typical[0] / (5.3 * error) < 4.0, candidate.key


def test_a_named_delay_is_to_be_confirmed_on_metal_at_the_highest_frequency(delayed):
    orders = instructions.instructions(delayed)["orders"]
    first = orders[0]
    assert first["specimens"] == [METAL] and first["temperature_C"] is None
    assert 40.0 in first["frequencies_Hz"]
    (why,) = [sentence for sentence in first["why"] if "Metal" in sentence]
    (rung,) = delayed.ladder.rungs
    assert f"{np.degrees(rung.candidate.values[0] * 80 * np.pi):.1f} deg of phase at 40 Hz" in why
    assert len(orders) <= 5


def why(kind, about, other, strengths, later=False, **then):
    """Reasons that an order at 20 degC gives for one question."""
    one = order_words.Open(kind, None, about, other, **then)
    order = choice.Order(Sweep("a", 20.0, (10.0,), False, None, 1.0), ["a"], 1.0, 1.0, {0: strengths})
    return order_words.reasons(order, [one], order_words.Context(later=later))


@pytest.mark.parametrize(
    "before,alike,said", [(4.0, False, True), (13.0, False, True), (14.0, True, True), (14.0, False, False)]
)
def test_a_cause_that_looks_the_same_is_told_where_a_test_would_decide(before, alike, said):
    told = why("apart", "channel delay", "phase offset", (before, 30.0), alike=alike)
    assert [one.endswith("This test should decide.") for one in told] == [True] * said
    less = why("apart", "channel delay", "phase offset", (before, 13.0), alike=alike)
    assert not said or less[0].endswith("This test should make it clearer.")


def test_an_odd_isotherm_is_to_be_tested_again():
    observed = table(4)
    odd = (observed.specimen == 1) & (observed.isotherm == 0)
    found = diagnose(replace(observed, modulus=observed.modulus * np.where(odd, 1.3, 1.0)), draws=1000)
    orders = instructions.instructions(found)["orders"]
    (again,) = [
        one for one in orders if any("times what its other temperatures" in why for why in one["why"])
    ]
    assert (again["specimens"], again["temperature_C"], again["half_strain"]) == (["b"], 0.0, False)
    assert again["why"][0].startswith("Specimen b at 0 degC: |E*| 1.")
    assert again["why"][0].endswith("was at fault: use the new tests.")


def test_a_sweep_that_was_asked_for_lowers_the_standard_error_as_promised(empty):
    """A bias of one isotherm: the sweep that says most of it is added to the table, which is diagnosed again."""
    found = empty
    model = possible(found, Costs())
    k = next(k for k, c in enumerate(model.candidates) if c.key == ("temperature_bias", 30.0))
    known = Knowledge(model.linear, [model.old])
    own = [one for one in model.sweeps if one.specimen in found.observed.names and not one.half_strain]
    more = known.gained([one.tested for one in own])[:, k, k]
    best, least = own[int(np.argmax(more))], own[int(np.argmin(more))]
    before = found.ladder.estimates["temperature_bias", 30.0][1]
    after = {}
    for one, gained in ((best, max(more)), (least, min(more))):
        wider = diagnose(_with(found.observed, one.specimen, one.temperature, one.frequencies), draws=1000)
        after[one.temperature] = wider.ladder.estimates["temperature_bias", 30.0][1]
        promised = before * np.sqrt(known.information[k, k] / (known.information[k, k] + gained))
        # The sweep adds its own scatter, and with it the errors of the laboratory are sized anew.
        assert after[one.temperature] == pytest.approx(promised, rel=0.2)
    assert after[best.temperature] < 0.8 * after[least.temperature]


def _with(observed: Observations, specimen: str, temperature: float, frequencies) -> Observations:
    """The table and one more sweep, drawn about the same law."""
    from test_diagnose import GAMMA, LAW

    random = np.random.default_rng(9)
    f = np.array(frequencies)
    size = f.size
    noise = SCATTER[0] * random.standard_normal(size) + 1j * SCATTER[1] * random.standard_normal(size)
    more = LAW.complex_modulus(2 * np.pi * f, np.full(size, temperature)) * np.exp(noise)
    own = np.full(size, observed.names.index(specimen))
    return Observations(
        np.concatenate([observed.specimen, own]),
        observed.names,
        np.concatenate([observed.temperature, np.full(size, temperature)]),
        np.concatenate([observed.frequency, f]),
        np.concatenate([observed.modulus, more]),
        np.full(observed.size + size, GAMMA),
        np.zeros(observed.size + size),
    )


def test_places_of_one_cause_are_told_together():
    helped = [
        (order_words.Open("reach", None, "a bias", candidate=Candidate(BIAS, t, (0.0,))), *strengths)
        for t, *strengths in ((20.0, 0.0, 47.0), (4.0, 0.0, 25.0), (50.0, 9.0, 47.0), (35.0, 9.0, 9.1))
    ]
    ((about, places, now, then),) = order_words.reached(helped)
    assert about == "a bias" and order_words.spelled_places(places) == " at 4, 20 or 50 degC"
    assert (order_words.chances(now), order_words.chances(then)) == ("0 to 24 %", "90 to 100 %")


def test_of_three_temperatures_the_last_order_is_a_fourth():
    whole = table(3)
    three = whole.subset(whole.temperature > 12.0)
    orders = instructions.instructions(diagnose(three, draws=1000))["orders"]
    assert len(orders) <= 5
    assert (orders[-1]["specimens"], orders[-1]["temperature_C"]) == (["a", "b"], 40.0)
    assert orders[-1]["why"] == ["3 temperatures were tested. A fault can be proved from 4 on."]


@pytest.mark.parametrize("tested,new", [([4, 21, 37], "47"), ([20, 35], "10 and 45"), ([60, 58, 50], "40")])
def test_temperatures_that_certainty_lacks_lie_beyond_those_tested(tested, new):
    whole = table(4)
    part = whole.subset(np.isin(whole.isotherm, whole.isotherms[: len(tested)]))
    at = np.array(sorted(tested), float)[np.unique(part.isotherm, return_inverse=True)[1]]
    (order,) = fixed_orders.order_temperatures(replace(part, temperature=at, nominal_temperature=at), Costs())
    assert f"test specimens a and b at {new} degC, " in order["text"]
    assert fixed_orders.order_temperatures(table(4), Costs()) == []
    poor = np.where(part.specimen == 0, 40.0, 20.0)
    checked = replace(
        part, temperature=at, nominal_temperature=at, quality={"deformation_uniformity_percent": poor}
    )
    assert fixed_orders.order_temperatures(checked, Costs())[0]["specimens"] == list(part.names[1:3])


def test_gauges_are_checked_first_where_half_of_the_tests_exceed_a_limit():
    whole = table(4)
    uniform = np.where(whole.specimen < 2, 40.0, 10.0)  # a and b of three
    flagged = replace(whole, quality={"deformation_uniformity_percent": uniform})
    order, *_ = instructions.instructions(diagnose(flagged, draws=1000))["orders"]
    assert order["specimens"] == ["a", "b"] and order["temperature_C"] == 20.0
    assert (
        ": check the gauges and the ends of the specimens, mount specimens a and b anew and test"
        in order["text"]
    )
    assert order["why"][0].startswith(f"{np.count_nonzero(uniform > 30.0)} of {whole.size} tests exceed")
    few = np.where(whole.specimen < 1, 40.0, 10.0)
    assert fixed_orders.gauges(replace(whole, quality={"deformation_uniformity_percent": few}), Costs()) == []


def test_of_one_specimen_the_first_order_is_a_second_one():
    alone = replace(table(3).subset(table(3).specimen == 0), names=("a",))
    orders = instructions.instructions(diagnose(alone, draws=1000))["orders"]
    assert orders[0]["specimens"] == [NEW] and orders[0]["frequencies_Hz"] == alone.frequencies.tolist()
    assert orders[0]["text"].startswith(f"{orders[0]['hours']:.1f} h: test a new specimen at ")
    assert len(orders) <= 5
    several = instructions.instructions(diagnose(table(3), draws=1000))["orders"]
    assert several[0]["specimens"] != [NEW]


def test_a_cause_that_these_tests_cannot_show_is_not_said_to_be_found_in_them(delayed):
    model = possible(delayed, Costs())
    reach = [one for one in instructions.open_questions(delayed, model) if one.kind == "reach"]
    bias = next(one for one in model.candidates if one.key == ("temperature_bias", 20.0))
    spread = delayed.ladder.estimates_spread
    wide = 3.0 * bias.typical[0] / spread
    limits = {bias.key: wide}
    shown, nowhere = (replace(delayed, ladder=replace(delayed.ladder)) for _ in range(2))
    shown.ladder.limits, nowhere.ladder.limits = limits, {}
    assert instructions._strength_by_limit(shown, bias) == pytest.approx((3.7 + 1.645) ** 2)
    assert instructions._strength_by_limit(nowhere, bias) == 0.0
    assert all(one.hidden >= 0.0 for one in reach)
    (said,) = why("reach", "a bias of 0.9 K", "", (9.0, 90.0), hidden=9.0)
    assert said.endswith("with a chance of 100 %; without it the chance is 0 %.")


def test_no_order_looks_for_a_cause_that_a_discrepancy_hides(empty):
    model = possible(empty, Costs())

    def sought(diagnosis):
        return [one.about for one in instructions.open_questions(diagnosis, model) if one.kind == "reach"]

    hidden = replace(
        empty, ladder=replace(empty.ladder, discrepancy={Process("isotherm", "phase", 20.0): 2.0})
    )
    assert any("second peak of the loss modulus" in about for about in sought(empty))
    assert not any("second peak of the loss modulus" in about for about in sought(hidden)) and sought(hidden)


def test_metal_is_ordered_at_both_ends_of_the_band_where_phases_lie_on_one_side(empty):
    (order,) = fixed_orders.metal(empty.observed, Costs(), "All phases lie above.")
    ends = empty.observed.frequencies[[0, -1]].tolist()
    assert (order["specimens"], order["frequencies_Hz"], order["temperature_C"]) == ([METAL], ends, None)
    assert order["hours"] == pytest.approx(Costs().hours(METAL, 20.0, ends), abs=0.005)
    told = instructions.instructions(empty, ahead=[order])["orders"]
    assert told[0] == order and len(told) <= instructions.MOST


def test_an_isotherm_off_its_target_is_tested_again_first():
    off = [{"specimen": name, "temperature_C": 20.0, "measured_C": 20.7} for name in "ac"]
    (order,) = fixed_orders.off_target(table(3), Costs(), off)
    assert (order["specimens"], order["temperature_C"]) == (["a", "c"], 20.0)
    assert ": test specimens a and c again at 20 degC, " in order["text"]
    assert order["purpose"] == "because they were measured up to 0.7 K off their target"
    (one,) = fixed_orders.off_target(table(3), Costs(), off[:1])
    assert one["purpose"] == "because it was measured 0.7 K off its target"
    assert fixed_orders.off_target(table(3), Costs(), []) == []


def test_orders_know_the_copies(delayed):
    observed = delayed.observed
    rows = [
        np.flatnonzero((observed.specimen == k) & (observed.isotherm == observed.isotherms[0]))
        for k in (0, 1)
    ]
    modulus = observed.modulus.copy()
    modulus[rows[1]] = modulus[rows[0]]
    found = diagnose(replace(observed, modulus=modulus), draws=500)
    again = [one for one in possible(found, Costs()).departures if one.kind == "repeat"]
    assert len(again) == 2 * rows[0].size and all(one.copied for one in again)


def test_a_specimen_may_be_called_anything():
    """Names that look like a temperature, a frequency or a list once ended in a traceback."""
    observed = few(table(3), 0.0, 15.0, 30.0)
    names = ("Mix 21 degC", "10 Hz, phase", "21", "specimen at 4 degC")[: len(observed.names)]
    odd = (observed.specimen == 1) & (observed.isotherm == 0)
    bent = np.where(observed.isotherm == observed.isotherm[-1], observed.frequency**0.3, 1.0)
    modulus = observed.modulus * np.where(odd, 1.3, 1.0) * bent
    found = diagnose(replace(observed, names=names, modulus=modulus), draws=500)
    assert found.ladder.discrepancy  # whose parts had such names
    assert {one.specimen for one in found.ladder.discrepancy} == {None, *names}
    assert instructions.instructions(found)["orders"]
    assert spell_cause("loose_clamp @ 21") == "loose clamp of specimen 21"
    assert spell_cause("temperature_bias @ 21.0") == "temperature bias at 21 degC"
