"""The longest step of each scheme, held against steps that are made."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest

from asphalt_nscd.nscd.bonds.law import BondLaw
from asphalt_nscd.reporting.tables import time_steps
from asphalt_nscd.reporting.tables.time_steps import RIGHT, explicit_step, longest_step
from asphalt_nscd.specimen.system import bending_system

LAW = BondLaw(24.3e9, 3.71e9, np.array([48.4e9]), np.array([0.773e9]))


def test_longest_step_is_where_the_stepped_law_is_wrong_by_one_percent():
    omega = 2.0 * np.pi * 3.0
    dt = 2.0 * np.pi / omega / round(2.0 * np.pi / omega / longest_step(LAW, omega))
    law, sigma, kelvin, found = LAW.step(dt), np.zeros(1), np.zeros((1, 1)), []
    turns = round(20.0 * 2.0 * np.pi / omega / dt)
    angles = omega * dt * np.arange(1, turns + 1)
    for now, before in zip(np.sin(angles), np.sin(angles - omega * dt), strict=True):
        explicit = law.explicit_part(sigma, kelvin)
        sigma = (explicit - (now - before) / dt) / law.compliance
        kelvin = law.remembered(sigma, np.zeros(1), kelvin)
        found.append(-sigma[0])
    basis = np.column_stack([np.sin(angles), np.cos(angles)])[turns // 2 :]
    real, imaginary = np.linalg.lstsq(basis, np.array(found)[turns // 2 :], rcond=None)[0]
    error = abs(np.log((real + 1j * imaginary) / LAW.discrete_modulus(omega, 0.0)))
    assert error == pytest.approx(RIGHT, rel=0.1)


def test_explicit_steps_diverge_just_beyond_the_longest(make_beam):
    system = bending_system(make_beam(shape=(2, 2, 4)), 0.35, np.inf, 0.0)
    longest = explicit_step(system, 24.3e9)
    free = np.delete(np.arange(system.mass.size), system.driven)
    operator = system.operator[:, free]
    energy = {}
    for factor in (0.98, 1.02):
        dt = factor * longest
        x, v = np.random.default_rng(1).standard_normal((2, free.size)) * 1e-9
        for _ in range(1500):
            v -= dt * (operator.T @ (24.3e9 * system.weight * (operator @ x))) / system.mass[free]
            x += dt * v
        energy[factor] = np.abs(x).max()
    assert energy[0.98] < 1e-3 < 1.0 < energy[1.02]


def test_each_test_stands_beside_its_own_solution(monkeypatch, make_beam):
    """The sample's is that of its shortest step; 1 % of |E*| or 0.573 degrees is right no more."""
    keys = {"frequency_Hz": 3.0, "spheres": 9, "steps": 20}
    tests = {
        "solved": [
            keys | {"time_step_s": 4e-4, "E_MPa": 100.9, "phase_deg": 20.0},
            keys | {"time_step_s": 1e-4, "E_MPa": 100.0, "phase_deg": 20.0},
            keys | {"time_step_s": 2e-4, "E_MPa": 100.0, "phase_deg": 20.6},
        ],
        "part": [keys | {"time_step_s": 1e-4, "E_MPa": 50.0, "phase_deg": 30.0}],
        "stopped": [
            keys | {"time_step_s": 1e-4, "tolerance": 1e-3, "E_MPa": 40.0, "phase_deg": 29.0, "sweeps": 70}
        ],
    }
    monkeypatch.setattr(time_steps, "collect", lambda paths: pd.DataFrame(tests[paths[0]]))
    monkeypatch.setattr(time_steps, "bond_law", lambda law: LAW)
    monkeypatch.setattr(time_steps, "read_bond_law", lambda path: None)
    system = bending_system(make_beam(shape=(2, 2, 4)), 0.35, np.inf, 0.0)
    monkeypatch.setattr(time_steps, "read_model", lambda path: SimpleNamespace(system=system))
    table = time_steps.make(["solved"], ["part"], ["stopped"], ["law"], ["model"])
    assert table["scheme"].tolist() == 3 * ["solved"] + [
        "Gauss-Seidel",
        "solved, longest",
        "explicit (DEM), longest",
    ]
    assert table["E_over_solution"][:4].to_list() == pytest.approx([1.009, 1.0, 1.0, 0.8])
    assert table["phase_difference_deg"][:4].to_list() == pytest.approx([0.0, 0.0, 0.6, -1.0])
    assert table["right"][:4].to_list() == [True, True, False, False]
    assert table["time_step_s"][:4].to_list() == [4e-4, 1e-4, 2e-4, 1e-4]
    last = [longest_step(LAW, 6.0 * np.pi), explicit_step(system, 24.3e9)]
    assert table["time_step_s"][4:].to_list() == pytest.approx(last)
    assert table["sweeps_per_step"][3] == 3.5 and table["tolerance"][3] == 1e-3
    assert table[["sweeps_per_step", "tolerance"]][:3].isna().all(axis=None)
