"""Rig files, and what a rig does to a test."""

from __future__ import annotations

import json

import numpy as np
import pytest

from asphalt_nscd.bending.case import LoadCase
from asphalt_nscd.bending.rig import Rig, read_rig, write_rig
from asphalt_nscd.files.errors import InputError

RIG = Rig(1e-7, 1e5, 2.0, 0.03, 1e-4, -0.01)


def test_round_trip(tmp_path):
    write_rig(tmp_path / "rig.json", RIG)
    assert read_rig(tmp_path / "rig.json") == RIG
    assert json.loads((tmp_path / "rig.json").read_text()) == {
        "clamp_compliance_m_N": 1e-7,
        "guide_stiffness_N_m": 1e5,
        "guide_friction_N": 2.0,
        "head_mass_kg": 0.03,
        "channel_delay_s": 1e-4,
        "phase_offset_rad": -0.01,
    }


def test_the_channel_records_the_displacement_late_and_behind_in_phase():
    """By 1 ms and 0.2 rad at 10 Hz; nothing before the head's start has come through."""
    case = LoadCase(10.0, 1e-6, 1.0, Rig(channel_delay=1e-3, phase_offset=0.2))
    expected = [0.0, 1e-6 * np.sin(20.0 * np.pi * 0.019 - 0.2)]
    np.testing.assert_allclose(case.recorded(np.array([3e-3, 0.02])), expected, rtol=1e-12)


@pytest.mark.parametrize(
    ("content", "words"),
    [
        ("[1]", "not a rig"),
        ('{"head_mass_g": 30}', "key 'head_mass_g' is not known; give keys among clamp_compliance_m_N"),
        ('{"head_mass_kg": "30 g"}', "key 'head_mass_kg' is '30 g'; give a number"),
        ('{"head_mass_kg": true}', "key 'head_mass_kg' is True"),
        (
            '{"head_mass_kg": -0.1, "clamp_compliance_m_N": 1e-7}',
            "head_mass_kg = -0.1 is negative, which a compliant clamp does not allow",
        ),
        ('{"channel_delay_s": NaN}', "channel_delay_s = nan must be at least -1e.15"),
    ],
)
def test_bad_files_are_refused_by_name(tmp_path, content, words):
    path = tmp_path / "rig.json"
    path.write_text(content)
    with pytest.raises(InputError, match=words) as caught:
        read_rig(path)
    assert str(path) in str(caught.value)
