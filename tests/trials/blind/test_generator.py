"""Cases: scatter of the stated size, records that reduce to peaks, determinism, independence."""

import ast
import json
from pathlib import Path

import blind
import numpy as np
import pandas as pd
import pytest
from blind.causes import CATALOGUE
from blind.design import GEOMETRY, factorial
from blind.generator import Hidden, draw
from blind.outside import OUTSIDE
from blind.records import Sampling, measure, reduce_record
from blind.strength import Scatter
from test_signatures import DESIGNS, QUIET, moduli

GENERATOR = [
    f"{name}.py"
    for name in "backgrounds causes design fitted generator laws outside records rig score strength".split()
]  # the campaign around it runs the diagnosis and may know it


def test_nothing_comes_from_the_package_under_test():
    allowed = {"__future__", "ast", "collections", "dataclasses", "functools", "json", "pathlib", "typing"}
    allowed |= {"numpy", "pandas", "scipy", "pytest"}
    for path in map(Path(blind.__file__).with_name, GENERATOR):
        for node in ast.walk(ast.parse(path.read_text())):
            if isinstance(node, ast.Import):
                roots = {alias.name.split(".")[0] for alias in node.names}
            elif isinstance(node, ast.ImportFrom) and node.level == 0:
                roots = {node.module.split(".")[0]}
            else:
                continue
            assert roots <= allowed, f"{path.name} imports {roots - allowed}"


@pytest.mark.parametrize("cause", [*CATALOGUE, *OUTSIDE])
def test_one_seed_one_case_and_a_seal_that_json_keeps(cause):
    effect = CATALOGUE.get(cause) or OUTSIDE[cause]
    one, same, other = (
        draw(seed, [Hidden(cause, amplitude=effect.step)], design=DESIGNS.get(cause)) for seed in (8, 8, 9)
    )
    pd.testing.assert_frame_equal(one.table, same.table)
    assert one.seal == same.seal == json.loads(json.dumps(one.seal))
    assert not one.table["F0_N"].equals(other.table["F0_N"])


def test_the_same_seed_keeps_mix_scatter_place_and_sign_at_any_amplitude():
    weak, strong = (draw(8, [Hidden("temperature_bias", amplitude=a)]) for a in (1e-9, 1.0))
    assert weak.seal["law"] == strong.seal["law"]
    placed, again = weak.seal["effects"][0], strong.seal["effects"][0]
    assert placed["where"] == again["where"] and placed["amplitude"] * again["amplitude"] > 0
    empty = draw(8)
    assert moduli(weak) == pytest.approx(moduli(empty), rel=1e-7)


def test_signs_and_places_vary_between_seeds():
    effects = [draw(s, [Hidden("temperature_bias", amplitude=0.5)]).seal["effects"][0] for s in range(40)]
    assert {np.sign(e["amplitude"]) for e in effects} == {-1.0, 1.0}
    assert {e["where"] for e in effects} == {-10.0, 0.0, 10.0, 15.0, 20.0, 30.0}
    clamps = [draw(s, [Hidden("loose_clamp", amplitude=1e-8)]).seal["effects"][0] for s in range(40)]
    assert all(e["amplitude"] > 0 for e in clamps) and {e["where"] for e in clamps} == set("ABCD")


def test_scatter_has_the_stated_size():
    design = factorial(specimens=[f"s{n}" for n in range(4000)])
    quiet = moduli(draw(1, design=design, scatter=QUIET))
    ratio = np.log(moduli(draw(1, design=design)) / quiet).reshape(4000, 30)
    within = ratio.real - ratio.real.mean(axis=1, keepdims=True)
    assert within.std() == pytest.approx(0.01 * (29 / 30) ** 0.5, rel=0.01)
    assert np.degrees(ratio.imag.std()) == pytest.approx(0.3, rel=0.01)
    assert np.degrees(ratio.imag.mean()) == pytest.approx(0.0, abs=0.004)
    assert ratio.real.mean(axis=1).std() == pytest.approx(0.03, rel=0.04)


@pytest.mark.parametrize("cause", ["channel_delay", "guide_friction", "moving_mass", "gain_at_frequency"])
def test_records_reduce_to_the_peaks_of_the_same_case(cause):
    hidden = [Hidden(cause, amplitude=5 * (CATALOGUE.get(cause) or OUTSIDE[cause]).step, sign=1)]
    design = factorial(specimens="AB", temperatures=(-10.0, 30.0))
    peaks = draw(2, hidden, design=design).table
    fine = Sampling(rate=40e3, cycles=10, noise=0.0)
    case = draw(2, hidden, design=design, form="records", sampling=fine)
    for row, record in zip(peaks.itertuples(), case.records.values(), strict=True):
        force, displacement, psi = reduce_record(*record.to_numpy().T, row.frequency_Hz)
        assert displacement == pytest.approx(row.z0_m, rel=2e-4)
        assert force == pytest.approx(row.F0_N, rel=2e-4)
        assert np.degrees(psi) == pytest.approx(row.psi_deg, abs=0.02)


