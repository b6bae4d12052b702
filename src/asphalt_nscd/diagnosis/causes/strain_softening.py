import numpy as np

from asphalt_nscd.diagnosis.causes._cause import MATERIAL, Cause, Complex, Expected, Parameter, Vector
from asphalt_nscd.diagnosis.observed.observations import Observations


class StrainSoftening(Cause):
    """The modulus falls with the amplitude: E* (1 - s A / A_max)."""

    name = "strain_softening"
    stage = MATERIAL
    parameters = (Parameter("loss_at_largest_amplitude", "1", 0.0, 0.8, 0.02),)
    expected = Expected(0.04, 0.12)
    unseen = "A softening with strain"
    plain = ("a softening with strain", "(|E*| lower by {} at the usual strain)")
    sentence = "the modulus depends on the strain amplitude: the mix is outside its linear range"
    confirmed_by = "an amplitude sweep down to 20 microstrain"
    needs = "more than one amplitude (column amplitude_m)"

    def shows(self, observed: Observations) -> bool:
        """Whether the amplitudes of the tests span more than a fifth of the largest."""
        amplitude = observed.amplitude
        # Amplitudes that wobble about one setting are no sweep of the strain.
        return amplitude is not None and bool(np.ptp(amplitude) > 0.2 * amplitude.max())

    def apparent(self, modulus: Complex, values: Vector, observed: Observations) -> Complex:
        """E* (1 - s A / A_max) [Pa] falls with the amplitude A [m]; `values` (1,) is s, A_max of the whole table."""
        return modulus * (
            1.0 - values[0] * observed.known("amplitude") / observed.table.known("amplitude").max()
        )
