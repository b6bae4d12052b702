"""Measurement tables: three forms agree, and every slip is refused by name."""

import json
import math
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from asphalt_nscd.files.csvinput import read_csv
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.measurements.geometry import read_geometry, read_shape
from asphalt_nscd.measurements.limits import least_modulus
from asphalt_nscd.measurements.reduction import (
    KEYS,
    REDUCED_COLUMNS,
    is_reduced,
    read_reduced,
    reduce_table,
    reduced_frame,
    require_enough,
)
from asphalt_nscd.measurements.twopoint import Geometry, complex_modulus, head_response, norm_and_phase
from asphalt_nscd.rheology.published_laws import read_published

ROOT = Path(__file__).parents[2]
MAPPING = {"b_mm": 25, "B_mm": 56, "e_mm": 25, "h_mm": 250, "mass_kg": 0.6, "mobile_mass_kg": 0.235}
PAPER = Geometry(0.025, 0.056, 0.025, 0.25, 0.6, 0.235)
HEADS = {
    "peaks": "specimen,temperature_C,frequency_Hz,F0_N,z0_m,psi_deg",
    "moduli": "specimen,temperature_C,frequency_Hz,E_MPa,phase_deg",
    "records": "specimen,temperature_C,frequency_Hz,record",
}
PEAK, MODULUS = "A,15,10,50,63e-6,14", "A,15,10,20000,14"


@pytest.fixture
def write(tmp_path):
    def write(*lines, name="measurements.csv"):
        path = tmp_path / name
        path.write_text("\n".join(lines) + "\n")
        return path

    return write


def reduce(path, geometry=MAPPING, **options):
    return reduce_table(path, geometry, path.parent / "measured.csv", **options)


def refusal(path, geometry=MAPPING):
    """The one sentence with which a table is refused; nothing is written."""
    with pytest.raises(InputError) as caught:
        reduce(path, geometry)
    message = str(caught.value)
    assert "\n" not in message and message.endswith(".")
    assert not (path.parent / "measured.csv").exists()
    return message


def test_peaks_are_reduced_by_the_equations_with_each_specimens_geometry(write, tmp_path):
    geometry = write(
        "specimen,b_mm,B_mm,e_mm,h_mm,mass_kg,mobile_mass_kg",
        "thick,25,56,26,250,0.62,0.235",
        "A,25,56,25,250,0.6,0.235",
        name="geometry.csv",
    )
    path = write(HEADS["peaks"], PEAK, "thick,-10,40,95,62e-6,2.5")
    frame = reduce(path, geometry)
    thick = Geometry(0.025, 0.056, 0.026, 0.25, 0.62, 0.235)
    expected = [
        complex_modulus(PAPER, 10, 50, 63e-6, math.radians(14)),
        complex_modulus(thick, 40, 95, 62e-6, math.radians(2.5)),
    ]
    norm, phase = norm_and_phase(expected)
    np.testing.assert_allclose(frame["E_MPa"], norm * 1e-6, rtol=1e-12)
    np.testing.assert_allclose(frame["phase_deg"], np.degrees(phase), rtol=1e-12)
    assert list(frame["origin"]) == ["measured", "measured"]
    assert frame["E_peak_MPa"].isna().all()
    read = read_reduced(tmp_path / "measured.csv")
    assert list(read.columns) == ["specimen", *KEYS, "origin", "E_MPa", "phase_deg"]
    pd.testing.assert_frame_equal(read, frame[read.columns], rtol=1e-9)
    header = (tmp_path / "measured.csv").read_text().splitlines()[0]
    assert header == ",".join(REDUCED_COLUMNS)


@pytest.mark.parametrize(("phase", "passes"), [(18.5, True), (16.5, False)])
def test_a_stiff_mix_may_look_soft_where_its_mass_carries_all_but_the_sine(write, phase, passes):
    """|E*| is 1 GPa, the least of the cold; the sines of 16.5 and 18.5 degrees are 0.28 and 0.32."""
    star = 1.001e9 * np.exp(1j * math.radians(phase))
    carried = complex_modulus(PAPER, 1, 0, 63e-6, 0).real
    frequency = float(np.sqrt(star.real / carried))
    force, lead = head_response(PAPER, frequency, star, 63e-6)
    assert math.degrees(lead) == pytest.approx(90, abs=0.1)
    path = write(HEADS["peaks"], f"A,-30,{frequency},{force},63e-6,{math.degrees(lead)}")
    if passes:
        assert reduce(path)["E_MPa"][0] == pytest.approx(1001, rel=1e-9)
    else:
        assert "is softer than any asphalt at -30 degC" in refusal(path)


