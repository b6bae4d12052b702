"""The complex modulus test on a numerical specimen, condensed before."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from asphalt_nscd.bending import runs
from asphalt_nscd.bending.case import LoadCase, RunOptions, require_possible
from asphalt_nscd.bending.excerpt import ModelExcerpt, read_excerpt
from asphalt_nscd.bending.layers import LayerHeights
from asphalt_nscd.bending.rig import Rig, read_rig
from asphalt_nscd.bending.settings import Numerics
from asphalt_nscd.bending.taring import soft_clamp, tared
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.store import save
from asphalt_nscd.files.words import counted
from asphalt_nscd.measurements.shape import Shape
from asphalt_nscd.measurements.signals import Response, harmonic_response, peak_response, require_steps
from asphalt_nscd.measurements.twopoint import norm_and_phase
from asphalt_nscd.nscd.bonds.law import BondLaw
from asphalt_nscd.rheology.burgers import Burgers
from asphalt_nscd.rheology.chain import KelvinChain
from asphalt_nscd.rheology.laws_io import read_bond_law

if TYPE_CHECKING:  # sparse matrices, which take as long to import as most tests to run
    from asphalt_nscd.bending.model import Model

REDUCED_CYCLES = 2  # the last ones, for the harmonic fit; the paper's peaks are those of the last cycle
FRAMES = "frames"  # group of the file with what all spheres and bonds do
PROFILE_SAMPLES = 200  # of the mean velocity against height over the last cycle, Fig. 8


def bond_law(law: Burgers | KelvinChain) -> BondLaw:
    """Give every bond the macroscopic law, as moduli and viscosities per geometry of the bond (Eqs. 30-33)."""
    chain = law.kelvin_form() if isinstance(law, Burgers) else law
    return BondLaw(
        chain.spring, chain.dashpot, np.array(chain.kelvin_springs), np.array(chain.kelvin_dashpots)
    )


@dataclass
class Record:
    """What one test gives: its histories and how they were obtained.

    `time` (s,) in s from the start of the oscillation; `displacement` (s,) of the channel in m; `force` (s,) of the
    actuator in N; `velocity` (s, l) in m/s, means over the layers; `broken` in the order of breaking; `frames` at the
    times of `Numerics.framed`. `residual` is that of the full equations, of "sweeps" the relative change of the last
    sweep, and NaN where nothing is checked. `ended` says why a record is shorter than asked.
    """

    time: np.ndarray
    displacement: np.ndarray
    force: np.ndarray
    broken: list[int]
    residual: float
    details: dict[str, float | int]
    velocity: np.ndarray | None = None
    frames: Sequence[runs.Frame] = ()
    ended: str = ""


def run_test(
    model: Model | ModelExcerpt,
    law: BondLaw,
    case: LoadCase,
    numerics: Numerics = Numerics(),
    options: RunOptions = RunOptions(),
) -> Record:
    """Apply gravity for the steps at rest, then the load case at the actuator; the record begins with the load case.

    The actuator is the head itself but for the rig; the record is that of the rig's channel. ArithmeticError or
    InputError where the motion cannot be followed, as of a specimen in two pieces, unless the options keep the record.
    """
    require_possible(case, numerics, options)
    if case.by_force:
        return _force_run(model.whole, law, case, numerics, options)
    times, rest = case.times(numerics), numerics.rest_steps
    displacement = case.recorded(times)
    if numerics.method == "harmonic":
        return Record(times, displacement, _steady_force(model.whole, law, case, times), [], np.nan, {})
    if numerics.method == "reduced":
        run = runs.reduced(model, law, case, numerics, options)
    else:
        full = runs.sweeps if numerics.method == "sweeps" else runs.condensed
        run = full(model.whole, law, case, numerics, options)
    force, velocity = run.force[rest:], run.velocity[rest:]
    if run.ended and not force.size:
        raise InputError(run.ended)
    made = slice(force.size)
    followed = run.residual, run.details, velocity, run.frames, run.ended
    return Record(times[made], displacement[made], force, run.broken, *followed)


def _force_run(model: Model, law: BondLaw, case: LoadCase, numerics: Numerics, options: RunOptions) -> Record:
    """The actuator moves a clamp so soft that it commands the force; what the clamp takes of its motion is left out."""
    clamp = soft_clamp(model, abs(law.discrete_modulus(case.omega, 0.0)))
    # a clamp far softer than the specimen turns its displacement into a force, so that one balance of the
    # head serves both controls
    pulled = replace(case, amplitude=clamp * case.amplitude, rig=Rig(clamp_compliance=clamp), by_force=False)
    record = run_test(tared(model), law, pulled, numerics, options)
    # energies are those of the soft clamp
    details = {name: value for name, value in record.details.items() if not name.startswith("energy_")}
    return replace(record, displacement=record.displacement - clamp * record.force, details=details)


def _steady_force(model: Model, law: BondLaw, case: LoadCase, times: np.ndarray) -> np.ndarray:
    """Force (s,) [N] of the actuator in the steady oscillation of the unbroken system."""
    from asphalt_nscd.nscd.stepping import harmonic

    omega = case.omega
    stiffness = harmonic.driving_force(
        model.system, law.discrete_modulus(omega, 0.0), omega, static=model.static_factor
    )
    amplitude = case.amplitude * harmonic.actuator_stiffness(stiffness, case.rig, omega)
    return (amplitude * np.exp(1j * omega * times)).imag  # the drive is a sine


def read_subject(model_file: str | Path, excerpt_file: str | Path | None = None) -> Model | ModelExcerpt:
    """Read the model made by `condense`, or its excerpt, which reads the model only where a test needs it."""
    if excerpt_file is not None:
        return read_excerpt(excerpt_file, model_file)
    from asphalt_nscd.bending.model import read_model

    return read_model(model_file)


@dataclass(frozen=True)
class TestFiles:
    """Files that a test reads and writes.

    `model` and `output` are HDF5 files; `law` (of the bonds) and `rig` are JSON; without `rig` the rig is ideal.
    `law_source` is kept with the result.
    """

    __test__ = False  # not one of pytest's

    model: str | Path
    law: str | Path
    output: str | Path
    rig: str | Path | None = None
    law_source: str = ""


def simulate(
    files: TestFiles,
    temperature: float,
    case: LoadCase,
    numerics: Numerics = Numerics(),
    options: RunOptions = RunOptions(),
    model: Model | ModelExcerpt | None = None,
) -> dict[str, Any]:
    """Run one test from files to a file: |E*| and phase by harmonic fit and by the paper's peak picking.

    `temperature` of the law in degC; `model` is what `files.model` holds, or its excerpt, where that has been read
    already.
    """
    law = read_bond_law(files.law, temperature, [case.frequency])
    case = replace(case, rig=Rig() if files.rig is None else read_rig(files.rig))
    model = read_subject(files.model) if model is None else model
    arrays, columns = outcome(model, law, temperature, case, numerics, options)
    columns["law_source"] = files.law_source
    if files.rig is not None:
        columns |= case.rig.columns()
    save(files.output, "test", arrays, columns)
    return columns


def told(columns: Mapping[str, Any]) -> str:
    """Say in one line |E*|, the phase and the number of bonds that broke in a test, or why it ended."""
    if "ended" in columns:
        return f"{columns['temperature_C']:g} degC, {columns['frequency_Hz']:g} Hz: {columns['ended']}"
    words = (
        f"{columns['temperature_C']:g} degC, {columns['frequency_Hz']:g} Hz: |E*| = {columns['E_MPa']:.4g} MPa, "
        f"phase {columns['phase_deg']:.2f} deg; law {columns['E_law_MPa']:.4g} MPa, "
        f"{columns['phase_law_deg']:.2f} deg"
    )
    if columns["broken_bonds"]:
        words += f", {columns['broken_bonds']} of {counted(columns['bonds'], 'bond')} broke"
    return words


def ended(why: str, times: np.ndarray, asked: float) -> str:
    """A sentence on a record that ends early, after `times` (n,) [s] of those asked [s]."""
    return f"the record ends after {times[-1]:.4g} of {asked:g} s: {why}"


def damage(columns: Mapping[str, Any]) -> str:
    """Say in one sentence what to make of a test that broke bonds."""
    return (
        f"{columns['broken_bonds']} of {counted(columns['bonds'], 'bond')} broke at an amplitude of "
        f"{1e6 * columns['amplitude_m']:.3g} um: E* is that of a damaged specimen; lower the amplitude, or raise the "
        "strength of the bonds."
    )


def unsettled(columns: Mapping[str, Any]) -> str:
    """A sentence on sweeps that ended before they had settled; empty for any other test."""
    if "ended" in columns or columns["method"] != "sweeps" or columns["residual"] < columns["tolerance"]:
        return ""
    return (
        f"the sweeps did not settle: the last of {columns['most_sweeps']} in a step still changed the reactions by a "
        f"residual of {columns['residual']:.2g}, where {columns['tolerance']:g} was asked for, so E* is not that of "
        "the specimen; allow more sweeps, or choose the method reduced."
    )


def outcome(
    model: Model | ModelExcerpt,
    law: Burgers | KelvinChain,
    temperature: float,
    case: LoadCase,
    numerics: Numerics = Numerics(),
    options: RunOptions = RunOptions(),
) -> tuple[dict[str, np.ndarray], dict[str, Any]]:
    """Run one test in memory (see `simulate`): arrays and attributes of its file; `temperature` in degC."""
    cycles, time_step, frequency = case.cycles, numerics.time_step, case.frequency
    if cycles < 1.0:
        raise InputError(f"cycles = {cycles:g}: the reduction needs a whole cycle; run at least one.")
    require_steps(time_step, frequency)
    try:
        record = run_test(model, bond_law(law), case, numerics, replace(options, keeps_record=True))
    except ArithmeticError as error:
        raise InputError(
            f"{model.name} at {frequency:g} Hz: {error}; lower the amplitude or choose another method."
        ) from None
    history = record.time, record.force, record.displacement, frequency
    steady = peak = Response(np.nan, np.nan, np.nan)
    if not record.ended:
        # the first cycles hold the transient of the Maxwell dashpot and of the start from rest
        steady = harmonic_response(*history, cycles=min(REDUCED_CYCLES, int(cycles)))
        # the paper's way: maxima carry the drift of the Maxwell dashpot, which the fit takes off
        peak = peak_response(*history, cycles=1)
    columns: dict[str, Any] = {
        "specimen": model.name,
        "temperature_C": temperature,
        "frequency_Hz": frequency,
        "spheres": model.spheres,
        "bonds": model.bonds,
        "broken_bonds": len(record.broken),
        "steps": record.time.size,
    }
    moduli = {
        "": _modulus(model.geometry, frequency, steady),
        "_peak": _modulus(model.geometry, frequency, peak),
        "_law": complex(law.complex_modulus(2.0 * np.pi * frequency)),
    }
    for suffix, modulus in moduli.items():
        norm, phase = norm_and_phase(modulus)
        columns |= {f"E{suffix}_MPa": float(norm) / 1e6, f"phase{suffix}_deg": float(np.degrees(phase))}
    columns |= {
        "residual": record.residual,
        "method": numerics.method,
        "head": model.head,
        "law_source": "",
        "time_step_s": time_step,
        "amplitude_m": steady.displacement_amplitude if case.by_force else case.amplitude,
        **({"amplitude_N": case.amplitude} if case.by_force else {}),
        **record.details,
        **({} if numerics.scheme == "euler" else {"scheme": numerics.scheme}),
        **({"ended": ended(record.ended, record.time, cycles / frequency)} if record.ended else {}),
    }
    arrays = {
        "time_s": record.time,
        "displacement_m": record.displacement,
        "force_N": record.force,
        "broken": np.asarray(record.broken, np.int64),
        **_velocity_profile(model.layers, record, frequency),
    }
    if record.frames:
        times = record.time[case.framed(numerics, options.frames)[: len(record.frames)]]
        arrays |= {
            f"{FRAMES}/{name}": values for name, values in framed(model.whole, times, record.frames).items()
        }
    return arrays, columns


def _modulus(shape: Shape, frequency: float, response: Response) -> complex:
    return complex(
        shape.complex_modulus(
            frequency, response.force_amplitude, response.displacement_amplitude, response.phase
        )
    )


def framed(model: Model, times: np.ndarray, frames: Sequence[runs.Frame]) -> dict[str, np.ndarray]:
    """Spheres and bonds as they stand, and in single precision what they do at each time (f,) [s]."""
    n = model.spheres

    def sphere_motion(motion: np.ndarray) -> np.ndarray:
        return np.asarray(motion[: 6 * n].reshape(n, 6)[:, :3], np.float32)

    return model.shape | {
        "strength_N": model.system.strength,
        "time_s": times,
        "displacement_m": np.array([sphere_motion(frame.displacement) for frame in frames]),
        "velocity_m_s": np.array([sphere_motion(frame.velocity) for frame in frames]),
        # Tension is positive; the other two are the shear in the frame of the bond.
        "bond_force_N": np.array(
            [np.float32(frame.reaction.reshape(-1, 3) * [-1.0, 1.0, 1.0]) for frame in frames]
        ),
    }


def _velocity_profile(layers: LayerHeights, record: Record, frequency: float) -> dict[str, np.ndarray]:
    """Mean velocity of the spheres along the drive in layers of equal height, over the last cycle."""
    if record.velocity is None:
        return {}
    # one whole cycle, however its start rounds: Fig. 8 compares the means of layers at equal phases
    last = np.flatnonzero(record.time > record.time[-1] - (1.0 - 1e-9) / frequency)
    taken = last[np.linspace(0, last.size - 1, min(PROFILE_SAMPLES, last.size)).astype(int)]
    return {
        "profile/height_m": layers.height,
        "profile/spheres": layers.spheres,
        "profile/time_s": record.time[taken],
        "profile/velocity_m_s": np.where(layers.spheres > 0, record.velocity[taken], np.nan),
    }
