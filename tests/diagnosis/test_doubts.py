"""A name in doubt: a look-alike takes most of an effect, but not its shape."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from asphalt_nscd.diagnosis.causes import CATALOGUE
from asphalt_nscd.diagnosis.model import discrepancy, fit_beside, laboratory, start
from asphalt_nscd.diagnosis.model.joint import Candidate
from asphalt_nscd.diagnosis.observed import scatter
from asphalt_nscd.diagnosis.observed.observations import Observations
from asphalt_nscd.diagnosis.search.diagnose import diagnose
from asphalt_nscd.diagnosis.search.doubts import find_doubts
from asphalt_nscd.rheology.parabolic import HuetSayegh
from asphalt_nscd.rheology.shift import WLF

pytestmark = pytest.mark.slow

LAW = HuetSayegh(
    static_modulus=80e6, glassy_modulus=32e9, k=0.22, h=0.6, delta=2.3, tau=0.3, shift=WLF(18.0, 140.0, 15.0)
)
CAUSES = {cause.name: cause for cause in CATALOGUE}
SCATTER = (0.01, np.radians(0.3))


TEMPERATURES = (-10.0, 4.0, 21.0, 37.0, 54.0)
FREQUENCIES = (0.1, 0.5, 1.0, 5.0, 10.0, 25.0)


def table(
    effect=lambda omega, temperature: 0.0,
    seed: int = 3,
    temperatures: tuple[float, ...] = TEMPERATURES,
    frequencies: tuple[float, ...] = FREQUENCIES,
) -> Observations:
    """Three specimens; effect: what is added to ln E* (n,)."""
    random = np.random.default_rng(seed)
    grid = np.array([(s, t, f) for s in range(3) for t in temperatures for f in frequencies])
    temperature, omega = grid[:, 1], 2.0 * np.pi * grid[:, 2]
    noise = SCATTER[0] * random.standard_normal(len(grid)) + 1j * SCATTER[1] * random.standard_normal(
        len(grid)
    )
    modulus = LAW.complex_modulus(omega, temperature) * np.exp(effect(omega, temperature) + noise)
    ones = np.ones(len(grid))
    return Observations(
        specimen=grid[:, 0].astype(int),
        names=("A", "B", "C"),
        temperature=temperature,
        frequency=grid[:, 2],
        modulus=modulus,
        form_factor=25e3 * ones,
        inertia=0.0 * ones,
    )


def doubts_of(observed: Observations, *names: str | Candidate) -> dict:
    """Doubts of these causes, fitted together and found in this order."""
    noise = scatter.stated(observed, *SCATTER, 0.03)
    joint, fitted = start.fit_spectrum(observed, noise)
    named = [n if isinstance(n, Candidate) else Candidate(CAUSES[n], None, (0.0,)) for n in names]
    alone = laboratory.alone(joint)
    processes = laboratory.processes(alone, alone.linearise(fitted.law, fitted.scales, ()))
    least = np.full(len(processes.described), discrepancy.LEAST)
    return find_doubts(fit_beside.settle(alone, processes, fitted, tuple(named), least), named)


def late(omega, temperature):
    return 6e-4j * omega


def turned(omega, temperature):
    return 1j * np.radians(3.0)


@cache
def of_the_delay():
    return diagnose(table(late), draws=500)


@pytest.mark.parametrize(
    "effect,right,wrong",
    [(late, "channel_delay", "phase_offset"), (turned, "phase_offset", "channel_delay")],
)
def test_a_look_alike_is_in_doubt_and_the_cause_itself_is_not(effect, right, wrong):
    observed = table(effect)
    assert doubts_of(observed, right) == {}
    (reason, *_) = doubts_of(observed, wrong)[wrong, None]
    assert "could look the same" in reason or "Its size may differ" in reason or "instead" in reason


def test_an_effect_that_grows_with_temperature_is_no_offset():
    observed = table(lambda omega, temperature: 1j * np.radians(0.12) * (temperature + 10.0))
    assert ("phase_offset", None) in doubts_of(observed, "phase_offset")


def test_a_small_effect_is_only_likely():
    observed = table(lambda omega, temperature: 0.06 * turned(omega, temperature))
    (reason,) = doubts_of(observed, "phase_offset")["phase_offset", None]
    assert reason == (
        "Another error that varies smoothly with frequency could look the same, and the evidence for this one is weak"
    )


def test_what_follows_a_name_in_doubt_is_in_doubt():
    observed = table(lambda omega, temperature: turned(omega, temperature) + late(omega, temperature))
    assert doubts_of(observed, "phase_offset", "channel_delay") == {}
    observed = table(lambda omega, temperature: turned(omega, temperature) + 0.05 * late(omega, temperature))
    found = doubts_of(observed, "channel_delay", "phase_offset")
    assert found["phase_offset", None] == ["It was found after another cause that is itself not certain"]
    assert list(doubts_of(observed, "phase_offset", "channel_delay")) == [("channel_delay", None)]


def test_a_parameter_at_its_bound_is_no_estimate():
    observed = table(lambda omega, temperature: 1j * np.radians(40.0))
    (reason, *_) = doubts_of(observed, "phase_offset")["phase_offset", None]
    assert reason == "Its offset stands at the bound of 30 deg"


@pytest.mark.parametrize("mass,doubted", [(-0.4, True), (-0.2, False), (0.4, False)])
def test_no_less_than_nothing_moves(mass, doubted):
    observed = table()
    counted = 0.316
    observed = replace(
        observed,
        inertia=counted * observed.form_factor,
        modulus=observed.modulus - observed.form_factor * mass * observed.omega**2,
    )
    reasons = doubts_of(observed, "moving_mass").get(("moving_mass", None), [])
    assert ("Less than no mass would move: the reduction counts 316 g" in reasons) == doubted


def test_a_name_in_doubt_explains_nothing(monkeypatch):
    named = of_the_delay()
    (rung,) = named.ladder.rungs
    assert rung.candidate.cause.name == "channel_delay"
    assert named.verdict == "explained" and named.established(rung) and named.doubts == {}
    monkeypatch.setattr(
        "asphalt_nscd.diagnosis.search.ladder.find_doubts", lambda *of: {rung.candidate.key: ["Why"]}
    )
    doubted = diagnose(table(late), draws=500)
    assert doubted.verdict == "unexplained_structure" and not doubted.established(doubted.ladder.rungs[0])


def test_without_the_cause_in_the_catalogue_no_name_is_established():
    without = tuple(cause for cause in CATALOGUE if cause.name != "channel_delay")
    found = diagnose(table(late), catalogue=without, draws=500)
    assert found.verdict == "unexplained_structure"
    assert not any(found.established(rung) for rung in found.ladder.rungs)


def test_a_size_whose_interval_holds_zero_is_unsure():
    ladder = of_the_delay().ladder
    (rung,) = ladder.rungs
    delay = ladder.fitted.active[0].values[0]
    for error, unsure in ((0.6 * delay, True), (0.4 * delay, False)):
        told = replace(ladder, estimates={rung.candidate.key: (delay, error)})
        assert (told.unsure is not None) == unsure


@pytest.mark.parametrize(
    "name,wrong,reason",
    [
        (
            "phase_offset",
            lambda e: np.abs(e) * np.exp(0.9j * np.angle(e)),
            "A phase read on a wrong scale would look the same",
        ),
        (
            "phase_offset",
            lambda e: e / (1.0 + np.abs(e) / 100e9),
            "A machine's compliance taken off |E*| alone would look the same",
        ),
    ],
)
def test_an_error_of_a_known_shape_puts_its_look_alike_in_doubt(name, wrong, reason):
    observed = table()
    assert reason in doubts_of(replace(observed, modulus=wrong(observed.modulus)), name)[name, None]


@pytest.mark.parametrize("effect,name", [(late, "channel_delay"), (turned, "phase_offset")])
def test_the_cause_itself_is_not_taken_for_such_an_error(effect, name):
    assert doubts_of(table(effect), name) == {}
