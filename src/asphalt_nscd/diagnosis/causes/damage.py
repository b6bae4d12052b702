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
        """(n,) from zero at the first test to one at the last; None where the order is not known."""
        count, every = ((o.cycles if o.cycles is not None else o.order) for o in (observed, observed.table))
        if count is None:
            return None
        return (count - every.min()) / max(np.ptp(every), 1e-300)
