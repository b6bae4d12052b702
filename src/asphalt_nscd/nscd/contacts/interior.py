"""Primal-dual interior path to the reactions, for problems on which sweeps stall.

With r = T x, T_a = k_a diag(1, mu, mu), and y_a = k_a (u_n + mu |u_T|, mu u_T) both cones become the
second-order cone of R^3, and the problem reads

    y = T (W T x + q) + |y_T| n,    x . y = 0,    x and y in the cone.

Steps of Mehrotra's kind follow x ∘ y = m e to m = 0 in Nesterov and Todd's scaling (as in Vandenberghe's
notes on CVXOPT). |y_T| makes the problem nonconvex: a share of its derivative enters the linear
system, all of it where steps are long, less where they get short.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial

import numpy as np
from scipy.sparse.linalg import SuperLU

from asphalt_nscd.nscd.contacts.problem import ContactProblem


def interior_path(problem: ContactProblem, start: float, balance: float) -> Iterator[np.ndarray]:
    """Yield reactions (3 c,) [N s] along an interior path, which ends only where rounding leaves no direction.

    `start` is the size of the first x and y, that of q being one (large: far inside the cones). Steps aim at no less
    than the share `balance` |residual| / gap of the gap x . y, for residual and gap to vanish together.
    """
    mu, contacts = problem.friction, problem.friction.size
    diagonal = problem.matrix.diagonal().reshape(-1, 3)
    own = diagonal[:, 0] + mu**2 * (diagonal[:, 1] + diagonal[:, 2])
    # each contact has the scale of its own diagonal, so that bodies whose masses differ by orders do not
    # spoil the condition
    k = np.sqrt(3.0 / np.where(own > 0.0, own, 3.0 / problem.length))
    transform = (k[:, None] * np.column_stack([np.ones(contacts), mu, mu])).ravel()
    each = transform.reshape(-1, 3)
    w = each[problem.row][:, :, None] * problem.block * each[problem.other][:, None, :]
    q = transform * problem.free_velocity
    # the path is that of q of norm one: `start` then means the same for every problem
    unit = np.linalg.norm(q)
    q = q / unit
    e = np.zeros((contacts, 3))
    e[:, 0] = 1.0
    # x and y start on the axes of their cones, as far inside as they can be, and equal: their scaling is then
    # one
    x = start / np.sqrt(contacts) * e
    y = x.copy()
    share = 1.0
    while min(_determinant(x).min(), _determinant(y).min()) > 0.0:
        slip = np.hypot(y[:, 1], y[:, 2])
        residual = (transform * (problem.matrix @ (transform * x.ravel())) + q).reshape(-1, 3) - y
        residual[:, 0] += slip
        gap = (x * y).sum()
        scaling = _scaling(y, x)
        centre = _times(scaling, x)
        squared = scaling @ scaling
        # |y_T| is what makes the problem nonconvex: of its derivative only this share enters the linear
        # system
        keep = np.tile(np.eye(3), (contacts, 1, 1))
        keep[:, 0, 1:] -= share * y[:, 1:] / np.where(slip > 0.0, slip, 1.0)[:, None]
        jacobian = w.copy()
        jacobian[problem.own] += keep @ squared
        factor = problem.factor(jacobian)
        if factor is None:
            return

        direction = partial(_direction, factor, scaling, squared, keep, centre, residual)
        dx, dy = direction(-_product(centre, centre))
        reach = min(1.0, _reach(x, dx), _reach(y, dy))
        # Mehrotra's heuristic: the more of the gap the predictor would close, the less centring is needed.
        # His power is three; two centres more
        left = ((x + reach * dx) * (y + reach * dy)).sum() / gap
        sigma = min(1.0, max(left, 0.0)) ** 2
        # a gap that vanished before the residual would leave the iterate at the border of the cones, where
        # steps are short
        sigma = max(sigma, min(1.0, balance * np.linalg.norm(residual) / gap))
        second_order = _product(np.linalg.solve(scaling, dy[:, :, None])[:, :, 0], _times(scaling, dx))
        dx, dy = direction(sigma * gap / contacts * e - _product(centre, centre) - second_order)
        # not quite to the border, where the scaling would be singular
        reach = min(1.0, 0.99 * min(_reach(x, dx), _reach(y, dy)))
        x, y = x + reach * dx, y + reach * dy
        if not (np.isfinite(x).all() and np.isfinite(y).all()):
            return
        # short steps say that the linearised |y_T| misleads; long ones that it may count in full again
        share = max(0.6 * share, 0.1) if reach < 0.3 else 1.0 - 0.6 * (1.0 - share)
        yield unit * transform * x.ravel()


def _direction(
    factor: SuperLU,
    scaling: np.ndarray,
    squared: np.ndarray,
    keep: np.ndarray,
    centre: np.ndarray,
    residual: np.ndarray,
    aim: np.ndarray,
) -> tuple[np.ndarray, np.ndarray]:
    """Changes of x and y that cancel the residual and make the change of x ∘ y, scaled, equal `aim`."""
    h = _times(scaling, _divide(centre, aim))
    dx = factor.solve((_times(keep, h) - residual).ravel(), "T").reshape(-1, 3)
    return dx, h - _times(squared, dx)


def _determinant(x: np.ndarray) -> np.ndarray:
    tangential = np.hypot(x[:, 1], x[:, 2])
    # as a product: the difference of squares would cancel near the border of the cone
    return (x[:, 0] - tangential) * (x[:, 0] + tangential)


def _times(matrices: np.ndarray, x: np.ndarray) -> np.ndarray:
    return np.einsum("aij,aj->ai", matrices, x)


def _product(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Jordan product x ∘ y."""
    return np.column_stack([(x * y).sum(axis=1), x[:, :1] * y[:, 1:] + y[:, :1] * x[:, 1:]])


