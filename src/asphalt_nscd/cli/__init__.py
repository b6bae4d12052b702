"""The command `asphalt-nscd`: one subcommand for each computing step, one module for each subcommand."""

from __future__ import annotations

import ctypes
import errno
import gc
import os
import pickle
import pkgutil
import re
import shutil
import signal
import sys
import threading
from collections.abc import Callable
from importlib import import_module
from io import TextIOWrapper
from typing import Any, NoReturn

# One core or many must give identical numbers, and jobs run side by side: every step is one thread.
for _variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS"):
    os.environ[_variable] = "1"

import click  # noqa: E402

from asphalt_nscd import __version__  # noqa: E402
from asphalt_nscd.files import digests  # noqa: E402
from asphalt_nscd.files.errors import CPU_TIME, WITHIN_WORKFLOW, DamagedFile, InputError  # noqa: E402

_MENDS = {
    errno.ENOSPC: "free some space and run the same command again",
    errno.EDQUOT: "free some of your quota and run the same command again",
    errno.EFBIG: "raise the limit on file sizes (ulimit -f) and run the same command again",
    errno.EACCES: "allow access or choose another path",
    errno.EPERM: "allow access or choose another path",
    errno.EROFS: "choose a path that can be written",
    errno.ENOENT: "check the path",
    errno.ENOTDIR: "check the path",
    errno.EISDIR: "give a file, not a folder",
    errno.EEXIST: "give a folder, or a path where nothing is",
}
# Modules of the extras in pyproject.toml.
_OF_EXTRAS = dict.fromkeys(("docutils", "rocrate", "snakemake"), "workflow")
_OF_EXTRAS |= dict.fromkeys(("llvmlite", "numba", "pyamg"), "simulation")
_NO_MEMORY = "the memory is used up; end other programs, or run fewer jobs at a time (--cores 1)."


_FIRST = (
    "diagnose",
    "serve",
    "compare",
    "forecast",
    "export",
    "new-study",
)  # what users type; a workflow calls the rest


class _Steps(click.Group):
    """Subcommands found among this package's modules and imported when called."""

    def list_commands(self, context: click.Context) -> list[str]:
        modules = (module.name for module in pkgutil.iter_modules(__path__))
        return sorted(name.replace("_", "-") for name in modules if not name.startswith("_"))

    def get_command(self, context: click.Context, name: str) -> click.Command | None:
        if name not in self.list_commands(context):
            return None
        return import_module(f"{__name__}.{name.replace('-', '_')}").command

    def format_commands(self, context: click.Context, formatter: click.HelpFormatter) -> None:
        """List what users type first, and the steps of the workflow below, in a group of their own."""
        names = self.list_commands(context)
        first = [name for name in _FIRST if name in names]
        others = [name for name in names if name not in first]
        for title, group in (("For your measurements", first), ("Steps of the workflow", others)):
            commands = ((name, self.get_command(context, name)) for name in group)
            with formatter.section(title):
                formatter.write_dl(
                    [(name, one.get_short_help_str(80)) for name, one in commands if one is not None]
                )


@click.group(cls=_Steps, context_settings={"show_default": True, "help_option_names": ["-h", "--help"]})
@click.option(
    "--version",
    is_flag=True,
    is_eager=True,
    expose_value=False,
    help="Show version and commit.",
    callback=lambda context, option, asked: _say_version(context) if asked else None,
)
def group() -> None:
    """Complex modulus of asphalt concrete by nonsmooth contact dynamics, step by step."""


def _say_version(context: click.Context) -> None:
    from asphalt_nscd.files.commit import commit

    click.echo(f"asphalt-nscd {__version__}, commit {commit()}")
    context.exit()


def main(arguments: list[str] | None = None) -> None:
    """Run one step. Exit status 2 with one sentence if input or files cannot be used."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, TextIOWrapper):
            stream.reconfigure(errors="replace")  # code pages of consoles lack Greek letters
    _end(lambda: _run(sys.argv[1:] if arguments is None else arguments))


def run_script(job: Any, step: Callable[[Any], object]) -> None:
    """End as `main` does with a step that a script of the workflow takes; `job` is the script's `snakemake`."""
    log = os.open(job.log[0], os.O_WRONLY | os.O_CREAT | os.O_TRUNC)
    for stream in (1, 2):
        os.dup2(log, stream)
    _end(lambda: _checked(job, step))


