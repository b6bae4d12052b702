"""Exports of testing machines: liberal in how they are written, strict in what they mean."""

from __future__ import annotations

import pytest
from table_import.slips import columns, plain, refused, workbook

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.table_import.campaign import read_campaign
from asphalt_nscd.table_import.names import specimen_of

# The layout of an AMPT's summary. The numbers are invented.
RESULTS = """\
Test results summary
,25 Hz,10 Hz,0.5 Hz
 Dynamic modulus (MPa),9100,8000,5000
 Phase angle (Degrees),12.5,13.25,19
 Average temperature  (°C),4.1,4.0,3.9
 Average confining pressure  (kPa),1.2,1.2,1.2
 Average micro-strain,104,101,97
 Load drift (%),0.0,-1.2,0.5
 Load standard error (%),3.2,0.9,na
 Phase uniformity (Degrees),7.9,0.4,0.5
"""
HEADER = """\
Test Information
****************
Project name,Ours
Target test temperature,4
Average dynamic strain range from 75 to 125 micro-strain
Comments
Identification,Mix-7-4C (X1)

 Dimensions,Point 1,Point 2,Average,Std Dev.
 Diameter (mm),100.1,100.2,100.15,0.07
Cross-sectional area (mm²),7878.0
Test date and time,Sat, May 2, 2020, 12:44 AM
"""
EXPORT = HEADER + RESULTS


def read(folder, text, name="Mix-7-4C (X1)_Sum.csv", codec="latin-1", **options):
    path = folder / name
    path.write_bytes(text.encode(codec))
    return read_campaign([path], **options)[0]


TURNED = (
    HEADER
    + """\
Frequency (Hz),Dynamic modulus (MPa),Phase angle (deg),Temperature (°C),Phase uniformity (deg)
25,9100,12.5,4.1,7.9
10,8000,13.25,4.0,0.4
0.5,5000,19,3.9,0.5

Approved by,me
"""
)


def until(last):
    assert last in EXPORT
    return EXPORT[: EXPORT.index(last) + len(last)]


def changed(old, new):
    assert old in EXPORT
    return EXPORT.replace(old, new)


def moduli(campaign):
    return tuple(columns(campaign, "E_MPa", "phase_deg"))


PLAIN = {
    "frequency_Hz": [25.0, 10.0, 0.5],
    "E_MPa": [9100.0, 8000.0, 5000.0],
    "phase_deg": [12.5, 13.25, 19.0],
    "temperature_C": [4.1, 4.0, 3.9],
    "nominal_temperature_C": [4.0] * 3,
    "phase_uniformity_deg": [7.9, 0.4, 0.5],
}


def require_plain(campaign):
    held = plain(campaign.table)
    assert held["specimen"] == ["Mix-7"] * 3
    assert campaign.test_type == "tension-compression"
    for name, numbers in PLAIN.items():
        assert held[name] == pytest.approx(numbers, rel=1e-6), name


def test_summary_export_is_read_as_it_is(tmp_path):
    campaign = read(tmp_path, EXPORT)
    require_plain(campaign)
    assert moduli(campaign) == ([9100, 8000, 5000], [12.5, 13.25, 19])
    assert columns(campaign, "load_standard_error_percent", "microstrain") == [
        [3.2, 0.9, None],
        [104, 101, 97],
    ]
    assert "ignored: 'Average confining pressure (kPa)'" in " ".join(campaign.notes)
    assert read(tmp_path, EXPORT, test_type="bending").test_type == "bending"


