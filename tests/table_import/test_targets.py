"""An export's temperature: what its header, its names and its readings say of it."""

from __future__ import annotations

import pytest

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.table_import.campaign import read_campaign

# The layout of an AMPT's summary. The numbers are invented.
EXPORT = """\
Test Information
Target test temperature,{header}
Identification,{specimen} (X1)
Test results summary
,25 Hz,10 Hz,0.5 Hz
 Dynamic modulus (MPa),9100,8000,5000
 Phase angle (Degrees),12.5,13.25,19
{readings}"""
READINGS = " Average temperature (°C),{0}.1,{0}.0,{0}.1\n"


def read(folder, file, header="4", specimen="Mix-7", measured=None):
    text = EXPORT.format(
        header=header,
        specimen=specimen,
        readings="" if measured is None else READINGS.format(measured),
    )
    if header is None:
        text = text.replace("Target test temperature,None\n", "")
    (folder / file).write_text(text, encoding="utf-8")
    campaign, _ = read_campaign([folder / file])
    columns = campaign.table.columns
    assert columns["specimen"] == ["Mix-7"] * 3
    return columns.get("nominal_temperature_C", columns["temperature_C"]), " ".join(campaign.notes)


def refusal(folder, *given, **more):
    with pytest.raises(InputError) as error:
        read(folder, *given, **more)
    assert "\n" not in str(error.value)
    return str(error.value)


def test_name_and_header_that_agree_are_not_mentioned(tmp_path):
    target, notes = read(tmp_path, "Mix-7_4C_Sum.csv", specimen="Mix-7-4C")
    assert target == ["4"] * 3 and "the name" not in notes


@pytest.mark.parametrize(
    ("file", "specimen"), [("Mix-7_21C_Sum.csv", "Mix-7"), ("Mix-7_Sum.csv", "Mix-7-21C")]
)
def test_the_readings_decide_between_name_and_header(tmp_path, file, specimen):
    said = "says 21 degC and the header 4 degC; "
    target, notes = read(tmp_path, file, specimen=specimen, measured=4)
    assert target == ["4"] * 3 and said + "4.1 degC was measured, so the header is taken" in notes
    target, notes = read(tmp_path, file, specimen=specimen, measured=21)
    assert target == ["21"] * 3 and said + "21.1 degC was measured, so the name is taken" in notes


def test_a_name_and_a_header_that_nothing_decides_between_are_refused(tmp_path):
    said = refusal(tmp_path, "Mix-7_21C_Sum.csv")
    assert (
        "Mix-7_21C_Sum.csv: the name 'Mix-7_21C' says 21 degC and the header 4 degC, and no measured temperature "
        "decides between them; rename the file and its specimen, or correct the header." in said
    )
    assert "but 37.1 degC was measured" in refusal(tmp_path, "Mix-7_21C_Sum.csv", measured=37)


def test_a_name_near_the_header_gives_way_to_it(tmp_path):
    target, notes = read(tmp_path, "Mix-7_20C_Sum.csv", header="22")
    assert target == ["22"] * 3 and "the header is taken" in notes


def test_the_file_of_several_temperatures_may_be_called_after_one(tmp_path):
    parts = [EXPORT.format(header=t, specimen="Mix-7", readings=READINGS.format(t)) for t in (4, 21)]
    (tmp_path / "Mix-7_4C.csv").write_text("".join(parts), encoding="utf-8")
    campaign, _ = read_campaign([tmp_path / "Mix-7_4C.csv"])
    assert campaign.table.columns["nominal_temperature_C"] == ["4"] * 3 + ["21"] * 3
    assert "says" not in " ".join(campaign.notes)


def test_a_target_far_from_what_was_measured_is_refused(tmp_path):
    said = refusal(tmp_path, "Mix-7_Sum.csv", header="37", measured=4)
    assert (
        "the target temperature is 37 degC and 4.1 degC was measured: which is right? If the measured one, write it as "
        "the target; if the target, leave the cells of the readings empty." in said
    )
    said = refusal(tmp_path, "Mix-7-37C_Sum.csv", header="37", measured=0)
    assert (
        "37 degC, as the name says, and 0.1 degC was measured: which is right? If the measured one, write it as the "
        "target and into the name; if the target, leave the cells of the readings empty." in said
    )


@pytest.mark.parametrize("header,refused", [("6.0", False), ("6.2", True), ("2.0", True), ("2.2", False)])
def test_a_target_may_be_two_kelvin_off(tmp_path, header, refused):
    """Measured are 4.1 degC; beyond, nobody can say which is right but who tested."""
    if not refused:
        assert read(tmp_path, "Mix-7_Sum.csv", header=header, measured=4)[0] == [header] * 3
        return
    said = refusal(tmp_path, "Mix-7_Sum.csv", header=header, measured=4)
    assert said.endswith("leave the file out and repeat its tests: AASHTO T 378 allows 0.5 K.")


