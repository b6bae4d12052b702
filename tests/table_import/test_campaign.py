"""One file, several or a folder as one campaign: what is taken, what is passed over, and what is refused."""

from __future__ import annotations

import pytest

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.table_import.campaign import read_campaign


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


def save(folder, **files):
    for name, text in files.items():
        (folder / f"{name}.csv").write_text(text, encoding="utf-8")
    return folder


def said(campaign, part):
    return [note for note in campaign.notes if part in note]


TABLE = "Sample;T (°C);f (Hz);E (MPa);phi (°)\nA;20;10;5000;20\nB;20;10;5100;21\n"


def test_folder_is_one_table_whose_errors_name_the_file(tmp_path):
    save(tmp_path, a=export("A", 4), b=export("B", 4, 1.1), c=export("A", 20), d=export("B", 20, 1.1))
    campaign, form = read_campaign([tmp_path])
    assert form == "moduli" and [path.name for path in campaign.files] == ["a.csv", "b.csv", "c.csv", "d.csv"]
    assert campaign.table.columns["specimen"] == ["Mix-A"] * 2 + ["Mix-B"] * 2 + ["Mix-A"] * 2 + ["Mix-B"] * 2
    assert str(campaign.table.error(3, "bad")) == f"{tmp_path / 'b.csv'}, line 5: bad"
    assert said(campaign, "2 specimens: Mix-A, Mix-B") and len(said(campaign, "machine export: ")) == 1


def test_several_files_are_as_their_folder(tmp_path):
    save(tmp_path, a=export("A", 4), b=export("B", 4, 1.1))
    together, _ = read_campaign([tmp_path])
    named, _ = read_campaign([tmp_path / "a.csv", tmp_path / "b.csv"])
    assert named.table.columns == together.table.columns and named.files == together.files


def test_exports_and_tables_come_together(tmp_path):
    save(tmp_path, a=export("A", 4), t=TABLE)
    campaign, _ = read_campaign([tmp_path])
    assert campaign.table.columns["specimen"] == ["Mix-A", "Mix-A", "A", "B"]
    assert campaign.table.columns["phase_uniformity_deg"] == ["0.9", "0.4", "", ""]
    assert campaign.table.columns["nominal_temperature_C"] == ["4", "4", "", ""]


def test_what_holds_no_tests_is_passed_over_with_the_reason(tmp_path):
    save(tmp_path, a=export("A", 4), sieves="sieve (mm),passing (%)\n8,100\n4,70\n", empty="")
    (tmp_path / "scan.pdf").write_bytes(b"%PDF")
    (tmp_path / "old").mkdir()
    (tmp_path / ".hidden.csv").write_text("rubbish")
    campaign, _ = read_campaign([tmp_path])
    assert [path.name for path in campaign.files] == ["a.csv"]
    assert said(campaign, "skipped sieves.csv (no columns for temperature, frequency, |E*| and phase)")
    assert said(campaign, "skipped scan.pdf (neither CSV, TSV, TXT nor XLSX)")
    assert said(campaign, "skipped old (a folder;") and said(
        campaign, "skipped empty.csv (the file is empty)"
    )
    assert not said(campaign, "hidden")
    (sentence,) = campaign.without_tests
    assert sentence.startswith(
        "2 of 3 files gave no test: empty.csv (the file is empty); sieves.csv (no columns"
    )


def test_folder_without_tests_is_refused(tmp_path):
    with pytest.raises(InputError, match="no file with tests; give the machine's exports"):
        read_campaign([tmp_path])
    (tmp_path / "scan.pdf").write_bytes(b"%PDF")
    with pytest.raises(InputError, match=r"no file with tests; it holds scan\.pdf \(neither"):
        read_campaign([tmp_path])


def test_a_table_with_another_ending_is_named_in_the_verdict(tmp_path):
    save(tmp_path, a=export("A", 4))
    (tmp_path / "b.csv.bak").write_text(export("B", 4))
    (tmp_path / "c.xls").write_bytes(b"\xd0\xcf\x11\xe0")
    (tmp_path / "notes.txt").write_text("Tested in May.\n")
    (tmp_path / "scan.pdf").write_bytes(b"%PDF")
    campaign, _ = read_campaign([tmp_path])
    assert campaign.without_tests == (
        "2 of 3 files gave no test: b.csv.bak, c.xls (neither CSV, TSV, TXT nor XLSX).",
    )
    assert said(campaign, "skipped notes.txt") and said(campaign, "skipped scan.pdf")


def test_one_specimen_in_several_spellings_is_one(tmp_path):
    save(tmp_path, a=export(temperature=4, name="Mix-A"), b=export(temperature=20, name="mix a"))
    save(tmp_path, c=export(temperature=35, name="MIX_A"), d=export("B", 4, 1.1))
    campaign, _ = read_campaign([tmp_path])
    assert set(campaign.table.columns["specimen"]) == {"Mix-A", "Mix-B"}
    assert said(campaign, "mix a, MIX_A taken for specimen Mix-A, spelt otherwise")