def test_noise_offset_and_drift_of_records_are_small_beside_the_scatter():
    design = factorial(specimens="A", temperatures=(10.0,))
    peaks, case = draw(2, design=design).table, draw(2, design=design, form="records")
    assert case.table["record"].tolist() == list(case.records)
    for row, record in zip(peaks.itertuples(), case.records.values(), strict=True):
        force, displacement, psi = reduce_record(*record.to_numpy().T, row.frequency_Hz)
        assert force / displacement == pytest.approx(row.F0_N / row.z0_m, rel=2e-3)
        assert np.degrees(psi) == pytest.approx(row.psi_deg, abs=0.1)


def test_slider_force_is_constant_against_the_velocity():
    design = factorial(specimens="A", temperatures=(10.0,), frequencies=(10.0,))
    smooth = Sampling(noise=0.0, offset=0.0, drift=0.0)
    plain, rubbed = (
        draw(2, hidden, design=design, form="records", sampling=smooth).records["record_0001.csv"]
        for hidden in ([], [Hidden("guide_friction", amplitude=2.0)])
    )
    added = (rubbed["force_N"] - plain["force_N"]).to_numpy()
    velocity = np.gradient(plain["displacement_m"])
    moving = np.abs(velocity) > 0.1 * np.abs(velocity).max()
    assert added[moving] == pytest.approx(2.0 * np.sign(velocity[moving]), abs=1e-9)


def test_pairs_add_in_the_linear_limit():
    hidden = [Hidden("channel_delay", amplitude=1e-6), Hidden("guide_friction", amplitude=1e-3)]
    empty = moduli(draw(5))
    both, first, second = (np.log(moduli(draw(5, h)) / empty) for h in (hidden, hidden[:1], hidden[1:]))
    size = np.abs(both).max()
    assert len(draw(5, hidden).seal["effects"]) == 2
    assert np.abs(both) == pytest.approx(np.abs(first + second), abs=1e-2 * size)


def test_a_design_without_what_an_effect_needs_is_refused():
    for cause, column in (("strain_softening", "amplitude_m"), ("damage", "cycles")):
        with pytest.raises(ValueError, match=column):
            draw(1, [Hidden(cause, amplitude=0.01)])
    with pytest.raises(ValueError, match="specimen"):
        draw(1, [Hidden("loose_clamp", amplitude=1e-8)], design=factorial(specimens="A"))
    with pytest.raises(ValueError, match="no temperature_C 12"):
        draw(1, [Hidden("temperature_bias", amplitude=1.0, where=12.0)])


def test_designs():
    design = factorial("AB", (0.0, 10.0), (1.0, 10.0), (2e-5, 6e-5), replicates=2, order="cold_first")
    assert len(design) == 32 and sorted(design["replicate"].unique()) == [1, 2]
    first = design[design["specimen"] == "A"]
    assert first["order"].tolist() == list(range(1, 17)) and first["temperature_C"].is_monotonic_increasing
    assert first["cycles"].tolist()[:3] == [0, 10, 20]
    table = draw(1, design=design, form="moduli").table
    assert {"replicate", "order", "cycles", "amplitude_m", "E_MPa", "phase_deg"} <= set(table)
    assert (
        500 < table["E_MPa"].min() < table["E_MPa"].max() < 45e3 and table["phase_deg"].between(0, 60).all()
    )


def test_measure_adds_nothing_but_scatter_to_simulated_histories():
    tests = factorial(specimens="AB", temperatures=(15.0,)).drop(columns="amplitude_m")
    histories = []
    for f in tests["frequency_Hz"]:
        time = np.arange(1, round(5 / f / 5e-5) + 1) * 5e-5
        early = np.exp(-3.0 * time * f)  # a transient that the last two cycles hardly see
        force = 20.0 * np.sin(2 * np.pi * f * time + 0.3) + 20.0 * early
        histories.append((time, force, 63e-6 * np.sin(2 * np.pi * f * time)))
    table = measure(tests, histories, GEOMETRY, seed=1, scatter=Scatter(0.0, 0.0, 0.0))
    assert table["F0_N"].to_numpy() == pytest.approx(20.0, rel=1e-4)
    assert table["psi_deg"].to_numpy() == pytest.approx(np.degrees(0.3), abs=0.02)
    spread = measure(tests, histories, GEOMETRY, seed=1)
    assert spread["z0_m"].to_numpy() == pytest.approx(table["z0_m"].to_numpy())
    assert 1e-3 < np.log(spread["F0_N"] / table["F0_N"]).std() < 0.1
