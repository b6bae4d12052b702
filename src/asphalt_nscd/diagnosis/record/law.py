"""law.json: one law of few parameters for all temperatures, of the mix as all hypotheses have it in the mean."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from asphalt_nscd.diagnosis.record.mixture import Mixture, averaged_over
from asphalt_nscd.diagnosis.search.diagnose import Diagnosis
from asphalt_nscd.diagnosis.simulation.gain import errors
from asphalt_nscd.files.words import joined
from asphalt_nscd.measurements.reduction import LEAST_TESTS
from asphalt_nscd.rheology.fitting import Fit, log_residual
from asphalt_nscd.rheology.priors import prior_of
from asphalt_nscd.rheology.spectrum import LAWS, Spectrum, parameters
from asphalt_nscd.rheology.spectrum_fitting import Form, fit_spectrum
from asphalt_nscd.rheology.spectrum_io import Uncertainty, fit_content

FAR = 1.0  # scatter of one test, of the law from what was found
TERMS = {  # a parameter of the law in words, its unit and how many of it are one SI unit; others go by their name
    "static_modulus": ("the static modulus", " MPa", 1e-6),
    "glassy_modulus": ("the glassy modulus", " GPa", 1e-9),
    "c1": ("C1", "", 1.0),
    "c2": ("C2", " K", 1.0),
    "activation_energy": ("the activation energy", " kJ/mol", 1e-3),
}


@dataclass(frozen=True)
class LawOfMix:
    """A fit of one of `LAWS` to the tests that are kept; `volumetrics` are VMA and VFA in percent, where known."""

    mix: Mixture
    fit: Fit[Spectrum]
    volumetrics: tuple[float, float] | None = None

    @property
    def law(self) -> Spectrum:
        """The law with its shift."""
        return self.fit.law

    @property
    def misfit_of_form(self) -> tuple[float, float]:
        """Root mean square of the law less the free curve at the tests, in ln|E*| and in the phase [rad]."""
        tests = self.mix.tests
        free = self.mix.weights @ self.mix.parts(tests.omega, tests.temperature)[0]
        off = log_residual(np.exp(free), self.law.complex_modulus(tests.omega, tests.temperature))
        of_modulus, of_phase = (float(np.sqrt(np.mean(part**2))) for part in np.split(off, 2))
        return of_modulus, of_phase

    @property
    def uncertainty(self) -> Uncertainty | None:
        """What the tests leave open; None where they do not determine the law."""
        if self.fit.covariance is None:
            return None
        tested = self.mix.tests.temperature
        ends = float(tested.min()), float(tested.max())
        return Uncertainty(self.fit.covariance, self.mix.freedom, self.misfit_of_form, ends)

    def content(self, source: str) -> dict[str, Any]:
        """Content of law.json."""
        content = fit_content(self.fit, source, self.uncertainty)
        return content | {"averaged_over": averaged_over(self.mix)}

    def misses(self, diagnosis: Diagnosis) -> dict[str, float]:
        """Errors of the law with what was taken off, as `errors` has them, mean over the isotherms of its fit."""
        observed = diagnosis.observed
        law = self.law.complex_modulus(observed.omega, observed.temperature)
        shown = np.log(np.abs(law)) + 1j * np.angle(law) + self.mix.effect(observed)
        found = errors(diagnosis, np.where(self.mix.kept, shown, np.nan))
        return {name: float(np.mean(list(by_temperature.values()))) for name, by_temperature in found.items()}

    def compared(self, diagnosis: Diagnosis) -> list[dict[str, Any]]:
        """Each law of `LAWS` with its number of parameters and its errors, as in `misses`."""
        found = []
        for name, kind in LAWS.items():
            taken = isinstance(self.law, kind)
            one = self if taken else LawOfMix(self.mix, _fit(self.mix, name, self.volumetrics))
            about = {"law": name, "title": one.law.title, "parameters": len(parameters(one.law))}
            found.append({**about, **one.misses(diagnosis), "taken": taken})
        return found

    def notes(self, diagnosis: Diagnosis, without: Sequence[str] = ()) -> list[str]:
        """Sentences: what the law is fitted without, and that it cannot take the form of the mix, where it cannot."""
        notes = [f"law.json and reported.csv are fitted without {joined(without)}."] if without else []
        off = self.misfit_of_form
        miss = np.sqrt(np.mean(np.square(np.divide(off, diagnosis.noise.sigma))))
        if miss < FAR or not diagnosis.replicated:  # else the scatter itself is a guess
            return notes
        better = f" No {self.law.title} law fits these tests better." * (not without)
        return [
            *notes,
            "law.json has constants of its own: do not mix them with those of the free master curve. The two laws "
            f"differ by {100.0 * off[0]:.2g} % in |E*| and {np.degrees(off[1]):.1f} deg in phase.{better}",
        ]


def law_of_mix(
    mix: Mixture, form: str = "2s2p1d", volumetrics: tuple[float, float] | None = None
) -> LawOfMix:
    """One law with a WLF shift of the tests less what causes do to them in the mean over the hypotheses.

    Of two temperatures or four tests, which determine no WLF constants, with an Arrhenius shift. What the tests leave
    open is as usual for asphalt concrete, or as its volumetrics say. Errors of |E*| and of the phase count alike: the
    misfit of the form exceeds the scatter, which is therefore no measure of what to trust. The covariance is that of
    the mixture at the tests, carried to the parameters, with that misfit.
    """
    fit, tests = _fit(mix, form, volumetrics), mix.tests
    misfit = np.repeat(np.square(LawOfMix(mix, fit).misfit_of_form), tests.size)
    return LawOfMix(
        mix, fit.restate(mix.covariance(tests.omega, tests.temperature) + np.diag(misfit)), volumetrics
    )


def _fit(mix: Mixture, form: str, volumetrics: tuple[float, float] | None) -> Fit[Spectrum]:
    tests = mix.tests
    reference = float(tests.isotherms[tests.isotherms.size // 2])
    shift = "wlf" if tests.isotherms.size > 2 and tests.size > LEAST_TESTS else "arrhenius"
    return fit_spectrum(
        tests.omega,
        tests.temperature,
        tests.modulus * np.exp(-mix.effect(tests)),
        reference,
        Form(form, shift),
        prior=prior_of(form, volumetrics),
    )


def left_to_priors(fit: Fit) -> tuple[str, list[str]]:
    """What the tests do not determine of the law, in a sentence, and the note with its values; empty if nothing."""
    terms = {name: TERMS.get(name, (name, "", 1.0)) for name in fit.undetermined}
    if not terms:
        return "", []

    def said(names: Sequence[str]) -> str:
        return f"These tests do not determine {joined([terms[name][0] for name in names])} of law.json"

    sizes = []
    for name in fit.from_prior:
        term, unit, factor = terms[name]
        sizes.append(
            f"{term.removeprefix('the ')} {float(f'{factor * parameters(fit.law)[name]:.2g}'):g}{unit}"
        )
    usual = f"{said(fit.from_prior)}; there it has usual values of published asphalt concretes: {', '.join(sizes)}."
    return f"{said(list(terms))}.", [usual] * bool(sizes)


def law_parameters(law: Mapping[str, Any]) -> dict[str, dict[str, Any]]:
    """Parameters in the content of a law file with value, interval_95 and determined; `tau_s` carries its unit."""
    intervals = law.get("interval_95", {})
    return {
        key: {"value": value, "interval_95": intervals.get(key), "determined": key not in law["unseen"]}
        for key, value in law.items()
        if isinstance(value, float) and key not in ("reference_temperature_C", "rms_log_residual")
    }
