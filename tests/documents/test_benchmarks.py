"""What the benchmarks write apart from times: exponents of growth, and rows of peers that are absent."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from forks import forked
from theory.specimens import save_specimen

from asphalt_nscd.files.store import save, write_table
from asphalt_nscd.rheology.burgers import Burgers
from asphalt_nscd.rheology.laws_io import write_law

pytestmark = pytest.mark.slow

BENCHMARKS = Path(__file__).parents[2] / "benchmarks"
COLUMNS = ["topic", "case", "spheres", "time_step_s", "cpu_s", "memory_MB", "remark"]
OUTPUTS = [
    "--output",
    "table.csv",
    "--beside",
    "beside.csv",
    "--growth",
    "growth.csv",
    "--million",
    "million.csv",
]


def run(folder, script, *arguments):
    """As a user starts it: these measure what they take."""
    command = [sys.executable, str(BENCHMARKS / script), *map(str, arguments)]
    subprocess.run(command, cwd=folder, check=True)


def tell(folder, script, *arguments, **environment):
    """Of a script that measures nothing here."""
    environment = (environment or {**os.environ}) | {"PYTHONPATH": str(BENCHMARKS)}
    done = forked(f"{script.removesuffix('.py')}:main", [*map(str, arguments)], folder, environment)
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_exponents_are_those_of_the_powers(tmp_path):
    """cpu ~ n^1.5 and memory ~ n of one stage; a stage done at one size has none. The last is that
    between the two largest."""
    rows = [
        {"topic": "growth", "case": "pour", "spheres": n, "cpu_s": 1e-4 * n**1.5, "memory_MB": 0.1 * n}
        for n in (1000, 4000, 16000)
    ]
    rows += [{"topic": "growth", "case": "cut", "spheres": 1000, "cpu_s": 1.0, "memory_MB": 2.0}]
    rows += [{"topic": "growth", "case": "cut", "spheres": 4000, "remark": "not done within 16 GiB"}]
    rows += [
        {"topic": "growth", "case": "test", "spheres": n, "cpu_s": cpu, "memory_MB": 8.0}
        for n, cpu in ((16000, 4.0), (1000, 1.0), (4000, 1.0))
    ]
    for k, row in enumerate([*rows, {"topic": "pouring", "case": "yade", "remark": "absent"}]):
        write_table(tmp_path / f"{k}.csv", pd.DataFrame([row], columns=COLUMNS))
    files = sorted(tmp_path.glob("*.csv"))
    tell(tmp_path, "collect.py", *files, *OUTPUTS)
    assert pd.read_csv(tmp_path / "table.csv").topic.tolist() == ["growth"] * 8 + ["pouring"]
    assert pd.read_csv(tmp_path / "beside.csv").topic.tolist() == ["pouring"]
    growth = pd.read_csv(tmp_path / "growth.csv").set_index("stage")
    assert growth.exponent_of_time["pour"] == pytest.approx(1.5)
    assert growth.exponent_of_memory["pour"] == pytest.approx(1.0)
    assert growth.last_exponent_of_time["test"] == pytest.approx(1.0)
    assert growth.exponent_of_time["test"] == pytest.approx(0.5)
    assert growth.loc["pour", "from"] == 1000 and growth.loc["pour", "to"] == 16000
    assert pd.isna(growth.exponent_of_time["cut"]) and growth.cpu_s_of_largest["cut"] == 1.0


def test_a_million_spheres_are_extrapolated_within_one_algorithm(tmp_path):
    """Factors below, multigrid above: where one size alone has multigrid, cost is proportional to it."""
    sizes = (1000, 3000, 30_000, 200_000)
    rows = [
        ("growth", "condense", n, None, n**1.3, 0.1 * n if n < 1e5 else 28.0 * n / 1e3, None) for n in sizes
    ]
    rows += [("growth", "vibrate", n, None, 1e-3 * n**1.2, 0.01 * n, None) for n in sizes]
    write_table(tmp_path / "rows.csv", pd.DataFrame(rows, columns=COLUMNS))
    tell(tmp_path, "collect.py", "rows.csv", *OUTPUTS)
    table = pd.read_csv(tmp_path / "million.csv").set_index("stage")
    assert table.memory_GB["condense"] == pytest.approx(28.0) and table.exponent_cpu_h["condense"] == 1.0
    assert table.cpu_h["vibrate"] == pytest.approx(1e-3 * 1e6**1.2 / 3600)


def test_rows_that_are_not_measured_again_are_kept_with_their_commit(tmp_path):
    """FCLIB's problems have no size, and are known by their name."""
    earlier = [
        ("growth", "pour", 1000, None, 9.0, 1.0, None),
        ("growth", "pour", 200_000, None, 99.0, 1.0, "slow"),
        ("FCLIB to 1e-8", "tower", None, None, 9.0, 1.0, None),
        ("pouring", "liggghts", 1000, None, 90.0, 1.0, "measured at 7654321"),
        ("pouring", "nscd", 900, None, 5.0, 1.0, None),
    ]
    write_table(tmp_path / "benchmark.csv", pd.DataFrame(earlier, columns=COLUMNS))
    (tmp_path / "provenance.json").write_text('{"git_commit": "0123456789"}')
    now = [
        ("growth", "pour", 1000, None, 1.0, 1.0, None),
        ("FCLIB to 1e-8", "tower", None, None, 2.0, 1.0, None),
        ("FCLIB to 1e-8", None, None, None, None, None, "absent: no files given"),
        ("pouring", "liggghts", None, None, None, None, "absent: not installed"),
        ("pouring", "yade", None, None, None, None, "absent: not installed"),
        ("pouring", "nscd", 1000, None, 4.0, 1.0, None),
    ]
    write_table(tmp_path / "rows.csv", pd.DataFrame(now, columns=COLUMNS))
    for _ in range(2):  # what was kept once is kept with its own commit
        tell(tmp_path, "collect.py", "rows.csv", *OUTPUTS, "--earlier", ".")
        table = pd.read_csv(tmp_path / "table.csv")
        assert table["cpu_s"].fillna(0.0).tolist() == [1.0, 2.0, 0.0, 4.0, 99.0, 90.0]
        assert table["remark"].fillna("").tolist() == [
            *("", "", "absent: not installed", "", "slow; measured at 0123456", "measured at 7654321")
        ]
        (tmp_path / "benchmark.csv").write_bytes((tmp_path / "table.csv").read_bytes())
        (tmp_path / "provenance.json").write_text('{"git_commit": "abcdef0123"}')


