"""One file, several or a folder as one campaign: what is taken, what is passed over, and what is refused."""

from __future__ import annotations

import pandas as pd
import pytest
from table_import.slips import columns, exports, plain, refused, said

from asphalt_nscd.files.csvinput import read_csv
from asphalt_nscd.measurements.reduction import reduce_table
from asphalt_nscd.table_import.campaign import read_campaign
from asphalt_nscd.table_import.frames import campaign_of, frame_of

TABLE = "Sample;T (°C);f (Hz);E (MPa);phi (°)\nA;20;10;5000;20\nB;20;10;5100;21\n"
PEAKS = "T_C,f_Hz,F0_N,z0_m,psi_deg\n10,5,60,5e-5,20\n"
NOTES = "Tests of May\nas planned\nWe found E*, phase, and more, at 4 C\n"


def export(specimen="A", temperature=4, factor=1.0, name=None):
    moduli = ",".join(f"{factor * value:g}" for value in (9100 - 100 * temperature, 8000 - 100 * temperature))
    return f"""\
Test Information
Target test temperature,{temperature}
Identification,{name or f"Mix-{specimen}-{temperature}C"}
,25 Hz,10 Hz
Dynamic modulus (MPa),{moduli}
Phase angle (Degrees),12.5,13.25
Average temperature (°C),{temperature + 0.1},{temperature}
Phase uniformity (Degrees),0.9,0.4
"""


def unnamed(temperature, factor):
    return export("A", temperature, factor).replace(f"Mix-A-{temperature}C", "")


def specimens(campaign):
    return campaign.table.columns["specimen"]


def files(campaign):
    return [path.name for path in campaign.files]


def test_a_campaign_as_a_frame_and_back(tmp_path):
    campaign = exports(tmp_path, a=export("A", 4), b=export("B", 4, 1.1))
    frame = frame_of(campaign)
    assert frame["E_MPa"].tolist() == [8700, 7600, 9570, 8360] and frame["specimen"].tolist() == specimens(
        campaign
    )
    assert frame.attrs["test_type"] == "tension-compression" and frame.attrs["source"] == str(tmp_path)
    back = campaign_of(frame.assign(E_MPa=2 * frame["E_MPa"].astype(int)))
    assert plain(back.table) == plain(campaign.table) | {"E_MPa": [17400, 15200, 19140, 16720]}
    assert (back.test_type, back.notes) == (campaign.test_type, campaign.notes)


def test_the_test_type_that_is_stated_comes_before_that_of_a_frame():
    frame = pd.DataFrame(
        {"specimen": ["A"], "temperature_C": [20], "frequency_Hz": [1], "E_MPa": [5e3], "phase_deg": [20]}
    )
    frame.attrs["test_type"] = "bending"
    assert campaign_of(frame, test_type="tension-compression").test_type == "tension-compression"
    assert campaign_of(frame).test_type == "bending"


def test_folder_is_one_table_whose_errors_name_the_file(tmp_path):
    grid = {"a": ("A", 4), "b": ("B", 4, 1.1), "c": ("A", 20), "d": ("B", 20, 1.1)}
    campaign = exports(tmp_path, **{name: export(*what) for name, what in grid.items()})
    assert files(campaign) == ["a.csv", "b.csv", "c.csv", "d.csv"]
    assert specimens(campaign) == ["Mix-A"] * 2 + ["Mix-B"] * 2 + ["Mix-A"] * 2 + ["Mix-B"] * 2
    assert str(campaign.table.error(3, "bad")) == f"{tmp_path / 'b.csv'}, line 5: bad"
    named, form = read_campaign(list(campaign.files))
    assert plain(named.table) == plain(campaign.table)
    assert (named.files, form) == (campaign.files, "moduli")


def test_exports_and_tables_come_together(tmp_path):
    campaign = exports(tmp_path, a=export("A", 4), t=TABLE)
    assert columns(campaign, "specimen", "phase_uniformity_deg", "nominal_temperature_C") == [
        ["Mix-A", "Mix-A", "A", "B"],
        [0.9, 0.4, None, None],
        [4, 4, None, None],
    ]