def test_temperature_of_the_name_where_no_other_is_given(tmp_path):
    for file, specimen in (("Mix-7_Sum.csv", "Mix-7-4C"), ("Mix-7-4C_Sum.csv", "Mix-7")):
        target, notes = read(tmp_path, file, header=None, specimen=specimen)
        assert target == ["4"] * 3 and "4 degC taken from the name 'Mix-7-4C" in notes
    target, _ = read(tmp_path, "Mix-7_Sum.csv", header=None, specimen="Mix-7-50F")
    assert target == ["10"] * 3
    assert "says 4 degC and the name 'Mix-7-21C' 21 degC" in refusal(
        tmp_path, "Mix-7-21C.csv", header=None, specimen="Mix-7-4C"
    )


@pytest.mark.parametrize("between", [" -", "_-", "--", " −", "−"])
def test_a_minus_in_a_name_is_one(tmp_path, between):
    name = f"Mix-7{between}10C"
    target, notes = read(tmp_path, "e.csv", header=None, specimen=name)
    assert target == ["-10"] * 3 and f"-10 degC taken from the name '{name} (X1)'" in notes
    said = refusal(tmp_path, "e.csv", header="10", specimen=name)
    assert f"the name '{name} (X1)' says -10 degC and the header 10 degC" in said
    read(tmp_path, "e.csv", header="-10", specimen=name)


def test_a_hyphen_before_the_temperature_separates_unless_another_name_has_a_minus(tmp_path):
    target, notes = read(tmp_path, "e.csv", header=None, specimen="Mix-7-10C")
    assert target == ["10"] * 3
    assert (
        "10 degC taken from the name 'Mix-7-10C (X1)', its hyphen as a separator; if -10 degC was meant, write that "
        "into the header" in notes
    )
    assert "separator" not in read(tmp_path, "e.csv", header=None, specimen="Mix-7-37C")[1]
    target, _ = read(tmp_path, "Mix-7 -10C.csv", header=None, specimen="Mix-7-10C")
    assert target == ["-10"] * 3
    for between in ("-", "_", " - "):  # a name may lack the minus that the header has
        assert read(tmp_path, "e.csv", header="-10", specimen=f"Mix-7{between}10C")[0] == ["-10"] * 3


def test_no_temperature_at_all_is_refused(tmp_path):
    said = refusal(tmp_path, "Mix-7_Sum.csv", header=None)
    assert "no temperature; add a line 'Target test temperature (°C)'" in said


def test_readings_stand_where_only_a_name_contradicts_them(tmp_path):
    target, notes = read(tmp_path, "Mix-7-21C.csv", header=None, measured=4)
    assert target == ["4.1", "4.0", "4.1"]
    assert "the name 'Mix-7-21C' says 21 degC; 4.1 degC was measured and is taken" in notes


def test_the_grade_of_a_binder_is_no_temperature(tmp_path):
    (tmp_path / "PG64-28C.csv").write_text(
        EXPORT.format(header="4", specimen="PG64-28C", readings=""), "utf-8"
    )
    campaign, _ = read_campaign([tmp_path / "PG64-28C.csv"])
    assert campaign.table.columns["temperature_C"] == ["4"] * 3


@pytest.mark.parametrize(("unit", "celsius"), [("Celsius", 4), ("degrees F", -15.56), ("K", -269.15)])
def test_units_of_the_target(tmp_path, unit, celsius):
    text = EXPORT.format(header="4", specimen="Mix-7", readings="").replace(
        "temperature,4", f"temperature ({unit}),4"
    )
    (tmp_path / "e.csv").write_text(text, "utf-8")
    campaign, _ = read_campaign([tmp_path / "e.csv"])
    assert [float(t) for t in campaign.table.columns["temperature_C"]] == pytest.approx([celsius] * 3)
    (tmp_path / "e.csv").write_text(text.replace(unit, "bar"), "utf-8")
    with pytest.raises(
        InputError, match="'bar' is no unit of the target test temperature; give one of C, K, F"
    ):
        read_campaign([tmp_path / "e.csv"])


def test_moduli_of_the_other_specimens_judge_readings_that_contradict_the_name(tmp_path):
    def save(file, header, specimen, measured, factor):
        text = EXPORT.format(header=header, specimen=specimen, readings=READINGS.format(measured))
        for modulus in (9100, 8000, 5000):
            text = text.replace(f",{modulus}", f",{factor * modulus:g}")
        (tmp_path / file).write_text(text, "utf-8")

    for number, specimen in enumerate(("A", "B")):
        save(f"{specimen}4.csv", 4, f"Mix-{specimen}", 4, 1.0 + 0.1 * number)
        save(f"{specimen}21.csv", 21, f"Mix-{specimen}", 21, 0.5 + 0.05 * number)
    save("Mix-C_21C.csv", 4, "Mix-C", 4, 0.95)
    assert any("so the header is taken" in note for note in read_campaign([tmp_path])[0].notes)
    save("Mix-C_21C.csv", 4, "Mix-C", 4, 0.0)  # refused further on
    read_campaign([tmp_path])
    save("Mix-C_21C.csv", 4, "Mix-C", 4, 0.53)
    with pytest.raises(InputError) as error:
        read_campaign([tmp_path])
    assert str(error.value) == (
        f"{tmp_path / 'Mix-C_21C.csv'}: its name and its header say 21 and 4 degC, and the measured temperature speaks "
        "for 4 degC; but |E*| is 0.51 times that of the other specimens at 4 degC and 1.01 times at 21 degC: correct "
        "header, readings or name."
    )
