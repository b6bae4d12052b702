from __future__ import annotations

import math
import subprocess
import sys
from importlib import import_module
from pathlib import Path

import pandas as pd
import pytest
import yaml

from asphalt_nscd.files.csvinput import read_csv
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.options import options_of
from asphalt_nscd.files.store import write_table
from asphalt_nscd.study.configuration import RESERVED, complete_study, label, refuse_repeated_keys
from asphalt_nscd.study.schema import SCHEMA, read_schema

ROOT = Path(__file__).parents[2]
TRAPEZOID = {"b_mm": 25, "B_mm": 56, "e_mm": 25, "h_mm": 250, "mass_kg": 0.6, "mobile_mass_kg": 0.235}
PACKING = {"frictions": [0.5], "seed": 1, "temperature_C": 15, "frequency_Hz": 3}


@pytest.fixture
def config(tmp_path):
    """The least a study can say."""
    for name in ("mine.csv", "counts.csv"):
        (tmp_path / name).touch()
    return {
        "study": "mine",
        "measurements": {"table": str(tmp_path / "mine.csv")},
        "geometry": dict(TRAPEZOID),
        "temperatures_C": [0, 15],
        "frequencies_Hz": [3, 10],
        "laws": {"simulate": "fitted"},
        "specimens": {"seeds": [1], "counts_table": str(tmp_path / "counts.csv"), "box_m": [0.2, 0.02, 1]},
    }


def complete(config):
    return complete_study(config, "my.yaml")


def refused(config, *names):
    """In one line, which holds the file and the names."""
    with pytest.raises(InputError) as error:
        complete(config)
    sentence = str(error.value)
    assert sentence.startswith("my.yaml: ")
    assert "\n" not in sentence
    assert all(name in sentence for name in names), sentence


def test_defaults_are_those_of_the_paper(config, monkeypatch):
    monkeypatch.chdir(ROOT)
    paper = yaml.safe_load((ROOT / "config/paper.yaml").read_text())
    full, study = complete(paper), complete(config)
    assert study["test"] == full["test"]
    assert study["specimens"]["deposit"] == full["specimens"]["deposit"]
    assert study["specimens"]["bonds"] == full["specimens"]["bonds"]
    assert study["specimens"]["geometry"] == full["geometry"] == TRAPEZOID
    specimens = {key: value for key, value in paper["specimens"].items() if key not in ("deposit", "bonds")}
    left_out = {key: value for key, value in paper.items() if key != "test"} | {"specimens": specimens}
    assert complete(left_out) == full


def test_numbers_in_scientific_notation_without_a_point_are_numbers(config):
    config["test"] = {"time_step_s": "5e-5", "amplitude_m": "1e-6"}
    assert complete(config)["test"]["time_step_s"] == 5e-5
    # 2.0 is a whole number to a schema, but no name of a sample
    config["specimens"]["seeds"], config["test"]["rest_steps"] = [1.0, "2e0"], 1e3
    made = complete(config)
    assert repr(made["specimens"]["seeds"] + [made["test"]["rest_steps"]]) == "[1, 2, 1000]"
    assert complete(config)["test"]["amplitude_m"] == 1e-6


def test_texts_of_the_command_line_are_numbers_where_the_schema_wants_some(config):
    """Snakemake hands over what stands in a list of --config as it was typed."""
    full = complete(config)
    config["frequencies_Hz"] = [str(value) for value in config["frequencies_Hz"]]
    config["specimens"]["seeds"] = [str(seed) for seed in config["specimens"]["seeds"]]
    assert complete(config) == full
    config["frequencies_Hz"] = ["three"]
    with pytest.raises(InputError, match="frequencies_Hz.0. is 'three', but must be a number"):
        complete(config)


def test_every_key_of_the_schema_has_a_description():
    def nameless(rule, path):
        for key, value in rule.get("properties", {}).items():
            if "$ref" not in value and not value.get("description"):
                yield f"{path}.{key}"
            yield from nameless(value, f"{path}.{key}")

    schema = read_schema()
    assert not list(nameless(schema, "")) + list(nameless(schema["$defs"]["trapezoid"], "trapezoid"))