def _divide(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """The z with x ∘ z = y."""
    first = (x[:, 0] * y[:, 0] - (x[:, 1:] * y[:, 1:]).sum(axis=1)) / _determinant(x)
    return np.column_stack([first, (y[:, 1:] - first[:, None] * x[:, 1:]) / x[:, :1]])


def _scaling(y: np.ndarray, x: np.ndarray) -> np.ndarray:
    """Symmetric matrices S (c, 3, 3) with S x = S^-1 y."""
    sy, sx = np.sqrt(_determinant(y)), np.sqrt(_determinant(x))
    y, x = y / sy[:, None], x / sx[:, None]
    half = np.sqrt(2.0 * (1.0 + (x * y).sum(axis=1)))
    v = (y + x * [1.0, -1.0, -1.0]) / half[:, None]
    s = np.empty((len(x), 3, 3))
    s[:, 0, :] = v
    s[:, 1:, 0] = v[:, 1:]
    s[:, 1:, 1:] = np.eye(2) + v[:, 1:, None] * v[:, None, 1:] / (1.0 + v[:, 0])[:, None, None]
    return np.sqrt(sy / sx)[:, None, None] * s


def _reach(x: np.ndarray, dx: np.ndarray) -> float:
    """Largest t for which all x + t dx are in the cone."""
    # the determinant along the step is the quadratic a t^2 + 2 b t + c; its roots by the stable form, without
    # cancellation
    a = _determinant_difference(dx, dx)
    b = _determinant_difference(x, dx)
    c = _determinant(x)
    with np.errstate(all="ignore"):
        root = np.sqrt(b * b - a * c)
        q = -(b + np.copysign(root, b))
        candidates = np.concatenate([q / a, c / q, -x[:, 0] / dx[:, 0]])
    # no root, NaN, is no border: it fails this question too
    candidates = candidates[candidates > 0.0]
    return candidates.min(initial=np.inf)


def _determinant_difference(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    return x[:, 0] * y[:, 0] - x[:, 1] * y[:, 1] - x[:, 2] * y[:, 2]
