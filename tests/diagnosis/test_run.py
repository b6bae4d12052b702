"""What diagnosis.json says of how the measurements were read, and of the files they came from."""

import json
from dataclasses import replace
from hashlib import sha256
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from jsonschema import Draft202012Validator
from test_diagnose import table

from asphalt_nscd.diagnosis import run
from asphalt_nscd.diagnosis.content.whole import schema
from asphalt_nscd.diagnosis.observed.reading import PAPER_GEOMETRY, read_observations
from asphalt_nscd.diagnosis.record.reading import reading
from asphalt_nscd.diagnosis.screening.suspects import Suspect
from asphalt_nscd.diagnosis.search import limits
from asphalt_nscd.diagnosis.search.diagnose import diagnose
from asphalt_nscd.diagnosis.words.answer import rows
from asphalt_nscd.diagnosis.written import read_diagnosis
from asphalt_nscd.measurements.agreement import mean_relative_error
from asphalt_nscd.rheology.spectrum_io import read_spectrum
from asphalt_nscd.table_import.campaign import read_campaign

pytestmark = pytest.mark.slow

PUBLISHED = Path(__file__).parents[2] / "results/published/paper"
EXPORTS = Path(__file__).parents[2] / "data/tutorial/exports"
FEW = run.Draws(500)
# Of the specimens in which no test contradicts its isotherm: such a table is diagnosed twice.
SOUND = sorted(path for name in ("A", "C") for path in EXPORTS.glob(f"Mix-{name}-*.csv"))
SCHEMA = schema()


def test_reading_names_isotherms_and_the_tests_beyond_a_limit():
    campaign, _ = read_campaign([EXPORTS])
    read = reading(read_observations(campaign, PAPER_GEOMETRY)[0], [], ["a note of the import"])
    assert (read["test_type"], read["isotherms_C"]) == ("tension-compression", [4, 20, 35, 50])
    assert read["limits_exceeded"] == [
        {
            "specimen": "Mix-B",
            "temperature_C": 4.0,
            "frequency_Hz": 25.0,
            "column": "phase_uniformity_deg",
            "value": 6.4,
            "limit": 3.0,
        }
    ]
    first, isotherms, law, quality = read["notes"]
    assert first == "a note of the import" and isotherms.startswith(
        "Isotherms in degC: 4 (measured 3.9 to 4.1), 20 ("
    )
    assert law == "Both laws are fitted to the measured temperatures."
    assert quality == (
        "Phase uniformity above 3 deg (AASHTO T 378, TP 132) in 1 of 72 tests: Mix-B at 4 degC, 25 Hz: 6.4 deg."
    )


def test_a_limit_that_most_of_a_sweep_exceeds_singles_no_test_out():
    observed, _ = read_observations(read_campaign([EXPORTS])[0], PAPER_GEOMETRY)
    uneven = np.where(observed.specimen == 0, 40.0, 10.0)
    uneven[np.flatnonzero(observed.specimen == 1)[0]] = 35.0
    also = (observed.specimen == 0) | ((observed.specimen == 1) & (observed.isotherm == 20.0))
    more = np.where(also, 40.0, 10.0)
    for values, where in ((uneven, "specimen Mix-A"), (more, "specimen Mix-A and specimen Mix-B at 20 degC")):
        notes = reading(replace(observed, quality={"deformation_uniformity_percent": values}), [], [])[
            "notes"
        ]
        assert notes[-1].endswith(
            f" Half of the tests or more exceed it in {where}: check gauges and mounting. No single test is rejected "
            "for that."
        )


def test_a_specimen_that_lacks_a_temperature_of_the_others_is_named():
    observed, _ = read_observations(read_campaign([EXPORTS])[0], PAPER_GEOMETRY)
    assert reading(observed, [], [])["not_tested"] == []
    lacking = (observed.specimen == 1) & (observed.isotherm == 20)
    assert reading(observed.subset(np.flatnonzero(~lacking)), [], [])["not_tested"] == [
        "specimen Mix-B at 20 degC"
    ]
    alone = observed.isotherm != 20
    alone |= observed.specimen == 1
    assert not reading(observed.subset(np.flatnonzero(alone)), [], [])["not_tested"]


def test_an_isotherm_off_its_target_is_to_be_checked_and_tested_again_first(tmp_path):
    for path in SOUND:
        text = path.read_bytes()
        if path.name == "Mix-A-20C_Sum.csv":
            text = text.replace(b"20.0,20.1,20.0,20.0,20.0,19.9", b"20.7,20.7,20.7,20.7,20.7,20.7")
        (tmp_path / path.name).write_bytes(text)
    content = run.conclude(read_campaign([tmp_path])[0], PAPER_GEOMETRY, draws=FEW).content
    assert (content["trust"]["check"], content["trust"]["use_by_specimen"]["Mix-A"]) == (6, 18)
    first = content["instructions"]["orders"][0]
    assert first["purpose"] == "because it was measured 0.7 K off its target"
    told = dict(rows(content))["Check first"]
    assert told[0].startswith(
        "Specimen Mix-A at 20 degC: measured at 20.7 degC, 0.7 K off its target (AASHTO"
    )


