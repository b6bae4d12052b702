"""A few hundred inputs for each reader; `make fuzz` tries a hundred thousand."""

from __future__ import annotations

import resource

import pytest
from fuzz.damage import binaries, texts
from fuzz.readers import BINARIES, TEXTS, tried
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

pytestmark = pytest.mark.slow

GROWTH = 400_000  # kB, of this process over all inputs of a reader


@pytest.mark.parametrize("reader", [*TEXTS, *BINARIES], ids=lambda reader: reader.name)
def test_taken_or_refused_in_one_sentence(reader, tmp_path_factory):
    folder = tmp_path_factory.mktemp("fuzz")
    contents = (binaries if reader in BINARIES else texts)(reader.begin)

    @settings(
        max_examples=60,
        deadline=None,
        derandomize=True,
        database=None,
        suppress_health_check=list(HealthCheck),
    )
    @given(content=contents)
    def check(content):
        tried(reader, content, folder)

    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    check()
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < GROWTH


@pytest.mark.parametrize("reader", [*TEXTS, *BINARIES], ids=lambda reader: reader.name)
def test_what_the_inputs_begin_from_is_valid(reader, tmp_path):
    for content in reader.begin:
        said = tried(reader, content, tmp_path)
        assert said is None or "no such file" in said, said


@settings(max_examples=200, deadline=None, derandomize=True, database=None)
@given(st.text())
def test_a_table_with_anything_in_its_cells_evaluates_none_of_it(tmp_path_factory, cell):
    """What a cell says comes back as it was or is refused; no formula is computed, and none is written."""
    from asphalt_nscd.files.errors import InputError
    from asphalt_nscd.table_import.cells import read_cells
    from asphalt_nscd.table_import.understand import understand

    assume(not cell.strip().startswith("#"))  # a comment
    folder = tmp_path_factory.mktemp("cell")
    quoted = cell.replace('"', '""')
    text = f'sample;T (°C);f (Hz);E (GPa);phi (deg)\n"{quoted}";0;1;9;20\nb;0;1;9;20\n'
    (folder / "t.csv").write_bytes(text.encode("utf-8", "surrogatepass"))
    try:
        said = understand(read_cells(folder / "t.csv")).table.columns["specimen"][0]
    except InputError:
        return
    assert said == " ".join(cell.split()) and said[:1] not in "=+-@"
