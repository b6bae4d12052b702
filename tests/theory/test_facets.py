"""Bonds that are facets of the power diagram, against geometry, elasticity and beams."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.optimize import brentq

from asphalt_nscd.bending.bending_test import bond_law, run_test
from asphalt_nscd.bending.case import LoadCase, Numerics
from asphalt_nscd.bending.condensing import Bonds, condensed
from asphalt_nscd.bending.hold import Hold, hold
from asphalt_nscd.bending.model import Model, model_of
from asphalt_nscd.files.store import Record
from asphalt_nscd.measurements.fourpoint import Beam
from asphalt_nscd.measurements.signals import harmonic_response
from asphalt_nscd.nscd.bonds.system import opening_operator
from asphalt_nscd.nscd.stepping.harmonic import driving_force
from asphalt_nscd.rheology.burgers import Burgers
from asphalt_nscd.specimen.network import region_of
from asphalt_nscd.specimen.power_diagram import power_diagram
from asphalt_nscd.specimen.prism import pull, static_ratio
from asphalt_nscd.specimen.system import bending_system
from asphalt_nscd.specimen.trimming import Specimen
from theory.rows import order
from theory.specimens import jittered_beam

STRAIN = np.array([[0.7, 0.3, -0.5], [0.3, -0.4, 0.2], [-0.5, 0.2, 1.0]])
LEFT_OUT = 1e-5  # relative; facets of negligible area are no bonds


def block() -> Specimen:
    """Spheres of many sizes in a prism of 24 x 20 x 48 mm, out of a lattice."""
    return jittered_beam(seed=4, shape=(6, 5, 12), fill=0.45, area="facets")


def test_cells(row):
    """Pyramids over the facets fill the specimen; each cell is closed and obeys the divergence theorem."""
    specimen, source = block(), "divergence theorem"
    n, geometry = specimen.radius.size, specimen.geometry
    facets = power_diagram(specimen.position, specimen.radius, region_of(geometry))
    volume = geometry.width * geometry.thickness * geometry.h
    own, normal = facets.second < n, facets.frame[:, 0]
    vector = facets.area[:, None] * normal
    out = np.zeros((n, 3))
    np.add.at(out, facets.first, vector)
    np.add.at(out, facets.second[own], -vector[own])
    arms = np.einsum("fi,fj->ij", facets.centroid - specimen.position[facets.first], vector)
    arms -= np.einsum(
        "fi,fj->ij", (facets.centroid[own] - specimen.position[facets.second[own]]), vector[own]
    )
    misfit = np.abs(arms - volume * np.eye(3)).max() / volume
    area = np.abs(out).max() / facets.area.mean()
    row("volume of cells, sum A l / 3 (m3)", volume, facets.volume, LEFT_OUT, "the specimen")
    row("closed cells, largest sum A n over a mean facet", 0.0, area, 10 * LEFT_OUT, source)
    row("sum A (c - x) n over the specimen less V I", 0.0, misfit, LEFT_OUT, source)


def test_patch(row):
    """kt = kn, all spheres displaced by a uniform strain: in equilibrium, with the stress E strain."""
    specimen, source = block(), "sum A n = 0 and sum A (c - x) n = V I in each cell"
    network, n, geometry = specimen.network, specimen.radius.size, specimen.geometry
    operator = opening_operator(
        network.first, network.second, network.frame, network.point, specimen.position
    )
    motion = np.hstack([specimen.position @ STRAIN, np.zeros((n, 3))]).ravel()
    force = np.repeat(network.form, 3) * (operator @ motion)
    half = np.array([geometry.width, geometry.thickness, geometry.h]) / 2
    centre = np.array([0.0, 0.0, half[2]])
    # no bond bears the traction on the free faces, so cells that reach them are not in equilibrium
    deep = (half - np.abs(specimen.position - centre) > 6e-3).all(axis=1)
    load = (operator.T @ force).reshape(n, 6)[deep]
    scale = network.area.mean()
    within = deep[network.first] & (network.second < n)
    within &= deep[np.minimum(network.second, n - 1)]
    traction = np.einsum("bk,bka->ba", force.reshape(-1, 3)[within], network.frame[within])
    error = traction - network.area[within, None] * network.frame[within, 0] @ STRAIN
    force, torque, misfit = (np.abs(of).max() / scale for of in (load[:, :3], load[:, 3:], error))
    row("uniform strain, largest force on a sphere", 0.0, force, 10 * LEFT_OUT, source)
    row("uniform strain, largest torque on a sphere (mm)", 0.0, 1e3 * torque, 10 * LEFT_OUT, source)
    row("uniform strain, traction of a facet", 0.0, misfit, 1e-12, "sigma n = E strain n")


def test_tension(row):
    """A prism with free faces, kt = kn: the modulus of the law in any packing, and no contraction."""
    for seed, fill in ((4, 0.45), (5, 0.25)):
        modulus, poisson = pull(
            jittered_beam(seed=seed, shape=(5, 4, 12), fill=fill, area="facets"), np.ones(3)
        )
        row(f"pulled prism of packing {seed}, E over the law", 1.0, modulus, LEFT_OUT, "patch test")
        row("the same, Poisson's ratio", 0.0, poisson, LEFT_OUT, "patch test")


def test_bending(row):
    """Cantilevers of facets against Timoshenko's beam, whose shear Eq. (3) leaves out.

    A facet acts at its centroid and has no moment of its own: N of them over the width of the beam have a
    second moment smaller by the part 1/N^2.
    """
    for count in (6, 10):
        beam = jittered_beam(seed=6, shape=(count, 3, 36), area="facets")
        share = beam.geometry.counted_share(0.0)
        expected = 1.0 / (1.0 / (1.0 - count**-2) + 1.0 / share - 1.0)
        found = share * static_ratio(bending_system(beam, 0.35, np.inf, 0.7), beam.geometry)
        name = f"cantilever of {count} facets over its width, Eq. (3) over the law"
        row(name, expected, found, 0.006, "Timoshenko, k = 5/6, nu = 0")


def test_four_points(row):
    """A prism between four clamps, the inner ones cutting through its spheres, against Timoshenko's beam; then dynamic.

    Beside the law stands E* over that of statics; at a tenth of the stiffness an error of 2 % in the mass factor shows.
    """
    beam = jittered_beam(seed=6, shape=(10, 3, 61), area="facets", test=Beam.test)
    modulus = 1e10 * np.exp(0.5j)
    geometry, system = beam.geometry, bending_system(beam, 0.35, np.inf, 0.7)
    share = geometry.counted_share(0.0)
    static = static_ratio(system, geometry)
    stiffness = abs(modulus) * static / geometry.form_factor()
    expected = 1.0 / (1.0 / (1.0 - 0.01) + 1.0 / share - 1.0)
    name = "prism of 10 facets over its depth, four-point bending over the law"
    row(name, expected, share * static, 2e-3, "Timoshenko, k = 5/6, nu = 0")
    for part in (1e-3, 0.1):
        omega = np.sqrt(part * stiffness / geometry.mass_factor())
        force = driving_force(system, modulus, omega)
        found = geometry.complex_modulus(omega / (2 * np.pi), abs(force), 1.0, np.angle(force)) / static
        name = f"the same, mass term {part:g} of the stiffness"
        row(f"{name}, |E*| over the law", 1.0, abs(found / modulus), 1e-3, "the law")
        phase = np.degrees(np.angle(found / modulus))
        row(f"{name}, phase over the law (deg)", 0.0, phase, 0.05, "the law")


def clamped() -> Model:
    """A prism between four clamps, of its weight and a thousandth of its inertia: it does not swing."""
    beam = jittered_beam(seed=6, shape=(4, 2, 25), area="facets", test=Beam.test)
    model = model_of(Record(*condensed(beam, "beam", Bonds(yield_Pa=1e12)), ""))
    # directions kept ready hold the projection of the old masses: none then
    return replace(model, system=replace(model.system, mass=1e-3 * model.system.mass), stand_by=None)


def test_held(row):
    """A prism between four clamps, its force or its displacement held: creep and relaxation of the law, in small steps.

    Errors are of first order in the step, so that twice those of half the step cancel. Its weight, a third of the
    force, is tared.
    """
    model, law = clamped(), Burgers(24.3e9, 0.06e9, 48.4e9, 0.077e9)
    static, form = static_ratio(model.system, model.geometry), model.geometry.form_factor()
    for what, held, law_at, source in (
        (
            "creep",
            {"force_N": 0.1},
            lambda t: 1.0 / law.creep_compliance(t),
            "D = 1/Em + t/eta + (1 - exp(-t/tau))/Ek",
        ),
        ("relaxation", {"displacement_m": 1e-7}, law.relaxation_modulus, "inverse transform of 1/(s D(s))"),
    ):
        times, found = np.array([1e-3, 4e-3]), []
        for steps in (400, 800):
            table = hold(model, law, Hold(4e-3, steps, **held)).iloc[[steps // 4 - 1, steps - 1]]
            found.append(form * (table["force_N"] / table["displacement_m"]).to_numpy())
        for t, coarse, fine in zip(times, *found, strict=True):
            name = f"prism between four clamps, {what} modulus after {1e3 * t:g} ms (GPa)"
            expected = float(law_at(t)) * static
            row(name, 1e-9 * expected, 1e-9 * (2.0 * fine - coarse), 2e-5, source)
            errors = [abs(one / expected - 1.0) for one in (coarse, fine)]
            row(f"{name}, order in the step", 1.0, order(errors), 0.01, "implicit Euler")


def test_commanded(row):
    """Its force commanded, E* is that of the motion commanded, and the force as it was said."""
    model, law = clamped(), bond_law(Burgers(24.3e9, 0.06e9, 48.4e9, 0.077e9))
    numerics = Numerics(1e-2 / 200, 1000, scheme="fitted")
    moduli, force = [], 0.0
    for case in (LoadCase(100.0, 1e-7, 8.0), LoadCase(100.0, 0.1, 8.0, by_force=True)):
        record = run_test(model, law, case, numerics)
        seen = harmonic_response(record.time, record.force, record.displacement, 100.0, 2)
        moduli.append(seen.force_amplitude / seen.displacement_amplitude * np.exp(1j * seen.phase))
        force = seen.force_amplitude
    ratio = moduli[1] / moduli[0]
    row("force commanded over motion commanded, |E*|", 1.0, abs(ratio), 1e-6, "one linear system")
    row("the same, phase (deg)", 0.0, float(np.degrees(np.angle(ratio))), 1e-5, "one linear system")
    row("commanded force (N)", 0.1, force, 1e-6, "as it was said")


def test_resonance(row):
    """A bar held at its foot, its head without mass: the first resonance in tension is that of a quarter wave."""
    beam, modulus = jittered_beam(seed=6, shape=(3, 3, 40), area="facets"), 1e10
    geometry, system = beam.geometry, bending_system(beam, 0.35, np.inf, 0.7)
    head = 6 * beam.radius.size
    mass = system.mass.copy()
    mass[head:] = 1e-9 * geometry.mass
    along = replace(system, mass=mass, driven=head + 2)
    share = geometry.counted_share(0.0)  # of the stiffness of bonds, which Eq. (3) has in bending
    speed = np.sqrt(modulus / share * geometry.width * geometry.thickness * geometry.h / geometry.mass)
    quarter = np.pi / 2.0 * speed / geometry.h
    stiffness = lambda omega: driving_force(along, complex(modulus), omega).real  # noqa: E731
    found = brentq(stiffness, 0.9 * quarter, 1.1 * quarter, rtol=1e-7)
    name, source = "bar of facets, first resonance in tension (rad/s)", "c = sqrt(E/rho), pi c/(2 h)"
    row(name, quarter, found, 1e-3, source)
