"""A specimen whose modulus is off at one temperature, and specimens that are hardly of one mix."""

from dataclasses import replace

import numpy as np
import pytest
from test_diagnose import table

from asphalt_nscd.diagnosis import levels


@pytest.mark.parametrize("factor", [0.6, 1.5, 3.0])
def test_one_isotherm_of_one_specimen_is_named(factor):
    observed = table(3)
    specimen, t = observed.names[1], float(observed.isotherms[1])
    hit = (observed.specimen == 1) & (observed.isotherm == t)
    wrong = replace(observed, modulus=np.where(hit, factor, 1.0) * observed.modulus)
    (one,) = levels.odd(wrong)
    assert (one["specimen"], one["temperature_C"]) == (specimen, t)
    assert one["factor"] == pytest.approx(factor, rel=0.1)
    (sentence,) = levels.notes([one])
    assert sentence.startswith(f"At {t:g} degC |E*| of specimen {specimen} is {one['factor']:.2g} times what")


def test_a_stiffer_specimen_and_usual_scatter_are_not_odd():
    observed = table(3)
    assert levels.odd(observed) == []
    stiffer = replace(observed, modulus=np.where(observed.specimen == 1, 1.5, 1.0) * observed.modulus)
    assert levels.odd(stiffer) == []


def test_of_two_specimens_neither_is_odd():
    observed = table(3)
    two = observed.subset(observed.specimen < 2)
    hit = (two.specimen == 1) & (two.isotherm == two.isotherms[0])
    assert levels.odd(replace(two, modulus=np.where(hit, 2.0, 1.0) * two.modulus)) == []
