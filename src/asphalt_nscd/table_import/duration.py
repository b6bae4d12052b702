"""How long a study will take, from the times of the paper study on two cores of 2.1 GHz."""

from __future__ import annotations

from collections.abc import Sequence

# CPU times. Those of a test are in reduced coordinates, whose number does not go with that of the spheres.
SECONDS_PER_SPHERE = 974 / (4 * 14160)  # pouring
SECONDS_PER_STEP = 4e-6  # between 3500 and 76000 steps
SECONDS_PER_TEST = 1.7  # start of a job
SECONDS_APART = 240  # compilation, figures, report
CYCLES, REST_STEPS = 5, 1000
CHANGED_LAWS = 8  # four parameters, each lowered and raised
CORES = 2


def duration(
    spheres: int, samples: int, temperatures: int, frequencies: Sequence[float], time_step: float
) -> str:
    """How long a study will take on two cores, as `about 20 minutes`; `frequencies` in Hz, `time_step` in s.

    Every test runs twice, as it is and extended by the diagnosis, and those of one temperature once more for each
    changed parameter.
    """
    # Each temperature twice: with the laws measured, and with the law that the diagnosis names.
    isotherms = 2 * temperatures + CHANGED_LAWS
    steps = sum(CYCLES / (frequency * time_step) + REST_STEPS for frequency in frequencies)
    testing = steps * SECONDS_PER_STEP + SECONDS_PER_TEST * len(frequencies)
    seconds = (samples * (spheres * SECONDS_PER_SPHERE + isotherms * testing) + SECONDS_APART) / CORES
    if seconds < 5400:
        return f"about {max(1, round(seconds / 60))} minutes"
    return f"about {seconds / 3600:.1f} hours"
