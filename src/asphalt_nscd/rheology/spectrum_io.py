"""Law files of all temperatures: a continuous law with its origin and its standard errors, as JSON."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.special import ndtri, stdtrit

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.store import write_json
from asphalt_nscd.rheology.fitting import Fit
from asphalt_nscd.rheology.laws_io import content_of, numbers_of, renamed
from asphalt_nscd.rheology.shift import SHIFTS
from asphalt_nscd.rheology.spectrum import LAWS, Spectrum, parameter_names, parameters

# Keys of parameters with a unit; others have the name of the parameter.
_KEYS = {
    "static_modulus": "E_static_Pa",
    "glassy_modulus": "E_glassy_Pa",
    "tau": "tau_s",
    "c1": "wlf_C1",
    "c2": "wlf_C2_K",
    "activation_energy": "activation_energy_J_mol",
}
_REFERENCE = {"reference_temperature": "reference_temperature_C"}
# Standard deviation of ln a_T by which the shift of a mix leaves the form that is fitted, this far [K] from the
# reference temperature; it grows with the cube. Half of the prior of the free curve (`diagnosis.model.bases`), for C2
# has one too.
DEPARTURE, DEPARTURE_KELVIN = 0.1, 25.0


def student(freedom: float) -> float:
    """Standard errors to either side of an estimate that hold 95 %: a quantile of Student's t.

    `freedom` are the degrees of freedom of the estimate of the scatter, infinite where the scatter is known.

    >>> round(student(np.inf), 2), round(student(2.0), 2)
    (1.96, 4.3)
    """
    return float(stdtrit(freedom, 0.975)) if np.isfinite(freedom) else float(ndtri(0.975))


@dataclass(frozen=True)
class Uncertainty:
    """What the tests leave open of a law.

    `covariance` (p, p) is of the logarithms of its parameters, `freedom` of the errors of |E*| and of the phase. `form`
    is the root mean square by which a law of this form misses a curve of any form, in ln|E*| and in the phase [rad].
    `tested`: coldest and warmest test [degC], beyond which the shift may leave its form.
    """

    covariance: NDArray[np.float64]
    freedom: tuple[float, float]
    form: tuple[float, float] = (0.0, 0.0)
    tested: tuple[float, float] = (-np.inf, np.inf)

    def half(self, law: Spectrum, omega: NDArray, temperature: NDArray) -> NDArray[np.complex128]:
        """Half-widths of the 95 % intervals of the E* of the mix; the misfit of the form counts too.

        `omega` [rad/s] and `temperature` [degC] are (n,); returns (n,), of ln|E*| and, imaginary, of the phase [rad].
        """
        slopes = law.log_slopes(omega, temperature)
        along = slopes[:, list(parameters(law)).index("tau")]  # by ln tau, as by ln a_T
        beyond = self._departure(law.shift.reference_temperature, temperature)
        # Without the misfit of the form the band held 84 to 91 % of drawn mixes, and 75 to 84 % of their phases.
        of_modulus, of_phase = (
            student(freedom)
            * np.sqrt(np.einsum("ij,jk,ik->i", part, self.covariance, part) + form**2 + (steep * beyond) ** 2)
            for part, steep, freedom, form in zip(
                (slopes.real, slopes.imag), (along.real, along.imag), self.freedom, self.form, strict=True
            )
        )
        return of_modulus + 1j * of_phase

    def _departure(self, reference: float, temperature: NDArray) -> NDArray[np.float64]:
        """Standard deviation (n,) of ln a_T off the form of the shift, from the nearest tested temperature on."""
        ends = np.clip(temperature, *self.tested)
        here, there = (((t - reference) / DEPARTURE_KELVIN) ** 3 for t in (temperature, ends))
        return DEPARTURE * np.abs(here - there)


def spectrum_content(
    law: Spectrum,
    *,
    source: str,
    rms_log_residual: float,
    std_error: dict[str, float] | None = None,
    unseen: Iterable[str] = (),
    from_prior: Iterable[str] | None = None,
    uncertainty: Uncertainty | None = None,
) -> dict[str, Any]:
    """Content of the file of a continuous law, which holds for all temperatures.

    `std_error` has each parameter by field name and in its unit. The tests do not determine `unseen`; those of them in
    `from_prior` have the value of a prior (None: no prior was used). The smaller of the degrees of freedom of
    `uncertainty` makes the intervals of the parameters.
    """
    keys = _keys_of(type(law)) | _keys_of(type(law.shift))
    content: dict[str, Any] = {
        "law": next(name for name, kind in LAWS.items() if type(law) is kind),
        "shift": next(name for name, kind in SHIFTS.items() if type(law.shift) is kind),
        "source": source,
        **renamed(parameters(law), keys),
        **renamed({"reference_temperature": law.shift.reference_temperature}, _REFERENCE),
        "std_error": None if std_error is None else renamed(std_error, keys),
        "unseen": [keys[name] for name in unseen],
        "rms_log_residual": rms_log_residual,
    }
    if from_prior is not None:
        content["from_prior"] = [keys[name] for name in from_prior]
    if uncertainty is not None:
        covariance, freedom = uncertainty.covariance, uncertainty.freedom
        values = np.array(list(parameters(law).values()))
        # On logarithms, in which the law was fitted: no interval reaches zero.
        spread = np.exp(student(min(freedom)) * np.sqrt(np.diag(covariance)))
        content["interval_95"] = {
            keys[name]: [float(value / by), float(value * by)]
            for name, value, by in zip(parameters(law), values, spread, strict=True)
            if std_error is not None and name in std_error
        }
        content["covariance_of_logarithms"] = {
            "parameters": [keys[name] for name in parameters(law)],
            "values": covariance.tolist(),
            "freedom": [float(one) if np.isfinite(one) else None for one in freedom],
            "misfit_of_form": list(uncertainty.form),
            "tested_C": [float(one) if np.isfinite(one) else None for one in uncertainty.tested],
        }
    return content


def fit_content(fit: Fit[Spectrum], source: str, uncertainty: Uncertainty | None = None) -> dict[str, Any]:
    """Content of the file of a fitted law; `uncertainty` replaces that of the fit where it is better known."""
    if uncertainty is None and fit.covariance is not None:
        uncertainty = Uncertainty(fit.covariance, (fit.freedom, fit.freedom))
    return spectrum_content(
        fit.law,
        source=source,
        rms_log_residual=fit.rms_log_residual,
        std_error=fit.std_error,
        unseen=fit.undetermined,
        from_prior=fit.from_prior,
        uncertainty=uncertainty,
    )


def uncertainty_of(path: str | Path, content: dict[str, Any], law: Spectrum) -> Uncertainty | None:
    """The uncertainty in the content of a law file; None where the file says nothing of it."""
    said = content.get("covariance_of_logarithms")
    if said is None:
        return None
    keys = _keys_of(type(law)) | _keys_of(type(law.shift))
    try:
        covariance = np.array(said["values"], float)
        freedom = tuple(np.inf if one is None else float(one) for one in said["freedom"])
        form = tuple(float(one) for one in said["misfit_of_form"])
        coldest, warmest = said["tested_C"]
        tested = -np.inf if coldest is None else coldest, np.inf if warmest is None else warmest
        sound = said["parameters"] == [keys[name] for name in parameters(law)]
        sound = sound and len(freedom) == 2 == len(form)
    except (KeyError, TypeError, ValueError):
        sound = False
    if not sound or covariance.shape != (len(keys), len(keys)) or not np.isfinite(covariance).all():
        raise InputError(f"{path}: key 'covariance_of_logarithms' is damaged; make the file again.")
    return Uncertainty(covariance, (freedom[0], freedom[1]), (form[0], form[1]), tested)


def write_spectrum(path: str | Path, law: Spectrum, **said: Any) -> dict[str, Any]:
    """Write a continuous law as JSON and return the content; `said` goes to `spectrum_content`."""
    content = spectrum_content(law, **said)
    write_json(path, content)
    return content


def read_spectrum(path: str | Path) -> Spectrum:
    """Read a continuous law from a JSON file."""
    return spectrum_of(path, content_of(path, list(LAWS)))


def spectrum_of(path: str | Path, content: dict[str, Any]) -> Spectrum:
    """The continuous law in the content of a file; `path` is for messages only."""
    if content.get("shift") not in SHIFTS:
        raise InputError(
            f"{path}: key 'shift' is {content.get('shift')!r}; give one of {', '.join(SHIFTS)} "
            "or make the file again."
        )
    kind, shift = LAWS[content["law"]], SHIFTS[content["shift"]]
    values = numbers_of(path, content, _keys_of(kind))
    refusal = kind.refusal(values)
    if refusal:
        raise InputError(f"{path}: {refusal}; correct it or make it again.")
    of_shift = _keys_of(shift)
    shifted = numbers_of(path, content, of_shift | _REFERENCE)
    for name, key in of_shift.items():
        if shifted[name] <= 0.0:
            raise InputError(
                f"{path}: {key} = {shifted[name]:g}; give one above zero, with which a warmer mix is softer."
            )
    return kind(**values, shift=shift(**shifted))


def _keys_of(kind: type) -> dict[str, str]:
    return {name: _KEYS.get(name, name) for name in parameter_names(kind)}
