"""Calls from Python compute on one thread of BLAS, and leave the caller's number as it was."""

from __future__ import annotations

import subprocess
import sys

BEND = """
import asphalt_nscd as an
from threadpoolctl import threadpool_info, threadpool_limits
from asphalt_nscd.api import bending
threadpool_limits(3, user_api="blas")
seen, condense, test = set(), bending.condensed, bending.outcome
def looked(compute):
    def also(*given):
        made = compute(*given)
        seen.update(one["num_threads"] for one in threadpool_info() if one["user_api"] == "blas")
        return made
    return also
bending.condensed, bending.outcome = looked(condense), looked(test)
packing = an.pour({6.0: 260}, (0.1, 0.02, 0.1), vibration=an.Vibration(duration=0.0))
g = {"b_mm": 16, "B_mm": 24, "e_mm": 20, "h_mm": 100, "mass_kg": 0.1, "mobile_mass_kg": 0.1}
law = an.Law.burgers(Em_Pa=24e9, eta_m_Pa_s=4e9, Ek_Pa=48e9, eta_k_Pa_s=1e9, temperature_C=15)
an.bend(an.specimen(packing, g), law, 10.0, 15.0, load=an.Load(cycles=2.0))
print(seen, {one["num_threads"] for one in threadpool_info() if one["user_api"] == "blas"})
"""


def test_a_test_runs_on_one_thread_where_the_caller_has_three():
    done = subprocess.run([sys.executable, "-c", BEND], capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["{1}", "{3}"]
