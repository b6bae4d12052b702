import hashlib

import pandas as pd
import pytest

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.store import read_json
from asphalt_nscd.reporting.publish import CHECKSUMS, RESTS_ON, Sources, altered, fill_blocks, publish, stale
from asphalt_nscd.reporting.published_tables import shown


def test_files_are_copied_with_their_checksums(tmp_path):
    root, output = tmp_path / "study", tmp_path / "published"
    (root / "figures").mkdir(parents=True)
    (root / "figures/a.png").write_bytes(b"picture")
    (root / "b.csv").write_text("x\n1\n")
    publish([root / "figures/a.png", root / "b.csv"], root, output)
    assert (output / "figures/a.png").read_bytes() == b"picture"
    lines = (output / CHECKSUMS).read_text().splitlines()
    assert lines == [
        f"{hashlib.sha256(b'x' + bytes([10]) + b'1' + bytes([10])).hexdigest()}  b.csv",
        f"{hashlib.sha256(b'picture').hexdigest()}  figures/a.png",
    ]
    (output / "c.png").write_bytes(b"another")
    publish([output / "c.png"], output, output)  # what stands there already is listed too
    assert (output / CHECKSUMS).read_text().splitlines() == [
        *lines[:1],
        f"{hashlib.sha256(b'another').hexdigest()}  c.png",
        lines[1],
    ]


def test_blocks_are_replaced_and_the_rest_is_left(tmp_path):
    document, table, text = tmp_path / "README.md", tmp_path / "t.csv", tmp_path / "t.md"
    document.write_text(
        "before\n<!-- one -->\nold\n<!-- end one -->\nbetween\n<!-- two -->\n<!-- end two -->\nafter\n"
    )
    table.write_text("name,value,spheres\na,1.23456,14160\nb,,\n")
    text.write_text("| as it is |\n")
    fill_blocks([document], {"one": table, "two": text})
    lines = document.read_text().splitlines()
    assert lines[0] == "before" and lines[-1] == "after" and "between" in lines
    assert "| a      |   1.235 |     14160 |" in lines and "old" not in lines
    assert "| b      |         |           |" in lines
    assert lines[lines.index("<!-- two -->") + 1] == "| as it is |"
    again = document.read_text()
    fill_blocks([document], {"one": table, "two": text})
    assert document.read_text() == again


def test_a_block_is_found_in_the_page_that_holds_it(tmp_path):
    (tmp_path / "docs").mkdir()
    readme, page, table = tmp_path / "README.md", tmp_path / "docs/page.md", tmp_path / "t.csv"
    readme.write_text("<!-- one -->\n<!-- end one -->\n")
    page.write_text("<!-- two -->\n<!-- end two -->\n")
    table.write_text("x\n1\n")
    fill_blocks([readme, tmp_path / "docs"], {"two": table})
    assert "|   1 |" in page.read_text() and "|" not in readme.read_text()
    (tmp_path / "docs/again.md").write_text("<!-- two -->\n<!-- end two -->\n")
    before = readme.read_text(), page.read_text()
    table.write_text("x\n2\n")
    with pytest.raises(InputError, match="again.md, .*page.md: the block <!-- two -->"):
        fill_blocks([readme, tmp_path / "docs"], {"one": table, "two": table})
    assert (readme.read_text(), page.read_text()) == before


def test_a_layout_chooses_columns_and_lists_what_is_long():
    table = pd.DataFrame(
        {"room": ["here", "there"], "mutants": [1.23456, 2.0], "noticed": [3, 4], "alive": ["long", None]}
    ).assign(other=5)
    lines = shown("mutants", table).splitlines()
    assert lines[0].replace(" ", "") == "|folder|tried|noticed|"
    assert lines[2].replace(" ", "") == "|here|1.235|3|" and lines[-1] == "* here: long"
    assert shown("a block without a layout", table[["room"]]).splitlines()[0].replace(" ", "") == "|room|"


def test_a_page_shows_some_rows():
    table = pd.DataFrame({"what": ["a", "b", "c"], "met": ["yes", None, "no"]})
    rows = [line.replace(" ", "") for line in shown("machines", table).splitlines()]
    assert rows[0] == "|what|met|" and rows[2:] == ["|a|yes|", "|c|no|"]


def test_rungs_stand_beside_each_other():
    """As ladder.csv has them: a row for each rung and temperature."""
    table = pd.DataFrame(
        {
            "rung": ["as in the paper"] * 2 + ["spectrum"] * 2,
            "temperature_C": [15, 30] * 2,
            "mre_E_percent": [4.0, 3.0, 2.0, 1.0],
            "mre_E_published_percent": [7.0, 6.0] * 2,
            "mre_phase_percent": [8.0] * 4,
        }
    )
    rows = [line.replace(" ", "") for line in shown("ladder", table).splitlines()]
    assert rows[2] == "|T,°C|printed|asinthepaper|spectrum|"
    assert rows[4:6] == ["|15|7|4|2|", "|30|6|3|1|"]


def test_what_differs_from_the_checksums_is_named(tmp_path):
    for name in "abc":
        (tmp_path / f"{name}.csv").write_text(f"x\n{name}\n")
    publish([], tmp_path, tmp_path)
    assert altered(tmp_path) == []
    (tmp_path / "a.csv").write_text("x\n1\n")
    (tmp_path / "b.csv").unlink()
    (tmp_path / "d.csv").touch()
    assert [sentence.split(": ")[0][-5:] for sentence in altered(tmp_path)] == ["a.csv", "b.csv", "d.csv"]
    (tmp_path / CHECKSUMS).write_text("0123 a.csv\n")
    assert altered(tmp_path) == [f"{tmp_path / CHECKSUMS}: a line is no checksum, two spaces and a name"]
    (tmp_path / CHECKSUMS).unlink()
    assert altered(tmp_path) == [f"{tmp_path / CHECKSUMS}: is missing"]


def test_what_rests_on_other_sources_by_now_is_stale(tmp_path, monkeypatch):
    """Comments mean nothing, bytes of a file that was read do; what was never noted is told."""
    root, out = tmp_path / "results", tmp_path / "published/mine"
    (root / "a").mkdir(parents=True)
    (table := root / "a/t.csv").write_text("x\n1\n")
    (read := tmp_path / "read.csv").write_text("1\n")
    monkeypatch.setattr("asphalt_nscd.files.digests.makers", lambda root: {table: "abc"})
    rests = Sources(["reporting.settings"], [str(read)])
    publish([table], root, out, "one", rests)
    publish([table], root, out, "two", Sources(["reporting.settings"], [str(tmp_path / "none")]))
    noted = read_json(out / RESTS_ON)
    assert noted["one"]["files"] == ["a/t.csv"] and noted["one"]["commits"] == ["abc"]
    assert noted["one"]["digest"] == rests.digest() != "" == noted["two"]["digest"]
    (tmp_path / "published/bare").mkdir()
    never = "its sources were never noted"
    assert stale(tmp_path / "published") == {"publish_bare": never, "two": never}
    read.write_text("2\n")
    assert stale(tmp_path / "published")["one"] == "its sources have changed"
    read.unlink()
    assert stale(tmp_path / "published")["one"] == "its sources have changed"
