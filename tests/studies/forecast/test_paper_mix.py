"""A binder known by its penetration alone, and the paper's mix made with it."""

import numpy as np
import pytest

from studies.forecast.paper_mix import EXPONENT, compare_paper, softening_point, stiffness


def test_a_point_by_hand():
    """Penetration 40 before mixing, 20 degC, 0.02 s."""
    index = (27 * np.log10(40) - 21.65) / (76.35 * np.log10(40) - 232.82)
    ring_and_ball = 98.4 - 26.4 * np.log10(26.0)
    by_hand = 1.157e-7 * 0.02**-0.368 * np.exp(-index) * (ring_and_ball - 20.0) ** 5  # MPa
    assert softening_point(40.0) == pytest.approx(ring_and_ball)
    found = stiffness(40.0, 20.0, np.array([50.0]))
    assert abs(found) == pytest.approx(1e6 * by_hand, rel=1e-12)
    assert 3e7 < abs(found[0]) < 1e8  # as of a 35/50
    assert np.angle(found) == pytest.approx(EXPONENT * np.pi / 2)


def test_outside_the_nomograph_nothing_is_known():
    omega = 2 * np.pi * np.array([0.1, 10.0, 100.0])
    assert np.isfinite(stiffness(40.0, 20.0, omega)).tolist() == [False, True, False]
    assert np.isnan(stiffness(40.0, np.array([-20.0, 45.0]), omega[1])).all()


@pytest.mark.filterwarnings("error")  # where the nomograph knows no stiffness, nothing is computed
def test_the_papers_mix(recipe):
    found = compare_paper(
        "data/paper/table1_grading.csv",
        "data/paper/table3_burgers.csv",
        recipe,
    )
    assert set(found["temperature_C"]) == {10.0, 15.0, 20.0, 30.0} and set(found["frequency_Hz"]) == {
        3,
        6,
        10,
    }
    assert (found["E_soft_MPa"] < found["E_middle_MPa"]).all()
    assert (found["E_middle_MPa"] < found["E_hard_MPa"]).all()
    # Table 3 at 20 degC and 10 Hz by hand: Maxwell and Kelvin elements in series
    w = 2 * np.pi * 10
    compliance = 1 / 20.2e9 + 1 / (1j * w * 1.79e9) + 1 / (27.2e9 + 1j * w * 0.461e9)
    row = found.query("temperature_C == 20 and frequency_Hz == 10").iloc[0]
    assert row.E_table3_MPa == pytest.approx(abs(1 / compliance) / 1e6, rel=1e-6)
