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
from asphalt_nscd.study.configuration import complete_study, label, refuse_repeated_keys
from asphalt_nscd.study.schema import read_schema

ROOT = Path(__file__).parents[2]
SCHEMA = ROOT / "workflow/schemas/study.schema.yaml"
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
    return complete_study(config, "my.yaml", SCHEMA)


def refusal(config):
    with pytest.raises(InputError) as error:
        complete(config)
    sentence = str(error.value)
    assert sentence.startswith("my.yaml: ") and "\n" not in sentence
    return sentence


def test_defaults_are_those_of_the_paper(config, monkeypatch):
    monkeypatch.chdir(ROOT)
    paper = complete_study(yaml.safe_load(Path("config/paper.yaml").read_text()), "paper.yaml", SCHEMA)
    study = complete(config)
    assert study["test"] == paper["test"]
    assert study["specimens"]["deposit"] == paper["specimens"]["deposit"]
    assert study["specimens"]["bonds"] == paper["specimens"]["bonds"]
    assert study["specimens"]["geometry"] == paper["geometry"] == TRAPEZOID


def test_completing_twice_changes_nothing(config):
    assert complete(complete(config)) == complete(config)


def test_config_itself_is_left_alone(config):
    complete(config)
    assert "test" not in config


def test_numbers_in_scientific_notation_without_a_point_are_numbers(config):
    config["test"] = {"time_step_s": "5e-5", "amplitude_m": "1e-6"}
    assert complete(config)["test"]["time_step_s"] == 5e-5
    assert complete(config)["test"]["amplitude_m"] == 1e-6


def test_every_key_of_the_schema_has_a_description():
    def nameless(rule, path):
        for key, value in rule.get("properties", {}).items():
            if "$ref" not in value and not value.get("description"):
                yield f"{path}.{key}"
            yield from nameless(value, f"{path}.{key}")

    schema = read_schema(SCHEMA)
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


def test_a_limit_in_the_schema_comes_before_those_of_the_option():
    rules = read_schema(SCHEMA)["properties"]["test"]["properties"]
    said = "Number of cycles, starting from rest."
    assert rules["cycles"] == {"description": said, "type": "integer", "minimum": 2, "default": 5}
    assert rules["amplitude_m"].items() >= {"type": "number", "minimum": 1e-15, "maximum": 1}.items()


def test_the_paper_has_the_defaults():
    paper = yaml.safe_load((ROOT / "config/paper.yaml").read_text())
    specimens = {key: value for key, value in paper["specimens"].items() if key not in ("deposit", "bonds")}
    left_out = {key: value for key, value in paper.items() if key != "test"} | {"specimens": specimens}
    assert complete(left_out) == complete(paper)


def test_every_mapping_of_the_schema_refuses_unknown_keys():
    def open_mappings(rule, path):
        if isinstance(rule, dict):
            if rule.get("type") == "object" and rule.get("additionalProperties") is not False:
                yield path
            for key, value in rule.items():
                yield from open_mappings(value, f"{path}.{key}")

    assert not list(open_mappings(yaml.safe_load(SCHEMA.read_text()), ""))


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        ({"temperature_C": [1]}, "unknown key 'temperature_C' in the study; did you mean 'temperatures_C'?"),
        ({"xyz": 1}, "unknown key 'xyz' in the study; allowed are study, measurements,"),
        ({"test": {"amplitud_m": 1}}, "unknown key 'amplitud_m' in test; did you mean 'amplitude_m'?"),
        ({"test": {"cycles": 2.5}}, "test.cycles is 2.5, but must be a whole number (Number of"),
        ({"test": {"head": "fixed"}}, "test.head is 'fixed', but must be one of free, blocked"),
        ({"test": {"amplitude_m": math.nan}}, "test.amplitude_m is nan, but must be a finite number."),
        ({"study": "../other"}, "study is '../other', but must be letters, digits"),
        ({"frequencies_Hz": [3, 0]}, "frequencies_Hz[1] is 0, but must be greater than 0."),
        ({"frequencies_Hz": [3, -6]}, "frequencies_Hz[1] is -6, but must be greater than 0."),
        ({"frequencies_Hz": []}, "frequencies_Hz is [], but must be a list of at least 1"),
        ({"frequencies_Hz": [math.nan]}, "frequencies_Hz[0] is nan, but must be a finite number."),
        ({"temperatures_C": [15, 15]}, "temperatures_C is [15, 15], but must be a list without repetitions"),
        (
            {"temperatures_C": [15, 15.00000000001]},
            "temperatures_C is [15, 15.0], but must be a list without",
        ),
        ({"temperatures_C": ["warm"]}, "temperatures_C[0] is 'warm', but must be a number."),
        ({"measurements": {}}, "measurements needs exactly one of table, reconstruct."),
        ({"measurements": {"table": "a.csv", "reconstruct": {"seed": 1}}}, "measurements needs exactly one"),
        ({"measurements": {"table": "gone.csv"}}, "measurements.table is 'gone.csv', but there is no such"),
        ({"measurements": {"reconstruct": {"seed": 1, "specimens": 1}}}, "is 1, but must be at least 2"),
        ({"measurements": {"reconstruct": {"seed": 1}}}, "laws.published is missing"),
        ({"laws": {"simulate": "published"}}, "laws.published is missing"),
        ({"geometry": 25}, "geometry is 25, but must be a mapping or text"),
        ({"geometry": "gone.csv"}, "geometry is a table, which does not say what to simulate"),
        ({"geometry": {**TRAPEZOID, "b_mm": 60}}, "geometry.b_mm must not be larger than B_mm"),
        ({"geometry": {**TRAPEZOID, "H_mm": 1}}, "unknown key 'H_mm' in geometry; did you mean 'h_mm'?"),
        ({"geometry": {"b_mm": 25}}, "key 'B_mm' is missing from geometry; add it."),
        ({"sensitivity": {"temperature_C": 20}}, "sensitivity.temperature_C 20 is not in temperatures_C"),
        ({"audit": {"seed": 1, "temperature_C": 15}}, "laws.published is missing, but audit needs it"),
        ({"packing_study": {**PACKING, "seed": 9}}, "packing_study.seed 9 is not in specimens.seeds"),
    ],
)
def test_bad_study_is_refused_in_one_sentence(config, change, sentence):
    assert sentence in refusal({**config, **change})