def test_moduli_pass_through_and_need_no_geometry(write):
    frame = reduce(
        write(HEADS["moduli"] + ",origin", MODULUS + ",synthetic", "7,15,10,18000,16,synthetic"), {}
    )
    assert frame[["specimen", "E_MPa", "phase_deg", "origin"]].values.tolist() == [
        ["A", 20000, 14, "synthetic"],
        ["7", 18000, 16, "synthetic"],
    ]
    assert frame["F0_N"].isna().all()


def write_record(path, frequency, modulus, step=5e-4, force_unit=1.0):
    force, phase = head_response(PAPER, frequency, modulus, 63e-6)
    time = np.arange(0, 12, step)
    omega = 2 * np.pi * frequency
    columns = {
        "time_s": time,
        "force_N": force_unit * (force * np.sin(omega * time + phase) + 2 + 0.3 * time),
        "displacement_m": 63e-6 * np.sin(omega * time),
    }
    path.parent.mkdir(exist_ok=True)
    pd.DataFrame(columns).to_csv(path, index=False)


def test_records_are_reduced_both_ways(write, tmp_path):
    modulus = 20e9 * np.exp(1j * math.radians(14))
    write_record(tmp_path / "raw" / "a.csv", 10.0, modulus)
    frame = reduce(write(HEADS["records"], "A,15,10,raw/a.csv"))
    row = frame.iloc[0]
    assert row["E_MPa"] == pytest.approx(20000, rel=1e-9)
    assert row["phase_deg"] == pytest.approx(14, abs=1e-7)
    assert row["z0_m"] == pytest.approx(63e-6, rel=1e-9)
    assert row["E_peak_MPa"] == pytest.approx(20000, rel=2e-3) and row["E_peak_MPa"] != row["E_MPa"]
    assert row["phase_peak_deg"] == pytest.approx(14, abs=1.8)


def test_window_is_passed_on(write, tmp_path):
    write_record(tmp_path / "a.csv", 10.0, 20e9)
    path = write(HEADS["records"], "A,15,10,a.csv")
    assert reduce(path, cycles=120)["E_MPa"][0] == pytest.approx(20000, rel=1e-9)
    with pytest.raises(
        InputError, match="line 2: record .*a.csv: the record lasts 120.00 cycles of 10 Hz, 121 needed"
    ):
        reduce(path, cycles=121)


@pytest.mark.parametrize(
    ("lines", "words"),
    [
        (["time_s,force_N,displacement_m"], "a.csv: the table has a header but no rows"),
        (
            ["time_s,force_kN,displacement_m", "0,1,1"],
            "column 'force_kN' must be 'force_N'; multiply by 1000",
        ),
        (
            ["time_s,force_N,displacement_m", "0,1,1", "0.1,nan,1"],
            "a.csv, line 3: force_N = nan is not finite",
        ),
        (["time_s,force_N,displacement_m", "0,1,1", "0.1,2,2"], "a.csv: the record holds 2 samples"),
    ],
)
def test_bad_records_are_named_with_the_row_that_calls_them(write, lines, words):
    write(*lines, name="a.csv")
    message = refusal(write(HEADS["records"], "A,15,10,a.csv"))
    assert "measurements.csv, line 2: record " in message and words in message


def test_record_in_kilonewtons_is_found_out(write, tmp_path):
    """At 40 Hz the mass term alone is 500 MPa, a modulus one could believe."""
    write_record(tmp_path / "a.csv", 40.0, 20e9, force_unit=1e-3)
    message = refusal(write(HEADS["records"], "A,15,40,a.csv"))
    assert (
        "line 2: 19.5 MPa is softer than any asphalt at 15 degC and 40 Hz" in message and "F0 in N" in message
    )


