"""Workbooks as laboratories lay them out: what each holds, by value, unit and specimen."""

from __future__ import annotations

import math
from itertools import product

import pytest
from table_import.slips import columns, read, refused

from asphalt_nscd.table_import.campaign import read_campaign

SPECIMENS, TEMPERATURES, FREQUENCIES = ("A", "B"), (4.0, 21.0, 37.0), (10.0, 1.0, 0.1)


def modulus(s, t, f):
    return round(16000 - 380 * t + 900 * math.log10(f) + 111 * "AB".index(s))


def phase(s, t, f):
    return round(9 + 0.6 * t - 3 * math.log10(f) + 0.1 * "AB".index(s), 1)


TESTS = {
    (s, t, f): (modulus(s, t, f), phase(s, t, f)) for s, t, f in product(SPECIMENS, TEMPERATURES, FREQUENCIES)
}
OF_A = {key: both for key, both in TESTS.items() if key[0] == "A"}
KEYS = ["T (°C)", "f (Hz)"]


def conditions():
    return product(TEMPERATURES, FREQUENCIES)


def replicates(label, *, merged=False):
    head = [*KEYS, "|E*| (MPa)", None, "Phase angle (°)", None]
    rows = []
    for t, f in conditions():
        shown = None if merged and f != FREQUENCIES[0] else t
        rows.append([shown, f, *(modulus(s, t, f) for s in "AB"), *(phase(s, t, f) for s in "AB")])
    return [head, [None, None, *(label.format(s) for s in "AB"), *(label.format(s) for s in "AB")], *rows]


@pytest.mark.parametrize("other", list("BDEL"))
def test_a_specimen_may_have_any_letter(tmp_path, other):
    names = ["E* A (MPa)", f"E* {other} (MPa)", "Phase A (°)", f"Phase {other} (°)"]
    table = read(tmp_path, [[*KEYS, *names], *flat("", "")[1:]], "t.xlsx")
    of = dict(zip(SPECIMENS, ("A", other), strict=True))
    found = zip(
        *columns(table, "specimen", "temperature_C", "frequency_Hz", "E_MPa", "phase_deg"), strict=True
    )
    assert {(s, t, f): (e, p) for s, t, f, e, p in found} == {
        (of[s], t, f): both for (s, t, f), both in TESTS.items()
    }


def flat(modulus_name, phase_name):
    names = [*KEYS, *(modulus_name.format(n) for n in (1, 2)), *(phase_name.format(n) for n in (1, 2))]
    rows = [
        [t, f, *(modulus(s, t, f) for s in "AB"), *(phase(s, t, f) for s in "AB")] for t, f in conditions()
    ]
    return [names, *rows]


def with_means():
    head = [*KEYS, "|E*| (MPa)", None, None, None, "Phase (°)", None]
    below = [None, None, "1", "2", "Mean", "CV (%)", "1", "2"]
    rows = []
    for t, f in conditions():
        e = [modulus(s, t, f) for s in "AB"]
        rows.append([t, f, *e, sum(e) / 2, 1.0, *(phase(s, t, f) for s in "AB")])
    return [head, below, *rows]


def matrix(show, *, corner=None, across=False, s="A"):
    if across:
        return [[corner, *TEMPERATURES], *([f, *(show(s, t, f) for t in TEMPERATURES)] for f in FREQUENCIES)]
    return [[corner, *FREQUENCIES], *([t, *(show(s, t, f) for f in FREQUENCIES)] for t in TEMPERATURES)]


def one_quantity(title, show):
    rows = [
        [t if f == 10.0 else None, f, *(show(s, t, f) for s in "AB"), show("A", t, f)]
        for t, f in conditions()
    ]
    return [[title], [*KEYS, "T1", "T2", "Mean"], *rows]


def at_temperatures(name, phase_name):
    names = ["Specimen", "f (Hz)"]
    names += [name.format(t) for t in TEMPERATURES] + [phase_name.format(t) for t in TEMPERATURES]
    rows = [
        [s, f, *(modulus(s, t, f) for t in TEMPERATURES), *(phase(s, t, f) for t in TEMPERATURES)]
        for s in "AB"
        for f in FREQUENCIES
    ]
    return [names, *rows]