def test_the_verdict_names_files_without_tests(tmp_path):
    for path in SOUND:
        (tmp_path / path.name).write_bytes(path.read_bytes())
    (tmp_path / "Mix-C-50C_Sum.csv").write_text("")
    outcome = run.conclude(read_campaign([tmp_path])[0], PAPER_GEOMETRY, draws=FEW)
    told = "1 of 8 files gave no test: Mix-C-50C_Sum.csv (the file is empty)."
    Draft202012Validator(SCHEMA).validate(outcome.content)
    assert outcome.content["reading"]["files_without_tests"] == [told]
    assert dict(rows(outcome.content))["Note"][0] == told


def test_what_is_named_without_the_doubtful_tests(monkeypatch):
    monkeypatch.setattr(limits, "detection_limits", None)  # names alone are asked for
    found = diagnose(table(3, lambda e, s, t, w: e * np.exp(1.5e-4j * w)), draws=500)
    assert run.second_opinions(found, None, 0)["without_doubtful"] is None  # none is doubtful
    least = int(np.ceil(run.MATTERING * found.observed.size))
    found.suspects = tuple(Suspect(row, ("a reason",), True) for row in range(least))
    then = run.second_opinions(found, None, 0)["without_doubtful"]
    assert then is not None
    assert [one["cause"] for one in then["causes"]] == ["relaxation_spectrum", "channel_delay"]
    found.suspects = found.suspects[1:]  # too few to matter
    assert run.second_opinions(found, None, 0)["without_doubtful"] is None
    found.suspects = tuple(Suspect(row, ("a reason",), True) for row in range(found.observed.size - 1))
    assert run.second_opinions(found, None, 0)["without_doubtful"] is None  # nothing is left to diagnose


@pytest.mark.parametrize("several", [True, False])
def test_files_of_a_campaign_stand_in_the_diagnosis_with_their_checksums(tmp_path, several):
    paths = sorted(EXPORTS.glob("Mix-A-*" if several else "Mix-A-20C*"))
    campaign, _ = read_campaign(paths)
    run.conclude(campaign, PAPER_GEOMETRY, stated=run.Stated(scatter=(0.01, 0.003)), draws=FEW).write(
        tmp_path
    )
    content = read_diagnosis([tmp_path / "diagnosis.json"])
    sums = [sha256(path.read_bytes()).hexdigest() for path in paths]
    if several:
        named = content["provenance"]["files"]
        assert [(one["name"], one["sha256"]) for one in named] == list(
            zip([p.name for p in paths], sums, strict=True)
        )
        assert [*content["baseline"]["mre_E_percent"]] == ["4", "20", "35", "50"]  # not 3.9, 4, 4.1, ...
    else:
        assert content["provenance"]["sha256"] == sums[0] and "files" not in content["provenance"]
    assert json.loads((tmp_path / "diagnosis.json").read_text())["origin"] == "synthetic"


@pytest.fixture(scope="module")
def campaigns(tmp_path_factory):
    """Three specimens; the published tests at 10 to 30 degC, and the same with their law times 1.002."""
    folder = tmp_path_factory.mktemp("campaigns")
    measured = pd.read_csv(PUBLISHED / "measured.csv", dtype={"specimen": str}).query("specimen != '4'")
    measured.to_csv(folder / "measured.csv", index=False)
    tests = pd.read_csv(PUBLISHED / "simulations.csv").query("temperature_C >= 10")
    tests.to_csv(paper := folder / "simulations.csv", index=False)
    facets = tests.assign(E_MPa=1.002 * tests["E_law_MPa"], phase_deg=tests["phase_law_deg"])
    facets.to_csv(by_facets := folder / "facets.csv", index=False)
    return folder, paper, by_facets


def test_the_ladder_begins_with_what_was_simulated(campaigns):
    folder, paper, facets = campaigns
    measured = folder / "measured.csv"
    run.conclude(measured, PAPER_GEOMETRY, draws=FEW, simulated=run.Simulated(paper, facets)).write(folder)
    content = read_diagnosis([folder / "diagnosis.json"])
    bonds, law = content["ladder"][:2]
    assert (bonds["cause"], law["cause"]) == ("bond_mapping", "relaxation_spectrum")
    data = pd.read_csv(measured, dtype={"specimen": str})
    errors = [
        mean_relative_error(data, pd.read_csv(path)).set_index("temperature_C") for path in (paper, facets)
    ]
    # where no test was simulated, there is no error of a simulation
    averages = bonds["gain"]["in_sample"]["averages_by_temperature"]
    assert list(averages) == ["10", "15", "20", "30"]
    of_law = law["gain"]["in_sample"]["averages_by_temperature"]
    assert list(of_law) == list(averages)
    for name in ("mre_E_percent", "mre_phase_percent"):
        for when, error in zip(("before", "after"), errors, strict=True):
            assert [one[name][when] for one in averages.values()] == pytest.approx(error[name].to_list())
        assert [one[name]["before"] for one in of_law.values()] == pytest.approx(errors[1][name].to_list())
    assert max(one["mre_E_percent"]["after"] for one in of_law.values()) < 1.0
    assert pd.read_csv(folder / "residuals.csv").query("temperature_C < 10")["E_before_MPa"].isna().all()
    residuals = pd.read_csv(folder / "residuals.csv").query("temperature_C == 15 and frequency_Hz == 10")
    simulated = pd.read_csv(paper).query("temperature_C == 15 and frequency_Hz == 10")["E_MPa"].mean()
    assert np.allclose(residuals["E_before_MPa"], simulated)


