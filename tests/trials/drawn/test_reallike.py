"""What real tables show, in the size that is said."""

import numpy as np
import pandas as pd
from drawn.design import factorial
from drawn.reallike import KINDS, Sizes

SEEDS = range(12)
SIZES = Sizes(0.01, np.radians(0.3), 0.04, 0.01)
DESIGN = factorial("ABC", (-10.0, 4.0, 21.0, 37.0), (0.1, 0.5, 1.0, 5.0, 10.0, 25.0))


def added(seed: int, kind: str) -> pd.DataFrame:
    """The tests with what a kind adds: `modulus`, of ln|E*|, and `phase` [deg]."""
    logarithm = np.asarray(KINDS[kind](DESIGN, SIZES, np.random.default_rng(seed)), complex)
    return DESIGN.assign(modulus=logarithm.real, phase=np.degrees(logarithm.imag))


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