def test_a_key_that_is_an_option_bears_its_name():
    def options(rule):
        for key, value in rule.items() if isinstance(rule, dict) else ():
            if isinstance(value, dict) and isinstance(value.get("option"), str):
                yield key, value["option"]
            yield from options(value)

    named = list(options(yaml.safe_load(SCHEMA.read_text())))
    assert len(named) > 20
    for key, place in named:
        module, kind, field = place.rsplit(".", 2)
        assert options_of(getattr(import_module(f"asphalt_nscd.{module}"), kind))[field].key == key


def test_every_mapping_of_the_schema_refuses_unknown_keys():
    def open_mappings(rule, path):
        if isinstance(rule, dict):
            if rule.get("type") == "object" and rule.get("additionalProperties") is not False:
                yield path
            for key, value in rule.items():
                yield from open_mappings(value, f"{path}.{key}")

    assert not list(open_mappings(yaml.safe_load(SCHEMA.read_text()), ""))


@pytest.mark.parametrize(
    ("change", "names"),
    [
        ({"temperature_C": [1]}, ["'temperature_C'", "'temperatures_C'"]),
        ({"xyz": 1}, ["'xyz'", "study, measurements,"]),
        ({"test": {"amplitud_m": 1}}, ["'amplitud_m' in test", "'amplitude_m'"]),
        ({"test": {"cycles": 2.5}}, ["test.cycles is 2.5"]),
        ({"test": {"head": "fixed"}}, ["test.head is 'fixed'", "free, blocked"]),
        ({"test": {"amplitude_m": math.nan}}, ["test.amplitude_m is nan"]),
        ({"test": "torsion"}, ["test.type"]),
        ({"study": "../other"}, ["study is '../other'"]),
        ({"study": "published"}, ["study 'published'"]),  # the folder of other results
        ({"frequencies_Hz": [3, 0]}, ["frequencies_Hz[1] is 0"]),
        ({"frequencies_Hz": [3, -6]}, ["frequencies_Hz[1] is -6"]),
        ({"frequencies_Hz": []}, ["frequencies_Hz is []"]),
        ({"frequencies_Hz": [math.nan]}, ["frequencies_Hz[0] is nan"]),
        ({"temperatures_C": [15, 15]}, ["temperatures_C is [15, 15]"]),
        ({"temperatures_C": [15, 15.00000000001]}, ["temperatures_C is [15, 15.0]"]),
        ({"temperatures_C": ["warm"]}, ["temperatures_C[0] is 'warm'"]),
        ({"measurements": {}}, ["measurements", "table, reconstruct"]),
        (
            {"measurements": {"table": "a.csv", "reconstruct": {"seed": 1}}},
            ["measurements", "table, reconstruct"],
        ),
        ({"measurements": {"table": "gone.csv"}}, ["measurements.table is 'gone.csv'"]),
        ({"measurements": {"reconstruct": {"seed": 1, "specimens": 1}}}, ["is 1,", "at least 2"]),
        ({"measurements": {"reconstruct": {"seed": 1}}}, ["laws.published", "but measurements.reconstruct"]),
        ({"tables_beside": {"tables": ["gone.csv"]}}, ["tables_beside.tables[0] is 'gone.csv'"]),
        # as `deposit` would, after other samples have been poured
        ({"packing_study": {**PACKING, "frictions": [101]}}, ["packing_study.frictions[0]", "at most 100"]),
        (
            {"audit": {"seed": 1, "temperature_C": 15, "likeliest_friction": 101}},
            ["audit.likeliest_friction"],
        ),
        ({"laws": {"simulate": "published"}}, ["laws.published"]),
        ({"geometry": 25}, ["geometry is 25"]),
        ({"geometry": "gone.csv"}, ["geometry is a table"]),
        ({"geometry": {**TRAPEZOID, "b_mm": 60}}, ["geometry.b_mm", "B_mm"]),
        ({"geometry": {**TRAPEZOID, "H_mm": 1}}, ["'H_mm' in geometry", "'h_mm'"]),
        ({"geometry": {"b_mm": 25}}, ["'B_mm'", "geometry"]),
        ({"sensitivity": {"temperature_C": 20}}, ["sensitivity.temperature_C 20"]),
        ({"audit": {"seed": 1, "temperature_C": 15}}, ["laws.published", "audit"]),
        ({"packing_study": {**PACKING, "seed": 9}}, ["packing_study.seed 9"]),
        ({"specimens": {"seeds": [1], "counts_table": "c.csv"}}, ["'box_m'", "specimens"]),
        ({"specimens": {"packings": ["gone.csv"]}}, ["specimens.packings[0] is 'gone.csv'"]),
    ],
)
def test_bad_study_is_refused_in_one_sentence(config, change, names):
    refused({**config, **change}, *names)


