"""Copied files: told where every digit agrees, for as many tests as are no chance."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from test_suspects import campaign, out

from asphalt_nscd.diagnosis.observed import copies
from asphalt_nscd.diagnosis.screening import suspects
from asphalt_nscd.files.errors import InputError


def copied(observed, to, of):
    """The tests of one specimen and isotherm in the place of another's."""
    rows = [
        np.flatnonzero((observed.specimen == specimen) & (observed.isotherm == t)) for specimen, t in (to, of)
    ]
    modulus = observed.modulus.copy()
    modulus[rows[0]] = modulus[rows[1]]
    return replace(observed, modulus=modulus), {*rows[0].tolist(), *rows[1].tolist()}


@pytest.mark.parametrize("to,of", [((1, 21.0), (0, 21.0)), ((2, 21.0), (2, 37.0))])
def test_a_copied_sweep_and_its_source_are_left_out(to, of):
    observed, rows = copied(campaign(), to, of)
    assert not out(campaign())
    assert set(out(observed)) == rows
    for one in suspects.find(observed):
        k, t = of if (observed.specimen[one.row], observed.isotherm[one.row]) == to else to
        told = f"equal in every digit to specimen {'ABC'[k]} at {t:g} degC: one was copied; look in the record which"
        assert one.reasons[0] == told


def test_two_tests_alike_are_chance():
    observed, _ = copied(campaign(), (1, 21.0), (0, 21.0))
    few = (observed.isotherm != 21.0) | (observed.specimen != 1) | (observed.frequency < 1.0)
    assert not list(copies.copied(observed.subset(np.flatnonzero(few))))
    assert list(copies.copied(observed))


def test_a_last_digit_makes_them_apart():
    observed, rows = copied(campaign(), (1, 21.0), (0, 21.0))
    modulus = observed.modulus.copy()
    modulus[min(rows)] *= 1.0 + 1e-4
    assert not list(copies.copied(replace(observed, modulus=modulus)))


def test_a_table_of_copies_alone_is_refused():
    observed = campaign()
    same = observed.subset(np.flatnonzero(observed.specimen == 0))
    twice = replace(
        observed.subset(np.flatnonzero(observed.specimen < 2)),
        modulus=np.tile(same.modulus, 2),
    )
    with pytest.raises(InputError, match="copies are not replicates"):
        copies.refuse_copies(twice)


@pytest.mark.parametrize(
    ("same", "own", "refused"), [(4, 3, True), (3, 3, False), (2, 0, False), (3, 0, True)]
)
def test_of_two_campaigns_one_may_not_be_most_of_the_other(same, own, refused):
    """More than half of the smaller, three tests at least."""
    observed = campaign()
    modulus = observed.modulus[: same + own] * np.where(np.arange(same + own) < same, 1.0, 1.01)
    both = {"a": observed, "b": replace(observed.subset(np.arange(same + own)), modulus=modulus)}
    if refused:
        with pytest.raises(InputError, match=f"a and b hold the same {same} tests"):
            copies.refuse_copied_campaign(both)
    else:
        copies.refuse_copied_campaign(both)
