# The study, and the few helpers that rules use.
import csv
import re
import shlex

from asphalt_nscd.files.digests import damaged, set_aside
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.paths import is_file, require_writable
from asphalt_nscd.nscd.cores import cores
from asphalt_nscd.study.configuration import complete_study, label, refuse_repeated_keys
from asphalt_nscd.workflow_support.clock import mistrust_future
from asphalt_nscd.workflow_support.failures import failures
from asphalt_nscd.workflow_support.sources import (
    PACKAGE,
    is_number,
    modules_of,
    noted,
    source_files,
    stamp,
    stamp_of_row,
    stamp_of_table,
)


def check(study, source):
    """Refuse what cannot work, before anything is poured; set aside what was damaged since."""
    results = f"results/{study['study']}"
    if BARE:
        logger.warning("The study's tables are not checked before it starts: there is no pandas beside Snakemake.")
    else:
        from asphalt_nscd.study.preflight import require_feasible

        require_feasible(study, source)
    require_writable(results)
    for folder in (results, *(f".snakemake/{kind}" for kind in ("code", "rows", "tables"))):
        mistrust_future(folder)
    if ALONE and not workflow.output_settings.dryrun:
        found = damaged(results)
        if found:
            sys.exit("\n".join(f"error: {set_aside(file)}" for file in found))


def located(value):
    """A study with the files that are not in this folder, but in the repository, by their place there."""
    if isinstance(value, dict):
        return {key: located(item) for key, item in value.items()}
    if isinstance(value, list):
        return [*map(located, value)]
    shared = isinstance(value, str) and "/" in value and CLONE and not is_file(value) and is_file(CLONE / value)
    return os.path.relpath(CLONE / value) if shared else value


def asked_together(study, frequencies):
    """Frequencies in the groups in which the study first asked for them: what is new later repeats no other test.

    Of one that was left out since no test is made: it may have been left out because its test fails.
    """
    kept = Path(".snakemake/rows", f"frequencies-{study}.json")
    groups = json.loads(kept.read_text()) if kept.is_file() and Path("results", study).is_dir() else []
    groups = [group for group in groups if not set(group).isdisjoint(frequencies)]
    new = [frequency for frequency in frequencies if frequency not in sum(groups, [])]
    groups += [new] * bool(new)
    if workflow.is_main_process and not workflow.output_settings.dryrun:
        kept.parent.mkdir(parents=True, exist_ok=True)
        kept.write_text(json.dumps(groups))
    asked = [[frequency for frequency in group if frequency in frequencies] for group in groups]
    return [group for group in asked if group]


# How large the attack on the diagnosis is: apart from any study. On the command line numbers come as text.
ATTACK = {name: int(number) for name, number in config.pop("attack", {}).items()}

try:
    for _path in workflow.configfiles:
        refuse_repeated_keys(_path)
    _source = " + ".join(map(os.path.relpath, workflow.configfiles)) or "configuration"
    STUDY = complete_study(located(config), _source)
    if MAIN and workflow.is_main_process:
        check(STUDY, _source)
except InputError as error:
    sys.exit(f"error: {error}")

# A user's own tables stand where the configuration says, whatever the prefix of a module.
for _holder, _key in [
    (STUDY["measurements"], "table"),
    (STUDY["laws"].get("published", {}), "table"),
    (STUDY["specimens"], "counts_table"),
    *((STUDY.get("published", {}), key) for key in STUDY.get("published", {})),
]:
    if _key in _holder:
        _holder[_key] = local(_holder[_key])


pathvars:
    results=f"results/{STUDY['study']}",


REPORT = f"results/{STUDY['study']}/report.html"
TEMPERATURES = [label(value) for value in STUDY["temperatures_C"]]
FREQUENCIES = [label(value) for value in STUDY["frequencies_Hz"]]
TOGETHER = asked_together(STUDY["study"], FREQUENCIES)
SAMPLES = [f"s{seed}" for seed in STUDY["specimens"]["seeds"]]

