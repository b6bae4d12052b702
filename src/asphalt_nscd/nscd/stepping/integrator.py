"""Runs a stepper, full or reduced, through a test by any scheme, and keeps the energy account."""

from __future__ import annotations

from asphalt_nscd.nscd.bonds.law import AnyLaw
from asphalt_nscd.nscd.stepping.condensed import CondensedStepper
from asphalt_nscd.nscd.stepping.energy import EnergyAccount
from asphalt_nscd.nscd.stepping.gauss_seidel_stepping import SweepingStepper
from asphalt_nscd.nscd.stepping.reduced_stepping import ReducedStepper
from asphalt_nscd.nscd.stepping.scheme import History, Scheme

Stepper = CondensedStepper | ReducedStepper | SweepingStepper


class March:
    """Steps of `dt` [s] by any scheme from a stepper's state, at rest for the energy account; the stepper's: dt / a."""

    def __init__(
        self,
        stepper: Stepper,
        scheme: Scheme,
        law: AnyLaw,
        dt: float,
        actuator: float = 0.0,
        account: bool = True,
    ) -> None:
        """actuator: where it stands [m]; account: whether to keep that of energy, in `account`."""
        self.stepper, self.scheme, self.law, self.dt = stepper, scheme, law, dt
        self.now = self.earlier = History.of(stepper.state, actuator)
        self.account, self.accounts = EnergyAccount(law), account

    def move_to(self, actuator: float) -> float:
        """Force [N] of the actuator in one step, which ends with it at `actuator` [m].

        A reduced stepper that cannot make the step raises FullSystemNeeded, and is left in the state before.
        """
        stepper = self.stepper
        base = self.now.extrapolate(self.earlier, self.scheme.b / self.scheme.a)
        base.put(stepper.state)
        try:
            force = stepper.move(base.actuator, actuator)
        except Exception:
            self._widen()  # a bond may have broken before the step failed
            self.now.put(stepper.state)
            raise
        base = base.widened(stepper.state)
        self._widen()
        after = History.of(stepper.state, actuator)
        if self.accounts:
            self.account.count(stepper, self.dt, force, self.now, base, after)
        self.earlier, self.now = self.now, after
        return force

    def go_on_with(self, full: CondensedStepper) -> None:
        """Replace the reduced stepper by `full`, one of the full system with the same bonds broken."""
        reduced = self.stepper
        assert isinstance(reduced, ReducedStepper), "the full system has nothing beyond it"

        def lifted(history: History) -> History:
            history.put(reduced.state)
            return History.of(reduced.full_state(), history.actuator)

        self.earlier, self.now = lifted(self.earlier), lifted(self.now)
        self.stepper = full

    def _widen(self) -> None:
        state = self.stepper.state
        self.earlier, self.now = self.earlier.widened(state), self.now.widened(state)
