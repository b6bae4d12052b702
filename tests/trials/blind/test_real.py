"""The part `real` of the campaign: what it plans, how it scores, and that nothing of a real table gets out."""

import json
from collections import Counter
from itertools import chain

import numpy as np
import pandas as pd
import pytest
from blind import real, real_plan, real_score, real_tables, reallike, sealed
from blind.backgrounds import Background
from blind.causes import CATALOGUE

UNIT = {"phase_offset": "deg", "channel_delay": "s", "temperature_bias": "K", "loose_clamp": "1/Pa"}


def rung(cause, value=1.0, error=0.1, where=None, **more):
    return {
        "cause": cause,
        "where": where,
        "parameters": {"size": {"value": value, "std_error": error, "unit": UNIT[cause]}},
    } | more


def diagnosis(*ladder, verdict="unexplained_structure", limits=None, estimates=None):
    return {
        "verdict": verdict,
        "ladder": [{"cause": "relaxation_spectrum", "where": None}, *ladder],
        "indistinguishable": [],
        "detection_limits": limits or {},
        "cpu_s": 0.1,
    } | ({"estimates": estimates} if estimates else {})


def effect(cause="phase_offset", amplitude=3.0, where=None):
    return {
        "cause": cause,
        "where": where,
        "amplitude": amplitude,
        "unit": UNIT[cause],
        "equivalents": {UNIT[cause]: amplitude},
    }


def own(value, cause="phase_offset", place="all"):
    estimate = {"value": value, "std_error": 0.2, "unit": UNIT[cause]}
    return {cause: {"places": {place: estimate}}}


def scored(before, after, hidden=None):
    hidden = hidden or effect()
    return real_score.row(hidden, hidden["unit"], 1.0, before, after)


def test_the_size_is_judged_after_the_own_value_of_the_table_is_taken_off():
    before = diagnosis(estimates=own(2.2))
    row = scored(before, diagnosis(rung("phase_offset", 5.15, 0.2, established=True)))
    assert (
        row["named"] and row["established"] and row["covered"] and row["error_sigma"] == pytest.approx(-0.25)
    )
    assert row["own_over_limit"] == pytest.approx(2.2)
    assert not scored(before, diagnosis(rung("phase_offset", 3.0, 0.2, established=True)))["covered"]
    assert scored(diagnosis(), diagnosis(rung("phase_offset", 3.0, 0.2)))["covered"]
    # Of the wrong sign, named or not.
    assert not scored(diagnosis(), diagnosis(rung("phase_offset", -3.0, 0.2)))["covered"]


def test_the_own_value_is_that_of_the_same_tests():
    """A bad test set aside before, and used after, is no part of what was put in."""
    before, alike = diagnosis(estimates=own(0.1)), diagnosis(estimates=own(1.6))
    hidden = effect()
    after = diagnosis(rung("phase_offset", 4.6, 0.2, established=True))
    row = real_score.row(hidden, hidden["unit"], 1.0, before, after, alike=alike)
    assert not row["covered"] and row["error_sigma"] == pytest.approx(7.5)
    assert row["covered_alike"] and row["error_sigma_alike"] == pytest.approx(0.0)
    after = diagnosis(rung("phase_offset", 3.1, 0.2, established=True))
    row = real_score.row(hidden, hidden["unit"], 1.0, before, after, alike=alike)
    assert row["covered"] and not row["covered_alike"]


def test_the_own_value_is_that_beside_the_same_causes(monkeypatch):
    """A table that is told another cause in the place of an offset has none; without that cause it has one of 0.7."""
    task = real_plan.Task("N", "real", ("phase_offset",), str(real_plan.real_tables()[0]))
    base = Background.read(task.path)

    def told(table, geometry, removed=(), **more):
        turned = float(np.degrees(np.angle(Background(table).modulus / base.modulus)).mean())
        if abs(turned) > 0.5:
            return diagnosis(rung("phase_offset", turned + 0.7, 0.1), limits=LIMITS)
        if "channel_delay" in removed:
            assert set(removed) == real.NAMEABLE - {"phase_offset"}
            return diagnosis(estimates=own(0.7))
        return diagnosis(rung("channel_delay"), limits=LIMITS, estimates=own(0.0))

    monkeypatch.setattr(sealed, "open_case", told)
    rows = [row for row in real.run([task]) if row["cause"] == "phase_offset"]
    assert {(row["covered"], row["covered_alike"]) for row in rows} == {(False, True)}


