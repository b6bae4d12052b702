"""A specimen whose modulus or phase is off at one temperature, or whose phase is off at all."""

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from asphalt_nscd.diagnosis.observed.reading import PAPER_GEOMETRY, read_observations
from asphalt_nscd.diagnosis.record.law import law_of_mix
from asphalt_nscd.diagnosis.record.mixture import mixture
from asphalt_nscd.diagnosis.record.statuses import Places, counts, kept, off_target, statuses
from asphalt_nscd.diagnosis.screening import levels
from asphalt_nscd.diagnosis.screening.suspects import Suspect
from asphalt_nscd.diagnosis.search.diagnose import diagnose
from asphalt_nscd.table_import.campaign import read_campaign

FEW = 500  # draws: what is tested here does not hang on the third digit of a chance
EXPORTS = Path(__file__).parents[2] / "data/tutorial/exports"


@pytest.fixture(scope="module")
def exports():
    """Three specimens at four temperatures."""
    return read_observations(read_campaign([EXPORTS])[0], PAPER_GEOMETRY)[0]


def test_the_law_is_nearer_to_the_mix_without_an_odd_isotherm(exports):
    hit = (exports.specimen == 1) & (exports.isotherm == 35)
    right, wrong = (
        diagnose(replace(exports, modulus=np.where(hit, factor, 1.0) * exports.modulus), draws=500)
        for factor in (1.0, 0.7)
    )
    odd = wrong.ladder.confined_faults
    used = ~levels.rows(wrong.observed, odd)
    assert (~used).sum() == hit.sum()
    omega, t = exports.omega[hit], exports.temperature[hit]
    every = np.ones(used.size, bool)
    law, without, spoiled = (
        law_of_mix(mixture(found, rows)).law.complex_modulus(omega, t)
        for found, rows in ((right, every), (wrong, used), (wrong, every))
    )
    assert np.abs(np.log(without / law)).max() < 0.02 < 0.05 < np.abs(np.log(spoiled / law)).min()


@pytest.mark.parametrize(
    "kelvin,told", [((9.0, -11.0), True), ((9.0, 11.0), False), ((9.0, -3.0), False), ((-9.0, 11.0), False)]
)
def test_two_sweeps_that_each_look_like_the_other_are_told_exchanged(kelvin, told):
    found = [{"specimen": "B", "temperature_C": t, "kelvin": k} for t, k in zip((15.0, 25.0), kelvin)]
    exchanged = ["specimen B: the sweeps at 15 and 25 degC look exchanged: check the record"]
    assert levels.swap_notes([], found) == exchanged * told
    assert not levels.swap_notes([], [found[0], found[1] | {"specimen": "C"}])


@pytest.mark.parametrize(
    "other,told", [((25.0, 1.23), True), ((15.0, 1.23), False), ((25.0, 1.6), False), ((25.0, 0.8), False)]
)
def test_two_specimens_that_are_off_by_inverse_factors_are_told_exchanged(other, told):
    found = [
        {"specimen": name, "temperature_C": t, "factor": factor}
        for name, (t, factor) in zip("BA", [other, (25.0, 0.82)])
    ]
    said = levels.swap_notes(found, [])
    assert len(said) == told
    assert all(
        one.startswith("at 25 degC specimen A is as far below its level of |E*| as specimen B is")
        for one in said
    )


def test_every_test_has_one_status(exports):
    odd = {"specimen": "Mix-B", "temperature_C": 35.0, "factor": 0.7}
    at = (exports.specimen == 1) & (exports.isotherm == 35)
    rows = [int(np.flatnonzero(at)[0]), int(np.flatnonzero(exports.isotherm == 4)[0])]
    suspects = (Suspect(rows[0], ("x",), used=False), Suspect(rows[1], ("y",), used=True))
    none = np.zeros(exports.size, bool)
    places = Places([odd], [], [], [{"temperature_C": 50.0}], off_target(exports), none)
    found = SimpleNamespace(suspects=suspects, observed=exports)
    record = statuses(found, exports, places)
    assert (record["status"] == np.where(at, "held back", record["status"])).sum() == exports.size - 1
    assert record["status"].tolist().count("held back") == at.sum() - 1
    assert (record["status"][exports.isotherm == 50] == "doubtful").all()
    first, second = record.iloc[rows].to_dict("records")
    assert (first["status"], first["decided_by"]) == ("left out", "its own isotherm, the other specimens")
    assert (second["status"], second["reasons"]) == ("doubtful", ["y"])
    told = counts(record, exports.isotherms.tolist())
    hot = int((exports.isotherm == 50).sum())
    check = hot + int(at.sum())
    assert (told["use"], told["check"], told["not_used"]) == (exports.size - check - 1, check, 1)
    assert told["held_back"] == at.sum() - 1
    assert told["use_by_specimen"] == {"Mix-A": 17, "Mix-B": 12, "Mix-C": 18}
    assert kept(record).sum() == exports.size - at.sum()
    # Where the rest makes no law, nothing is held back.
    odd = {"temperature_C": 35.0, "phase_deg": 3.0, "interval_95": [2.0, 4.0]}
    whole = Places([], [odd | {"specimen": name} for name in exports.names], [], [], [], none)
    assert "held back" not in set(
        statuses(SimpleNamespace(suspects=(), observed=exports), exports, whole)["status"]
    )


def test_a_limit_that_half_of_all_tests_exceed_makes_them_doubtful(exports):
    half = exports.size // 2
    none = Places([], [], [], [], [], np.zeros(exports.size, bool))
    for above, doubtful in ((half, half), (half - 1, 0)):
        uneven = replace(
            exports, quality={"phase_uniformity_deg": np.where(np.arange(exports.size) < above, 4.0, 2.0)}
        )
        record = statuses(SimpleNamespace(suspects=(), observed=uneven), uneven, none)
        assert (record["status"] == "doubtful").sum() == doubtful
