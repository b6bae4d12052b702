from asphalt_nscd.diagnosis.causes._cause import HEAD, Cause, Complex, Expected, Parameter, Vector
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
    expected = Expected(0.04, 0.25)  # kg
    sentence = "the mass moving with the head differs from the one used in the reduction"
    signs = (
        "The mass entered for the parts that move is too small.",
        "The mass entered for the parts that move is too large.",
    )
    confirmed_by = "weighing what moves with the head, or a test of the rig without a specimen"

    def shows(self, observed: Observations) -> bool:
        """Whether two frequencies or more were tested: at one, a mass is a constant of E1."""
        return observed.frequencies.size > 1

    def apparent(self, modulus: Complex, values: Vector, observed: Observations) -> Complex:
        """Take from E1 the inertia of dm [kg], `values` (1,), that Eq. (1) leaves out: E* - gamma dm omega^2 [Pa]."""
        return modulus - observed.form_factor * values[0] * observed.omega**2

    def impossible(self, values: Vector, observed: Observations) -> str:
        """Name the mass that the reduction counts where less than none would move; empty where the size can be.

        `values` (1,) is the mass that the reduction lacks in kg, below zero where it counts too much: its own count
        bounds that. Moduli given without their reduction bound nothing.
        """
        counted = float((observed.inertia / observed.form_factor).max())  # nothing, where moduli were given
        if values[0] >= -counted or not counted:
            return ""
        return f"Less than no mass would move: the reduction counts {1e3 * counted:.0f} g"

    def rig(self, values: Vector, form_factor: float, amplitude: float) -> dict[str, float]:
        """The mass on the head of the simulation: head_mass_kg."""
        return {"head_mass_kg": values[0]}
