import numpy as np

from asphalt_nscd.diagnosis.causes._cause import (
    CHANNEL,
    Cause,
    Complex,
    Expected,
    Parameter,
    Place,
    Vector,
    less,
)
from asphalt_nscd.diagnosis.observed.observations import Observations


class ChannelDelay(Cause):
    """The displacement is recorded later than the force by a fixed time: F/z exp(i omega tau)."""

    name = "channel_delay"
    stage = CHANNEL
    # Up to 20 ms: where the search ended at 5 ms a larger one had no name, and what it left made other limits absurd.
    parameters = (Parameter("delay", "s", -2e-2, 2e-2, 1e-4),)
    expected = Expected(0.06, 2.5e-4)  # s
    unseen = "A delay of all tests"
    sentence = "the displacement channel lags the force channel by a fixed time"
    signs = (
        "The displacement is recorded after the force.",
        "The displacement is recorded before the force.",
    )
    shows_in = "a test on a metal reference specimen: in these, the master curve can bend to hide it"
    confirmed_by = "a test on an elastic reference specimen of metal, which has no phase of its own"

    def shows(self, observed: Observations) -> bool:
        """Whether two frequencies or more were tested: at one, a delay is an angle like any other."""
        return observed.frequencies.size > 1

    def correction(self, value: float, place: Place) -> str:
        """The phase turned back by 360 degrees times the frequency times the delay `value` [s]."""
        return f"{less(360.0 * value, 'deg per Hz')} the phase"

    def apparent(self, modulus: Complex, values: Vector, observed: Observations) -> Complex:
        """Turn the recorded F/z by omega tau; the inertia that the reduction adds by Eq. (1) is not turned.

        With `values` (1,) the delay tau in s: (E* - gamma m omega^2) exp(i omega tau) + gamma m omega^2 (n,) [Pa].
        """
        # The delay turns F/z as recorded; the reduction then adds the inertia of Eq. (1), unturned.
        inertia = observed.inertia * observed.omega**2
        return (modulus - inertia) * np.exp(1j * observed.omega * values[0]) + inertia

    def rig(self, values: Vector, form_factor: float, amplitude: float) -> dict[str, float]:
        """The channel of the simulation delays the displacement: channel_delay_s."""
        return {"channel_delay_s": values[0]}
