from asphalt_nscd.diagnosis.causes._cause import HEAD, Cause, Complex, Parameter, Vector
from asphalt_nscd.diagnosis.observed.observations import Observations


class MovingMass(Cause):
    """Mass that moves with the head and is missing from Eq. (1): E* - gamma dm omega^2.

    gamma is the form factor of a two-point specimen. At the frequencies of an axial test the inertia of a platen
    between load cell and cylinder is far below its stiffness: 2 kg at 25 Hz are 0.05 kN/mm,
    a cylinder of 1.9 GPa has 100 kN/mm.
    """

    name = "moving_mass"
    stage = HEAD
    benches = ("bending",)
    needs = "two-point bending at several frequencies"
    parameters = (Parameter("mass", "kg", -2.0, 2.0, 0.02),)
    sentence = "the mass moving with the head differs from the one used in the reduction"
    signs = (
        "The mass entered for the parts that move is too small.",
        "The mass entered for the parts that move is too large.",
    )
    confirmed_by = "weighing what moves with the head, or a test of the rig without a specimen"

    def shows(self, observed: Observations) -> bool:
        """All tests of a two-point bench at two frequencies or more: at one, a mass is a constant of E1.

        Parameters
        ----------
        observed : Observations
            Measured tests.

        Returns
        -------
        bool
            True if so.
        """
        return observed.frequencies.size > 1

    def apparent(self, modulus: Complex, values: Vector, observed: Observations) -> Complex:
        """The inertia that Eq. (1) leaves out takes from E1.

        Parameters
        ----------
        modulus : ndarray of complex (n,)
            E* before [Pa].
        values : ndarray (1,)
            Mass dm that the reduction lacks [kg].
        observed : Observations
            Measured tests, with the form factor gamma [1/m] of their specimens.

        Returns
        -------
        ndarray of complex (n,)
            E* - gamma dm omega^2 [Pa].
        """
        return modulus - observed.form_factor * values[0] * observed.omega**2

    def impossible(self, values: Vector, observed: Observations) -> str:
        """Less than no mass cannot move: the reduction's own count bounds what it counts too much.

        Parameters
        ----------
        values : ndarray (1,)
            Mass that the reduction lacks [kg]; below zero, it counts too much.
        observed : Observations
            Measured tests; moduli given without their reduction bound nothing.

        Returns
        -------
        str
            Empty where it can be; else the mass that the reduction counts.
        """
        counted = float((observed.inertia / observed.form_factor).max())  # nothing, where moduli were given
        if values[0] >= -counted or not counted:
            return ""
        return f"Less than no mass would move: the reduction counts {1e3 * counted:.0f} g"

    def rig(self, values: Vector, form_factor: float, amplitude: float) -> dict[str, float]:
        """The mass on the head of the simulation.

        Parameters
        ----------
        values : ndarray (1,)
            The mass [kg].
        form_factor : float
            gamma of the specimen [1/m]; of no effect.
        amplitude : float
            Of the simulated test [m]; of no effect.

        Returns
        -------
        dict of str to float
            head_mass_kg.
        """
        return {"head_mass_kg": values[0]}
