import numpy as np

from asphalt_nscd.diagnosis.causes._cause import SPECIMEN, Cause, Parameter


class Damage(Cause):
    """The modulus falls with the load cycles a specimen has borne, or with the order of its tests."""

    name = "damage"
    stage = SPECIMEN
    parameters = (Parameter("loss_at_last_test", "1", 0.0, 0.8, 0.02),)
    sentence = "the specimens lose stiffness in the course of the tests"
    confirmed_by = "repeating the first test at the end"
    needs = "the order of the tests (column order or cycles)"

    def places(self, observed):
        progress = self._progress(observed)
        return () if progress is None or np.ptp(progress) == 0.0 else (None,)

    def apparent(self, modulus, values, observed):
        return modulus * (1.0 - values[0] * self._progress(observed))

    @staticmethod
    def _progress(observed):
        """From zero at the first test to one at the last."""
        count = observed.cycles if observed.cycles is not None else observed.order
        if count is None:
            return None
        return (count - count.min()) / max(np.ptp(count), 1e-300)