P, M = HEADS["peaks"], HEADS["moduli"]
BAD_TABLES = {
    "missing column": ([P.replace(",z0_m", ""), "A,15,10,50,14"], "column 'z0_m' is missing"),
    "missing key": ([M.replace("specimen,", ""), "15,10,20000,14"], "column 'specimen' is missing"),
    "no quantity": (["specimen,temperature_C,frequency_Hz", "A,15,10"], "no measured quantity found"),
    "two forms": ([P + ",E_MPa,phase_deg", PEAK + ",20000,14"], "holds peaks and moduli together"),
    "E in GPa": ([M.replace("E_MPa", "E_GPa"), "A,15,10,20,14"], "'E_GPa' must be 'E_MPa'; multiply by 1000"),
    "E (GPa)": ([M.replace("E_MPa", "|E*| (GPa)"), "A,15,10,20,14"], "must be 'E_MPa'; multiply by 1000"),
    "E without unit": ([M.replace("E_MPa", "E"), MODULUS], "column 'E' must be 'E_MPa'; give it in MPa"),
    "phase_rad": ([M.replace("phase_deg", "phase_rad"), "A,15,10,20000,.2"], "multiply by 180/pi and rename"),
    "z0 in mm": (
        [P.replace("z0_m", "z0_mm"), "A,15,10,50,.063,14"],
        "'z0_mm' must be 'z0_m'; divide by 1000",
    ),
    "kelvin": ([M.replace("temperature_C", "temperature_K"), MODULUS], "subtract 273.15"),
    "spelling": (
        [M.replace("frequency_Hz", "Frequency_Hz"), MODULUS],
        "'Frequency_Hz' must be 'frequency_Hz'",
    ),
    "GPa under MPa": ([M, "A,15,10,20,14", "A,15,25,22,12"], "line 2: 20 MPa is softer than any asphalt"),
    "one row in GPa": ([M, MODULUS, "A,15,25,22,12"], "line 3: 22 MPa is softer than any asphalt"),
    "warm, in GPa": ([M, "A,50,10,.9,30"], "E_MPa looks like GPa, multiply by 1000"),
    "one row in kN": ([P, PEAK, "A,15,25,.05,63e-6,14"], "line 3: "),
    "Pa under MPa": ([M, "A,15,10,2e10,14"], "line 2: E_MPa = 2e+10 is outside"),
    "radians": (
        [M, "A,15,10,12000,.3", "A,30,10,3000,.7"],
        "the largest phase is 0.7: is it in radians? Multiply by 180",
    ),
    "radians, cold": ([M, "A,-10,10,39000,.026"], "is it in radians?"),
    "psi in radians": ([P, "A,15,10,30,63e-6,.25"], "the largest phase is 0.249: is it in radians?"),
    "phases reversed": (
        [M, "A,15,10,20000,-14", "A,15,25,21000,-13", "A,25,10,9000,20"],
        "the force leads: remove the minus signs.",
    ),
    "z0 in micrometres": ([P, "A,15,10,50,63,14"], "line 2: z0_m = 63 is outside"),
    "z0 in mm under m": ([P, "A,15,10,50,1e-3,14", "A,15,25,50,.063,14"], "line 3: z0_m = 0.063 is outside"),
    "F0 in kN": ([P, "A,15,10,.05,63e-6,14"], "check F0 in N"),
    "E from peaks": ([P, "A,15,10,5e4,63e-6,14"], "line 2: the peaks give E_MPa = 1.992e+07"),
    "zero force": ([P, "A,15,10,0,63e-6,14"], "line 2: F0_N = 0 is outside"),
    "negative modulus": ([M, "A,15,10,-20000,14"], "line 2: E_MPa = -20000 is outside"),
    "phase over 90": ([M, "A,15,10,20000,140"], "line 2: phase_deg = 140 is outside -90 to 90"),
    "zero frequency": ([M, MODULUS, "A,15,0,20000,14"], "line 3: frequency_Hz = 0 is outside"),
    "negative frequency": ([M, "A,15,-3,20000,14"], "line 2: frequency_Hz = -3 is outside"),
    "kelvin under C": ([M, "A,288,10,20000,14"], "line 2: temperature_C = 288 is outside"),
    "NaN": ([M, MODULUS, "", "A,15,25,nan,14"], "line 4: E_MPa = nan is not finite"),
    "infinite": ([M, "A,15,10,inf,14"], "line 2: E_MPa = inf is not finite"),
    "empty field": ([M, "A,15,10,,14"], "line 2: E_MPa is empty"),
    "not a number": ([M, "A,15,10,stiff,14"], "line 2: E_MPa = 'stiff' is not a number"),
    "digits in groups": ([M, "A,15,10,20_000,14"], "line 2: E_MPa = '20_000' is not a number"),
    "formula": ([M, "=1+1,15,10,20000,14"], "line 2: specimen '=1+1' would be a formula in a spreadsheet"),
    "no specimen": ([M, ",15,10,20000,14"], "line 2: specimen is empty"),
    "duplicate": (
        [M, MODULUS, "B,15,10,20000,14", "A,15.0,10,21000,14"],
        "line 4: repeats the test of line 2, with other values (E_MPa 20000 and 21000): is a name, a temperature or",
    ),
    "duplicate of equal values": (
        [M, MODULUS, "B,15,10,20000,14", MODULUS],
        "line 4: repeats the test of line 2, with equal values; keep one of the two.",
    ),
    "a block under another name": (
        [M, MODULUS, "A,25,10,9000,20", "A,15,10,20000,15", "A,25,10,9500,21"],
        "repeats the test of line 2, and so does 1 more row, with other values (phase_deg 14 and 15): is the name of "
        "this block, specimen A, wrong? Correct it.",
    ),
    "a block at another temperature": (
        [M, MODULUS, "A,15,3,18000,16", "A,15,10,9000,20", "A,15,3,7000,22"],
        "is the temperature of this block, 15 degC, or its name, specimen A, wrong? Correct it.",
    ),
    "a digit too many": (
        [M, "A,15,3,18000,16", "A,15,10,200000.1,15", "A,15,25,21000,14"],
        "line 3: |E*| 200000 MPa, where its other frequencies ask for about 19700 MPa: a digit too many",
    ),
    "origin": ([M + ",origin", MODULUS + ",guessed"], "line 2: origin 'guessed' is not known"),
    "no rows": ([M], "the table has a header but no rows"),
    "empty file": ([""], "the file is empty"),
    "semicolons": ([M.replace(",", ";"), MODULUS.replace(",", ";")], "not separated by commas"),
    "ragged": ([M, "A,15,10,20000,14,2"], "line 2: 6 fields under 5 column names"),
    "column twice": ([M + ",E_MPa", MODULUS + ",1"], "appears twice in the header"),
}


