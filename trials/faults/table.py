"""The faults by kind, and what the user must be told."""

from __future__ import annotations

import signal

from faults import storage, surroundings
from faults.damaged import changed, cut, damaged, emptied, flipped, other_kind, without_its_last_line
from faults.ended import half_written, signalled, two_at_once, workflow_signalled
from faults.fault import ALL, CORE, DEPOSIT, DEPOSIT_LOG, MODEL, READ, SET_ASIDE, TEST, Fault
from faults.study import RESULTS
from faults.surroundings import CACHE, damaged_cache, no_cache, with_environment

SAMPLES = "pages/samples.html"
DECAYED = ("simulations.csv", "diagnosis/diagnosis.json", "figures/fig09.png", SAMPLES, ALL)


def standing() -> dict[str, list[Fault]]:
    """All faults by kind, but the SIGKILL in each rule."""
    return {
        "a job or Snakemake ended from outside": [
            signalled("SIGTERM", signal.SIGTERM, "error: the job was killed"),
            signalled("SIGINT", signal.SIGINT, "error: interrupted; nothing half-written is left."),
            workflow_signalled("SIGKILL", signal.SIGKILL, DEPOSIT, DEPOSIT_LOG),
            workflow_signalled("SIGTERM", signal.SIGTERM, DEPOSIT, DEPOSIT_LOG),
            workflow_signalled("SIGINT", signal.SIGINT, DEPOSIT, DEPOSIT_LOG),
            workflow_signalled("SIGKILL", signal.SIGKILL, ALL, "report.log"),
            Fault("half-written file left", half_written, None, DEPOSIT),
        ],
        "two Snakemakes at once": [Fault("two Snakemakes at once", two_at_once, "cannot be locked", DEPOSIT)],
        "a result cut, emptied, or with one bit flipped": [
            *(
                damaged(name, how, SET_ASIDE)
                for name in READ if name.endswith(".h5")
                for how in (cut, emptied, flipped)
            ),
            damaged(TEST, other_kind, r"error: \S+f10\.h5: expected a test file; found a model file"),
            *(
                damaged(name, how, SET_ASIDE)
                for name in READ if not name.endswith(".h5")
                for how in (cut, emptied, flipped, without_its_last_line)
            ),
            *(changed(name, SET_ASIDE, "edited") for name in READ),
            *(changed(name, SET_ASIDE, "decayed") for name in DECAYED),
        ],
        "no room, no right, no memory": [
            Fault("disk full", storage.full_disk, "error: .*s1.h5: no space left on device; free some space", DEPOSIT),
            Fault("results read-only", storage.read_only, rf"error: {RESULTS}/deposits: cannot be written to", DEPOSIT),
            Fault("file size limited", storage.no_larger_files, "error: .*file too large; raise the limit", DEPOSIT),
            Fault("memory limited", storage.little_memory, "error: .*memory", DEPOSIT),
            Fault("folder in place of a table", storage.output_is_a_folder, "error: .*samples.csv", SAMPLES),
            Fault("file in place of the results", storage.results_is_a_file, "error: .*results/smoke"),
        ],
        "clocks and records": [
            Fault("clock set back by a day", surroundings.clock_set_back, None, "simulations.csv"),
            Fault("input dated tomorrow", surroundings.clock_ahead, None, "specimens/s1.h5"),
            Fault("records of Snakemake lost", surroundings.records_lost, None, TEST),
            Fault("records of Snakemake damaged", surroundings.records_damaged, None, TEST),
            Fault("stamps of the code lost", surroundings.stamps_lost, None, TEST),
        ],
        "inputs and environment": [
            Fault("input table gone", surroundings.table_gone, "error: .*mine.csv"),
            Fault("input table cut", surroundings.table_in_half, "error: .*table3_burgers.csv", TEST),
            Fault("configuration cut", surroundings.configuration_in_half, "error: .*study.yaml"),
            Fault("compiled core damaged", with_environment(MODEL, CACHE, damaged_cache("*.nb?")), CORE, MODEL),
            Fault("compiled kernel damaged", with_environment(TEST, CACHE, damaged_cache("*.native")), None, TEST),
            Fault("compiled core has no place", with_environment(TEST, CACHE, no_cache), None, TEST),
            Fault("locale without Unicode", with_environment(TEST, "LC_ALL", lambda study: "C"), None, TEST),
        ],
    }  # fmt: skip
