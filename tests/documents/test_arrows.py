"""Which folder of the package may import from which: the arrows of ARCHITECTURE.md, as data."""

from __future__ import annotations

import ast
from functools import cache
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import pytest

from asphalt_nscd.workflow_support.sources import PACKAGE

# In the order of the work, from what knows nothing of the others to what knows most. Each folder may
# import from those named, and from itself.
ARROWS = {
    "files": [],
    "workflow_support": ["files"],
    "nscd": [],
    "contact_problems": ["files", "nscd"],
    "measurements": ["files"],
    "rheology": ["files", "measurements"],
    "specimen": ["files", "measurements", "nscd"],
    "packings": ["files", "nscd", "specimen"],
    "bending": ["files", "measurements", "nscd", "rheology", "specimen"],
    "forecasting": ["files", "measurements", "nscd", "rheology", "specimen"],
    "diagnosis": ["files", "measurements", "nscd", "rheology", "bending"],
    "exports": ["files", "measurements", "rheology", "diagnosis"],
    "reporting": [
        "files", "workflow_support", "measurements", "nscd", "rheology", "specimen", "bending", "forecasting",
        "diagnosis",
    ],
    "study": ["files", "measurements", "rheology", "specimen", "packings", "bending", "reporting"],
    "table_import": ["files", "measurements", "bending", "forecasting", "study", "reporting"],
    "api": [
        "files", "measurements", "nscd", "rheology", "specimen", "bending", "diagnosis", "exports", "reporting",
        "table_import", "packings", "forecasting",
    ],
    "web": ["files", "measurements", "diagnosis", "exports", "reporting", "table_import", "api"],
    "cli": [
        "files", "measurements", "rheology", "specimen", "bending", "diagnosis", "exports", "reporting",
        "study", "table_import", "nscd", "api", "contact_problems", "forecasting", "web",
    ],
}  # fmt: skip
# The rooms of the diagnosis likewise. All may import `criteria` and `written`; `run` imports from all.
ROOMS = {
    "content": [],
    "observed": [],
    "causes": ["observed"],
    "model": ["observed", "causes"],
    "screening": ["observed", "model"],
    "search": ["observed", "causes", "model", "screening"],
    "simulation": ["observed", "causes", "model", "search"],
    "next_tests": ["observed", "causes", "model", "screening", "search"],
    "words": ["content", "observed", "causes", "model", "screening", "simulation", "next_tests"],
    "machine": ["observed", "causes", "model", "search", "words"],
    "record": [
        "content",
        "observed",
        "causes",
        "model",
        "screening",
        "search",
        "simulation",
        "next_tests",
        "words",
    ],
}


def folders(inside: Path = PACKAGE) -> list[str]:
    return sorted(path.name for path in inside.iterdir() if path.is_dir() and path.name != "__pycache__")


@cache
def named(file: Path) -> set[str]:
    """Modules that a file imports and what it imports from them, by their full names; in functions too."""
    found = set()
    for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom):
            found |= {str(node.module), *(f"{node.module}.{alias.name}" for alias in node.names)}
        elif isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
    return found


def imported(file: Path, package: str) -> set[str]:
    """Folders and modules of a package that a file imports from."""
    return {
        name.removeprefix(f"{package}.").split(".")[0] for name in named(file) if name.startswith(package)
    }


DIAGNOSIS = "asphalt_nscd.diagnosis"
CASES = [(PACKAGE, "asphalt_nscd", ARROWS, folder) for folder in ARROWS]
CASES += [(PACKAGE / "diagnosis", DIAGNOSIS, ROOMS, room) for room in ROOMS]


def test_every_folder_and_every_room_of_the_diagnosis_has_its_arrows():
    assert folders() == sorted(ARROWS) and folders(PACKAGE / "diagnosis") == sorted(ROOMS)


@pytest.mark.parametrize(("inside", "package", "arrows", "folder"), CASES, ids=[case[-1] for case in CASES])
def test_arrows_run_one_way(inside, package, arrows, folder):
    earlier = list(arrows)[: list(arrows).index(folder)]
    assert set(arrows[folder]) <= set(earlier), f"{folder} may only import from what is listed before it"
    known = {*folders(inside), "run"} - {folder, *arrows[folder]}
    for file in sorted((inside / folder).rglob("*.py")):
        beyond = imported(file, package) & known
        assert not beyond, f"{file.relative_to(PACKAGE)} imports from {', '.join(sorted(beyond))}"


def test_few_modules_lie_loose():
    assert [path.name for path in PACKAGE.glob("*.py")] == ["__init__.py"]
    loose = sorted(path.name for path in (PACKAGE / "diagnosis").glob("*.py"))
    assert loose == ["__init__.py", "criteria.py", "run.py", "settings.py", "written.py"]


def test_no_modules_import_each_other():
    """Imports inside functions included: what would be a circle is two halves of one module."""
    modules = {
        ".".join(file.relative_to(PACKAGE.parent).with_suffix("").parts): file
        for file in PACKAGE.rglob("*.py")
    }
    needs = {name: (named(file) & modules.keys()) - {name} for name, file in modules.items()}
    try:
        TopologicalSorter(needs).prepare()
    except CycleError as found:
        pytest.fail(" imports ".join(reversed(found.args[1])))