@pytest.mark.parametrize("case", BAD_TABLES)
def test_bad_tables_are_refused(write, case):
    lines, words = BAD_TABLES[case]
    path = write(*lines)
    message = refusal(path)
    assert str(path) in message and words in message


def test_cold_mixes_with_small_phases_are_no_mistake(write):
    frame = reduce(write(M, "A,-10,3,39000,1.5", "A,-10,40,41000,0.9"))
    assert len(frame) == 2


def test_a_few_negative_phases_are_kept_for_the_diagnosis(write):
    """Which are so few that their median is above zero, though their mean is not."""
    frame = reduce(write(M, "A,-10,40,40000,-9", "A,-10,10,39000,2", "A,0,10,33000,5"))
    assert frame["phase_deg"].min() == -9


def test_columns_beside_temperature_and_frequency_may_tell_tests_apart(write):
    rows = ["A,15,10,20000,14,1,5e-5", "A,15,10,20500,14,2,5e-5", "A,15,10,20500,14,2,6e-5"]
    table = read_csv(write(M + ",replicate,amplitude_m", *rows))
    frame = reduced_frame(table, {}, tests=(*KEYS, "replicate", "amplitude_m"))
    assert frame["replicate"].tolist() == ["1", "2", "2"] and frame["amplitude_m"].tolist() == [
        5e-5,
        5e-5,
        6e-5,
    ]
    with pytest.raises(InputError, match="line 4: repeats the test of line 3, with equal values"):
        reduced_frame(table, {}, tests=(*KEYS, "replicate"))


def test_a_reduced_table_has_peaks_of_both_kinds_beside_its_moduli():
    assert is_reduced([*REDUCED_COLUMNS, "further"])
    assert not any(is_reduced({*REDUCED_COLUMNS} - {name}) for name in ("E_peak_MPa", "E_MPa", "z0_m", *KEYS))


def test_a_diagnosis_takes_four_tests_at_two_frequencies():
    require_enough(4, 2)
    for tests, frequencies, words in ((3, 2, "3 tests at 2 freq"), (9, 1, "9 tests at 1 frequency are")):
        with pytest.raises(InputError, match=words):
            require_enough(tests, frequencies)


def test_the_softest_mixes():
    """MPa at 1 Hz; ten times faster is 9 K colder, and between two temperatures it falls by decades."""
    softest = {-20: 1000, 0: 300, 10: 120, 30: 25, 50: 6, 70: 2, 90: 1}
    at = np.array([-40, *softest, 110])
    for frequency, colder in ((1.0, 0.0), (10.0, 9.0), (0.01, -18.0)):
        found = least_modulus(at + colder, frequency)
        assert found == pytest.approx([1000, *softest.values(), 1], rel=1e-12)
    assert least_modulus(5.0, 1.0) == pytest.approx(np.sqrt(300 * 120), rel=1e-12)


