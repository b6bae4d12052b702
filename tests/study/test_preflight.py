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
SCHEMA = ROOT / "workflow/schemas/study.schema.yaml"
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
        require_feasible(complete_study(config, "my.yaml", SCHEMA), "my.yaml")

    run.geometry = yaml.safe_load((ROOT / "config/smoke.yaml").read_text())["geometry"]
    run.specimens = yaml.safe_load((ROOT / "config/smoke.yaml").read_text())["specimens"]
    return run


def measure(*tests, form=PEAKS, values="20,6.3e-5,10"):
    """A table `mine.csv` of tests (temperature, frequency)."""
    rows = "".join(f"1,{temperature},{frequency},{values}\n" for temperature, frequency in tests)
    Path("mine.csv").write_text(form + rows)
    return {"table": "mine.csv"}


FOUR = [(0, 3), (0, 10), (20, 3), (20, 10)]


@pytest.mark.parametrize("study", ["paper", "smoke"])
def test_our_own_studies_are_feasible(check, study):
    check(study)


def test_measurements_of_more_than_the_study_asks_for_are_welcome(check):
    check(measurements=measure(*FOUR, (40, 3), (20, 25)))


@pytest.mark.parametrize(
    ("tests", "sentence"),
    [
        (FOUR[:2], "my.yaml: temperatures_C: 20 is not in mine.csv, which has 0; use these."),
        (FOUR[::2], "my.yaml: frequencies_Hz: 10 is not in mine.csv, which has 3; use these."),
        (FOUR[:3], "my.yaml: mine.csv has no test at 20 degC, 10 Hz; add it"),
        ([*FOUR, (20, 10)], "my.yaml: measurements.table: mine.csv, line 6: repeats the test of line 5"),
    ],
)
def test_every_test_needs_a_measurement(check, tests, sentence):
    with pytest.raises(InputError) as error:
        check(measurements=measure(*tests))
    assert str(error.value).startswith(sentence)


def test_too_few_tests_for_a_diagnosis_are_refused_before_anything_is_poured(check):
    few = "are too few for a diagnosis; measure at least 4 tests at 2 frequencies."
    alone = dict.fromkeys(("time_step_study", "packing_study", "audit", "sensitivity"))
    with pytest.raises(InputError, match=f"my.yaml: mine.csv: 2 tests at 2 frequencies {few}"):
        check(measurements=measure(*FOUR[:2]), temperatures_C=[0], **alone)
    with pytest.raises(InputError, match=f"my.yaml: frequencies_Hz: 4 tests at 1 frequency {few}"):
        check(frequencies_Hz=[10], **alone)


def test_frequency_with_more_digits_than_tables_keep_is_found(check):
    tests = [(temperature, frequency) for temperature in (0, 20) for frequency in (10 / 3, 10)]
    check(measurements=measure(*tests), frequencies_Hz=[3.3333333333, 10], time_step_study=None)
    with pytest.raises(
        InputError, match="frequencies_Hz: 3.33333 is not in mine.csv, which has 3.333333333, 10"
    ):
        check(measurements=measure(*tests), frequencies_Hz=[3.33333, 10], time_step_study=None)


def test_geometry_table_without_a_specimen(check):
    header = "specimen," + ",".join(check.geometry)
    Path("shapes.csv").write_text(header + "\n2," + ",".join(map(str, check.geometry.values())) + "\n")
    specimens = check.specimens | {"geometry": check.geometry}
    changes = {"geometry": "shapes.csv", "specimens": specimens}
    with pytest.raises(InputError, match="shapes.csv: specimen '1' has no geometry"):
        check(**changes)
    with pytest.raises(InputError, match="shapes.csv: specimen '1' has no geometry"):
        check(**changes, measurements=measure(*FOUR))
    moduli = "specimen,temperature_C,frequency_Hz,E_MPa,phase_deg\n"
    check(**changes, measurements=measure(*FOUR, form=moduli, values="12000,20"))


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        (
            {"h_mm": 0.06},
            "my.yaml: geometry: h_mm = 0.06 is not a number from 20 to 1000; give the height in mm.",
        ),
        ({"mass_kg": 21}, "my.yaml: geometry: mass_kg = 21 is not a number from 0.001 to 20"),
        ({"h_mm": 61}, "my.yaml: specimens: the specimen is 61 mm high, but the box only 60 mm long"),
        ({"e_mm": 12}, "my.yaml: specimens: the specimen is 12 mm thick, but the box only 10 mm wide"),
    ],
)
def test_implausible_geometry(check, change, sentence):
    with pytest.raises(InputError) as error:
        check(geometry=check.geometry | change)
    assert str(error.value).startswith(sentence)
    with pytest.raises(
        InputError, match="my.yaml: specimens: geometry: mass_kg = 1e-07 is not a number from"
    ):
        check(specimens=check.specimens | {"geometry": check.geometry | {"mass_kg": 0.0000001}})


