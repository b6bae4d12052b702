"""First fits of a table."""

from types import SimpleNamespace

import numpy as np
import pytest

from asphalt_nscd.diagnosis.model import start
from asphalt_nscd.diagnosis.observed import scatter
from asphalt_nscd.diagnosis.observed.observations import Observations
from asphalt_nscd.rheology.fitting import fit_burgers


@pytest.mark.parametrize("frequency", [[3.0, 6, 10, 25, 40], [0.1, 1, 10]], ids=["paper", "two decades"])
def test_each_burgers_law_is_the_best_of_many_random_starts(frequency):
    omega = 2.0 * np.pi * np.array(frequency)
    isotherms = [-10.0, 15.0, 30.0]
    time = [10.0, 0.05, 1e-3]
    moduli = [30e9 / (1.0 + 2.0 * (1j * omega * t) ** -0.2 + (1j * omega * t) ** -0.6) for t in time]
    n, m = omega.size, len(isotherms)
    observed = Observations(
        np.zeros(m * n, int),
        ("a",),
        np.repeat(isotherms, n),
        np.tile(frequency, m),
        np.concatenate(moduli),
        np.ones(m * n),
        np.zeros(m * n),
    )
    # Modulus and phase weighted alike and the specimen's scale held, as fit_burgers takes them.
    noise = scatter.stated(observed, 1e-2, 1e-2, 1e-9)
    _, fitted = start.fit_burgers_at_each(observed, noise)
    for rows, modulus in zip(np.split(np.arange(m * n), m), moduli, strict=True):
        law = fit_burgers(omega, modulus).law
        wanted = np.log(law.complex_modulus(omega))
        assert np.abs(fitted.modelled[rows] - wanted).max() < 1e-5


def test_a_rougher_spectrum_pays_for_each_of_its_second_differences():
    """ln of exp(-objective / 2) / sqrt(det precision) / roughness^(m - 2), of ten branches and three parameters."""
    joint = SimpleNamespace(spectrum=SimpleNamespace(times=np.zeros(10), roughness=0.5))
    fitted = SimpleNamespace(objective=3.0, precision=2.0 * np.eye(3))
    expected = -1.5 - 1.5 * np.log(2.0) - 8.0 * np.log(0.5)
    assert start.marginal_likelihood(joint, fitted) == pytest.approx(expected)
