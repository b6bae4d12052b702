"""The simulation extended by what a diagnosis named: a law for each test, and a rig for each sample.

One continuous law holds for all temperatures. It is fitted to the measurements with the effect of the
named causes taken off, except those that the measurements themselves speak against; a test gets the
Kelvin chain of this law at its temperature, changed by the causes that sit in the material or the
specimen; those at the head and in the channel become the rig.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from asphalt_nscd.diagnosis.causes import CATALOGUE
from asphalt_nscd.diagnosis.causes._cause import MATERIAL, SPECIMEN
from asphalt_nscd.diagnosis.model.joint import Candidate
from asphalt_nscd.diagnosis.observed.observations import Complex, Observations, Vector
from asphalt_nscd.diagnosis.observed.reading import read_observations
from asphalt_nscd.diagnosis.search.diagnose import Diagnosis
from asphalt_nscd.diagnosis.simulation.bond_mapping import NAME as BOND_MAPPING
from asphalt_nscd.diagnosis.simulation.gain import errors
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.store import read_json, write_json
from asphalt_nscd.files.words import joined
from asphalt_nscd.measurements.reduction import LEAST_TESTS
from asphalt_nscd.rheology.conversion import kelvin_chain
from asphalt_nscd.rheology.fitting import Fit, log_residual
from asphalt_nscd.rheology.laws_io import write_chain
from asphalt_nscd.rheology.priors import prior_of
from asphalt_nscd.rheology.spectrum import LAWS, Spectrum, parameters
from asphalt_nscd.rheology.spectrum_fitting import Form, fit_spectrum
from asphalt_nscd.rheology.spectrum_io import read_spectrum

TOLERANCE = 1e-3  # of ln E* of a Kelvin chain over the tested band
FAR = 1.0  # scatter of one test, of the law of the extended simulation from what was found
MARGIN = 2.0  # of the band, for the transient of a test
TERMS = {  # a parameter of the law in words, its unit and how many of it are one SI unit; others go by their name
    "static_modulus": ("the static modulus", " MPa", 1e-6),
    "glassy_modulus": ("the glassy modulus", " GPa", 1e-9),
    "c1": ("C1", "", 1.0),
    "c2": ("C2", " K", 1.0),
    "activation_energy": ("the activation energy", " kJ/mol", 1e-3),
}


def material_law(
    diagnosis: Diagnosis,
    used: NDArray[np.bool_] | None = None,
    form: str = "2s2p1d",
    volumetrics: tuple[float, float] | None = None,
) -> Fit[Spectrum]:
    """One law with a WLF shift of the measurements without the causes that are taken off.

    Of two temperatures or four tests, which determine no WLF constants, with an Arrhenius shift. What the tests leave
    open is as usual for asphalt concrete, or as its `volumetrics` (VMA and VFA in percent) say. Errors of |E*| and of the phase count alike: the misfit of the form exceeds
    the scatter, which is therefore no measure of what to trust. The covariance is that of the free curve at the tests
    (see `reported`), carried to the parameters, with that misfit.
    """
    observed = diagnosis.observed
    modulus = observed.modulus / effect_taken_off(diagnosis)
    rows = np.ones(observed.size, bool) if used is None else used
    reference = float(observed.isotherms[observed.isotherms.size // 2])
    shift = "wlf" if observed.isotherms.size > 2 and observed.size > LEAST_TESTS else "arrhenius"
    fit = fit_spectrum(
        observed.omega[rows],
        observed.temperature[rows],
        modulus[rows],
        reference,
        Form(form, shift),
        prior=prior_of(form, volumetrics),
    )
    free, slope = diagnosis.ladder.joint.apparent(diagnosis.ladder.fitted.law, ())
    along = (slope[rows] / free[rows, None])[:, : diagnosis.ladder.fitted.law.size]
    along = np.concatenate([along.real, along.imag])
    size = along.shape[1]
    misfit = np.repeat(np.square(misfit_of_form(diagnosis, fit.law, rows)), along.shape[0] // 2)
    return fit.restate(along @ diagnosis.ladder.fitted.covariance[:size, :size] @ along.T + np.diag(misfit))


def misfit_of_form(diagnosis: Diagnosis, law: Spectrum, used: NDArray[np.bool_]) -> tuple[float, float]:
    """Root mean square of the law less the free curve, in ln|E*| and in the phase [rad]; `used` (n,) tests count."""
    observed = diagnosis.observed
    free = _mix_modulus(diagnosis)[used]
    off = log_residual(free, law.complex_modulus(observed.omega[used], observed.temperature[used]))
    of_modulus, of_phase = (float(np.sqrt(np.mean(part**2))) for part in np.split(off, 2))
    return of_modulus, of_phase


def compared(
    diagnosis: Diagnosis,
    fit: Fit[Spectrum],
    used: NDArray[np.bool_],
    volumetrics: tuple[float, float] | None = None,
) -> list[dict[str, Any]]:
    """Each law of `LAWS` with its number of parameters and its errors, as in `law_misses`; `fit` is the one taken."""
    found = []
    for name, kind in LAWS.items():
        law = fit.law if isinstance(fit.law, kind) else material_law(diagnosis, used, name, volumetrics).law
        about = {"law": name, "title": law.title, "parameters": len(parameters(law))}
        found.append({**about, **law_misses(diagnosis, law, used), "taken": law is fit.law})
    return found


def law_notes(diagnosis: Diagnosis, law: Spectrum, without: Sequence[str] = ()) -> list[str]:
    """Sentences: what the law is fitted without, and that it cannot take the form of the mix, where it cannot."""
    both = f"the free master curve with {'it' if len(without) == 1 else 'them'}"
    notes = [f"law.json is fitted without {joined(without)}, {both}."] if without else []
    off = misfit_of_form(diagnosis, law, np.ones(diagnosis.observed.size, bool))
    miss = np.sqrt(np.mean(np.square(np.divide(off, diagnosis.noise.sigma))))
    if miss < FAR or not diagnosis.replicated:  # else the scatter itself is a guess
        return notes
    better = f" No {law.title} law fits these tests better." * (not without)
    return [
        *notes,
        "law.json has constants of its own: do not mix them with those of the free master curve. The two laws differ "
        f"by {100.0 * off[0]:.2g} % in |E*| and {np.degrees(off[1]):.1f} deg in phase.{better}",
    ]


def law_misses(diagnosis: Diagnosis, law: Spectrum, used: NDArray[np.bool_]) -> dict[str, float]:
    """Mean relative errors [%] of the law with what was taken off, as in Table 4; `used` (n,) are tests of its fit."""
    observed = diagnosis.observed
    shown = effect_taken_off(diagnosis) * law.complex_modulus(observed.omega, observed.temperature)
    found = errors(diagnosis, np.where(used, np.log(np.abs(shown)) + 1j * np.angle(shown), np.nan))
    return {name: float(np.mean(list(by_temperature.values()))) for name, by_temperature in found.items()}


def left_to_priors(fit: Fit) -> tuple[str, list[str]]:
    """What the tests do not determine of the law, in a sentence, and the note with its values; empty if nothing."""
    names, sizes = [], []
    for name in fit.from_prior:
        term, unit, factor = TERMS.get(name, (name, "", 1.0))
        names.append(term)
        sizes.append(
            f"{term.removeprefix('the ')} {float(f'{factor * parameters(fit.law)[name]:.2g}'):g}{unit}"
        )
    if not names:
        return "", []
    said = f"These tests do not determine {joined(names)} of law.json"
    return f"{said}.", [
        f"{said}; there it has usual values of published asphalt concretes: {', '.join(sizes)}."
    ]


def effect_taken_off(diagnosis: Diagnosis) -> Complex:
    """E* of each test (n,) with the causes that are taken off over that of the mix alone, by the last fit."""
    ladder = diagnosis.ladder
    off = {rung.candidate.key for rung in ladder.rungs if diagnosis.taken_off(rung)}
    active = tuple(candidate for candidate in ladder.fitted.active if candidate.key in off)
    return ladder.joint.apparent(ladder.fitted.law, active)[0] / _mix_modulus(diagnosis)


def _mix_modulus(diagnosis: Diagnosis) -> Complex:
    """E* (n,) [Pa] of the mix alone, by the last fit."""
    return diagnosis.ladder.joint.apparent(diagnosis.ladder.fitted.law, ())[0]


@dataclass(frozen=True)
class Sample:
    """One numerical specimen, and the simulated tests on it.

    `number`, from 0, stands for the measured specimen of this number (more samples than specimens: for these in turn);
    `amplitude` in m; each of `tests` is temperature [degC], frequency [Hz] and the file of the bond law to write.
    """

    number: int
    amplitude: float
    tests: Sequence[tuple[float, float, str | Path]]


def extend(
    diagnosis_file: str | Path,
    law_file: str | Path,
    measured: str | Path,
    geometry: str | Path | Mapping[str, Any],
    sample: Sample,
    rig_output: str | Path,
) -> None:
    """Write the bond law (a Kelvin chain) of each test of one sample, and its rig.

    The law goes into the bonds as it is: with facets, |E*| of a specimen is that of its law (docs/mapping.md).
    """
    named = causes_taken_off(diagnosis_file)
    observed, _ = read_observations(measured, geometry)
    law = read_spectrum(law_file)
    # More samples than specimens stand for these in turn.
    stands_for = sample.number % len(observed.names)
    frequencies = [frequency for _, frequency, _ in sample.tests]
    band = {"lowest_hz": min(frequencies) / MARGIN, "highest_hz": max(frequencies) * MARGIN}
    slowest, fastest = (2.0 * np.pi * frequency for frequency in band.values())
    for temperature, frequency, path in sample.tests:
        row = _row(observed, stands_for, temperature, frequency)
        bonds = _bond_modulus(law, observed, row, named)
        chain, error = kelvin_chain(bonds, slowest, fastest, TOLERANCE)
        write_chain(path, chain, source="diagnosis", temperature=temperature, error=error, **band)
    rig: dict[str, float] = {}
    gamma = float(observed.form_factor[observed.specimen == stands_for][0])
    for candidate in named:
        if candidate.place is None or candidate.place == observed.names[stands_for]:
            rig |= candidate.cause.rig(np.array(candidate.values), gamma, sample.amplitude)
    write_json(rig_output, {key: float(value) for key, value in rig.items()})


def _bond_modulus(
    law: Spectrum, observed: Observations, row: int, named: Sequence[Candidate]
) -> Callable[[Vector], Complex]:
    """E* [Pa] at omega (m,) [rad/s] of the mix in one test, with the causes that sit in mix or specimen."""
    here = [c for c in named if c.cause.rows(observed, c.place)[row]]
    rises = [c.cause.temperature_rise(np.array(c.values), observed) for c in here]
    temperature = observed.temperature[row] + sum(np.broadcast_to(rise, observed.size)[row] for rise in rises)
    inside = [c for c in here if c.cause.stage == MATERIAL or _scales(c)]

    def modulus(omega: Vector) -> Complex:
        # A subset keeps the table as its whole, to which largest amplitudes and last cycles refer.
        swept = replace(observed.subset(np.full(omega.size, row)), frequency=omega / (2.0 * np.pi))
        value = law.complex_modulus(omega, temperature)
        for candidate in sorted(inside, key=lambda c: c.cause.stage):
            value = candidate.cause.apparent(value, np.array(candidate.values), swept)
        return value

    return modulus


def causes_taken_off(diagnosis_file: str | Path) -> list[Candidate]:
    """Causes, with values and in ladder order, that the law of a diagnosis.json is free of; not bonds and law."""
    content = read_json(diagnosis_file)
    causes = {cause.name: cause for cause in CATALOGUE}
    out = []
    try:
        for rung in content["ladder"]:
            if rung["cause"] in ("relaxation_spectrum", BOND_MAPPING) or not rung["taken_off"]:
                continue
            cause = causes[rung["cause"]]
            values = tuple(float(rung["parameters"][p.name]["value"]) for p in cause.parameters)
            out.append(Candidate(cause, rung["where"], values))
    except (KeyError, TypeError) as error:
        raise InputError(
            f"{diagnosis_file}: not a diagnosis of this version ({error}); make it again."
        ) from None
    return out


def _scales(candidate: Candidate) -> bool:
    """Whether a cause of the specimen acts on its modulus, and not at its head."""
    rig = candidate.cause.rig(np.array(candidate.values), 1.0, 1.0)
    return candidate.cause.stage == SPECIMEN and not rig


def _row(observed: Observations, specimen: int, temperature: float, frequency: float) -> int:
    """The row of a test, of another specimen where this one has none."""
    near = (np.abs(observed.temperature - temperature) < 1e-6) & (
        np.abs(observed.frequency / frequency - 1.0) < 1e-9
    )
    own = np.flatnonzero(near & (observed.specimen == specimen))
    found = own if own.size else np.flatnonzero(near)
    if not found.size:
        raise InputError(
            f"the extended test at {temperature:g} degC, {frequency:g} Hz has no measurement; add one to the table."
        )
    return int(found[0])
