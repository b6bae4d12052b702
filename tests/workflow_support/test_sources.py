from __future__ import annotations

import json
import os

import pytest

from asphalt_nscd.workflow_support import sources


@pytest.fixture
def package(tmp_path, monkeypatch):
    root = tmp_path / "asphalt_nscd"
    (root / "core").mkdir(parents=True)
    files = {
        "__init__.py": "",
        "step.py": "def command():\n    from asphalt_nscd.core.solver import solve\n",
        "core/__init__.py": "from asphalt_nscd import plotting\n",
        "core/solver.py": "import numpy\nfrom . import kernel\nfrom ..errors import InputError as E\n",
        "core/kernel.py": "",
        "errors.py": "",
        "plotting.py": "import asphalt_nscd.files.errors\nfrom asphalt_nscd.core import solver\n",
    }
    for name, content in files.items():
        (root / name).write_text(content)
    monkeypatch.setattr(sources, "PACKAGE", root)
    sources._read.cache_clear()
    return root


@pytest.fixture
def another_process(package, monkeypatch):
    """As if the process ended and another began; gives the files that it parses."""
    waiting, parsed = [], []
    monkeypatch.setattr(sources.atexit, "register", lambda *call: waiting.append(call))
    parse = sources._parse
    monkeypatch.setattr(
        sources, "_parse", lambda path, content: parsed.append(path.name) or parse(path, content)
    )
    sources._parsed.cache_clear()
    (package / "__pycache__").mkdir()

    def begin():
        for keep, *parts in waiting:
            keep(*parts)
        sources._read.cache_clear()
        sources._parsed.cache_clear()
        for seen in (waiting, parsed):
            seen.clear()
        return parsed

    return begin


def names(root, *modules):
    return [str(path.relative_to(root)) for path in sources.source_files(*modules)]


def test_follows_imports_in_functions_and_relative_ones_but_not_the_packages_around(package):
    assert names(package, "step") == ["core/kernel.py", "core/solver.py", "errors.py", "step.py"]


def test_unknown_module_is_refused(package):
    with pytest.raises(ValueError, match="no module asphalt_nscd.setp"):
        sources.source_files("setp")


def test_modules_that_a_package_finds_by_itself(package):
    assert sources.modules_of("core") == ["core.kernel", "core.solver"]
    assert names(package, *sources.modules_of("core")) == ["core/kernel.py", "core/solver.py", "errors.py"]


def test_a_stamp_changes_with_the_content_only(tmp_path, package):
    files = sources.source_files("plotting")
    path = sources.stamp(tmp_path, "plotting", files)
    first, kept = path.read_text(), path.stat().st_mtime_ns
    files[0].touch()
    assert sources.stamp(tmp_path, "plotting", files).stat().st_mtime_ns == kept
    kernel = next(file for file in files if file.name == "kernel.py")
    kernel.write_text('"""What it does."""\n# and why\n')
    assert sources.stamp(tmp_path, "plotting", files).read_text() == first
    kernel.write_text("SIGN = -1\n")
    for file in (*files, path):  # as from an archive of another version: all are older than any result
        os.utime(file, (1e9, 1e9))
    assert sources.stamp(tmp_path, "plotting", files).read_text() != first
    assert path.stat().st_mtime > 1e9
    path.unlink()
    assert sources.stamp(tmp_path, "plotting", files).stat().st_mtime == 1e9


def test_a_table_s_stamp_is_new_where_an_older_table_takes_its_place(tmp_path):
    (table := tmp_path / "mine.csv").write_text("E\n1\n")
    os.utime(table, (1e9, 1e9))
    path = sources.stamp_of_table(tmp_path / "rows", table)
    assert path.stat().st_mtime == 1e9
    table.write_text("E\n2\n")
    os.utime(table, (1e9, 1e9))
    assert sources.stamp_of_table(tmp_path / "rows", table).stat().st_mtime > 1e9