@pytest.mark.parametrize(
    ("title", "kind"),
    [
        ("", "unknown"),
        ("Complex modulus", "unknown"),
        ("Essai de module complexe NF EN 12697-26, 2PB-TR", "bending"),
        ("Flexion deux points", "bending"),
        ("2PB-TR beside AASHTO T 378", "unknown"),
        ("NF EN 12697-26 annexe A", "bending"),
        ("EN 12697-26:2018, Anhang D", "tension-compression"),
        ("EN 12697-26 Annex B (4PB-PR)", "four-point bending"),
        ("Indirect tension, IT-CY", "indirect tension"),
        ("Dynamic modulus, AASHTO T 378", "tension-compression"),
        ("Zug-Druck-Versuch an Zylindern", "tension-compression"),
    ],
)
def test_the_kind_of_test_is_told_by_its_scheme_and_never_assumed(tmp_path, title, kind):
    rows = "specimen,temperature_C,frequency_Hz,E_MPa,phase_deg\n1,15,1,9000,20\n1,15,3,11000,18\n"
    (tmp_path / "t.csv").write_text((f'"{title}"\n' if title else "") + rows)
    told, _ = read_campaign([tmp_path / "t.csv"])
    assert told.test_type == kind
    assert any("is not said; say --measured-in" in note for note in told.notes) == (kind == "unknown")
    stated, _ = read_campaign([tmp_path / "t.csv"], test_type="bending")
    assert stated.test_type == "bending"
    assert "--measured-in" not in " ".join(stated.notes)


@pytest.mark.parametrize(
    ("above", "stated"),
    [
        (
            "Fecha;12/03/2026\nNorma;NF EN 12697-26 annexe A",
            {"date": "12/03/2026", "standard": "NF EN 12697-26 annexe A"},
        ),
        ("Date of test: 12.3.2026\nOperator;A. Tester", {"date": "12.3.2026", "operator": "A. Tester"}),
        (
            "Ensayo;AASHTO T 378\nMezcla;AC16\nObra;A-7",
            {"standard": "AASHTO T 378", "mix": "AC16", "project": "A-7"},
        ),
        (
            "Specimen dimensions;100 x 150 mm\nStrain level: 50 µm/m",
            {"dimensions": "100 x 150 mm", "strain": "50 µm/m"},
        ),
        ("Date;Operator;Machine\nx;y;z", {}),
    ],
)
def test_lines_above_a_table_say_what_stands_at_the_head_of_a_report(tmp_path, above, stated):
    rows = "specimen;temperature_C;frequency_Hz;E_MPa;phase_deg\n1;15;1;9000;20\n1;15;3;11000;18\n"
    (tmp_path / "t.csv").write_text(f"{above}\n{rows}")
    told = read_campaign([tmp_path / "t.csv"])[0].stated
    assert {name: text for name, text in told.items() if text} == stated


def test_strains_that_are_recorded_stand_there_too(tmp_path):
    rows = "specimen,T (°C),f (Hz),E (MPa),phi (°),microstrain\n1,15,1,9000,20,78\n1,15,3,11000,18,104\n"
    (tmp_path / "t.csv").write_text(rows)
    assert read_campaign([tmp_path / "t.csv"])[0].stated["strain"] == "78 to 104 microstrain, as recorded"


def test_days_that_differ_between_files_are_not_taken_for_one(tmp_path):
    for n in (1, 2):
        rows = (
            f"specimen;temperature_C;frequency_Hz;E_MPa;phase_deg\n{n};15;1;900{n};20\n{n};15;3;1100{n};18\n"
        )
        (tmp_path / f"{n}.csv").write_text(f"Date;{n}.3.2026\nOperator;A. Tester\n{rows}")
    told = read_campaign([tmp_path])[0].stated
    assert "date" not in told and told["operator"] == "A. Tester"


def test_a_refusal_of_a_workbook_names_the_file_once(tmp_path):
    path = workbook(tmp_path / "t.xlsx", **{name: [["a", "b"], [1, 2]] for name in ("One", "Two")})
    with pytest.raises(InputError) as refusal:
        read_campaign([path])
    assert str(refusal.value).count("t.xlsx") == 1 and "sheet One, sheet Two (" in str(refusal.value)


@pytest.mark.parametrize("codec", ["utf-8", "utf-8-sig", "utf-16"])
def test_encodings(tmp_path, codec):
    require_plain(read(tmp_path, EXPORT, codec=codec))


def with_commas(separator):
    return EXPORT.replace(",", separator).replace(".", ",").replace("Std Dev,", "Std Dev.")


FAHRENHEIT = changed("temperature,4", "temperature,39.2").replace("4C", "39.2F")
FREQUENCIES, MODULI = ",25 Hz,10 Hz,0.5 Hz", " Dynamic modulus (MPa),9100,8000,5000"


