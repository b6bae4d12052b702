"""A diagnosis from files to files."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from hashlib import sha256
from itertools import chain
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from asphalt_nscd.diagnosis.next_tests import fixed_orders
from asphalt_nscd.diagnosis.next_tests.sweeps import Costs
from asphalt_nscd.diagnosis.observed import repeatability
from asphalt_nscd.diagnosis.observed.reading import PAPER_GEOMETRY, read_observations
from asphalt_nscd.diagnosis.record import measured_limits, report, reported
from asphalt_nscd.diagnosis.record.instructions import instructions
from asphalt_nscd.diagnosis.record.measured_limits import Progress
from asphalt_nscd.diagnosis.record.trust import reading, trust
from asphalt_nscd.diagnosis.screening import levels, suspects, within_isotherm
from asphalt_nscd.diagnosis.search.diagnose import Diagnosis, diagnose
from asphalt_nscd.diagnosis.simulation import bond_mapping, gain
from asphalt_nscd.diagnosis.simulation.extension import (
    compared,
    law_misses,
    law_notes,
    material_law,
    misfit_of_form,
    prior_notes,
)
from asphalt_nscd.diagnosis.simulation.numerics import of_campaign
from asphalt_nscd.diagnosis.simulation.simulated import NumericalSpecimen, read_specimen
from asphalt_nscd.diagnosis.words.summary import answer
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.store import provenance, write_json, write_table
from asphalt_nscd.measurements.campaign import Campaign
from asphalt_nscd.rheology.spectrum import LAWS
from asphalt_nscd.rheology.spectrum_io import Uncertainty, fit_content

OF_THE_PAPER = (
    "no --geometry: the specimen of Quezada and Chazallon (2020) is taken, 250 mm high, with 235 g that move; sizes of "
    "causes in the bench (mass, friction, compliance) depend on it"
)
STEPS = 5  # read, causes, law, second opinion, next tests
FEW_DRAWS = 1000  # where a second opinion is asked for
MATTERING = 0.02  # share of the tests that doubtful ones must have for one


@dataclass
class Steps:
    """Says how far a diagnosis has come.

    Parameters
    ----------
    progress : callable
        progress(stage, done, total).
    done : int
        Steps.
    """

    progress: Progress
    done: int = 0

    def step(self) -> None:
        """One more step is done."""
        self.done += 1
        self.progress("Diagnose", self.done, STEPS)


@dataclass(frozen=True)
class Outcome:
    """What a diagnosis gives: the content of its files.

    Parameters
    ----------
    content : dict
        Of diagnosis.json.
    residuals : DataFrame
        Of residuals.csv.
    causality : DataFrame
        Of causality.csv.
    law : dict or None
        Content of law.json; None for one isotherm.
    diagnosis : Diagnosis, optional
        That gave them; None if they were read from files.
    limits : DataFrame, optional
        Of limits.csv, where limits were verified.
    to_report : mapping of str to DataFrame
        Of further tables, by the stem of their file.
    """

    content: dict[str, Any]
    residuals: pd.DataFrame
    causality: pd.DataFrame
    law: dict[str, Any] | None
    diagnosis: Diagnosis | None = None
    limits: pd.DataFrame | None = None
    to_report: Mapping[str, pd.DataFrame] = field(default_factory=dict)

    def with_limits(self, table: pd.DataFrame) -> Outcome:
        """The same with limits that were verified.

        Parameters
        ----------
        table : DataFrame
            Of `measured_limits.verify`.

        Returns
        -------
        Outcome
            Another one.
        """
        content = self.content | {"measured_limits": measured_limits.summarised(table)}
        return replace(self, content=content, limits=table)

    def write(self, folder: str | Path) -> list[str]:
        """Write the files into a folder.

        Parameters
        ----------
        folder : path
            Made where it does not exist.

        Returns
        -------
        list of str
            Their names.
        """
        folder = Path(folder)
        write_table(folder / "residuals.csv", self.residuals)
        write_table(folder / "causality.csv", self.causality)
        if self.law is not None:
            write_json(folder / "law.json", self.law)
        if self.limits is not None:
            write_table(folder / "limits.csv", self.limits)
        for name, table in self.to_report.items():
            write_table(folder / f"{name}.csv", table)
        write_json(folder / "diagnosis.json", self.content)
        return [
            "diagnosis.json",
            "residuals.csv",
            "causality.csv",
            *([] if self.law is None else ["law.json"]),
            *([] if self.limits is None else ["limits.csv"]),
            *(f"{name}.csv" for name in self.to_report),
        ]

    def written(self, folder: str | Path) -> str:
        """Write the files.

        Parameters
        ----------
        folder : path
            Made where it does not exist.

        Returns
        -------
        str
            The answer, and what was written.
        """
        names = self.write(folder)
        return f"{answer(self.content)}\n\nWritten to {folder}: {', '.join(names)}."


@dataclass(frozen=True)
class Draws:
    """Of the chance level: how many, and the seed of their random numbers.

    Parameters
    ----------
    number : int
        Tables drawn without any cause.
    seed : int
        The same seed gives the same diagnosis.

    Examples
    --------
    >>> Draws(500)
    Draws(number=500, seed=0)
    """

    number: int = 4000
    seed: int = 0


@dataclass(frozen=True)
class Simulated:
    """What was simulated of the tests that are diagnosed.

    Parameters
    ----------
    campaign : path, optional
        Table of simulated tests, to say what in them is numerics.
    facets : path, optional
        Table of the same tests with bonds that are facets, to judge bond_mapping.
    specimen : path, optional
        Numerical specimen, a file of `asphalt-nscd reduced-specimen`; else the one shipped.

    Examples
    --------
    >>> Simulated(campaign="results/smoke/simulations.csv").specimen is None
    True
    """

    campaign: str | Path | None = None
    facets: str | Path | None = None
    specimen: str | Path | None = None


@dataclass(frozen=True)
class Stated:
    """What the user says beside the table.

    Parameters
    ----------
    static_modulus : float, optional
        Of the mix [Pa].
    scatter : tuple of float, optional
        Of |E*| (relative) and of the phase [rad].
    law : str
        One of `LAWS`, the form that is fitted.

    Raises
    ------
    InputError
        For a law that is not known.

    Examples
    --------
    >>> Stated().law
    '2s2p1d'
    """

    static_modulus: float | None = None
    scatter: tuple[float, float] | None = None
    law: str = "2s2p1d"

    def __post_init__(self) -> None:
        if self.law not in LAWS:
            raise InputError(f"law {self.law!r} is not known; give one of {', '.join(LAWS)}.")


def conclude(
    measurements: str | Path | Campaign,
    geometry: str | Path | Mapping[str, Any],
    *,
    stated: Stated = Stated(),
    simulated: Simulated = Simulated(),
    draws: Draws = Draws(),  # noqa: B008  frozen
    progress: Progress = lambda *_: None,
) -> Outcome:
    """Diagnose measurements.

    Parameters
    ----------
    measurements : path or Campaign
        Table or campaign.
    geometry : path or mapping
        Of the specimens.
    stated : Stated
        What the user says beside the table.
    simulated : Simulated
        What was simulated of the same tests.
    draws : Draws
        Of the chance level.
    progress : callable
        progress(stage, done, total).

    Returns
    -------
    Outcome
        Content of the files.

    Raises
    ------
    InputError
        For a table that cannot be diagnosed.
    """
    scatter = stated.scatter
    done = Steps(progress)
    numerical = read_specimen(simulated.specimen)
    campaign = measurements if isinstance(measurements, Campaign) else None
    given = measurements.table.path if isinstance(measurements, Campaign) else Path(measurements)
    files = (given,) if campaign is None else campaign.files
    observed, origin = read_observations(measurements, geometry, stated.static_modulus)
    done.step()
    try:
        diagnosis = diagnose(observed, scatter, draws=draws.number, seed=draws.seed)
    except InputError as error:
        raise InputError(f"{given}: {error}") from None
    done.step()
    moduli, phases, own = levels.odd(observed), levels.odd_phases(observed), diagnosis.ladder.of_one_place
    phases, temperatures = levels.with_confined(
        phases, levels.odd_temperatures(observed, moduli, phases), own
    )
    odd = moduli, phases
    doubtful = levels.rows(diagnosis.observed, chain(*odd, temperatures))
    if np.unique(diagnosis.observed.isotherm[~doubtful]).size < diagnosis.observed.isotherms.size:
        doubtful[:] = False  # the rest makes no law
    # law.json is of all temperatures: one isotherm has no shift.
    fit = None if observed.isotherms.size < 2 else material_law(diagnosis, ~doubtful, stated.law)
    content, before = report.as_json(diagnosis, numerical), None
    if fit is not None:
        content["law_misses"] = law_misses(diagnosis, fit.law, ~doubtful)
        content["laws"] = compared(diagnosis, fit, ~doubtful)
        content["notes"] += law_notes(diagnosis, fit.law, levels.places(*odd)) + prior_notes(fit)
    done.step()
    notes, without_tests = ([], ()) if campaign is None else ([*campaign.notes], campaign.without_tests)
    if observed.test_type == "bending" and geometry == PAPER_GEOMETRY:
        notes.append(OF_THE_PAPER)
    content["reading"] = reading(observed, notes, without_tests)
    if simulated.campaign is not None:
        content["numerics"]["campaign"] = of_campaign(
            simulated.campaign, observed.temperature, observed.frequency
        )
        before = _begin_with_campaigns(content, diagnosis, numerical, simulated.campaign, simulated.facets)
    content["origin"] = origin
    loo = within_isotherm.leave_one_out(observed)
    one_sided = "" if diagnosis.ladder.rungs else suspects.one_sided(observed, loo)
    content["one_sided"] = one_sided
    content["repeatability"] = repeatability.coefficients(diagnosis.observed)
    content["odd_levels"], content["odd_phases"] = odd
    content["odd_temperatures"] = temperatures
    content["with_suspects"] = with_suspects(diagnosis, scatter, draws.seed)
    content["without_doubtful"] = without_doubtful(diagnosis, scatter, draws.seed)
    done.step()
    ahead = fixed_orders.off_target(observed, Costs(), content["reading"].get("off_target", []))
    ahead += fixed_orders.metal(observed, Costs(), one_sided) if one_sided else []
    content["instructions"] = instructions(diagnosis, ahead=ahead)
    done.step()
    broken = suspects.broken_isotherms(observed, loo, diagnosis.ladder.torn)
    content["contradictory_isotherms"] = [
        {
            "temperature_C": one.temperature,
            "sentence": one.sentence,
            "worst_Hz": float(one.frequency[worst]),
            "worst_deg": float(one.difference[worst]),
        }
        for one in broken
        for worst in [int(np.argmax(np.abs(one.difference)))]
    ]
    to_check = [one.temperature for one in broken]
    turned = [one for one in own if "offset_deg" in one and one["temperature_C"] not in to_check]
    content["contradictory_isotherms"] += turned
    to_check += [one["temperature_C"] for one in turned]
    content["trust"] = trust(observed, diagnosis, levels.rows(observed, chain(*odd, temperatures)), to_check)
    standard = reported.standard_values(diagnosis)
    content["reported"] = standard.iloc[0].to_dict()
    content["provenance"] = {
        **provenance(),
        "measurements": given.name,
        **(_checksums(files) if files else {}),
        "draws": draws.number,
        "seed": draws.seed,
        "geometry": dict(geometry) if isinstance(geometry, Mapping) else Path(geometry).name,
        "specimen": None if simulated.specimen is None else Path(simulated.specimen).name,
        "static_modulus_Pa": stated.static_modulus,
        "scatter_stated": None if scatter is None else list(scatter),
    }
    law, curve = None, reported.master_curve(diagnosis)
    if fit is not None:
        known = None
        if fit.covariance is not None:
            form = misfit_of_form(diagnosis, fit.law, ~doubtful)
            known = Uncertainty(fit.covariance, reported.freedom_of(diagnosis), form)
        law = fit_content(fit, f"fitted ({origin})", known)
        content["law_parameters"] = law_parameters(law)
        curve = reported.with_law(curve, fit.law, known)
    return Outcome(
        content,
        gain.residual_table(diagnosis, numerical, before),
        suspects.table(observed, list(diagnosis.suspects), loo),
        law,
        diagnosis,
        to_report={
            "corrected": reported.corrected(diagnosis),
            "reported": standard,
            "master_curve": curve,
        },
    )


def law_parameters(law: Mapping[str, Any]) -> dict[str, dict[str, Any]]:
    """Parameters in the content of a law file with their intervals; `tau_s` carries its unit.

    Parameters
    ----------
    law : mapping
        Content of law.json.

    Returns
    -------
    dict of str to dict
        value, interval_95 and determined of each.
    """
    intervals = law.get("interval_95", {})
    return {
        key: {
            "value": value,
            "interval_95": intervals.get(key),
            "determined": key not in law["unseen"],
        }
        for key, value in law.items()
        if isinstance(value, float) and key not in ("reference_temperature_C", "rms_log_residual")
    }


def _begin_with_campaigns(
    content: dict[str, Any],
    diagnosis: Diagnosis,
    specimen: NumericalSpecimen,
    simulations: str | Path,
    facets: str | Path | None,
) -> NDArray[np.complex128]:
    """Put what was simulated before the ladder: its first rung, and the errors before the law. ln E* (n,) of it."""
    observed = diagnosis.observed
    before = after = bond_mapping.simulated(simulations, observed)
    rung = None
    if facets is None:
        content["notes"].append(bond_mapping.void(simulations))
    else:
        after = bond_mapping.simulated(facets, observed)
        rung, sentence = bond_mapping.bond_mapping(
            simulations, facets, gain.averages(diagnosis, before, after)
        )
        if rung is None:
            content["notes"].append(sentence)
    for law in content["ladder"]:
        if law["cause"] == "relaxation_spectrum":
            law["gain"]["in_sample"]["averages_by_temperature"] = gain.averages(
                diagnosis, after, gain.with_common_law(diagnosis, specimen)
            )
    content["ladder"][:0] = [] if rung is None else [rung]
    return before


def with_suspects(
    diagnosis: Diagnosis, scatter: tuple[float, float] | None, seed: int
) -> dict[str, Any] | None:
    """What is named if the tests that were set aside are used.

    Parameters
    ----------
    diagnosis : Diagnosis
        What was found.
    scatter : tuple of float, optional
        As stated by the user.
    seed : int
        Of the draws.

    Returns
    -------
    dict or None
        None where none was set aside.
    """
    if diagnosis.whole is None or not diagnosis.set_aside.size:
        return None
    return _named(diagnose(diagnosis.whole, scatter, draws=FEW_DRAWS, seed=seed, use_suspects=True))


def without_doubtful(
    diagnosis: Diagnosis, scatter: tuple[float, float] | None, seed: int
) -> dict[str, Any] | None:
    """What is named if the doubtful tests are not used either.

    Parameters
    ----------
    diagnosis : Diagnosis
        What was found.
    scatter : tuple of float, optional
        As stated by the user.
    seed : int
        Of the draws.

    Returns
    -------
    dict or None
        None where nothing was named, or they are few or too many.
    """
    whole = diagnosis.whole
    rows = [one.row for one in diagnosis.suspects]
    kept = sum(one.used for one in diagnosis.suspects)
    # A second opinion is a whole diagnosis: asked only where a name and tests enough are at stake.
    if whole is None or not diagnosis.ladder.rungs or kept < MATTERING * whole.size or not kept:
        return None
    try:
        part = whole.subset(np.setdiff1d(np.arange(whole.size), rows))
        return _named(diagnose(part, scatter, draws=FEW_DRAWS, seed=seed, use_suspects=True))
    except InputError:
        return None


def _named(other: Diagnosis) -> dict[str, Any]:
    named = [
        {"cause": rung.candidate.cause.name, "where": rung.candidate.place} for rung in other.ladder.rungs
    ]
    law = [{"cause": "relaxation_spectrum", "where": None}] if other.relaxation_spectrum else []
    return {"verdict": other.verdict, "causes": [*law, *named]}


def _checksums(files: Sequence[Path]) -> dict[str, Any]:
    """The SHA-256 of one file, or name and SHA-256 of each of several."""
    sums = [(path.name, sha256(path.read_bytes()).hexdigest()) for path in files]
    if len(sums) == 1:
        return {"sha256": sums[0][1]}
    return {"files": [{"name": name, "sha256": digest} for name, digest in sums]}
