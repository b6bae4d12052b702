"""Studies that a schema admits and that would fail after hours."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest
import yaml

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.study.configuration import complete_study
from asphalt_nscd.study.preflight import require_feasible

ROOT = Path(__file__).parents[2]
PEAKS = "specimen,temperature_C,frequency_Hz,F0_N,z0_m,psi_deg\n"
STEPS = {"seed": 1, "temperature_C": 20, "frequency_Hz": 10, "tolerances": [1e-4]}


@pytest.fixture
def check(tmp_path, monkeypatch):
    """Checks the smoke study with changes, in a folder with the repository's tables."""
    monkeypatch.chdir(tmp_path)
    for name in ("config", "data"):
        (tmp_path / name).symlink_to(ROOT / name)

    def run(study="smoke", **changes):
        config = yaml.safe_load((ROOT / f"config/{study}.yaml").read_text())
        config = {key: value for key, value in (config | changes).items() if value is not None}
        require_feasible(complete_study(config, "my.yaml"), "my.yaml")

    run.geometry = yaml.safe_load((ROOT / "config/smoke.yaml").read_text())["geometry"]
    run.specimens = yaml.safe_load((ROOT / "config/smoke.yaml").read_text())["specimens"]
    return run


def refused(check, *names, file="my.yaml", **changes):
    with pytest.raises(InputError) as error:
        check(**changes)
    sentence = str(error.value)
    assert sentence.startswith(f"{file}: ")
    assert "\n" not in sentence
    assert all(name in sentence for name in names), sentence


def measure(*tests, form=PEAKS, values="20,6.3e-5,10"):
    """A table `mine.csv` of tests (temperature, frequency)."""
    rows = "".join(f"1,{temperature},{frequency},{values}\n" for temperature, frequency in tests)
    Path("mine.csv").write_text(form + rows)
    return {"table": "mine.csv"}


FOUR = [(0, 3), (0, 10), (20, 3), (20, 10)]


@pytest.mark.parametrize("study", ["paper", "smoke"])
def test_our_own_studies_are_feasible(check, study):
    check(study)


ALONE = dict.fromkeys(("time_step_study", "packing_study", "audit", "sensitivity"))


@pytest.mark.parametrize(
    ("tests", "more", "names"),
    [
        (FOUR[:2], {}, ["temperatures_C: 20 is not in mine.csv", "has 0;"]),
        (FOUR[::2], {}, ["frequencies_Hz: 10 is not in mine.csv", "has 3;"]),
        (FOUR[:3], {}, ["mine.csv", "20 degC, 10 Hz"]),
        ([*FOUR, (20, 10)], {}, ["measurements.table: mine.csv, line 6", "line 5"]),
        (FOUR[:2], ALONE | {"temperatures_C": [0]}, ["mine.csv: 2 tests at 2 frequencies", "4 tests"]),
    ],
)
def test_every_test_needs_a_measurement_and_a_diagnosis_enough_of_them(check, tests, more, names):
    refused(check, *names, measurements=measure(*tests), **more)


def test_a_diagnosis_of_drawn_measurements_needs_enough_frequencies(check):
    refused(check, "frequencies_Hz: 4 tests at 1 frequency", frequencies_Hz=[10], **ALONE)


def test_frequency_with_more_digits_than_tables_keep_is_found(check):
    tests = [(temperature, frequency) for temperature in (0, 20) for frequency in (10 / 3, 10)]
    study = {"measurements": measure(*tests), "time_step_study": None}
    check(**study, frequencies_Hz=[3.3333333333, 10])
    names = ["frequencies_Hz: 3.33333 is not in mine.csv", "has 3.333333333, 10"]
    refused(check, *names, **study, frequencies_Hz=[3.33333, 10])


def test_geometry_table_without_a_specimen(check):
    header = "specimen," + ",".join(check.geometry)
    Path("shapes.csv").write_text(header + "\n2," + ",".join(map(str, check.geometry.values())) + "\n")
    specimens = check.specimens | {"geometry": check.geometry}
    changes = {"geometry": "shapes.csv", "specimens": specimens}
    refused(check, "specimen '1'", file="shapes.csv", **changes)
    refused(check, "specimen '1'", file="shapes.csv", **changes, measurements=measure(*FOUR))
    moduli = "specimen,temperature_C,frequency_Hz,E_MPa,phase_deg\n"
    check(**changes, measurements=measure(*FOUR, form=moduli, values="12000,20"))