@pytest.mark.parametrize(
    "text",
    [
        changed(FREQUENCIES, "Frequency (Hz),25,10,0.5"),
        changed(FREQUENCIES, "FREQUENCY,25 hz,10 hz,0.5 hz"),
        changed(FREQUENCIES, "omega (rad/s),157.0796327,62.83185307,3.141592654"),
        changed(FREQUENCIES, ",157.0796327 rad/s,62.83185307 rad/s,3.141592654 rad/s"),
        changed(FREQUENCIES, "Frequency (rad/s),157.0796327,62.83185307,3.141592654"),
        changed(MODULI, "|E*| [GPa],9.1,8,5"),
        changed(MODULI, "E* (Pa),9.1e9,8e9,5e9"),
        changed(MODULI, "|E*| (ksi),1319.843414,1160.301903,725.1886892"),
        changed(MODULI, "|E*| (psi),1319843.414,1160301.903,725188.6892"),
        changed(" Phase angle (Degrees),12.5,13.25,19", "PHASE ANGLE (deg),12.5,13.25,19"),
        changed("Target test temperature,4", "Target temperature (°C): 4"),
        changed("Target test temperature,4", "Set temperature,4 °C"),
        FAHRENHEIT.replace("(°C),4.1,4.0,3.9", "(°F),39.38,39.2,39.02"),
        changed("Identification,Mix-7-4C (X1)", "Specimen ID: Mix-7"),
        changed("Identification,Mix-7-4C (X1)", "Identification,"),
        with_commas(";"),
        with_commas("\t"),
        with_commas(";").replace("0,5 Hz", "0.5 Hz"),  # a heading is read by itself
        TURNED,
    ],
)
def test_variants_mean_the_same(tmp_path, text):
    require_plain(read(tmp_path, text))


def test_workbook(tmp_path):
    def value(cell):
        return float(cell) if cell.replace(".", "").lstrip("-").isdigit() else cell

    rows = [[value(cell) for cell in line.split(",")] for line in EXPORT.splitlines()]
    require_plain(read_campaign([workbook(tmp_path / "Mix-7-4C_Sum.xlsx", summary=rows)])[0])


def test_several_temperatures_in_one_file(tmp_path):
    warm = RESULTS.replace("4.1,4.0,3.9", "21.1,21,20.9").replace("9100,8000,5000", "5100,4000,2000")
    second = "Target test temperature,21\nIdentification,Mix-7-21C (X1)\n"
    held = plain(read(tmp_path, EXPORT + second + warm).table)
    assert held["nominal_temperature_C"] == [4] * 3 + [21] * 3
    assert held["specimen"] == ["Mix-7"] * 6 and held["E_MPa"][3:] == [5100, 4000, 2000]


def test_frequency_without_a_result_is_left_out_and_said(tmp_path):
    text = EXPORT.replace("9100,8000,5000", "9100,8000").replace("12.5,13.25,19", "12.5,13.25")
    campaign = read(tmp_path, text)
    assert columns(campaign, "frequency_Hz") == [[25, 10]]
    assert "frequencies without a modulus left out: 1" in campaign.notes


@pytest.mark.parametrize(
    ("comment", "origin"), [("Synthetic: drawn", ["synthetic"] * 3), ("cold, synthetic binder", None)]
)
def test_synthetic_exports_say_so(tmp_path, comment, origin):
    text = EXPORT.replace("Comments\n", f"Comments,{comment}\n")
    assert read(tmp_path, text).table.columns.get("origin") == origin


