"""Digests beside what a workflow makes: a turned bit is found, an edit by hand is not taken for one's own."""

from __future__ import annotations

import pytest

from asphalt_nscd.files import digests
from asphalt_nscd.files.errors import DamagedFile, InputError, is_result, unreadable
from asphalt_nscd.files.paths import inside, require_readable
from asphalt_nscd.files.store import atomic_path, write_json


@pytest.fixture
def result(tmp_path, monkeypatch):
    """A table that a step of a workflow made."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("ASPHALT_NSCD_WITHIN_WORKFLOW", "1")
    monkeypatch.setenv("ASPHALT_NSCD_COMMIT", "abc")
    with atomic_path("results/mine/t.csv") as path:
        path.write_text("x\n1\n")
    return tmp_path / "results/mine/t.csv"


def test_a_turned_bit_is_found_and_the_file_set_aside(result):
    digests.require_unchanged(["results/mine/t.csv", "table=results/mine/t.csv", "nothing.csv"])
    assert digests.damaged("results") == [] and digests.makers(result.parents[1]) == {result: "abc"}
    result.write_text("x\n2\n")
    with pytest.raises(DamagedFile, match=r"t\.csv: damaged, or edited .* delete \.t\.csv\.sha256"):
        digests.require_unchanged(["table=results/mine/t.csv"])
    (found,) = digests.damaged("results")
    assert "it was set aside as .t.csv.damaged" in digests.set_aside(found)
    assert not result.exists() and result.with_name(".t.csv.damaged").read_text() == "x\n2\n"
    assert digests.makers(result.parents[1]) == {}
    digests.set_aside(found)  # another job has just done so


def test_a_digest_that_was_not_written_to_its_end_says_nothing(result):
    beside = result.with_name(".t.csv.sha256")
    assert len(beside.read_text().split()[0]) == digests.WHOLE
    beside.write_text("0" * 63)
    digests.require_unchanged(["results/mine/t.csv"])
    assert digests.makers(result.parent) == {result: "unknown"}
    beside.write_text("0" * 64)
    with pytest.raises(DamagedFile):
        digests.require_unchanged(["results/mine/t.csv"])


def test_what_is_written_anew_has_the_digest_of_its_new_content(result, monkeypatch):
    write_json("results/published/p.json", {})
    write_json("elsewhere/e.json", {})
    assert not [*result.parents[1].glob("published/.*"), *result.parents[2].glob("elsewhere/.*")]
    monkeypatch.delenv("ASPHALT_NSCD_WITHIN_WORKFLOW")  # by hand: the digest that stood is made again
    with atomic_path("results/mine/t.csv") as path:
        path.write_text("x\n3\n")
    monkeypatch.setenv("ASPHALT_NSCD_WITHIN_WORKFLOW", "1")
    assert digests.damaged("results") == []
    assert digests.forget(result) and not digests.forget(result)


def test_a_result_is_made_again_and_a_users_file_mended(monkeypatch):
    assert not is_result("results/mine/t.csv")
    assert str(unreadable("t.csv", "odd", "mend it")) == "t.csv: odd; mend it."
    monkeypatch.setenv("ASPHALT_NSCD_WITHIN_WORKFLOW", "1")
    told = unreadable("results/mine/t.csv", "odd", "mend it")
    assert isinstance(told, DamagedFile) and told.problem == "odd"
    assert str(told) == "results/mine/t.csv: odd; delete it and run the workflow again."
    assert not is_result("results/published/t.csv") and not is_result("data/results/t.csv")


def test_a_long_message_keeps_its_beginning_and_its_end():
    said = str(InputError("a" * 900 + "\n " + "b" * 900))
    assert said == "a" * 800 + " ... " + "b" * 200
    assert str(InputError("a" * 1000)) == "a" * 1000


def test_no_name_leads_out_of_a_folder_and_no_huge_file_is_read(tmp_path, monkeypatch):
    assert inside(tmp_path, "a/b.csv") == tmp_path / "a/b.csv"
    for name in ("../b.csv", "/etc/passwd", "a\0b"):
        with pytest.raises(InputError, match="is outside"):
            inside(tmp_path, name)
    (path := tmp_path / "a").write_text("12345")
    monkeypatch.setattr("asphalt_nscd.files.paths.MOST_BYTES", 5)
    require_readable(path, "m")
    path.write_text("123456")
    for bad in (path, tmp_path, tmp_path / "none", "a\0"):
        with pytest.raises(InputError, match="no such file; m|larger than"):
            require_readable(bad, "m")
