"""Wild tables stay within what a measurement table may hold, and a few of them go through the diagnosis."""

from __future__ import annotations

import numpy as np
import pytest
from fuzz import diagnoses, wild

from asphalt_nscd.measurements.limits import LIMITS

pytestmark = pytest.mark.slow

SEEDS = range(300)


@pytest.fixture(scope="module")
def tables():
    return [wild.draw(seed) for seed in SEEDS]


def test_every_value_is_within_its_limits(tables):
    for table, _ in tables:
        for name in ("temperature_C", "frequency_Hz", "E_MPa", "phase_deg"):
            assert table[name].between(LIMITS[name].low, LIMITS[name].high).all()
        assert not table[["specimen", "temperature_C", "frequency_Hz"]].isna().any().any()


def test_tables_are_as_wild_as_promised(tables):
    sizes = [len(table) for table, _ in tables]
    assert min(sizes) <= 3 and max(sizes) == wild.MOST_TESTS
    assert set(" ".join(faults for _, faults in tables).split()) == set(wild.FAULTS)
    assert any(table["specimen"].nunique() == 1 for table, _ in tables)
    assert any(table["frequency_Hz"].nunique() == 2 for table, _ in tables)
    assert min(table["E_MPa"].min() for table, _ in tables) < 0.2
    assert max(table["E_MPa"].max() for table, _ in tables) > 1.8e5
    assert any((table["phase_deg"] == 0.0).all() for table, _ in tables)
    assert any((table["phase_deg"] > 88.0).all() for table, _ in tables)
    assert any(not table["temperature_C"].is_monotonic_increasing for table, _ in tables)
    assert {"replicate", "order", "cycles", "amplitude_m"} <= set().union(*(table for table, _ in tables))


@pytest.mark.parametrize("seed", [3, 16])  # of few tests: `make fuzz` tries a thousand
def test_a_few_are_diagnosed_or_refused_in_one_sentence(seed):
    outcome = diagnoses.tried(seed)
    assert outcome.ended in ("diagnosed", "refused"), outcome


@pytest.mark.parametrize(
    ("error", "ended"),
    [
        (np.linalg.LinAlgError("not positive"), "traceback"),
        (AssertionError("no summary"), "traceback"),
        (diagnoses.InputError("give another file."), "refused"),
    ],
)
def test_what_is_no_refusal_is_a_traceback(monkeypatch, error, ended):
    def conclude(*_):
        raise error

    monkeypatch.setattr(diagnoses, "conclude", conclude)
    assert diagnoses.tried(0).ended == ended


def test_a_diagnosis_with_infinity_in_its_file_is_none(monkeypatch):
    class Infinite:
        def written(self, folder):
            (folder / "diagnosis.json").write_text('{"ladder": [{"p_value": Infinity}]}')
            return "summary"

    monkeypatch.setattr(diagnoses, "conclude", lambda *_: Infinite())
    outcome = diagnoses.tried(0)
    assert outcome.ended == "traceback" and outcome.said.endswith("diagnosis.ladder.0.p_value")


def test_rates_count_the_ends_and_time_the_diagnosed():
    ends = ["diagnosed"] * 6 + ["refused"] * 3 + ["traceback"]
    sizes, warned = [50] * 3 + [200] * 7, ["", "joint.py:3"] + [""] * 8
    outcomes = [
        diagnoses.Outcome(n, "", size, end, cpu_s=float(n), warned=said)
        for n, (size, end, said) in enumerate(zip(sizes, ends, warned))
    ]
    table = diagnoses.rates(outcomes).set_index("what")
    assert table.loc["traceback", "hits"] == 1 and table.loc["traceback", "rate"] == pytest.approx(0.1)
    assert table.loc["refused", "rate"] == pytest.approx(0.3) and table.loc["numerical warning", "hits"] == 1
    short, long = (row for name, row in table.iterrows() if name.startswith("CPU"))
    assert (short["n"], short["median"], short["largest"]) == (3, 1.0, 2.0)
    assert (long["n"], long["median"], long["largest"]) == (3, 4.0, 5.0)
