"""A Slurm of one node, this machine, started by hand and stopped again."""

from __future__ import annotations

import os
import shutil
import socket
import subprocess
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

PROGRAMS = ("munged", "slurmctld", "slurmd", "sbatch", "srun", "squeue", "scancel", "sinfo")
CONFIGURATION = Path("/etc/slurm/slurm.conf")  # SLURM_CONF would be lost inside jobs

OURS = "# Written by trials/cluster for as long as this process runs: "
# No accounting, no cgroups: neither a database nor systemd is there. Jobs stay known to squeue for a day.
TEMPLATE = (
    OURS
    + """{process}
ClusterName=one
SlurmctldHost={host}(127.0.0.1)
SlurmUser=root
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
ReturnToService=2
MinJobAge=86400
KillWait=5
NodeName={host} NodeAddr=127.0.0.1 CPUs={cpus} RealMemory={memory} State=UNKNOWN
PartitionName=work Nodes={host} Default=YES MaxTime=INFINITE State=UP
"""
)


def why_not() -> str | None:
    """What is missing to start a Slurm here, in a sentence; None if nothing."""
    missing = [name for name in PROGRAMS if shutil.which(name, path=_path()) is None]
    if missing:
        return f"no {', '.join(missing)} on PATH (Debian: apt install slurmctld slurmd slurm-client munge)"
    if os.geteuid() != 0:
        return "only root can start a Slurm"
    if CONFIGURATION.exists() and not _left_over():
        return f"{CONFIGURATION} stands already, and belongs to another Slurm"
    return None


def _left_over() -> bool:
    """Whether the configuration is of a run of this script that was killed."""
    process = CONFIGURATION.read_text().partition("\n")[0].removeprefix(OURS)
    return process.isdigit() and not Path("/proc", process).exists()


@contextmanager
def slurm() -> Iterator[Path]:
    """A Slurm that takes jobs; its folder with logs. All that it started is stopped at the end, jobs first."""
    folder = Path(tempfile.mkdtemp(prefix="slurm-"))
    folder.chmod(0o755)  # munged insists
    for name in ("state", "spool"):
        (folder / name).mkdir()
    daemons: list[subprocess.Popen[bytes]] = []

    def start(*command: str) -> None:
        with (folder / f"{command[0]}.out").open("wb") as out:
            daemons.append(
                subprocess.Popen(command, stdout=out, stderr=out, env=os.environ | {"PATH": _path()})
            )

    key = folder / "munge.key"
    key.write_bytes(os.urandom(1024))
    key.chmod(0o600)
    memory = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") // 2**20
    text = TEMPLATE.format(
        process=os.getpid(),
        folder=folder,
        host=socket.gethostname(),
        cpus=os.cpu_count(),
        memory=int(0.9 * memory),
    )
    CONFIGURATION.parent.mkdir(parents=True, exist_ok=True)
    if CONFIGURATION.exists() and _left_over():
        CONFIGURATION.unlink()
    try:
        with CONFIGURATION.open("x") as file:
            file.write(text)
        start(
            "munged",
            "--foreground",
            "--force",
            f"--key-file={key}",
            f"--socket={folder}/munge.socket",
            f"--pid-file={folder}/munged.pid",
            f"--log-file={folder}/munged.log",
            f"--seed-file={folder}/munged.seed",
        )
        _wait(lambda: (folder / "munge.socket").exists(), "munged", folder)
        start("slurmctld", "-D")
        start("slurmd", "-D")
        _wait(lambda: _answer("sinfo", "--noheader", "--format=%T") == "idle", "the node", folder)
        yield folder
    finally:
        _end_jobs()
        for daemon in reversed(daemons):
            daemon.terminate()
            try:
                daemon.wait(20)
            except subprocess.TimeoutExpired:
                daemon.kill()
                daemon.wait()
        if CONFIGURATION.exists() and CONFIGURATION.read_text() == text:
            CONFIGURATION.unlink()
        shutil.rmtree(folder, ignore_errors=True)


def _end_jobs(seconds: float = 30.0) -> None:
    """Those that still run where the study was interrupted: they would outlive slurmd."""
    until = time.monotonic() + seconds
    while jobs := _answer("squeue", "--noheader", "--format=%A").split():
        _answer("scancel", *jobs)
        if time.monotonic() > until:
            print(f"warning: Slurm jobs {', '.join(jobs)} did not end in {seconds:g} s.")
            break
        time.sleep(0.5)


def _path() -> str:
    return os.pathsep.join([os.environ.get("PATH", ""), "/usr/sbin", "/sbin"])


def _answer(*command: str) -> str:
    done = subprocess.run(command, capture_output=True, text=True, env=os.environ | {"PATH": _path()})
    return done.stdout.strip()


def _wait(ready: object, what: str, folder: Path, seconds: float = 60.0) -> None:
    until = time.monotonic() + seconds
    while not ready():  # type: ignore[operator]
        if time.monotonic() > until:
            logs = "\n".join(path.read_text(errors="replace")[-2000:] for path in folder.glob("*.log"))
            raise RuntimeError(f"{what} did not get ready in {seconds:g} s:\n{logs}")
        time.sleep(0.2)