def test_what_does_not_say_its_origin_beside_what_does_is_measured(tmp_path):
    drawn = export("A", 4).replace("Test Information", "Comments,Synthetic: drawn")
    assert columns(exports(tmp_path, a=drawn, t=TABLE), "origin") == [["synthetic"] * 2 + ["measured"] * 2]


def test_what_holds_no_tests_is_passed_over_with_the_reason(tmp_path):
    (tmp_path / "b.csv.bak").write_text(export("B", 4))
    (tmp_path / "scan.pdf").write_bytes(b"%PDF")
    (tmp_path / "notes.txt").write_text(NOTES)
    (tmp_path / ".hidden.csv").write_text("rubbish")
    (tmp_path / "old").mkdir()
    sieves = "sieve (mm),passing (%)\n8,100\n4,70\n"
    campaign = exports(tmp_path, a=export("A", 4), sieves=sieves, empty="", notes=NOTES)
    assert files(campaign) == ["a.csv"]
    assert len(campaign.table.lines) == 2
    for name in ("sieves.csv", "scan.pdf", "old", "empty.csv", "notes.txt", "notes.csv"):
        assert said(campaign, f"skipped {name} (")
    assert not said(campaign, "hidden")
    for name in ("empty.csv", "sieves.csv", "b.csv.bak"):
        assert name in " ".join(campaign.without_tests)
    assert campaign.without_tests[0].startswith("5 of 6 files gave no test: ")


@pytest.mark.parametrize(
    ("b", "names"),
    [
        (export("B", 4).replace("8700", "87x0"), ["b.csv, line 5", "Dynamic modulus (MPa)", "87x0"]),
        (TABLE.replace("5000", "many"), ["b.csv, line 2", "E (MPa)", "many"]),
        ("specimen;T (°C);E (GPa) at 10 Hz;phi (°) at 10 Hz\nB;4;9;20;7\n", ["b.csv, line 2", "5 fields"]),
        ("PK rubbish", ["b.csv", "workbook"]),
        (export("A", 4, 1.2), ["a.csv and b.csv", "Mix-A", "4 degC, 25 Hz"]),
        (PEAKS, ["moduli and peaks"]),
    ],
)
def test_damaged_or_contested_results_in_a_folder_are_refused_not_passed_over(tmp_path, b, names):
    refused(exports, tmp_path, a=export("A", 4), b=b, names=names)


def test_one_specimen_in_several_spellings_is_one(tmp_path):
    spelt = {t: export(temperature=t, name=name) for t, name in ((4, "Mix-A"), (20, "mix a"), (35, "MIX_A"))}
    campaign = exports(tmp_path, a=spelt[4], b=spelt[20], c=spelt[35], d=export("B", 4, 1.1))
    assert set(specimens(campaign)) == {"Mix-A", "Mix-B"}


def test_a_table_that_holds_the_tests_of_the_exports_is_passed_over(tmp_path):
    table = "specimen,temperature_C,frequency_Hz,E_MPa,phase_deg\nK1,4.0,25.0,8700.4,12.50\nK1,4.0,10.0,7600,13.25\n"
    campaign = exports(tmp_path, a=export("A", 4), table=table)
    assert said(campaign, "skipped table.csv", "a.csv")
    assert specimens(campaign) == ["Mix-A"] * 2
    # One test more, and it is no copy.
    assert len(exports(tmp_path, table=f"{table}K1,4.0,1.0,6000,14\n").table.lines) == 5


@pytest.mark.parametrize(
    ("kept", "copy", "specimen", "names"),
    [
        ("a", "copy", "A", ["a.csv"]),
        ("K10", "K10 - Copy", "A", ["K10.csv"]),  # the original
        ("a", "b", "B", ["Mix-B and Mix-A"]),
    ],
)
def test_the_same_export_twice_counts_once(tmp_path, kept, copy, specimen, names):
    campaign = exports(tmp_path, **{kept: export("A", 4), copy: export(specimen, 4)})
    assert files(campaign) == [f"{kept}.csv"]
    assert len(campaign.table.lines) == 2
    assert said(campaign, f"skipped {copy}.csv", *names)


