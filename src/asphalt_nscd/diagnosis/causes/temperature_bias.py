from collections.abc import Sequence

from asphalt_nscd.diagnosis.causes._cause import MATERIAL, Cause, Complex, Expected, Parameter, Place, Vector
from asphalt_nscd.diagnosis.observed.observations import Observations
from asphalt_nscd.files.words import three_digits


class TemperatureBias(Cause):
    """One isotherm was tested at another temperature than stated."""

    name = "temperature_bias"
    stage = MATERIAL
    parameters = (Parameter("temperature_rise", "K", -8.0, 8.0, 0.3),)
    expected = Expected(0.06, 2.0)  # K
    unseen = "A temperature error at one isotherm"
    alike = ("temperature_bias of all isotherms", "shift constants of relaxation_spectrum")
    sentence = "the specimens were not at the temperature stated for this isotherm"
    signs = ("The specimens were warmer than stated.", "The specimens were colder than stated.")
    confirmed_by = "a thermometer in a dummy specimen at this temperature"
    shows_in = "a test at a temperature between these or beyond them"
    confined_to = "temperature_C"

    def places(self, observed: Observations) -> Sequence[Place]:
        """Each isotherm [degC] with a few tests at least, of four or more; a bias of one of two is a shift law."""
        # Two isotherms: a bias of one is a change of the shift law.
        return tuple(float(t) for t in observed.held_isotherms) if observed.isotherms.size > 3 else ()

    def temperature_rise(self, values: Vector, observed: Observations) -> Vector | float:
        """The same rise of the specimens above the stated temperature for all tests of the isotherm [K]."""
        return values[0]

    def correction(self, value: float, place: Place) -> str:
        """Another temperature of the isotherm `place` [degC], `value` [K] away."""
        assert isinstance(place, float | int)
        return f"take {three_digits(place + value)} degC as their temperature"

    def apparent(self, modulus: Complex, values: Vector, observed: Observations) -> Complex:
        """Leave the modulus E* (n,) [Pa] as it is: what the temperature does to it is the law's."""
        return modulus
