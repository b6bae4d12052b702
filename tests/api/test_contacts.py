"""Contacts from Python: components in any order that is stated, and a warning where it is not the stated one."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import sparse

import asphalt_nscd as an

ORDERS = {"nts": [0, 1, 2], "tns": [1, 0, 2], "tsn": [1, 2, 0]}  # which of n, t, s stands at each place


@pytest.fixture(scope="module")
def problem():
    rng = np.random.default_rng(3)
    root = rng.normal(size=(12, 14))
    q = rng.normal(size=12)
    q[::3] = -np.abs(q[::3])
    return root @ root.T, q


@pytest.mark.parametrize("order", ORDERS)
@pytest.mark.parametrize("storage", [np.asarray, sparse.csr_array, sparse.coo_matrix])
def test_the_order_of_components_changes_nothing_but_the_order(problem, order, storage):
    W, q = problem
    usual = an.solve_contacts(W, q, 0.4).require_converged()
    place = (3 * np.arange(4)[:, None] + ORDERS[order]).ravel()
    given = an.solve_contacts(storage(W[np.ix_(place, place)]), q[place], 0.4, order=order)
    assert np.allclose(given.reactions, usual.reactions[place], atol=1e-7)
    assert np.allclose(given.velocities, usual.velocities[place], atol=1e-7)


def test_normal_last_input_taken_for_normal_first_is_doubted():
    fallen = [0.1, 0.0, -1.0]
    with pytest.warns(UserWarning, match="all would in order 'tsn'"):
        solution = an.solve_contacts(np.eye(3), fallen, 0.5)
    assert not solution.reactions.any()
    assert an.solve_contacts(np.eye(3), fallen, 0.5, order="tsn").reactions[2] == pytest.approx(1.0)


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        ((np.eye(3), [1.0, 2.0], 0.5), "three for each contact"),
        ((np.eye(6), [-1.0, 0.0, 0.0], 0.5), "not of three rows for each contact"),
        ((np.eye(3), [-1.0, np.nan, 0.0], 0.5), "must be finite"),
        ((np.eye(3), [-1.0, 0.0, 0.0], -0.5), "must not be negative"),
        ((np.eye(3) + np.eye(3, k=1), [-1.0, 0.0, 0.0], 0.5), "W: not symmetric"),
        ((sparse.csr_array(-np.eye(3)), [-1.0, 0.0, 0.0], 0.5), "W: negative on its diagonal"),
    ],
)
@pytest.mark.parametrize("order", ["nts", "tsn"])
def test_what_is_no_problem_is_refused(arguments, sentence, order):
    with pytest.raises(an.InputError, match=sentence):
        an.solve_contacts(*arguments, order=order)


@pytest.mark.parametrize("scale", [1e-3, 1e3])
def test_rounding_of_what_was_assembled_is_no_asymmetry(scale):
    """Up to a millionth of the largest entry."""
    for share, taken in ((0.9e-6, True), (1.1e-6, False)):
        W = scale * np.eye(3)
        W[0, 1] = share * scale
        if taken:
            assert an.solve_contacts(W, [-1.0, 0.0, 0.0], 0.5).reactions[0] == pytest.approx(1.0 / scale)
        else:
            with pytest.raises(an.InputError, match="W: not symmetric"):
                an.solve_contacts(W, [-1.0, 0.0, 0.0], 0.5)


def test_an_order_that_is_none():
    with pytest.raises(an.InputError, match="give one of nts, tns, tsn"):
        an.solve_contacts(np.eye(3), [-1.0, 0.0, 0.0], 0.5, order="xyz")