def long(names, convert=lambda e, p: (e, p)):
    return [["Core", *names], *([s, t, f, *convert(e, p)] for (s, t, f), (e, p) in TESTS.items())]


def parts(e, p):
    return e * math.cos(math.radians(p)), e * math.sin(math.radians(p))


def under(s, *lines):
    return [*lines, ["T° (°C)", "Freq. (Hz)", "E* (MPa)", "δ (°)"]] + [
        [t, f, modulus(s, t, f), phase(s, t, f)] for t, f in conditions()
    ]


FILES = {
    "letters that are units": (
        [replicates("{}")[0], [None, None, "C", "F", "C", "F"], *replicates("{}")[2:]], TESTS),
    "below a title": ([["Dynamic modulus, AASHTO T 378"], ["Mix", "A 13"], *replicates("Sample {}")], TESTS),
    "E1, E2 as specimens": (flat("E{} (MPa)", "phi {} (°)"), TESTS),
    "means beside": (with_means(), TESTS),
    "E* (4 °C)": (at_temperatures("E* (MPa) (T={:g} °C)", "phi (°) (T={:g} °C)"), TESTS),
    "matrices, temperature across": (
        [["E* (MPa)"], [None, "Temperature (°C)"], *matrix(modulus, corner="f (Hz)", across=True),
         ["phi (°)"], [None, "Temperature (°C)"], *matrix(phase, corner="f (Hz)", across=True)], OF_A),
    "two sheets": (
        {"Modulus": [["E* (MPa)"], [None, "f (Hz)"], *matrix(modulus, corner="T (°C)")],
         "Phase": [["Phase (°)"], [None, "f (Hz)"], *matrix(phase, corner="T (°C)")]}, OF_A),
    "title with en": (
        {"Module": [["Module complexe |E*| en MPa"], *matrix(modulus, corner="T (°C) \\ f (Hz)")],
         "Angle": [["Angle de phase en °"], *matrix(phase, corner="T (°C) \\ f (Hz)")]}, OF_A),
    "two languages": (
        long(["Température / Temperature (°C)", "Fréquence / Frequency (Hz)",
              "Module complexe / Complex modulus (MPa)", "Déphasage / Phase angle (°)"]), TESTS),
    "German in the genitive": (
        long(["Prüftemp. [°C]", "Frequenz [1/s]", "Betrag des komplexen Moduls |E*| [N/mm²]",
              "Phasenverschiebungswinkel φ [°]"]), TESTS),
    "French without accents": (
        long(["Temperature essai (C)", "Frequence (Hz)", "Norme du module (MPa)", "Angle (degres)"]), TESTS),
    "Spanish": (long(["Temp. (°C)", "Frec. (Hz)", "Rigidez (MPa)", "Desfase (°)"]), TESTS),
    "Portuguese": (
        long(["Temperatura (°C)", "Frequência (Hz)", "Módulo dinâmico (MPa)", "Ângulo de fase (°)"]), TESTS),
    "target and actual": (
        [["Core", "Target temperature (°C)", "Actual temperature (°C)", "Target frequency (Hz)",
          "Actual frequency (Hz)", "E* (MPa)", "phi (°)"],
         *([s, t + 0.2, t, f + 0.01, f, e, p] for (s, t, f), (e, p) in TESTS.items())], TESTS),
    "target alone": (long(["Target temperature (°C)", "Target frequency (Hz)", "E* (MPa)", "phi (°)"]), TESTS),
    "remarks beside": (
        [[*row, None, "Air voids", 5.1] if n in (1, 3) else row
         for n, row in enumerate(long([*KEYS, "E* (MPa)", "phi (°)"]))], TESTS),
    "units below, the mix above": (
        [["Mischgut:", "AC 22 T S 30/45"], ["Probekörper", "Prüftemperatur", "Frequenz", "Steifigkeitsmodul |E*|",
                                            "Phasenwinkel"], ["", "°C", "Hz", "MPa", "°"], *long([])[1:]], TESTS),
    "units below, one unknown": (
        [["Beam", "Temp", "Freq", "Stiffness", "Phase", "Dissipated energy"], ["", "°C", "Hz", "MPa", "deg", "J/m3"],
         *([*row, 12.5] for row in long([])[1:])], TESTS),
    "means at the end, named once": (
        [["Core", *KEYS, "E* (MPa)", "phi (°)"],
         *([s if (t, f) == (4.0, 10.0) else None, t if f == 10.0 else None, f, e, p]
           for (s, t, f), (e, p) in TESTS.items()),
         *(["Mittelwert" if f == 10.0 else None, 21.0, f, 9000, 21.0] for f in FREQUENCIES)], TESTS),
    "specimens across, quantities below each other": (
        [["EN 12697-26 (2PB-TR) - Complex modulus"], *one_quantity("Complex modulus |E*| [MPa]", modulus), [],
         *one_quantity("Phase angle φ [°]", phase)], TESTS),
    "specimens across, a sheet for each quantity": (
        {"E": one_quantity("Complex modulus |E*| [MPa]", modulus), "P": one_quantity("Phase [°]", phase)}, TESTS),
    "names over two lines below titles": (
        [["EN 12697-26 (2PB-TR) - Complex modulus"], ["Mixture: EME2"], [],
         [None, None, "Complex modulus |E*| [MPa]", None, "Phase angle φ [°]", None], [*KEYS, "T1", "T2", "T1", "T2"],
         *replicates("", merged=True)[2:]], TESTS),
    "E* T1 (MPa)": (
        [[*KEYS, "E* T1 (MPa)", "E* T2 (MPa)", "phase T1 (°)", "phase T2 (°)", "Mean"],
         *([*row, 1] for row in replicates("")[2:])], TESTS),
    "E1 and E2": (long([*KEYS, "E1 (MPa)", "E2 (MPa)"], parts), TESTS),
}  # fmt: skip


