import numpy as np

from asphalt_nscd.diagnosis.causes._cause import HEAD, Cause, Complex, Parameter, Vector
from asphalt_nscd.diagnosis.observed.observations import Observations


class GuideFriction(Cause):
    """A slider in parallel with the specimen: loss that does not depend on the rate, added to E2.

    Its first harmonic is 4 F / (pi z0), so the loss modulus is gamma 4 F / (pi z0); where the table
    gives amplitudes z0, the loss is that of the median amplitude. A two-point bench guides the head that
    displacement and force are read at; a cylinder's load cell and gauges sit on the specimen, with no guide between.
    """

    name = "guide_friction"
    stage = HEAD
    benches = ("bending",)
    needs = "two-point bending: a cylinder in tension-compression has no guided head"
    parameters = (Parameter("loss_modulus", "Pa", 0.0, 5e9, 2e7),)
    sentence = "dry friction in a guide adds a loss that does not depend on the frequency"
    confirmed_by = "a test of the rig without a specimen, or tests at two amplitudes"

    def apparent(self, modulus: Complex, values: Vector, observed: Observations) -> Complex:
        """A loss added to E2, larger where the amplitude is smaller.

        Parameters
        ----------
        modulus : ndarray of complex (n,)
            E* before [Pa].
        values : ndarray (1,)
            Loss modulus at the median amplitude [Pa].
        observed : Observations
            Measured tests; without amplitudes the loss is the same in all.

        Returns
        -------
        ndarray of complex (n,)
            E* + i loss (median z0) / z0 [Pa].
        """
        loss: Vector | float = values[0]
        if observed.amplitude is not None:
            loss = loss * np.median(observed.table.known("amplitude")) / observed.amplitude
        return modulus + 1j * loss

    def rig(self, values: Vector, form_factor: float, amplitude: float) -> dict[str, float]:
        """The slider whose first harmonic is this loss: F = loss pi z0 / (4 gamma).

        Parameters
        ----------
        values : ndarray (1,)
            Loss modulus [Pa].
        form_factor : float
            gamma of the specimen [1/m].
        amplitude : float
            Of the simulated test, z0 [m].

        Returns
        -------
        dict of str to float
            guide_friction_N.
        """
        return {"guide_friction_N": values[0] / form_factor * np.pi * amplitude / 4.0}
