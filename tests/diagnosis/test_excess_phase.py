"""The excess of the phase, on mixes of a generator that shares nothing with the diagnosis, and on measured ones."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from attack.mixes import LAWS, SHIFTS, Mix

from asphalt_nscd.diagnosis.observed import scatter
from asphalt_nscd.diagnosis.observed.observations import Observations
from asphalt_nscd.diagnosis.observed.reading import PAPER_GEOMETRY, read_observations
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


def test_specimens_tested_at_other_frequencies_count_by_their_number():
    observed = drawn(1, np.radians(1.0))
    kept = (observed.specimen > 0) | (observed.frequency > 0.3)
    every, fewer = found(observed), found(observed.subset(kept))
    for one, other in zip(every, fewer, strict=True):
        assert other.excess == pytest.approx(one.excess, abs=np.radians(0.25))
        assert one.std_error < other.std_error < 1.5 * one.std_error


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
