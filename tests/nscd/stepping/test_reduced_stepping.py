"""The reduced model in time: against its naive twin and the full system, and what its certificate is worth."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from naive.stepping import NaiveState, naive_step
from theory.specimens import system_of

from asphalt_nscd.nscd.bonds.law import BondLaw
from asphalt_nscd.nscd.bonds.system import BondedSystem
from asphalt_nscd.nscd.stepping.condensed import CondensedState, CondensedStepper
from asphalt_nscd.nscd.stepping.reduced_model import ReducedModel, ritz_basis
from asphalt_nscd.nscd.stepping.reduced_stepping import FullSystemNeeded, ReducedStepper

DT = 5e-5
CHAIN = BondLaw(24.3e9, 0.06e9, np.array([48.4e9, 90e9]), np.array([0.077e9, 0.02e9]))


def sine(amplitude, frequency=40.0, steps=300, dt=DT, rest=20):
    """Head at rest for some steps, then A sin(2 pi f t)."""
    time = dt * np.arange(1, steps + 1)
    return np.concatenate([np.zeros(rest), amplitude * np.sin(2 * np.pi * frequency * time)])


def reduced(system, law, vectors=12, tolerance=1e-6, dt=DT) -> ReducedStepper:
    return ReducedStepper(ReducedModel(system, ritz_basis(system, vectors)), law, dt, tolerance)


def full(system, law, dt=DT) -> CondensedStepper:
    return CondensedStepper(system, law, dt, CondensedState.rest_state(system, law))


def march(stepper, driven):
    return np.array([stepper.advance(v) for v in np.diff(driven, prepend=0.0) / stepper.dt])


def deviation(force, reference):
    return np.abs(force - reference).max() / np.abs(reference).max()


@pytest.mark.parametrize("law", [CHAIN, BondLaw(24.3e9, 0.06e9, np.array([]), np.array([]))])
def test_naive_twin(beam_system, law):
    """The same Galerkin equations on vectors of full length, and the certificate by looking at every bond."""
    basis, driven = ritz_basis(beam_system, 2), sine(1e-6, frequency=200.0, steps=12, rest=2)
    stepper = reduced(beam_system, law, vectors=2, tolerance=np.inf)
    force, velocity = stepper.run(driven)
    state, model = NaiveState.at_rest(beam_system, law), stepper.model
    largest = stress = residual = utilised = 0.0
    narrow = np.inf
    for n in range(driven.size):
        before = driven[n - 1] if n else 0.0
        state, expected = naive_step(beam_system, law, DT, state, (driven[n] - before) / DT, basis=basis)
        largest = max(largest, abs(expected))
        assert force[n] == pytest.approx(expected, abs=1e-9 * largest)
        fastest = np.abs(state.velocity).max()
        np.testing.assert_allclose(basis @ velocity[n], state.velocity, rtol=0, atol=1e-9 * fastest)
        # coordinate 0 of the stress: K-orthogonal projection on column 0
        column = beam_system.stiffness() @ basis[:, 0]
        work = (beam_system.weight * state.sigma) @ (beam_system.operator @ basis[:, 0])
        stress = max(stress, abs(work / column[beam_system.driven]))
        residual = max(residual, state.residual / (model.head_norm * stress + model.load_norm))
        utilised = max(utilised, beam_system.utilisation(beam_system.weight * state.sigma).max())
        narrow = min(narrow, (beam_system.gap + beam_system.operator[::3] @ state.displacement).min())
    certificate = stepper.certificate()
    assert 1e-6 < residual < 1e-1
    assert certificate.largest_residual == pytest.approx(residual, rel=1e-6)
    assert utilised * (1 - 1e-9) <= certificate.largest_utilisation <= 3 * utilised
    assert narrow - 1e-9 < certificate.smallest_gap <= narrow + 1e-18
    np.testing.assert_allclose(
        stepper.full_state().sigma, state.sigma, rtol=0, atol=1e-9 * np.abs(state.sigma).max()
    )
    np.testing.assert_allclose(
        stepper.full_state().displacement,
        state.displacement,
        rtol=0,
        atol=1e-9 * np.abs(state.displacement).max(),
    )
    assert stepper.full_state().memory.shape == state.memory.shape
    np.testing.assert_allclose(
        stepper.full_state().memory, state.memory, rtol=0, atol=1e-9 * np.abs(state.memory).max(initial=0.0)
    )


def test_full_and_reduced_agree_step_by_step(beam_system, quick_law):
    """Twenty-six coordinates for 330: forces to 1e-12, stresses and displacements to 1e-9."""
    driven = sine(1e-6)
    stepper, complete = reduced(beam_system, quick_law), full(beam_system, quick_law)
    assert deviation(stepper.run(driven)[0], march(complete, driven)) < 1e-12
    state, expected = stepper.full_state(), complete.state
    for name in ("displacement", "velocity", "sigma", "memory"):
        wanted = getattr(expected, name)
        np.testing.assert_allclose(getattr(state, name), wanted, rtol=0, atol=1e-9 * np.abs(wanted).max())
    assert stepper.certificate().enrichments == 0


@pytest.mark.parametrize("frequency", [40.0, 1000.0])
def test_residual_tells_the_error(beam_system, quick_law, frequency):
    """The fewer Krylov vectors, the larger the residual and the error of the force with it. Galerkin's
    force is of higher order than its residual: it stays below it, down to rounding."""
    dt = 2e-3 / frequency
    driven = sine(1e-6, frequency, steps=200, dt=dt)
    reference = march(full(beam_system, quick_law, dt), driven)
    residuals, errors = [], []
    for vectors in (0, 1, 2, 3, 5, 8):
        stepper = reduced(beam_system, quick_law, vectors, tolerance=np.inf, dt=dt)
        errors.append(deviation(stepper.run(driven)[0], reference))
        residuals.append(stepper.certificate().largest_residual)
    assert (np.diff(residuals) < 0).all()
    assert residuals[0] > 1e-2 and residuals[-1] < 0.1 * residuals[0]
    assert (np.diff(errors)[np.array(errors[:-1]) > 1e-11] < 0).all()
    for residual, error in zip(residuals, errors):
        assert error < residual + 1e-12


@pytest.mark.parametrize("tolerance", [1e-2, 1e-5, 1e-8, 1e-11])
def test_tightening_enriches_the_basis(beam_system, quick_law, tolerance):
    """From two vectors on: whatever tolerance is asked for is kept, and the error follows it."""
    dt = 1e-5
    driven = sine(1e-6, frequency=1000.0, steps=100, dt=dt)
    stepper = reduced(beam_system, quick_law, vectors=0, tolerance=tolerance, dt=dt)
    force, velocity = stepper.run(driven)
    certificate = stepper.certificate()
    assert 0 < certificate.enrichments < 12
    assert certificate.largest_residual <= tolerance
    assert deviation(force, march(full(beam_system, quick_law, dt), driven)) < 10 * tolerance + 1e-12
    np.testing.assert_array_equal(
        velocity[-1], stepper.state.velocity
    )  # of what the basis has got since, too
    gram = stepper.model.stiffness[1:, 1:]
    np.testing.assert_allclose(gram, np.eye(gram.shape[0]), atol=1e-10)


def test_a_model_that_has_grown_too_large_gives_way(beam_system, quick_law):
    """No further enrichment allowed: the full system goes on from there, as if it had run all the way."""
    driven = sine(4e-5, steps=280)
    complete = full(beam_system, quick_law)
    reference = march(complete, driven)
    stepper = ReducedStepper(
        ReducedModel(beam_system, ritz_basis(beam_system, 12)), quick_law, DT, 1e-8, most_enrichments=0
    )
    with pytest.raises(FullSystemNeeded, match="too many enrichments") as accepted:
        stepper.run(driven)
    done = accepted.value.force.size
    assert 250 < done < 290
    assert deviation(accepted.value.force, reference[:done]) < 1e-10
    after = CondensedStepper(beam_system, quick_law, DT, stepper.full_state())
    continued = [after.advance(v) for v in np.diff(driven[done - 1 :]) / DT]
    assert deviation(np.array(continued), reference[done:]) < 1e-7
    assert after.state.broken == complete.state.broken != []


# Yield: amplitudes at which single bonds go and take others with them in the same step.


@pytest.mark.parametrize(
    ("amplitude", "steps", "vectors", "tolerance"),
    [(4e-5, 270, 12, 1e-8), (4e-5, 270, 1, 1e-6), (6e-5, 100, 12, 1e-6)],
)
def test_the_same_bonds_break_in_the_same_order(beam_system, quick_law, amplitude, steps, vectors, tolerance):
    """Reduced and full, force by force, to 1e-7 before and after; what is left stays within yield."""
    driven = sine(amplitude, steps=steps)
    complete = full(beam_system, quick_law)
    reference, broken_by, utilised = np.empty(driven.size), [], 0.0
    for n, velocity in enumerate(np.diff(driven, prepend=0.0) / DT):
        reference[n] = complete.advance(velocity)
        broken_by.append(len(complete.state.broken))
        share = beam_system.utilisation(complete._operator.weight * complete.state.sigma)
        assert share.max() <= 1.0
        assert not share[complete.state.broken].any()
        utilised = max(utilised, share.max())
    stepper = reduced(beam_system, quick_law, vectors, tolerance)
    force, _ = stepper.run(driven)
    assert len(complete.state.broken) >= 2
    assert stepper.state.broken == complete.state.broken
    assert deviation(force, reference) < 1e-7
    assert np.isfinite(beam_system.strength[stepper.state.broken]).all()  # never a plate bond
    certificate = stepper.certificate()
    assert certificate.largest_residual <= tolerance
    assert utilised * (1 - 1e-6) <= certificate.largest_utilisation <= 1.0
    if amplitude == 4e-5:
        assert np.diff(broken_by).max() == 2  # a cascade within one step


def springs(first, second, masses, gap, strength, bodies=2) -> BondedSystem:
    """Bonds along one axis between bodies 0 (driven), 1, ...; None is the wall."""
    rows = np.zeros((3 * len(first), bodies))
    for b, (i, j) in enumerate(zip(first, second)):
        if i is not None:
            rows[3 * b, i] -= 1.0
        if j is not None:
            rows[3 * b, j] += 1.0
    return system_of(rows, 1e-3, masses, gap=gap, strength=strength, friction=0.5)


ELASTIC = BondLaw(1e10, 1e20, np.array([]), np.array([]))


def test_yield_is_not_decided_by_an_inaccurate_step():
    """Head - heavy body - heavy body - wall, jerked: in truth only the first bond feels it. The static
    vector alone would stretch all three alike and break the last, which is weak."""
    system = springs([1, 2, None], [0, 1, 2], [1.0, 50.0, 50.0], [1, 1, 1], [np.inf, np.inf, 0.2], bodies=3)
    driven = np.full(3, 1e-7)
    complete = full(system, ELASTIC, dt=1e-4)
    reference = march(complete, driven)
    assert complete.state.broken == []
    static = np.array([1, 2 / 3, 1 / 3])[:, None]
    stepper = ReducedStepper(ReducedModel(system, static), ELASTIC, 1e-4, 1e-9)
    force, _ = stepper.run(driven)
    assert stepper.state.broken == []
    assert deviation(force, reference) < 1e-9


def test_yield_is_not_decided_before_contact():
    """Head - body between two walls: the body meets the near wall, which saves its bond to the far one."""
    system = springs([0, 1, None], [1, None, 1], [1.0, 1e-3], [1, 1e-8, 1], [np.inf, np.inf, 0.2])
    complete = full(system, ELASTIC, dt=1e-4)
    complete.advance(1e-3)
    assert complete.state.broken == []
    assert complete.state.displacement[1] == pytest.approx(1e-8, rel=1e-9)
    stepper = ReducedStepper(
        ReducedModel(system, ritz_basis(replace(system, load=np.array([0, 1.0])), 0)), ELASTIC, 1e-4, 1e-6
    )
    with pytest.raises(FullSystemNeeded, match="a gap closes") as closed:
        stepper.run(np.full(3, 1e-7))
    assert closed.value.force.size == 0 and stepper.state.broken == []


def test_a_closing_gap_ends_the_reduced_run(beam_system, quick_law):
    """Gaps a thousand times narrower: the reduced run stops before the very step in which the full one
    meets contact, and the full system goes on from its state as if it had run all the way."""
    system = replace(
        beam_system, gap=1e-3 * beam_system.gap, strength=np.full_like(beam_system.strength, np.inf)
    )
    driven = sine(3e-5, steps=150)
    complete, forces, first, smallest = full(system, quick_law), [], None, np.inf
    for n, velocity in enumerate(np.diff(driven, prepend=0.0) / DT):
        before = complete.state.velocity
        forces.append(complete.advance(velocity))
        state = complete.state
        gap = system.gap + system.operator[::3] @ state.displacement
        smallest = min(smallest, gap.min())
        closed = np.flatnonzero(gap < 1e-13)
        if closed.size and first is None:
            first = n
        # what the bonds do not explain of the motion are the contact forces, and only closed gaps bear any
        missing = system.mass * (state.velocity - before) / DT - system.load
        missing -= system.operator.T @ (system.weight * state.sigma)
        rows = (3 * closed[:, None] + np.arange(3)).ravel()
        jacobian = system.operator[rows][:, system.free].toarray().T
        contact, *_ = np.linalg.lstsq(jacobian, missing[system.free])
        left = jacobian @ contact - missing[system.free]
        assert np.abs(left).max() < 1e-9 * np.abs(forces).max()
        contact = contact.reshape(-1, 3)
        size = np.abs(contact).max(initial=0.0)
        assert (contact[:, 0] >= -1e-10 * size).all()  # repulsive
        assert (np.hypot(contact[:, 1], contact[:, 2]) <= system.friction * contact[:, 0] + 1e-9 * size).all()
    assert smallest > -1e-12
    assert 20 < first < driven.size - 50

    stepper = reduced(system, quick_law)
    with pytest.raises(FullSystemNeeded, match="a gap closes") as closed:
        stepper.run(driven)
    done = closed.value.force.size
    assert done == first
    assert deviation(closed.value.force, np.array(forces[:done])) < 1e-10
    after = CondensedStepper(system, quick_law, DT, stepper.full_state())
    continued, before = [], stepper.certificate()
    for velocity in np.diff(driven[done - 1 :]) / DT:
        continued.append(after.advance(velocity))
        stepper.certify(after)
    certificate = stepper.certificate()
    assert before.smallest_gap > 0.0 >= smallest >= certificate.smallest_gap
    assert before.largest_residual <= certificate.largest_residual < 1e-10
    assert deviation(np.array(continued), np.array(forces[done:])) < 1e-7
