"""The complex modulus test on a numerical specimen, condensed before."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from asphalt_nscd.bending.checkpoint import Checkpoint, digest
from asphalt_nscd.bending.excerpt import ModelExcerpt, read_excerpt
from asphalt_nscd.bending.layers import LayerHeights, Layers
from asphalt_nscd.bending.rig import Rig, read_rig
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.store import save
from asphalt_nscd.measurements.signals import harmonic_response, peak_response, require_steps
from asphalt_nscd.measurements.twopoint import Geometry, complex_modulus, norm_and_phase
from asphalt_nscd.nscd.bonds.law import BondLaw
from asphalt_nscd.nscd.stepping.reduced_stepping import FullSystemNeeded, ReducedStepper
from asphalt_nscd.nscd.stepping.scheme import Scheme
from asphalt_nscd.rheology.burgers import Burgers
from asphalt_nscd.rheology.chain import KelvinChain
from asphalt_nscd.rheology.laws_io import read_bond_law

if TYPE_CHECKING:  # sparse matrices, imported below where a test needs them: that takes as long as most tests
    from asphalt_nscd.bending.model import Model
    from asphalt_nscd.nscd.stepping.condensed import CondensedStepper
    from asphalt_nscd.nscd.stepping.gauss_seidel_stepping import SweepingStepper

METHODS = ("reduced", "condensed", "sweeps", "harmonic")
RESIDUAL_TOLERANCE = 1e-6  # of the full equations, relative to the load of the head
REDUCED_CYCLES = 2  # the last ones, for the harmonic fit; the paper's peaks are those of the last cycle
PROFILE_SAMPLES = 200  # of the mean velocity against height over the last cycle, Fig. 8

Progress = Callable[[int, int], None]
"""Called with (steps done, steps in all)."""


def bond_law(law: Burgers | KelvinChain) -> BondLaw:
    """The macroscopic law as the law of every bond (Eqs. 30-33, geometry divided out)."""
    chain = law.as_chain() if isinstance(law, Burgers) else law
    return BondLaw(
        chain.spring, chain.dashpot, np.array(chain.kelvin_springs), np.array(chain.kelvin_dashpots)
    )


@dataclass
class Record:
    """What one test gives: histories and how they were obtained."""

    time: np.ndarray  # (s,) s, from the start of the oscillation
    displacement: np.ndarray  # (s,) m
    force: np.ndarray  # (s,) N
    broken: list[int]
    residual: float  # of the full equations; relative change of the last sweep; NaN where nothing is checked
    details: dict[str, float | int]
    velocity: np.ndarray | None = None  # (s, l) m/s, means over the model's layers


def run_test(
    model: Model | ModelExcerpt, law: BondLaw, frequency: float, amplitude: float, cycles: float, time_step: float,
    rest_steps: int, method: str = "reduced", tolerance: float = 1e-4, most_sweeps: int = 50,
    progress: Progress = lambda done, total: None, rig: Rig = Rig(), scheme: str = "euler",
    energy: bool = False, checkpoint: Checkpoint | None = None,
) -> Record:  # fmt: skip
    """Gravity for rest_steps, then z = A sin(2 pi f t) at the actuator for the given number of cycles.

    frequency [Hz], amplitude [m], time_step [s]; tolerance and most_sweeps concern "sweeps" only.
    "harmonic" gives the steady oscillation of the unbroken system, without gravity or transient.
    scheme: one of nscd.scheme.SCHEMES, for "reduced" and "condensed"; energy: keep the energy account
    of a reduced run too, whose steps are then made one by one, as those of other schemes than "euler".
    checkpoint: from where the run, step by step then, goes on, and where it is kept; "reduced" and
    "condensed". The actuator is the head itself but for the rig; the record is that of the rig's channel.
    """
    if method == "harmonic" and rig.guide_friction:
        raise InputError("rig: a slider has no steady harmonic oscillation; choose the method reduced.")
    if scheme != "euler" and method not in ("reduced", "condensed"):
        raise InputError(
            f"method {method} knows no scheme {scheme!r}; choose the method reduced or condensed."
        )
    if checkpoint is not None and method not in ("reduced", "condensed"):
        raise InputError(f"method {method} keeps no checkpoint; choose the method reduced or condensed.")
    if method == "sweeps" and not rig.is_rigid:
        raise InputError(
            "rig: Gauss-Seidel on bonds knows no devices at the head; choose the method reduced."
        )
    steps = round(cycles / frequency / time_step)
    times = time_step * np.arange(1, steps + 1)
    omega = 2.0 * np.pi * frequency
    driven = np.concatenate([np.zeros(rest_steps), amplitude * np.sin(omega * times)])
    recorded = omega * (times - rig.channel_delay) - rig.phase_offset
    displacement = np.where(recorded > 0.0, amplitude * np.sin(recorded), 0.0)
    if method == "harmonic":
        from asphalt_nscd.nscd.stepping import harmonic

        stiffness = harmonic.driving_force(model.whole.system, law.discrete_modulus(omega, 0.0), omega)
        amplitude_of_force = amplitude * harmonic.actuator_stiffness(stiffness, rig, omega)
        force = (amplitude_of_force * np.exp(1j * omega * times)).imag
        return Record(times, displacement, force, [], np.nan, {})
    if method == "sweeps":
        from asphalt_nscd.nscd.stepping.condensed import CondensedState
        from asphalt_nscd.nscd.stepping.gauss_seidel_stepping import SweepingStepper

        whole = model.whole
        state = CondensedState.at_rest(whole.system, law)
        stepper = SweepingStepper(whole.system, law, time_step, state, tolerance, most_sweeps)
        force, velocity = _march(stepper, driven, 0.0, time_step, whole.layers, progress)
        broken, residual = state.broken, stepper.largest_change
        details = {"sweeps": stepper.sweeps, "tolerance": tolerance, "most_sweeps": most_sweeps}
    elif method == "reduced" and scheme == "euler" and not energy and checkpoint is None:
        force, velocity, broken, residual, details = _run_reduced(
            model, law, time_step, driven, rig, progress
        )
    else:
        from asphalt_nscd.bending.stepwise import condensed_steps, reduced_steps

        coefficients, whole = Scheme.named(scheme, omega * time_step), model.whole
        if method == "condensed":
            steps = condensed_steps(
                whole.system, law, coefficients, time_step, driven, rig, whole.layers, progress,
                checkpoint,
            )  # fmt: skip
            residual, details = np.nan, {}
        else:
            stepper = _reduced_stepper(whole, law, time_step / coefficients.a, rig)
            steps = reduced_steps(
                stepper, law, coefficients, time_step, driven, whole.layers, progress, checkpoint
            )
            residual, details = _certified(stepper, steps.full_steps)
        force, velocity, broken = steps.force, steps.velocity, steps.broken
        details |= steps.energies.columns()
    return Record(
        times, displacement, force[rest_steps:], broken, residual, details, velocity[rest_steps:]
    )  # fmt: skip


def _run_reduced(
    model: Model | ModelExcerpt,
    law: BondLaw,
    time_step: float,
    driven: np.ndarray,
    rig: Rig,
    progress: Progress,
) -> tuple[np.ndarray, np.ndarray, list[int], float, dict[str, float | int]]:
    stepper = _reduced_stepper(model, law, time_step, rig)
    along = model.along
    full_steps = 0
    broken = stepper.state.broken
    try:
        force, coordinates = stepper.run(driven)
        velocity = coordinates @ along
    except FullSystemNeeded as accepted:
        from asphalt_nscd.nscd.stepping.condensed import CondensedStepper

        whole, done = model.whole, accepted.force.size
        state = stepper.full_state()
        rest, start = driven[done:], driven[done - 1] if done else 0.0
        full = CondensedStepper(whole.system, law, time_step, state, rig, start)
        further = _march(full, rest, start, time_step, whole.layers, progress, lambda: stepper.certify(full))
        force = np.concatenate([accepted.force, further[0]])
        velocity = np.concatenate([accepted.velocity @ along, further[1]])
        full_steps, broken = rest.size, state.broken
    progress(driven.size, driven.size)
    return force, velocity, broken, *_certified(stepper, full_steps)


def _reduced_stepper(model: Model | ModelExcerpt, law: BondLaw, time_step: float, rig: Rig) -> ReducedStepper:
    reduced, stand_by = model.reduced_form
    return ReducedStepper(reduced, law, time_step, RESIDUAL_TOLERANCE, devices=rig, stand_by=stand_by)


def _certified(stepper: ReducedStepper, full_steps: int) -> tuple[float, dict[str, float | int]]:
    """(residual, columns) of the certificate of a run, `full_steps` of which the full system made."""
    certificate = stepper.certificate()
    return certificate.largest_residual, {
        "largest_utilisation": certificate.largest_utilisation,
        "smallest_gap_m": certificate.smallest_gap,
        "enrichments": certificate.enrichments,
        "full_steps": full_steps,
    }


def _march(
    stepper: CondensedStepper | SweepingStepper, driven: np.ndarray, start: float, time_step: float,
    layers: Layers, progress: Progress, check: Callable[[], None] = lambda: None,
) -> tuple[np.ndarray, np.ndarray]:  # fmt: skip
    """Driving force (s,) and mean velocities of the layers (s, l); `check` is called after each step."""
    force, mean = np.empty(driven.size), np.empty((driven.size, layers.height.size))
    velocity = np.diff(driven, prepend=start) / time_step
    for n in range(driven.size):
        force[n] = stepper.advance(velocity[n])
        mean[n] = layers.mean @ stepper.state.velocity
        check()
        if n % 20 == 19:
            progress(n + 1, driven.size)
    return force, mean


def read_subject(model_file: str | Path, excerpt_file: str | Path | None = None) -> Model | ModelExcerpt:
    """What to test: a model made by `condense`, or its excerpt, which reads the model only where a test needs it."""
    if excerpt_file is not None:
        return read_excerpt(excerpt_file, model_file)
    from asphalt_nscd.bending.model import read_model

    return read_model(model_file)


def simulate(
    model_file: str | Path, law_file: str | Path, temperature: float, frequency: float, amplitude: float,
    cycles: float, time_step: float, rest_steps: int, output: str | Path, law_source: str = "",
    method: str = "reduced", tolerance: float = 1e-4, most_sweeps: int = 50,
    progress: Progress = lambda done, total: None, rig_file: str | Path | None = None, scheme: str = "euler",
    energy: bool = False, checkpoint_file: str | Path | None = None, checkpoint_every: int = 100,
    model: Model | ModelExcerpt | None = None,
) -> None:  # fmt: skip
    """One test from files to a file. |E*| and phase by harmonic fit and by the paper's peak picking.

    model: what `model_file` holds, or its excerpt, where that has been read already.
    """
    if cycles < 1.0:
        raise InputError(f"cycles = {cycles:g}: the reduction needs a whole cycle; run at least one.")
    require_steps(time_step, frequency)
    law = read_bond_law(law_file)
    rig = Rig() if rig_file is None else read_rig(rig_file)
    model = read_subject(model_file) if model is None else model
    checkpoint = None
    if checkpoint_file is not None:
        run = {
            "model": digest(model_file), "law": digest(law_file), "frequency_Hz": frequency,
            "amplitude_m": amplitude, "cycles": cycles, "time_step_s": time_step, "rest_steps": rest_steps,
            "method": method, "scheme": scheme, "rig": "" if rig_file is None else digest(rig_file),
        }  # fmt: skip
        checkpoint = Checkpoint(Path(checkpoint_file), checkpoint_every, run)
    began = time.process_time()
    try:
        record = run_test(
            model, bond_law(law), frequency, amplitude, cycles, time_step, rest_steps, method, tolerance,
            most_sweeps, progress, rig, scheme, energy, checkpoint,
        )  # fmt: skip
    except ArithmeticError as error:
        raise InputError(
            f"{model_file} at {frequency:g} Hz: {error}; lower the amplitude or choose another method."
        ) from None
    cpu = time.process_time() - began
    history = record.time, record.force, record.displacement, frequency
    steady = harmonic_response(*history, cycles=min(REDUCED_CYCLES, int(cycles)))
    peak = peak_response(*history, cycles=1)
    columns: dict[str, float | int | str] = {
        "specimen": model.name, "temperature_C": temperature, "frequency_Hz": frequency,
        "spheres": model.spheres, "bonds": model.bonds,
        "broken_bonds": len(record.broken), "steps": record.time.size,
    }  # fmt: skip
    moduli = {
        "": _modulus(model.geometry, frequency, steady),
        "_peak": _modulus(model.geometry, frequency, peak),
        "_law": complex(law.complex_modulus(2.0 * np.pi * frequency)),
    }
    for suffix, modulus in moduli.items():
        norm, phase = norm_and_phase(modulus)
        columns |= {f"E{suffix}_MPa": float(norm) / 1e6, f"phase{suffix}_deg": float(np.degrees(phase))}
    columns |= {
        "residual": record.residual, "cpu_s": cpu, "method": method, "head": model.head,
        "law_source": law_source, "time_step_s": time_step, "amplitude_m": amplitude, **record.details,
        **({} if rig_file is None else rig.columns()), **({} if scheme == "euler" else {"scheme": scheme}),
    }  # fmt: skip
    arrays = {
        "time_s": record.time, "displacement_m": record.displacement, "force_N": record.force,
        "broken": np.asarray(record.broken, np.int64), **_velocity_profile(model.layers, record, frequency),
    }  # fmt: skip
    save(output, "test", arrays, columns)
    if checkpoint is not None:
        checkpoint.drop()


def _modulus(geometry: Geometry, frequency: float, response) -> complex:
    return complex_modulus(
        geometry, frequency, response.force_amplitude, response.displacement_amplitude, response.phase
    )


def _velocity_profile(layers: LayerHeights, record: Record, frequency: float) -> dict[str, np.ndarray]:
    """Mean velocity of the spheres along the drive in layers of equal height, over the last cycle."""
    if record.velocity is None:
        return {}
    last = np.flatnonzero(record.time > record.time[-1] - 1.0 / frequency)
    taken = last[np.linspace(0, last.size - 1, min(PROFILE_SAMPLES, last.size)).astype(int)]
    return {
        "profile/height_m": layers.height,
        "profile/spheres": layers.spheres,
        "profile/time_s": record.time[taken],
        "profile/velocity_m_s": record.velocity[taken],
    }
