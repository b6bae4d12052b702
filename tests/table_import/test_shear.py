"""Sweeps of a shear rheometer in the layouts of its programs."""

from __future__ import annotations

import numpy as np
import openpyxl
import pytest

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.forecasting.rheometer import read_rheometer
from asphalt_nscd.table_import.campaign import read_campaign
from asphalt_nscd.table_import.shear import is_shear, read_sweeps

TEMPERATURES, OMEGA = (10, 30, 50), np.array([0.628, 2.51, 10.0, 62.8])


def shear(omega, temperature):
    """A liquid without a law: modulus and phase of any sweep."""
    return (
        1e6
        * omega**0.7
        * 10.0 ** (-0.06 * temperature)
        * np.exp(1j * np.radians(40 + 0.6 * temperature - 3 * omega**0.3))
    )


POINTS = [(t, w, shear(w, t)) for t in TEMPERATURES for w in OMEGA]


def anton_paar(mark="."):
    """A block for each temperature: a line of names, one of units, and a line of its number above."""
    lines = ["Project:\tBitumen 50/70", "Test:\tFS 25 mm EN 14770", ""]
    names = "Interval data:\tPoint No.\tTemperature\tAngular Frequency\tStorage Modulus\tLoss Modulus\t"
    for n, t in enumerate(TEMPERATURES, 1):
        lines += [
            f"Interval and data points:\t{n}\t4",
            f"{names}Complex Shear Modulus\tPhase Shift Angle\tShear Strain",
        ]
        lines.append("\t\t[°C]\t[rad/s]\t[Pa]\t[Pa]\t[Pa]\t[°]\t[%]")
        for k, w in enumerate(OMEGA, 1):
            g = shear(w, t)
            row = [
                k,
                t,
                w,
                *(f"{x:.7E}" for x in (g.real, g.imag, abs(g))),
                f"{np.degrees(np.angle(g)):.6f}",
                0.5,
            ]
            lines.append("\t" + "\t".join(map(str, row)).replace(".", mark))
        lines.append("")
    return "\n".join(lines)


def trios(units=("MPa", "MPa", "MPa")):
    """Steps, each with names and units of its own; `units` of |G*| by step."""
    lines = ["Filename\tsweep.tri", "Instrument name\tDHR-2", "Operator\tlab"]
    for n, (t, unit) in enumerate(zip(TEMPERATURES, units, strict=True), 1):
        lines += [
            "",
            "[step]",
            f"Frequency sweep - {n}",
            "Angular frequency\tStep time\tTemperature\tComplex modulus\tPhase angle",
        ]
        lines.append(f"rad/s\ts\t°C\t{unit}\t°")
        size = {"MPa": 1e-6, "kPa": 1e-3, "Pa": 1.0}[unit]
        for w in OMEGA:
            g = shear(w, t)
            lines.append(f"{w}\t12.3\t{t}\t{size * abs(g):.7e}\t{np.degrees(np.angle(g)):.6f}")
    return "\n".join(lines)


def table(
    separator=",",
    mark=".",
    head="Temp (°C);Ang. frequency (rad/s);|G*| (Pa);δ (°);G' (Pa);G'' (Pa)",
    omega=1.0,
):
    lines = [head.replace(";", separator)]
    for t, w, g in POINTS:
        row = (t, w * omega, abs(g), np.degrees(np.angle(g)), g.real, g.imag)
        lines.append(separator.join(f"{x:.9g}".replace(".", mark) for x in row))
    return "\n".join(lines)


def reads(path):
    temperature, omega, modulus = read_rheometer(path, read_sweeps)
    assert temperature.tolist() == [t for t, _, _ in POINTS]
    assert omega == pytest.approx([w for _, w, _ in POINTS], rel=1e-6)
    assert modulus == pytest.approx(np.array([g for _, _, g in POINTS]), rel=1e-5)


