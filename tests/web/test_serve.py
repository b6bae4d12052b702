"""The page for one user on this machine: who may ask, and what files it survives."""

from __future__ import annotations

import io
import json
import multiprocessing
import re
import time
import zipfile
from types import SimpleNamespace

import forks  # noqa: F401  what its server has loaded, a process need not load again
import pytest
from table_import.slips import workbook

pytest.importorskip("flask")

from asphalt_nscd.files.errors import InputError  # noqa: E402
from asphalt_nscd.web import app as pages  # noqa: E402
from asphalt_nscd.web import work  # noqa: E402
from asphalt_nscd.web.app import create_app, safe_name  # noqa: E402
from asphalt_nscd.web.work import Choices, Job, read_tables  # noqa: E402

TABLE = "specimen,T (°C),f (Hz),E (MPa),phi (°)\n" + "".join(
    f"{s},{t},{f},{15000 - 300 * t + 400 * f},{20 + 0.3 * t - f}\n"
    for s in "AB"
    for t in (4, 21)
    for f in (10, 1)
)
TAB = "0123456789ab"
PAGE = f"/secret/{TAB}/"


@pytest.fixture(autouse=True)
def quick_processes(monkeypatch):
    """Started as forks; test_ended and test_browser start them as users do."""
    context = multiprocessing.get_context("forkserver")
    monkeypatch.setattr(work.multiprocessing, "get_context", lambda _: context)


@pytest.fixture
def app():
    made = create_app("secret")
    yield made
    made.config["DESKS"].close()


@pytest.fixture
def client(app):
    client = app.test_client()
    client.environ_base["HTTP_HOST"] = "127.0.0.1:5000"
    return client


def dropped(client, *files):
    data = {"files": [(io.BytesIO(content), name) for name, content in files]}
    return client.post(f"{PAGE}files", data=data, content_type="multipart/form-data")


def test_only_the_user_is_answered(client):
    assert client.get(PAGE).status_code == 200
    assert client.get("/secret/").status_code == 302
    for address in ("/", "/other/", "/secre/", f"/other/{TAB}/job", "/secret/..", "/secret/../job"):
        assert client.get(address).status_code in (403, 404)
    assert client.get(PAGE, headers={"Host": "evil.example"}).status_code == 403
    elsewhere = {"Origin": "http://evil.example"}
    assert client.post(f"{PAGE}diagnose", json={}, headers=elsewhere).status_code == 403
    own = {"Origin": "http://localhost"}
    assert client.post(f"{PAGE}cancel", headers=own).get_json() == {"state": "cancelled"}
    assert client.get(f"{PAGE}job").status_code == 404  # nothing was started


def test_results_are_those_that_the_job_has_listed(client, app):
    desk = app.config["DESKS"].desk(TAB)
    desk.output.mkdir()
    for name in ("a.csv", "b.csv"):
        (desk.output / name).write_text(name)
    told = {"files": ["a.csv", "gone.csv"]}
    desk.job = SimpleNamespace(
        state="running", result=told, stage="s", share=0.5, look=lambda: "running", stop=id
    )
    assert client.get(f"{PAGE}results/a.csv").status_code == 404
    assert client.post(f"{PAGE}read", json={}).status_code == 409  # no files, and a job
    desk.files = [desk.output / "a.csv"]
    assert client.post(f"{PAGE}diagnose", json={}).get_json()["error"].startswith("a diagnosis is under way")
    desk.job.state, desk.job.look = "done", lambda: "done"
    assert client.get(f"{PAGE}results/a.csv").text == "a.csv"
    assert client.get(f"{PAGE}results/a.csv?download").headers["Content-Disposition"].startswith("attachment")
    assert {client.get(f"{PAGE}results/{name}").status_code for name in ("b.csv", "gone.csv")} == {404}
    said = client.get(f"{PAGE}job").get_json()
    assert said == {"state": "done", "stage": "s", "share": 0.5} | told
    desk.job.stop = lambda: None


def test_a_law_is_exported_for_each_program_that_it_can_be(tmp_path, monkeypatch):
    made = []

    def export(law, settings, form, path):
        made.append(path.name)
        if form == "ansys":
            raise InputError("cannot")

    monkeypatch.setattr("asphalt_nscd.exports.export.export_law", export)
    monkeypatch.setattr("asphalt_nscd.exports.law.read_law_file", lambda path: path)
    work._export(tmp_path)
    assert made == []
    (tmp_path / "law.json").touch()
    work._export(tmp_path)
    assert sorted(made) == sorted(
        ["law_abaqus.inp", "law_ansys.inp", "law_comsol.txt", "law_csv.csv", "law_mepdg.csv", "law_xlsx.xlsx"]
    )
    assert work._names(tmp_path) == ["law.json"]


def test_cells_and_sentences_of_the_first_look(tmp_path):
    assert [work._rounded(x) for x in ("a", 1234567.0, 0.1234567, float("nan"))] == [
        "a",
        "1.23457e+06",
        "0.123457",
        "",
    ]
    path = tmp_path / "t.csv"
    assert work._shorten_paths(f"{path}: odd, in {tmp_path}/u.csv", [path]) == "t.csv: odd, in u.csv"
    assert [work._missing_unit(q) for q in ("E_MPa", "specimen")] == ["not said", ""]


