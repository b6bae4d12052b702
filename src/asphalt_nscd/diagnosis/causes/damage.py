import numpy as np

from asphalt_nscd.diagnosis.causes._cause import SPECIMEN, Cause, Complex, Expected, Parameter, Vector
from asphalt_nscd.diagnosis.observed.observations import Observations


class Damage(Cause):
    """The modulus falls with the load cycles a specimen has borne, or with the order of its tests."""

    name = "damage"
    stage = SPECIMEN
    parameters = (Parameter("loss_at_last_test", "1", 0.0, 0.8, 0.02),)
    expected = Expected(0.04, 0.12)
    sentence = "the specimens lose stiffness in the course of the tests"
    confirmed_by = "repeating the first test at the end"
    needs = "the order of the tests (column order or cycles)"

    def shows(self, observed: Observations) -> bool:
        """Whether the table tells the order or the cycles of its tests, and not all are the same."""
        known = observed.cycles is not None or observed.order is not None
        return known and bool(np.ptp(self._progress(observed)) > 0.0)

    def apparent(self, modulus: Complex, values: Vector, observed: Observations) -> Complex:
        """Modulus that falls in proportion to the cycles borne or, where these are unknown, to the number of the test.

        E* (1 - loss progress) (n,) [Pa], progress from 0 at the first to 1 at the last test; `values` (1,) is the loss
        at the last test, as a share of the modulus.
        """
        return modulus * (1.0 - values[0] * self._progress(observed))

    @staticmethod
    def _progress(observed: Observations) -> Vector:
        """(n,) from zero at the first test to one at the last."""
        # Cycles where the table has both: damage grows with loads, not with tests.
        name = "order" if observed.cycles is None else "cycles"
        count, every = observed.known(name), observed.table.known(name)
        return (count - every.min()) / max(np.ptp(every), 1e-300)
