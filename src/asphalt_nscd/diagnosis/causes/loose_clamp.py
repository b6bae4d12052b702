from collections.abc import Sequence

from asphalt_nscd.diagnosis.causes._cause import SPECIMEN, Cause, Complex, Expected, Parameter, Place, Vector
from asphalt_nscd.diagnosis.observed.observations import Observations


class LooseClamp(Cause):
    """A compliance in series with one specimen: 1/E + C.

    On a two-point bench the displacement of the head holds it. The gauges on a cylinder measure between two points
    of the specimen, and no clamp lies between these.
    """

    name = "loose_clamp"
    stage = SPECIMEN
    benches = ("bending",)
    parameters = (Parameter("compliance", "1/Pa", 0.0, 1e-9, 5e-13),)
    expected = Expected(0.02, 8e-12)  # 1/Pa
    # 1/E + C is exactly another Burgers law, and without a static modulus another law of Huet and Sayegh.
    alike = ("loose_clamp of all specimens", "relaxation_spectrum")
    sentence = "this specimen is held by a compliant clamp or glue joint"
    confirmed_by = "clamping the specimen again and repeating its coldest test"
    needs = "two-point bending and a second specimen to compare with"
    confined_to = "specimen"

    def places(self, observed: Observations) -> Sequence[Place]:
        """Each specimen, where there are others: a compliance of all specimens is another law exactly."""
        # A compliance of all specimens, 1/E + C, is another law exactly: only one that differs shows.
        return observed.names if len(observed.names) > 1 and self.possible_on_bench(observed) else ()

    def apparent(self, modulus: Complex, values: Vector, observed: Observations) -> Complex:
        """Put a compliance C in series with the specimen: 1 / (1/E* + C) (n,) [Pa], with `values` (1,) C in 1/Pa."""
        return modulus / (1.0 + values[0] * modulus)

    def rig(self, values: Vector, form_factor: float, amplitude: float) -> dict[str, float]:
        """The compliance between head and specimen: clamp_compliance_m_N is C [1/Pa] times the form factor [1/m]."""
        return {"clamp_compliance_m_N": values[0] * form_factor}
