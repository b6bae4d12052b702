"""When a bond breaks: tension or the tangential force reaches its strength. All solvers take the measure from here.

A reaction has a normal part, negative in tension, and two tangential parts. Another criterion changes these
functions alone, as long as `bound` is no less than `utilisation` and is homogeneous and convex: the reduced model adds
the bounds of its coordinates.
"""

from __future__ import annotations

import numpy as np

from asphalt_nscd.nscd.compiled import compiled


def utilisations(reaction: np.ndarray, strength: np.ndarray) -> np.ndarray:
    """How far reactions use up the strength of bonds.

    Parameters
    ----------
    reaction : ndarray (b, 3) or (3 b,)
        [N], tension negative.
    strength : ndarray (b,)
        [N].

    Returns
    -------
    ndarray
        (b,) Above one a bond breaks.
    """
    reaction = reaction.reshape(-1, 3)
    shear = np.hypot(reaction[:, 1], reaction[:, 2])
    # a bond under pressure breaks by shear alone
    return np.maximum(-reaction[:, 0], shear) / strength


@compiled
def utilisation(normal, tangent, other):
    """How far one bond is used up.

    Parameters
    ----------
    normal, tangent, other : float
        Its reaction over its strength, tension negative.

    Returns
    -------
    float
        Above one it breaks.
    """
    return max(-normal, np.sqrt(tangent * tangent + other * other))


@compiled
def bound(normal, tangent, other):
    """What `utilisation` does not exceed, whatever the signs.

    Parameters
    ----------
    normal, tangent, other : float
        A reaction over its strength.

    Returns
    -------
    float
        Norm of the three.
    """
    return np.sqrt(normal**2 + tangent**2 + other**2)