@pytest.mark.parametrize(
    ("script", "arguments", "name"),
    [
        ("pouring.py", ["liggghts", "counts.csv"], "liggghts"),
        ("pouring.py", ["yade", "counts.csv"], "yade"),
        ("cycle.py", ["yade", "m.h5", "l.json", "--specimen", "s.h5"], "yade"),
        ("fclib.py", [], "FCLIB"),
    ],
)
def test_what_is_absent_is_said(tmp_path, script, arguments, name):
    tell(tmp_path, script, *arguments, "--output", tmp_path / "row.csv", PATH=str(tmp_path))
    row = pd.read_csv(tmp_path / "row.csv").iloc[0]
    assert (
        row.remark.startswith("absent: ")
        and name in row.remark
        and pd.isna(row.cpu_s)
        and pd.notna(row.topic)
    )


def test_stages_of_growth(tmp_path, beam):
    """A test on a specimen: each stage with its cost, and the modulus beside that of the law."""
    save_specimen(tmp_path / "beam.h5", beam)
    write_law(
        tmp_path / "law.json", Burgers(24.3e9, 3.71e9, 48.4e9, 0.773e9), source="fitted", temperature=15.0
    )
    run(tmp_path, "growth.py", "test", 700, "beam.h5", "law.json", "--output", "rows.csv")
    rows = pd.read_csv(tmp_path / "rows.csv").set_index("case")
    assert rows.index.tolist() == ["condense", "reduced, a cycle", "condensed, factors", "condensed, a step"]
    assert (rows.cpu_s > 0.0).all() and (rows.memory_MB > 50.0).all() and (rows.spheres == 700).all()
    assert rows.remark["condensed, a step"] == "factors"
    ratio = float(re.search(r"E over law ([\d.]+)", rows.remark["reduced, a cycle"])[1])
    assert 0.2 < ratio < 2.0


def test_a_diagnosis_of_the_whole_command(tmp_path):
    """The row says that a diagnosis was written, of the size of its table."""
    run(tmp_path, "diagnosis.py", "54", "--output", "rows.csv")
    row = pd.read_csv(tmp_path / "rows.csv").iloc[0]
    assert row.topic == "diagnosis" and row.case == "54 tests" and row.cpu_s > 0.0
    assert int(re.search(r"of (\d+) kB", row.remark)[1]) > 5


def lying_layer(pitch, shape, seed=3):
    """A jittered lattice of spheres at rest on z = 0, as a deposit's arrays."""
    rng = np.random.default_rng(seed)
    cells = np.stack(np.meshgrid(*map(np.arange, shape), indexing="ij"), -1).reshape(-1, 3)
    radius = pitch * rng.uniform(0.3, 0.45, len(cells))
    position = pitch * (cells + 0.5) + (0.5 * pitch - radius)[:, None] * rng.uniform(-1, 1, cells.shape)
    return {"position": position, "radius": radius}


