from collections.abc import Sequence

from asphalt_nscd.diagnosis.causes._cause import SPECIMEN, Cause, Complex, Expected, Parameter, Place, Vector
from asphalt_nscd.diagnosis.observed.observations import Observations
from asphalt_nscd.files.words import three_digits


class SpecimenGeometry(Cause):
    """One specimen's modulus is off by a factor, its phase is not: its dimensions are wrong."""

    name = "specimen_geometry"
    stage = SPECIMEN
    parameters = (Parameter("relative_modulus", "1", -0.8, 3.0, 0.03),)
    expected = Expected(0.06, 0.25)
    alike = ("specimen_geometry of all specimens", "glassy modulus of relaxation_spectrum")
    sentence = "the dimensions used for this specimen are wrong beyond the usual scatter of specimens"
    signs = (
        "Its modulus comes out too high, or it is stiffer than the others (fewer voids, say).",
        "Its modulus comes out too low, or it is softer than the others (more voids, say).",
    )
    confirmed_by = "measuring its dimensions again"
    needs = "two more specimens to compare with"
    confined_to = "specimen"

    def places(self, observed: Observations) -> Sequence[Place]:
        """Each specimen, of three or more: of two neither is the odd one."""
        # Of two specimens neither is the odd one.
        return observed.names if len(observed.names) > 2 else ()

    def correction(self, value: float, place: Place) -> str:
        """|E*| of the specimen over one plus the relative error `value`."""
        return f"if its dimensions prove wrong, divide its |E*| by {three_digits(1.0 + value)}"

    def apparent(self, modulus: Complex, values: Vector, observed: Observations) -> Complex:
        """Multiply the modulus by one factor; the phase stays: E* (1 + r) (n,) [Pa], with `values` (1,) r."""
        return modulus * (1.0 + values[0])
