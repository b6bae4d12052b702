"""Result files: written whole or not at all, refused when damaged."""

from __future__ import annotations

import json
import os

import h5py
import numpy as np
import pytest

from asphalt_nscd.files import store
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.store import atomic_path, load, made_by, read_json, save, write_json

ARRAYS = {"a/b": np.arange(6.0).reshape(2, 3), "c": np.array([1, 2])}
ATTRIBUTES = {"name": "s1", "value": 0.5, "count": 3}


@pytest.fixture
def file(tmp_path):
    save(path := tmp_path / "x.h5", "kind", ARRAYS, ATTRIBUTES)
    return path


def require_as_saved(record):
    assert record.attributes == ATTRIBUTES
    assert set(record.arrays) == set(ARRAYS)
    for name, value in ARRAYS.items():
        np.testing.assert_array_equal(record.arrays[name], value)
        assert record.arrays[name].dtype == value.dtype


def test_what_is_saved_is_loaded(file):
    require_as_saved(load(file, "kind"))


def change(place):
    def changed(file):
        with h5py.File(file, "r+") as content:
            place(content)

    return changed


def alter(content):
    content["a/b"][0, 0] = 1e-9


@pytest.mark.parametrize(
    ("spoil", "kind", "names"),
    [
        (lambda file: None, "model", "a model file; found a kind file"),
        (lambda file: file.unlink(), "kind", "no such file"),
        (lambda file: file.write_bytes(file.read_bytes()[:-200]), "kind", "damaged"),
        (lambda file: file.write_text("not HDF5"), "kind", "not HDF5"),
        (change(alter), "kind", "digest"),
        (change(lambda content: content.attrs.modify("value", 0.50001)), "kind", "digest"),
        (change(lambda content: content.pop("c")), "kind", "digest"),
    ],
)
def test_a_file_that_is_not_what_was_saved_is_refused(file, spoil, kind, names):
    spoil(file)
    with pytest.raises(InputError, match=f"x.h5: .*{names}"):
        load(file, kind)


def test_every_flipped_byte_is_refused_or_harmless(file):
    whole = file.read_bytes()
    for place in range(0, len(whole), 37):
        changed = bytearray(whole)
        changed[place] ^= 0xFF
        file.write_bytes(bytes(changed))
        try:
            record = load(file, "kind")
        except InputError:
            continue
        require_as_saved(record)


def test_nothing_is_left_of_a_write_that_fails(tmp_path):
    path = tmp_path / "folder" / "x.txt"
    with pytest.raises(RuntimeError), atomic_path(path) as temporary:
        temporary.write_text("half")
        raise RuntimeError
    assert list(path.parent.iterdir()) == []
    path.write_text("before")
    with pytest.raises(RuntimeError), atomic_path(path) as temporary:
        temporary.write_text("half")
        raise RuntimeError
    assert path.read_text() == "before" and len(list(path.parent.iterdir())) == 1


def test_device_is_not_replaced(tmp_path):
    os.mkfifo(pipe := tmp_path / "pipe")
    with pytest.raises(InputError, match="not a regular file"), atomic_path(pipe):
        pass
    assert pipe.is_fifo()


def test_json_that_cannot_be_read_is_named(tmp_path):
    (path := tmp_path / "x.json").write_text("{")
    with pytest.raises(InputError, match="not valid JSON"):
        read_json(path)
    with pytest.raises(InputError, match="no such file"):
        read_json(tmp_path / "none.json")


def test_versions_are_found_or_told_by_a_workflow(monkeypatch):
    monkeypatch.delenv(store.VERSIONS, raising=False)
    found = store.provenance()["packages"]
    assert found["numpy"] == np.__version__
    monkeypatch.setenv(store.VERSIONS, json.dumps(found | {"numpy": "0.1"}))
    assert store.provenance()["packages"] == found | {"numpy": "0.1"}
    assert store.package_versions() == found


@pytest.mark.parametrize(("mask", "mode"), [(0o077, 0o600), (0o002, 0o664), (0o022, 0o644)])
def test_the_umask_is_obeyed(tmp_path, mask, mode):
    before = os.umask(mask)
    try:
        write_json(tmp_path / "a.json", {})
    finally:
        os.umask(before)
    assert (tmp_path / "a.json").stat().st_mode & 0o777 == mode


def test_each_part_names_the_commit_that_made_it(tmp_path, monkeypatch):
    """Of a folder whose tests are old and whose table was made since."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("ASPHALT_NSCD_WITHIN_WORKFLOW", "1")
    for number, commit in enumerate(("old", "old", "new")):
        monkeypatch.setenv("ASPHALT_NSCD_COMMIT", commit)
        save(f"results/mine/tests/{number}.h5", "test", ARRAYS, ATTRIBUTES)
        write_json("results/mine/law.json", {"number": number})
    assert made_by("results/mine") == {"law.json": {"new": 1}, "tests": {"new": 1, "old": 2}}
