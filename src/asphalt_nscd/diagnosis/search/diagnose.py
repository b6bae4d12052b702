"""The chain of a diagnosis: scatter, baseline, law, ladder, verdict, what was gained."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.special import chdtrc, fdtrc

from asphalt_nscd.diagnosis.causes import EVERY
from asphalt_nscd.diagnosis.causes._cause import Cause
from asphalt_nscd.diagnosis.criteria import ALPHA_PER_STEP, CONFIDENCE, LEAST_ISOTHERMS, MIXES_TURN, NAMED
from asphalt_nscd.diagnosis.model import chance, fit_beside, laboratory, start
from asphalt_nscd.diagnosis.model.bases import FlexibleSpectrum
from asphalt_nscd.diagnosis.model.joint import Fitted, Joint
from asphalt_nscd.diagnosis.model.laboratory import Laboratory
from asphalt_nscd.diagnosis.model.probability import stated
from asphalt_nscd.diagnosis.observed import copies, scatter
from asphalt_nscd.diagnosis.observed.noise import Noise
from asphalt_nscd.diagnosis.observed.observations import Observations
from asphalt_nscd.diagnosis.screening import excess_phase, suspects, within_isotherm
from asphalt_nscd.diagnosis.screening.suspects import Suspect
from asphalt_nscd.diagnosis.screening.within_isotherm import LooPrediction
from asphalt_nscd.diagnosis.search.doubts import Key
from asphalt_nscd.diagnosis.search.hypotheses import Hypothesis, hypotheses
from asphalt_nscd.diagnosis.search.ladder import Ladder, Rung, climb, lawless
from asphalt_nscd.diagnosis.settings import Draws
from asphalt_nscd.diagnosis.written import shown
from asphalt_nscd.measurements.reduction import require_enough

CLOSE = 0.01  # change of the objective at which a fit that is only judged ends
FIRST_SCATTER = (0.02, np.radians(0.5))  # of |E*| and phase, where nothing was repeated


@dataclass
class Diagnosis:
    """All that the report tells. verdict: explained, unexplained_structure or nothing_to_explain."""

    observed: Observations
    set_aside: Observations  # outliers among replicates, not used
    noise: Noise  # of single tests, and what the laboratory adds to it
    alone: Noise  # of single tests
    replicated: bool  # whether a lack of fit can be tested: by replicates or a stated scatter
    baseline: Fitted
    baseline_joint: Joint
    baseline_p: float  # of a misfit as large as the baseline's, by the replicate scatter
    law_p: float  # the same for the law taken, with all causes
    relaxation_spectrum: bool
    ladder: Ladder
    left_out: LooPrediction  # each value, with those set aside, held against the rest of its isotherm
    verdict: str = ""
    notes: list[str] = field(default_factory=list)
    whole: Observations | None = None  # with the tests that are set aside
    suspects: tuple[Suspect, ...] = ()  # rows of whole
    too_few: str = ""  # why these data tell no cause from what the catalogue lacks; empty if they may
    laboratory: Laboratory | None = None  # None where one isotherm was tested
    common: tuple[Joint, Fitted] | None = None  # the law of all temperatures, if the ladder has none

    def law_of_all(self) -> tuple[FlexibleSpectrum, Fitted]:
        """One law for all temperatures and its fit: that of the ladder, or what was fitted in its place."""
        joint, fitted = self.common or (self.ladder.joint, self.ladder.fitted)
        return joint.spectrum, fitted

    @property
    def doubts(self) -> dict[Key, list[str]]:
        """Of names, see `diagnosis.search.doubts`."""
        return self.ladder.doubts

    def established(self, rung: Rung) -> bool:
        """Whether the whole table carries a name and it has no rival, named or not; never of too few tests."""
        key = rung.candidate.key
        disputed = rung.rivals or key in self.doubts or self.ladder.hangs_on[key]
        if self.too_few or disputed or rung.probability < NAMED:
            return False
        return not self._is_as_of_mixes(rung)

    def probability(self, rung: Rung) -> float:
        """Probability of a name as stated, calibrated on drawn tables: all that speaks for or against it counts."""
        return stated(rung.probability, self.established(rung), rung.candidate.key in self.doubts)

    @cached_property
    def hypotheses(self) -> list[Hypothesis]:
        """Explanations that the table leaves open, the likeliest first; what is established holds in each."""
        if self.common is not None:
            return [Hypothesis(1.0, *self.common)]
        probabilities = {
            rung.candidate.key: 1.0 if self.established(rung) else self.probability(rung)
            for rung in self.ladder.rungs
        }
        return hypotheses(self.ladder, probabilities)

    def share(self, rung: Rung) -> float:
        """Probability of the explanations that hold a name: by so much of it is what is told of the mix free."""
        key = rung.candidate.key
        return sum(one.probability for one in self.hypotheses if key in {cause.key for cause in one.causes})

    def _is_as_of_mixes(self, rung: Rung) -> bool:
        """Whether a fault turns phases by no more than mixes that are not linear do."""
        candidate = next(one for one in self.ladder.fitted.active if one.key == rung.candidate.key)
        if not (candidate.cause.family and candidate.cause.alters_tests):
            return False
        joint, law = self.ladder.joint, self.ladder.fitted.law
        turned = np.angle(joint.apparent(law, (candidate,))[0] / joint.apparent(law, ())[0])
        size, error = abs(candidate.values[0]), float(self.ladder.std_errors(candidate)[0])
        least = max(1.0 - CONFIDENCE * error / max(size, 1e-300), 0.0)
        return bool(least * np.quantile(np.abs(turned), 0.9) < MIXES_TURN)


def diagnose(
    observed: Observations,
    scatter_stated: tuple[float, float] | None = None,
    catalogue: tuple[Cause, ...] = EVERY,
    draws: int = Draws.number,
    seed: int = 0,
    use_suspects: bool = False,
) -> Diagnosis:
    """Diagnose a table: ladder of causes, law, limits and notes.

    `scatter_stated` of |E*| (relative) and of the phase [rad], where replicates do not tell; `draws` of what chance
    alone would give; `use_suspects`: tests that contradict their own isotherm are used all the same.
    """
    require_enough(observed.size, observed.frequencies.size)
    copies.refuse_copies(observed)
    notes: list[str] = []
    whole = observed
    left_out = within_isotherm.leave_one_out(whole)
    doubtful = suspects.find(whole, left_out)
    if use_suspects:
        doubtful = [replace(one, used=True) for one in doubtful]
    aside = np.array([one.row for one in doubtful if not one.used], np.int64)
    observed = whole.subset(np.setdiff1d(np.arange(whole.size), aside))
    noise, replicated = _noise(observed, scatter_stated, catalogue, notes)
    if scatter_stated is None and min(noise.sigma) <= 1.01 * scatter.FLOOR:
        notes.append(
            "Repeated tests agree better than tests can be repeated; taken as a scatter of "
            f"{100.0 * scatter.FLOOR:g} % and {np.degrees(scatter.FLOOR):.2g} deg. Check that they are separate tests."
        )
    alone = noise
    # No law of the mix is needed to see that its phases are too large; else a softening would be a misfit of the law.
    above = excess_phase.shows_excess(observed, alone)
    catalogue = tuple(cause for cause in catalogue if cause.alters_tests or above)
    joint, fitted = start.fit_spectrum(observed, noise)
    begun = fit_beside.begin(laboratory.alone(joint), fitted)
    noise = begun.everyday.noise
    # A law that cannot follow the tests leaves them to temperatures and mountings if it may.
    baseline_joint, baseline = start.fit_burgers_at_each(observed, alone)
    baseline_p = misfit_p_value(baseline, alone)
    joint, fitted = start.fit_roughness(begun.everyday, begun.fitted)
    spectrum_p = misfit_p_value(fitted, noise)
    # Neither law holds the other as a special case, so Schwarz's criterion decides and no F test.
    spectrum_better = _information(fitted) < _information(baseline)
    no_common_law = baseline_p > ALPHA_PER_STEP and not spectrum_better and spectrum_p < ALPHA_PER_STEP
    if observed.frequencies.size < 3:
        notes.append("Two frequencies: Burgers laws fit them exactly, so their misfit cannot be judged.")
    if no_common_law:
        notes.append(
            "The Burgers laws fit and no law common to all temperatures does: no cause is sought. What is reported of "
            "the mix follows a common law all the same, and is less certain than it says."
        )
        ladder = lawless(baseline_joint, baseline, draws, seed)
    else:
        ladder = climb(begun, catalogue, draws, seed)
        noise = (ladder.end or begun).everyday.noise
    law_p = misfit_p_value(_nearest_fit(ladder, noise), noise)
    diagnosis = Diagnosis(
        observed,
        whole.subset(aside),
        noise,
        alone,
        replicated,
        baseline,
        baseline_joint,
        baseline_p,
        law_p,
        not no_common_law and baseline_p <= ALPHA_PER_STEP and spectrum_better,
        ladder,
        left_out,
        notes=notes,
    )
    diagnosis.whole, diagnosis.suspects = whole, tuple(doubtful)
    if observed.isotherms.size > 1:
        last = ladder.end or begun
        diagnosis.laboratory = laboratory.inferred(last.model.processes, last.variances)
    diagnosis.common = (joint, fitted) if no_common_law else None
    diagnosis.verdict = _verdict(diagnosis)
    diagnosis.too_few = too_few = _too_few(diagnosis)
    if ladder.rungs and too_few:
        diagnosis.verdict = "unexplained_structure"
        named = dict.fromkeys(rung.candidate.cause.name for rung in ladder.rungs)
        names = ", ".join(named).replace("_", " ")
        notes.append(
            f"{names}: the likeliest of the causes that this program knows; not established, for {too_few}. An effect "
            "that it does not know may look the same."
        )
    if no_common_law and not ladder.rungs:
        diagnosis.verdict = "unexplained_structure"
    notes += _bound_notes(ladder)
    return diagnosis


def _too_few(diagnosis: Diagnosis) -> str:
    """Why these data tell no cause from what the catalogue lacks; empty if they may."""
    observed = diagnosis.observed
    if not diagnosis.replicated:
        return "nothing was repeated on another specimen"
    if observed.frequencies.size < 3:
        return "two frequencies show no curvature"
    if observed.isotherms.size < LEAST_ISOTHERMS:
        return f"fewer than {LEAST_ISOTHERMS} temperatures were tested"
    return ""


def _nearest_fit(ladder: Ladder, noise: Noise) -> Fitted:
    """The last fit as near to the tests as it comes, its residuals in units of the scatter alone."""
    plain = Joint(ladder.joint.observed, ladder.joint.base, noise)
    return plain.fit(ladder.fitted.law, ladder.fitted.scales, ladder.fitted.active, CLOSE)


def _bound_notes(ladder: Ladder) -> list[str]:
    """A sentence for each parameter of a named cause that stands at its physical bound."""
    if not ladder.rungs:
        return []
    return [
        f"{candidate.cause.name.replace('_', ' ')}: {parameter.name.replace('_', ' ')} stands at its bound of "
        f"{_unit_value(value, parameter.unit)}, so that its standard error means nothing; the true one may lie beyond, "
        "or the cause be another."
        for candidate in ladder.rungs[-1].after.active
        for parameter, value in candidate.pinned
    ]


def _unit_value(value: float, unit: str) -> str:
    size, name = shown(value, unit)
    return f"{size:g} {name}".rstrip()


def misfit_p_value(fitted: Fitted, noise: Noise) -> float:
    """Chance of so large a misfit if the law holds (F test; chi-squared of a stated scatter); 1 if nothing is left."""
    size = fitted.residual.size
    # Priors hold many parameters: what the tests determine is the trace of the hat matrix.
    used = float(np.trace(np.linalg.solve(fitted.precision, fitted.jacobian.T @ fitted.jacobian)))
    if noise.freedom >= scatter.STATED:
        return float(chdtrc(size - used, fitted.residual @ fitted.residual))
    # Replicates alone leave `freedom` of these squares (pure error); the rest is lack of fit.
    left = float(fitted.residual @ fitted.residual) - noise.freedom
    freedom = size - used - noise.freedom
    if freedom < 1.0:
        return 1.0
    return float(fdtrc(freedom, noise.freedom, max(left, 0.0) / freedom))


def _information(fitted: Fitted) -> float:
    """Misfit plus ln(n) for each parameter that the data determine (Schwarz)."""
    used = np.trace(np.linalg.solve(fitted.precision, fitted.jacobian.T @ fitted.jacobian))
    return float(fitted.residual @ fitted.residual + used * np.log(fitted.residual.size))


def _noise(
    observed: Observations,
    scatter_stated: tuple[float, float] | None,
    catalogue: tuple[Cause, ...],
    notes: list[str],
) -> tuple[Noise, bool]:
    if scatter_stated is not None:
        notes.append("The scatter is the one stated, not estimated from replicates.")
        modulus, phase = scatter_stated
        return scatter.stated(observed, modulus, phase, scatter.SPECIMEN_SCALE), True
    logarithm = observed.logarithm.real - scatter.median_by(observed.logarithm.real, observed.cell)
    scales = np.array([np.median(logarithm[observed.specimen == k]) for k in np.unique(observed.specimen)])
    membership = np.eye(len(observed.names), dtype=complex)[observed.specimen]
    noise = scatter.estimate(observed, membership, scales)
    if noise is not None:
        # What one specimen may do as a whole, or the course of the tests, is no scatter: take causes and patterns out.
        joint, fitted = start.fit_spectrum(observed, noise)
        every = chance.catalogue_candidates(observed, catalogue)
        candidates = [one for one in every if isinstance(one.place, str) and not one.cause.told]
        directions = chance.candidate_directions(joint, fitted, candidates)
        patterns = [p.direction[:, None] for p in chance.structures_of_replicates(observed)]
        refined = scatter.estimate(observed, np.hstack([membership, directions, *patterns]), scales)
        # Few replicates against many patterns leave no freedom: the first estimate then stands.
        return refined or noise, True
    notes.append(
        "No condition was repeated on another specimen. What a smooth law misses is therefore taken for scatter, and "
        "whether a law fits cannot be tested. Measure a second specimen or state the scatter."
    )
    sizes = FIRST_SCATTER
    # How smooth the law is depends on the scatter, and the scatter on what a smooth law leaves.
    for _ in range(3):
        noise = scatter.stated(observed, *sizes, scatter.SPECIMEN_SCALE)
        _, fitted = start.fit_spectrum(observed, noise)
        sizes, freedom = _residual_scatter(fitted, sizes)
    noise = scatter.stated(observed, *sizes, scatter.SPECIMEN_SCALE, freedom)
    return noise, False


def _residual_scatter(fitted: Fitted, sizes: tuple[float, float]) -> tuple[tuple[float, float], int]:
    hat = np.einsum("ij,ji->i", fitted.jacobian, np.linalg.solve(fitted.precision, fitted.jacobian.T))
    n = fitted.residual.size // 2
    new, freedom = [], 0.0
    for size, part in zip(sizes, (slice(0, n), slice(n, None)), strict=True):
        left = n - float(hat[part].sum())
        freedom += left
        rms = np.sqrt(float(fitted.residual[part] @ fitted.residual[part]) / max(left, 1.0))
        # A table made by a formula leaves nothing, by which residuals cannot be divided.
        new.append(max(size * rms, 1e-4))
    return (new[0], new[1]), max(int(freedom), 1)


def _verdict(diagnosis: Diagnosis) -> str:
    remaining = diagnosis.ladder.remaining
    # Two tests, so that an empty table fails either no more often than ALPHA_PER_STEP.
    unexplained = remaining is not None and remaining.p_value <= 0.5 * ALPHA_PER_STEP
    if diagnosis.replicated:
        unexplained = unexplained or diagnosis.law_p <= 0.5 * ALPHA_PER_STEP
    if unexplained or diagnosis.doubts:
        return "unexplained_structure"
    if diagnosis.ladder.rungs or diagnosis.relaxation_spectrum:
        return "explained"
    return "nothing_to_explain"


def cell_residuals(diagnosis: Diagnosis) -> tuple[NDArray, NDArray]:
    """Mean residuals ln E* by condition (c,), measured less modelled, and the larger part in standard deviations."""
    observed, fitted = diagnosis.observed, diagnosis.ladder.fitted
    left = observed.logarithm - fitted.modelled
    count = np.bincount(observed.cell)
    mean = np.bincount(observed.cell, left.real) / count + 1j * np.bincount(observed.cell, left.imag) / count
    sigma = diagnosis.noise.sigma
    z = np.maximum(np.abs(mean.real) / sigma[0], np.abs(mean.imag) / sigma[1]) * np.sqrt(count)
    return mean, z
