"""An export's temperature: what its header, its names and its readings say of it."""

from __future__ import annotations

import pytest
from table_import.slips import plain, refused

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
READINGS = " Average temperature (°C),{0}.1,{0}.0,{0}.3\n"  # in the middle, {0}.1


def saved(folder, file, header, specimen, measured):
    readings = "" if measured is None else READINGS.format(measured)
    text = EXPORT.format(header=header, specimen=specimen, readings=readings)
    text = text.replace("Target test temperature,None\n", "")
    (folder / file).write_text(text, encoding="utf-8")
    return read_campaign([folder / file])[0]


def read(folder, file, header="4", specimen="Mix-7", measured=None):
    campaign = saved(folder, file, header, specimen, measured)
    columns = plain(campaign.table)
    assert columns["specimen"] == ["Mix-7"] * 3
    return columns.get("nominal_temperature_C", columns["temperature_C"]), " ".join(campaign.notes)


@pytest.mark.parametrize(
    ("file", "specimen"), [("Mix-7_21C_Sum.csv", "Mix-7"), ("Mix-7_Sum.csv", "Mix-7-21C")]
)
@pytest.mark.parametrize(("measured", "taken"), [(4, "header"), (21, "name")])
def test_the_readings_decide_between_name_and_header(tmp_path, file, specimen, measured, taken):
    target, notes = read(tmp_path, file, specimen=specimen, measured=measured)
    assert target == [measured] * 3
    assert "says 21 degC and the header 4 degC" in notes
    assert f"{measured}.1 degC was measured, so the {taken} is taken" in notes


@pytest.mark.parametrize(
    ("file", "header", "specimen", "measured", "names"),
    [
        ("Mix-7_21C_Sum.csv", "4", "Mix-7", None, ["'Mix-7_21C'", "21 degC", "header 4 degC"]),
        ("Mix-7_18.9C_Sum.csv", "22", "Mix-7", None, ["18.9 degC", "header 22 degC"]),
        ("Mix-7_21C_Sum.csv", "4", "Mix-7", 37, ["21 degC", "header 4 degC", "37.1 degC"]),
        ("Mix-7_Sum.csv", "37", "Mix-7", 4, ["37 degC", "4.1 degC"]),
        ("Mix-7-37C_Sum.csv", "37", "Mix-7", 0, ["37 degC", "name", "0.1 degC"]),
        ("Mix-7-21C.csv", None, "Mix-7-4C", None, ["4 degC", "'Mix-7-21C' 21 degC"]),
        ("Mix-7_Sum.csv", None, "Mix-7", None, ["no temperature", "'Target test temperature (°C)'"]),
        # Measured are 4.1 degC; beyond 2 K, nobody can say which is right but who tested.
        ("Mix-7_Sum.csv", "6.2", "Mix-7", 4, ["6.2 degC", "4.1 degC"]),
        ("Mix-7_Sum.csv", "2.0", "Mix-7", 4, ["2.0 degC", "4.1 degC"]),
        *(("e.csv", "10", f"Mix-7{minus}10C", None, [f"'Mix-7{minus}10C (X1)'", "-10 degC", "header 10 degC"])
          for minus in (" -", "_-", "--", " −", "−")),
    ],
)  # fmt: skip
def test_a_temperature_that_nothing_decides_is_refused(tmp_path, file, header, specimen, measured, names):
    refused(saved, tmp_path, file, header, specimen, measured, names=[file, *names])