@pytest.mark.parametrize(
    ("change", "names"),
    [
        ({"h_mm": 0.06}, ["geometry: h_mm = 0.06", "from 20 to 1000"]),
        ({"mass_kg": 21}, ["geometry: mass_kg = 21", "from 0.001 to 20"]),
        ({"h_mm": 61}, ["specimens: ", "61 mm", "60 mm"]),
        ({"e_mm": 12}, ["specimens: ", "12 mm", "10 mm"]),
    ],
)
def test_implausible_geometry(check, change, names):
    refused(check, *names, geometry=check.geometry | change)


def test_four_clamps_need_facets(check):
    beam = {"L_mm": 60, "H_mm": 10, "B_mm": 10, "mass_kg": 0.02, "mobile_mass_kg": 0}
    refused(check, "specimens: four-point bending", "facets", specimens=check.specimens | {"geometry": beam})
    check(specimens=check.specimens | {"geometry": beam, "bonds": {"area": "facets"}})


def test_time_steps_too_coarse(check):
    refused(check, "test.time_step_s", "20 steps", "10 Hz", test={"time_step_s": 5.1e-3})
    check(test={"time_step_s": 5e-3})
    steps = STEPS | {"time_steps_s": [1e-4, 0.1]}
    refused(check, "time_step_study.time_steps_s", "0.1 s", "10 Hz", time_step_study=steps)


def test_more_time_steps_than_a_test_takes_at_the_lowest_frequency(check):
    slow = {"frequencies_Hz": [0.004, 10]}
    refused(check, "0.004 Hz", "6.25e+06 steps", test={"time_step_s": 2e-4}, **slow)
    check(test={"steps_per_cycle": 200}, **slow)
    refused(check, "3 Hz", "a test takes at most", test={"steps_per_cycle": 10**7})
    refused(check, "time_step_study.time_steps_s", time_step_study=STEPS | {"time_steps_s": [1e-9]})


@pytest.mark.parametrize(
    "table", ["diameter_mm\n2\n", "diameter_mm,count\n2,-4\n", "diameter_mm,count\n2,0\n"]
)
def test_counts_that_cannot_be_poured(check, table):
    Path("counts.csv").write_text(table)
    specimens = check.specimens | {"counts_table": "counts.csv"}
    refused(check, "specimens.counts_table: counts.csv", specimens=specimens)


def test_temperature_without_a_published_law(check):
    names = ["temperatures_C: 5", "data/paper/table3_burgers.csv", "-10, 0, 10, 15, 20, 30"]
    refused(check, *names, temperatures_C=[5, 20])
    tests = [(temperature, frequency) for temperature in (5, 20) for frequency in (3, 10)]
    fitted = {"temperatures_C": [5, 20], "measurements": measure(*tests)}
    fitted["laws"] = yaml.safe_load((ROOT / "config/smoke.yaml").read_text())["laws"] | {"simulate": "fitted"}
    check(**fitted)
    audit = {"seed": 1, "temperature_C": 5}
    refused(check, "audit.temperature_C: 5", "data/paper/table3", **fitted, audit=audit)


def test_published_tables_that_cannot_be_read(check):
    published = yaml.safe_load((ROOT / "config/smoke.yaml").read_text())["published"]
    Path("t.csv").write_text("a,b\n1,2\n")
    for key in published:
        refused(check, "column '", file="t.csv", published=published | {key: "t.csv"})


@pytest.mark.parametrize(
    ("text", "names"),
    [
        ("x,y,z,radius\n1,2,3,-1\n", ["sphere 1", "radius"]),
        ("x_mm,y_mm,z_mm,radius_mm\n1,1,1,1\n2,1,1,1\n", ["spheres 1 and 2", "100 %"]),
        ("x_mm,y_mm,z_mm,radius_mm\n1,1,1,1\n4,1,1,1\n", ["box"]),
        ("nothing\n", []),
    ],
)
def test_packings_that_cannot_be_used(check, text, names):
    Path("pile.csv").write_text(text)
    changes = ALONE | {"published": None, "specimens": {"packings": ["pile.csv"]}}
    refused(check, "specimens.packings: ", "pile.csv: ", *names, **changes)


def test_a_study_is_checked_without_the_compiled_core():
    """Snakemake does it at each start, also where little memory is left: jobs say so, in a sentence."""
    said = (
        "import sys, asphalt_nscd.study.preflight; print([m for m in ('numba', 'scipy') if m in sys.modules])"
    )
    assert subprocess.run([sys.executable, "-c", said], capture_output=True, text=True).stdout == "[]\n"
