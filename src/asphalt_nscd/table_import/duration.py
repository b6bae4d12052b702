"""How long a study will take, from the times of the paper study on two cores of 2.1 GHz."""

from __future__ import annotations

from collections.abc import Sequence

from asphalt_nscd.measurements.kinds import FITTED_STEPS

# CPU times. Those of a test are in reduced coordinates, whose number does not go with that of the spheres.
SECONDS_PER_SPHERE = 974 / (4 * 14160)  # pouring
SECONDS_PER_STEP = 4e-6  # between 3500 and 76000 steps
SECONDS_PER_TEST = 1.7  # start of a job
SECONDS_APART = 240  # compilation, figures, report
CYCLES, REST_STEPS = 5, 1000
CHANGED_LAWS = 8  # four parameters, each lowered and raised
CORES = 2


def steps_of_a_test(frequency: float, time_step: float | None) -> float:
    """Time steps of a test at a frequency [Hz], by a time step [s] or, if None, by a scheme fitted to the frequency."""
    return (CYCLES * FITTED_STEPS if time_step is None else CYCLES / (frequency * time_step)) + REST_STEPS


def duration(
    spheres: int, samples: int, temperatures: int, frequencies: Sequence[float], time_step: float | None
) -> str:
    """How long a study will take on two cores, as `about 20 minutes`; steps are those of `steps_of_a_test`.

    Every test runs twice, as it is and extended by the diagnosis, and those of one temperature once more for each
    changed parameter.
    """
    # Each temperature twice: with the laws measured, and with the law that the diagnosis names.
    isotherms = 2 * temperatures + CHANGED_LAWS
    steps = sum(steps_of_a_test(frequency, time_step) for frequency in frequencies)
    testing = steps * SECONDS_PER_STEP + SECONDS_PER_TEST * len(frequencies)
    seconds = (samples * (spheres * SECONDS_PER_SPHERE + isotherms * testing) + SECONDS_APART) / CORES
    if seconds < 5400:
        return f"about {max(1, round(seconds / 60))} minutes"
    return f"about {seconds / 3600:.1f} hours"
