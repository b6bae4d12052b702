import numpy as np

from asphalt_nscd.diagnosis.causes._cause import EXCESS, MATERIAL, Cause, Complex, Expected, Parameter, Vector
from asphalt_nscd.diagnosis.observed.observations import Observations

# By how much [deg] a fit without a drift reads the phase of a creep t^n too large, over the last 5 of 10 cycles of a
# haversine from rest (`rheology.as_run`); n is the slope of ln|E*|, a 90th of the phase.
SLOPES = 0.0, 0.1, 0.15, 0.2, 0.25, 0.3, 0.35, 0.4, 0.5
READ_TOO_LARGE = 0.0, 0.35, 0.68, 1.11, 1.66, 2.35, 3.18, 4.14, 6.35


class DriftingReading(Cause):
    """A haversine makes the mix creep while it oscillates; read without that drift, its phase comes out too large."""

    name = "drifting_reading"
    stage = MATERIAL
    benches = ("tension-compression",)
    alters_tests = False
    family = EXCESS
    parameters = (Parameter("share", "1", 0.0, 1.0, 0.2),)
    expected = Expected(0.15, 0.5)
    plain = ("a drift that is read as phase", "({} of what a fit without a drift would add)")
    sentence = "the phase is read from a haversine whose drift is not taken off"
    needs = "a cylinder: the head of a two-point bench swings about zero"
    confirmed_by = "the record read with a term for the drift, and a test on metal"

    def apparent(self, modulus: Complex, values: Vector, observed: Observations) -> Complex:
        """Turn E* (n,) [Pa] by a share of the excess that its own slope gives; `values` (1,) is the share."""
        slope = np.angle(modulus) / (0.5 * np.pi)
        return modulus * np.exp(1j * values[0] * np.radians(np.interp(slope, SLOPES, READ_TOO_LARGE)))
