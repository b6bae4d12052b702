"""A study as an RO-Crate (https://w3id.org/ro/crate): results and what made them, in one archive."""

from __future__ import annotations

import mimetypes
from collections.abc import Sequence
from datetime import UTC, datetime
from pathlib import Path

from rocrate.model.contextentity import ContextEntity
from rocrate.model.file import File
from rocrate.rocrate import ROCrate

from asphalt_nscd.files.paths import require_readable
from asphalt_nscd.files.store import atomic_path, read_json

LICENCE = "https://spdx.org/licenses/MIT"
PAPER = "https://doi.org/10.1016/j.compgeo.2019.103255"
PROFILES = [  # which the archive meets; each builds on the one before
    "https://w3id.org/ro/wfrun/process/0.5",
    "https://w3id.org/ro/wfrun/workflow/0.5",
    "https://w3id.org/workflowhub/workflow-ro-crate/1.0",
]
TITLE = "asphalt-nscd: complex modulus of asphalt concrete by nonsmooth contact dynamics"


def write_crate(files: Sequence[Path], root: Path, workflow: Path, provenance: Path, output: Path) -> None:
    """Put files below `root` and the workflow (a Snakefile) into a .zip archive, as the results of one run.

    `provenance` is what `asphalt-nscd provenance` wrote of the run: the study, the commit and the versions of packages.
    """
    for path in (*files, workflow, provenance):
        require_readable(path, "run the study first, or check the path")
    made_by = read_json(provenance)
    crate = ROCrate(version="1.1")  # that on which the profiles rest
    crate.name = f"Study {made_by['study']['study']} of asphalt-nscd"
    crate.description = "Measurements, laws, simulated tests and their diagnosis; report.html shows them."
    crate.license = crate.add(_work(crate, LICENCE, "MIT License"))
    # When the results were made, not when they were packed.
    crate.datePublished = datetime.fromtimestamp(provenance.stat().st_mtime, UTC)
    # No CWL: the library can make it of Galaxy's workflows alone, and refuses all others.
    main = crate.add_workflow(workflow, workflow.name, main=True, lang="snakemake", gen_cwl=False)
    main["name"], main["license"], main["citation"] = TITLE, LICENCE, {"@id": PAPER}
    main["version"] = made_by["git_commit"]
    main["softwareRequirements"] = [
        crate.add(_software(crate, name, version))
        for name, version in ({"python": made_by["python"]} | made_by["packages"]).items()
    ]
    given = _file(crate, provenance, root)
    results = [_file(crate, path, root) for path in files if path != provenance]
    run = ContextEntity(crate, "#run", {"@type": "CreateAction", "name": "The run that made these results"})
    crate.add(run)
    run["instrument"], run["object"], run["result"] = main, given, results
    crate.root_dataset["mentions"] = run
    crate.root_dataset["conformsTo"] = [crate.add(_work(crate, profile, profile)) for profile in PROFILES]
    with atomic_path(output) as temporary:
        crate.write_zip(temporary)


def _file(crate: ROCrate, path: Path, root: Path) -> File:
    """A file in its place below root, with its media type."""
    media = mimetypes.guess_type(path.name)[0]
    return crate.add_file(
        path,
        path.relative_to(root).as_posix(),
        properties={"encodingFormat": media} if media else {},
    )


def _work(crate: ROCrate, identifier: str, name: str) -> ContextEntity:
    return ContextEntity(crate, identifier, {"@type": "CreativeWork", "name": name})


def _software(crate: ROCrate, name: str, version: str) -> ContextEntity:
    properties = {"@type": "SoftwareApplication", "name": name, "softwareVersion": version}
    return ContextEntity(crate, f"#{name}", properties)
