import numpy as np

from asphalt_nscd.diagnosis.causes._cause import EXCESS, MATERIAL, Cause, Expected, Parameter, Vector
from asphalt_nscd.diagnosis.observed.observations import Observations


class SelfHeating(Cause):
    """The mix warms by its own dissipation: a rise proportional to omega E2 (amplitude squared)."""

    name = "self_heating"
    stage = MATERIAL
    parameters = (Parameter("largest_temperature_rise", "K", 0.0, 15.0, 0.5),)
    family = EXCESS
    expected = Expected(0.03, 1.5)  # K
    sentence = "the specimens warm themselves while they are tested"
    confirmed_by = "a thermometer in the specimen, or the drift of the modulus during a longer test"

    def shows(self, observed: Observations) -> bool:
        """Whether frequencies and isotherms are several and the mix dissipates at all."""
        several = observed.frequencies.size > 1 and observed.isotherms.size > 1
        # A table of metal dissipates nothing.
        return several and bool(self._power(observed.table).max() > 0.0)

    def temperature_rise(self, values: Vector, observed: Observations) -> Vector | float:
        """Rise (n,) [K] in proportion to omega E2 z0^2, without amplitudes to omega E2, by the measured loss.

        `values` (1,) is the rise of the test that dissipates most in the whole table in K.
        """
        return values[0] * self._power(observed) / self._power(observed.table).max()

    @staticmethod
    def _power(observed: Observations) -> Vector:
        # The measured loss: a true feedback would only change the rise by its own small share.
        power = observed.omega * np.maximum(observed.modulus.imag, 0.0)
        return power if observed.amplitude is None else power * observed.amplitude**2