def test_mappings_of_a_deposit(monkeypatch, tmp_path):
    """A row for each mapping; the facets' modulus is that of the law, and exactly so in tension."""
    monkeypatch.syspath_prepend(str(BENCHMARKS))
    import mapping

    long = 0.25 * (700 / 14160) ** (1 / 3)  # as the specimen is high
    attributes = {"seed": 3, "friction": 0.2, "solid_fraction": 0.4}
    save(tmp_path / "layer.h5", "deposit", lying_layer(long / 37, (37, 4, 9)), attributes)
    rows = pd.DataFrame(mapping.solve(700, tmp_path / "layer.h5"), columns=mapping.COLUMNS)
    assert rows.notna().all().all() and (rows.packing == "700-s3-friction0.2").all()
    table = rows.set_index(["mapping", rows.kt_over_kn.round(2)])
    facets = table.loc[("facets", 1.0)]
    assert facets.E_over_law == pytest.approx(1.0, abs=0.06)
    assert facets.E_tension_over_law == pytest.approx(1.0, abs=1e-5)
    assert facets.macroscopic_poisson == pytest.approx(0.0, abs=1e-5)
    assert table.loc[("facets at mid-gap", 1.0)].E_over_law < facets.E_over_law
    assert table.loc[("facets with moments", 1.0)].E_over_law > facets.E_over_law
    assert table.loc[("facets with moments", 1.0)].bonds == 3 * facets.bonds
    assert abs(table.loc[("paper", 0.37)].E_tension_over_law - 1.0) > 0.05
    poisson = mapping.poisson(700, tmp_path / "layer.h5").set_index("kt / kn")
    assert poisson.loc[1.0].tolist() == [1.0, 1.0, 0.0, 0.0]
    assert (poisson["network Poisson's ratio"].diff().dropna() < 0).all() and len(poisson) == 11
    both = mapping.summary(mapping.collect([write(tmp_path / f"{k}.csv", rows) for k in range(2)]))
    assert (both.packings == 2).all() and len(both) == len(rows)


def write(path, rows):
    write_table(path, rows)
    return path


def test_three_points_have_the_moments_of_a_facet(monkeypatch, make_beam):
    """Area, first and second moments; and they lie within it."""
    monkeypatch.syspath_prepend(str(BENCHMARKS))
    import mapping

    from asphalt_nscd.specimen.network import region_of
    from asphalt_nscd.specimen.power_diagram import power_diagram

    beam = make_beam(area="facets")
    network = mapping.moments(beam.network, beam)
    facets = power_diagram(beam.position, beam.radius, region_of(beam.geometry))
    bonded = facets.second < beam.radius.size + 2
    points, area = network.point.reshape(-1, 3, 3), network.area.reshape(-1, 3)
    np.testing.assert_allclose(area.sum(axis=1), facets.area[bonded], rtol=1e-14)
    np.testing.assert_allclose(points.mean(axis=1), facets.centroid[bonded], atol=1e-15)
    within = np.einsum("bpa,bka->bpk", points - points.mean(axis=1)[:, None], facets.frame[bonded])
    second = np.einsum("bpk,bpl->bkl", within, within) / 3.0
    uu, vv, uv = facets.spread[bonded].T
    scale = facets.area.mean()
    for at, expected in (((1, 1), uu), ((2, 2), vv), ((1, 2), uv), ((0, 0), 0)):
        np.testing.assert_allclose(second[:, *at], expected, atol=1e-12 * scale)


def test_counts_keep_the_grading(monkeypatch):
    monkeypatch.syspath_prepend(str(BENCHMARKS))
    import mapping

    table = mapping.scaled_counts(1416, BENCHMARKS.parent / "data/paper/table2_counts.csv")
    assert table.diameter_mm.tolist() == [2, 4, 6.3, 8, 10]
    assert table["count"].tolist() == [1180, 159, 49, 21, 7]


PAPER = BENCHMARKS.parent / "data/paper/table2_counts.csv"  # of the size that the geometry asks for


@pytest.fixture
def counts(tmp_path):
    path = tmp_path / "counts.csv"
    path.write_text("diameter_mm,count\n6.3,20\n")
    return path


@pytest.mark.parametrize(
    ("arguments", "least"),
    [
        (["pouring.py", "nscd", "counts.csv", "--rest", "rest.npy"], 1),
        (["density.py", "counts.csv"], 4),
    ],
)
def test_what_pours_runs_at_its_smallest_size(tmp_path, counts, arguments, least):
    run(tmp_path, *arguments, "--output", "rows.csv")
    rows = pd.read_csv(tmp_path / "rows.csv")
    assert len(rows) >= least and rows.select_dtypes("number").notna().any().any()


@pytest.mark.parametrize("method", ["sweeps", "chain"])
def test_a_cycle_by_each_method(tmp_path, beam, monkeypatch, method):
    monkeypatch.syspath_prepend(str(BENCHMARKS))
    import growth

    save_specimen(tmp_path / "beam.h5", beam)
    write_law(
        tmp_path / "law.json", Burgers(24.3e9, 3.71e9, 48.4e9, 0.773e9), source="fitted", temperature=15.0
    )
    growth.reduce(str(tmp_path / "beam.h5"), str(tmp_path / "model.h5"))
    run(tmp_path, "cycle.py", method, "model.h5", "law.json", "--specimen", "beam.h5", "--output", "rows.csv")
    assert pd.read_csv(tmp_path / "rows.csv").cpu_s.iloc[0] > 0.0
