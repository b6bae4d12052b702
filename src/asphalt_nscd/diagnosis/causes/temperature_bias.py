from asphalt_nscd.diagnosis.causes._cause import MATERIAL, Cause, Parameter


class TemperatureBias(Cause):
    """One isotherm was tested at another temperature than stated."""

    name = "temperature_bias"
    stage = MATERIAL
    parameters = (Parameter("temperature_rise", "K", -8.0, 8.0, 0.3),)
    sentence = "the specimens were not at the temperature stated for this isotherm"
    confirmed_by = "a thermometer in a dummy specimen at this temperature"

    def places(self, observed):
        # Two isotherms: a bias of one is a change of the shift law.
        return tuple(float(t) for t in observed.isotherms) if observed.isotherms.size > 3 else ()

    def temperature_rise(self, values, observed):
        return values[0]

    def apparent(self, modulus, values, observed):
        return modulus