def test_one_mapping_alone_makes_no_rung(campaigns):
    folder, _, facets = campaigns
    simulated = run.Simulated(facets)
    run.conclude(folder / "measured.csv", PAPER_GEOMETRY, draws=FEW, simulated=simulated).write(folder)
    content = read_diagnosis([folder / "diagnosis.json"])
    assert content["ladder"][0]["cause"] == "relaxation_spectrum"
    assert any("No rung bond_mapping" in note and "1.002 of the law" in note for note in content["notes"])


@pytest.mark.parametrize("stated", [None, "bending"])
def test_faults_of_one_bench_are_looked_for_only_where_the_bench_is_known(stated):
    campaign, _ = read_campaign([EXPORTS.parent / "campaign.csv"], test_type=stated)
    content = run.conclude(campaign, PAPER_GEOMETRY, draws=FEW).content
    assert content["reading"]["test_type"] == (stated or "unknown")
    # What the motion of a bent trapezoid adds to the law of its bonds is in no test of another bench.
    added = content["numerics"]["largest_modulus_percent"], content["numerics"]["largest_phase_deg"]
    assert min(added) > 1e-3 if stated else max(added) < 1e-9
    limits = set(content["detection_limits"])
    assert "channel_delay" in limits and ("moving_mass" in limits) == (stated is not None)
    assert not list(Draft202012Validator(SCHEMA).iter_errors(json.loads(json.dumps(content))))


def test_the_verdict_tells_what_the_law_that_is_written_misses(tmp_path):
    """Computed again: the law of the file with the delay added, averages over specimens, mean over all."""
    outcome = run.conclude(read_campaign(SOUND)[0], PAPER_GEOMETRY, draws=FEW)
    outcome.write(tmp_path)
    observed = outcome.diagnosis.observed
    modulus = read_spectrum(tmp_path / "law.json").complex_modulus(observed.omega, observed.temperature)
    (delay,) = [one["parameters"] for one in outcome.content["ladder"] if one["cause"] == "channel_delay"]
    late = observed.omega * next(iter(delay.values()))["value"]
    by_hand = pd.DataFrame(
        {
            "at": observed.isotherm,
            "f": observed.frequency,
            "E": np.abs(observed.modulus),
            "phase": np.degrees(np.angle(observed.modulus)),
            "E_law": np.abs(modulus),
            "phase_law": np.degrees(np.angle(modulus) + late),
        }
    )
    means = by_hand.groupby(["at", "f"]).mean()
    misses = outcome.content["law_misses"]
    for name in ("E", "phase"):
        error = 100.0 * np.abs(means[f"{name}_law"] / means[name] - 1.0).groupby("at").mean().mean()
        assert misses[f"mre_{name}_percent"] == pytest.approx(error, rel=1e-6), name
    off = np.abs(means["phase_law"] - means["phase"]).groupby("at").mean().mean()
    assert misses["off_phase_deg"] == pytest.approx(off, rel=1e-6)
    said = f"{misses['mre_E_percent']:.2g} % in |E*| and {off:.2g} deg in the phase"
    (law,) = dict(rows(outcome.content))["Law"]
    assert said in law and "fitted to the corrected tests" in law


def test_metal_comes_first_where_phases_lie_on_one_side(monkeypatch):
    told = "32 of 54 phases lie above."
    monkeypatch.setattr(run.suspects, "one_sided", lambda *_: told)

    def without_a_cause(observed, *_, **__):
        return diagnose(observed, catalogue=(), draws=500)

    monkeypatch.setattr(run, "diagnose", without_a_cause)
    content = run.conclude(read_campaign(SOUND)[0], PAPER_GEOMETRY, draws=FEW).content
    first = content["instructions"]["orders"][0]
    assert first["specimens"] == ["a metal reference specimen"] and first["why"][0].startswith(
        f"{told} Metal has no"
    )


def test_what_is_taken_off_the_tests_is_no_excess_to_look_into():
    """An established offset of 1.9 deg leaves nothing for ten hours at two strains to explain."""
    corrected = pd.DataFrame(
        {
            "nominal_temperature_C": [0.0, 0.0, 20.0],
            "recorded_phase_deg": [9.0, 8.0, 30.0],
            "phase_deg": [7.1, np.nan, 30.0],
        }
    )
    found = [{"temperature_C": t, "excess_deg": 2.0, "standard_error_deg": 0.3} for t in (0.0, 20.0)]
    cold, warm = run._less_established(found, corrected)
    assert cold["excess_deg"] == pytest.approx(0.1) and cold["taken_off_deg"] == pytest.approx(1.9)
    assert warm == found[1] | {"taken_off_deg": 0.0}
