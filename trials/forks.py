"""Programs in Python, each run in a process of its own, without the seconds that a start takes.

Most of a short program is its imports. One process has those of others; each run is a fork of it. No module of ours is
among them, for a test may bring its own.
"""

from __future__ import annotations

import atexit
import multiprocessing
import os
import subprocess
import sys
import tempfile
from collections.abc import Mapping
from importlib import import_module
from pathlib import Path

_FORKS = multiprocessing.get_context("forkserver")
_LOADED = "snakemake.cli snakemake.report.html_reporter pandas scipy.optimize h5py jsonschema click"
_FORKS.set_forkserver_preload(_LOADED.split())
LONGEST = 1800.0  # s; a run that hangs is then killed, ends as -9, and its test shows what it said


def forked(
    program: str, arguments: list[str], folder: str | Path = ".", environment: Mapping[str, str] = os.environ
) -> subprocess.CompletedProcess[str]:
    """What a program named as `snakemake.cli:main` says in a folder, and how it ends."""
    with tempfile.NamedTemporaryFile("r") as out, tempfile.NamedTemporaryFile("r") as err:
        told = (program, arguments, str(folder), dict(environment), (out.name, err.name))
        process = _FORKS.Process(target=_run, args=told)
        process.start()
        process.join(LONGEST)
        if process.exitcode is None:
            process.kill()
            process.join()
        return subprocess.CompletedProcess(arguments, process.exitcode, out.read(), err.read())


def _run(
    program: str, arguments: list[str], folder: str, environment: dict[str, str], streams: tuple[str, str]
) -> None:
    os.chdir(folder)
    os.environ.clear()
    os.environ.update(environment)
    for descriptor, name in enumerate(streams, 1):
        os.dup2(os.open(name, os.O_WRONLY), descriptor)
    searched = environment.get("PYTHONPATH", "").split(os.pathsep)
    sys.path[:0] = [os.getcwd(), *filter(None, searched)]
    module, function = program.split(":")
    sys.argv = [module, *arguments]
    try:
        getattr(import_module(module), function)()
    finally:
        atexit._run_exitfuncs()  # a fork leaves them out: what a program keeps at its end, as the sources it has parsed
