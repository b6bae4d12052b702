# Where this workflow stands, and the environment of its jobs.
import functools
import gc
import json
import os
import shutil
import sys
from importlib.util import find_spec
from pathlib import Path

gc.set_threshold(100_000, 50, 100)  # a plan of a thousand jobs holds little garbage to search for

HERE = Path(workflow.current_basedir.get_path_or_uri(secret_free=True))  # workflow/rules
CLONE = HERE.parents[1] if HERE.is_dir() else None  # none where Snakemake fetched the workflow
MAIN = workflow.modifier.is_main_snakefile()  # else a module of another workflow


if MAIN and CLONE in Path.cwd().parents:  # called in a folder of the clone

    workdir: CLONE


def shipped(path):
    """A file of this repository."""
    return local(os.path.relpath(CLONE / path)) if CLONE else workflow.source_path(f"../../{path}")


PAPER = os.path.relpath(CLONE / "config/paper.yaml") if CLONE else "config/paper.yaml"
ENVIRONMENT = "../envs/asphalt-nscd.yaml"  # beside the rules, which name it
IMAGE = "asphalt-nscd.sif"  # made by the commands at the head of Dockerfile

# A clone need not be installed, and what is installed may be of another commit than these rules.
if CLONE:
    sys.path.insert(0, str(CLONE / "src"))
if MAIN and not os.access(".", os.W_OK):
    sys.exit(f"error: {Path.cwd()}: nothing can be written there; call Snakemake in a folder of your own.")

BARE = find_spec("pandas") is None  # a Snakemake whose jobs have an environment of their own

from asphalt_nscd.files.commit import TOLD, commit
from asphalt_nscd.nscd.core_cache import cache_base
from asphalt_nscd.workflow_support import sources, warm
from asphalt_nscd.workflow_support.lock import release_stale_locks

ALONE = MAIN and workflow.is_main_process and release_stale_locks(".snakemake")
if ALONE is None:
    logger.warning("This file system has no locks: after a kill, snakemake --unlock; start one run at a time.")
DEPLOYED = bool(workflow.deployment_settings.deployment_method)  # --sdm

# `asphalt-nscd` is the one beside this Python, whether or not the environment is activated. Where there is none, or jobs
# have an environment of their own, it is run by the first `python` of that environment.
beside = Path(sys.executable).parent
places = [str(beside), os.environ["PATH"]]
SCRIPTS = CLONE or Path(".snakemake/fetched").resolve()  # holds studies/, whose scripts import each other
searched = [str(SCRIPTS), str(CLONE / "src") if CLONE else "", os.environ.get("PYTHONPATH", "")]
sources.STUDIES[:] = [SCRIPTS / "studies"]
STEPS = None if DEPLOYED else shutil.which("asphalt-nscd", path=beside)
if CLONE and not STEPS:
    places.insert(0, str(CLONE / "workflow/scripts"))
else:
    from asphalt_nscd.files.store import VERSIONS, package_versions

    os.environ[VERSIONS] = json.dumps(package_versions())  # what each of many jobs would find out for itself
os.environ[TOLD] = commit()
os.environ["PATH"] = os.pathsep.join(places)
os.environ["PYTHONPATH"] = os.pathsep.join(filter(None, searched))
os.environ["ASPHALT_NSCD_CACHE"] = cache_base()
os.environ["ASPHALT_NSCD_WITHIN_WORKFLOW"] = "1"
os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
if MAIN:
    shell.prefix("exec ")  # a signal reaches the step itself
