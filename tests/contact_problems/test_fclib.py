"""FCLIB files: three storages, what is refused, and the command from files to lines and exit status."""

from __future__ import annotations

import h5py
import numpy as np
import pandas as pd
import pytest
from scipy import sparse
from theory.assemblies import block_on_slope, box_stack

from asphalt_nscd import cli
from asphalt_nscd.contact_problems import fclib
from asphalt_nscd.contact_problems.fclib import read_problem
from asphalt_nscd.files.errors import InputError


def stored(W, storage):
    """Datasets of a matrix as FCLIB writes it."""
    W = sparse.csr_array(W)
    if storage == "triplets":
        coo = W.tocoo()
        row, column = coo.coords
        content = {"nz": coo.nnz, "i": row, "p": column, "x": coo.data}
    else:
        W = W.tocsc() if storage == "columns" else W
        content = {"nz": -1 if storage == "columns" else -2, "i": W.indices, "p": W.indptr, "x": W.data}
    return {"m": W.shape[0], "n": W.shape[1], "nzmax": W.nnz, **content}


def write(path, W, q, mu, storage="rows", change=(), spacedim=3):
    """`change` replaces datasets by name; None removes."""
    content = {f"W/{name}": value for name, value in stored(W, storage).items()}
    content |= {"spacedim": spacedim, "vectors/q": q, "vectors/mu": np.broadcast_to(mu, len(q) // 3)}
    content |= dict(change)
    with h5py.File(path, "w") as file:
        file["fclib_local/info/title"] = "a test"
        for name, value in content.items():
            if value is not None:
                whole = np.asarray(value).dtype.kind in "iu"
                file[f"fclib_local/{name}"] = np.atleast_1d(np.asarray(value, np.int32 if whole else None))
    return path


@pytest.mark.parametrize("storage", ["rows", "columns", "triplets"])
def test_storages(tmp_path, storage):
    """An unsymmetric W shows whether rows are rows."""
    W = np.arange(36.0).reshape(6, 6) * (np.arange(36).reshape(6, 6) % 3 > 0)
    problem = read_problem(write(tmp_path / "p.hdf5", W, np.arange(6.0), [0.3, 0.4], storage))
    np.testing.assert_array_equal(problem.W.toarray(), W)
    np.testing.assert_array_equal(problem.q, np.arange(6.0))
    np.testing.assert_array_equal(problem.mu, [0.3, 0.4])


@pytest.mark.parametrize("storage", ["rows", "columns", "triplets"])
def test_room_for_more_entries_is_not_read_and_an_entry_given_twice_is_summed(tmp_path, storage):
    W = np.diag(np.arange(1.0, 7.0))
    W[0, 4] = 5.0
    content = stored(W, storage)
    count = content["x"].size
    twice = np.flatnonzero(content["x"] == 5.0)[0]  # the second half of it stands behind
    content["x"][twice] = 2.0
    content = {
        name: np.append(values, [values[twice], 5]) if name in "ix" else values
        for name, values in content.items()
    }
    content["x"][-2] = 3.0
    if storage == "triplets":
        content |= {"nz": count + 1, "p": np.append(content["p"], [content["p"][twice], 0])}
    else:
        order = np.insert(np.arange(count), twice, count).tolist() + [count + 1]
        line = 4 if storage == "columns" else 0
        content |= {name: content[name][order] for name in "ix"} | {"p": content["p"] + (np.arange(7) > line)}
    content["nzmax"] = count + 2
    change = {f"W/{name}": value for name, value in content.items()}
    problem = read_problem(write(tmp_path / "p.hdf5", W, np.arange(6.0), 0.3, change=change))
    np.testing.assert_array_equal(problem.W.toarray(), W)
    if storage != "triplets":
        change["W/nzmax"] = count
        with pytest.raises(InputError, match="pointers W/p do not fit"):
            read_problem(write(tmp_path / "p.hdf5", W, np.arange(6.0), 0.3, change=change))


def test_each_is_solved_to_the_tolerance_once_the_solver_is_compiled(tmp_path, monkeypatch):
    block, asked, solve = block_on_slope(0.3), [], fclib.solve_contacts
    monkeypatch.setattr(
        fclib,
        "solve_contacts",
        lambda *given, **more: asked.append((*given[3:], more)) or solve(*given, **more),
    )
    path = write(tmp_path / "block.hdf5", block.W, block.q, 0.5)
    (outcome,) = fclib.solve_files([path], 1e-5)
    assert asked == [({"most_sweeps": 20, "most_steps": 0},), (1e-5, {})]
    solution = solve(block.W, block.q, np.full(4, 0.5), 1e-5)
    expected = "block.hdf5", 4, solution.iterations, solution.error, solution.scaled_error, True
    assert (*list(vars(outcome).values())[:5], outcome.converged) == expected
    assert fclib.table([outcome]).iloc[0].tolist() == list(vars(outcome).values())


REFUSED = {
    "two dimensions": ({"spacedim": 2}, "spacedim is 2"),
    "no W": ({"W/x": None}, "no dataset fclib_local/W/x"),
    "q too short": ({"vectors/q": np.zeros(3)}, "do not belong together"),
    "negative friction": ({"vectors/mu": np.array([0.1, -0.1])}, "vectors/mu has negative values"),
    "storage": ({"W/nz": -3}, r"unknown way \(nz = -3\)"),
    "pointers": ({"W/p": np.array([0, 1, 2, 3, 4, 5, 99])}, "pointers W/p do not fit"),
    "columns": ({"W/i": np.array([0, 1, 2, 3, 4, 6])}, "outside its rows and columns"),
    "triplets outside": ({"W/nz": 6, "W/p": np.array([0, 1, 2, 3, 4, -1])}, "outside its rows and columns"),
    "bilateral": ({"R/m": 3}, "bilateral constraints"),
    "no rows": ({"W/m": 0}, "W has 0 rows and 6 columns"),
    "triplets missing": ({"W/nz": 7}, "W announces 7 entries and holds 6"),
    "triplets too far": ({"W/nz": 6, "W/p": np.array([0, 1, 2, 3, 4, 6])}, "outside its rows and columns"),
    "first pointer": ({"W/p": np.array([1, 1, 2, 3, 4, 5, 6])}, "pointers W/p do not fit"),
    "falling pointers": ({"W/p": np.array([0, 1, 3, 2, 4, 5, 6])}, "pointers W/p do not fit"),
    "negative column": ({"W/i": np.array([0, 1, 2, 3, 4, -1])}, "outside its rows and columns"),
    "no contact": ({"vectors/q": np.zeros(0), "vectors/mu": np.zeros(0)}, "do not belong together"),
    "W too small": ({"vectors/q": np.zeros(9), "vectors/mu": np.ones(3)}, "do not belong together"),
    "a float": ({"W/i": np.zeros(6)}, "W/i does not hold integers"),
    "a text": ({"vectors/q": np.array([b"x"] * 6)}, "vectors/q does not hold numbers"),
    "infinite": ({"vectors/q": np.full(6, np.inf)}, "vectors/q has values that are not finite"),
    "two dimensions at once": ({"spacedim": np.array([3, 3])}, "fclib_local/spacedim is not one number"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_refused(tmp_path, name):
    change, sentence = REFUSED[name]
    path = write(tmp_path / "p.hdf5", np.eye(6), np.zeros(6), 0.5, change=change)
    with pytest.raises(InputError, match=rf"^{path}: .*{sentence}.*; give a local problem .*\.$"):
        read_problem(path)


def run(capsys, *arguments):
    with pytest.raises(SystemExit) as end:
        cli.main(["fclib", *map(str, arguments)])
    return end.value.code, capsys.readouterr()


def test_command(tmp_path, capsys):
    """One line and one row for each file, in their order."""
    stack, block = box_stack(4), block_on_slope(0.3)
    files = [
        write(tmp_path / "stack.hdf5", stack.W, stack.q, 0.5),
        write(tmp_path / "block.hdf5", block.W, block.q, 0.5, "columns"),
    ]
    status, said = run(capsys, *files, "--tolerance", "1e-8", "--output", tmp_path / "table.csv")
    assert status == 0
    lines = said.out.splitlines()
    assert [line.split(":")[0] for line in lines] == ["stack.hdf5", "block.hdf5"]
    assert "36 contacts" in lines[0] and "4 contacts" in lines[1]
    assert all(line.endswith("s, converged") for line in lines)
    table = pd.read_csv(tmp_path / "table.csv")
    assert table.columns.tolist() == [
        "file",
        "contacts",
        "iterations",
        "error",
        "scaled_error",
        "seconds",
        "converged",
    ]
    assert table.converged.all() and (table[["error", "scaled_error"]].to_numpy() <= 1e-8).all()


def test_command_says_what_is_not_solved(tmp_path, capsys):
    """A contact of two fixed bodies driven together: status 1, and the others are solved all the same."""
    block = block_on_slope(0.3)
    files = [
        write(tmp_path / "fixed.hdf5", np.zeros((3, 3)), np.array([-1.0, 0, 0]), 0.5, "triplets"),
        write(tmp_path / "block.hdf5", block.W, block.q, 0.5),
    ]
    status, said = run(capsys, *files, "--output", tmp_path / "table.csv")
    assert status == 1
    assert [line.endswith("NOT converged") for line in said.out.splitlines()] == [True, False]
    assert "not converged to 1e-08: fixed.hdf5" in said.err and "block" not in said.err
    assert pd.read_csv(tmp_path / "table.csv").converged.tolist() == [False, True]
