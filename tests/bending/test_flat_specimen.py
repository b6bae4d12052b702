"""A specimen one grain thick."""

from __future__ import annotations

from dataclasses import replace

import pytest
from theory.specimens import jittered_beam

from asphalt_nscd.bending.condensing import condensed
from asphalt_nscd.bending.cycles import skeleton_of
from asphalt_nscd.bending.model import model_of
from asphalt_nscd.bending.settings import Bonds
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.store import Record


def test_centres_in_a_plane_bear_no_pressure(monkeypatch):
    monkeypatch.setattr("asphalt_nscd.bending.cycles.TOUCHING", 1.0)
    model = model_of(Record(*condensed(jittered_beam(), "slice", Bonds()), ""))
    assert skeleton_of(model, 1e4, 0.5).bonds.size > 0
    flat = model.shape | {"position_m": model.shape["position_m"] * [1.0, 0.0, 1.0]}
    with pytest.raises(InputError, match="slice: the centres of its grains lie in one plane"):
        skeleton_of(replace(model, shape=flat), 1e4, 0.5)
