"""A diagnosis from files to files."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from hashlib import sha256
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from asphalt_nscd.diagnosis.causes._cause import Place
from asphalt_nscd.diagnosis.next_tests import fixed_orders
from asphalt_nscd.diagnosis.next_tests.sweeps import Costs
from asphalt_nscd.diagnosis.observed import repeatability
from asphalt_nscd.diagnosis.observed.observations import Observations
from asphalt_nscd.diagnosis.observed.reading import PAPER_GEOMETRY, read_observations
from asphalt_nscd.diagnosis.record import measured_limits, report, reported
from asphalt_nscd.diagnosis.record.instructions import MOST, instructions
from asphalt_nscd.diagnosis.record.law import law_of_mix, law_parameters, left_to_priors
from asphalt_nscd.diagnosis.record.measured_limits import Progress
from asphalt_nscd.diagnosis.record.mixture import Mixture, mixture
from asphalt_nscd.diagnosis.record.reading import reading
from asphalt_nscd.diagnosis.record.statuses import counts, kept, odd_places, statuses, told
from asphalt_nscd.diagnosis.record.volumetrics import explained, read_volumetrics
from asphalt_nscd.diagnosis.screening import suspects
from asphalt_nscd.diagnosis.search.diagnose import Diagnosis, diagnose
from asphalt_nscd.diagnosis.settings import Draws, Simulated
from asphalt_nscd.diagnosis.simulation import bond_mapping, gain
from asphalt_nscd.diagnosis.simulation.numerics import numerical_errors
from asphalt_nscd.diagnosis.simulation.simulated import NumericalSpecimen, read_specimen
from asphalt_nscd.diagnosis.words.answer import answer
from asphalt_nscd.diagnosis.written import name_at
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.store import provenance, write_json, write_table
from asphalt_nscd.measurements.campaign import Campaign
from asphalt_nscd.rheology.spectrum import LAWS

OF_THE_PAPER = (
    "no --geometry: the specimen of Quezada and Chazallon (2020) is taken, 250 mm high, with 235 g that move; sizes of "
    "causes in the bench (mass, friction, compliance) depend on it"
)
STEPS = 5  # read, causes, law, second opinion, next tests
FEW_DRAWS = 1000  # where a second opinion is asked for
MATTERING = 0.02  # share of the tests that doubtful ones must have for one


@dataclass(frozen=True)
class Outcome:
    """Content of the files of a diagnosis; `law` is None for one isotherm, `diagnosis` and `mix` if read from files."""

    content: dict[str, Any]
    residuals: pd.DataFrame
    causality: pd.DataFrame
    law: dict[str, Any] | None
    diagnosis: Diagnosis | None = None
    mix: Mixture | None = None
    limits: pd.DataFrame | None = None
    to_report: Mapping[str, pd.DataFrame] = field(default_factory=dict)

    def add_limits(self, table: pd.DataFrame) -> Outcome:
        """The same outcome with limits that were verified, a table of `measured_limits.verify`."""
        content = self.content | {"measured_limits": measured_limits.summarised(table)}
        return replace(self, content=content, limits=table)

    def write(self, folder: str | Path) -> list[str]:
        """Write the files into a folder, which is made where it does not exist; their names."""
        files: dict[str, Any] = {
            "diagnosis.json": self.content,
            "residuals.csv": self.residuals,
            "causality.csv": self.causality,
            "law.json": self.law,
            "limits.csv": self.limits,
            **{f"{name}.csv": table for name, table in self.to_report.items()},
        }
        names = [name for name, content in files.items() if content is not None]
        # diagnosis.json last: where it is, the others are too.
        for name in reversed(names):
            (write_json if name.endswith(".json") else write_table)(Path(folder) / name, files[name])
        return names

    def written(self, folder: str | Path) -> str:
        """Write the files into a folder, made where it does not exist; the answer, and what was written, in words."""
        names = self.write(folder)
        return f"{answer(self.content)}\n\nWritten to {folder}: {', '.join(names)}."


@dataclass(frozen=True)
class Stated:
    """What the user says beside the table.

    `static_modulus` of the mix in Pa; `scatter` of |E*| (relative) and of the phase [rad]; `law`: one of `LAWS`, the
    form that is fitted; `vma` and `vfa` in percent.

    >>> Stated().law
    '2s2p1d'
    """

    static_modulus: float | None = None
    scatter: tuple[float, float] | None = None
    law: str = "2s2p1d"
    vma: float | None = None
    vfa: float | None = None

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
    """Diagnose a table or campaign of measurements: the content of the files that a diagnosis writes."""
    scatter = stated.scatter
    numerical = read_specimen(simulated.specimen)
    campaign = measurements if isinstance(measurements, Campaign) else None
    given = measurements.table.path if isinstance(measurements, Campaign) else Path(measurements)
    files = (given,) if campaign is None else campaign.files
    observed, origin = read_observations(measurements, geometry, stated.static_modulus)
    if simulated.specimen is None and numerical.geometry.test != observed.test_type:
        # what a bent trapezoid's own motion adds is in no test of a cylinder
        numerical = numerical.law_alone()
    progress("Diagnose", 1, STEPS)
    try:
        diagnosis = diagnose(observed, scatter, draws=draws.number, seed=draws.seed)
    except InputError as error:
        raise InputError(f"{given}: {error}") from None
    progress("Diagnose", 2, STEPS)
    odd = odd_places(diagnosis, observed)
    record = statuses(diagnosis, observed, odd)
    mix = mixture(diagnosis, kept(record))
    volumes = read_volumetrics(None if campaign is None else campaign.table, stated.vma, stated.vfa)
    # law.json is of all temperatures: one isotherm has no shift.
    law = law_of_mix(mix, stated.law, volumes.of_mix) if observed.isotherms.size > 1 else None
    content, before = report.diagnosis_content(diagnosis, numerical), None
    content |= {"suspect_tests": told(record), "trust": counts(record, observed.isotherms.tolist())}
    content["averaged_over"] = [
        {"causes": [name_at(*cause.key) for cause in mix.possible(one)], "probability": one.probability}
        for one in mix.hypotheses
    ]
    content["scatter"]["air_voids"] = explained(diagnosis, volumes)
    written_law = None
    if law is not None:
        written_law = law.content(f"fitted ({origin})")
        content["law_parameters"] = law_parameters(written_law)
        content["law_misses"] = law.misses(diagnosis)
        content["laws"] = law.compared(diagnosis)
        highest = diagnosis.ladder.at_highest
        at = [] if highest is None else [f"the tests at {highest.frequency:g} Hz"]
        said, notes = left_to_priors(law.fit)
        content["notes"] += [
            *volumes.note,
            *law.notes(diagnosis, [*odd.words, *at] if content["trust"]["held_back"] else []),
            *notes,
        ]
        content["undetermined"] = said
    progress("Diagnose", 3, STEPS)
    notes, without_tests = ([], ()) if campaign is None else ([*campaign.notes], campaign.without_tests)
    if observed.test_type == "bending" and geometry == PAPER_GEOMETRY:
        notes.append(OF_THE_PAPER)
    content["reading"] = reading(observed, odd.off_target, notes, without_tests)
    if simulated.campaign is not None:
        content["numerics"]["campaign"] = numerical_errors(
            simulated.campaign, observed.temperature, observed.frequency
        )
        before = _begin_with_campaigns(content, diagnosis, numerical, simulated)
    loo = diagnosis.left_out
    one_sided = "" if diagnosis.ladder.rungs else suspects.one_sided(observed, loo)
    content |= {
        "origin": origin,
        "one_sided": one_sided,
        "repeatability": repeatability.coefficients(diagnosis.observed, mix.kept),
        "odd_levels": odd.moduli,
        "odd_phases": odd.phases,
        "odd_temperatures": odd.temperatures,
        "contradictory_isotherms": odd.contradictory,
    }
    content |= second_opinions(diagnosis, scatter, draws.seed)
    progress("Diagnose", 4, STEPS)
    ahead = fixed_orders.off_target(observed, Costs(), odd.off_target)
    ahead += fixed_orders.metal(observed, Costs(), one_sided) if one_sided else []
    content["instructions"] = instructions(diagnosis, ahead=ahead)
    orders = content["instructions"]["orders"]
    corrected = reported.corrected(diagnosis, observed, mix, record)
    open_excess = _less_established(content["excess_phase"], corrected)
    orders += fixed_orders.strains(observed, Costs(), open_excess)[: MOST - len(orders)]
    progress("Diagnose", 5, STEPS)
    standard = reported.standard_values(mix, law)
    content["reported"] = standard.drop(columns=["asked_by", "averaged_over"]).iloc[0].to_dict()
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
    return Outcome(
        content,
        gain.residual_table(diagnosis, numerical, before),
        suspects.table(observed, record, loo),
        written_law,
        diagnosis,
        mix,
        to_report={
            "corrected": corrected,
            "reported": standard,
            "master_curve": reported.master_curve(mix, law=law),
        },
    )


def _less_established(excesses: Sequence[dict[str, Any]], corrected: pd.DataFrame) -> list[dict[str, Any]]:
    """Entries of `excess_phase` less what the correction of the tests takes off: that has its reason."""
    taken_off = corrected["recorded_phase_deg"] - corrected["phase_deg"]
    mean = taken_off.groupby(corrected["nominal_temperature_C"]).mean().round(6)
    return [
        one | {"excess_deg": one["excess_deg"] - less, "taken_off_deg": less}
        for one in excesses
        for less in (mean[one["temperature_C"]],)
    ]


def _begin_with_campaigns(
    content: dict[str, Any], diagnosis: Diagnosis, specimen: NumericalSpecimen, simulated: Simulated
) -> NDArray[np.complex128]:
    """Put what was simulated before the ladder: its first rung, and the errors before the law. ln E* (n,) of it."""
    observed, simulations, facets = diagnosis.observed, simulated.campaign, simulated.facets
    assert simulations is not None
    before = after = bond_mapping.simulated(simulations, observed)
    rung = None
    if facets is None:
        content["notes"].append(bond_mapping.void(simulations))
    else:
        after = bond_mapping.simulated(facets, observed)
        errors = gain.averages(diagnosis, before, after)
        rung, sentence = bond_mapping.bond_mapping(simulations, facets, errors)
        if rung is None:
            content["notes"].append(sentence)
    for law in content["ladder"]:
        if law["cause"] == "relaxation_spectrum":
            common = gain.nearest(diagnosis, diagnosis.ladder.start, specimen)
            errors = gain.averages(diagnosis, after, common)
            law["gain"]["in_sample"]["averages_by_temperature"] = errors
    content["ladder"][:0] = [] if rung is None else [rung]
    return before


def second_opinions(
    diagnosis: Diagnosis, scatter: tuple[float, float] | None, seed: int
) -> dict[str, dict[str, Any] | None]:
    """Verdict and causes "with_suspects" (tests set aside) and "without_doubtful" ones; None where nobody asks.

    The second is asked only where something was named and the doubtful tests are not few. Too many of them leave no
    table that can be diagnosed: None then, too.
    """

    def named(tests: Observations) -> dict[str, Any]:
        other = diagnose(tests, scatter, draws=FEW_DRAWS, seed=seed, use_suspects=True)
        keys: list[tuple[str, Place]] = [("relaxation_spectrum", None)] * other.relaxation_spectrum
        keys += [rung.candidate.key for rung in other.ladder.rungs]
        return {"verdict": other.verdict, "causes": [{"cause": name, "where": place} for name, place in keys]}

    found: dict[str, dict[str, Any] | None] = {"with_suspects": None, "without_doubtful": None}
    whole = diagnosis.whole
    if whole is not None and diagnosis.set_aside.size:
        found["with_suspects"] = named(whole)
    kept = sum(one.used for one in diagnosis.suspects)
    # A second opinion is a whole diagnosis: asked only where a name and tests enough are at stake.
    if whole is not None and diagnosis.ladder.rungs and kept >= max(MATTERING * whole.size, 1):
        rest = np.setdiff1d(np.arange(whole.size), [one.row for one in diagnosis.suspects])
        with suppress(InputError):
            found["without_doubtful"] = named(whole.subset(rest))
    return found


def _checksums(files: Sequence[Path]) -> dict[str, Any]:
    """The SHA-256 of one file, or name and SHA-256 of each of several."""
    sums = [(path.name, sha256(path.read_bytes()).hexdigest()) for path in files]
    if len(sums) == 1:
        return {"sha256": sums[0][1]}
    return {"files": [{"name": name, "sha256": digest} for name, digest in sums]}
