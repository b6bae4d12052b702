"""Verdicts on results follow from the numbers, in both directions."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest
from judgements import by_id, judgement

from asphalt_nscd.measurements.twopoint import PAPER
from studies.paper import outcomes
from studies.paper.bond_readings import AFTER, BARYCENTRES, MEAN_RADIUS, OURS
from studies.paper.finding import DIFFERS, HOLDS, INCONSISTENT, LEFT_OPEN, REPRODUCED, UNCHECKED

COUNTS = np.array([2, 4, 6.3, 8, 10]) * 1e-3, np.array([11798, 1588, 492, 211, 71])


def some_tests(ratio=1.1, broken=0):
    return pd.DataFrame(
        {
            "specimen": "s1",
            "temperature_C": [0.0, 0.0, 20.0],
            "frequency_Hz": [3.0, 40.0, 3.0],
            "E_MPa": np.array([1.0, 1.001, 1.0]) * ratio * 1e4,
            "E_law_MPa": 1e4,
            "phase_deg": 10.02,
            "phase_law_deg": 10.0,
            "broken_bonds": [broken, 0, 0],
            "smallest_gap_m": 3e-5,
        }
    )


PACKING = pd.DataFrame(
    {"solid_fraction": [0.60, 0.64, 0.68], "E_MPa": [0.8, 0.95, 1.1], "E_law_MPa": [1.0, 1.0, 1.0]}
)


def readings(said=1.1, allowed=1.0):
    names = [OURS, AFTER, OURS, BARYCENTRES, MEAN_RADIUS]
    ratios = [said, 1.05, allowed, 80.0, 2.4]
    return pd.DataFrame(
        {
            "reading": names,
            "friction": [0.2, 0.2, 0.5, 0.2, 0.2],
            "gap_max_mm": [2.0, 1.931, 2.0, 2.0, 2.0],
            "bonds": [70, 60, 65, 70, 70],
            "through_third_sphere_percent": 12.5,
            "E_over_law": ratios,
            "expected": ratios,
            "possible": [False, False, allowed is not None, False, False],
        }
    )


def test_bonds_read_literally_and_their_poisson_ratio():
    rows = by_id(outcomes.bonds(readings()))
    assert rows["barycentre"].ours == "80 or 1.1" and rows["barycentre"].verdict == LEFT_OPEN
    tangential = rows["tangential"]
    assert tangential.verdict == DIFFERS and tangential.ours == pytest.approx((1 - 1 / 2.7) / (4 + 1 / 2.7))


@pytest.mark.parametrize(("gap", "verdict"), [(3e-5, UNCHECKED), (-1e-9, REPRODUCED)])
def test_contacts_count_only_where_a_gap_closes(gap, verdict):
    row = judgement(outcomes.contacts(pd.DataFrame({"smallest_gap_m": [1e-4, gap]})))
    assert row.verdict == verdict and ("Not exercised" in row.evidence) == (gap > 0)


def test_ratio_and_its_dependence_on_the_packing():
    rows = by_id(outcomes.laws_and_samples(some_tests(), PACKING, readings(allowed=None)))
    ratio = rows["macro_is_micro"]
    assert ratio.ours == pytest.approx(1.1, rel=1e-3) and ratio.verdict == DIFFERS
    assert (
        "0.800 at 0.600, 0.950 at 0.640, 1.100 at 0.680" in ratio.evidence and "facets" not in ratio.evidence
    )
    assert rows["one_ratio"].ours == pytest.approx(0.1) and rows["one_ratio"].verdict == HOLDS
    assert rows["fluctuations"].ours == pytest.approx(0.02) and rows["fluctuations"].verdict == UNCHECKED
    assert rows["yield_stress"].verdict == REPRODUCED


def test_tests_that_break_bonds_are_counted_and_left_out_of_the_ratio():
    tests = some_tests(ratio=1.0, broken=3)
    tests.loc[0, "E_MPa"] = 0.99e4
    rows = by_id(outcomes.laws_and_samples(tests, PACKING, readings()))
    assert rows["macro_is_micro"].verdict == REPRODUCED and rows["one_ratio"].verdict == HOLDS
    whole = rows["yield_stress"]
    assert whole.ours == 3 and whole.verdict == DIFFERS and "at 0 degC." in whole.evidence
    assert "is 0.9900 instead of 1.0005" in whole.evidence


def table4(**columns):
    table = {"temperature_C": [0.0, 20.0], "compared_with": "reconstructed"}
    for kind in ("E", "phase"):
        table |= {f"mre_{kind}_{who}_percent": 1.0 for who in ("published", "law", "simulated")}
    return pd.DataFrame(table | columns)


def test_an_error_against_data_that_were_made_of_the_same_law_reproduces_nothing():
    refit = pd.DataFrame({"temperature_C": [0.0, 20.0], "mre_phase_percent": [0.7, 0.8]})
    rows = by_id(outcomes.agreement(table4(), refit))
    assert rows["fig10"].verdict == UNCHECKED and "0.7 %" in rows["fig10"].evidence
    assert rows["burgers_describes"].ours == "not known" and "1.0 %" in rows["burgers_describes"].evidence


def test_peaks_are_held_against_the_harmonic_fit():
    tests = some_tests().assign(E_peak_MPa=lambda t: t["E_MPa"], phase_peak_deg=10.02)
    assert judgement(outcomes.reduction(tests)).verdict == REPRODUCED
    assert judgement(outcomes.reduction(tests.assign(phase_peak_deg=10.8))).verdict == DIFFERS


def test_an_overtone_is_no_sinusoid():
    time = np.arange(1, 501) / 2500.0
    force = 3.0 + time + 10.0 * np.sin(2 * np.pi * 10 * time)

    def found(force):
        arrays = {"time_s": time, "displacement_m": 0.0 * time, "force_N": force}
        return judgement(outcomes.waveform(SimpleNamespace(arrays=arrays, attributes={"frequency_Hz": 10.0})))

    pure, bent = found(force), found(force + 0.3 * np.cos(2 * np.pi * 30 * time))
    assert pure.ours == pytest.approx(0.0, abs=1e-6) and pure.verdict == HOLDS
    assert bent.ours == pytest.approx(3.0, rel=0.01) and bent.verdict == DIFFERS


def test_time_step_matters_only_where_gauss_seidel_stops():
    rows = by_id(outcomes.numerics(*time_steps()))
    assert rows["time_step"].verdict == DIFFERS and "0.01 to 0.1 of the solved" in rows["time_step"].evidence
    assert rows["steps"].verdict == HOLDS
    assert "They take 70 to 300 sweeps a step" in rows["stable_reactions"].evidence
    assert outcomes.longest_step(time_steps()[1], "explicit (DEM)") == 2e-7
    assert rows["stable_reactions"].verdict == LEFT_OPEN and "0.01 of" in rows["stable_reactions"].evidence


def test_the_audit_holds_no_time_that_differs_from_run_to_run():
    tests, table, costs = time_steps()
    one, two = (
        list(outcomes.numerics(tests, table, costs.assign(cpu_s=cpu))) for cpu in ([1.0, 20.0], [1.7, 30.0])
    )
    assert one == two and judgement(one[-1]).verdict == UNCHECKED
    slow = list(outcomes.numerics(tests, table, costs.assign(cpu_s=[1.0, 3000.0])))
    assert one[-1].ours == "less than a tenth of it" and slow[-1].ours == "a tenth of it or more"


def time_steps():
    tests = pd.DataFrame(
        {"frequency_Hz": [3.0, 40.0], "steps": [33333, 2500], "spheres": 9000, "residual": 1e-8}
    )
    rows = [
        ("solved", np.nan, 5e-5, np.nan, 1.0, True),
        ("solved", np.nan, 2e-4, np.nan, 1.0001, True),
        ("Gauss-Seidel", 1e-4, 5e-5, 70.0, 0.01, False),
        ("Gauss-Seidel", 1e-5, 5e-5, 300.0, 0.1, False),
        ("solved, longest", np.nan, 6e-3, np.nan, np.nan, np.nan),
        ("explicit (DEM), longest", np.nan, 2e-7, np.nan, np.nan, np.nan),
    ]
    columns = ["scheme", "tolerance", "time_step_s", "sweeps_per_step", "E_over_solution", "right"]
    table = pd.DataFrame(rows, columns=columns).assign(spheres=359.0)
    costs = {
        "topic": "cycle of 10 Hz",
        "case": ["reduced, Burgers", "sweeps"],
        "spheres": 9000,
        "time_step_s": 2e-4,
    }
    return tests, table, pd.DataFrame(costs | {"cpu_s": [1.0, 20.0]})


@pytest.mark.parametrize(("bulge", "verdict"), [(0.0, REPRODUCED), (0.05, DIFFERS)])
def test_a_profile_is_held_against_the_beam(bulge, verdict):
    height = np.linspace(0.0, 0.25, 1001)
    shape = PAPER.line(height)[5::10]
    height = height[5::10]
    velocity = np.outer([0.5, 1.0], shape + bulge * np.sin(np.pi * height / 0.25))
    arrays = {"velocity_m_s": velocity, "spheres": np.ones(height.size), "height_m": height}
    rows = by_id(outcomes.profile({f"profile/{name}": values for name, values in arrays.items()}))
    assert rows["fig8_beam"].verdict == verdict


def test_counts_are_held_against_the_sieves_themselves():
    """10 mm: 69 of 100 are retained above 2 mm, 10 of them on 10 mm."""
    curve = pd.DataFrame(
        {"diameter_mm": [12.5, 10, 8, 6.3, 4, 2, 1], "passing_percent": [100, 90, 75, 58, 44, 31, 20]}
    )
    row = judgement(outcomes.grading(curve, *COUNTS))
    volume = COUNTS[1] * COUNTS[0] ** 3
    assert (
        row.ours
        == pytest.approx(100 * abs(volume[-1] / volume.sum() / (10 / 69) - 1))
        == pytest.approx(1.64, abs=0.005)
    )
    assert row.verdict == HOLDS and "at 10 mm" in row.evidence


def test_counts_that_contradict_each_other():
    row = judgement(outcomes.lattice(COUNTS[1]))
    assert (row.ours, row.verdict) == (14160, INCONSISTENT) and "has 8000 cells" in row.evidence
    rows = by_id(outcomes.samples([DEPOSIT], [SPECIMEN], MOVED))
    assert "so 9558 of" in rows["particles_kept"].evidence
    assert rows["particles_kept"].verdict == rows["density"].verdict == INCONSISTENT


DEPOSIT = {
    "spheres": 14160,
    "layer_height_m": 0.0604,
    "poured_layer_height_m": 0.063,
    "solid_fraction": 0.69,
    "poured_segregation": 0.0,
    "largest_overlap_moving_m": 1e-4,
    "periods_with_contact": 28,
}
SPECIMEN = {"spheres": 9500, "density": 3850.0}
MOVED = np.array([[0.3, 0.8, 0.95]])


@pytest.mark.parametrize(
    ("changed", "row"), [({"layer_height_m": 0.0629}, "layer"), ({"poured_segregation": 0.3}, "segregation")]
)
def test_a_layer_is_judged_by_its_height_and_its_grains(changed, row):
    moved = np.array([[0.3, 0.8, 0.95], [0.4, 0.7, 0.92]])
    good = by_id(outcomes.samples([DEPOSIT, DEPOSIT], [SPECIMEN], moved))
    bad = by_id(outcomes.samples([DEPOSIT, DEPOSIT | changed], [SPECIMEN], moved))
    names = ("layer", "segregation")
    assert {good[name].verdict for name in names} == {REPRODUCED}
    assert {name for name in names if bad[name].verdict == DIFFERS} == {row}
    top = good["top_layers"]
    assert top.verdict == LEFT_OPEN and top.ours == pytest.approx(35.0)
    assert "the top 10 mm have 30 to 40 %" in top.evidence and "the upper half 92 to 95 %" in top.evidence


@pytest.mark.parametrize(("lift", "verdict"), [(0.049, REPRODUCED), (0.08, UNCHECKED), (-0.12, DIFFERS)])
def test_what_size_alone_lifts_is_no_segregation(lift, verdict):
    """4 mm, the difference of the radii, are 0.063 of this layer."""
    rows = by_id(outcomes.samples([DEPOSIT | {"poured_segregation": lift}], [SPECIMEN], MOVED))
    assert rows["segregation"].verdict == verdict and "up to 0.063 can be" in rows["segregation"].evidence


def test_what_moves_on_top():
    poured = np.array([[0.0, 0.0, height] for height in (0.01, 0.035, 0.045, 0.06)])
    moved = [[0.0, 0.0, -1e-3], [1e-3, 0.0, 0.0], [0.0, 1e-3, 0.0], [0.0, 3e-3, 0.0]]
    deposit = {"poured_position": poured, "position": poured + moved}
    assert outcomes.moved_on_top(deposit) == pytest.approx([9.0 / 12.0, 10.0 / 12.0, 11.0 / 12.0])