def test_tests_that_were_left_out_are_taken_from_the_table():
    tests = [("A", 4.0, 25.0, False), ("A", 21.0, 25.0, True)]
    names = ("specimen", "temperature_C", "frequency_Hz", "used")
    found = {"suspect_tests": [dict(zip(names, one, strict=True)) for one in tests]}
    gone = real_score.left_out(found)
    assert gone == {("A", 4.0, 25.0)}
    table = pd.DataFrame(
        [(s, t, f, 9e3, 15.0) for s in "AB" for t in (4.1, 21.0) for f in (10.0, 25.0)],
        columns=["specimen", "temperature_C", "frequency_Hz", "E_MPa", "phase_deg"],
    )
    left = Background(table).without(gone)
    assert (
        len(left) == 7
        and not ((left.specimen == "A") & (left.temperature_C < 5) & (left.frequency_Hz > 20)).any()
    )


def test_an_interval_that_is_not_symmetric_is_used():
    entry = rung("phase_offset", 3.5, 0.1)
    entry["parameters"]["size"]["interval_95"] = [2.9, 3.7]
    assert scored(diagnosis(), diagnosis(entry))["covered"]


def test_confidence_is_the_rungs_own_or_of_the_whole_diagnosis():
    told = rung("phase_offset", 3.0)
    for verdict, flag, sure in (
        ("explained", {}, True),
        ("unexplained_structure", {}, False),
        ("unexplained_structure", {"established": True}, True),
        ("explained", {"established": False}, False),
    ):
        row = scored(diagnosis(), diagnosis(told | flag, verdict=verdict))
        assert row["named"] and row["established"] == sure


def test_only_confident_names_that_were_not_there_before_are_false():
    before = diagnosis(rung("channel_delay"))
    after = diagnosis(
        rung("channel_delay", established=True), rung("temperature_bias", where=10.0, established=True)
    )
    row = scored(before, after)
    assert (
        row["added"] == 1 and row["instead"] and not row["named"] and row["wrong_names"] == "temperature_bias"
    )
    row = scored(before, diagnosis(rung("temperature_bias", where=10.0, established=False)))
    assert row["added"] == 0 and not row["instead"]
    row = scored(
        before,
        diagnosis(rung("phase_offset", established=True), rung("loose_clamp", where="B", established=True)),
    )
    assert row["added"] == 1 and row["named"] and not row["instead"]


def test_the_right_cause_in_the_wrong_place_is_not_right():
    hidden = effect("temperature_bias", 1.0, where=21.0)
    wrong = scored(diagnosis(), diagnosis(rung("temperature_bias", where=4.0, established=True)), hidden)
    assert wrong["elsewhere"] and wrong["instead"] and not wrong["named"]
    right = scored(diagnosis(), diagnosis(rung("temperature_bias", where="21", established=True)), hidden)
    assert right["named"] and not right["elsewhere"] and right["added"] == 0


def test_names_of_a_bare_table_are_false_but_for_the_odd_specimens_size():
    geometry = {"cause": "specimen_geometry", "where": "S2", "parameters": {}, "established": True}
    found = diagnosis(geometry, rung("phase_offset", established=True), rung("channel_delay"))
    assert real_score.untouched(found)["wrong"] == 2 and real_score.untouched(found)["any_name"] == 3
    row = real_score.untouched(found, odd="S2")
    assert row["wrong"] == 1 and row["odd_named"] and row["wrong_names"] == "phase_offset"
    assert real_score.untouched(found, odd="S1")["wrong"] == 2
    hidden = effect("channel_delay", 1e-3)
    arguments = (hidden, "s", 1e-4, diagnosis(), diagnosis(geometry, rung("channel_delay")))
    assert [real_score.row(*arguments, odd)["added"] for odd in ("S2", "S1", None)] == [0, 1, 1]


def test_plan_holds_every_cause_and_every_kind(monkeypatch):
    monkeypatch.delenv(real_plan.FOLDER, raising=False)
    tasks = list(chain.from_iterable(real_plan.tasks()))
    shipped = [task for task in tasks if task.path]
    tasks = [task for task in tasks if not task.path]
    assert len(real_plan.real_tables()) == len({task.alias for task in shipped}) == 9  # the states of NCAT
    assert {Background.read(path).test_type for path in real_plan.real_tables()} == {"tension-compression"}
    assert Counter(chain.from_iterable(task.causes for task in shipped)) == dict.fromkeys(real_plan.CAUSES, 9)
    assert set(real_plan.CAUSES) == set(CATALOGUE) - {"guide_stiffness"}
    hidden = Counter(chain.from_iterable(task.causes for task in tasks))
    assert set(hidden) == set(real_plan.CAUSES) and min(hidden.values()) >= 4
    kinds = Counter(task.kind for task in tasks if not task.causes)
    assert set(kinds) == set(reallike.KINDS) and min(kinds.values()) == real_plan.BARE_OF_A_KIND
    assert len({task.seed for task in tasks}) == len(tasks) == len({task.alias for task in tasks})