def run_table(job: Any, make: Callable[..., Any]) -> None:
    """Run a script whose one output is a table: the names of its inputs, but `code`, are the parameters of `make`."""

    def step(job: Any) -> None:
        from asphalt_nscd.files.store import write_table

        named = {name: files for name, files in job.input.items() if name != "code"}
        write_table(job.output[0], make(**named))

    run_script(job, step)


def _checked(job: Any, step: Callable[[Any], object]) -> None:
    digests.require_unchanged(map(str, job.input))
    step(job)


def _end(step: Callable[[], object]) -> NoReturn:
    """Take a step and end the process with its status; within the workflow its CPU time and memory end the log."""
    if os.environ.get(WITHIN_WORKFLOW) and sys.platform == "linux":
        # PR_SET_PDEATHSIG: the kernel ends this step when Snakemake dies, however it dies.
        prctl_set_death_signal = 1
        ctypes.CDLL(None).prctl(prctl_set_death_signal, signal.SIGTERM)
    threading.excepthook = _end_with_thread
    # Modules that are being loaded hold no garbage, and most steps load little else.
    gc.set_threshold(100_000, 50, 100)
    status = _status(step)
    if os.environ.get(WITHIN_WORKFLOW) and not status:
        # For timings.csv: Snakemake looks at a job now and then, and misses what it takes after the last look.
        click.echo(f"{CPU_TIME}{sum(os.times()[:4]):.2f} s, memory: {_most_memory():.1f} MB", err=True)
    sys.exit(status)


def _end_with_thread(failure: threading.ExceptHookArgs) -> None:
    """End the process where one of its threads lacks memory: the others may wait for it. Else as usual."""
    if not isinstance(failure.exc_value, MemoryError):
        threading.__excepthook__(failure)
        return
    status = _say(_NO_MEMORY, 2)
    sys.stderr.flush()
    os._exit(status)


def _most_memory() -> float:
    """Largest resident set of this process, MB; 0 on Windows."""
    try:
        import resource
    except ImportError:
        return 0.0
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / (1e6 if sys.platform == "darwin" else 1e3)


def _run(arguments: list[str]) -> None:
    # Here for all steps: what a rule hands to one is checked before it is read.
    digests.require_unchanged(arguments)
    group.main(arguments, prog_name="asphalt-nscd", standalone_mode=False)


def _status(step: Callable[[], object]) -> int:
    """The exit status of a step: 0, or that of a refusal, whose sentence is printed. What is our fault is raised."""
    try:
        step()
    except click.ClickException as error:
        error.show()
        return error.exit_code
    except DamagedFile as error:
        within = os.environ.get(WITHIN_WORKFLOW)
        return _say(digests.set_aside(error) if within else str(error), 2)
    except InputError as error:
        return _say(str(error), 2)
    except (KeyboardInterrupt, click.Abort):
        return _say("interrupted; nothing half-written is left.", 130)
    except MemoryError:
        return _say(_NO_MEMORY, 2)
    except SystemError as error:  # Python had no memory left to raise a MemoryError with
        if re.search(r"without (setting an )?exception", str(error)) is None:
            raise
        return _say(_NO_MEMORY, 2)
    except ImportError as error:
        if error.name in _OF_EXTRAS:
            return _say(
                f"this step needs {error.name}; pip install 'asphalt-nscd[{_OF_EXTRAS[error.name]}]'.", 2
            )
        if "failed to map segment" not in str(error):
            raise
        return _say(_NO_MEMORY, 2)
    except (pickle.UnpicklingError, EOFError):  # only the compiler's cache is pickled
        return _say(_forget_core(), 2)
    except (OSError, RuntimeError) as error:
        sentence = _file_trouble(error)
        if sentence is None:
            raise
        return _say(sentence, 2)
    return 0


def _forget_core() -> str:
    from asphalt_nscd.nscd.core_cache import core_folder

    shutil.rmtree(core_folder(), ignore_errors=True)
    return f"{core_folder()}: the compiled core was damaged; it was removed, run the same command again."


def _file_trouble(error: OSError | RuntimeError) -> str | None:
    """One sentence on a full disk and its like; HDF5 reports them as text in either class."""
    number = getattr(error, "errno", None)
    if number is None:
        found = re.search(r"errno = (\d+)", str(error))
        number = int(found.group(1)) if found else None
    if number is None:
        return None
    name = getattr(error, "filename", None) or "output file"
    mend = _MENDS.get(number, "mend that and run the same command again")
    return f"{name}: {os.strerror(number).lower()}; {mend}."


def _say(sentence: str, status: int) -> int:
    click.echo(f"error: {sentence}", err=True)
    return status
