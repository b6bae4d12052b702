import numpy as np

from asphalt_nscd.diagnosis.causes._cause import (
    CHANNEL,
    EXCESS,
    Cause,
    Complex,
    Expected,
    Parameter,
    Place,
    Vector,
    less,
)
from asphalt_nscd.diagnosis.observed.observations import Observations


class PhaseOffset(Cause):
    """A constant error of the phase: F/z exp(i phi)."""

    name = "phase_offset"
    stage = CHANNEL
    parameters = (Parameter("offset", "deg", -30.0, 30.0, 0.5),)
    expected = Expected(0.06, 1.2)  # deg
    family = EXCESS
    unseen = "A common phase offset"
    sentence = "the measured phase is off by the same angle in every test"
    signs = ("The measured phases are too large.", "The measured phases are too small.")
    shows_in = "a test on a metal reference specimen: in these, the master curve can bend to hide it"
    confirmed_by = "a test on an elastic reference specimen of metal, which has no phase of its own"

    def correction(self, value: float, place: Place) -> str:
        """The phase less the offset `value` [deg]."""
        return f"{less(value, 'deg')} the phase"

    def apparent(self, modulus: Complex, values: Vector, observed: Observations) -> Complex:
        """Turn the recorded F/z by one angle; the inertia that the reduction adds by Eq. (1) is not turned.

        With `values` (1,) the angle phi in deg: (E* - gamma m omega^2) exp(i phi) + gamma m omega^2 (n,) [Pa].
        """
        # The error turns F/z as recorded; the reduction then adds the inertia of Eq. (1), unturned.
        inertia = observed.inertia * observed.omega**2
        return (modulus - inertia) * np.exp(1j * np.radians(values[0])) + inertia

    def rig(self, values: Vector, form_factor: float, amplitude: float) -> dict[str, float]:
        """The channel of the simulation turns the phase: phase_offset_rad, of `values` (1,) in deg."""
        return {"phase_offset_rad": float(np.radians(values[0]))}
