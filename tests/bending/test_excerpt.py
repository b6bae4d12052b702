"""A test on the excerpt of a model is that on the model, bit for bit, whether or not bonds break."""

from __future__ import annotations

import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest
from theory.specimens import jittered_beam, save_specimen

from asphalt_nscd.bending.bending_test import TestFiles, read_subject, simulate
from asphalt_nscd.bending.case import LoadCase
from asphalt_nscd.bending.condensing import condense
from asphalt_nscd.bending.settings import Bonds, Numerics
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.store import load
from asphalt_nscd.nscd.stepping import bond_bounds
from asphalt_nscd.nscd.stepping.bond_bounds import BeyondExcerpt, BondBounds
from asphalt_nscd.nscd.stepping.break_modes import BONDS
from asphalt_nscd.rheology.burgers import Burgers
from asphalt_nscd.rheology.laws_io import write_law

LAW = Burgers(24.3e9, 0.06e9, 48.4e9, 0.077e9)


@pytest.fixture(scope="module")
def folder(tmp_path_factory, beam):
    """Models and excerpts, that list a few bonds only, of strong and of weak bonds, and a law."""
    folder = tmp_path_factory.mktemp("excerpt")
    save_specimen(folder / "beam.h5", beam)
    with pytest.MonkeyPatch.context() as patch:
        for name, count in (("LEADING", 6), ("OTHERS", 1), ("NARROW", 2)):
            patch.setattr(bond_bounds, name, count)
        for name, strength in (("strong", 2.7e8), ("weak", 2.7e6)):
            bonds = Bonds(yield_Pa=strength)
            condense(folder / "beam.h5", bonds, folder / f"{name}.h5", folder / f"{name}.excerpt.h5")
    write_law(folder / "law.json", LAW, source="fitted", temperature=15.0)
    return folder


def outcome(folder, name, amplitude, subject):
    files = TestFiles(folder / f"{name}.h5", folder / "law.json", folder / "test.h5")
    simulate(files, 15.0, LoadCase(40.0, amplitude, 2.0), Numerics(1e-4, 20), model=subject)
    record = load(folder / "test.h5", "test")
    return record.arrays, record.attributes


@pytest.mark.parametrize(
    ("name", "amplitude", "breaks", "read"),
    [("strong", 1e-7, False, False), ("strong", 1e-6, False, None), ("weak", 1e-3, True, True)],
)
def test_bits_are_those_of_the_whole_model(folder, name, amplitude, breaks, read):
    excerpt = read_subject(folder / f"{name}.h5", folder / f"{name}.excerpt.h5")
    was_read = []
    spied = replace(
        excerpt,
        reduced_form=(replace(excerpt.reduced_form[0], whole=lambda: _spied(excerpt, was_read)), None),
    )
    arrays, columns = outcome(folder, name, amplitude, read_subject(folder / f"{name}.h5"))
    found, found_columns = outcome(folder, name, amplitude, spied)
    assert (columns["broken_bonds"] > 0) == breaks
    assert found_columns == columns and set(found) == set(arrays)
    assert all(found[key].tobytes() == arrays[key].tobytes() for key in arrays)
    if read is not None:
        assert bool(was_read) == read


def _spied(excerpt, was_read):
    was_read.append(True)
    return excerpt.whole.reduced_form


def test_an_excerpt_of_another_model_is_refused(folder):
    """Noticed where the model is read."""
    mixed = read_subject(folder / "weak.h5", folder / "strong.excerpt.h5")
    with pytest.raises(InputError, match="belongs to another model"):
        assert mixed.whole


def test_an_excerpt_answers_as_all_bonds_would_or_not_at_all():
    """Random bonds and envelopes of every size; each question is answered often, some not always."""
    rng = np.random.default_rng(3)
    n, k = 400, 5
    gap = rng.uniform(1e-4, 1e-3, n)
    utilised, closed = rng.exponential(1.0, (2, n, k)) * 10.0 ** -np.arange(k)
    everything = BondBounds(np.arange(n), utilised, closed, gap)
    with pytest.MonkeyPatch.context() as patch:
        for name, count in (("LEADING", 40), ("OTHERS", 10), ("NARROW", 40)):
            patch.setattr(bond_bounds, name, count)
        part, chosen = everything.excerpt()
    assert 0 < chosen.size < n and (part.number == chosen).all()
    nothing = np.empty(0, int)
    answered = np.zeros(4, int)
    for size in 10 ** rng.uniform(-4, 1, 300):
        sigma, motion = size * rng.random((2, k)) * 10 ** rng.uniform(-2, 2, (2, k))
        questions = (
            lambda bounds: np.concatenate(bounds.candidates(sigma, motion)).tolist(),  # noqa: B023
            lambda bounds: bounds.any_candidate(sigma, motion),  # noqa: B023
            lambda bounds: bounds.largest_utilisation(sigma, nothing, 0.01),  # noqa: B023
            lambda bounds: bounds.smallest_gap(motion),  # noqa: B023
        )
        for number, question in enumerate(questions):
            try:
                assert question(part) == question(everything)
                answered[number] += 1
            except BeyondExcerpt:
                pass
    assert (answered > 20).all() and (answered[[0, 3]] < 300).all(), answered


def test_a_quick_test_imports_neither_sparse_matrices_nor_numba(folder):
    """By which it would take several times as long."""
    said = (
        "import sys; from asphalt_nscd.cli import group; "
        "group.main(sys.argv[1:], standalone_mode=False); "
        "print([name for name in ('scipy', 'numba', 'pandas') if name in sys.modules])"
    )
    command = [
        "simulate", "strong.h5", "--excerpt", "strong.excerpt.h5", "--law", "law.json", "--temperature-c", "15",
        "--frequency-hz", "40", "--amplitude-m", "1e-7", "--cycles", "1", "--output", "quick.h5",
    ]  # fmt: skip
    done = subprocess.run([sys.executable, "-c", said, *command], cwd=folder, capture_output=True, text=True)
    told, imported = done.stdout.splitlines()
    assert told.startswith("15 degC, 40 Hz: |E*| = ") and imported == "[]", done.stdout + done.stderr


def test_so_many_bonds_are_made_ready_to_break(folder):
    for wanted, ready in ((0, 0), (2, 2), (None, BONDS)):
        condense(folder / "beam.h5", Bonds(yield_Pa=2.7e6), folder / "ready.h5", stand_by=wanted)
        assert load(folder / "ready.h5", "model").arrays["stand_by/bonds"].size == ready
    save_specimen(folder / "facets.h5", jittered_beam(area="facets"))
    condense(folder / "facets.h5", Bonds(), folder / "ready.h5")
    assert load(folder / "ready.h5", "model").arrays["stand_by/bonds"].size == 0
