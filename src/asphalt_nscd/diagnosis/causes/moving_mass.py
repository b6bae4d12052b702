from asphalt_nscd.diagnosis.causes._cause import HEAD, Cause, Parameter


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
    confirmed_by = "weighing what moves with the head, or a test of the rig without a specimen"

    def places(self, observed):
        return (None,) if observed.frequencies.size > 1 and self.on_bench(observed) else ()

    def apparent(self, modulus, values, observed):
        return modulus - observed.form_factor * values[0] * observed.omega**2

    def rig(self, values, form_factor, amplitude):
        return {"head_mass_kg": values[0]}
