"""Time stepping of the reduced model under a certificate.

Every step is checked before it is accepted: the residual of the full equations, the yield of
every bond and the gap of every pair. On a violation the model changes: an overstressed bond is
removed, and the basis is enriched by the exact correction of that step, until the step passes.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, TypeVar

import numpy as np

from asphalt_nscd.nscd.bonds.head import RIGID, HeadDevices
from asphalt_nscd.nscd.bonds.law import AnyLaw
from asphalt_nscd.nscd.stepping.bond_bounds import BeyondExcerpt
from asphalt_nscd.nscd.stepping.excerpt import Excerpt
from asphalt_nscd.nscd.stepping.reduced_run import CLOSED_GAP, DONE, OUTSIDE_ENVELOPE, YIELD, ReducedRun
from asphalt_nscd.nscd.stepping.reduced_steps import advance_reduced

if TYPE_CHECKING:  # sparse matrices, which take as long to import as a test without breaks to run
    from scipy.sparse.linalg import SuperLU

    from asphalt_nscd.nscd.bonds.implicit_operator import ShiftedOperator
    from asphalt_nscd.nscd.stepping.break_modes import StandBy
    from asphalt_nscd.nscd.stepping.condensed import CondensedState, CondensedStepper
    from asphalt_nscd.nscd.stepping.reduced_model import ReducedModel

Answer = TypeVar("Answer")

# Vectors added at a violation: the correction of the refused step, and those its inertia will need. Doubled at every
# further violation, since each costs a projection of the whole system
FIRST_ENRICHMENT, LARGEST_ENRICHMENT = 4, 16

# After these the basis has some 500 vectors, and full steps are cheaper in time and memory
MOST_ENRICHMENTS = 30

FAR = 16.0  # growth of the envelope as long as no bond comes near yield within it


@dataclass
class ReducedState:
    """Coordinates of motion and history; `broken` lists bonds in the order in which they broke."""

    displacement: np.ndarray  # q (k,)
    velocity: np.ndarray  # (k,)
    sigma: np.ndarray  # s (k,)
    memory: np.ndarray  # (m, k), of the law
    broken: list[int] = field(default_factory=list)


@dataclass(frozen=True)
class Certificate:
    """What was verified at every accepted step, those of the full system included."""

    largest_residual: float  # of the full equations, relative to the load of the head
    largest_utilisation: float  # of any bond left unbroken: exact near yielding, else an upper bound
    smallest_gap: float  # m, a lower bound
    enrichments: int


class FullSystemNeeded(Exception):
    """The next step is one for the full system: a gap closes, or the model has outgrown its use after breaks.

    Of the steps accepted, `force` (n,) is that of the actuator [N], `velocity` (n, k) the coordinates.
    """

    def __init__(self, reason: str, force: np.ndarray, velocity: np.ndarray) -> None:
        super().__init__(reason)
        self.force, self.velocity = force, velocity


class ReducedStepper:
    """Steps a reduced model, or an excerpt, at constant dt [s] and law; `state` starts at rest.

    `tolerance` is relative, of the residual of the full equations; `most_enrichments` bounds those of the basis in a
    run; `stand_by` holds directions for breaks on the basis of `model`; an excerpt brings its own. TypeError for bonds
    of several laws.
    """

    def __init__(
        self,
        model: ReducedModel | Excerpt,
        law: AnyLaw,
        dt: float,
        tolerance: float,
        most_enrichments: int = MOST_ENRICHMENTS,
        devices: HeadDevices = RIGID,
        stand_by: StandBy | None = None,
    ) -> None:
        self.law = law.step(dt)
        if np.ndim(self.law.compliance):
            raise TypeError(
                "the reduced model has one law for all bonds; step bonds of several by CondensedStepper."
            )
        k = model.size
        self._part, self.dt, self.tolerance, self.devices = model, dt, tolerance, devices
        self._coefficients = self.law.coefficients(law.memory)
        self.state = ReducedState(np.zeros(k), np.zeros(k), np.zeros(k), np.zeros((law.memory, k)))
        self.enrichments, self.most_enrichments = 0, most_enrichments
        # running maxima: |s_0|, residual, utilisation of watched bonds
        self._maxima = np.zeros(3)
        self._smallest_gap = np.inf  # where the full system took over
        self._may_yield = np.empty(0, np.int64)
        self._reached_sigma, self._reached_motion = np.zeros(k), np.zeros(k)
        self._stand_by, self._ritz = stand_by, None if isinstance(model, Excerpt) else model.basis
        self._operator: ShiftedOperator | None = None
        self._shifted: SuperLU | None = None  # for directions that were not kept ready
        self._watch(np.zeros(k), np.zeros(k))

    @property
    def model(self) -> ReducedModel:
        """The whole model, read now where there was only an excerpt of it."""
        if isinstance(self._part, Excerpt):
            self._part, self._stand_by = self._part.whole()
            self._ritz = self._part.basis
            self._maxima[2] = self._borne()  # of bonds that the excerpt did not list
        return self._part

    def _ask_bonds(self, question: Callable[[ReducedModel | Excerpt], Answer]) -> Answer:
        """The answer of the excerpt if it has one, else that of the whole model."""
        try:
            return question(self._part)
        except BeyondExcerpt:
            return question(self.model)

    def run(self, driven: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Force of the actuator (n,) [N] that follows `driven` (n,) [m], one a step; FullSystemNeeded if it cannot.

        With velocity coordinates (n, k) of the basis as it is in the end; what it got on the way came behind the rest.
        """
        force, velocity = np.empty(driven.size), np.zeros((driven.size, self._part.size))
        done = 0
        while True:
            try:
                taken, code, bond = self._advance(driven[done:], force[done:], velocity[done:])
            except np.linalg.LinAlgError:
                # bodies of a regular lattice can turn without a strain of any bond: directions of rounding alone
                raise FullSystemNeeded("singular", force[:done], velocity[:done]) from None
            done += taken
            if code == DONE:
                return force, velocity
            if code == OUTSIDE_ENVELOPE:
                self._widen_envelope(np.abs(self._trial[1]), np.abs(self._trial[2]))
                continue
            # contacts between bodies are solved by the full system alone
            if code == CLOSED_GAP:
                raise FullSystemNeeded("a gap closes", force[:done], velocity[:done])
            if self.enrichments >= self.most_enrichments:
                raise FullSystemNeeded("too many enrichments", force[:done], velocity[:done])
            if code == YIELD:
                self.state.broken.append(bond)
            self._enrich(code)
            velocity = _widened(velocity, self._part.size - velocity.shape[1])

    def move(self, start: float, end: float) -> float:
        """Force of the actuator [N] in one step, in which it moves from `start` to `end` [m]."""
        return float(self.run(np.array([end]))[0][0])

    def full_state(self) -> CondensedState:
        """The state of the full system at this instant."""
        from asphalt_nscd.nscd.stepping.condensed import CondensedState

        state, basis, opening = self.state, self.model.basis, self.model.opening
        return CondensedState(
            displacement=basis @ state.displacement,
            velocity=basis @ state.velocity,
            sigma=opening @ state.sigma,
            memory=state.memory @ opening.T,
            broken=list(state.broken),
        )

    def certify(self, full: CondensedStepper) -> None:
        """Count the last step of the full system in the certificate; ArithmeticError where it misses its equations."""
        from asphalt_nscd.nscd.stepping.condensed import CLOSED

        model, system = self.model, self.model.system
        # what s_0 would be in a reduced step of this force
        stress = abs(full.missing[system.driven]) / model.stiffness[0, 0]
        self._maxima[0] = max(self._maxima[0], stress)
        # relative to the largest load so far: at zero crossings of the head the instant's own is nothing to
        # divide by
        size = model.head_norm * self._maxima[0] + model.load_norm
        residual = model.residual_norm(full.missing) / size if size > 0.0 else 0.0
        if not residual <= self.tolerance:
            raise ArithmeticError(f"a step of the full system misses its equations by {residual:.1e}")
        self._maxima[1:] = np.maximum(self._maxima[1:], [residual, full.utilisation])
        # the full system counts a gap as touching within CLOSED, so the bound gives that much away
        gap = system.gap + system.operator[::3] @ full.state.displacement
        self._smallest_gap = min(self._smallest_gap, float(gap.min()) - CLOSED)

    def certificate(self) -> Certificate:
        """Bounds over all accepted steps."""
        gap = self._ask_bonds(lambda part: part.bounds.smallest_gap(self._reached_motion))
        return Certificate(
            largest_residual=float(self._maxima[1]),
            largest_utilisation=self._ask_bonds(lambda part: self._borne(of_all=True)),
            smallest_gap=min(gap, self._smallest_gap),
            enrichments=self.enrichments,
        )

    def _advance(self, driven: np.ndarray, force: np.ndarray, velocity: np.ndarray) -> tuple[int, int, int]:
        """(steps taken, code of their end, bond that yields or -1) by the kernel; writes `force` and `velocity`."""
        model, state, law = self._part, self.state, self.law
        self._trial = np.zeros((3, model.size))
        inverse = self._step_inverse()
        run = ReducedRun(
            driven,
            self.devices.head_constants,
            *self._seen_from_head(inverse),
            _columns(model.mass),
            _columns(model.stiffness),
            model.load,
            _columns(inverse),
            law.dt,
            float(law.compliance),
            *self._coefficients,
            _columns(model.residual_factor),
            model.head_norm,
            model.load_norm,
            self.tolerance,
            self._reaction,
            self._beyond_head,
            self._closing,
            self._sigma_envelope,
            self._motion_envelope,
            self._reached_sigma,
            self._reached_motion,
            self._maxima,
            state.displacement,
            state.velocity,
            state.sigma,
            state.memory,
            self._trial,
            force,
            velocity,
            np.empty(5 * model.size + len(model.residual_factor) + 1),
        )
        taken, code, watched = advance_reduced(run)
        return taken, code, int(self._may_yield[watched]) if code == YIELD else -1

    def _step_inverse(self) -> np.ndarray:
        model = self._part
        # an inverse and no factors: the kernel allocates nothing and calls no linear algebra
        return np.linalg.inv((model.mass + self.dt / self.law.compliance * model.stiffness)[1:, 1:])

    def _seen_from_head(self, inverse: np.ndarray) -> tuple[float, np.ndarray, np.ndarray, float]:
        """(Z, a, b, c) of the coming step: the head takes the force Z v+ - a v - b explicit - c."""
        model, dt, compliance = self._part, self.dt, self.law.compliance
        step = model.mass / dt + model.stiffness / compliance
        # by the Schur complement of the head, a step costs one product with `inverse` and a scalar equation
        following = np.concatenate([[1.0], -dt * (inverse @ step[1:, 0])])  # motion for v+ = 1
        return (
            float(following @ step[:, 0]),
            model.mass @ following / dt,
            model.stiffness @ following / compliance,
            float(following @ model.load),
        )

    def _widen_envelope(self, sigma: np.ndarray, motion: np.ndarray) -> None:
        """Widen the envelope to FAR times |s| and |q| (k,) if no bond could yield or close there, else to twice."""
        s, q = self._outer_envelope(FAR * sigma, FAR * motion)
        # a wide envelope is rarely left, but where bonds come near yield within it they would all be watched
        # in each step
        growth = 2.0 if self._ask_bonds(lambda part: part.bounds.any_candidate(s, q)) else FAR
        self._watch(growth * sigma, growth * motion)

    def _watch(self, sigma: np.ndarray, motion: np.ndarray) -> None:
        """Widen the envelope of s and q, and list the bonds that could yield or close within it."""
        # before the lists change: of bonds that are no longer watched only a bound is known
        self._maxima[2] = self._borne()
        s, q = self._sigma_envelope, self._motion_envelope = self._outer_envelope(sigma, motion)
        self._may_yield, self._may_close = self._ask_bonds(lambda part: part.bounds.candidates(s, q))
        self._look_at()

    def _outer_envelope(self, sigma: np.ndarray, motion: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """An envelope that holds these and twice what has been reached."""
        return np.maximum(sigma, 2.0 * self._reached_sigma), np.maximum(motion, 2.0 * self._reached_motion)

    def _borne(self, of_all: bool = False) -> float:
        """The largest utilisation so far; of bonds that are not watched only a bound is known.

        That of bonds that an excerpt does not list only grows: it is asked for in the end alone (`of_all`).
        """
        reached, watched, most = self._reached_sigma, self._may_yield, float(self._maxima[2])
        return self._part.bounds.largest_utilisation(reached, watched, most, of_all)

    def _look_at(self) -> None:
        """Take from the model what shows whether the bonds watched yield or close."""
        part = self._part
        self._reaction = part.reaction_of(self._may_yield)
        self._beyond_head = part.bounds.head_bounds(self._may_yield, self._sigma_envelope)
        self._closing = part.closing_of(self._may_close)

    def _enrich(self, code: int) -> None:
        """Widen the basis once for the step just refused, at the head velocity just tried.

        For a bond that broke by directions kept ready (`_stand_by`), else by the exact correction of that step.
        """
        from asphalt_nscd.nscd.stepping.break_modes import AHEAD
        from asphalt_nscd.nscd.stepping.reduced_model import append_columns

        self.enrichments += 1
        whole, model = self.model, None
        # a bond broke, and directions for its break were kept ready, or can be for more bonds
        if code == YIELD and self._stand_by is not None and self._ritz is not None:
            if not np.isin(self.state.broken, self._stand_by.bonds).all():
                self._stand_by_for(self.state.broken, AHEAD)
            model = self._stand_by.model(whole.system, self._ritz, self.state.broken)
        if model is None:
            # the exact correction of the refused step, where none was kept ready: it costs a factorisation
            self._stand_by = None  # its projection knows nothing of the directions now found
            basis = append_columns(whole.system, whole.basis, self._corrections())
            model = whole.project_anew(basis, self.state.broken)
        more, self._part = model.size - self.state.sigma.size, model
        for name in ("displacement", "velocity", "sigma", "memory"):
            setattr(self.state, name, _widened(getattr(self.state, name), more))
        self._reached_sigma = _widened(self._reached_sigma, more)
        self._reached_motion = _widened(self._reached_motion, more)
        self._watch(_widened(self._sigma_envelope, more), _widened(self._motion_envelope, more))

    def _stand_by_for(self, bonds: list[int], ahead: int) -> None:
        """Find directions for `bonds` too, and for the next to break, `ahead` so many."""
        from asphalt_nscd.nscd.stepping.reduced_model import shifted_factor

        system = self.model.system
        assert self._stand_by is not None and self._ritz is not None
        self._shifted = self._shifted or shifted_factor(system)
        self._stand_by = self._stand_by.add_directions(bonds, system, self._ritz, self._shifted, ahead)

    def _corrections(self) -> np.ndarray:
        """What the refused step misses of the full solution, and what its inertia will need (d, columns)."""
        from asphalt_nscd.nscd.bonds.implicit_operator import ShiftedOperator
        from asphalt_nscd.nscd.stepping.projection import rows_of

        model, system, state, dt = self.model, self.model.system, self.state, self.dt
        weight = system.weight.copy()
        weight[rows_of(state.broken)] = 0.0
        velocity, sigma, _ = self._trial
        residual = dt * system.load - system.mass * (model.basis @ (velocity - state.velocity))
        residual += dt * (system.operator.T @ (weight * (model.opening @ sigma)))
        if self._operator is None:
            self._operator = ShiftedOperator(system, dt / self.law.compliance)
        self._operator.remove(state.broken)
        columns = min(FIRST_ENRICHMENT * 2 ** (self.enrichments - 1), LARGEST_ENRICHMENT)
        extra = np.zeros((system.mass.size, columns))
        force = residual[system.free]
        for column in range(columns):
            extra[system.free, column] = self._operator.solve(force)
            force = system.mass[system.free] * extra[system.free, column]
        return extra


def _columns(matrix: np.ndarray) -> np.ndarray:
    """Its columns as rows: products are summed column by column, which keeps the order of each sum."""
    return np.ascontiguousarray(matrix.T)


def _widened(coordinates: np.ndarray, more: int) -> np.ndarray:
    """Coordinates in a basis with further columns at its end."""
    padding = [(0, 0)] * (coordinates.ndim - 1) + [(0, more)]
    return np.pad(coordinates, padding)
