"""The model of tests that could follow, what each would say, and which of them are chosen."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from asphalt_nscd.diagnosis.causes import CATALOGUE
from asphalt_nscd.diagnosis.model.discrepancy import Process
from asphalt_nscd.diagnosis.model.joint import Candidate
from asphalt_nscd.diagnosis.next_tests import choice, fixed_orders, further_tests, sweeps
from asphalt_nscd.diagnosis.next_tests.sweeps import METAL, NEW, Costs, Sweep
from asphalt_nscd.diagnosis.observed.noise import Noise
from asphalt_nscd.diagnosis.observed.observations import Observations
from asphalt_nscd.diagnosis.record import instructions

CAUSES = {cause.name: cause for cause in CATALOGUE}
GRID = np.array([(s, t, f) for s in (0, 1) for t in (0.0, 20.0) for f in (1.0, 10.0)])
DONE = Observations(
    GRID[:, 0].astype(int), ("A", "B"), GRID[:, 1], GRID[:, 2], np.exp(23.0 + 0.1 * np.arange(8) + 0.3j),
    np.full(8, 25e3), np.full(8, 6e3), amplitude=np.full(8, 5e-5), cycles=np.arange(1.0, 9.0),
    time_step=np.full(8, 1e-4),
)  # fmt: skip
TABLE = sweeps.every_test(DONE, [0.0, 10.0, 20.0])
LINEAR = SimpleNamespace(effects=np.zeros((TABLE.size + 2, 3)))
HALVED = sweeps.half_strain_rows(TABLE)


def diagnosis(**ladder):
    return SimpleNamespace(observed=DONE, whole=DONE, suspects=(), ladder=SimpleNamespace(**ladder))


def rows(**wanted):
    """Rows to come with these values, at the usual strain."""
    found = ~HALVED & (np.arange(TABLE.size) >= DONE.size)
    for name, value in wanted.items():
        found &= getattr(TABLE, name) == value
    return np.flatnonzero(found)


def test_tests_to_come_are_of_each_specimen_and_a_new_one_and_some_at_half_the_strain():
    assert sweeps.temperatures(DONE) == [-10.0, 0.0, 10.0, 20.0, 30.0] and sweeps.frequencies(DONE) == [
        0.3,
        1.0,
        10.0,
    ]
    assert TABLE.names == ("A", "B", NEW) and TABLE.size == 8 + 3 * 3 * 3 + 2 * 2 * 2
    assert (TABLE.amplitude[HALVED] == 2.5e-5).all() and HALVED.sum() == 8
    assert set(zip(TABLE.isotherm[HALVED], TABLE.frequency[HALVED])) == {
        (t, f) for t in (0, 20) for f in (1, 10)
    }
    for k, borne in enumerate((4.0, 8.0, 1.0)):  # a new specimen has borne none
        assert (TABLE.cycles[8:][TABLE.specimen[8:] == k] == borne).all()
    assert (TABLE.time_step == 1e-4).all() and (TABLE.form_factor == 25e3).all()


@pytest.mark.parametrize(
    ("tested", "at"),
    [
        ([0.0, 7.9, 20.0], [-10.0, 0.0, 7.9, 14.0, 20.0, 30.0]),
        ([-15.0, 0.0], [-15.0, -8.0, 0.0, 10.0]),
        ([40.0, 55.0], [30.0, 40.0, 48.0, 55.0]),
    ],
)
def test_temperatures_lie_between_those_far_apart_and_ten_kelvin_beyond(tested, at):
    assert sweeps.temperatures(SimpleNamespace(isotherms=np.array(tested))) == at


@pytest.mark.parametrize(
    ("tested", "at"), [([0.1, 1.0], [0.03, 0.1, 1.0]), ([0.02, 1.0], [0.02, 1.0]), ([5.0], [2.0, 5.0])]
)
def test_one_frequency_below_is_a_third_that_a_machine_can_be_set_to(tested, at):
    assert sweeps.frequencies(SimpleNamespace(frequencies=np.array(tested))) == at


def test_of_many_values_some_are_kept_evenly_with_both_ends():
    many = SimpleNamespace(isotherms=np.arange(25.0), frequencies=np.arange(1.0, 16.0))
    assert sweeps.temperatures(many)[1:-1] == [0, 2, 4, 7, 9, 11, 13, 15, 17, 20, 22, 24]
    assert sweeps.frequencies(many)[1:] == [1, 3, 5, 7, 9, 11, 13, 15]


def test_hours_are_those_of_mounting_conditioning_cycles_and_pauses():
    costs, cycles = Costs(), 20.0 * (1.0 / 0.1 + 1.0 / 10.0) / 3600.0 + 2.0 / 60.0
    for specimen, temperature, fixed in (
        ("A", 15.0, 0.5), ("A", 25.0, 0.5), ("A", 14.9, 2.5), ("A", 25.1, 2.5), (NEW, 20.0, 4.5), (NEW, 0.0, 6.5),
        (METAL, 0.0, 0.5),
    ):  # fmt: skip
        assert costs.hours(specimen, temperature, (0.1, 10.0)) == pytest.approx(fixed + cycles)


def noise():
    within = np.tile(np.linspace(0.01, 0.08, 8), (2, 1)) * [[1.0], [0.5]]
    return Noise(within, 0.5 * within, np.repeat(np.arange(4), 2), (0.04, 0.02), 0.03, 20)


def test_a_new_test_scatters_as_those_of_its_isotherm_or_of_the_whole_table():
    wide = sweeps.noise_of(noise(), DONE, TABLE)
    own = noise().within
    assert (wide.within[:, :8] == own).all() and (wide.block[:8] == noise().block).all()
    for t in (0.0, 20.0):
        here = np.flatnonzero(TABLE.isotherm == t)[4:]
        mean = own[:, DONE.isotherm == t].mean(axis=1, keepdims=True)
        assert wide.within[:, here] == pytest.approx(np.tile(mean, here.size))
        assert wide.shared[:, here] == pytest.approx(0.5 * wide.within[:, here])
    new = wide.within[:, TABLE.isotherm == 10.0]
    assert new == pytest.approx(np.tile(own.mean(axis=1, keepdims=True), new.shape[1]))
    one = sweeps.scatter_of(
        np.array([[3.0, 4.0], [1.0, 2.0]]), np.array([[2.0, 5.0], [6.0, 7.0]]), np.array([0, 0])
    )
    assert one == pytest.approx(np.array([[13, 10, 0, 0], [10, 41, 0, 0], [0, 0, 37, 42], [0, 0, 42, 53]]))


def test_sweeps_of_specimens_and_of_metal():
    costs, wide = Costs(), sweeps.noise_of(noise(), DONE, TABLE)
    every = list(sweeps.sweeps_at(DONE, TABLE, wide, costs))
    mounted = {
        (one.specimen, one.temperature, one.half_strain): set(wide.block[one.tested.rows]) for one in every
    }
    assert {len(one) for one in mounted.values()} == {1} and len(set.union(*mounted.values())) == len(
        mounted
    ) == 13
    assert min(set.union(*mounted.values())) > noise().block.max()
    usual = [one for one in every if not one.half_strain]
    assert {one.frequencies for one in usual} == {(1.0, 10.0), (0.3, 1.0, 10.0)} and len(usual) == 18
    assert {one.frequencies for one in every if one.half_strain} == {(1.0, 10.0)} and len(every) == 22
    for one in every:
        at = one.tested.rows
        assert (TABLE.isotherm[at] == one.temperature).all() and TABLE.frequency[at].tolist() == [
            *one.frequencies
        ]
        assert {TABLE.names[k] for k in TABLE.specimen[at]} == {one.specimen} and (
            HALVED[at] == one.half_strain
        ).all()
        assert one.hours == costs.hours(one.specimen, one.temperature, one.frequencies)
        scatter = sweeps.scatter_of(wide.within[:, at], wide.shared[:, at], np.zeros(at.size))
        assert one.tested.scatter == pytest.approx(scatter)
    five = replace(DONE.subset(np.arange(5)), frequency=np.arange(1.0, 6.0))
    metal = sweeps.metal_tests(five)
    assert metal.frequency.tolist() == [1, 2, 3, 4, 5] and (metal.modulus == 70e9).all()
    bands = list(sweeps.sweeps_on_metal(metal, 40, noise(), costs))
    assert [one.frequencies for one in bands] == [(1, 2, 3, 4, 5), (1, 3, 5), (1, 5)]
    assert bands[2].tested.rows.tolist() == [40, 44]
    assert bands[2].tested.scatter == pytest.approx(np.diag([0.04, 0.04, 0.02, 0.02]) ** 2)


def test_a_test_left_out_departs_from_what_the_others_say_where_it_is_repeated():
    found = diagnosis()
    found.suspects = tuple(SimpleNamespace(row=row, used=used) for row, used in ((2, False), (5, True)))
    expected = DONE.logarithm[2] - (0.2 - 0.1j)
    (one,) = further_tests._repeats(found, TABLE, np.full(TABLE.size, expected), LINEAR)
    (row,) = rows(specimen=0, isotherm=20.0, frequency=1.0)
    assert (one.kind, one.specimen, one.isotherm, one.frequency, one.copied) == (
        "repeat",
        "A",
        20.0,
        1.0,
        False,
    )
    assert np.flatnonzero(one.effect).tolist() == [row] and one.effect[row] == pytest.approx(0.2 - 0.1j)


@pytest.mark.parametrize(
    ("odd", "at", "effect"),
    [
        ({"temperature_C": 20.0, "factor": 1.2}, {"isotherm": 20.0}, lambda f: np.log(1.2) + 0.0 * f),
        ({"temperature_C": None, "phase_deg": 3.0}, {}, lambda f: 1j * np.radians(3.0) + 0.0 * f),
        ({"temperature_C": None, "phase_deg": 3.0, "delay_s": 1.0}, {}, lambda f: 1j * np.radians(0.3 * f)),
    ],
)
def test_what_is_odd_would_be_so_again_and_a_delay_falls_with_the_frequency(odd, at, effect):
    one = further_tests._again(diagnosis(), TABLE, LINEAR, {"specimen": "B", **odd})
    here = rows(specimen=1, **at)
    assert np.flatnonzero(one.effect).tolist() == here.tolist()
    assert one.effect[here] == pytest.approx(effect(TABLE.frequency[here]))
    every = [{"kelvin": 1.0}, {"factor": 1.2}, {"offset_deg": 1.0}, {"phase_deg": 3.0}]
    assert further_tests._odd(diagnosis(confined_faults=every)) == [every[1], every[3]]


def test_half_the_strain_takes_half_of_an_isotherm_s_own_departure_back():
    processes = [Process("isotherm", part, t) for t in (0.0, 20.0) for part in ("modulus", "phase")]
    columns = [(one, slice(k, k + 1)) for k, one in enumerate(processes)]
    nuisance = np.zeros((TABLE.size + 2, 4), complex)
    nuisance[: TABLE.size] = np.array([1.0, 1j, 1.0, 1j])
    found = diagnosis(discrepancy=dict(zip(processes, (0.9, 0.8, 0.2, 1.1))))
    linear = SimpleNamespace(nuisance=nuisance, effects=LINEAR.effects)
    (one,) = further_tests._nonlinear_departures(
        found, TABLE, linear, np.array([9.0, 9.0, 0.02, 0.06]), columns
    )
    here = np.flatnonzero(HALVED & (TABLE.isotherm == 20.0))
    assert (one.kind, one.isotherm) == ("linear", 20.0) and np.flatnonzero(
        one.effect
    ).tolist() == here.tolist()
    assert one.effect[here] == pytest.approx(np.full(here.size, -0.01 - 0.03j))


def test_a_process_at_a_new_isotherm_has_a_size_between_its_neighbours():
    sizes = {Process("isotherm", "phase", 0.0): 2.0, Process("specimen", "phase", None, "A"): 3.0,
             Process("specimen", "phase", None, "B"): 1.0}  # fmt: skip

    def variance(*process):
        return further_tests._variance(Process(*process), sizes, np.array([0.0, 20.0]))

    assert variance("isotherm", "phase", 0.0) == 4.0 and variance("isotherm", "phase", 5.0) == 1.5**2
    assert variance("isotherm", "phase", -10.0) == 4.0 and variance("isotherm", "modulus", 5.0) == 0.0
    assert variance("specimen", "phase", None, NEW) == 5.0 and variance("all", "phase") == 0.0


def test_only_head_and_channel_act_on_metal():
    metal = sweeps.metal_tests(DONE)
    named = {
        "channel_delay": 1e-4, "phase_offset": 1.0, "moving_mass": 0.1, "guide_friction": 0.0, "film_softening": 1.0,
    }  # fmt: skip
    candidates = [Candidate(CAUSES[name], None, (value,)) for name, value in named.items()]
    found = further_tests._metal_effects(
        metal, [*candidates, Candidate(CAUSES["loose_clamp"], "A", (1e-12,))]
    )
    omega, inertia = metal.omega, 6e3 * metal.omega**2
    turned = (70e9 - inertia) * np.exp(1j * np.radians(1.0))
    expected = [
        1e-4 * 1j * omega * (1.0 - inertia / 70e9),
        1j * np.radians(0.5) * turned / (turned + inertia),
        -25e3 * 0.02 * omega**2 / (70e9 - 25e3 * 0.1 * omega**2),
        2e7j / 70e9 * np.ones(2),
        np.zeros(2),
        np.zeros(2),
    ]
    assert found == pytest.approx(np.array(expected).T, rel=1e-3, abs=1e-12)


def sweep(specimen, temperature, hours, half=False, frequencies=(1.0, 10.0)):
    return Sweep(specimen, temperature, frequencies, half, None, hours)


class Told:
    """An inquiry in which each sweep tells a fixed amount of each question until it is taken."""

    def __init__(self, told):
        self.told, self.taken = told, 0

    def gains(self, tested):
        return np.array([self.told[one] for one in tested])

    def strengths(self):
        return [10.0 * self.taken] * 2

    def take(self, tested):
        self.taken += 1


def chosen(monkeypatch, kinds, *told):
    """Orders of sweeps (sweep, gain of each question)."""
    given = {k: gain for k, (_, gain) in enumerate(told)}
    monkeypatch.setattr(choice, "Inquiry", lambda *_: Told(given))
    waiting = tuple(replace(one, tested=k) for k, (one, _) in enumerate(told))
    model = SimpleNamespace(
        linear=None, old=None, known=None, sweeps=waiting, table=SimpleNamespace(names=("A", "B", NEW))
    )
    return choice.choose(model, [None] * 2, kinds)


def test_the_most_per_hour_comes_first_and_what_makes_tests_doubtful_before_it(monkeypatch):
    told = [
        (sweep("A", 0.0, 2.0), (4.0, 0.0)),  # two an hour
        (sweep("A", 20.0, 1.0), (3.0, 0.0)),  # three an hour
        (sweep("A", 40.0, 4.0), (0.0, 0.31)),  # of doubtful tests
        (sweep("A", 50.0, 0.1), (0.0, 0.29)),  # nothing
    ]
    at = [[one.sweep.temperature for one in chosen(monkeypatch, kinds, *told)] for kinds in (
        ["kept", "repeat"], ["kept", "level"], ["kept", "reach"])]  # fmt: skip
    assert at == [[40.0, 20.0, 0.0], [40.0, 20.0, 0.0], [20.0, 0.0, 40.0]]
    alike = [(sweep("A", t, 1.0), (3.0 * (1.0 + 1e-9 * t), 0.0)) for t in (0.0, 20.0)]  # but for rounding
    assert chosen(monkeypatch, ["kept", "reach"], *alike)[0].sweep.temperature == 0.0
    many = [(sweep("A", 10.0 * k, 1.0), (9.0 - k, 0.0)) for k in range(8)]
    assert len(chosen(monkeypatch, ["kept", "reach"], *many)) == 5


def test_one_sweep_of_several_specimens_is_one_order_and_none_is_asked_for_twice(monkeypatch):
    told = [
        (sweep("B", 0.0, 1.0), (4.0, 0.0)),
        (sweep("B", 0.0, 1.1, frequencies=(0.3, 1.0, 10.0)), (4.1, 0.0)),  # the same tests again
        (sweep("A", 0.0, 1.0), (3.0, 0.2)),
        (sweep("B", 0.0, 1.0, half=True), (2.0, 0.0)),
        (sweep(METAL, 20.0, 1.0, frequencies=(1.0,)), (1.5, 0.0)),
        (sweep(METAL, 20.0, 1.0, frequencies=(10.0,)), (1.4, 0.0)),
    ]
    first, half, metal = chosen(monkeypatch, ["kept", "metal"], *told)
    assert (first.specimens, half.specimens, metal.specimens) == (["A", "B"], ["B"], [METAL])
    assert (first.hours, first.nats) == (2.0, pytest.approx(7.2)) and not first.sweep.half_strain
    # Both tell of the first question, from none to 20; 0.2 is less than a tenth of 3.2, but enough of metal.
    assert first.helps == {0: (0.0, 20.0), 1: (10.0, 20.0)} and metal.sweep.frequencies == (1.0,)
    first, *_ = chosen(monkeypatch, ["kept", "reach"], *told)
    assert first.helps.keys() == {0}


def test_two_strains_by_two_modes_take_four_sweeps_where_the_excess_is_largest():
    done = replace(DONE, test_type="tension-compression")
    found = [
        {"temperature_C": t, "excess_deg": size, "standard_error_deg": 0.3}
        for t, size in ((0.0, 0.91), (20.0, 2.0))
    ]
    (order,) = fixed_orders.strains(done, Costs(), found)
    assert order["temperature_C"] == 20.0 and "2.0 deg above" in order["why"][0]
    assert order["hours"] == pytest.approx(4.0 * Costs().hours("A", 20.0, [1.0, 10.0]), abs=0.005)
    assert fixed_orders.strains(done, Costs(), [found[0] | {"excess_deg": 0.89}]) == []
    (order,) = fixed_orders.strains(done, Costs(), [found[1] | {"taken_off_deg": 1.8}])
    assert "2.0 deg above what |E*| requires, when corrected." in order["why"][0]
    assert fixed_orders.strains(DONE, Costs(), found) == []  # a beam oscillates about zero


def test_a_second_specimen_is_mounted_at_each_temperature_and_made_once():
    alone = replace(DONE.subset(DONE.specimen == 0), names=("A",))
    (order,) = fixed_orders.second_specimen(alone, Costs())
    sweep_hours = [Costs().hours("", t, [1.0, 10.0]) for t in (0.0, 20.0)]
    assert order["hours"] == pytest.approx(sum(sweep_hours) + 4.0, abs=0.005) and order["specimens"] == [NEW]
    assert fixed_orders.second_specimen(DONE, Costs()) == []


@pytest.mark.parametrize(
    ("effect", "share", "said"),
    [
        ([0.01j, 0.05j, 0.02j], 0.5, "5.7 deg of phase at 5 Hz"),
        ([0.01j, 0.05j, 0.02j], 2.0, "6 deg of phase at 5 Hz"),  # +- 11 deg
        ([0.05j, 0.0496j, 0.02j], 1e-3, "5.7 deg of phase at 5 Hz"),  # alike: the higher frequency
        ([0.001, -0.0004j, 0.001], 0.3, "0.20 % of the modulus at 10 Hz"),
        ([-0.03j] * 3, 0.3, "-3.4 deg of phase at every frequency"),
    ],
)
def test_what_a_cause_does_on_metal_is_told_where_it_does_most(effect, share, said):
    """Of two typical sizes, to the second digit of its interval or the first of its own."""
    effects = np.zeros((5, 2), complex)
    effects[2:, 1] = effect
    model = SimpleNamespace(
        table=SimpleNamespace(size=2), metal_frequencies=np.array([1.0, 5.0, 10.0]),
        linear=SimpleNamespace(nuisance=np.zeros((5, 1)), effects=effects),
    )  # fmt: skip
    assert instructions._metal_effect(model, 1, 2.0, share) == said


def test_rows_that_stay_where_a_part_is_left_out():
    kept = dict(instructions._parts(TABLE, TABLE.size + 2))
    assert set(kept) == {
        "0 degC",
        "10 degC",
        "20 degC",
        "0.3 Hz",
        "1 Hz",
        "10 Hz",
        "specimen A",
        "specimen B",
        f"specimen {NEW}",
    }
    assert (kept["specimen B"][:-2] == (TABLE.specimen != 1)).all() and kept["specimen B"][-2:].all()
    assert (kept["10 Hz"][:-2] == (TABLE.frequency != 10.0)).all() and (
        kept["0 degC"][:-2] == (TABLE.isotherm != 0)
    ).all()
