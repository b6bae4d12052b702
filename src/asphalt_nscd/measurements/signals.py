"""Amplitude and phase of sampled force and displacement records."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from asphalt_nscd.files.errors import InputError

WINDOW = 10.0  # s: the paper reduces "the last ten seconds of each test"
SAMPLES_PER_CYCLE = 8  # fewer cannot show a peak, nor a harmonic apart from its first overtone
STEPS_PER_CYCLE = 20  # of a simulated test
STEP_TOLERANCE = 0.5  # share of the sampling step: admits times rounded in print, not a missing sample
SINUSOID_SHARE = 0.9  # of the displacement's variance that the harmonic must explain

Vector = NDArray[np.float64]


def require_steps(time_step: float, frequency: float) -> None:
    """Refuse a time step [s] of fewer than STEPS_PER_CYCLE at the frequency [Hz], too coarse to simulate a test."""
    if STEPS_PER_CYCLE * time_step * frequency > 1.0:
        most = 1.0 / (STEPS_PER_CYCLE * frequency)
        digit = 10.0 ** (np.floor(np.log10(most)) - 2.0)  # the third one, down
        raise InputError(
            f"time step {time_step:g} s: fewer than {STEPS_PER_CYCLE} steps per cycle at {frequency:g} Hz; "
            f"give at most {np.floor(most / digit * (1.0 + 1e-9)) * digit:.3g} s."
        )


@dataclass(frozen=True)
class Response:
    """Amplitudes F0 [N] and z0 [m] of a record, and the phase Psi by which the force leads [rad]."""

    force_amplitude: float
    displacement_amplitude: float
    phase: float


def harmonic_response(
    time: ArrayLike, force: ArrayLike, displacement: ArrayLike, frequency: float, cycles: int | None = None
) -> Response:
    """Least-squares fit of offset, linear drift, cosine and sine to the last whole cycles.

    `time` [s], `force` [N] and `displacement` [m] are (n,), `frequency` in Hz. `cycles` counts those of the window;
    None takes the whole cycles of the last ten seconds. Refuses records too short, or too coarse.

    >>> time = np.arange(2000) / 1000
    >>> force = 100 * np.sin(2 * np.pi * 10 * time + 0.3)
    >>> displacement = 6e-5 * np.sin(2 * np.pi * 10 * time)
    >>> response = harmonic_response(time, force, displacement, frequency=10.0)
    >>> print(f"{response.force_amplitude:.1f} N, {response.phase:.4f} rad")
    100.0 N, 0.3000 rad
    """
    window = _window(time, force, displacement, frequency, cycles)
    phase = 2.0 * np.pi * frequency * window.time
    centred = window.time - window.time.mean()
    # Offset and drift: five cycles from rest are not steady where the Maxwell time is long (1.6 s at -10 degC).
    basis = np.column_stack(
        [np.ones_like(phase), centred / np.ptp(window.time), np.cos(phase), np.sin(phase)]
    )
    signals = np.column_stack([window.force, window.displacement])
    # Scaled to unit range, so that newtons and micrometres are solved with the same relative accuracy.
    scale = np.maximum(np.ptp(signals, axis=0), np.finfo(float).tiny)
    solution = np.linalg.lstsq(basis, signals / scale, rcond=None)[0]
    _require_sinusoid(window.displacement / scale[1], basis, solution[:, 1], frequency)
    force_complex, displacement_complex = (solution[2] - 1j * solution[3]) * scale
    ratio = force_complex / displacement_complex
    return Response(float(abs(force_complex)), float(abs(displacement_complex)), float(np.angle(ratio)))


def peak_response(
    time: ArrayLike, force: ArrayLike, displacement: ArrayLike, frequency: float, cycles: int | None = None
) -> Response:
    """Peak picking as in the paper: sampled extremes of each cycle, phase from the lag of the maxima.

    Arguments and units are those of `harmonic_response`. Amplitudes are half the range within a cycle; values of all
    cycles in the window are averaged. Nothing is interpolated, so the phase comes in steps of 2 pi frequency dt, and
    drift within a cycle stays in the result.

    >>> time = np.arange(2000) / 1000
    >>> force = 100 * np.sin(2 * np.pi * 10 * time + 0.3)
    >>> displacement = 6e-5 * np.sin(2 * np.pi * 10 * time)
    >>> response = peak_response(time, force, displacement, frequency=10.0)
    >>> print(f"{response.phase:.4f} rad")  # five samples of 0.0628
    0.3142 rad
    """
    window = _window(time, force, displacement, frequency, cycles)
    # A last sample that rounds up would begin a cycle of its own.
    cycle = np.minimum((window.time - window.time[0]) * frequency, window.cycles - 0.5).astype(int)
    amplitudes, lags = [], []
    for number in range(window.cycles):
        inside = cycle == number
        t, f, z = window.time[inside], window.force[inside], window.displacement[inside]
        amplitudes.append((0.5 * np.ptp(f), 0.5 * np.ptp(z)))
        lags.append(t[np.argmax(z)] - t[np.argmax(f)])
    force_amplitude, displacement_amplitude = np.mean(amplitudes, axis=0)
    # Mean on the circle: a maximum at the rim of a cycle is found at one end or the other.
    phase = np.angle(np.mean(np.exp(2j * np.pi * frequency * np.array(lags))))
    return Response(float(force_amplitude), float(displacement_amplitude), float(phase))


@dataclass(frozen=True)
class _Window:
    time: Vector
    force: Vector
    displacement: Vector
    cycles: int


def _window(
    time: ArrayLike, force: ArrayLike, displacement: ArrayLike, frequency: float, cycles: int | None
) -> _Window:
    """The last whole cycles of a record, `cycles` of them or those of WINDOW; refuses one too short or too coarse."""
    time, force, displacement = (np.asarray(v, dtype=float) for v in (time, force, displacement))
    _require_samples(time, force, displacement)
    step = _uniform_step(time)
    if not np.isfinite(frequency) or frequency <= 0:
        raise InputError(f"the frequency {frequency:g} Hz is not positive; give the frequency of the test.")
    samples_per_cycle = 1.0 / (frequency * step)
    if samples_per_cycle < SAMPLES_PER_CYCLE - 1e-6:
        raise InputError(
            f"the record has {samples_per_cycle:.1f} samples per cycle of {frequency:g} Hz; "
            f"sample at least {SAMPLES_PER_CYCLE} times per cycle, or check the frequency."
        )
    # Half a sample of grace: n samples stand for n steps, and a cycle need not be a whole number of them.
    available = int((time.size + 0.5) / samples_per_cycle)
    wanted = max(1, int(WINDOW * frequency * (1 + 1e-9))) if cycles is None else cycles
    required = 1 if cycles is None else cycles
    if required < 1:
        raise InputError(f"a window of {cycles} cycles holds no cycle; give at least one.")
    if available < required:
        raise InputError(
            f"the record lasts {time.size / samples_per_cycle:.2f} cycles of {frequency:g} Hz, "
            f"{required} needed; record longer or check the frequency."
        )
    count = min(wanted, available)
    first = time.size - min(time.size, round(count * samples_per_cycle))
    return _Window(time[first:], force[first:], displacement[first:], count)


def _require_samples(time: Vector, force: Vector, displacement: Vector) -> None:
    """Refuse channels that differ in length, hold less than a cycle, are not finite or do not vary."""
    if time.ndim != 1 or not time.shape == force.shape == displacement.shape:
        raise InputError("time, force and displacement differ in length; give all three for every sample.")
    if time.size < SAMPLES_PER_CYCLE:
        raise InputError(f"the record holds {time.size} samples; give at least one whole cycle.")
    for name, values in (("time", time), ("force", force), ("displacement", displacement)):
        bad = np.flatnonzero(~np.isfinite(values))
        if bad.size:
            raise InputError(f"{name} of sample {bad[0] + 1} is not a finite number; mend or remove it.")
    for name, values in (("force", force), ("displacement", displacement)):
        if np.ptp(values) == 0:
            raise InputError(f"the {name} does not vary; check that the right channel was recorded.")


def _uniform_step(time: Vector) -> float:
    """Sampling step [s]; refuses time that runs backwards or has gaps."""
    steps = np.diff(time)
    backwards = np.flatnonzero(steps <= 0)
    if backwards.size:
        raise InputError(f"time does not increase at sample {backwards[0] + 2}; sort the record by time.")
    ordered = np.sort(steps)
    usual = (
        ordered[(steps.size - 1) // 2] + ordered[steps.size // 2]
    ) / 2.0  # np.median would load masked arrays
    uneven = np.flatnonzero(np.abs(steps / usual - 1.0) > STEP_TOLERANCE)
    if uneven.size:
        raise InputError(
            f"time is not sampled evenly at sample {uneven[0] + 2} (step {steps[uneven[0]]:.3g} s, "
            f"elsewhere {usual:.3g} s); resample the record."
        )
    # Over the whole record the rounding of printed times averages out.
    return float((time[-1] - time[0]) / steps.size)


def _require_sinusoid(values: Vector, basis: NDArray[np.float64], solution: Vector, frequency: float) -> None:
    """Refuse a displacement that is not mainly a sinusoid of the stated frequency."""
    left = np.sum((values - basis @ solution) ** 2)
    trend = basis[:, :2]
    varying = np.sum((values - trend @ np.linalg.lstsq(trend, values, rcond=None)[0]) ** 2)
    explained = 1.0 - left / varying
    if explained < SINUSOID_SHARE:
        raise InputError(
            f"a sinusoid of {frequency:g} Hz explains only {100 * max(0.0, explained):.0f} % of the variation of the "
            "displacement; check the frequency and the channel."
        )
