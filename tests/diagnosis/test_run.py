"""What diagnosis.json says of how the measurements were read, and of the files they came from."""

import json
from hashlib import sha256
from pathlib import Path

import pytest

from asphalt_nscd.diagnosis import run
from asphalt_nscd.diagnosis.reading import PAPER_GEOMETRY, read_observations
from asphalt_nscd.diagnosis.written import read_diagnosis
from asphalt_nscd.table_import.campaign import read_campaign

EXPORTS = Path(__file__).parents[2] / "data/tutorial/exports"


def test_reading_names_isotherms_and_the_tests_beyond_a_limit():
    campaign, _ = read_campaign([EXPORTS])
    read = run.reading(read_observations(campaign, PAPER_GEOMETRY)[0], ["a note of the import"])
    assert (read["test_type"], read["isotherms_C"]) == ("tension-compression", [4, 20, 35, 50])
    assert read["limits_exceeded"] == [
        {
            "specimen": "Mix-B", "temperature_C": 4.0, "frequency_Hz": 25.0, "column": "phase_uniformity_deg",
            "value": 6.4, "limit": 3.0,
        }
    ]  # fmt: skip
    first, isotherms, law, quality = read["notes"]
    assert first == "a note of the import" and isotherms.startswith(
        "Isotherms in degC: 4 (measured 3.9 to 4.1), 20 ("
    )
    assert law == "The law is fitted to the measured temperatures."
    assert quality == (
        "Phase uniformity above 3 deg (AASHTO T 378, TP 132) in 1 of 72 tests: Mix-B at 4 degC, 25 Hz: 6.4 deg."
    )


@pytest.mark.parametrize("several", [True, False])
def test_files_of_a_campaign_stand_in_the_diagnosis_with_their_checksums(tmp_path, several):
    paths = sorted(EXPORTS.glob("Mix-A-*" if several else "Mix-A-20C*"))
    campaign, _ = read_campaign(paths)
    run.run(campaign, tmp_path, PAPER_GEOMETRY, scatter=(0.01, 0.003), draws=500)
    content = read_diagnosis([tmp_path / "diagnosis.json"])
    sums = [sha256(path.read_bytes()).hexdigest() for path in paths]
    if several:
        named = content["provenance"]["files"]
        assert [(one["name"], one["sha256"]) for one in named] == list(
            zip([p.name for p in paths], sums, strict=True)
        )
    else:
        assert content["provenance"]["sha256"] == sums[0] and "files" not in content["provenance"]
    assert json.loads((tmp_path / "diagnosis.json").read_text())["origin"] == "synthetic"
