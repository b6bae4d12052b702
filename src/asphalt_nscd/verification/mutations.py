"""A wrong sign or factor in an equation of the core, in a copy of the sources, must turn a row red."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
import tempfile
from functools import cache, partial
from pathlib import Path

from asphalt_nscd.files.words import counted
from asphalt_nscd.verification.row import Checks, Row
from asphalt_nscd.workflow_support.sources import PACKAGE

LONGEST = 200  # s of CPU for the rows of a theme: ten times what they need, so that more means without end
MUTANTS = [
    # what, theme that must notice, file, right, wrong
    ("dashpot in the compliance of a bond", "law", "nscd/bonds/law.py", "+ 1.0 / self.dashpot +", "- 1.0 / self.dashpot +"),
    ("recall of the Kelvin element", "law", "nscd/bonds/law.py", "kelvin_recall=springs / damped", "kelvin_recall=-springs / damped"),
    ("growth of the Kelvin element", "law", "nscd/bonds/law.py", "* kelvin - _beside", "* kelvin + _beside"),
    ("memory of the spring", "law", "nscd/bonds/law.py", "spring_memory=1.0 / (dt * self.spring)", "spring_memory=-1.0 / (dt * self.spring)"),
    ("tangential law of a bond", "law", "nscd/bonds/law.py", "[normal, tangential, tangential]", "[normal, normal, tangential]"),
    ("law of another bond", "methods", "nscd/bonds/law.py", "kelvin_recall for step in steps]", "kelvin_decay for step in steps]"),
    ("loss of a bond in the frequency domain", "methods", "nscd/stepping/harmonic.py", "system.weight * relative)", "system.weight * relative.conj())"),
    ("laws in the energy of the springs", "accounts", "nscd/stepping/energy.py", "one[0] / law.spring", "one[0] / np.mean(law.spring)"),
    ("lever arm of a bond", "beams", "nscd/bonds/system.py", "arm[k1] * frame[b, c, k2] - arm", "arm[k1] * frame[b, c, k2] + arm"),
    ("history of the bonds in the condensed equations", "beams", "nscd/stepping/condensed.py", "impulse += self._impulse_of", "impulse -= self._impulse_of"),
    ("load in the force of the head", "beams", "nscd/stepping/condensed.py", "inertia - system.load", "inertia + system.load"),
    ("guide spring at the head", "beams", "nscd/bonds/head_kernels.py", "/ dt + spring * x)", "/ dt - spring * x)"),
    ("inertia in the frequency domain", "beams", "nscd/stepping/harmonic.py", "-(omega**2)", "+(omega**2)"),
    ("form factor of the trapezoid", "beams", "measurements/twopoint.py", "(-np.log1p(-x) - x", "(-np.log1p(-x) + x"),
    ("plane of equal power", "facets", "specimen/power_diagram.py", "+ weight[i] - weight[j])", "- weight[i] + weight[j])"),
    ("weight of the lifted spheres", "facets", "specimen/power_diagram.py", ".sum(axis=1) - weight]", ".sum(axis=1) + weight]"),
    ("centroid of a facet", "facets", "specimen/power_diagram.py", "total(u + p)", "total(u - p)"),
    ("image of a sphere", "facets", "specimen/power_diagram.py", "+ 2.0 * least", "- 2.0 * least"),
    ("deflection between four clamps", "facets", "measurements/fourpoint.py", "5.0 * self.h**3 / (27.0", "5.75 * self.h**3 / (27.0"),
    ("mass between four clamps", "facets", "measurements/fourpoint.py", "SHARE_OF_MASS * self.mass +", "0.5 * self.mass +"),
    ("clamps that turn", "facets", "measurements/fourpoint.py", "driven = (DRIVEN, FREE, FREE, FREE, FREE, FREE)", "driven = (DRIVEN, FREE, FREE, FREE, HELD, FREE)"),
    ("clamps that are driven as one", "facets", "specimen/system.py", "column[driven] = column[driven[0]]", "column[driven] = -1"),
    ("shear in two-point bending", "facets", "measurements/twopoint.py", "bending / (bending + shear)", "bending / (bending - shear)"),
    ("pressure of a squeezed film", "films", "forecasting/film.py", "d * own + rest * one", "d * own - rest * one"),
    ("flow out of a film", "films", "forecasting/film.py", "outer * edge**3", "outer * edge**2"),
    ("slope of a film's surfaces", "films", "forecasting/film.py", "turned = 1.0 + slopes[0]", "turned = 1.0 - slopes[0]"),
    ("mean stress in the grains of a film", "films", "forecasting/film.py", "force / (1.0 + relief)", "force / (1.0 - relief)"),
    ("grain under a spot", "films", "forecasting/film.py", "gain * shed + 1.0 / lame", "-gain * shed + 1.0 / lame"),
    ("pressure of a wedge", "films", "forecasting/film.py", "slid + 0.5 * wedge", "slid - 0.5 * wedge"),
    ("flow around in a wedge", "films", "forecasting/film.py", "+ round_flow[i] / g", "- round_flow[i] / g"),
    ("slopes of a wedge", "films", "forecasting/film.py", "else 0.0) - 1.0 / r1)", "else 0.0) + 1.0 / r1)"),
    ("shear across a facet", "films", "forecasting/film.py", "+ g / length)", "- g / length)"),
    ("Young's modulus of a network of films", "films", "forecasting/film.py", "(3.0 * bulk + shear) * (4.0", "(3.0 * bulk - shear) * (4.0"),
    ("weight of a specimen under a commanded force", "facets", "bending/taring.py", "np.zeros_like(model.system.load)", "model.system.load"),
    ("motion of the clamp that commands a force", "facets", "bending/bending_test.py", "record.displacement - clamp", "record.displacement + clamp"),
    ("motion of the clamp that holds a force", "facets", "bending/hold.py", "path - clamp", "path + clamp"),
    ("mass of a cell", "facets", "specimen/system.py", "geometry.mass * cell / cell.sum()", "geometry.mass * specimen.radius**3 / (specimen.radius**3).sum()"),
    ("stress of the reduced model", "methods", "nscd/stepping/reduced_kernel.py", "(explicit[a] - new_v[a])", "(explicit[a] + new_v[a])"),
    ("opening in a sweep over bonds", "methods", "nscd/bonds/gauss_seidel.py", "mx = load(packed, block, 0) - ux", "mx = load(packed, block, 0) + ux"),
    ("extrapolation of the two-step scheme", "methods", "nscd/stepping/scheme.py", "v + share * (v - earlier", "v - share * (v - earlier"),
    ("dissipation of the dashpots", "accounts", "nscd/stepping/energy.py", "sums.dashpots += dt * power", "sums.dashpots -= dt * power"),
    ("slip in the natural map", "coupled", "nscd/contacts/gauss_seidel.py", "shifted = u0 + friction", "shifted = u0 - friction"),
    ("other contacts in a sweep", "coupled", "nscd/contacts/gauss_seidel.py", "u0 += w[0, 0] * n + w[0, 1] * t + w[0, 2] * s\n                u1", "u0 += w[0, 0] * n - w[0, 1] * t + w[0, 2] * s\n                u1"),
    ("normal reaction of a sticking contact", "coupled", "nscd/contacts/coulomb.py", "n = stopping - b1 * x", "n = stopping + b1 * x"),
    ("slip in Newton's method", "coupled", "nscd/contacts/newton.py", "z[:, 0] -= rho", "z[:, 0] += rho"),
    ("derivative of the projection", "coupled", "nscd/contacts/coulomb.py", "np.eye(2) - direction", "np.eye(2) + direction"),
    ("slip on the interior path", "coupled", "nscd/contacts/interior.py", "residual[:, 0] += slip", "residual[:, 0] -= slip"),
    ("derivative of the slip on it", "coupled", "nscd/contacts/interior.py", "keep[:, 0, 1:] -= share", "keep[:, 0, 1:] += share"),
    ("velocity of a proximal point", "coupled", "nscd/contacts/proximal.py", "problem.free_velocity - each * r", "problem.free_velocity + each * r"),
    ("impulse in the condensed contact", "accounts", "nscd/stepping/condensed.py", "+= response @ impulse", "-= response @ impulse"),
    ("gravity of a sphere", "spheres", "nscd/spheres/granular.py", "+= dt * gravity[k]", "-= dt * gravity[k]"),
    ("moment of a contact on a sphere", "spheres", "nscd/spheres/gauss_seidel.py", "j[2] + w * z, w, j[4] - u * tx", "j[2] + w * z, w, j[4] + u * tx"),
    ("spin in the slip of two spheres", "spheres", "nscd/spheres/gauss_seidel.py", "(vx - (surface_y * nz - surface_z * ny))", "(vx + (surface_y * nz - surface_z * ny))"),
    ("width of the slabs that threads share out", "spheres", "nscd/spheres/slabs.py", "* (1.0 + 1e-9)", "* 0.3"),
    ("strength that a bond must have", "edges", "nscd/bonds/system.py", "self.strength > 0.0", "self.strength > -1.0"),
    ("gap that a bond must have", "edges", "nscd/bonds/system.py", "self.gap >= 0.0", "self.gap >= -1.0"),
    ("end of an open range", "edges", "files/ranges.py", "self.above < number", "self.above <= number"),
    ("normal of spheres in one place", "edges", "nscd/spheres/granular.py", "select_greater(square, zero, z / length, one)", "z / length"),
    ("largest ratio of diameters", "edges", "specimen/granular_bed.py", "LARGEST_RATIO * smallest", "1e9 * smallest"),
    ("balance of a layer at rest", "edges", "specimen/preparation.py", "max(carried, unbalanced) <=", "min(carried, unbalanced) <="),
    ("restitution of an impact", "spheres", "nscd/spheres/granular.py", "= -restitution * opening", "= restitution * opening"),
]  # fmt: skip

checks = Checks()


def mutate(what: str, theme: str, file: str, right: str, wrong: str) -> Row:
    """A row that passes when rows of `theme`, green before, are red once `right` is `wrong` in `file`."""
    with tempfile.TemporaryDirectory() as folder:
        copy = Path(folder, PACKAGE.name)
        shutil.copytree(PACKAGE, copy, ignore=shutil.ignore_patterns("__pycache__"))
        text = (copy / file).read_text(encoding="utf-8")
        if right not in text:
            raise ValueError(f"{file} no longer holds {right!r}; adapt this mutant.")
        (copy / file).write_text(text.replace(right, wrong), encoding="utf-8")
        failed = red_rows(theme, folder)
    if failed is None:
        red, seen = 1, f"{theme} does not end"
    else:
        red = len(failed - (red_rows_before(theme) or set()))
        seen = f"{counted(red, 'row')} of {theme} {'fails' if red == 1 else 'fail'}"
    return Row(f"noticed: {what}", 1.0, float(min(red, 1)), 0.0, f"{right} -> {wrong} in {file}: {seen}")


def red_rows(theme: str, folder: str) -> set[str] | None:
    """Names of the rows of `theme` that fail with the sources in `folder`; None if it does not end.

    A check that raises is a row of its own name.
    """
    script = (
        f"import resource; resource.setrlimit(resource.RLIMIT_CPU, ({LONGEST}, {LONGEST + 9}))\n"
        "from asphalt_nscd.verification.study import verify\n"
        f"rows = verify({theme!r}); print(*rows.name[rows.verdict == 'failed'], sep='\\n')"
    )
    environment = os.environ | {"PYTHONPATH": folder, "ASPHALT_NSCD_CACHE": str(Path(folder, "cache"))}
    done = subprocess.run(
        [sys.executable, "-c", script], env=environment, cwd=folder, capture_output=True, text=True
    )
    if done.returncode == -signal.SIGXCPU:
        return None
    done.check_returncode()
    return set(done.stdout.splitlines()) - {""}


@cache
def red_rows_before(theme: str) -> set[str] | None:
    """The same of the sources as they are: a row that fails anyway notices nothing."""
    with tempfile.TemporaryDirectory() as folder:
        shutil.copytree(PACKAGE, Path(folder, PACKAGE.name), ignore=shutil.ignore_patterns("__pycache__"))
        return red_rows(theme, folder)


for _mutant in MUTANTS:
    checks(partial(mutate, *_mutant))