def test_no_study_has_the_name_of_other_results():
    assert {path.name for path in (ROOT / "results/published").iterdir() if path.is_dir()} - {"paper"} < set(
        RESERVED
    )


def test_key_that_stands_twice(tmp_path):
    (path := tmp_path / "my.yaml").write_text("study: a\ntest:\n  cycles: 5\n  amplitude_m: 1\n  cycles: 3\n")
    with pytest.raises(InputError, match=r"my\.yaml, line 5: key 'cycles'"):
        refuse_repeated_keys(path)
    for text, said in (
        ("a: &x [1]\nb:\n  - 2\n  - *x\n", "line 4: refers to an anchor"),
        ("a: 1\n[1, 2]: 3\n", "line 2: a key is not a word"),
        ("a: {b\n", "not valid YAML"),
    ):
        path.write_text(text)
        with pytest.raises(InputError, match=rf"my\.yaml.*{said}"):
            refuse_repeated_keys(path)
    for study in ("paper", "smoke"):
        refuse_repeated_keys(ROOT / f"config/{study}.yaml")


def test_prism_is_a_trapezoid_as_wide_at_the_head_as_at_the_foot(config):
    config["geometry"] = {**TRAPEZOID, "b_mm": 56}
    assert complete(config)["specimens"]["geometry"]["b_mm"] == 56


def test_labels_are_those_of_file_names():
    assert [label(value) for value in (15.0, -10, 12.5, 0.1)] == ["15", "-10", "12.5", "0.1"]


def test_file_names_and_tables_hold_the_very_numbers_of_the_study(config, tmp_path):
    values = complete({**config, "frequencies_Hz": [10 / 3, 1e-4 / 3, 1e3 / 3, 3.3333333]})["frequencies_Hz"]
    assert values[0] == pytest.approx(10 / 3, rel=1e-9) and values[3] == 3.3333333
    assert [float(label(value)) for value in values] == values
    write_table(tmp_path / "t.csv", pd.DataFrame({"frequency_Hz": [10 / 3, 1e-4 / 3, 1e3 / 3, 3.3333333]}))
    assert read_csv(tmp_path / "t.csv").numbers("frequency_Hz").tolist() == values


def packed(config, tmp_path, **others):
    for name in ("one.csv", "two.csv"):
        (tmp_path / name).touch()
    files = [str(tmp_path / name) for name in ("one.csv", "two.csv")]
    return config | {"specimens": {"packings": files, **others}}


def test_packings_are_numbered_as_if_by_seeds(config, tmp_path):
    given = complete(packed(config, tmp_path, packing_unit="mm"))
    assert given["specimens"]["seeds"] == [1, 2]
    assert "deposit" not in given["specimens"]
    assert complete(given) == given
    steps = {"seed": 3, "temperature_C": 15, "frequency_Hz": 3, "time_steps_s": [1e-4], "tolerances": [1e-4]}
    refused(packed(config, tmp_path) | {"time_step_study": steps}, "time_step_study.seed 3")