def own_tasks():
    """Those of tables that are not shipped."""
    return [task for task in chain.from_iterable(real_plan.tasks()) if task.alias.startswith("real table")]


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """A folder with a table that stands for a real one, and a file that is none."""
    table = reallike.draw(1, "scatter")[0].table
    table.assign(specimen="secret " + table["specimen"]).to_csv(tmp_path / "mine.csv", index=False)
    (tmp_path / "export_Sum.csv").write_bytes("Prüfmaschine;°C\n".encode("latin-1"))
    monkeypatch.setenv(real_plan.FOLDER, str(tmp_path))
    return tmp_path


def test_without_a_real_table_its_criteria_are_not_tried():
    table = real_tables.cases(
        [{"table": "drawn table 1", "kind": "scatter", "cause": "nothing", "wrong": 0, "any_name": 0}]
    )
    met = real_tables.summary(table).set_index("what")["met"]
    assert met["real tables, offset and delay at 3 and 6 limits: named"] == "not tried"
    assert met["tables without a cause: misnamed with confidence"] == "yes"


def test_real_tables_get_every_cause_once_with_both_signs(folder):
    assert [path.name for path in real_plan.real_tables()[9:]] == ["mine.csv"]
    tasks = own_tasks()
    assert sorted(chain.from_iterable(task.causes for task in tasks)) == sorted(real_plan.CAUSES)
    assert all(task.both_signs for task in tasks) and sum(task.counted for task in tasks) == 1


LIMITS = {
    "phase_offset": {"value": 1.0, "unit": "deg"},
    "channel_delay": {"value": 1e-4, "unit": "s"},
    "moving_mass": {"value": 0.09, "unit": "kg"},
}


def perfect(table, geometry, removed=(), test_type="bending", use_suspects=False):
    """A diagnosis that measures an offset by what it knows of the untouched table."""
    base = Background.read(real_plan.real_tables()[-1])
    turned = np.degrees(np.angle(Background(table).modulus / base.modulus))
    if np.ptp(turned) > 1e-9 or abs(turned[0]) < 0.5:
        return diagnosis(limits=LIMITS)
    return diagnosis(rung("phase_offset", float(turned[0]), 0.1, established=True), limits=LIMITS)


def test_rows_of_a_real_table_hold_rates_and_nothing_of_the_table(folder, monkeypatch, tmp_path):
    monkeypatch.setattr(sealed, "open_case", perfect)
    rows = list(real.run(own_tasks()))
    offsets = [row for row in rows if row["cause"] == "phase_offset"]
    assert {(row["ratio"], row["sign"]) for row in offsets} == {
        (r, s) for r in (1.0, 2.0, 3.0, 5.0, 6.0) for s in (-1, 1)
    }
    assert all(row["named"] and row["covered"] for row in offsets)
    assert {
        row["ratio"]
        for row in rows
        if row["cause"] == "moving_mass" and row["sign"] < 0 and row.get("not_drawn")
    } == {5.0}
    assert {row["cause"] for row in rows if row.get("not_drawn") == "no limit"} == set(
        real_plan.CAUSES
    ) - set(LIMITS)
    table = real_tables.cases(rows)
    written = table.drop(columns="cpu_s").to_csv() + json.dumps(
        [{k: v for k, v in r.items() if k != "cpu_s"} for r in rows]
    )
    assert "secret" not in written and "mine" not in written and str(folder) not in written
    for value in pd.read_csv(folder / "mine.csv")["E_MPa"]:
        assert f"{value:.3f}" not in written
    summary = real_tables.summary(table).set_index("what")
    offset_and_delay = summary.loc["real tables, offset and delay at 3 and 6 limits: named"]
    assert (
        offset_and_delay["percent"] == 50.0
        and offset_and_delay["of"] == 8
        and offset_and_delay["met"] == "no"
    )
    limits = real_tables.limits(table).set_index(["tables", "cause", "own_value"])["rate"]
    assert limits["real", "phase_offset", "any"] == 1.0 and limits["real", "channel_delay", "any"] == 0.0
    rates = real_tables.efficiency(table).set_index(["tables", "cause", "ratio"])
    assert (
        rates.loc[("real", "phase_offset", 6.0), "established"] == 1.0
        and rates.loc[("all", "all", 3.0), "n"] == 6
    )


def test_a_diagnosis_that_fails_is_counted_and_stops_nothing(folder, monkeypatch):
    def broken(table, geometry, removed=(), test_type="bending", use_suspects=False):
        if len(calls) > 0:
            raise np.linalg.LinAlgError("array must not contain infs or NaNs")
        calls.append(1)
        return diagnosis(limits={"phase_offset": LIMITS["phase_offset"]})

    calls: list[int] = []
    monkeypatch.setattr(sealed, "open_case", broken)
    task = next(task for task in own_tasks() if "phase_offset" in task.causes)
    table = real_tables.cases(real.run([task]))
    assert table["failed"].sum() == 10 and not real_tables.hidden(table)["named"].any()
    assert set(table["error"].dropna()) == {"LinAlgError"}
    assert real_tables.summary(table).set_index("what").loc["diagnoses that failed", "met"] == "no"
