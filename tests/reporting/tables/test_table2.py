"""Table 2 against hand calculation."""

from __future__ import annotations

import numpy as np
import pytest

from asphalt_nscd.reporting.tables.table2 import counts_of_grading, make


def write(path, header, *rows):
    path.write_text("\n".join([header, *rows]) + "\n")
    return [path]


def test_numbers_go_with_mass_over_volume():
    # 4 mm retains 40 %, 2 mm retains 30 %: 40/64 to 30/8, or 1 to 6. Sieves below 2 mm do not count.
    counts = counts_of_grading(np.array([4.0, 2.0, 1.0]), np.array([60.0, 30.0, 20.0]), 2.0, 700)
    assert dict(counts) == {2.0: 600, 4.0: 100}


def test_rounded_numbers_add_up():
    counts = counts_of_grading(np.array([4.0, 2.0]), np.array([60.0, 30.0]), 2.0, 702)
    assert counts.sum() == 702 and dict(counts) == {2.0: 602, 4.0: 100}  # 601.71 and 100.29


def test_the_papers_table_follows_from_its_grading_within_four_spheres():
    table = make(
        grading=["data/paper/table1_grading.csv"],
        published=["data/paper/table2_counts.csv"],
        used=["data/paper/table2_counts.csv"],
    )
    assert list(table["diameter_mm"]) == [2, 4, 6.3, 8, 10]
    assert table["count_from_grading"].sum() == table["count_published"].sum() == 14160
    difference = (table["count_from_grading"] - table["count_published"]).abs()
    assert list(difference) == [4, 0, 1, 2, 1]
    assert (table["count_used"] == table["count_published"]).all()


def test_other_sizes_used_than_published(tmp_path):
    table = make(
        grading=write(tmp_path / "g.csv", "diameter_mm,passing_percent", "4,60", "2,30"),
        published=write(tmp_path / "p.csv", "diameter_mm,count", "2,6", "4,1"),
        used=write(tmp_path / "u.csv", "diameter_mm,count", "3,5"),
    )
    assert list(table["diameter_mm"]) == [2, 3, 4]
    assert list(table["count_used"].fillna(0)) == [0, 5, 0]
    assert list(table["volume_published_percent"].fillna(0)) == pytest.approx([4800 / 112, 0, 6400 / 112])