def test_a_folder_of_folders_says_to_give_these(tmp_path):
    (tmp_path / "A").mkdir()
    save(tmp_path / "A", a=export("A", 4))
    with pytest.raises(
        InputError, match=r"no file with tests; it holds A \(a folder.*give the folders in it by"
    ):
        read_campaign([tmp_path])


def test_one_reason_of_many_files_is_said_once(tmp_path):
    for n in range(9):
        save(tmp_path, **{f"e{n}": export("A", 4, 1.0 + n).replace(" (MPa)", "")})
    with pytest.raises(InputError) as error:
        read_campaign([tmp_path])
    assert str(error.value) == (
        f"{tmp_path}: no file with tests; it holds e0.csv, e1.csv, e2.csv and 6 more (column 'Dynamic modulus' does "
        "not say its unit); write it after the name, as in E (MPa)."
    )


def test_damaged_results_in_a_folder_are_refused_not_passed_over(tmp_path):
    save(tmp_path, a=export("A", 4), b=export("B", 4).replace("8700", "87x0"))
    with pytest.raises(InputError, match=r"b\.csv, line 5: Dynamic modulus \(MPa\): '87x0' is not a number"):
        read_campaign([tmp_path])
    save(tmp_path, b=TABLE.replace("5000", "many"))
    with pytest.raises(InputError, match=r"b\.csv, line 2: E \(MPa\): 'many' is not a number"):
        read_campaign([tmp_path])


@pytest.mark.parametrize("name", ["notes.txt", "notes.csv"])
def test_running_text_is_passed_over(tmp_path, name):
    save(tmp_path, a=export("A", 4))
    (tmp_path / name).write_text("Tests of May\nas planned\nWe found E*, phase, and more, at 4 C\n")
    campaign, _ = read_campaign([tmp_path])
    assert len(campaign.table.lines) == 2 and said(campaign, f"skipped {name} (")


def test_a_wide_table_that_is_damaged_is_refused(tmp_path):
    save(tmp_path, a=export("A", 4), b="specimen;T (°C);E (GPa) at 10 Hz;phi (°) at 10 Hz\nB;4;9;20;7\n")
    with pytest.raises(InputError, match=r"b\.csv, line 2: 5 fields under 4 column names"):
        read_campaign([tmp_path])
    (tmp_path / "b.csv").write_bytes(b"PK rubbish")
    with pytest.raises(InputError, match=r"b\.csv: cannot be read as XLSX"):
        read_campaign([tmp_path])


def test_a_table_that_holds_the_tests_of_the_exports_is_passed_over(tmp_path):
    rows = [
        "specimen,temperature_C,frequency_Hz,E_MPa,phase_deg",
        "K1,4.0,25.0,8700.0,12.50",
        "K1,4.0,10.0,7600,13.25",
    ]
    save(tmp_path, a=export("A", 4), table="\n".join(rows) + "\n")
    campaign, _ = read_campaign([tmp_path])
    assert said(campaign, "skipped table.csv (holds the same tests as a.csv)")
    assert campaign.table.columns["specimen"] == ["Mix-A"] * 2
    # One test more, and it is no copy.
    save(tmp_path, table="\n".join([*rows, "K1,4.0,1.0,6000,14"]) + "\n")
    assert len(read_campaign([tmp_path])[0].table.lines) == 5


def test_the_same_export_twice_counts_once(tmp_path):
    save(tmp_path, a=export("A", 4), copy=export("A", 4))
    campaign, _ = read_campaign([tmp_path])
    assert len(campaign.table.lines) == 2 and said(
        campaign, "skipped copy.csv (holds the same tests as a.csv)"
    )


@pytest.mark.parametrize("first", [True, False])
def test_repeated_test_is_taken_instead_of_the_first_and_said(tmp_path, first):
    names = ("a", "b") if first else ("b", "a")
    repeated = export("A", 4, 1.2, name="Mix-A-4C-Repeated")
    save(tmp_path, **dict(zip(names, (export("A", 4), repeated), strict=True)), c=export("A", 20))
    campaign, _ = read_campaign([tmp_path])
    assert campaign.table.columns["E_MPa"][:2] == ["10440", "9120"]
    assert said(campaign, f"{names[1]}.csv is taken instead of {names[0]}.csv: the test was repeated")
    assert len(campaign.table.lines) == 4


def test_two_files_of_one_test_are_refused(tmp_path):
    save(tmp_path, a=export("A", 4), b=export("A", 4, 1.2))
    with pytest.raises(
        InputError,
        match=r"a\.csv and b\.csv both hold specimen Mix-A at 4 degC, 25 Hz, and no date in both tells",
    ):
        read_campaign([tmp_path])


def test_moduli_and_peaks_do_not_mix(tmp_path):
    save(tmp_path, a=TABLE, b="T_C,f_Hz,F0_N,z0_m,psi_deg\n10,5,60,5e-5,20\n")
    with pytest.raises(InputError, match="the files hold moduli and peaks; give those of one form together"):
        read_campaign([tmp_path])


