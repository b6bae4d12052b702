"""How long a study will take, from the times of the paper study on two cores of 2.1 GHz."""

from __future__ import annotations

from collections.abc import Sequence

SECONDS_PER_SPHERE = 983 / (4 * 14160)  # CPU time of pouring
SECONDS_PER_STEP = 373 / (122 * 14300)  # CPU time of a test on 14160 spheres, in proportion to them
SECONDS_PER_TEST = 1.5  # start of a job
CYCLES, REST_STEPS = 5, 1000
SPHERES = 14160
CHANGED_LAWS = 8  # four parameters, each lowered and raised
CORES = 2


def duration(
    spheres: int, samples: int, temperatures: int, frequencies: Sequence[float], time_step: float
) -> str:
    """`about 20 minutes`, for two cores.

    Every test runs twice, as it is and extended by the diagnosis, and those of one temperature once
    more for each changed parameter.
    """
    isotherms = 2 * temperatures + CHANGED_LAWS
    steps = sum(CYCLES / (frequency * time_step) + REST_STEPS for frequency in frequencies)
    testing = steps * SECONDS_PER_STEP * spheres / SPHERES + SECONDS_PER_TEST * len(frequencies)
    seconds = samples * (spheres * SECONDS_PER_SPHERE + isotherms * testing) / CORES + 120
    if seconds < 5400:
        return f"about {max(1, round(seconds / 60))} minutes"
    return f"about {seconds / 3600:.1f} hours"
