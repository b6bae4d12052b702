from __future__ import annotations

import pandas as pd
import pytest

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.reporting.pages.style import page


@pytest.fixture
def table(tmp_path):
    frame = pd.DataFrame(
        {"specimen": ["01", "s<2>"], "E_MPa": [24300.123456, float("nan")], "bonds": [12, 70_000_000]}
    )
    frame.to_csv(tmp_path / "table.csv", index=False)
    return tmp_path / "table.csv"


def test_cells_say_what_the_table_says(table):
    html = page(table, "E & phase")
    assert "<caption>E &amp; phase</caption>" in html
    assert '<th scope="col">specimen</th><th scope="col">E_MPa</th><th scope="col">bonds</th>' in html
    assert '<td>01</td><td class="number">24300.1</td><td class="number">12</td>' in html
    assert '<td>s&lt;2&gt;</td><td class="number"></td><td class="number">70000000</td>' in html


def test_table_that_is_none(tmp_path):
    with pytest.raises(InputError, match="gone.csv: no such file"):
        page(tmp_path / "gone.csv", "t")
    (tmp_path / "empty.csv").touch()
    with pytest.raises(InputError, match="empty.csv: not a CSV table"):
        page(tmp_path / "empty.csv", "t")


def test_comment_lines_at_the_beginning_stand_above_the_table(tmp_path):
    (tmp_path / "t.csv").write_text("# largest error 0.8 % < 1 %\n#   of |E*|\nspecimen,E_MPa\n#2,1\n")
    html = page(tmp_path / "t.csv", "t")
    assert '<p class="note">largest error 0.8 % &lt; 1 % of |E*|</p><div class="wide"' in html
    assert '<td>#2</td><td class="number">1</td>' in html


def test_a_cell_with_a_sentence_is_not_squeezed(tmp_path):
    (tmp_path / "t.csv").write_text(f"evidence,verdict\n{'word ' * 9},differs\n")
    html = page(tmp_path / "t.csv", "t")
    assert '<td class="words">word word' in html and "<td>differs</td>" in html
