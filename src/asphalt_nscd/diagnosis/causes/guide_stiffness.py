from asphalt_nscd.diagnosis.causes._cause import HEAD, Cause, Complex, Parameter, Vector
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
    sentence = "a guide or cable acts as a spring in parallel with the specimen"
    confirmed_by = "a test of the rig without a specimen, or the modulus of the mix at long times"
    needs = "two-point bending and the static modulus of the mix (--static-modulus-mpa), since both add alike to |E*|"

    def shows(self, observed: Observations) -> bool:
        """All tests of a bench with a guide, where the static modulus of the mix is known: the two add alike to E1.

        Parameters
        ----------
        observed : Observations
            Measured tests.

        Returns
        -------
        bool
            True if so.
        """
        # It adds to E1 as a larger static modulus does at every temperature and frequency: that must be known.
        return observed.static_modulus is not None

    def apparent(self, modulus: Complex, values: Vector, observed: Observations) -> Complex:
        """A constant added to E1.

        Parameters
        ----------
        modulus : ndarray of complex (n,)
            E* before [Pa].
        values : ndarray (1,)
            Modulus of the spring [Pa].
        observed : Observations
            Measured tests; of no effect.

        Returns
        -------
        ndarray of complex (n,)
            E* + modulus [Pa].
        """
        return modulus + values[0]

    def rig(self, values: Vector, form_factor: float, amplitude: float) -> dict[str, float]:
        """The spring between head and ground: its modulus over the form factor.

        Parameters
        ----------
        values : ndarray (1,)
            Modulus of the spring [Pa].
        form_factor : float
            gamma of the specimen [1/m].
        amplitude : float
            Of the simulated test [m]; of no effect.

        Returns
        -------
        dict of str to float
            guide_stiffness_N_m.
        """
        return {"guide_stiffness_N_m": values[0] / form_factor}
