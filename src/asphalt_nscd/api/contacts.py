"""Contacts with friction, in whatever order the components of each contact stand."""

from __future__ import annotations

import warnings
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from scipy import sparse

from asphalt_nscd.api.arguments import checked
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.nscd.contacts.friction import ContactSolution
from asphalt_nscd.nscd.contacts.friction import solve_contacts as solve_normal_first

ASYMMETRY = 1e-6  # of the largest entry: rounding of what was assembled
ORDERS = {"nts": (0, 1, 2), "tns": (1, 0, 2), "tsn": (2, 0, 1)}  # where n, t, s stand in what is given


@checked
def solve_contacts(
    W: Any, q: ArrayLike, mu: ArrayLike, *, order: str = "nts", tolerance: float = 1e-8
) -> ContactSolution:
    """Reactions r with u = W r + q: Signorini's condition along the normals, Coulomb friction across them.

    Parameters
    ----------
    W : array or sparse matrix
        Delassus operator (3 c, 3 c) [1/kg], positive semidefinite.
    q : array_like
        Free velocities (3 c,) or (c, 3) [m/s], positive opening.
    mu : float or array_like
        Friction, one for all or (c,).
    order : str
        How the normal n and the tangents t, s of each contact stand: "nts" (here, in Siconos and FCLIB), "tns" (LMGC90)
        or "tsn" (normal last).
    tolerance : float
        Largest error of the natural map, relative to the whole of what W couples.

    Returns
    -------
    ContactSolution
        Reactions [N s] and velocities [m/s] in the order of q. Look at `converged`, or call `require_converged()`.

    Raises
    ------
    InputError
        With one sentence, for shapes that do not fit, or a W that is no Delassus operator.

    Warns
    -----
    UserWarning
        Where q looks like another order than stated: that is another problem.

    Examples
    --------
    >>> W, q = np.eye(3) / 2.0, [-9.81e-3, 2e-3, 0.0]  # a body of 2 kg, after 1 ms of gravity, slides at 2 mm/s
    >>> solve_contacts(W, q, mu=0.5).require_converged().reactions.round(12).tolist()
    [0.01962, -0.004, 0.0]
    >>> solve_contacts(W, [2e-3, 0.0, -9.81e-3], mu=0.5, order="tsn").reactions.round(12).tolist()
    [-0.004, 0.0, 0.01962]
    """
    if order not in ORDERS:
        raise InputError(f"order {order!r} is not known; give one of {', '.join(ORDERS)}.")
    try:
        free = np.asarray(q, float).ravel()
    except (TypeError, ValueError):
        raise InputError("q: not numbers; give three velocities [m/s] for each contact.") from None
    if free.size % 3:
        raise InputError(f"q holds {free.size} numbers; give three for each contact.")
    _require_symmetric(W)
    place = (3 * np.arange(free.size // 3)[:, None] + ORDERS[order]).ravel()
    _doubt(free, order)
    try:
        if order == "nts" or np.shape(W) != (free.size, free.size):  # which is refused there
            return solve_normal_first(W, free, mu, tolerance)
        matrix = (
            # Not every format of scipy can be indexed; this one can.
            sparse.csr_array(W)[place][:, place]
            if sparse.issparse(W)
            else np.asarray(W)[np.ix_(place, place)]
        )
        solved = solve_normal_first(matrix, free[place], mu, tolerance)
    except (TypeError, ValueError) as error:
        raise InputError(f"contacts: {error}.") from None
    # The order that undoes a permutation.
    back = np.argsort(place)
    return replace(solved, reactions=solved.reactions[back], velocities=solved.velocities[back])


def _require_symmetric(W: Any) -> None:
    """Refuse what is no Delassus operator: it is symmetric, and no contact pulls itself."""
    if not (sparse.issparse(W) or isinstance(W, np.ndarray)) or W.ndim != 2 or W.shape[0] != W.shape[1]:
        return  # refused further on
    largest = abs(W).max() if W.shape[0] else 0.0
    if largest and abs(W - W.T).max() > ASYMMETRY * largest:
        raise InputError("W: not symmetric; give H^T M^-1 H, in which action equals reaction.")
    if (W.diagonal() < 0.0).any():
        raise InputError("W: negative on its diagonal; give H^T M^-1 H, which is positive semidefinite.")


def _doubt(free: np.ndarray, order: str) -> None:
    """Warn where nothing closes along the stated normals while everything closes along another component."""
    if not free.size:
        return
    each = free.reshape(-1, 3)
    if (each[:, ORDERS[order][0]] < 0.0).any():
        return
    for other, (normal, *_) in ORDERS.items():
        if other != order and (each[:, normal] < 0.0).all():
            warnings.warn(
                f"q: no contact closes along the normals of order {order!r}, and all would in order {other!r}; check "
                "the order. Reactions are zero as it stands.",
                # Past this function and `checked`, to the user's own line.
                stacklevel=4,
            )
            return
