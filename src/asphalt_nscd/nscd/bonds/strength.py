"""When a bond breaks: tension or the tangential force reaches its strength. All solvers take the measure from here.

A reaction has a normal part, negative in tension, and two tangential parts. Another criterion changes these
functions alone, as long as `bound` is no less than `utilisation` and is homogeneous and convex: the reduced model adds
the bounds of its coordinates.
"""

from __future__ import annotations

import numpy as np

from asphalt_nscd.nscd.compiled import compiled


def utilisations(reaction: np.ndarray, strength: np.ndarray) -> np.ndarray:
    """How far reactions [N], tension negative, use up the strength (b,) [N] of bonds: (b,), above one they break."""
    reaction = reaction.reshape(-1, 3)
    shear = np.hypot(reaction[:, 1], reaction[:, 2])
    # a bond under pressure breaks by shear alone
    return np.maximum(-reaction[:, 0], shear) / strength


@compiled
def utilisation(normal, tangent, other):
    """How far a bond is used up by its reaction over its strength (tension negative); above one it breaks."""
    return max(-normal, np.sqrt(tangent * tangent + other * other))


@compiled
def bound(normal, tangent, other):
    """Norm of a reaction over its strength, which `utilisation` does not exceed, whatever the signs."""
    return np.sqrt(normal**2 + tangent**2 + other**2)
