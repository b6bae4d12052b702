"""The operator of implicit steps, from which bonds are removed."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from asphalt_nscd.nscd.bonds import implicit_operator
from asphalt_nscd.nscd.bonds.implicit_operator import ShiftedOperator


@pytest.mark.parametrize(("unknowns", "way"), [(150_000, "factors"), (150_001, "multigrid")])
def test_what_factors_would_not_fit_goes_by_multigrid(beam_system, monkeypatch, unknowns, way):
    """And factors for a system without places."""
    monkeypatch.setattr(implicit_operator, "factors", lambda matrix: "factors")
    monkeypatch.setattr(
        implicit_operator, "Multigrid", lambda matrix, modes: "multigrid" if modes.shape[1] == 6 else ""
    )
    matrix = SimpleNamespace(shape=(unknowns, unknowns))
    assert implicit_operator.factorise(matrix, beam_system) == way
    assert implicit_operator.factorise(matrix, replace(beam_system, position=None)) == "factors"


def test_each_61st_bond_that_breaks_calls_for_new_factors(beam_system, monkeypatch):
    made, factorise = [], implicit_operator.factorise
    monkeypatch.setattr(
        implicit_operator, "factorise", lambda *given: made.append(given) or factorise(*given)
    )
    operator = ShiftedOperator(beam_system, 1e-14)
    for count, factors in ((60, 1), (61, 2), (121, 2), (122, 3)):
        operator.remove(list(range(count)))
        assert len(made) == factors


@pytest.mark.parametrize("together", [2, 7])
def test_removal_of_bonds_depends_on_their_list_alone(beam_system, together, monkeypatch):
    """Removed one by one, or some at a time, with factorisations in between."""
    monkeypatch.setattr(ShiftedOperator, "most_updates", 3)
    broken = [5, 17, 3, 40, 22, 8, 31, 12, 60, 2]
    one, some = (ShiftedOperator(beam_system, 1e-14) for _ in range(2))
    for count in range(1, len(broken) + 1):
        one.remove(broken[:count])
        if count % together == 0 or count == len(broken):
            some.remove(broken[:count])
    force = np.random.default_rng(0).normal(size=beam_system.free.size)
    assert one.solve(force).tobytes() == some.solve(force).tobytes()
    dense = beam_system.stiffness(one.weight).toarray()[np.ix_(beam_system.free, beam_system.free)]
    exact = np.linalg.solve(np.diag(beam_system.mass[beam_system.free]) + 1e-14 * dense, force)
    np.testing.assert_allclose(one.solve(force), exact, rtol=1e-8)
