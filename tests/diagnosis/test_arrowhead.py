"""A factor made isotherm by isotherm against that of the whole matrix."""

from __future__ import annotations

import numpy as np
import pytest

from asphalt_nscd.diagnosis.model.arrowhead import Arrowhead, Factor

GROUPS = {
    "two isotherms, and what both share": [0, 1, -1, 0, 0, 1, -1, 1],
    "one, of several columns": [-1, 0, 0, 0, -1, -1, -1, -1],
    "nothing alone": [-1] * 8,
    "nothing shared but the law": [1, 0, 1, 2, 2, 0, 1, 1],
}


def columns(random, group: np.ndarray) -> np.ndarray:
    """Columns (60, q) of which those of each group reach rows of their own alone."""
    isotherm = np.repeat(np.arange(3), 20)
    return random.standard_normal((60, group.size)) * ((group < 0) | (isotherm[:, None] == group))


@pytest.mark.parametrize("name", GROUPS)
def test_a_factor_by_isotherms_is_that_of_the_whole(name):
    random, group = np.random.default_rng(4), np.array(GROUPS[name])
    u, j = columns(random, group), random.standard_normal((60, 3))
    precision = j.T @ j + np.diag([0.1, 2.0, 5.0])
    followed = np.linalg.solve(np.linalg.cholesky(precision), j.T @ u)
    gram = u.T @ u - u.T @ j @ np.linalg.solve(precision, j.T @ u)
    s = np.geomspace(1e-2, 30.0, group.size)[::-1]
    factor = Factor(Arrowhead(u.T @ u, followed, group), s)
    whole = np.eye(group.size) + s[:, None] * gram * s
    inverse, right = np.linalg.inv(whole), random.standard_normal((group.size, 2))
    assert not factor.failed
    assert factor.log_determinant == pytest.approx(np.linalg.slogdet(whole)[1], rel=1e-11)
    assert factor.solve(right) == pytest.approx(inverse @ right, rel=1e-9, abs=1e-12)
    half = factor.halve(right)
    assert half.T @ half == pytest.approx(right.T @ inverse @ right, rel=1e-9)
    left = (np.eye(group.size) - inverse) / s[:, None] / s
    assert factor.left == pytest.approx(left, rel=1e-9, abs=1e-12)
    assert factor.diagonal == pytest.approx(np.diag(left), rel=1e-9)


@pytest.mark.parametrize("group", [[0, 0], [-1, -1]])
def test_what_is_not_positive_has_no_factor(group):
    gram = np.array([[1.0, 3.0], [3.0, 1.0]])
    assert Factor(Arrowhead(gram, np.zeros((1, 2)), np.array(group)), np.array([2.0, 2.0])).failed
