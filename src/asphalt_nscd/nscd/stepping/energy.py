"""Where the work of the actuator goes: an account that closes to rounding, step by step.

Each step satisfies, with the rates x' = (x+ - x*)/(dt/a) of its scheme (see `scheme`; implicit Euler:
a = 1, x* = x),

    M v' = f + G^T w sigma+ + r + e F,   q' = v+,   G v+ = -sigma'/E - sigma+/eta + sum kappa',
    -sigma+ = Ek kappa+ + eta_k kappa'   for each Kelvin element.

The first times dt v+, with the others put in for the work of the bonds, is exact in the discrete:

    dt F z' = dt v+ M v' + dt <sigma+, sigma'>/E + sum dt Ek <kappa+, kappa'> - dt f q'
            + dt <sigma+, sigma+>/eta + sum dt eta_k <kappa', kappa'> - dt r (G v+)

with <x, y> = x^T w y over the bonds that are left. A store of energy H = x^2/2 takes dt x+ x' = H+ - H + N,
and N, which is (x+ - x)^2/2 in implicit Euler, is the numerical dissipation of the scheme. A bond that breaks
releases what it stores at the beginning of the step. Devices at the head add stores and a slider.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any, NamedTuple

import numpy as np

from asphalt_nscd.nscd.bonds.law import AnyLaw, Form
from asphalt_nscd.nscd.stepping.scheme import History


@dataclass
class Energies:
    """All in J: stores at the present, the rest summed from the beginning.

    Stores: `kinetic`, `springs` of the bonds, `load` (its potential), `devices` (clamp, spring and mass at the head).
    Sums: work of the `actuator`, or what set a world in motion; dissipated in the `dashpots` of the bonds, by
    `friction` (tangential forces of contacts and the slider at the head), by `impact` (normal forces of contacts, where
    gaps close), and by the scheme (`numerical`); `fracture` is what bonds stored when they broke.
    """

    actuator: float = 0.0
    kinetic: float = 0.0
    springs: float = 0.0
    load: float = 0.0
    devices: float = 0.0
    dashpots: float = 0.0
    friction: float = 0.0
    impact: float = 0.0
    fracture: float = 0.0
    numerical: float = 0.0

    @property
    def error(self) -> float:
        """Work of the actuator less all the others [J]: rounding."""
        return 2.0 * self.actuator - sum(asdict(self).values())  # the sum holds it too

    def columns(self) -> dict[str, float]:
        """Values by the names that they have in result files; the error relative to the actuator's work."""
        named = {f"energy_{name}_J": float(value) for name, value in asdict(self).items()}
        relative = self.error / abs(self.actuator) if self.actuator else self.error
        return named | {"energy_error": float(relative)}


class EnergyAccount:
    """Keeps the energy account of one run; the stepper may be exchanged between steps."""

    def __init__(self, law: AnyLaw, by_force: bool = False) -> None:
        """by_force: the clamp is a means to command a force; the work is then that on the head."""
        self.law, self.sums, self._by_force = law, Energies(), by_force
        self._broken = 0

    def count(
        self, stepper: Any, dt: float, force: float, before: History, base: History, after: History
    ) -> None:
        """Add one step of `dt` [s] under the actuator's `force` [N].

        `before` and `after` are the states at its start and end, `base` is the state y* from which the scheme steps.
        """
        of = forms(stepper)
        # a two-step scheme has rates over dt/a; the account is over dt
        sums, scale = self.sums, dt / stepper.dt
        # by the bonds that are left: what the last step had beyond it was stored in those that broke
        old = self._stores(stepper, of, before, before)
        if len(stepper.state.broken) != self._broken:
            sums.fracture += sums.springs - old["springs"]
            self._broken = len(stepper.state.broken)
        new = self._stores(stepper, of, after, after)
        taken = self._stores(stepper, of, after, _difference(after, base), 1.0)
        for name in new:
            sums.numerical += scale * taken[name] - (new[name] - old[name])
            setattr(sums, name, new[name])
        head, start = (state.values["displacement"][of.head] for state in (after, base))
        moved = head - start if self._by_force else after.actuator - base.actuator
        sums.actuator += scale * force * moved
        at_end, rate = after.values, (after.values["memory"] - base.values["memory"]) / stepper.dt
        sums.dashpots += dt * self.law.dissipated(of.strain, at_end["sigma"], at_end["memory"], rate)
        sums.friction += dt * stepper.devices.guide_friction * abs(after.values["velocity"][of.head])
        contact = getattr(stepper, "contact", None)
        if contact is not None:
            reaction, opening = (part.reshape(-1, 3) for part in contact)
            # a gap that closes within the step has u_n = -gap/dt where it presses: the impact loses that work
            sums.impact -= dt * float((reaction[:, 0] * opening[:, 0]).sum())
            sums.friction -= dt * float((reaction[:, 1:] * opening[:, 1:]).sum())

    def _stores(
        self, stepper: Any, of: Forms, x: History, y: History, factor: float = 0.5
    ) -> dict[str, float]:
        """`factor` times the bilinear form [J] of each store at x and y; for the load its linear one at y."""
        clamp, spring, _, mass = stepper.devices.head_constants
        one, other = x.values, y.values
        stresses = [(values["sigma"], values["memory"]) for values in (one, other)]
        places = [(h.values["displacement"][of.head], h.values["velocity"][of.head]) for h in (x, y)]
        (at, speed), (at_other, speed_other) = places
        devices = spring * at * at_other + mass * speed * speed_other
        if clamp and not self._by_force:
            devices += (x.actuator - at) * (y.actuator - at_other) / clamp
        return {
            "kinetic": factor * of.inertia(one["velocity"], other["velocity"]),
            "springs": factor * self.law.stored(of.strain, *stresses),
            "load": -float(of.load @ other["displacement"]),
            "devices": factor * devices,
        }


class Forms(NamedTuple):
    """What energies of a system are made of."""

    strain: Form  # <,> over the bonds
    inertia: Form  # kinetic form
    load: np.ndarray  # (d,) or (k,) N
    head: int  # its coordinate


def forms(stepper: Any) -> Forms:
    """Quadratic forms of stiffness and mass, full or reduced, with load and driven degree of freedom."""
    model = getattr(stepper, "model", None)
    if model is not None:
        return Forms(_matrix_form(model.stiffness), _matrix_form(model.mass), model.load, 0)
    system = stepper.system
    return Forms(diagonal_form(stepper.weight), diagonal_form(system.mass), system.load, system.driven)


def _matrix_form(matrix: np.ndarray) -> Form:
    return lambda x, y: float(x @ matrix @ y)


def diagonal_form(weight: np.ndarray) -> Form:
    """The form of a diagonal matrix."""
    return lambda x, y: float((x * weight) @ y)


def _difference(after: History, base: History) -> History:
    return History({n: v - base.values[n] for n, v in after.values.items()}, after.actuator - base.actuator)
