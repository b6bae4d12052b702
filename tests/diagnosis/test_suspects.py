"""Suspect tests: found within their own isotherm, whatever the majority says; broken isotherms are no suspects."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest
from scipy.stats import t as student

from asphalt_nscd.diagnosis.observed.observations import Observations
from asphalt_nscd.diagnosis.screening import suspects, within_isotherm
from asphalt_nscd.rheology.parabolic import TwoS2P1D
from asphalt_nscd.rheology.shift import WLF

FREQUENCIES = np.array([0.1, 0.5, 1.0, 5.0, 10.0, 25.0])
TEMPERATURES = np.array([4.0, 21.0, 37.0])
LAW = TwoS2P1D(86e6, 26e9, k=0.22, h=0.65, delta=2.5, tau=0.8, beta=43.0, shift=WLF(12.0, 120.0, 21.0))


def campaign(seed=0, scatter=(0.003, 0.1)):
    """Three specimens at three temperatures; scatter: relative of |E*|, and of the phase [deg]."""
    specimen, temperature, frequency = (
        values.ravel() for values in np.meshgrid(np.arange(3), TEMPERATURES, FREQUENCIES, indexing="ij")
    )
    random = np.random.default_rng(seed)
    level = random.normal(0.0, 0.05, 3)[specimen]
    noise = random.normal(0.0, scatter[0], specimen.size)
    noise = noise + 1j * random.normal(0.0, np.radians(scatter[1]), specimen.size)
    modulus = LAW.complex_modulus(2.0 * np.pi * frequency, temperature) * np.exp(level + noise)
    ones = np.ones(specimen.size)
    return Observations(specimen, ("A", "B", "C"), temperature, frequency, modulus, ones, 0.0 * ones)


def row_of(observed, specimen, temperature, frequency):
    match = (observed.specimen == specimen) & (observed.temperature == temperature)
    return int(np.flatnonzero(match & (observed.frequency == frequency))[0])


def altered(observed, rows, modulus=0.0, phase_deg=0.0):
    """ln|E*| and phase changed by that much in some rows."""
    change = np.zeros(observed.size, complex)
    change[rows] = modulus + 1j * np.radians(phase_deg)
    return replace(observed, modulus=observed.modulus * np.exp(change))


def out(observed):
    return [one.row for one in suspects.find(observed) if not one.used]


@pytest.mark.parametrize("seed", range(6, 12))
def test_clean_campaign_loses_no_test(seed):
    observed = campaign(seed)
    found = suspects.find(observed)
    # In two of these tables one value of all 108 lies as far from its replicates as one of 200 does by chance.
    assert all(one.used and "replicate" not in " ".join(one.reasons) for one in found)
    assert not suspects.broken_isotherms(observed)


@pytest.mark.parametrize("frequency", FREQUENCIES[1:])  # 0.1 Hz has a decade without neighbours on one side
@pytest.mark.parametrize("change", [{"phase_deg": 5.0}, {"phase_deg": -5.0}, {"modulus": np.log(0.8)}])
def test_single_fault_is_found_and_nothing_else(frequency, change):
    observed = campaign()
    row = row_of(observed, 1, 4.0, frequency)
    assert out(altered(observed, row, **change)) == [row]


def test_majority_is_no_witness():
    observed = campaign()
    wrong = [row_of(observed, specimen, 4.0, 25.0) for specimen in (0, 2)]
    found = suspects.find(altered(observed, wrong, phase_deg=5.0))
    assert [one.row for one in found if not one.used] == wrong
    right = row_of(observed, 1, 4.0, 25.0)
    assert all(one.used for one in found if one.row == right)


def test_contradiction_that_all_specimens_share_is_no_single_test():
    observed = campaign()
    rows = [row_of(observed, specimen, 4.0, 5.0) for specimen in range(3)]
    found = suspects.find(altered(observed, rows, phase_deg=-4.0))
    assert [one.row for one in found] == rows
    assert all(one.used and suspects.SHARED in one.reasons for one in found)


def delayed(observed, delay, rows=slice(None)):
    """The same with a delay [s] between the channels in some rows."""
    return altered(observed, rows, phase_deg=360.0 * delay * observed.frequency[rows])


@pytest.mark.parametrize("delay", [-1.7e-3, -0.8e-3, 0.8e-3, 1.7e-3])
def test_delay_neither_hides_a_fault_of_the_majority_nor_moves_it(delay):
    observed = campaign()
    wrong = [row_of(observed, specimen, 4.0, 25.0) for specimen in (0, 2)]
    found = suspects.find(delayed(altered(observed, wrong, phase_deg=4.0), delay))
    assert [one.row for one in found if not one.used] == wrong
    reason = next(reason for reason in found[0].reasons if reason.startswith("phase "))
    assert "; both phases as recorded, with the delay)" in reason
    required = float(reason.split(" expected ")[1].split(" deg")[0])
    right = np.degrees(observed.logarithm.imag[wrong[0]]) + 360.0 * delay * 25.0
    assert required == pytest.approx(right, abs=1.5)


def test_delay_is_that_of_all_isotherms_or_none():
    observed = campaign()
    assert within_isotherm.leave_one_out(observed).delay == 0.0
    assert within_isotherm.leave_one_out(delayed(observed, 1e-3)).delay == pytest.approx(1e-3, rel=0.1)
    assert within_isotherm.leave_one_out(delayed(observed, 1e-3, observed.specimen == 1)).delay == 0.0
    assert within_isotherm.leave_one_out(delayed(observed, 1e-3, observed.temperature == 4.0)).delay == 0.0


def test_specimen_that_differs_as_a_whole_is_no_suspect():
    observed = campaign()
    assert not out(altered(observed, observed.specimen == 1, modulus=-0.3, phase_deg=1.0))


def test_isotherm_that_breaks_as_a_whole_is_reported_and_its_tests_are_used():
    observed = campaign()
    hot = observed.temperature == 37.0
    departure = -12.0 * (np.log(observed.frequency / 0.1) / np.log(250.0)) ** 2
    broken = altered(observed, hot, phase_deg=departure[hot])
    assert not out(broken)
    (found,) = suspects.broken_isotherms(broken)
    assert found.temperature == 37.0 and found.specimens == 3
    assert found.difference[-1] == pytest.approx(-12.0, abs=2.0)
    assert "deg below it at 25 Hz (mean of 3 specimens)" in found.sentence


def test_isotherm_without_any_order_is_broken_and_no_list_of_suspects():
    observed = campaign()
    hot = observed.temperature == 37.0
    wild = np.array([0.0, 4.0, -6.0, 8.0, -10.0, -20.0])[np.searchsorted(FREQUENCIES, observed.frequency)]
    wild *= np.array([1.0, 0.7, -0.8])[observed.specimen]
    broken = altered(observed, hot, phase_deg=wild[hot])
    assert not out(broken)
    assert [one.temperature for one in suspects.broken_isotherms(broken)] == [37.0]


def test_of_an_isotherm_that_is_torn_from_the_others_less_evidence_is_asked():
    """Three tests are too few to break by themselves; 6 deg of a torn one are enough, 2 deg are not."""
    whole = campaign()
    few = whole.subset(np.flatnonzero(np.isin(whole.frequency, (0.1, 1.0, 10.0))))
    hot = few.temperature == 37.0
    for degrees, torn, expected in (
        (-6.0, (), []),
        (-6.0, (37.0,), [37.0]),
        (-2.0, (37.0,), []),
        (-6.0, (4.0,), []),
    ):
        turned = altered(few, hot, phase_deg=degrees)
        assert [one.temperature for one in suspects.broken_isotherms(turned, torn=torn)] == expected


def test_fault_in_a_cold_isotherm_is_found_beside_a_broken_hot_one():
    observed = campaign()
    hot = observed.temperature == 37.0
    departure = -12.0 * (np.log(observed.frequency / 0.1) / np.log(250.0)) ** 2
    row = row_of(observed, 0, 4.0, 1.0)
    assert out(altered(altered(observed, hot, phase_deg=departure[hot]), row, phase_deg=4.0)) == [row]


def flagged(observed, rows, value=7.9):
    column = np.full(observed.size, 0.5)
    column[rows] = value
    return replace(observed, quality={"phase_uniformity_deg": column})


def test_quality_flag_alone_is_listed_and_the_test_used():
    observed = campaign()
    row = row_of(observed, 1, 4.0, 25.0)
    (found,) = suspects.find(flagged(observed, row))
    assert found == suspects.Suspect(
        row,
        ("phase uniformity 7.9 deg (limit 3)", suspects.ONE_WITNESS),
        True,
    )


def test_of_one_specimen_a_flag_and_causality_take_a_test_out():
    observed = campaign(3, scatter=(0.01, 0.3))
    observed = observed.subset(observed.specimen == 1)
    row = row_of(observed, 1, 4.0, 25.0)
    doubtful = altered(observed, row, phase_deg=4.0)
    assert not out(doubtful)
    (found,) = suspects.find(flagged(doubtful, row))
    assert not found.used
    assert ", expected " in found.reasons[0] and "phase uniformity" in found.reasons[1]
    (found,) = suspects.find(flagged(observed, row))
    assert found.used and found.reasons[-1] == suspects.ONE_WITNESS


def test_quality_flag_turns_a_doubt_into_a_reason_to_drop():
    observed = campaign(scatter=(0.01, 0.3))
    row = row_of(observed, 1, 21.0, 1.0)
    doubtful = altered(observed, row, phase_deg=1.5)
    assert row not in out(doubtful)
    assert out(flagged(doubtful, row)) == [row]


def test_replicates_alone_take_no_test_out():
    # At the end of the band the isotherm leaves the phase open by more than a degree.
    observed = campaign()
    row = row_of(observed, 1, 4.0, 0.1)
    (found,) = suspects.find(altered(observed, row, phase_deg=-2.0))
    assert found.row == row and found.used
    assert "phase differs from 2 replicates by" in found.reasons[-1]


def test_replicates_that_find_a_test_in_place_ask_causality_for_more(monkeypatch):
    observed = campaign(scatter=(0.01, 0.3))
    row = row_of(observed, 1, 21.0, 5.0)
    others = [row_of(observed, specimen, 21.0, 5.0) for specimen in (0, 2)]
    # just enough where the replicates say so too
    enough = next(
        size for size in np.linspace(0.03, 0.15, 25) if out(altered(observed, [row], size)) == [row]
    )
    assert row not in out(altered(altered(observed, [row], enough), others, 0.7 * enough))
    in_place = np.full((observed.size, 2), 1e-9), np.ones((observed.size, 2))
    monkeypatch.setattr(suspects, "_replicate_distance", lambda *_: in_place)
    assert not out(altered(observed, [row], enough)) and out(altered(observed, [row], 2.0 * enough)) == [row]


def test_table_holds_what_the_map_shows():
    observed = campaign()
    row = row_of(observed, 1, 4.0, 25.0)
    faulty = flagged(altered(observed, row, phase_deg=5.0), row)
    loo = within_isotherm.leave_one_out(faulty)
    record = pd.DataFrame({"status": "used", "reasons": [[]] * faulty.size})
    table = suspects.table(faulty, record, loo)
    assert table.index[table["quality_flag"] == 1].tolist() == [row]
    left = (table["phase_deg"] - table["phase_required_deg"]).drop(row)
    assert left.abs().median() < 0.5 and (left.abs() < 4.0 * table["std_error_deg"].drop(row)).all()
    assert table["phase_deg"][row] - table["phase_required_deg"][row] > 3.0


def test_replicates_judge_a_test_that_they_have_not_seen():
    """By least squares on levels and conditions without the test: what it lies off, in scatter of such a prediction."""
    observed = campaign(scatter=(0.01, 0.3))
    observed = altered(observed, row := row_of(observed, 1, 21.0, 5.0), 0.05, 1.0)
    everything = np.ones(observed.size, bool)
    apart, chance = suspects._replicate_distance(observed, everything)
    own, z = [], []
    for one in np.flatnonzero(observed.temperature == 21.0):
        here = np.flatnonzero(observed.temperature == 21.0)
        levels = (observed.specimen[here, None] == np.arange(3)).astype(float)
        design = np.hstack([levels, (observed.frequency[here, None] == FREQUENCIES).astype(float)])
        rest = here != one
        for column, value in enumerate((observed.logarithm.real, observed.logarithm.imag)):
            best = np.linalg.lstsq(design[rest], value[here][rest], rcond=None)[0]
            off = (value[here] - design @ best)[~rest][0]
            assert apart[one, column] == pytest.approx(off, abs=1e-12)
            if one == row:
                left = value[here][rest] - design[rest] @ best
                wide = (
                    1.0 + design[~rest][0] @ np.linalg.pinv(design[rest].T @ design[rest]) @ design[~rest][0]
                )
                own.append(np.sqrt(left @ left / 9.0 * wide))  # 17 tests less 8 that are fitted
                z.append(off)
    tables = [observed.temperature == t for t in TEMPERATURES]
    usual = []
    for here in tables:
        every = observed.logarithm[here].reshape(3, -1)
        every = every - every.mean(axis=0) - every.mean(axis=1, keepdims=True) + every.mean()
        usual.append(np.sqrt([(every.real**2).sum() / 10.0, (every.imag**2).sum() / 10.0]))
    error = np.maximum(own, np.median(usual, axis=0) / np.sqrt(1.0 - 8.0 / 18.0))
    assert chance[row] == pytest.approx(2.0 * student(30).sf(np.abs(z) / error))
    alone, one = suspects._replicate_distance(observed, observed.specimen > 0)  # two are no replicates
    assert not alone.any() and (one == 1.0).all()


@pytest.mark.parametrize(("above", "accused"), [(2, True), (3, False)])
def test_a_limit_singles_out_tests_of_a_sweep_less_than_half_of_which_exceed_it(above, accused):
    observed = campaign()
    found = suspects._singled_out(flagged(observed, np.arange(above)))
    assert [bool(one) for one in found] == [accused and row < above for row in range(observed.size)]


def test_a_broken_isotherm_is_told_by_means_over_its_specimens(monkeypatch):
    """Phase measured less required at each frequency; its error of the single ones, and of the scatter of a test."""
    observed = campaign()
    loo = within_isotherm.leave_one_out(observed)
    required = observed.logarithm.imag - np.radians(observed.specimen + 1.0)
    monkeypatch.setattr(
        suspects, "_required", lambda *_: (required, np.radians(0.4) * (1.0 + observed.specimen))
    )
    monkeypatch.setattr(suspects, "_broken_temperatures", lambda *_: np.array([21.0]))
    loo.scatter[:, 1] = np.radians(0.3)
    loo.exchanged = (SimpleNamespace(rows=(row_of(observed, 2, 21.0, 5.0),)),)
    (found,) = suspects.broken_isotherms(observed, loo)
    assert found.difference == pytest.approx([2.0, 2.0, 2.0, 1.5, 2.0, 2.0]) and found.specimens == 3
    errors = np.hypot([0.4, 0.8, 1.2], 0.3)
    assert found.std_error[0] == pytest.approx(np.sqrt(errors @ errors) / 3.0)
    assert found.std_error[3] == pytest.approx(np.sqrt(errors[:2] @ errors[:2]) / 2.0)


@pytest.mark.parametrize(
    ("difference", "error", "contradicts"),
    [
        ([-2.0, -4.2], [1.0, 1.0], True),
        ([-2.0, -3.9], [1.0, 1.0], False),
        ([4.0, 4.0], [1.0, 4.6], False),
        ([4.0, 4.4], [1.0, 4.4], True),
        ([], [], False),
    ],
)
def test_a_torn_isotherm_contradicts_itself_from_3_degrees_and_1_5_errors_of_its_mean(
    difference, error, contradicts
):
    assert suspects._contradicts(np.array(difference), np.array(error)) is contradicts


def test_an_isotherm_is_broken_if_all_specimens_together_say_so():
    """Each as likely to depart by 15 deg as not at all; the prior is for none, and three specimens outweigh it."""
    observed = campaign()
    loo = within_isotherm.leave_one_out(observed)
    for evidence, broken in ((2.5, [21.0]), (2.4, [])):
        loo.log_evidence[:] = np.where(np.arange(5) < 2, 0.0, -60.0)
        loo.log_evidence[observed.temperature == 21.0] = [0.0, 0.0, -60.0, -60.0, evidence]
        share = 0.05 * np.exp(3.0 * evidence) / (0.78 + 0.05 * np.exp(3.0 * evidence))
        assert (share > 0.98) and bool(share > 0.99) is bool(broken)
        assert suspects._broken_temperatures(observed, loo).tolist() == broken


def test_a_modulus_off_its_replicates_is_told_in_percent_of_theirs():
    """ln|E*| 0.36 below is 30 %, and 0.26 above is 30 % too."""
    observed = SimpleNamespace(cell=np.zeros(3, int))
    for times in (0.7, 1.3):
        apart = np.array([[np.log(times), 0.0]] * 3)
        assert " from 2 replicates by 30.0 %," in suspects._replicate_reason(observed, apart, 0, 0)