def test_a_missing_file_is_refused(tmp_path):
    with pytest.raises(InputError, match="check the path"):
        read_campaign([tmp_path / "none.csv"])


def test_what_reduce_wrote_is_taken_as_it_is(tmp_path):
    from asphalt_nscd.measurements.reduction import reduce_table

    (tmp_path / "m.csv").write_text(
        "specimen,temperature_C,frequency_Hz,E_MPa,phase_deg\n"
        + "".join(f"A,{t},{f},{9000.123456789012 - 100 * t + f},20\n" for t in (0, 10) for f in (1, 10))
    )
    geometry = {"b_mm": 25, "B_mm": 56, "e_mm": 25, "h_mm": 250, "mass_kg": 0.6, "mobile_mass_kg": 0.235}
    reduce_table(tmp_path / "m.csv", geometry, tmp_path / "reduced.csv")
    campaign, _ = read_campaign([tmp_path / "reduced.csv"])
    from asphalt_nscd.files.csvinput import read_csv

    assert campaign.table.columns == read_csv(tmp_path / "reduced.csv").columns
    # Every digit of a plain table stays, too.
    plain, _ = read_campaign([tmp_path / "m.csv"])
    assert plain.table.columns["E_MPa"] == read_csv(tmp_path / "m.csv").columns["E_MPa"]


def test_one_specimen_is_one(tmp_path):
    (tmp_path / "t.csv").write_text("specimen,temperature_C,frequency_Hz,E_MPa,phase_deg\nA,20,10,9000,20\n")
    assert "1 specimen: A" in read_campaign([tmp_path / "t.csv"])[0].notes


def test_files_with_numbers_for_names_are_no_specimens(tmp_path):
    grid = [(s, t) for s in range(2) for t in (4, 20)]
    texts = [export(temperature=t, factor=1.0 + 0.1 * s).replace(f"Mix-A-{t}C", "") for s, t in grid]
    save(tmp_path, **{str(n): text for n, text in enumerate(texts, start=1)})
    with pytest.raises(InputError) as error:
        read_campaign([tmp_path])
    assert str(error.value) == (
        f"{tmp_path}: 4 files, 4 specimens, each at one temperature only: write the specimen into Identification, or "
        "into the names of the files as in K10_21C."
    )
    for n, (s, t) in enumerate(grid, start=1):
        (tmp_path / f"{n}.csv").rename(tmp_path / f"K{s}_{t}C.csv")
    assert set(read_campaign([tmp_path])[0].table.columns["specimen"]) == {"K0", "K1"}


def test_files_with_numbers_for_names_at_one_temperature_are_specimens(tmp_path):
    save(tmp_path, **{str(n): export("A", 4, n, name="").replace("Mix-A-4C", "") for n in (1, 2)})
    assert set(read_campaign([tmp_path])[0].table.columns["specimen"]) == {"1", "2"}


@pytest.mark.parametrize("unit, said", [("psi", "only 62.1 MPa, too soft"), ("GPa", "9e+06 MPa, too stiff")])
def test_megapascals_under_another_unit_are_asked_for(tmp_path, unit, said):
    rows = [f"A,{t},{f},{9000 - 100 * t + 100 * f:g},{10 + t / 4}" for t in (5, 15) for f in (1, 5)]
    save(tmp_path, t="\n".join([f"specimen,T (C),f (Hz),|E*| ({unit}),phi (deg)", *rows]))
    with pytest.raises(InputError) as error:
        read_campaign([tmp_path / "t.csv"])
    assert str(error.value) == (
        f"{tmp_path / 't.csv'}: read as {unit} |E*| reaches {said} for asphalt; read as MPa it fits: is the unit MPa? "
        "Write it into the name of the column."
    )
    save(tmp_path, t="\n".join(["specimen,T (C),f (Hz),|E*| (MPa),phi (deg)", *rows]))
    read_campaign([tmp_path / "t.csv"])


def test_of_an_original_and_its_copy_the_original_is_kept(tmp_path):
    save(tmp_path, **{"K10": export("A", 4), "K10 - Copy": export("A", 4)})
    campaign, _ = read_campaign([tmp_path])
    assert [path.name for path in campaign.files] == ["K10.csv"]
    assert said(campaign, "skipped K10 - Copy.csv (holds the same tests as K10.csv)")
    assert not said(campaign, "identical results")


def test_identical_results_under_two_specimens_are_said(tmp_path):
    save(tmp_path, a=export("A", 4), b=export("B", 4))
    assert said(
        read_campaign([tmp_path])[0],
        "skipped b.csv (holds the same tests as a.csv): identical results under two specimens, Mix-B and Mix-A: one "
        "export was saved twice; export the missing one",
    )


def test_an_export_without_its_quality_lines_says_so(tmp_path):
    save(tmp_path, a=export("A", 4))
    assert not said(read_campaign([tmp_path])[0], "no quality columns")
    save(tmp_path, a=export("A", 4).replace("Phase uniformity (Degrees),0.9,0.4\n", ""))
    assert said(read_campaign([tmp_path])[0], "machine export: ")[0].endswith("; no quality columns")
