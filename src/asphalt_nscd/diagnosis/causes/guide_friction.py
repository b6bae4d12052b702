import numpy as np

from asphalt_nscd.diagnosis.causes._cause import EXCESS, HEAD, Cause, Complex, Expected, Parameter, Vector
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
    family = EXCESS
    expected = Expected(0.03, 1.2e8)  # Pa
    plain = ("friction in the guide", "(a loss modulus larger by {})")
    sentence = "dry friction in a guide adds a loss that does not depend on the frequency"
    confirmed_by = "a test of the rig without a specimen, or tests at two amplitudes"

    def apparent(self, modulus: Complex, values: Vector, observed: Observations) -> Complex:
        """Add a loss to E2, larger where the amplitude z0 is smaller: E* + i loss (median z0) / z0 (n,) [Pa].

        `values` (1,) is the loss modulus at the median amplitude in Pa; without amplitudes it is the same in all tests.
        """
        loss: Vector | float = values[0]
        if observed.amplitude is not None:
            loss = loss * np.median(observed.table.known("amplitude")) / observed.amplitude
        return modulus + 1j * loss

    def rig(self, values: Vector, form_factor: float, amplitude: float) -> dict[str, float]:
        """The slider with this loss [Pa] as first harmonic: guide_friction_N = loss pi z0 / (4 gamma), z0 in m."""
        return {"guide_friction_N": values[0] / form_factor * np.pi * amplitude / 4.0}
