"""What the steps of the reduced model work on, and why they end."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

DONE, OUTSIDE_ENVELOPE, YIELD, CLOSED_GAP, RESIDUAL = range(5)  # why steps ended


class ReducedRun(NamedTuple):
    """Model, state and results of some steps: n steps, k coordinates, m variables of the law, c bonds.

    Of matrices the columns, as rows (`columns`), so that a product adds whole columns to a sum.
    """

    driven: np.ndarray  # (n,) m, of the actuator
    devices: tuple[float, float, float, float]  # `HeadDevices.head_constants`
    impedance: float  # Z: the head takes the force Z v+ - a v - b explicit - c
    head_inertia: np.ndarray  # a (k,)
    head_strain: np.ndarray  # b (k,)
    head_load: float  # c, N
    mass: np.ndarray  # (k, k) columns
    stiffness: np.ndarray  # (k, k) columns
    load: np.ndarray  # (k,)
    inverse: np.ndarray  # (k - 1, k - 1) columns of the step matrix without the head
    dt: float  # s
    compliance: float  # of the law, as those that follow
    recall: np.ndarray  # (1 + m,)
    decay: np.ndarray  # (m,)
    gain: np.ndarray  # (m,)
    follow: np.ndarray  # (m,)
    residual_factor: np.ndarray  # 2 k + 1 columns of an upper triangle
    head_norm: float
    load_norm: float
    tolerance: float  # of the residual, relative
    reaction: np.ndarray  # (c, 3, k) of bonds watched for yield, over their strength
    beyond_head: np.ndarray  # (c, 2) of these, see `BondBounds.head_bounds`
    closing: np.ndarray  # (d, k) of d bonds watched for a closing gap, share of it
    sigma_envelope: np.ndarray  # (k,)
    motion_envelope: np.ndarray  # (k,)
    reached_sigma: np.ndarray  # (k,), written, as all that follow
    reached_motion: np.ndarray  # (k,)
    maxima: np.ndarray  # (3,) largest |s_0|, relative residual, utilisation
    q: np.ndarray  # (k,)
    v: np.ndarray  # (k,)
    s: np.ndarray  # (k,)
    memory: np.ndarray  # (m, k)
    trial: np.ndarray  # (3, k) v+, s+, q+ of the last step tried
    force: np.ndarray  # (n,) N
    velocity: np.ndarray  # (n, at most k): the first coordinates of v
    scratch: np.ndarray  # (5 k + r + 1,), r rows of the residual factor


FIELDS = len(ReducedRun._fields)