def test_a_study_does_not_take_the_folder_of_other_results(config):
    config["study"] = "published"
    with pytest.raises(
        InputError, match="study 'published' is a folder of other results; give it another name"
    ):
        complete(config)


def test_missing_key(config):
    del config["laws"]
    assert "key 'laws' is missing from the study; add it." in refusal(config)


def test_key_that_stands_twice(tmp_path):
    (path := tmp_path / "my.yaml").write_text("study: a\ntest:\n  cycles: 5\n  amplitude_m: 1\n  cycles: 3\n")
    with pytest.raises(
        InputError, match=r"my\.yaml, line 5: key 'cycles' appears twice; keep one of the two\."
    ):
        refuse_repeated_keys(path)
    for study in ("paper", "smoke"):
        refuse_repeated_keys(ROOT / f"config/{study}.yaml")


def test_prism_is_a_trapezoid_as_wide_at_the_head_as_at_the_foot(config):
    config["geometry"] = {**TRAPEZOID, "b_mm": 56}
    assert complete(config)["specimens"]["geometry"]["b_mm"] == 56


def test_empty_study():
    assert "the study is empty" in refusal({})


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
    assert given["specimens"]["seeds"] == [1, 2] and "deposit" not in given["specimens"]
    assert complete(given) == given
    steps = {
        "temperature_C": 15,
        "frequency_Hz": 3,
        "time_steps_s": [1e-4],
        "tolerances": [1e-4],
    }
    assert "is not in specimens.seeds" in refusal(
        packed(config, tmp_path) | {"time_step_study": steps | {"seed": 3}}
    )


def test_packings_and_pouring_exclude_each_other(config, tmp_path):
    for key, value in {"seeds": [4], "counts_table": "counts.csv", "deposit": {"friction": 0.3}}.items():
        sentence = f"specimens.{key} is for pouring, and packings are poured already; leave out one of them."
        assert sentence in refusal(packed(config, tmp_path, **{key: value}))
    study = {"frictions": [0.5], "seed": 1, "temperature_C": 15, "frequency_Hz": 10}
    assert "packing_study needs spheres that the study pours" in refusal(
        packed(config, tmp_path) | {"packing_study": study}
    )
    sentence = "key 'box_m' is missing from specimens; add it, or give packings instead."
    assert sentence in refusal(config | {"specimens": {"seeds": [1], "counts_table": "c.csv"}})
    gone = refusal(config | {"specimens": {"packings": ["gone.csv"]}})
    assert "specimens.packings[0] is 'gone.csv', but there is no such file" in gone
    units = config | {"specimens": config["specimens"] | {"packing_up": "y"}}
    assert "specimens.packing_up is for packings; leave it out." in refusal(units)


def test_a_cylinder_is_told_what_it_lacks_and_a_trapezoid_too(config):
    """The sentence is of the shape that the mapping is nearest to."""
    cylinder = {"d_mm": 100, "h_mm": 150, "mass_kg": 2.8, "mobile_mass_kg": 0}

    def simulating(geometry):
        return config | {"specimens": config["specimens"] | {"geometry": geometry}}

    assert complete_study(simulating(cylinder), "study.yaml", SCHEMA)["specimens"]["geometry"] == cylinder
    short = {key: value for key, value in cylinder.items() if key != "h_mm"}
    assert "key 'h_mm' is missing from specimens.geometry; add it." in refusal(simulating(short))
    assert "unknown key 'D_mm' in specimens.geometry;" in refusal(
        simulating({"D_mm": 100} | {key: value for key, value in cylinder.items() if key != "d_mm"})
    )
    beam = {"L_mm": 357, "H_mm": 50, "mass_kg": 2.7, "mobile_mass_kg": 0}
    assert "key 'B_mm' is missing from specimens.geometry; add it." in refusal(simulating(beam))
    trapezoid = {"b_mm": 25, "B_mm": 56, "h_mm": 250, "mass_kg": 0.6, "mobile_mass_kg": 0.2}
    assert "key 'e_mm' is missing from specimens.geometry; add it." in refusal(simulating(trapezoid))


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
    sentence = refusal(config | {"test": "bending"})
    assert "test.type is 'bending', but specimens.geometry has the keys of 'tension-compression'" in sentence
    assert "test.type" in refusal(config | {"test": "torsion"})


@pytest.mark.parametrize("study", ["paper", "smoke"])
def test_a_study_is_planned_without_numpy(study):
    """By a Snakemake of one's own, whose jobs have an environment of their own."""
    script = (
        "import sys, yaml; sys.modules['numpy'] = None\n"
        "from asphalt_nscd.study.configuration import complete_study\n"
        f"config = yaml.safe_load(open('config/{study}.yaml'))\n"
        "complete_study(config, 'it', 'workflow/schemas/study.schema.yaml')\n"
    )
    subprocess.run([sys.executable, "-c", script], check=True, cwd=ROOT)