def held(campaign, specimens):
    """Tests by specimen, temperature and frequency; the specimens are told by their order."""
    cells = columns(campaign, "specimen", "temperature_C", "frequency_Hz", "E_MPa", "phase_deg")
    names = list(dict.fromkeys(cells[0]))
    assert len(names) == specimens
    rows = (("AB"[names.index(s)], *rest) for s, *rest in zip(*cells))
    return {(s, t, f): (e, p) for s, t, f, e, p in rows}


@pytest.mark.parametrize(
    ("name", "ending"),
    [
        (name, ending)
        for ending in ("xlsx", "csv")
        for name, (rows, _) in FILES.items()
        if ending == "xlsx" or not isinstance(rows, dict)  # several sheets fit into no CSV file
    ],
)
def test_what_laboratories_have_is_read(tmp_path, name, ending):
    rows, tests = FILES[name]
    found = held(read(tmp_path, rows, f"t.{ending}"), len({s for s, _, _ in tests}))
    assert found.keys() == tests.keys()
    for key, (e, p) in tests.items():
        assert found[key] == (pytest.approx(e, rel=1e-9), pytest.approx(p, abs=1e-6))


def derived(names, convert):
    return [["Core", *names], *([s, *convert(t, f, *both)] for (s, t, f), both in TESTS.items())]


REDUCED = derived(
    ["T (°C)", "Reduced frequency (Hz)", "E* (MPa)", "phi (°)"], lambda t, f, e, p: (t, f * 9, e, p)
)
LOG_F = derived(["T (°C)", "log f (Hz)", "E* (MPa)", "phi (°)"], lambda t, f, e, p: (t, math.log10(f), e, p))
MATRIX = [["E* (MPa)"], *matrix(modulus, corner="T (°C) \\ f (Hz)")]
PAIR = [[*KEYS, "E (MPa)", "phi (°)"], [4, 10, 9000, 12]]