@pytest.mark.parametrize("names", [("a", "b"), ("b", "a")])
def test_repeated_test_is_taken_instead_of_the_first_and_said(tmp_path, names):
    repeated = export("A", 4, 1.2, name="Mix-A-4C-Repeated")
    campaign = exports(tmp_path, **{names[0]: export("A", 4), names[1]: repeated}, c=export("A", 20))
    assert columns(campaign, "E_MPa") == [[10440, 9120, 7100, 6000]]
    assert said(campaign, f"{names[1]}.csv is taken instead of {names[0]}.csv")


def test_a_repetition_that_the_name_of_its_file_alone_tells_is_taken(tmp_path):
    campaign = exports(
        tmp_path, **{"A_4C_repeated": export("A", 4, 1.2), "A_4C": export("A", 4)}, c=export("A", 20)
    )
    assert columns(campaign, "E_MPa") == [[10440, 9120, 7100, 6000]]
    assert said(campaign, "A_4C_repeated.csv is taken instead of A_4C.csv")


def test_what_reduce_wrote_is_taken_as_it_is(tmp_path):
    rows = [f"A,{t},{f},{9000.123456789012 - 100 * t + f},20\n" for t in (0, 10) for f in (1, 10)]
    header = "specimen,temperature_C,frequency_Hz,E_MPa,phase_deg\n"
    (tmp_path / "m.csv").write_text(header + "".join(rows))
    geometry = {"b_mm": 25, "B_mm": 56, "e_mm": 25, "h_mm": 250, "mass_kg": 0.6, "mobile_mass_kg": 0.235}
    reduce_table(tmp_path / "m.csv", geometry, tmp_path / "reduced.csv")
    campaign, _ = read_campaign([tmp_path / "reduced.csv"])
    for name in ("E_MPa", "phase_deg", "temperature_C"):
        assert (campaign.table.numbers(name) == read_csv(tmp_path / "reduced.csv").numbers(name)).all()
    # Every digit of a plain table stays, too.
    as_given, _ = read_campaign([tmp_path / "m.csv"])
    assert (as_given.table.numbers("E_MPa") == read_csv(tmp_path / "m.csv").numbers("E_MPa")).all()


def test_files_with_numbers_for_names(tmp_path):
    """At one temperature they are specimens; at several nobody can say."""
    assert set(specimens(exports(tmp_path, **{"1": unnamed(4, 1.0), "2": unnamed(4, 2.0)}))) == {"1", "2"}
    grid = [(s, t) for s in range(2) for t in (4, 20)]
    numbered = {str(n): unnamed(t, 1.0 + 0.1 * s) for n, (s, t) in enumerate(grid, start=1)}
    refused(exports, tmp_path, **numbered, names=[str(tmp_path), "4 files, 4 specimens"])
    for n, (s, t) in enumerate(grid, start=1):
        (tmp_path / f"{n}.csv").rename(tmp_path / f"K{s}_{t}C.csv")
    assert set(specimens(read_campaign([tmp_path])[0])) == {"K0", "K1"}


@pytest.mark.parametrize(("unit", "read_as"), [("psi", "62.1 MPa"), ("GPa", "9e+06 MPa")])
def test_megapascals_under_another_unit_are_asked_for(tmp_path, unit, read_as):
    rows = [f"A,{t},{f},{9000 - 100 * t + 100 * f:g},{10 + t / 4}" for t in (5, 15) for f in (1, 5)]
    table = "\n".join(["specimen,T (C),f (Hz),|E*| (MPa),phi (deg)", *rows])
    refused(exports, tmp_path, t=table.replace("MPa", unit), names=[str(tmp_path), unit, read_as])
    exports(tmp_path, t=table)