def test_four_clamps_need_facets(check):
    beam = {"L_mm": 60, "H_mm": 10, "B_mm": 10, "mass_kg": 0.02, "mobile_mass_kg": 0}
    with pytest.raises(
        InputError, match="my.yaml: specimens: four-point bending clamps .*; give area facets."
    ):
        check(specimens=check.specimens | {"geometry": beam})
    check(specimens=check.specimens | {"geometry": beam, "bonds": {"area": "facets"}})


def test_time_steps_too_coarse(check):
    with pytest.raises(
        InputError, match=r"my.yaml: test.time_step_s: .* fewer than 20 steps per cycle at 10 Hz"
    ):
        check(test={"time_step_s": 5.1e-3})
    check(test={"time_step_s": 5e-3})
    with pytest.raises(InputError, match=r"my.yaml: time_step_study.time_steps_s: time step 0.1 s: .* 10 Hz"):
        check(time_step_study=STEPS | {"time_steps_s": [1e-4, 0.1]})


@pytest.mark.parametrize(
    "table", ["diameter_mm\n2\n", "diameter_mm,count\n2,-4\n", "diameter_mm,count\n2,0\n"]
)
def test_counts_that_cannot_be_poured(check, table):
    Path("counts.csv").write_text(table)
    with pytest.raises(InputError, match="my.yaml: specimens.counts_table: counts.csv"):
        check(specimens=check.specimens | {"counts_table": "counts.csv"})


def test_temperature_without_a_published_law(check):
    sentence = (
        "my.yaml: temperatures_C: 5 is not in data/paper/table3_burgers.csv, which has -10, 0, 10, 15, 20, 30"
    )
    with pytest.raises(InputError, match=sentence):
        check(temperatures_C=[5, 20])
    tests = [(temperature, frequency) for temperature in (5, 20) for frequency in (3, 10)]
    fitted = {"temperatures_C": [5, 20], "measurements": measure(*tests)}
    fitted["laws"] = yaml.safe_load((ROOT / "config/smoke.yaml").read_text())["laws"] | {"simulate": "fitted"}
    check(**fitted)
    with pytest.raises(InputError, match="my.yaml: audit.temperature_C: 5 is not in data/paper/table3"):
        check(**fitted, audit={"seed": 1, "temperature_C": 5})


def test_published_tables_that_cannot_be_read(check):
    published = yaml.safe_load((ROOT / "config/smoke.yaml").read_text())["published"]
    for key in published:
        Path("t.csv").write_text("a,b\n1,2\n")
        with pytest.raises(InputError, match="t.csv: column '.*' is missing"):
            check(published=published | {key: "t.csv"})


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("x,y,z,radius\n1,2,3,-1\n", "pile.csv: sphere 1 has a radius of zero or less"),
        ("x_mm,y_mm,z_mm,radius_mm\n1,1,1,1\n2,1,1,1\n", "pile.csv: spheres 1 and 2 overlap by 100 %"),
        ("x_mm,y_mm,z_mm,radius_mm\n1,1,1,1\n4,1,1,1\n", "pile.csv: .*box"),
        ("nothing\n", "pile.csv: "),
    ],
)
def test_packings_that_cannot_be_used(check, text, sentence):
    Path("pile.csv").write_text(text)
    left_out = dict.fromkeys(("sensitivity", "time_step_study", "packing_study", "audit", "published"))
    with pytest.raises(InputError, match=f"my.yaml: specimens.packings: .*{sentence}") as refused:
        check(specimens={"packings": ["pile.csv"]}, **left_out)
    assert "\n" not in str(refused.value)


def test_a_study_is_checked_without_the_compiled_core():
    """Snakemake does it at each start, also where little memory is left: jobs say so, in a sentence."""
    said = (
        "import sys, asphalt_nscd.study.preflight; print([m for m in ('numba', 'scipy') if m in sys.modules])"
    )
    assert subprocess.run([sys.executable, "-c", said], capture_output=True, text=True).stdout == "[]\n"