@pytest.mark.parametrize(
    ("text", "names"),
    [
        (until(",25 Hz,10 Hz,0.5 Hz"), ["ends early", "moduli", "phases"]),
        (until(" Dynamic modulus (MPa),9100,8000,5000"), ["ends early", "phases"]),
        (until(" Phase angle (Degrees),12.5"), ["line 16", "Phase angle (Degrees)", "10, 0.5"]),
        (until(" Average temperature  (°C),4.1,4.0"), ["Average temperature (°C)", "0.5"]),
        (TURNED.replace("10,8000", "1O,8000"), ["Frequency (Hz)", "'1O'"]),
        (changed(",25 Hz,10 Hz,0.5 Hz\n", ""), ["frequencies"]),
        (changed(",10 Hz,0.5 Hz", ",10 Hz,0,5 Hz"), ["'0'", "frequencies"]),
        (changed(",25 Hz,10 Hz,0.5 Hz", ",157.1 rad/s,10 Hz,0.5 Hz"), ["line 14", "Hz and rad/s"]),
        (changed("modulus (MPa)", "modulus"), ["'Dynamic modulus'", "unit"]),
        (changed("modulus (MPa)", "modulus (m)"), ["'m'", "E_MPa"]),
        (changed(" Phase angle (Degrees),12.5,13.25,19\n", ""), ["no column for phase"]),
        (changed(" Load drift", " E* (MPa),9,8,7\n Load drift"), ["'Dynamic modulus (MPa)' and 'E* (MPa)'"]),
        (changed("9100,8000,5000", "9100,8000,5000,4000"), ["4 values", "3 frequencies"]),
        (changed("9100,8000,5000", "9100,error,5000"), ["Dynamic modulus (MPa)", "'error'"]),
        (changed("9100,8000,5000", "9100,,5000"), ["Dynamic modulus (MPa)", "empty"]),
        (changed("9100,8000,5000", '"9,100.0","8,000","5,000.5"'), ["decimal marks"]),
        (FAHRENHEIT, ["'Mix-7-39.2F (X1)'", "39.2,", "Fahrenheit"]),
        # Commas that may group digits, and a point.
        (until(MODULI).replace("9100", '"9,100"') + "\n Phase angle (Degrees),12,13,19",
         ["'9,100' (line 15)", "'0.5' (line 14)"]),
        (changed("9100,8000,5000\n Phase angle (Degrees),12.5,13.25,19", "na,na,na\n Phase angle (Degrees),na,na,na"),
         ["no frequency has a modulus"]),
    ],
)  # fmt: skip
def test_what_is_ambiguous_or_cut_short_is_refused(tmp_path, text, names):
    refused(read, tmp_path, text, names=["Mix-7-4C (X1)_Sum.csv", *names])


def test_a_target_that_cannot_be_read_is_none(tmp_path):
    text = changed("Target test temperature,4", "Target test temperature,4 bar")
    assert "nominal_temperature_C" not in read(tmp_path, text).table.columns


@pytest.mark.parametrize(
    ("text", "target", "specimen", "repeated"),
    [
        ("Mix-10-21C (4G16A)", 21, "Mix-10", False),
        ("Mix-10-21C- (4G16A)", 21, "Mix-10", False),
        ("Mix-11-37C-Repeated (4G16A)", 37, "Mix-11", True),
        ("Mix-11-Repeat-37C", 37, "Mix-11", False),
        ("Mix 11 40F rerun", 4.4, "Mix 11", True),
        ("Mix-11--10C", -10, "Mix-11", False),
        ("Mix-11-10C", -10, "Mix-11", False),
        ("Mix_11_4.4 °C", 4.4, "Mix_11", False),
        ("PG64-22C-B2-21C", 21, "PG64-22C-B2", False),
        ("Mix-4C-B2-21C", None, "Mix-4C-B2", False),
        ("Mix-12", 4, "Mix-12", False),
        ("Mix-4Cores", 4, "Mix-4Cores", False),
        ("4C", 4, "4C", False),
        ("Mix-11-20.1C", 21, "Mix-11", False),
        ("Mix-11_270.15K", None, "Mix-11_270.15K", False),  # no machine names them so
    ],
)
def test_specimen_without_temperature_and_remarks(text, target, specimen, repeated):
    name = specimen_of(text, target)
    assert (name.specimen, name.contradicts) == (specimen, False)
    if "Repeat-" not in text:
        assert name.repeated == repeated


@pytest.mark.parametrize(
    ("text", "target"), [("Mix-11-19.9C", 21), ("Mix-11--10C", 10), ("Mix-11-21C", -19.9), ("Mix-11-40F", 6)]
)
def test_a_name_contradicts_another_target(text, target):
    """By more than 1 K, with its minus if it has one; without one it may mean either."""
    assert specimen_of(text, target).contradicts
    assert not specimen_of("Mix-11-21C", -21.9).contradicts


def test_digits_in_groups_with_a_decimal_point(tmp_path):
    text = EXPORT.replace("9100,8000,5000", '"9,100.0",8000.0,"5,000.5"')
    assert moduli(read(tmp_path, text))[0] == [9100.0, 8000.0, 5000.5]