def test_what_one_process_parsed_another_takes_over(package, another_process):
    parsed = another_process()
    first = names(package, "step")
    assert sorted(parsed) == ["errors.py", "kernel.py", "solver.py", "step.py"]
    stamp = sources.stamp(package, "step", sources.source_files("step")).read_text()
    parsed = another_process()
    assert names(package, "step") == first and not parsed
    assert sources.stamp(package, "step", sources.source_files("step")).read_text() == stamp


def test_what_was_parsed_before_counts_for_the_same_content_alone(package, another_process):
    """Though the file looks the same from outside: as long, and of the same time."""
    another_process()
    names(package, "plotting")
    parsed = another_process()
    solver, seen = package / "core/solver.py", (package / "core/solver.py").stat().st_mtime_ns
    text = solver.read_text()
    solver.write_text(text.replace("from . import kernel", "import math         "))
    assert len(text) == len(solver.read_text())
    os.utime(solver, ns=(seen, seen))
    assert names(package, "plotting") == ["core/solver.py", "errors.py", "plotting.py"]
    assert parsed == ["solver.py"]


def test_a_module_that_appears_counts_for_sources_that_did_not_change(package, another_process):
    (package / "core/kernel.py").unlink()
    another_process()
    assert "core/__init__.py" in names(package, "step")  # of which it is a name
    parsed = another_process()
    (package / "core/kernel.py").write_text("")
    assert "core/kernel.py" in names(package, "step") and parsed == ["kernel.py"]


@pytest.mark.parametrize(
    "harm", ["half", "other shape", "other entries", "another's", "changed", "none to write"]
)
def test_a_broken_file_of_what_was_parsed_is_not_trusted(package, another_process, harm):
    another_process()
    first = names(package, "step")
    another_process()
    kept = package / "__pycache__/sources.json"
    table = json.loads(kept.read_text())
    files = sorted(table)
    bad = {
        "half": kept.read_text()[: kept.stat().st_size // 2],
        "other shape": "[1]",
        "other entries": json.dumps(dict.fromkeys(files, 1)),
        "another's": json.dumps(dict(zip(files, [table[file] for file in files[1:] + files[:1]]))),
        "changed": json.dumps({file: [seal, meaning, []] for file, (seal, meaning, _) in table.items()}),
        "none to write": None,
    }[harm]
    kept.unlink()
    if bad is None:
        kept.mkdir()
    else:
        kept.write_text(bad)
    assert names(package, "step") == first
    another_process()
    assert names(package, "step") == first


def test_a_string_that_is_no_docstring_counts(tmp_path, package):
    """In a module that ends up without statements too."""
    file = package / "errors.py"
    seen = set()
    for content in (
        "",
        '"""Errors."""\n',
        '"""Errors"""\nWHAT = "a"\n',
        'WHAT = "b"\n',
        "def f():\n    'Errors'\n",
    ):
        file.write_text(content)
        sources._read.cache_clear()
        seen.add(sources.stamp(tmp_path, "errors", [file]).read_text())
    assert len(seen) == 4


def test_a_row_s_stamp_changes_with_its_row_only(tmp_path):
    table = tmp_path / "laws.csv"

    def stamps(text):
        table.write_text(text)
        return [
            sources.stamp_of_row(tmp_path / "rows", table, "temperature_C", value).read_text()
            for value in (0.0, 20.0)
        ]

    cold, warm = stamps("temperature_C,E\n0,1\n20,2\n")
    assert stamps("# measured\ntemperature_C,E\n0.0,1\n20,3\n")[1] != warm
    assert stamps("temperature_C,E\n0,1\n20,3\n")[0] == cold
    assert stamps("temperature_C,E\n20,2\n0,1\n") == [cold, warm]
    missing = stamps("temperature_C,E\n20,2\n")
    assert missing[0] != cold and missing[1] == warm
    table.unlink()
    assert sources.stamp_of_row(tmp_path / "rows", table, "temperature_C", 0.0).is_file()