@pytest.mark.parametrize(
    ("rows", "chosen", "name"),
    [
        (LOG_F, {}, "column 'log f (Hz)'"),
        (LOG_F, {"frequency_Hz": "log f (Hz)"}, "'log f (Hz)'"),
        (derived(["T (°C)", "f (Hz)", "log |E*| (MPa)", "phi (°)"], lambda t, f, e, p: (t, f, math.log10(e), p)), {},
         "column 'log |E*| (MPa)'"),
        (REDUCED, {}, "column 'Reduced frequency (Hz)'"),
        (REDUCED, {"frequency_Hz": "Reduced frequency (Hz)"}, "'Reduced frequency (Hz)'"),
        (derived(["T (°C)", "f (Hz)", "quantity", "value"],
                 lambda t, f, e, p: (t, f, "E* (MPa)" if f > 1 else "phi (°)", e)), {}, "column 'quantity'"),
        (derived(["T (°C)", "f (Hz)", "E* (MPa)", "lag"], lambda t, f, e, p: (t, f, e, f"{p}°")), {}, "phase"),
        ([[*row, None, 7.0] if n == 1 else row for n, row in enumerate(FILES["E1 and E2"][0])], {},
         "7 fields under 5"),  # numbers beside the table
        ([["   ".join(map(str, row))] for row in PAIR], {}, "separate"),
        ([[" | ".join(map(str, row))] for row in PAIR], {}, "separate"),
        ([*MATRIX, [], ["E* (MPa)"], *matrix(modulus, corner="T (°C) \\ f (Hz)", s="B")], {}, "specimens"),
        ([row[:5] for row in flat("E* {} (MPa)", "Phase (°)")], {}, "not the same for all quantities"),
    ],
)  # fmt: skip
def test_what_stands_in_place_of_a_quantity_is_named(tmp_path, rows, chosen, name):
    refused(read, tmp_path, rows, **chosen, names=["t.csv", name])


def test_a_text_is_no_name_of_a_column(tmp_path):
    """Nor is it searched word by word: eight thousand took minutes."""
    long_name = "E / " * 50 + "E (MPa)"
    refused(read, tmp_path, [[*KEYS, long_name, "phi (°)"], PAIR[1]], names=["no column for |E*|"])
    table = read(tmp_path, [[*KEYS, long_name[-23:], "phi (°)"], PAIR[1]]).table
    assert table.numbers("E_MPa").tolist() == [9000]


def test_degrees_fahrenheit_by_hertz_without_phase(tmp_path):
    head = ["T (°F)", *FREQUENCIES]
    rows = [[1.8 * t + 32, *(modulus("A", t, f) / 6.894757293 for f in FREQUENCIES)] for t in TEMPERATURES]
    campaign = read(tmp_path, [["Dynamic modulus, ksi"], [None, "Frequency (Hz)"], head, *rows], "t.xlsx")
    assert "phase_deg" not in campaign.table.columns
    for t, f, e in zip(*columns(campaign, "temperature_C", "frequency_Hz", "E_MPa")):
        assert e == pytest.approx(modulus("A", round(t, 2), f), rel=1e-6)


def test_rows_of_single_tests_are_no_matrix(tmp_path):
    """A specimen called 1B is no corner, and what stands behind it no axis."""
    rows = [
        [f"1{s}", t, f, e, p] for (s, t, f), (e, p) in sorted(TESTS.items(), key=lambda item: item[0][1:])
    ]
    assert held(read(tmp_path, [["specimen", *KEYS, "E (MPa)", "phi (°)"], *rows]), 2) == TESTS


def test_title_lines_of_a_text_file(tmp_path):
    lines = ["Essai de module complexe NF EN 12697-26", "Enrobé : EME 2 0/14, liant 20/30", ""]
    lines += ["Éprouvette;Température (°C);Fréquence (Hz);Module (MPa);Angle de phase (°)"]
    lines += [f"{s};{t:g};{f:g};{e};{p}".replace(".", ",") for (s, t, f), (e, p) in TESTS.items()]
    (tmp_path / "t.csv").write_bytes("\r\n".join(lines).encode("cp1252"))
    assert held(read_campaign([tmp_path / "t.csv"])[0], 2) == TESTS


def test_specimen_and_temperature_before_those_across_are_no_head_of_an_export(tmp_path):
    across = [value for t in TEMPERATURES for value in (t, None)]
    rows = [["Specimen", "Temperature (°C)", *across], [None, "f (Hz)", *["E* (MPa)", "Phase (°)"] * 3]]
    for s, f in product(SPECIMENS, FREQUENCIES):
        rows.append([s, f, *(one(s, t, f) for t in TEMPERATURES for one in (modulus, phase))])
    table = read(tmp_path, rows, "t.xlsx")
    found = zip(
        *columns(table, "specimen", "temperature_C", "frequency_Hz", "E_MPa", "phase_deg"), strict=True
    )
    assert {(s, t, f): (e, p) for s, t, f, e, p in found} == TESTS