def test_a_page_loads_nothing_from_elsewhere(client):
    answer = client.get(PAGE)
    assert "default-src 'none'" in answer.headers["Content-Security-Policy"]
    assert answer.headers["Referrer-Policy"] == "no-referrer"  # which would hold the token
    assert "innerHTML" not in answer.text
    assert "http" not in answer.text


@pytest.mark.parametrize(
    ("name", "safe"),
    [
        ("../../etc/passwd", "passwd"), ("..\\..\\a.csv", "a.csv"), ("/abs/t.csv", "t.csv"),
        (".hidden.csv", "hidden.csv"),
        ("<img src=x>.csv", "_img src_x_.csv"), ("a\0b.csv", "a_b.csv"), ("..", "file"),
        ("Éprouvette 1.csv", "Éprouvette 1.csv"), ("a" * 200 + ".csv", "a" * 116 + ".csv"),
    ],
)  # fmt: skip
def test_names_of_files_are_names_and_no_paths(name, safe):
    assert safe_name(name) == safe


def test_files_are_read_and_said(client, app):
    answer = dropped(client, ("../../t.csv", TABLE.encode()))
    content = answer.get_json()
    assert answer.status_code == 200
    assert (content["state"], content["tests"], content["files"]) == ("done", 8, ["t.csv"])
    held = {one["name"]: (one["quantity"], one["unit"]) for one in content["columns"]}
    expected = {"E (MPa)": ("E_MPa", "MPa"), "T (°C)": ("temperature_C", "C"), "specimen": ("specimen", "")}
    assert held.items() >= expected.items()
    # Notes hold no folder of the server, and menus of the page for options of the command.
    assert not any(str(app.config["DESKS"].folder) in note or "--" in note for note in content["notes"])


def test_what_a_file_says_of_its_tests_is_shown_and_all_its_specimens(client):
    names = ["Temp. (°F)", "f (Hz)", "E* (ksi)", "", "phase (°)", ""]
    rows = [
        [t if f == 10 else "", f, 900 - 3 * t + f, 905 - 3 * t + f, 20, 21] for t in (40, 70) for f in (10, 1)
    ]
    table = [["AASHTO T 342 results"], ["Mix ID:", "SP-12.5"], names, ["", "", "S1", "S2", "S1", "S2"], *rows]
    text = "\n".join(";".join(map(str, row)) for row in table)
    content = dropped(client, ("t.csv", text.encode())).get_json()
    assert (content["stated"]["mix"], content["test_type"]) == ("SP-12.5", "tension-compression")
    shown = {one["name"]: (one["condition"], one["cells"]) for one in content["columns"]}
    assert shown["E* (ksi)"][0] == "S1, S2" and shown["Temp. (°F)"][1] == "40, 70"
    usual = json.loads(re.search(r"USUAL = (\[[^]]*\])", client.get(PAGE).text)[1])
    assert usual[0] == "E_MPa" and "specimen" in usual and "E1_MPa" not in usual


def test_each_tab_has_a_desk_that_a_reload_keeps_and_no_other_sees(client):
    first, second = (client.get("/secret/").headers["Location"] for _ in range(2))
    assert first != second
    for place, name in ((first, "a.csv"), (second, "b.csv")):
        data = {"files": [(io.BytesIO(TABLE.encode()), name)]}
        client.post(f"{place}files", data=data, content_type="multipart/form-data")
    chosen = {"law": "cam", "heading": {"operator": "A. Tester"}}
    client.post(f"{first}read", json=chosen)
    for place, name, law in ((first, "a.csv", "cam"), (second, "b.csv", "2s2p1d")):
        kept = client.get(f"{place}state").get_json()
        assert (kept["reading"]["files"], kept["reading"]["tests"], kept["job"]) == ([name], 8, None)
        assert kept["choices"]["law"] == law
    assert client.get(f"{first}state").get_json()["choices"]["heading"] == chosen["heading"]


def test_of_too_many_desks_the_oldest_goes(client, app):
    dropped(client, ("t.csv", TABLE.encode()))
    for n in range(pages.MOST_DESKS):
        client.get(f"/secret/{n:012x}/state")
    assert client.get(f"{PAGE}state").get_json()["reading"] is None
    assert len(list(app.config["DESKS"].folder.iterdir())) == pages.MOST_DESKS


@pytest.mark.parametrize(
    ("choice", "status"),
    [
        ({"measured_in": "torsion"}, 400),
        ({"law": "burger"}, 400),
        ({"law": "cam"}, 200),
        ({"heading": {"x": "y"}}, 400),
        ({"columns": "abc"}, 400),
        ({"heading": ["temperature_C"]}, 400),
    ],
)
def test_choices_are_those_of_the_page(client, choice, status):
    dropped(client, ("t.csv", TABLE.encode()))
    assert client.post(f"{PAGE}read", json=choice).status_code == status


