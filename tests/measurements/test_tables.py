"""Result tables as figures and tables read them."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.measurements import tables as results

HEADER = "specimen,temperature_C,frequency_Hz,E_MPa,phase_deg,E_law_MPa,phase_law_deg"


def write(path, *rows, header=HEADER):
    path.write_text("\n".join([header, *rows]) + "\n")
    return path


def test_tables_are_put_together_with_the_columns_asked_for(tmp_path):
    first = write(tmp_path / "a.csv", "1,15,3,100,20,101,21,7,free", header=HEADER + ",factor,head")
    second = write(tmp_path / "b.csv", "2,15,3,110,22,101,21,8,blocked", header=HEADER + ",factor,head")
    frame = results.read_tests([first, second], numbers=["factor"], texts=["head"])
    assert list(frame["specimen"]) == ["1", "2"]
    assert list(frame["E_MPa"]) == [100.0, 110.0] and list(frame["factor"]) == [7.0, 8.0]
    assert list(frame["head"]) == ["free", "blocked"]


@pytest.mark.parametrize(
    ("row", "message"),
    [
        ("1,15,3,abc,20,101,21", "line 2: E_MPa = 'abc' is not a number"),
        ("1,15,3,nan,20,101,21", "not finite"),
    ],
)
def test_bad_numbers_are_refused_with_their_place(tmp_path, row, message):
    with pytest.raises(InputError, match=message):
        results.read_tests([write(tmp_path / "a.csv", row)])


def test_averages_by_hand():
    frame = pd.DataFrame(
        [(15, 3, 100, 20), (15, 3, 110, 22), (15, 10, 50, 5)],
        columns=["temperature_C", "frequency_Hz", "E_MPa", "phase_deg"],
    )
    mean = results.averages(frame)
    assert list(mean["E_MPa"]) == [105.0, 50.0] and list(mean["count"]) == [2, 1]
    assert mean["E_MPa_sd"].iloc[0] == pytest.approx(np.sqrt(50.0)) and np.isnan(mean["E_MPa_sd"].iloc[1])


def test_origin_names_all_there_are():
    frame = pd.DataFrame({"origin": ["synthetic", "measured", "measured"]})
    assert results.origin_of(frame) == "measured and synthetic"
    assert results.origin_of(frame.iloc[:1]) == "synthetic"


def test_rows_of_one_temperature():
    frame = pd.DataFrame({"temperature_C": [15.0, 15.0 + 1e-9, 15.1, 20.0]})
    assert len(results.isotherm_rows(frame, 15.0)) == 2
    with pytest.raises(InputError, match="no test at 5 degC; the table has 15"):
        results.isotherm_rows(frame, 5.0)


def test_one_file_or_at_least_one_is_asked_for():
    assert str(results.only_file(iter(["a.csv"]), "measured")) == "a.csv"
    for paths in ([], ["a.csv", "b.csv"]):
        with pytest.raises(InputError, match=f"{len(paths)} files given as 'measured'"):
            results.only_file(paths, "measured")
    with pytest.raises(InputError, match="no table given"):
        results.read_measured([])
