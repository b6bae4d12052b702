"""Force control: an actuator that commands a force on a specimen whose weight the machine has tared."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:  # sparse matrices, which take as long to import as most tests to run
    from asphalt_nscd.bending.model import Model

SOFTNESS = 1e7
"""Compliance of the clamp under force control, over that of the specimen: the force is as prescribed to the inverse."""


def tared(model: Model) -> Model:
    """The model without weight or directions for breaks, as a machine set to zero with the specimen in it shows it."""
    # directions kept ready hold the projection of a system with weight
    system = replace(model.system, load=np.zeros_like(model.system.load))
    return replace(model, system=system, stand_by=None)


def soft_clamp(model: Model, modulus: float) -> float:
    """Compliance [m/N] of a clamp so soft that the actuator commands the force; `modulus` of the specimen in Pa."""
    return SOFTNESS * model.geometry.form_factor() / modulus