G = "specimen,b_mm,B_mm,e_mm,h_mm,mass_kg,mobile_mass_kg"
BAD_GEOMETRIES = {
    "specimen without geometry": ([G, "B,25,56,25,250,0.6,0.235"], "specimen 'A' has no geometry (known: B)"),
    "column missing": ([G.replace(",e_mm", ""), "A,25,56,250,0.6,0.235"], "column 'e_mm' is missing"),
    "metres": (
        [G.replace("h_mm", "h_m"), "A,25,56,25,.25,0.6,0.235"],
        "'h_m' must be 'h_mm'; multiply by 1000",
    ),
    "metres under mm": ([G, "A,.025,56,25,250,0.6,0.235"], "line 2: b_mm = 0.025 is outside"),
    "grams under kg": ([G, "A,25,56,25,250,600,235"], "line 2: mass_kg = 600 is outside"),
    "head and foot exchanged": ([G, "A,56,25,25,250,0.6,0.235"], "line 2: geometry: the head"),
    "twice": (
        [G, "A,25,56,25,250,0.6,0.235", "A,25,56,25,250,0.6,0.235"],
        "line 3: specimen 'A' appears twice",
    ),
}


@pytest.mark.parametrize("case", BAD_GEOMETRIES)
def test_bad_geometry_tables_are_refused(write, case):
    lines, words = BAD_GEOMETRIES[case]
    geometry = write(*lines, name="geometry.csv")
    message = refusal(write(P, PEAK), geometry)
    assert str(geometry) in message and words in message


@pytest.mark.parametrize(
    ("mapping", "words"),
    [
        ({key: value for key, value in MAPPING.items() if key != "B_mm"}, "geometry: key 'B_mm' is missing"),
        (MAPPING | {"width": 3}, "geometry: key 'width' is not known"),
        (MAPPING | {"h_mm": "tall"}, "geometry: h_mm = 'tall' is not a number from 20 to 1000"),
        (MAPPING | {"h_mm": 6 * 10**400}, "00 is not a number from 20 to 1000; give the height in mm"),
        (MAPPING | {"h_mm": math.nan}, "geometry: h_mm = nan is not a number"),
        (MAPPING | {"b_mm": 60}, "geometry: geometry: the head"),
        (MAPPING | {"mass_kg": True}, "geometry: mass_kg = True is not a number from 0.001 to 20"),
    ],
)
def test_bad_geometry_mappings_are_refused(write, mapping, words):
    assert words in refusal(write(P, PEAK), mapping)


def test_one_mapping_holds_for_all_specimens_also_as_json(write):
    expected = {"A": PAPER, "B": PAPER}
    assert read_geometry(MAPPING, ["A", "B", "A"]) == expected
    assert read_geometry(write(json.dumps(MAPPING), name="geometry.json"), ["A", "B"]) == expected
    table = write(G, "A,25,60,25,250,0.6,0.235", "specimen,25,56,25,250,0.6,0.235", name="geometry.csv")
    assert read_shape(table) == PAPER


@pytest.mark.parametrize("form", ["moduli", "peaks"])
def test_every_row_of_a_usual_mix_tells_mega_from_giga(write, form):
    """At the paper's temperatures and frequencies, from a soft mix to a stiff one; and so N from kN."""
    temperatures, laws = read_published(ROOT / "data/paper/table3_burgers.csv")
    for temperature, law in zip(temperatures, laws, strict=True):
        for frequency in (1.0, 3.0, 40.0):
            e = complex(law.complex_modulus(2 * np.pi * frequency))
            for share, lower in ((0.4, False), (1.0, False), (1.0, True), (1.3, True)):
                force, psi = head_response(PAPER, frequency, share * e, 63e-6)
                unit = 1e-3 if lower else 1.0
                values = {
                    "moduli": f"{unit * share * abs(e) / 1e6},{np.degrees(np.angle(e))}",
                    "peaks": f"{unit * force},63e-6,{np.degrees(psi)}",
                }[form]
                table = write(HEADS[form], f"A,{temperature},{frequency},{values}")
                if lower:
                    assert "softer than any asphalt" in refusal(table), (temperature, frequency, values)
                else:
                    reduce(table)
                    (table.parent / "measured.csv").unlink()
