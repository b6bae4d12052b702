"""The excess of the phase, on mixes of a generator that shares nothing with the diagnosis, and on measured ones."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from attack.mixes import LAWS, SHIFTS, Mix

from asphalt_nscd.diagnosis.observed import scatter
from asphalt_nscd.diagnosis.observed.observations import Observations
from asphalt_nscd.diagnosis.observed.reading import PAPER_GEOMETRY, read_observations
from asphalt_nscd.diagnosis.screening import excess_phase
from asphalt_nscd.diagnosis.screening.excess_phase import excess_phases

ROOT = Path(__file__).resolve().parents[2]
SCATTER = 0.01, np.radians(0.3)  # of ln|E*| and phase
SPECIMENS = 3
DESIGNS = (
    ((4.0, 20.0, 40.0), (0.1, 1.0, 10.0)),  # AASHTO T 378
    ((-10.0, 4.4, 21.1, 37.8, 54.4), (0.1, 0.5, 1.0, 5.0, 10.0, 25.0)),  # AASHTO T 342
    ((-10.0, 0.0, 10.0, 15.0, 20.0, 30.0), (3.0, 6.0, 10.0, 25.0, 40.0)),  # EN 12697-26, two-point bending
)


def drawn(number, excess=0.0, mounting=0.0):
    """Tests of three specimens of a drawn mix whose phases lie above what |E*| requires by `excess` [rad].

    `mounting`: what a sweep's phases have in common by chance where it is warmest [rad], and a quarter where coldest.
    """
    rng = np.random.default_rng([20261128, number])
    temperatures, frequencies = DESIGNS[number % len(DESIGNS)]
    mix = Mix.draw(list(LAWS)[number % len(LAWS)], list(SHIFTS)[number // 2 % len(SHIFTS)], rng)
    specimen, temperature, frequency = (
        grid.ravel() for grid in np.meshgrid(range(SPECIMENS), temperatures, frequencies, indexing="ij")
    )
    chance = rng.standard_normal((2, specimen.size)) * np.array(SCATTER)[:, None]
    warm = 0.25 + 0.75 * (temperature - min(temperatures)) / np.ptp(temperatures)
    mounted = rng.standard_normal((SPECIMENS, len(temperatures), 1)).repeat(len(frequencies), axis=2).ravel()
    turned = chance[1] + excess + mounting * warm * mounted
    logarithm = mix.log_modulus(frequency, temperature) + chance[0] + 1j * turned
    flat = np.ones(specimen.size)
    names = tuple("abc")
    return Observations(
        specimen, names, temperature, frequency, np.exp(logarithm), flat, flat, test_type="axial"
    )


def found(observed):
    return excess_phases(observed, scatter.stated(observed, *SCATTER, 0.03))


@pytest.mark.slow
@pytest.mark.parametrize("mounting", [0.0, np.radians(0.8)])
def test_the_interval_holds_what_was_put_in(mounting):
    off, error, design, warmest = [], [], [], []
    for number in range(300):
        put_in = np.radians(1.5 * (number // 3 % 2))
        excesses = found(drawn(number, put_in, mounting))
        off += [one.excess - put_in for one in excesses]
        error += [one.std_error for one in excesses]
        design += [number % len(DESIGNS)] * len(excesses)
        warmest += [False] * (len(excesses) - 1) + [True]
    z, warmest = np.array(off) / error, np.array(warmest)
    assert 0.93 < np.mean(np.abs(z) < 1.96) < 0.985
    assert np.mean(np.abs(z[warmest]) < 1.96) > 0.92
    assert np.abs(z.mean()) < 0.15
    if not mounting:  # Six frequencies over two decades tell the excess of an isotherm to 0.3 degrees.
        assert np.mean(np.abs(off)[np.array(design) == 1] < np.radians(0.3)) > 0.9


def test_two_frequencies_tell_nothing():
    observed = drawn(0)
    assert found(observed.subset(observed.frequency < 5.0)) == []


def test_nine_measured_states_show_what_a_difference_of_three_tests_shows():
    """By 90 degrees times the slope between 0.1 and 10 Hz: 0.59, 1.74 and 2.0 degrees at 4, 20 and 40 degC."""
    excess = {4.0: [], 20.0: [], 40.0: []}
    for path in sorted((ROOT / "data/ncat").glob("*_*.csv")):
        for one in found(read_observations(path, PAPER_GEOMETRY)[0]):
            excess.setdefault(one.temperature, []).append(np.degrees(one.excess))
    means = [np.mean(excess[temperature]) for temperature in (4.0, 20.0, 40.0)]
    assert means == pytest.approx([0.59, 1.74, 2.0], abs=0.35)
    told = "{:.1f}, {:.1f} and {:.1f} degrees at 4, 20 and 40 degC".format(*means)
    assert told in " ".join((ROOT / "docs/machine.md").read_text(encoding="utf-8").split())


def alike(excess, law, single, each):
    return excess_phase._Alike(excess, law, single, np.array(each))


def test_what_lies_outside_the_band_is_one_unknown_of_all_specimens():
    """Two sets of frequencies, of two specimens and of one: their own chance is independent, the law is not."""
    sets = [alike(0.02, 4e-6, 2e-6, [0.01, 0.03]), alike(0.05, 1e-6, 6e-6, [0.05])]
    weight = 1.0 / np.array([4e-6 + 3.0 * 1e-6, 1e-6 + 3.0 * 6e-6])
    share = weight / weight.sum()
    variance = (share @ [2e-3, 1e-3]) ** 2 + share**2 @ [3e-6, 18e-6]
    expected = share @ [0.02, 0.05], np.sqrt(variance)
    assert excess_phase._combined(sets, 3.0) == pytest.approx(expected)


def test_specimens_say_how_far_their_excesses_scatter():
    """The mean of a factor over its prior and what specimens say of it, by a sum over a finer grid."""
    temperature = np.array([0.0, 30.0, 40.0])
    each = [[0.01, 0.03, 0.02], [0.00, 0.06, 0.02], [0.05]]
    sets = [[alike(0.0, 0.0, 1e-4, one)] for one in each]
    node = np.linspace(-3.0, 3.0, 121)
    size, growth = (grid.ravel() for grid in np.meshgrid(0.7 * node, 1.0 + 0.7 * node, indexing="ij"))
    evidence = -0.5 * ((size / 0.7) ** 2 + ((growth - 1.0) / 0.7) ** 2)
    factors = [np.exp(2.0 * (size + growth * place)) for place in (-0.5, 0.25, 0.5)]
    for one, factor in zip(each, factors, strict=True):
        squares = np.var(one) * len(one) / 1e-4
        evidence -= 0.5 * ((len(one) - 1) * np.log(factor) + squares / factor)
    share = np.exp(evidence - evidence.max())
    expected = [share @ factor / share.sum() for factor in factors]
    assert excess_phase._wider(temperature, sets) == pytest.approx(expected, rel=0.02)
    flat = excess_phase._wider(np.array([20.0]), [sets[2]])  # one specimen of one isotherm says nothing
    assert flat == pytest.approx(np.exp(2.0 * 0.7**2), rel=0.05)  # of a prior to three deviations


@pytest.mark.parametrize(
    ("z", "shown"),
    [((0.0, 3.1), True), ((2.9, 2.9), False), ((3.1, -3.1), False), ((-3.1, 3.1), True), ((3.1, 0.0), True)],
)
def test_an_excess_speaks_unless_a_warmer_isotherm_turns_about(z, shown, monkeypatch):
    each = [excess_phase.ExcessPhase(10.0 * k, 0.01 * one, 0.01) for k, one in enumerate(z)]
    monkeypatch.setattr(excess_phase, "excess_phases", lambda *_: each)
    assert excess_phase.shows_excess(None, None) is shown
