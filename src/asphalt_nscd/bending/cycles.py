"""A force commanded from rest on a specimen whose grains touch, cycle after cycle, and read as a machine reads it."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import pandas as pd
from scipy import sparse
from scipy.spatial import ConvexHull, QhullError

from asphalt_nscd.bending.bending_test import bond_law
from asphalt_nscd.bending.further_settings import Cycling
from asphalt_nscd.bending.model import Model
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.nscd.bonds.law import AnyLaw
from asphalt_nscd.nscd.bonds.system import BondedSystem
from asphalt_nscd.nscd.stepping.compliant import CompliantStepper
from asphalt_nscd.nscd.stepping.condensed import CondensedState
from asphalt_nscd.nscd.stepping.energy import diagonal_form
from asphalt_nscd.nscd.stepping.harmonic import driving_force
from asphalt_nscd.nscd.stepping.scheme import History, Scheme
from asphalt_nscd.nscd.stepping.skeleton import Skeleton
from asphalt_nscd.rheology.as_run import Programme
from asphalt_nscd.rheology.burgers import Burgers
from asphalt_nscd.rheology.chain import KelvinChain

TOUCHING = 0.005  # of the distance of two centres: a smaller gap in the poured layer is a contact
TOLERANCE = 1e-6  # of the motion of the head: how far an opening may lie from that in balance


@dataclass(frozen=True)
class CyclicTest:
    """What a test of cycles gives; forces press, and displacements of the head go with them.

    `stiffness` is what is read, force over displacement [N/m], and `stuck` that of the same system with its contacts
    stuck, in steady oscillation. `angle` omega t [rad], `force` [N] and `displacement` [m] are (s,). Of the last cycle:
    `work` of the force, and `taken` by dashpots and contacts or stored [J], which is the same but for the time step.
    """

    stiffness: complex
    stuck: complex
    angle: np.ndarray
    force: np.ndarray
    displacement: np.ndarray
    work: float
    taken: float


def cycle(model: Model, law: Burgers | KelvinChain, frequency: float, cycling: Cycling) -> pd.DataFrame:
    """One test of a specimen whose grains touch; each step has time_s, force_N and displacement_m, pressing.

    `attrs`: E_MPa and phase_deg as they are read, E_stuck_MPa and phase_stuck_deg of the specimen with its contacts
    stuck, contacts, and energy_error, the share of the work of the last cycle that is not accounted for.
    """
    chain = bond_law(law)
    skeleton = skeleton_of(model, cycling.pressure_Pa, cycling.skeleton_friction)
    stuck = stuck_stiffness(model.system, chain, skeleton, 2.0 * np.pi * frequency)
    amplitude = cycling.amplitude_m or model.geometry.usual_amplitude()
    programme = Programme(
        cycling.haversine, cycling.all_cycles, cycling.read_cycles, cycling.drift, cycling.steps_in_cycle
    )
    try:
        test = run_cycles(model.system, chain, skeleton, frequency, abs(stuck) * amplitude, programme)
    except ArithmeticError as error:
        raise InputError(f"{model.name}: {error}; lower the amplitude, or give more steps.") from None
    table = pd.DataFrame({"time_s": test.angle / (2.0 * np.pi * frequency)})
    table["force_N"], table["displacement_m"] = test.force, test.displacement
    table.attrs = {"specimen": model.name, "contacts": skeleton.bonds.size}
    for name, stiffness in (("", test.stiffness), ("_stuck", stuck)):
        modulus = complex(
            model.geometry.complex_modulus(frequency, abs(stiffness), 1.0, float(np.angle(stiffness)))
        )
        table.attrs |= {
            f"E{name}_MPa": abs(modulus) / 1e6,
            f"phase{name}_deg": float(np.degrees(np.angle(modulus))),
        }
    table.attrs["energy_error"] = float(1.0 - test.taken / test.work)
    return table


def told(table: pd.DataFrame) -> str:
    """Say in one line what is read, and what would be if no contact slipped."""
    of = table.attrs
    return (
        f"|E*| = {of['E_MPa']:.4g} MPa, phase {of['phase_deg']:.2f} deg; with all {of['contacts']} contacts stuck "
        f"{of['E_stuck_MPa']:.4g} MPa, {of['phase_stuck_deg']:.2f} deg"
    )


def skeleton_of(model: Model, pressure: float, friction: float) -> Skeleton:
    """Contacts between grains that touched when they were poured, preloaded by `pressure` [Pa].

    Grains of a specimen are shrunk alike: a gap over its distance tells whether they touched, or overlapped, before.
    """
    shape, n = model.shape, model.spheres
    first, second, position = shape["first"], shape["second"], shape["position_m"]
    radius = shape["radius_m"]
    between = np.flatnonzero(np.maximum(first, second) < n)
    if not between.size:
        raise InputError(f"{model.name}: no two grains are bonded; take a specimen of more grains.")
    apart = model.system.gap[between] / np.linalg.norm(
        position[first[between]] - position[second[between]], axis=1
    )
    shrunk = 1.0 - (1.0 - model.volume_reduction) ** (1.0 / 3.0)
    # grains poured here overlap by less than half of it; of another program's, one pair may overlap by more
    least = np.clip(apart.min(), shrunk - TOUCHING / 2.0, shrunk)
    touching = between[apart < least + TOUCHING]
    if not touching.size:
        raise InputError(
            f"{model.name}: no two grains are known to have touched when poured; take a packing in which they did, "
            "and condense its specimen anew."
        )
    one, two = first[touching], second[touching]
    effective = radius[one] * radius[two] / (radius[one] + radius[two])
    length = np.linalg.norm(position[one] - position[two], axis=1)
    try:
        volume = float(ConvexHull(position).volume)  # of the centres, between which the forces act
    except QhullError:  # as of a slice one grain thick
        raise InputError(
            f"{model.name}: the centres of its grains lie in one plane, between which no pressure can act; take a "
            "specimen of more grains."
        ) from None
    return Skeleton.preloaded(touching, effective, length, volume, pressure, friction=friction)


def run_cycles(
    system: BondedSystem,
    law: AnyLaw,
    skeleton: Skeleton,
    frequency: float,
    force: float,
    programme: Programme,
) -> CyclicTest:
    """Press the head by a force of this amplitude [N] at `frequency` [Hz]; weight is left out, and bonds do not break.

    The scheme is fitted to the frequency: films alone have no error of the time step in steady oscillation.
    """
    omega, head = 2.0 * np.pi * frequency, system.driven
    stuck = stuck_stiffness(system, law, skeleton, omega)
    loose = _loose(system)
    scheme = Scheme.named("fitted", 2.0 * np.pi / programme.samples)
    time_step = 1.0 / (frequency * programme.samples)
    state = CondensedState.rest_state(loose, law)
    stepper = CompliantStepper(
        loose, law, time_step / scheme.a, state, skeleton, TOLERANCE * force / abs(stuck)
    )
    strain, inertia = diagonal_form(loose.weight), diagonal_form(loose.mass)
    work = dashpots = began = 0.0

    def held(now: History) -> float:
        """Energy in motion, films and contacts [J]; what friction took counts as held."""
        stress = now.values["sigma"], now.values["memory"]
        moving = inertia(now.values["velocity"], now.values["velocity"])
        return 0.5 * (moving + law.stored(strain, stress, stress)) + stepper.grip.held(skeleton)

    angle = programme.angles()
    forces = force * programme.stress(angle)
    displacement = np.zeros_like(forces)
    earlier = now = History.of(state, 0.0)
    for n in range(1, angle.size):
        base = now.extrapolate(earlier, scheme.b / scheme.a)
        base.put(state)
        loose.load[head] = -forces[n]
        stepper.advance(0.0)
        earlier, now = now, History.of(state, 0.0)
        displacement[n] = -state.displacement[head]
        # rates of the scheme, of second order as the motion is
        rate = (now.values["memory"] - base.values["memory"]) / stepper.dt
        work -= time_step * forces[n] * state.velocity[head]
        dashpots += time_step * law.dissipated(strain, state.sigma, state.memory, rate)
        # the account is that of the last cycle
        if n == angle.size - 1 - programme.samples:
            work, dashpots, began = 0.0, 0.0, held(now)
    read = programme.phasor(forces, angle) / programme.phasor(displacement, angle)
    return CyclicTest(read, stuck, angle, forces, displacement, work, dashpots + held(now) - began)


def stuck_stiffness(system: BondedSystem, law: AnyLaw, skeleton: Skeleton, omega: float) -> complex:
    """Force over displacement of the head [N/m] at `omega` [rad/s], contacts stuck under their preload."""
    bonds = system.weight * law.discrete_modulus(omega, 0.0)
    bonds[skeleton.rows] += skeleton.stiffness(skeleton.overlap)
    weight = np.abs(bonds)
    return driving_force(replace(system, weight=weight), bonds / weight, omega)


def _loose(system: BondedSystem) -> BondedSystem:
    """The same without weight, its head free: what is driven instead is bonded to nothing."""
    none = sparse.csr_matrix((system.weight.size, 1))
    return replace(
        system,
        operator=sparse.hstack([system.operator, none]).tocsr(),
        mass=np.append(system.mass, 1.0),
        load=np.zeros(system.mass.size + 1),
        driven=system.mass.size,
    )
