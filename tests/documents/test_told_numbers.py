"""Numbers in a sentence of docs/ that stands in place of a table are those of the published table."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from asphalt_nscd.forecasting.written import MISSED, WORTH
from asphalt_nscd.measurements.twopoint import PAPER, bending_share
from asphalt_nscd.rheology.reconstruct import Sampling

ROOT = Path(__file__).parents[2]


def published(table: str) -> pd.DataFrame:
    return pd.read_csv(ROOT / f"results/published/{table}.csv")


def page(name: str) -> str:
    return " ".join((ROOT / f"docs/{name}.md").read_text(encoding="utf-8").split())


def readme() -> str:
    return " ".join((ROOT / "README.md").read_text(encoding="utf-8").split())


def test_packings_of_another_program():
    over = published("benchmark/outside").set_index(["bonds", "poured_by"]).E_over_law
    facets = f"{over['facets'].min():.3f} to {over['facets'].max():.3f}"
    assert f"is {facets} of the law with both programs" in page("packings")
    ranges = {who: over["paper"][who] for who in ("LIGGGHTS", "this program")}
    told = [f"{values.min():.2f} to {values.max():.2f}" for values in ranges.values()]
    assert f"{told[0]} with LIGGGHTS and {told[1]} here" in page("packings")


def test_steps_that_are_solved_and_sweeps_that_stop_early():
    table = published("paper/time_steps")
    solved, sweeps = (table[table.scheme == scheme] for scheme in ("solved", "Gauss-Seidel"))
    text = page("results")
    assert solved.phase_difference_deg.abs().max() < 0.01 and (1 - solved.E_over_solution).max() <= 3e-4
    assert "same |E\\*| within 0.03 % and the same phase within 0.01°" in text
    least, most = 100 * sweeps.E_over_solution.min(), 100 * sweeps.E_over_solution.max()
    assert f"gives {least:.1f} to {most:.1f} % of that |E\\*| ({sweeps.spheres.iloc[0]:.0f} spheres" in text
    assert (
        f"take {sweeps.sweeps_per_step.min():.0f} to {sweeps.sweeps_per_step.max():.0f} sweeps a step" in text
    )
    explicit = table.set_index("scheme").time_step_s["explicit (DEM), longest"]
    assert round(5e-5 / explicit, -1) == 250 and "250 times that of an explicit DEM" in text


def test_no_bitumen_of_the_paper_s_grade_is_stiff_enough():
    table = published("forecast/paper_mix")
    there = table[table.temperature_C.between(10, 20)]
    assert (there.E_hard_MPa < there.E_table3_MPa).all() and not there.empty
    assert "no such bitumen makes a mix as stiff as Table 3 between 10 and 20 °C" in page("forecast")


def test_what_ncat_campaigns_share_and_what_not():
    text, table = page("machine"), published("attack/machine_measured").set_index("where")
    assert set(table.cause) == {"channel_delay"} and f"delay of {table.value['all campaigns']:.2f} ms" in text
    turned = 0.36 * table.value["all campaigns"] * np.array([10.0, 1.0])  # deg, of ms
    assert f"by {turned[0]:.2f}° at 10 Hz and by {turned[1]:.2f}° at 1 Hz" in text
    slow = table.loc["0.1 Hz"]
    off = (table.value["all campaigns"] - slow.value) / slow.std_error
    assert f"contradict it by {off:.1f} standard errors" in text
    ncat = published("measured/excess").query("population == 'ncat'")
    each = ncat.groupby(["mix", "temperature_C"]).isotherm_deg.first().unstack()
    told = " and ".join(f"{each[t].mean():.1f}" for t in (20.0, 40.0))
    assert f"by {each[4.0].mean():.1f}, {told} degrees at 4, 20 and 40" in text
    means = each.mean(axis=1)
    assert f"by {means.min():.1f} to {means.max():.1f} degrees in the mean of a mix" in text


def test_how_drawn_tables_and_calls_end():
    wild = published("fuzz/wild").set_index("what")
    diagnosed, refused, traceback, warned = wild.hits[
        ["diagnosed", "refused", "traceback", "numerical warning"]
    ]
    told = f"{diagnosed:.0f} were diagnosed and {refused:.0f} refused, none ended in a traceback, {warned:.0f} gave a"
    assert traceback == 0 and diagnosed + refused == wild.n["diagnosed"] and told in page("trust")
    calls = published("calls/calls").set_index("function").loc["all"]
    told = f"Of {calls.calls:.0f} calls {calls.result:.0f} ended in a result, {calls.sentence:.0f} in one sentence"
    assert calls.traceback == calls.no_end == 0
    assert f"{told}. The longest took {calls.cpu_s_largest:.0f} s of CPU" in page("core")


def test_no_reading_of_the_paper_is_possible_at_its_friction():
    table = published("paper/bond_readings")
    at_it = table[table.friction == 0.2]
    assert (
        not (at_it.empty or at_it.possible.any())
        and table.possible.any()
        and "None could be one" in page("results")
    )


def test_the_scatter_that_reconciles_tables_3_and_4():
    table = published("paper/smoothness")
    least = table.groupby("phase_weight").scatter_percent.max().min()
    assert len(table.phase_weight.unique()) == 4 and "four weights of the phase" in page("results")
    told = f"{least:.2f} % of |E\\*| or {np.degrees(least / 100):.2f}°"
    assert told in page("results") and told in readme()
    usual = Sampling(seed=0)
    drawn = [100 * usual.modulus_scatter / 2, usual.phase_scatter_deg / 2]
    assert usual.specimens == 4 and f"scatters by {drawn[0]:g} % and {drawn[1]:g}°" in page("results")


def test_how_stiff_the_mix_of_table_3_is():
    row = published("paper/audit").set_index("id").loc["level_of_table3"]
    assert f"[{row.ours} times]" in readme() and f"its |E\\*| is {row.ours} times" in page("results")
    stiffer = re.search(r"it is (\S+ to \S+) times as stiff", row.evidence)[1]
    assert f"and {stiffer} times that of a BBME of class 1" in page("results")


def test_errors_of_temperatures_that_were_left_out():
    table = published("paper/families")
    table = table[table.origin == "measured"]
    told = [
        f"{table[f'mre_{q}_held_out_percent'].min():.1f} to {table[f'mre_{q}_held_out_percent'].max():.1f} %"
        for q in ("E", "phase")
    ]
    assert f"measured mixes are missed by {told[0]} of |E\\*| and {told[1]} of the phase" in page("results")
    means = published("measured/means").set_index("rung").filter(like="left_out_isotherm").round(1)
    burgers, one_law = (means.loc[rung].tolist() for rung in ("burgers", "one_law"))
    said = (
        f"missed by {burgers[0]} and {burgers[1]} %, and by {one_law[0]} and {one_law[1]} %: outside the data"
    )
    assert said in page("results")


def test_what_the_results_say_of_samples():
    text, samples = page("results"), published("paper/samples")
    assert round(samples.spheres.mean(), -2) == 9400 and "about 9400 of which remain" in text
    assert (
        samples.largest_phase_difference_deg.max() < 0.1 and "The phase agrees to a tenth of a degree" in text
    )
    facets = published("paper/facets")
    assert np.abs(facets.E_MPa / facets.E_law_MPa - 1.0).max() < 2e-3 and "it is 1 within 0.2 %" in text
    factor = 1.0 / bending_share(PAPER, 0.0)
    assert f"a factor of {factor:.3f} from beam theory" in text
    cold = published("paper/ladder").set_index(["rung", "temperature_C"]).loc[("facets", -10)]
    assert f"phase of a single test scatters by {cold.scatter_phase_percent:.0f} %" in text
    drawn, printed = (published("paper/ensemble").iloc[0].filter(like=name) for name in ("mean", "burgers"))
    assert drawn.mean_E_percent < printed.burgers_E_percent
    assert (
        drawn.mean_phase_percent > printed.burgers_phase_percent and "the gain in the phase is gone" in text
    )


def test_what_a_percent_of_air_costs():
    mean = published("forecast/voids").iloc[-1]
    told = f"costs {-mean.forecast_percent:.1f} % of |E\\*| in the forecast and {-mean.measured_percent:.1f} % in"
    assert told in page("forecast")
    assert f"with a standard error of {mean.standard_error_percent:.1f} %" in page("forecast")


def test_a_bond_at_mid_gap_is_too_soft():
    table = published("mapping/mapping")
    there = table[(table.spheres == 14160) & (table["mapping"] == "facets at mid-gap")].E_over_law
    assert f"at mid-gap |E\\*| would be {100 * (1 - there.mean()):.0f} % too low" in page("mapping")


def test_no_row_of_the_verification_failed():
    assert (published("verification/verification").verdict == "passed").all()
    assert "Rows that passed; none failed:" in page("core")


def test_how_far_phases_are_off_where_nothing_was_tested():
    table = published("intervals/summary").set_index(["population", "at"]).xs("54.4 degC", level="at")
    drawn = table.loc[["invented", "usual", "thinned"]]
    off, half = drawn.phase_off_deg.round(1), drawn.phase_half_deg.round(1)
    told = f"by {off.invented}° in the median, those of `usual` ones by {off.usual}°"
    told += f" and of `thinned` ones by {off.thinned}°"
    assert f"{told}, at half-widths of {half.min()} to {half.max()}°" in page("trust")


def test_how_near_an_excess_can_be_found():
    percent = published("excess/summary").set_index("what").percent.round().astype(int)
    text = page("trust")
    for of, said in (
        ("that by the slope", "agrees in {} % of the isotherms, ours in {} %"),
        ("none", "within 0.3° of none it is in {} %, ours in {} %"),
    ):
        own = f"excess within 0.3 deg of {of}"
        assert said.format(percent[f"best possible {own}"], percent[own]) in text
    half, quarter = (percent[f"the same, with {less} times these errors"] for less in (0.5, 0.25))
    assert f"With half of these errors it would be in {half} %, with a quarter in {quarter} %" in text


def test_what_the_attack_finds_inside_runs():
    cases = published("attack/inside").query("suite == 'inside'")
    told = f"{cases.named.sum()} of {len(cases)} faults of three limits are named, none wrongly"
    assert f"{told}; {cases.covered.sum()} sizes" in page("trust") and not cases.wrong_names.notna().any()


def test_what_the_attack_finds():
    text, cases = page("trust"), published("attack/cases")
    found = cases[(cases.suite == "catalogue") & (cases.ratio == 3) & ~cases.measured]
    assert f"{found.named.sum()} of {len(found)} causes are named at three limits" in text
    both = cases[cases.suite == "pair"].groupby("table").named.agg(lambda named: named.astype(bool).all())
    assert f"of {len(both)} pairs both in {both.sum()}." in text
    place = cases[cases.suite == "place"].told.astype(bool)
    assert f"is told in {place.sum()} of {len(place)} cases" in text
    empty = cases[(cases.suite == "nothing") & ~cases.measured]
    told = f"empty tables none gets a name with confidence, and {empty.wrong_possible.sum()} a possible one"
    assert not empty.wrong_confident.any() and f"of {len(empty)} {told}" in text
    noted = cases[cases.fault == "wrong top frequency"].told
    assert f"told in {noted.sum()} of {len(noted)} tables" in text
    assert (
        not cases[cases.fault == "exchanged specimens"].told.any()
        and "at one temperature are not told" in text
    )
    measured = cases[cases.measured & (cases.suite == "catalogue")]
    missed = measured[~measured.named.astype(bool)]
    told = (
        f"the {len(missed)} causes of {len(measured)} that are missed are heights of specimens, at two limits"
    )
    assert {*missed.fault} == {"specimen_geometry"} and {*missed.ratio} == {2.0} and told in text
    sizes = published("attack/coverage").set_index("cause").loc["all"]
    assert f"{sizes.hits:.0f} of {sizes.n:.0f} are in their 95 % intervals" in text
    stated = published("attack/reliability").set_index("stated")
    assert f"above 95 %, {stated.hits['0.95 - 0.99']:.0f} of {stated.n['0.95 - 0.99']:.0f} names" in text
    for group, beside in (("0.7 - 0.9", " on average"), ("0.5 - 0.7", ""), ("0 - 0.5", "")):
        row = stated.loc[group]
        assert f"at {100 * row.mean_stated:.0f} %{beside}, {row.hits:.0f} of {row.n:.0f}" in text


def test_laws_of_measured_mixes():
    table = published("measured/means").set_index("rung")
    said = {rung: (f"{row.E_percent:.1f}", f"{row.phase_percent:.1f}") for rung, row in table.iterrows()}
    burgers, one_law, as_run = (said[rung] for rung in ("burgers", "one_law", "as_run"))
    assert f"by {burgers[0]} % of |E\\*| and {burgers[1]} % of the phase; one law for all temp" in readme()
    assert f"temperatures by {one_law[0]} and {one_law[1]} %" in readme()
    assert (
        f"error of a drifting haversine by {as_run[0]} and {as_run[1]} %, which fits nothing more" in readme()
    )
    out = table.left_out_isotherm_E_percent
    phase = table.left_out_isotherm_phase_percent
    told = " and ".join(
        f"{row.burgers:.1f}, {row.one_law:.1f} and {row.as_run:.1f} % of {what}"
        for row, what in ((out, "|E\\*|"), (phase, "the phase"))
    )
    assert f"miss by {told}: the third extrapolates worse" in readme()
    for missed in (out, phase):
        assert missed.as_run > max(missed.one_law, missed.phase_offset) and "extrapolates worse" in page(
            "measured"
        )
    rival = table.loc["phase_offset"]
    assert f"offset instead by {rival.E_percent:.1f} and {rival.phase_percent:.1f} %" in readme()
    assert table.phase_percent["as_run"] < table.phase_percent["phase_offset"]
    assert table.E_percent["as_run"] < 1.01 * table.E_percent["phase_offset"]


def test_what_explains_the_excess_phase():
    table = published("measured/budget").set_index(["population", "temperature_C"])
    assert table.index[table.verdict == "explained"].tolist() == [("ncat", 20.0)]
    assert (table.loc["mixes50"].verdict == "not").all()
    ncat, hot = table.loc["ncat"], table.loc["mixes50"].loc[37.8:]
    taken = 1.0 - ncat.loc[40.0, ["rms_less_reading_deg", "rms_less_all_deg"]] / ncat.rms_deg[40.0]
    assert f"takes {100 * taken.iloc[0]:.0f} % of the rms. With the other two it is a quarter" in page(
        "measured"
    )
    assert f"{100 * taken.iloc[0]:.0f} % of it at 40 °C" in readme() and 0.24 < taken.iloc[1] < 0.26
    assert f"(r = {ncat.correlation[40.0]:.1f})" in page("measured")
    high = ncat.reading_deg[4.0] - ncat.measured_deg[4.0]
    assert f"reading alone is {high:.2f}° too large" in page("measured")
    assert ncat.rms_less_all_deg[4.0] < ncat.rms_less_mean_deg[4.0]
    told = f"{ncat.contacts_deg[4.0]:.2f}, {ncat.contacts_deg[20.0]:.2f} and {ncat.contacts_deg[40.0]:.2f}° at 4, 20"
    assert told in page("measured")
    for column, verb in (
        ("weak_films_deg", "add"),
        ("rms_less_weak_films_deg", "leave"),
        ("rms_less_mean_deg", "leaves"),
    ):
        cold, warm, hottest = (f"{ncat[column][at]:.2f}" for at in (4.0, 20.0, 40.0))
        assert f"{verb} {cold}, {warm} and {hottest}°" in page("measured")
    both = ncat.reading_deg + ncat.weak_films_deg - ncat.measured_deg
    assert (both[[4.0, 20.0]] > 2.0 * ncat.standard_error_deg[[4.0, 20.0]]).all()
    assert f"{ncat.weak_films_deg[4.0]:.1f} to {ncat.weak_films_deg[40.0]:.1f}° if weaker" in readme()
    third = hot.weak_films_deg / hot.measured_deg
    assert 0.28 < third[37.8] < 0.36 and 0.22 < third[54.4] < 0.3
    share = hot.reading_deg / hot.measured_deg
    assert 0.15 < share[37.8] < 0.25 and share[54.4] < 0.05
    assert table.softening_deg.abs().max() < 0.1 and "below 0.1° everywhere" in page("measured")


def test_what_decides_the_sign_of_contacts():
    table, text = published("measured/sign").set_index(["haversine", "shear"]), page("measured")
    stiff, weak = (table.loc[(1, shear)] for shear in (1.0, 0.03))
    assert stiff.gain_percent > 0.0 > stiff.change_deg and abs(stiff.poisson) < 0.01
    assert weak.gain_percent < 0.0 < weak.change_deg and weak.cell_gain_percent > 0.0
    pulled = table.loc[(0, 1.0)]
    for part in ("gain", "loss"):
        assert pulled[f"{part}_percent"] == pytest.approx(pulled[f"cell_{part}_percent"], abs=1.0)
    told = f"from {stiff.cell_gain_percent:.0f} to {weak.cell_gain_percent:.0f} %"
    assert f"of what pressing gains in a cell, {told}" in text
    all_tests = published("measured/contacts")
    one = all_tests[
        (all_tests.E_MPa.round(-2) == 900) & (all_tests.exponent == 0.3) & (all_tests.shear == 0.03)
    ]
    others = one[(one.pressure_kPa != 10.0) | (one.friction != 0.5)].query("haversine == 1")
    assert len(others) == 2 and (others.change_deg > 0.0).all()


def test_strains_that_contradict():
    table = published("measured/amplitude")
    assert (table.contradicted == table.test.map({"uniaxial": "yes", "bending": "no"})).all()
    most = table[(table.test == "uniaxial") & (table.mechanism == "all")].iloc[0]
    assert most.measured_E_percent / most.predicted_E_percent > 10.0 and "factor of ten or more" in page(
        "measured"
    )


def test_verdicts_on_the_paper():
    verdicts = published("paper/audit").verdict.value_counts()
    untold = verdicts["left open"] + verdicts["cannot be checked"]
    told = (
        f"of {verdicts.sum()}, {verdicts.sum() - verdicts['not judged']} were taken up; {verdicts['holds']} hold, "
        f"{verdicts['reproduced']} are reproduced, {verdicts['inconsistent in itself']} contradict themselves, "
        f"{verdicts['differs']} differ from ours; {untold} stay open or cannot be checked"
    )
    assert told in readme() and verdicts.size == 7


def test_page_one_tells_the_forecast_of_mixes_that_set_nothing():
    six = published("forecast/mixes/overall").set_index("forecast")
    for begin, row in (("On six others it misses by", six.loc["forecast"]), ("Hirsch by", six.loc["hirsch"])):
        assert f"{begin} {row.factor_all:.2f} and {row.phase_all_deg:.1f}°" in readme()


def test_a_forecast_says_what_the_published_tables_say_of_it():
    blind = published("forecast/blind_overall").query("temperature_C == '4.4 to 54.4'").set_index("model")
    six = published("forecast/mixes/overall").set_index("forecast")
    mixes, others = MISSED.values()
    for told, row in zip(mixes, (blind.loc["forecast"], blind.loc["hirsch"]), strict=True):
        assert told == (round(row.factor, 2), round(row.phase_deg, 1))
    for told, row in zip(others, (six.loc["forecast"], six.loc["hirsch"]), strict=True):
        assert told == (round(row.factor_all, 2), round(row.phase_all_deg, 1))
    assert list(MISSED) == [f"{blind.mixes['forecast']} mixes", "six others"]
    assert (
        blind.loc["forecast", ["E_in_band", "phase_in_band"]] > 0.9
    ).all() and "nine in ten or more" in WORTH
