"""What a table cannot decide is weighed: probabilities add up, and each explanation has the law that goes with it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from test_not_linear import NCAT

from asphalt_nscd.api.tables import campaign_in
from asphalt_nscd.diagnosis.observed.reading import PAPER_GEOMETRY, read_observations
from asphalt_nscd.diagnosis.search.diagnose import Diagnosis, diagnose

pytestmark = pytest.mark.slow


def measured(state: str) -> Diagnosis:
    path = Path(NCAT) / f"{state}.csv"
    observed, _ = read_observations(campaign_in(path, measured_in="tension-compression"), PAPER_GEOMETRY)
    return diagnose(observed, draws=500)


def test_what_is_open_has_a_law_for_each_explanation():
    found = measured("N1-1_RH")
    told = found.hypotheses
    (rung,) = found.ladder.rungs
    assert sum(one.probability for one in told) == pytest.approx(1.0)
    alone = [[cause.cause.name for cause in one.causes] for one in told]
    named = [rung.candidate.cause.name, *(rival.cause.name for rival in rung.rivals)]
    assert sorted(name for names in alone for name in names) == sorted(named) and [] in alone
    # A rival has what the search gave it, scaled as the name was: not an even part of what is left.
    weight = {names[0]: one.probability for one, names in zip(told, alone, strict=True) if names}
    for rival, share in zip(rung.rivals, rung.shares, strict=True):
        expected = share * found.probability(rung) / rung.probability
        assert weight[rival.cause.name] == pytest.approx(expected, rel=1e-9)
    assert found.share(rung) == pytest.approx(found.probability(rung))
    assert [one.probability for one in told] == sorted((one.probability for one in told), reverse=True)
    # Without an offset or a softening the law itself has the phases that were read.
    observed = found.observed
    phases = [
        np.angle(one.joint.apparent(one.fitted.law, ())[0])[
            observed.isotherm == observed.isotherms[-1]
        ].mean()
        for one in told
    ]
    assert max(phases) == phases[alone.index([])] > min(phases) + np.radians(0.3)
