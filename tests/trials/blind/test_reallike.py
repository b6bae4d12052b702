"""Real-like tables hold what their kind says, in the size it says, and no table is like another."""

import json

import numpy as np
import pandas as pd
import pytest
from blind import reallike
from blind.backgrounds import Background
from blind.laws import Law

SEEDS = range(12)


def departure(background: Background) -> pd.DataFrame:
    """The tests, with ln of measured over law: `modulus`, and `phase` [deg]."""
    table = background.table
    omega = 2.0 * np.pi * table["frequency_Hz"].to_numpy()
    left = np.log(background.modulus / background.law.modulus(omega, table["temperature_C"].to_numpy()))
    return table.assign(modulus=left.real, phase=np.degrees(left.imag))


def added(seed: int, kind: str) -> pd.DataFrame:
    """What a kind adds to the same table with scatter only: same mix, design, scatter and missing tests."""
    plain, own = (departure(reallike.draw(seed, name)[0]) for name in ("scatter", kind))
    return own.assign(modulus=own["modulus"] - plain["modulus"], phase=own["phase"] - plain["phase"])


@pytest.mark.parametrize("kind", reallike.KINDS)
def test_one_seed_one_table_and_a_seal_that_json_keeps(kind):
    (one, seal), (same, again), (other, _) = (reallike.draw(seed, kind) for seed in (5, 5, 6))
    pd.testing.assert_frame_equal(one.table, same.table)
    assert seal == again == json.loads(json.dumps(seal))
    assert not one.table["E_MPa"].equals(other.table["E_MPa"])
    assert one.known_law == Law(**seal["law"])


@pytest.mark.parametrize("kind", reallike.KINDS)
def test_designs_are_small_and_some_tests_are_missing(kind):
    missing = 0
    for seed in SEEDS:
        table = reallike.draw(seed, kind)[0].table
        counts = [table[name].nunique() for name in ("specimen", "temperature_C", "frequency_Hz")]
        assert 2 <= counts[0] <= 4 and 3 <= counts[1] <= 6
        assert len(table) >= 0.88 * np.prod(counts) - 1
        assert table.groupby(["specimen", "temperature_C"]).size().min() >= reallike.LEAST_LEFT
        missing += len(table) < np.prod(counts)
        assert table["phase_deg"].between(*reallike.PHASES).all() and (table["E_MPa"] > 1.0).all()
    assert missing > len(SEEDS) / 2


def test_hooks_are_five_degrees_at_the_highest_frequency_of_cold_isotherms_in_most_specimens():
    for seed in SEEDS:
        table = added(seed, "hooks")
        hit = table["phase"].abs() > 1e-9
        cold, most = np.sort(table["temperature_C"].unique())[:2], table["frequency_Hz"].max()
        assert table[hit]["temperature_C"].isin(cold).all() and (table[hit]["frequency_Hz"] == most).all()
        assert 2.0 < table[hit]["phase"].min() and table[hit]["phase"].max() < 8.0
        at = table[(table["frequency_Hz"] == most) & (table["temperature_C"] == cold[0])]
        assert len(at) - 1 <= hit[at.index].sum() and np.abs(table["modulus"]).max() < 1e-9


def test_a_broken_isotherm_is_hot_steeper_and_loses_phase_with_frequency():
    for seed in SEEDS:
        table = added(seed, "broken_hot")
        temperature = table["temperature_C"]
        assert np.abs(table.loc[temperature < np.sort(temperature.unique())[-2], "phase"]).max() < 1e-9
        hottest = table[temperature == temperature.max()].sort_values("frequency_Hz")
        assert hottest["modulus"].iloc[-1] > 0.05 > -0.05 > hottest["modulus"].iloc[0]
        assert hottest["phase"].iloc[-1] < -4.0 and hottest["phase"].iloc[0] > -1.0


def test_a_gain_step_is_the_same_at_every_temperature_and_leaves_the_phase():
    for seed in SEEDS:
        table = added(seed, "gain_step")
        assert np.abs(table["phase"]).max() < 1e-9
        levels = table.groupby("frequency_Hz")["modulus"].agg(["min", "max"])
        assert (levels["max"] - levels["min"]).max() < 1e-9
        assert 0.09 < np.abs(levels["max"]).max() < 0.23 and (np.abs(levels["max"]) < 1e-9).any()


def test_an_odd_specimen_is_soft_and_its_phase_is_larger_by_a_fifth():
    for seed in SEEDS:
        table, odd = added(seed, "odd_specimen"), reallike.draw(seed, "odd_specimen")[1]["odd"]
        own = table["specimen"] == odd
        assert np.exp(table.loc[own, "modulus"]).between(0.55, 0.7).all()
        assert np.abs(table.loc[~own, ["modulus", "phase"]].to_numpy()).max() < 1e-9
        law = (
            table.loc[own, "phase_deg"] - departure(reallike.draw(seed, "odd_specimen")[0]).loc[own, "phase"]
        )
        assert table.loc[own, "phase"].to_numpy() == pytest.approx(0.2 * law.to_numpy(), rel=1e-6)


def test_heavy_tails_hit_a_few_tests_hard():
    share = [
        (added(seed, "heavy_tails")[["modulus", "phase"]].abs() > 1e-9).any(axis=1).mean() for seed in SEEDS
    ]
    assert 0.03 < np.mean(share) < 0.12
    largest = max(added(seed, "heavy_tails")["phase"].abs().max() for seed in SEEDS)
    assert largest > 3.0


def test_discrepancies_are_common_to_the_specimens_and_of_several_families():
    seals = [reallike.draw(seed, "rough")[1] for seed in SEEDS]
    assert {seal["family"] for seal in seals} == set(reallike.FAMILIES)
    for seed in SEEDS:
        table = added(seed, "rough")
        cells = table.groupby(["temperature_C", "frequency_Hz"])[["modulus", "phase"]]
        assert (cells.max() - cells.min()).to_numpy().max() < 1e-9
        assert 0.005 < table["modulus"].std() < 0.15


def test_a_specimen_keeps_a_few_tests_on_each_isotherm_however_many_are_missing(monkeypatch):
    monkeypatch.setattr(reallike, "MOST_MISSING", 1.0)
    left = [
        reallike.draw(s, "scatter")[0].table.groupby(["specimen", "temperature_C"]).size().min()
        for s in SEEDS
    ]
    assert min(left) == reallike.LEAST_LEFT


def test_columns_that_a_cause_needs_are_there():
    table = reallike.draw(3, "scatter", ("amplitude_m", "cycles"))[0].table
    assert table["amplitude_m"].nunique() == 2 and table["cycles"].nunique() > 2
    assert not {"amplitude_m", "cycles"} & set(reallike.draw(3, "scatter")[0].table)