@pytest.mark.parametrize(
    ("file", "header", "specimen", "measured", "target"),
    [
        ("Mix-7_19.1C_Sum.csv", "22", "Mix-7", None, "22"),  # a name near the header gives way to it
        ("Mix-7_Sum.csv", "6.0", "Mix-7", 4, "6.0"),
        ("Mix-7_Sum.csv", "2.2", "Mix-7", 4, "2.2"),
        ("Mix-7_Sum.csv", None, "Mix-7-4C", None, "4"),
        ("Mix-7-4C_Sum.csv", None, "Mix-7", None, "4"),
        ("Mix-7_Sum.csv", None, "Mix-7-50F", None, "10"),
        *(("e.csv", header, f"Mix-7{minus}10C", None, "-10")
          for minus in (" -", "_-", "--", " −", "−") for header in (None, "-10")),
        ("e.csv", None, "Mix-7-10C", None, "10"),  # a hyphen
        ("Mix-7 -10C.csv", None, "Mix-7-10C", None, "-10"),  # unless another name has a minus
        *(("e.csv", "-10", f"Mix-7{between}10C", None, "-10") for between in ("-", "_", " - ")),  # or the header
    ],
)  # fmt: skip
def test_the_temperature_that_is_taken(tmp_path, file, header, specimen, measured, target):
    assert read(tmp_path, file, header, specimen, measured)[0] == [float(target)] * 3


def test_readings_stand_where_only_a_name_contradicts_them(tmp_path):
    target, notes = read(tmp_path, "Mix-7-21C.csv", header=None, measured=4)
    assert target == [4.1, 4.0, 4.3]
    assert "'Mix-7-21C' says 21 degC; 4.1 degC was measured" in notes


def test_the_file_of_several_temperatures_may_be_called_after_one(tmp_path):
    parts = [EXPORT.format(header=t, specimen="Mix-7", readings=READINGS.format(t)) for t in (4, 21)]
    (tmp_path / "Mix-7_4C.csv").write_text("".join(parts), encoding="utf-8")
    campaign, _ = read_campaign([tmp_path / "Mix-7_4C.csv"])
    assert plain(campaign.table)["nominal_temperature_C"] == [4] * 3 + [21] * 3
    assert "says" not in " ".join(campaign.notes)


@pytest.mark.parametrize(
    ("name", "doubtful"), [("Mix-7-30C", True), ("Mix-7-37C", False), ("Mix-7_30C", False)]
)
def test_a_hyphen_before_a_temperature_may_be_a_minus_down_to_30_degrees(tmp_path, name, doubtful):
    _, notes = read(tmp_path, "e.csv", header=None, specimen=name)
    assert f"{name[-3:-1]} degC taken from the name" in notes
    assert ("if -30 degC was meant" in notes) == doubtful


def test_the_grade_of_a_binder_is_no_temperature(tmp_path):
    campaign = saved(tmp_path, "PG64-28C.csv", "4", "PG64-28C", None)
    assert campaign.table.numbers("temperature_C").tolist() == [4] * 3


def test_a_set_value_stands_before_a_reading_of_the_header(tmp_path):
    text = EXPORT.format(header="4", specimen="Mix-7", readings="")
    (tmp_path / "e.csv").write_text(f"Temperature,4.6\n{text}", "utf-8")
    assert read_campaign([tmp_path / "e.csv"])[0].table.numbers("temperature_C").tolist() == [4] * 3
    text = f"Temperature (°F),39.2\n{text}".replace("Target test temperature,4\n", "")
    (tmp_path / "e.csv").write_text(text, "utf-8")
    assert read_campaign([tmp_path / "e.csv"])[0].table.numbers("temperature_C").tolist() == [4] * 3


@pytest.mark.parametrize(("unit", "celsius"), [("Celsius", 4), ("degrees F", -15.56), ("K", -269.15)])
def test_units_of_the_target(tmp_path, unit, celsius):
    text = EXPORT.format(header="4", specimen="Mix-7", readings="")
    text = text.replace("temperature,4", f"temperature ({unit}),4")
    (tmp_path / "e.csv").write_text(text, "utf-8")
    campaign, _ = read_campaign([tmp_path / "e.csv"])
    assert campaign.table.numbers("temperature_C").tolist() == pytest.approx([celsius] * 3)
    (tmp_path / "e.csv").write_text(text.replace(unit, "bar"), "utf-8")
    refused(read_campaign, [tmp_path / "e.csv"], names=["e.csv", "'bar'"])