def test_packings_and_pouring_exclude_each_other(config, tmp_path):
    for key, value in {"seeds": [4], "counts_table": "counts.csv", "deposit": {"friction": 0.3}}.items():
        refused(packed(config, tmp_path, **{key: value}), f"specimens.{key}", "packings")
    refused(packed(config, tmp_path) | {"packing_study": PACKING | {"frequency_Hz": 10}}, "packing_study")
    refused(config | {"specimens": config["specimens"] | {"packing_up": "y"}}, "specimens.packing_up")


CYLINDER = {"d_mm": 100, "h_mm": 150, "mass_kg": 2.8, "mobile_mass_kg": 0}
BEAM = {"L_mm": 357, "H_mm": 50, "B_mm": 50, "mass_kg": 2.7, "mobile_mass_kg": 0}


@pytest.mark.parametrize(
    ("shape", "lacks", "more", "names"),
    [
        (CYLINDER, "h_mm", {}, "'h_mm'"),
        (CYLINDER, "d_mm", {"D_mm": 100}, "'D_mm'"),
        (BEAM, "B_mm", {}, "'B_mm'"),
        (TRAPEZOID, "e_mm", {}, "'e_mm'"),
    ],
)
def test_a_specimen_is_told_what_it_lacks_of_the_shape_that_it_is_nearest_to(
    config, shape, lacks, more, names
):
    def simulating(geometry):
        return config | {"specimens": config["specimens"] | {"geometry": geometry}}

    assert complete(simulating(CYLINDER))["specimens"]["geometry"] == CYLINDER
    short = {key: value for key, value in shape.items() if key != lacks}
    refused(simulating(short | more), names, "specimens.geometry")


def test_the_test_says_what_is_simulated(config):
    said = complete(config | {"test": "tension-compression"})
    assert said["specimens"]["geometry"] == {"d_mm": 100, "h_mm": 150, "mass_kg": 2.83, "mobile_mass_kg": 0}
    assert said["test"]["type"] == "tension-compression" and said["test"]["amplitude_m"] == 7.5e-6
    assert said["test"]["steps_per_cycle"] == 200 and complete(said) == said
    for key, value in (("time_step_s", 1e-4), ("steps_per_cycle", 50)):
        own = complete(config | {"test": {"type": "tension-compression", key: value}})["test"]
        assert own[key] == value and own.get("steps_per_cycle", 50) == 50
    four = complete(config | {"test": {"type": "four-point bending", "amplitude_m": 1e-5}})
    assert four["specimens"]["geometry"]["L_mm"] == 357 and four["test"]["amplitude_m"] == 1e-5
    bent = complete(config)
    assert bent["test"]["type"] == "bending" and bent["test"]["amplitude_m"] == 63e-6
    assert "steps_per_cycle" not in bent["test"]


def test_the_specimen_says_what_is_simulated(config):
    config["specimens"]["geometry"] = {"d_mm": 80, "h_mm": 120, "mass_kg": 1.4, "mobile_mass_kg": 0}
    said = complete(config)
    assert said["test"]["type"] == "tension-compression" and said["test"]["amplitude_m"] == 6e-6
    refused(
        config | {"test": "bending"}, "test.type is 'bending'", "specimens.geometry", "'tension-compression'"
    )


@pytest.mark.parametrize("study", ["paper", "smoke"])
def test_a_study_is_planned_without_numpy(study):
    """By a Snakemake of one's own, whose jobs have an environment of their own."""
    script = (
        "import sys, yaml; sys.modules['numpy'] = None\n"
        "from asphalt_nscd.study.configuration import complete_study\n"
        f"config = yaml.safe_load(open('config/{study}.yaml'))\n"
        "complete_study(config, 'it')\n"
    )
    subprocess.run([sys.executable, "-c", script], check=True, cwd=ROOT)
