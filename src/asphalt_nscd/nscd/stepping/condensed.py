"""Full time stepping with the bonds condensed: one symmetric positive definite system per step.

Putting sigma+ = (b - G v+)/S into the equations of motion gives

    (M + dt G^T w/S G) v+ = M v- + dt f + dt G^T w/S b

whose matrix is constant while no bond breaks. Where a gap closes, of a broken bond or a sound one, there is a
frictional contact; contacts are solved on their Delassus operator.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from asphalt_nscd.nscd.bonds.head import RIGID, HeadDevices
from asphalt_nscd.nscd.bonds.head_kernels import actuator_force, follow_actuator
from asphalt_nscd.nscd.bonds.implicit_operator import ShiftedOperator
from asphalt_nscd.nscd.bonds.law import AnyLaw
from asphalt_nscd.nscd.bonds.system import BondedSystem
from asphalt_nscd.nscd.contacts.friction import solve_contacts

CLOSED = 1e-12  # m, by which a gap in contact may differ from zero


@dataclass
class CondensedState:
    """Motion and bond history at one instant; all zero at rest.

    `displacement` (d,) in m or rad, `velocity` (d,) in m/s or rad/s, `sigma` (3 b,) in N/m, `memory` (m, 3 b) is that
    of the law; `broken` lists bonds in the order in which they broke.
    """

    displacement: np.ndarray
    velocity: np.ndarray
    sigma: np.ndarray
    memory: np.ndarray
    broken: list[int] = field(default_factory=list)

    @classmethod
    def rest_state(cls, system: BondedSystem, law: AnyLaw) -> CondensedState:
        """State of no motion and no stress, with the memory of the law."""
        d, rows = system.mass.size, system.weight.size
        return cls(np.zeros(d), np.zeros(d), np.zeros(rows), np.zeros((law.memory, rows)))


class CondensedStepper:
    """Steps the full system at constant dt [s] and law, breaks bonds and meets contacts; `state` is changed.

    Of the last step: `missing` (d,) [N, N m], what the equations of motion lack (the driving force where the motion is
    driven, else rounding); `utilisation`, the largest of a bond; `contact`, (reactions [N], openings [m/s]) (3 c,) of
    gaps that closed, or None. `on_break` is called with the broken bonds when one more breaks, `on_contact` with gaps
    that close before their reactions are found; an error in one ends the step. `actuator` is in m, at `state`.
    """

    def __init__(
        self,
        system: BondedSystem,
        law: AnyLaw,
        dt: float,
        state: CondensedState,
        devices: HeadDevices = RIGID,
        actuator: float = 0.0,
    ) -> None:
        self.system, self.step_law, self.dt, self.state = system, law.step(dt), dt, state
        self.devices, self.actuator = devices, actuator
        # solved, not swept: sweeps that stop at a change of 1e-4 or 1e-5 give 0.3 to 7.6 % of |E*| (Fig. 6)
        self._operator = ShiftedOperator(system, dt / self.step_law.compliance)
        self._operator.remove(state.broken)
        self._loose = np.empty(0)  # velocity (d,) without contacts, of a rigid clamp
        # what is kept until one more bond breaks, and how many had broken; -1: nothing yet
        self._following = np.empty(0), -1
        self._responses: tuple[dict[int, np.ndarray], int] = {}, -1
        self.on_break: Callable[[list[int]], None] = lambda broken: None
        self.on_contact: Callable[[list[int]], None] = lambda touching: None

    @property
    def weight(self) -> np.ndarray:
        """w (3 b,) [m] of the bonds, zero for the broken ones."""
        return self._operator.weight

    def move(self, start: float, end: float) -> float:
        """Force of the actuator [N] in one step, in which it moves from `start` to `end` [m]."""
        self.actuator = start
        force = self.advance((end - start) / self.dt)
        self.actuator = end
        return force

    def advance(self, driven_velocity: float) -> float:
        """Force of the actuator [N] in a step at its velocity [m/s]; the head moves with it if the clamp is rigid.

        Bonds that yield break one after another, the most overstressed first, and the step is solved again until none
        is left.
        """
        system, state, dt, law = self.system, self.state, self.dt, self.step_law
        explicit = law.explicit_part(state.sigma, state.memory)
        velocity, contact_force, friction = self._solve(explicit, driven_velocity)
        exact = True
        while True:
            # NaN is not <= 1 either: the step would break bond after bond
            if not np.isfinite(velocity).all():
                raise ArithmeticError("the motion of a step is not finite")
            sigma, memory = law.update(explicit, system.operator @ velocity, state.memory)
            utilisation = system.utilisation(self._operator.weight * sigma)
            worst = int(np.argmax(utilisation))
            if utilisation[worst] <= 1.0 and exact:
                break
            # with a clamp a break changes the velocity of the head too: no short way
            exact = utilisation[worst] <= 1.0 or self.devices.clamp_compliance > 0.0
            if utilisation[worst] > 1.0:
                state.broken.append(worst)
                self.on_break(state.broken)
                self._operator.remove(state.broken)
            if exact:
                velocity, contact_force, friction = self._solve(explicit, driven_velocity)
            else:
                velocity, contact_force = self._let_go(worst, explicit)
        inertia = system.mass * (velocity - state.velocity) / dt
        reaction = system.operator.T @ (self._operator.weight * sigma)
        self.missing = inertia - system.load - reaction - contact_force
        self.utilisation = float(utilisation[worst])
        head = system.driven
        force = actuator_force(
            self.devices.head_constants,
            dt,
            self.missing[head],
            friction,
            state.displacement[head],
            state.velocity[head],
            velocity[head],
        )
        self.actuator += dt * driven_velocity
        state.displacement = state.displacement + dt * velocity
        state.velocity, state.sigma, state.memory = velocity, sigma, memory
        return float(force)

    def _solve(self, explicit: np.ndarray, driven_velocity: float) -> tuple[np.ndarray, np.ndarray, float]:
        """(velocity, contact forces, force of the slider) of the coming step while no bond breaks."""
        system, state, dt = self.system, self.state, self.dt
        impulse = system.mass * state.velocity + dt * system.load
        impulse += self._impulse_of(explicit)
        if self.devices.clamp_compliance == 0.0:
            slider = self.devices.guide_friction * float(np.sign(driven_velocity))
            return *self._move(impulse, driven_velocity), slider
        return self._move_by_clamp(impulse, driven_velocity)

    def _let_go(self, bond: int, explicit: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """(velocity, contact forces) once a bond has broken, from those before: its impulse is gone.

        It saves two solves of a break, of which a step may have hundreds; the step ends with an exact solution.
        """
        system, rows = self.system, 3 * bond + np.arange(3)
        scale = np.broadcast_to(self.dt / self.step_law.compliance, system.weight.shape)[rows]
        opening = explicit[rows] - system.operator[rows] @ self._loose
        self._loose[system.free] -= self._operator.release(scale * system.weight[rows] * opening)
        return self._meet_contacts(self._loose)

    def _move(self, impulse: np.ndarray, head_velocity: float) -> tuple[np.ndarray, np.ndarray]:
        """(velocity, contact forces) under an impulse (d,) with the head moving at head_velocity."""
        self._loose = self._velocity(impulse - head_velocity * self._coupling(), head_velocity)
        return self._meet_contacts(self._loose)

    def _velocity(self, impulse: np.ndarray, head_velocity: float) -> np.ndarray:
        """Velocity (d,) under an impulse (d,), the head's being given, without contacts."""
        velocity = np.empty_like(impulse)
        velocity[self.system.driven] = head_velocity
        velocity[self.system.free] = self._operator.solve(impulse[self.system.free])
        return velocity

    def _coupling(self) -> np.ndarray:
        """Impulse (d,) that a unit velocity of the head alone takes by its bonds."""
        return self._impulse_of(self.system.operator[:, [self.system.driven]].toarray()[:, 0])

    def _impulse_of(self, opening: np.ndarray) -> np.ndarray:
        """Impulse (d,) by which bonds close that open at velocities (3 b,) [m/s]."""
        scale = self.dt / self.step_law.compliance
        return np.asarray(self.system.operator.T @ (scale * self._operator.weight * opening))

    def _follow_head(self) -> np.ndarray:
        """Velocities (d,) per unit velocity of the head, all else at rest before; kept until one more bond breaks."""
        following, broken = self._following
        if broken != len(self.state.broken):
            following = self._velocity(-self._coupling(), 1.0)
            self._following = following, len(self.state.broken)
        return following

    def _move_by_clamp(
        self, impulse: np.ndarray, driven_velocity: float
    ) -> tuple[np.ndarray, np.ndarray, float]:
        """As `_move`, with the head's velocity that of the balance in `head`; and the slider's force."""
        system, state, dt = self.system, self.state, self.dt
        head, following = system.driven, self._follow_head()
        impedance = (system.mass[head] + float(self._coupling() @ following)) / dt
        # affine in the velocity of the head: two solutions serve all the velocities that are tried below
        held = self._velocity(impulse, 0.0)

        def move(head_velocity: float) -> tuple[np.ndarray, np.ndarray]:
            return self._meet_contacts(held + head_velocity * following)

        def follow(contact_force: np.ndarray) -> tuple[float, float]:
            free_force = -float(following @ (impulse / dt + contact_force))
            return follow_actuator(
                self.devices.head_constants,
                dt,
                free_force,
                impedance,
                self.actuator + dt * driven_velocity,
                state.displacement[head],
                state.velocity[head],
            )

        def yields(head_velocity: float) -> float:
            """How much faster the head would go under the contact forces of this head velocity."""
            return follow(move(head_velocity)[1])[0] - head_velocity

        velocity, _ = follow(np.zeros_like(impulse))
        motion, contact_force = move(velocity)
        resisted, slider = follow(contact_force)
        excess = resisted - velocity
        # the head velocity is found where contacts and clamp agree; `yields` is monotone, so that a bracket
        # always holds it
        if excess:  # contacts resist motion, so the answer lies between
            from scipy.optimize import brentq  # takes as long to import as a test to run

            unresisted, velocity = velocity, velocity + excess
            if excess * yields(velocity) < 0.0:  # else the answer is that end, but for rounding
                velocity = brentq(yields, unresisted, velocity, xtol=1e-14 * abs(excess))
            velocity, slider = follow(move(velocity)[1])
            motion, contact_force = move(velocity)
        return motion, contact_force, slider

    def _meet_contacts(self, velocity: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Velocities [m/s], corrected by the impulses of gaps that would close within the step, and the force [N]."""
        system, dt = self.system, self.dt
        opening_rows = system.operator[::3]
        gap = system.gap + opening_rows @ self.state.displacement
        closing = np.flatnonzero(gap + dt * (opening_rows @ velocity) < 0.0)
        touching: list[int] = []
        force = np.zeros_like(velocity)
        corrected, self.contact = velocity, None
        # reactions move bodies, so that other gaps may close: the set only grows, so that this ends
        while not np.isin(closing, touching).all():
            touching = sorted({*touching, *closing.tolist()})
            self.on_contact(touching)
            rows = (3 * np.asarray(touching)[:, None] + np.arange(3)).ravel()
            opening = system.operator[rows]
            response = self._response(touching)
            delassus = opening[:, system.free] @ response
            free_velocity = opening @ velocity
            # an open gap may close within the step by so much; one that is closed already may not be pushed
            # open, which would add energy
            free_velocity[::3] += np.maximum(gap[touching], 0.0) / dt
            solution = solve_contacts(delassus, free_velocity, system.friction, tolerance=1e-12)
            impulse = solution.require_converged().reactions
            corrected = velocity.copy()
            corrected[system.free] += response @ impulse
            force = opening.T @ impulse / dt
            self.contact = impulse / dt, opening @ corrected
            closing = np.flatnonzero(gap + dt * (opening_rows @ corrected) < -CLOSED)
        return corrected, force

    def _response(self, bonds: list[int]) -> np.ndarray:
        """Velocities (f, 3 n) for unit impulses at these bonds; each is kept until one more breaks."""
        known, broken = self._responses
        if broken != len(self.state.broken):
            known, _ = self._responses = {}, len(self.state.broken)
        for bond in bonds:
            if bond not in known:  # each apart: its digits do not depend on what was asked with it
                rows = self.system.operator[3 * bond : 3 * bond + 3][:, self.system.free]
                known[bond] = self._operator.solve(rows.T.toarray())
        return np.hstack([known[bond] for bond in bonds])
