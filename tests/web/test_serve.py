"""The page for one user on this machine: who may ask, and what files it survives."""

from __future__ import annotations

import io
import zipfile

import openpyxl
import pytest

pytest.importorskip("flask")

from asphalt_nscd.files.errors import InputError  # noqa: E402
from asphalt_nscd.web import app as pages  # noqa: E402
from asphalt_nscd.web.app import create_app, safe_name  # noqa: E402
from asphalt_nscd.web.work import Choices, Job, read_tables  # noqa: E402

TABLE = "specimen,T (°C),f (Hz),E (MPa),phi (°)\n" + "".join(
    f"{s},{t},{f},{15000 - 300 * t + 400 * f},{20 + 0.3 * t - f}\n"
    for s in "AB"
    for t in (4, 21)
    for f in (10, 1)
)
PAGE = "/secret/"


@pytest.fixture
def app():
    made = create_app("secret")
    yield made
    made.config["DESK"].close()


@pytest.fixture
def client(app):
    client = app.test_client()
    client.environ_base["HTTP_HOST"] = "127.0.0.1:5000"
    return client


def dropped(client, *files):
    data = {"files": [(io.BytesIO(content), name) for name, content in files]}
    return client.post(f"{PAGE}files", data=data, content_type="multipart/form-data")


def workbook(rows):
    book = openpyxl.Workbook()
    for row in rows:
        book.active.append(row)
    book.save(saved := io.BytesIO())
    return saved.getvalue()


def test_only_the_user_is_answered(client):
    assert client.get(PAGE).status_code == 200
    for address in ("/", "/other/", "/secre/", "/other/job"):
        assert client.get(address).status_code in (403, 404)
    assert client.get(PAGE, headers={"Host": "evil.example"}).status_code == 403
    assert (
        client.post(f"{PAGE}diagnose", json={}, headers={"Origin": "http://evil.example"}).status_code == 403
    )


def test_a_page_loads_nothing_from_elsewhere(client):
    answer = client.get(PAGE)
    assert "default-src 'none'" in answer.headers["Content-Security-Policy"]
    assert answer.headers["Referrer-Policy"] == "no-referrer"  # which would hold the token
    assert "innerHTML" not in answer.text and "http" not in answer.text


@pytest.mark.parametrize(
    ("name", "safe"),
    [
        ("../../etc/passwd", "passwd"), ("..\\..\\a.csv", "a.csv"), ("/abs/t.csv", "t.csv"),
        (".hidden.csv", "hidden.csv"),
        ("<img src=x>.csv", "_img src_x_.csv"), ("a\0b.csv", "a_b.csv"), ("..", "file"),
        ("Éprouvette 1.csv", "Éprouvette 1.csv"),
    ],
)  # fmt: skip
def test_names_of_files_are_names_and_no_paths(name, safe):
    assert safe_name(name) == safe


def test_files_are_read_and_said(client, app):
    answer = dropped(client, ("../../t.csv", TABLE.encode()))
    content = answer.get_json()
    assert answer.status_code == 200 and content["state"] == "done" and content["tests"] == 8
    assert content["files"] == ["t.csv"]
    held = {one["name"]: (one["quantity"], one["unit"]) for one in content["columns"]}
    assert held["E (MPa)"] == ("E_MPa", "MPa") and held["T (°C)"] == ("temperature_C", "C")
    assert held["specimen"] == ("specimen", "")
    assert not any(str(app.config["DESK"].folder) in note for note in content["notes"])
    assert client.post(f"{PAGE}read", json={"measured_in": "torsion"}).status_code == 400
    assert client.post(f"{PAGE}read", json={"law": "burger"}).status_code == 400
    assert client.post(f"{PAGE}read", json={"law": "cam"}).status_code == 200


def test_what_is_no_table_is_refused(client):
    assert "give files that end in" in dropped(client, ("t.exe", b"MZ")).get_json()["error"]
    assert (
        "two files have this name"
        in dropped(client, ("a/t.csv", b"a"), ("b/t.csv", b"b")).get_json()["error"]
    )
    assert client.post(f"{PAGE}diagnose", json={}).status_code in (200, 409)


def test_much_more_than_a_table_is_refused(client, app, monkeypatch):
    app.config["MAX_CONTENT_LENGTH"] = 1000
    answer = dropped(client, ("t.csv", b"1" * 2000))
    assert answer.status_code == 413 and "more than 40 MB" in answer.get_json()["error"]
    assert pages.MOST_BYTES < 100e6
    assert app.config["DESK"].files == []


