import numpy as np

from asphalt_nscd.diagnosis.causes._cause import MATERIAL, Cause, Complex, Expected, Parameter, Vector
from asphalt_nscd.diagnosis.observed.observations import Observations


class Solver(Cause):
    """Implicit Euler steps too long for the oscillation: i omega becomes (1 - exp(-i omega dt))/dt.

    ln E* moves by the logarithm of their ratio times d ln E*/d ln(i omega); the slope of a smooth law
    is its phase over pi/2.
    """

    name = "solver"
    stage = MATERIAL
    parameters = (Parameter("effect_of_time_step", "1", -20.0, 20.0, 1.0),)
    expected = Expected(0.5, 1.0)  # of a simulated campaign
    sentence = "the time step of the simulation is too long"
    confirmed_by = "the same tests at half the time step"
    needs = "simulated tests (column time_step_s); in measurements there is no time step"

    def shows(self, observed: Observations) -> bool:
        """Whether the table tells the time step of a simulation."""
        return observed.time_step is not None

    def apparent(self, modulus: Complex, values: Vector, observed: Observations) -> Complex:
        """What implicit Euler makes of the modulus of a smooth law, whose slope is its phase over pi/2.

        E* ((1 - exp(-i omega dt)) / (i omega dt))^(value slope) (n,) [Pa], with dt in s from `observed`; `values` (1,)
        is one for the whole effect of the time step, zero for none.
        """
        slope = np.angle(modulus) / (0.5 * np.pi)
        step = 1j * observed.omega * observed.known("time_step")
        return modulus * (-np.expm1(-step) / step) ** (values[0] * slope)
