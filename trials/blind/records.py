"""Sampled records of force and displacement, and their reduction to amplitudes and phase."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike

from .design import apparent_modulus, head_stiffness
from .rig import Response
from .strength import Scatter

History = tuple[ArrayLike, ArrayLike, ArrayLike]  # time [s], force [N], displacement [m]


@dataclass(frozen=True)
class Sampling:
    """rate [Hz]; cycles per record; noise (standard deviation), offset, drift over the amplitude."""

    rate: float = 4000.0
    cycles: int = 10
    noise: float = 2e-3
    offset: float = 0.05
    drift: float = 0.05


def sample(
    response: Response, displacement: np.ndarray, slider: float, sampling: Sampling, rng: np.random.Generator
) -> list[pd.DataFrame]:
    """One record per test: time_s, force_N, displacement_m. displacement [m]: amplitude at the head.

    The slider pushes against the velocity with constant force: a square wave, not its first harmonic.
    """
    records = []
    for n, frequency in enumerate(response.frequency):
        turn = np.exp(-1j * response.channel[n])
        rest = response.ratio[n] * turn - response.sliding[n]
        time = np.arange(round(sampling.cycles / frequency * sampling.rate)) / sampling.rate
        wave = np.exp(2j * np.pi * frequency * time)
        force = displacement[n] * (rest * wave).imag + slider * np.sign(wave.real)
        shown = displacement[n] * (turn * wave).imag
        records.append(
            pd.DataFrame(
                {
                    "time_s": time,
                    "force_N": _spoil(force, sampling, rng),
                    "displacement_m": _spoil(shown, sampling, rng),
                }
            )
        )
    return records


def _spoil(signal: np.ndarray, sampling: Sampling, rng: np.random.Generator) -> np.ndarray:
    """Noise, an offset and a linear drift, all in proportion to the signal's amplitude."""
    size = 0.5 * np.ptp(signal)
    offset, drift = rng.uniform(-1.0, 1.0, 2) * (sampling.offset, sampling.drift)
    noise = sampling.noise * rng.standard_normal(signal.size)
    return signal + size * (offset + drift * np.linspace(0.0, 1.0, signal.size) + noise)


def reduce_record(
    time: ArrayLike, force: ArrayLike, displacement: ArrayLike, frequency: float
) -> tuple[float, float, float]:
    """F0 [N], z0 [m], psi [rad] (force leading) by least squares with offset and drift; frequency [Hz]."""
    angle = 2.0 * np.pi * frequency * np.asarray(time, dtype=float)
    basis = np.stack([np.sin(angle), np.cos(angle), np.ones_like(angle), np.linspace(-1.0, 1.0, angle.size)])
    # Unit sums of squares are enough conditioning for four columns.
    solution = np.linalg.solve(basis @ basis.T, basis @ np.stack([force, displacement], axis=1))
    f, z = solution[0] + 1j * solution[1]
    return float(abs(f)), float(abs(z)), float(np.angle(f / z))


def reduce_records(records: Iterable[History], frequencies: Iterable[float]) -> pd.DataFrame:
    """F0_N, z0_m, psi_deg of each record at its true frequency [Hz]."""
    rows = [reduce_record(*record, frequency) for record, frequency in zip(records, frequencies, strict=True)]
    table = pd.DataFrame(rows, columns=["F0_N", "z0_m", "psi_deg"])
    return table.assign(psi_deg=np.degrees(table["psi_deg"]))


def measure(
    tests: pd.DataFrame,
    histories: Iterable[History],
    geometry: dict[str, float],
    seed: int,
    scatter: Scatter | None = None,
    cycles: int = 2,
) -> pd.DataFrame:
    """The measurement table of simulated tests in whose rig the effect already sits.

    tests: specimen, temperature_C, frequency_Hz and whatever else the table shall keep; histories: time
    [s], force [N], displacement [m] of each. The last `cycles` cycles are reduced; only scatter is added.
    """
    rng = np.random.default_rng(seed)
    scatter = scatter or Scatter()
    frequency = tests["frequency_Hz"].to_numpy(float)
    ends = [_last_cycles(history, f, cycles) for history, f in zip(histories, frequency, strict=True)]
    peaks = reduce_records(ends, frequency)
    stiffness = peaks["F0_N"] / peaks["z0_m"] * np.exp(1j * np.radians(peaks["psi_deg"]))
    modulus = apparent_modulus(geometry, frequency, stiffness) * scatter_factor(
        tests["specimen"], scatter, rng
    )
    stiffness = head_stiffness(geometry, frequency, modulus)
    peaks["F0_N"], peaks["psi_deg"] = np.abs(stiffness) * peaks["z0_m"], np.degrees(np.angle(stiffness))
    return pd.concat([tests.reset_index(drop=True), peaks], axis=1)


def scatter_factor(specimens: pd.Series, scatter: Scatter, rng: np.random.Generator) -> np.ndarray:
    """One complex factor on E* per test: specimen scale, and scatter of modulus and phase."""
    names, code = np.unique(specimens.to_numpy(), return_inverse=True)
    scale = scatter.specimen * rng.standard_normal(names.size)[code]
    modulus, phase = rng.standard_normal((2, code.size))
    return np.exp(scale + scatter.modulus * modulus + 1j * np.radians(scatter.phase_deg) * phase)


def _last_cycles(history: History, frequency: float, cycles: int) -> History:
    time = np.asarray(history[0], dtype=float)
    step = (time[-1] - time[0]) / (time.size - 1)
    count = min(time.size, round(cycles / frequency / step))
    return tuple(np.asarray(values, dtype=float)[-count:] for values in (time, *history[1:]))