# Of a sample's pouring: more than one where the study has fewer samples than cores. `workflow.cores` raises where none
# are given, as by `snakemake --report`.
THREADS = max(1, min(workflow.resource_settings.cores or 1, cores()) // len(SAMPLES))

POURED = "packings" not in STUDY["specimens"]
SHAPES = [local(STUDY["geometry"])] if isinstance(STUDY["geometry"], str) else []  # a table of specimens
COUNTS = STUDY["specimens"].get("counts_table", [])  # none where packings are given


wildcard_constraints:
    seed=r"\d+",
    sample=r"s\d+(-friction[\d.]+(e[+-]?\d+)?)?",
    temperature=r"-?[\d.]+(e[+-]?\d+)?",
    frequency=r"[\d.]+(e[+-]?\d+)?",
    head="free|blocked",
    parameter="Em|eta_m|Ek|eta_k",
    factor=r"[\d.]+(e[+-]?\d+)?",
    family=r"[\w.-]+",
    friction=r"[\d.]+(e[+-]?\d+)?",
    time_step=r"[\d.]+(e[+-]?\d+)?",
    tolerance=r"[\d.]+(e[+-]?\d+)?",


@functools.cache  # rules ask three times for each stamp
def code(step, *modules, without=()):
    """What stands for the source behind a step and modules that it picks by name; `without` folders that are no matter."""
    wanted = (f"cli.{step.replace('-', '_')}", *modules)
    return noted_sources("-".join([step, *modules[:1], *without[:1]]), wanted, without)


MODULES = {}  # behind each stamp


def noted_sources(name, modules, without=()):
    """The stamp of modules and of what they import."""
    path = local(stamp(".snakemake/code", name, source_files(*modules, without=without)).as_posix())
    MODULES[str(path)] = modules
    return path


OF_PAPER = [
    *("audit", "bond_readings", "consistent", "ensemble", "equations", "fig_readings", "finding", "levels"),
    *("other_bonds", "outcomes", "reconstructions", "scale_law", "smooth_bounds", "smoothness"),
]

if not CLONE:
    for _name in OF_PAPER:
        _path = SCRIPTS / f"studies/paper/{_name}.py"
        _content = Path(shipped(f"studies/paper/{_name}.py")).read_bytes()
        if not _path.is_file() or _path.read_bytes() != _content:
            _path.parent.mkdir(parents=True, exist_ok=True)
            _path.write_bytes(_content)


# By a parameter: Snakemake asks for a script when its job starts, and a loop over rules has then ended.
SCRIPT = str(SCRIPTS / "studies/{params.script}.py")


def studied(name):
    """What stands for the source behind a script of studies/: `paper.audit`."""
    return noted_sources(f"studies.{name}", [f"studies.{name}"])


def page_files(*names):
    """Templates behind a page, with what gives all pages their look and their buttons."""
    return [local(os.path.relpath(PACKAGE / "reporting/pages" / name)) for name in (*names, "page.css", "page.js")]


def row_at(table):
    """What stands for the row of a table at the temperature of a job; none where the study has no such table."""
    if not table:
        return []
    return lambda wildcards: local(
        stamp_of_row(".snakemake/rows", table, "temperature_C", float(wildcards.temperature)).as_posix()
    )


def content_of(table):
    """What stands for the content of a table: one that is put in its place may be older than results."""
    # a folder of its own: Snakemake lists one once, and stamps of rows come into theirs later
    return local(stamp_of_table(".snakemake/tables", table).as_posix()) if table else []


def part_of_study(name, **content):
    """What of the study a figure shows, so that other keys do not draw it again."""
    return [local(noted(Path(".snakemake/code", f"{STUDY['study']}-{name}.json"), json.dumps(content)).as_posix())]


def text(value):
    """A value of the study as one word on the command line, the same in whatever order keys are written."""
    if isinstance(value, dict):
        return ",".join(f"{key}={item}" for key, item in sorted(value.items()))
    if isinstance(value, list):
        return ",".join(map(str, value))
    return value


def options(values, *keys):
    """`{"gap_max_mm": 2}` as `--gap-max-mm 2`; all keys or those named."""
    return " ".join(f"--{key.lower().replace('_', '-')} {text(values[key])}" for key in keys or values)


# Of a study that repeats no paper: workflow/report/own/
OWN_CAPTIONS = (
    *("extended", "facets", "fig09", "fig10", "fig10_extended", "fig_ratio"),
    *("ladder", "table3", "table4"),
)


def caption(name):
    """Name of a caption in workflow/report: in own/, where there is one, of a study that repeats no paper."""
    return f"own/{name}" if "published" not in STUDY and name in OWN_CAPTIONS else name


def title(name):
    """First line of a caption; numbers padded, because the report sorts by it."""
    text = Path(shipped(f"workflow/report/{caption(name)}.rst"))
    if not text.exists():
        sys.exit(
            f"error: workflow/report/{name}.rst: no caption of {name}; write it, its title in ** on the first line."
        )
    line = text.read_text(encoding="utf-8").splitlines()[0]
    return re.sub(r"Fig\. (\d):", r"Fig. 0\1:", line.strip("*").replace("\\", ""))


def pairs(wildcards, input):
    """`simulations=results/paper/simulations.csv`, for each file that the rule was given by name."""
    return [f"{kind}={path}" for kind, paths in input.items() if kind != "code" for path in paths]
