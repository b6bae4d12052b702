"""The Burgers law against its differential equation, its limits and itself in another domain."""

import numpy as np
import pytest
from scipy.integrate import quad, solve_ivp

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.rheology.burgers import Burgers

LAW = Burgers(24.3e9, 3.71e9, 48.4e9, 0.773e9)  # 15 degC
COLD = Burgers(39.8e9, 62.8e9, 956e9, 14.9e9)  # -10 degC


def test_printed_storage_and_loss_compliance():
    """Eqs. (28)-(29) term by term; D'' is the loss, so D* = D' - i D''."""
    omega = np.array([0.1, 18.85, 251.3])
    kelvin = LAW.modulus_k**2 + (omega * LAW.viscosity_k) ** 2
    storage = 1 / LAW.modulus_m + LAW.modulus_k / kelvin
    loss = 1 / (omega * LAW.viscosity_m) + omega * LAW.viscosity_k / kelvin
    np.testing.assert_allclose(LAW.complex_compliance(omega), storage - 1j * loss, rtol=1e-13)
    np.testing.assert_allclose(np.tan(np.angle(LAW.complex_modulus(omega))), loss / storage, rtol=1e-12)


@pytest.mark.parametrize("law", [LAW, COLD])
def test_creep_solves_the_differential_equation(law):
    """Kelvin strain: eta_k e' + E_k e = 1; Maxwell: e' = 1/eta_m after the jump 1/E_m."""
    times = np.array([1e-3, 0.02, 0.3, 5.0])
    kelvin = solve_ivp(
        lambda _, e: (1e9 - law.modulus_k * e) / law.viscosity_k,
        (0, 5),
        [0.0],
        t_eval=times,
        rtol=1e-11,
        atol=1e-15,
    ).y[0]
    expected = 1 / law.modulus_m + times / law.viscosity_m + kelvin * 1e-9
    np.testing.assert_allclose(law.creep_compliance(times), expected, rtol=1e-9)


@pytest.mark.parametrize("time", [1e-3, 0.1, 3.0])
@pytest.mark.parametrize("law", [LAW, COLD])
def test_relaxation_and_creep_are_each_others_inverse(law, time):
    """Integral of E(t - s) J(s) ds from 0 to t is t."""

    def integrand(s: float) -> float:
        return law.relaxation_modulus(time - s) * law.creep_compliance(s)

    assert quad(integrand, 0, time, epsrel=1e-11)[0] == pytest.approx(time, rel=1e-9)


def test_relaxation_gives_the_complex_modulus():
    """E* = i omega times the one-sided Fourier transform of E(t)."""
    omega = 12.0
    end = 20.0  # s, after which E(t) is below 1e-30 of its start

    def transform(weight: str) -> float:
        return quad(
            LAW.relaxation_modulus, 0, end, weight=weight, wvar=omega, limit=200, epsabs=0, epsrel=1e-10
        )[0]

    modulus = omega * (transform("sin") + 1j * transform("cos"))
    assert modulus == pytest.approx(LAW.complex_modulus(omega), rel=1e-8)


@pytest.mark.parametrize("value", [0.0, -1.0, np.nan])
def test_impossible_parameters_are_refused(value):
    with pytest.raises(InputError, match="viscosity_k"):
        Burgers(1e9, 1e9, 1e9, value)