@pytest.mark.parametrize(
    ("text", "encoding"),
    [
        (anton_paar(), "utf-8"),
        (anton_paar(","), "utf-16"),
        (trios(), "utf-8"),
        (trios(("MPa", "kPa", "Pa")), "utf-8"),
        (table(), "utf-8"),
        (table(";", ","), "cp1252"),
        (table("\t", head="Temp (°C);Ang. Freq. (rad/sec);|G*| (Pa);Phase Angle δ (°);a;b"), "utf-8"),
        (table(head="temperature_C;angular_frequency_rad_s;G_Pa;phase_deg;G1_Pa;G2_Pa"), "utf-8"),
        (
            table(head="T [°C];f [Hz];Complex modulus G* [Pa];Phase angle [deg];a;b", omega=0.5 / np.pi),
            "utf-8",
        ),
        (table(head="T [°C];omega [rad/s];a;b;Storage modulus G' [Pa];Loss modulus G'' [Pa]"), "utf-8"),
    ],
)
def test_an_export_is_read_as_it_is(tmp_path, text, encoding):
    path = tmp_path / "dsr.txt"
    path.write_bytes(text.replace("δ", "delta").encode(encoding))
    reads(path)


def test_a_workbook_with_a_sheet_for_each_step(tmp_path):
    book = openpyxl.Workbook()
    book.active.append(["Sample name", "50/70"])
    book.active.append(["Operator", "lab"])
    for n, t in enumerate(TEMPERATURES, 1):
        sheet = book.create_sheet(f"Frequency sweep - {n}")
        sheet.append(["Temperature (°C)", "Angular frequency (rad/s)", "|G*| (kPa)", "δ (°)"])
        for w in OMEGA:
            g = shear(w, t)
            sheet.append([t, float(w), 1e-3 * float(abs(g)), float(np.degrees(np.angle(g)))])
    book.save(tmp_path / "dsr.xlsx")
    reads(tmp_path / "dsr.xlsx")


def test_a_point_may_be_measured_twice(tmp_path):
    """With two plates, say: no specimen tells them apart, and none need."""
    text = table()
    (tmp_path / "dsr.csv").write_text(f"{text}\n{text.splitlines()[-1]}\n", encoding="utf-8")
    assert read_rheometer(tmp_path / "dsr.csv", read_sweeps)[0].size == len(POINTS) + 1


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (table(head="T (°C);Frequency (Hz);G* (Pa);δ (°);a;b"), "0.628, .* look like rad/s"),
        (
            table(head="T (°C);omega (rad/s);G*;δ (°);a;b"),
            r"column 'G\*' does not say its unit; write it .* as in G \(MPa\)",
        ),
        (table(head="T (°C);omega (rad/s);|E*| (Pa);δ (°);a;b"), "line 1: names Young's modulus"),
        (table(head="T (°C);a;G* (Pa);δ (°);b;c"), "no column for frequency .*give columns temperature"),
        (
            table(head="T (°C);omega (rad/s);G* (Pa);a;b;c"),
            "give columns temperature .* units in their names",
        ),
        (table(head="T (°C);omega (rad/s);G* (MPa);δ (°);a;b"), "G_MPa = .* is outside"),
        ("a note\nand another\n", "dsr.csv"),
    ],
)
def test_a_table_that_cannot_be_one_is_refused_without_a_way_to_other_commands(tmp_path, text, said):
    (tmp_path / "dsr.csv").write_text(text, encoding="utf-8")
    with pytest.raises(InputError, match=said) as caught:
        read_rheometer(tmp_path / "dsr.csv", read_sweeps)
    assert not any(word in str(caught.value) for word in ("--", "new-study", "E*", "point)"))


@pytest.mark.parametrize("text", [anton_paar(), table()])
def test_a_campaign_of_mixes_refuses_the_moduli_of_a_binder(tmp_path, text):
    (tmp_path / "dsr.csv").write_text(text, encoding="utf-8")
    with pytest.raises(InputError, match="is of a shear modulus, as binders have.*forecast"):
        read_campaign([tmp_path / "dsr.csv"])


def test_names_of_shear_moduli():
    names = {
        "G' (Pa)": True,
        "G_MPa": True,
        "Shear modulus (Pa)": True,
        "Shear stress (Pa)": False,
        "E* (MPa)": False,
        "Grade": False,
    }
    assert {name: is_shear(name) for name in names} == names
