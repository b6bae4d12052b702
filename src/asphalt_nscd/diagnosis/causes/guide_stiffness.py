from asphalt_nscd.diagnosis.causes._cause import HEAD, Cause, Complex, Expected, Parameter, Vector
from asphalt_nscd.diagnosis.observed.observations import Observations


class GuideStiffness(Cause):
    """A spring in parallel with the specimen: a constant added to E1. Only the head of a two-point bench is guided."""

    name = "guide_stiffness"
    stage = HEAD
    benches = ("bending",)
    shows_in = (
        "tests so warm that the mix comes near its static modulus, or a test of the rig without a specimen"
    )
    parameters = (Parameter("modulus", "Pa", 0.0, 5e9, 2e7),)
    expected = Expected(0.03, 1.2e8)  # Pa
    followed = True
    alike = ("guide_stiffness", "static modulus of relaxation_spectrum")
    sentence = "a guide or cable acts as a spring in parallel with the specimen"
    confirmed_by = "a test of the rig without a specimen, or the modulus of the mix at long times"
    needs = "two-point bending and the static modulus of the mix (--static-modulus-mpa), since both add alike to |E*|"

    def shows(self, observed: Observations) -> bool:
        """Whether the static modulus of the mix is known: it and a guide add alike to E1."""
        # It adds to E1 as a larger static modulus does at every temperature and frequency: that must be known.
        return observed.static_modulus is not None

    def apparent(self, modulus: Complex, values: Vector, observed: Observations) -> Complex:
        """Add a constant to E1: E* + modulus (n,) [Pa], with `values` (1,) the modulus of the spring in Pa."""
        return modulus + values[0]

    def rig(self, values: Vector, form_factor: float, amplitude: float) -> dict[str, float]:
        """The spring between head and ground: guide_stiffness_N_m is its modulus [Pa] over the form factor [1/m]."""
        return {"guide_stiffness_N_m": values[0] / form_factor}