@pytest.mark.parametrize(
    ("files", "name"),
    [
        ([("t.exe", b"MZ")], "t.exe"),
        ([("a/t.csv", b"a"), ("b/t.csv", b"b")], "t.csv"),
        ([("t.csv", TABLE.replace("E (MPa)", "S (MPa)").encode())], "in the menus below"),
        ([("t.csv", TABLE.replace("specimen", "x").encode())], "in its menu below"),
    ],
)
def test_what_is_no_table_is_refused(client, files, name):
    assert name in dropped(client, *files).get_json()["error"]
    assert client.post(f"{PAGE}diagnose", json={}).status_code in (200, 409)


def test_much_more_than_a_campaign_is_refused(client, app, tmp_path):
    many = [(f"t{n}.csv", TABLE.encode()) for n in range(pages.MOST_FILES + 11)]
    answers = {"100 files": dropped(client, *many)}
    assert app.config["MAX_CONTENT_LENGTH"] == pages.MOST_BYTES < 100e6
    app.config["MAX_CONTENT_LENGTH"] = 1000
    answers["40 MB"] = dropped(client, ("t.csv", b"1" * 2000))
    for name, answer in answers.items():
        assert answer.status_code == 413
        assert name in answer.get_json()["error"]
    assert app.config["DESKS"].desk(TAB).files == []
    (tmp_path / "t.csv").write_text("T (C),f (Hz),E (MPa),phi (deg)\n" + "4,10,12345,12\n" * 21_001)
    with pytest.raises(InputError, match="t.csv: more than 20000 rows"):
        read_tables([tmp_path / "t.csv"], Choices())


def test_an_archive_that_unpacks_to_much_more_is_refused(tmp_path):
    with zipfile.ZipFile(tmp_path / "t.xlsx", "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("xl/worksheets/sheet1.xml", b"0" * 60_000_000)
    job = Job("read", [tmp_path / "t.xlsx"], Choices(), None, 60.0)
    job.finish()
    assert job.state == "failed"
    assert "60 MB" in job.result["error"]
    assert str(tmp_path) not in job.result["error"]


def test_a_huge_row_number_is_refused_at_once(tmp_path):
    path = workbook(tmp_path / "t.xlsx", results=[line.split(",") for line in TABLE.splitlines()])
    with zipfile.ZipFile(path) as archive:
        parts = {name: archive.read(name) for name in archive.namelist()}
    with zipfile.ZipFile(path, "w") as archive:
        for name, content in parts.items():
            archive.writestr(name, content.replace(b'<row r="5"', b'<row r="1000000000000"'))
    before = time.process_time()
    with pytest.raises(InputError, match="values in row 1000000000000"):
        read_tables([path], Choices())
    assert time.process_time() - before < 2.0


def test_html_in_cells_is_handed_on_as_it_is(tmp_path):
    """The page makes text of it."""
    evil = "<img src=x onerror=alert(1)>"
    lines = [line.split(",") for line in TABLE.splitlines()]
    rows = [[*lines[0], evil], *([s, *map(float, cells), evil] for s, *cells in lines[1:])]
    read = read_tables([workbook(tmp_path / "t.xlsx", results=rows)], Choices())
    assert evil in [one["name"] for one in read["columns"]]


def test_columns_of_matrices_and_means_are_shown_as_they_were_read(tmp_path):
    titles = {"E": "|E*| (MPa)", "P": "Phase (°)"}
    below = [["T (°C) \\ f (Hz)", 1, 10], [4, 9.0, 8.0], [21, 7.0, 6.0]]
    path = workbook(tmp_path / "t.xlsx", **{name: [[title], *below] for name, title in titles.items()})
    shown = read_tables([path], Choices())["columns"]
    assert [one["quantity"] for one in shown] == ["temperature_C", "frequency_Hz", "E_MPa", "phase_deg"]
    names, *rows = (line.split(",") for line in TABLE.splitlines())
    tests = {s: [[float(cell) + (s == "B") for cell in row[1:]] for row in rows if row[0] == s] for s in "AB"}
    sheets = {name: [names[1:], *tests[name]] for name in tests}
    means = [["T (°C)", "f (Hz)", "Mean E (MPa)", "Mean phi (°)"], [4, 10, 17800, 11.2]]
    read = read_tables([workbook(tmp_path / "t.xlsx", Sheet=means, **sheets)], Choices())
    assert read["specimens"] == ["A", "B"]
    assert [one["name"] for one in read["columns"]] == names[1:]


def test_work_that_takes_too_long_is_stopped(tmp_path):
    (tmp_path / "t.csv").write_text(TABLE)
    job = Job("read", [tmp_path / "t.csv"], Choices(), None, 0.0)
    job.finish()
    assert job.state == "failed"
    assert "too long" in job.result["error"]
    job = Job("diagnose", [tmp_path / "t.csv"], Choices(), tmp_path, 60.0)
    job.stop()
    assert job.look() == "cancelled"