def test_more_files_or_lines_than_a_campaign_has_are_refused(client, tmp_path):
    many = [(f"t{n}.csv", TABLE.encode()) for n in range(pages.MOST_FILES + 11)]
    answer = dropped(client, *many)
    assert answer.status_code == 413 and "more than 100 files" in answer.get_json()["error"]
    (tmp_path / "t.csv").write_text("T (C),f (Hz),E (MPa),phi (deg)\n" + "4,10,12345,12\n" * 21_001)
    with pytest.raises(InputError, match="t.csv: more than 20000 rows or 300 columns"):
        read_tables([tmp_path / "t.csv"], Choices())


def test_an_archive_that_unpacks_to_much_more_is_refused(tmp_path):
    with zipfile.ZipFile(tmp_path / "t.xlsx", "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("xl/worksheets/sheet1.xml", b"0" * 60_000_000)
    job = Job("read", [tmp_path / "t.xlsx"], Choices(), None, 60.0)
    job.finish()
    assert job.state == "failed" and "unpacks to 60 MB" in job.result["error"]
    assert str(tmp_path) not in job.result["error"]


def test_html_in_cells_is_text(tmp_path):
    evil = "<img src=x onerror=alert(1)>"
    rows = [["specimen", "T (°C)", "f (Hz)", "E (MPa)", "phi (°)", evil]]
    rows += [["A", t, f, 15000 - 300 * t + 400 * f, 20 + 0.3 * t - f, evil] for t in (4, 21) for f in (10, 1)]
    (tmp_path / "t.xlsx").write_bytes(workbook(rows))
    read = read_tables([tmp_path / "t.xlsx"], Choices())
    assert any(
        one["name"] == evil for one in read["columns"]
    )  # handed on as it is: the page makes text of it


def test_sentences_name_the_menus_of_the_page(client):
    def error(table):
        return dropped(client, ("t.csv", table.encode())).get_json()["error"]

    assert error(TABLE.replace("E (MPa)", "S (MPa)")).endswith("or name a column of yours in its menu below.")
    assert error(TABLE.replace("specimen", "x")).endswith("or say which is one, in its menu below.")
    notes = dropped(client, ("t.csv", TABLE.encode())).get_json()["notes"]
    assert "which test gave the moduli is not said; choose it in the menu" in notes
    assert not any("--" in note for note in notes)


def test_columns_of_matrices_and_means_are_shown_as_they_were_read(tmp_path):
    book = openpyxl.Workbook()
    book.remove(book.active)
    for name, title in (("E", "|E*| (MPa)"), ("P", "Phase (°)")):
        sheet = book.create_sheet(name)
        for row in ([title], ["T (°C) \\ f (Hz)", 1, 10], [4, 9.0, 8.0], [21, 7.0, 6.0]):
            sheet.append(row)
    book.save(tmp_path / "t.xlsx")
    read = read_tables([tmp_path / "t.xlsx"], Choices())
    assert [one["quantity"] for one in read["columns"]] == [
        "temperature_C",
        "frequency_Hz",
        "E_MPa",
        "phase_deg",
    ]
    book = openpyxl.Workbook()
    for name in "AB":
        sheet = book.create_sheet(name)
        for row in (line.split(",")[1:] for line in TABLE.splitlines() if line[0] in ("s", name)):
            sheet.append([float(cell) + (name == "B") if cell[0].isdigit() else cell for cell in row])
    for row in (["T (°C)", "f (Hz)", "Mean E (MPa)", "Mean phi (°)"], [4, 10, 17800, 11.2]):
        book.active.append(row)
    book.save(tmp_path / "t.xlsx")
    read = read_tables([tmp_path / "t.xlsx"], Choices())
    assert read["specimens"] == ["A", "B"]
    assert [one["name"] for one in read["columns"]] == ["T (°C)", "f (Hz)", "E (MPa)", "phi (°)"]


def test_work_that_takes_too_long_is_stopped(tmp_path):
    (tmp_path / "t.csv").write_text(TABLE)
    job = Job("read", [tmp_path / "t.csv"], Choices(), None, 0.0)
    job.finish()
    assert job.state == "failed" and "took too long" in job.result["error"]
    job = Job("diagnose", [tmp_path / "t.csv"], Choices(), tmp_path, 60.0)
    job.stop()
    assert job.look() == "cancelled"
