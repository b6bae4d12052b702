"""A job or Snakemake itself ended from outside, and two Snakemakes at once."""

from __future__ import annotations

import signal
import subprocess
import time

from faults.fault import DEPOSIT, DEPOSIT_LOG, KILLED, Fault, Unable
from faults.study import Missed, Run, Study


def killed(rule: str, output: str, log: str) -> Fault:
    def disturb(study: Study) -> Run:
        delay = 0.2  # s
        while True:
            (study.results / output).unlink()
            try:
                return study.killed(log, delay=delay)
            except Missed:  # on a fast machine, a job of a few lines takes less
                if delay < 0.01:
                    raise Unable("its job ends within milliseconds, before it can be killed") from None
                delay /= 4.0

    return Fault(f"SIGKILL in {rule}", disturb, KILLED, output)


def signalled(name: str, signum: int, said: str) -> Fault:
    def disturb(study: Study) -> Run:
        (study.results / DEPOSIT).unlink()
        return study.killed(DEPOSIT_LOG, signum)

    return Fault(f"{name} in deposit", disturb, said, DEPOSIT)


def workflow_signalled(name: str, signum: int, output: str, log: str) -> Fault:
    """Snakemake itself gets the signal while it makes `output`; it need not be able to say anything."""

    def disturb(study: Study) -> Run:
        (study.results / output).unlink()
        process = study.start("--cores", "2", *study.targets)
        while process.poll() is None and log not in study.jobs():
            time.sleep(0.01)
        time.sleep(0.3)
        process.send_signal(signum)
        try:
            _, said = process.communicate(timeout=30)
        except subprocess.TimeoutExpired:  # Snakemake 9.27 can wait for itself
            process.kill()
            _, said = process.communicate()
        return Run(process.args, process.returncode or 1, "", said)

    return Fault(f"{name} to Snakemake while it makes {output}", disturb, "", output)


def two_at_once(study: Study) -> Run:
    (study.results / DEPOSIT).unlink()
    first = study.start("--cores", "1", *study.targets)
    while first.poll() is None and DEPOSIT_LOG not in study.jobs():
        time.sleep(0.01)
    first.send_signal(signal.SIGSTOP)  # however slow the second is, the first has not ended
    second = study.finish()
    first.kill()
    first.communicate()
    return second


def half_written(study: Study) -> Run:
    """What a power cut leaves beside a result."""
    (study.results / "deposits/.s1-x3f2k1.h5").write_bytes(b"\x89HDF\r\n\x1a\n half")
    (study.results / DEPOSIT).unlink()
    done = study.finish()
    (study.results / "deposits/.s1-x3f2k1.h5").unlink()
    return done
