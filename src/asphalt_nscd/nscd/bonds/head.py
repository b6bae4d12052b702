"""Devices between the actuator and the head of a specimen, and between the head and the ground.

Seen from its head, a specimen is affine within an implicit step: the head velocity v+ takes the
force F0 + Z v+ (F0 from the history, Z [N s/m] its impedance). With a clamp of compliance C to the
actuator at z+, and a spring k, a Coulomb slider F_s and an extra mass m at the head, the balance

    F0 + Z v+ + m (v+ - v)/dt + k (x + dt v+) + r = (z+ - x - dt v+) / C,   r in F_s Sign(v+)

is one monotone inclusion in v+ with an explicit solution. Times C it holds for a rigid clamp too.
The specimen itself still has a driven head: nothing else about it changes. `head_kernels` solves the balance.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class HeadDevices:
    """Devices at the head of a specimen; if all are zero, the head is driven itself.

    `clamp_compliance` C [m/N] lies between actuator and head; `guide_stiffness` k [N/m] and the Coulomb slider of
    `guide_friction` F_s [N] between head and ground; `head_mass` m [kg] moves with the head.
    """

    clamp_compliance: float = 0.0
    guide_stiffness: float = 0.0
    guide_friction: float = 0.0
    head_mass: float = 0.0

    @property
    def head_constants(self) -> tuple[float, float, float, float]:
        """The devices (C, k, F_s, m) for the compiled functions."""
        return (
            float(self.clamp_compliance),
            float(self.guide_stiffness),
            float(self.guide_friction),
            float(self.head_mass),
        )


RIGID = HeadDevices()
