"""What the ladder counts: misfit beyond scatter, the spread of estimates, frequencies of their own."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from test_joint import CAUSES, LAW, fit, table  # noqa: F401  fixtures

from asphalt_nscd.diagnosis.model import fit_beside, laboratory
from asphalt_nscd.diagnosis.model.joint import Candidate, Joint
from asphalt_nscd.diagnosis.search import ladder
from asphalt_nscd.diagnosis.search.ladder import Ladder, Rung

DRAWS = 500


def begin(joint, fitted):
    return fit_beside.begin(laboratory.alone(joint), fitted)


def redrawn(joint, fitted, seed, effect=0.0):
    """The law fitted, equal specimens, scatter drawn anew and an effect on ln E*; refitted."""
    random = np.random.default_rng(seed)
    within = joint.noise.within
    scatter = within[0] * random.standard_normal(within.shape[1]) + 1j * within[1] * random.standard_normal(
        within.shape[1]
    )
    observed = replace(joint.observed, modulus=joint.apparent(fitted.law, ())[0] * np.exp(scatter + effect))
    again = Joint(observed, joint.base, joint.noise)
    return again, again.fit(fitted.law, fitted.scales)


def test_estimates_spread_is_that_of_causes_without_a_name():
    offset, delay, bias = (CAUSES[name] for name in ("phase_offset", "channel_delay", "temperature_bias"))
    named = Rung(Candidate(delay, None, (1e-4,)), 0.001, None, None, (), 0.99)
    estimates = {
        (delay.name, None): (9.0, 1.0),  # named: not counted
        (offset.name, None): (3.0, 2.0),
        (bias.name, 0.0): (2.0, 1.0),
        (bias.name, 20.0): (0.0, 1.0),
        ("moving_mass", None): (5.0, np.inf),  # not seen
        ("guide_friction", None): (-12.0, 1.0),  # friction that gives power
    }
    found = Ladder(None, None, rungs=[named], estimates=estimates)
    assert found.estimates_spread == pytest.approx(np.sqrt((1.5**2 + (2.0**2 + 0.0) / 2) / 2))
    assert Ladder(None, None, estimates={(offset.name, None): (0.1, 1.0)}).estimates_spread == 1.0
    assert Ladder(None, None).estimates_spread == 1.0


def test_the_name_that_is_least_sure_is_the_one_whose_interval_holds_zero_by_most(fit):  # noqa: F811
    joint, fitted = fit
    offset, delay = (
        Candidate(CAUSES[n], None, (v,)) for n, v in (("phase_offset", 1.0), ("channel_delay", 1e-4))
    )
    both = joint.linearise(fitted.law, fitted.scales, (offset, delay))
    rungs = [Rung(one, 0.001, None, both, (), 0.99) for one in (offset, delay)]

    def unsure(of_offset, of_delay, spread=0.0):
        sizes = {
            offset.key: (1.0, of_offset),
            delay.key: (1e-4, of_delay),
            ("moving_mass", None): (spread, 1.0),
        }
        return Ladder(joint, fitted, rungs=rungs, estimates=sizes).unsure

    assert unsure(0.45, 0.45e-4) is None
    assert unsure(0.55, 0.45e-4) == offset and unsure(0.55, 0.60e-4) == delay
    assert (
        unsure(0.45, 0.40e-4, spread=3.0) == offset
    )  # the estimates of this table spread three times as far


def test_specimens_with_frequencies_of_their_own_are_noticed_and_scatter_is_not(fit):  # noqa: F811
    joint, fitted = fit
    empty = [one.p_value for seed in range(40) for one in ladder._interactions(*redrawn(joint, fitted, seed))]
    assert len(empty) == 80 and np.mean(np.array(empty) < 0.1) < 0.15 and np.median(empty) > 0.3
    table_ = joint.observed
    pattern = np.where(
        table_.specimen == 1, (-1.0) ** np.searchsorted(table_.frequencies, table_.frequency), 0.0
    )
    for unit, part in ((0.02, "modulus"), (0.008j, "phase")):
        found = {
            one.pattern.split(", ")[1]: one
            for one in ladder._interactions(*redrawn(joint, fitted, 1, unit * pattern))
        }
        assert found[part].p_value < 1e-6 and found[part].gain > 30.0
        other = ({"modulus", "phase"} - {part}).pop()
        assert found[other].p_value > 1e-3


def test_a_ladder_climbs_to_what_was_put_in_and_no_further(fit):  # noqa: F811
    joint, fitted = fit
    catalogue = [CAUSES[name] for name in ("phase_offset", "channel_delay", "specimen_geometry")]
    base = redrawn(joint, fitted, 3)
    assert not ladder.climb(begin(*base), catalogue, DRAWS, 0).rungs
    late = 1j * joint.observed.omega * 3e-4
    found = ladder.climb(begin(*redrawn(joint, fitted, 3, late)), catalogue, DRAWS, 0)
    assert [rung.candidate.cause.name for rung in found.rungs] == ["channel_delay"]
    assert found.rungs[0].candidate.values[0] == pytest.approx(3e-4, abs=3e-5)
    assert found.rungs[0].p_value < 0.005
    assert found.rungs[0].probability > 0.99
