# What is committed of a folder of results: figures, tables, and the tables of README and docs. Only on request:
#   snakemake --cores 1 publish


import glob


class Published(NamedTuple):
    """What is committed of a folder of results."""

    folder: str
    files: list
    blocks: dict = {}  # of documents: the tables that fill them
    documents: list = ["docs"]
    modules: list = []  # behind what a program makes that is no rule
    sources: str = ""  # its files, as a pattern


def rests_on(input, told):
    """Options of `publish`: modules and files behind all jobs that its inputs come from, or behind a program."""
    dag = workflow.dag
    last = [job for job in dag.jobs if not set(input.files).isdisjoint(job.output)]
    read = {str(path) for job in dag.bfs(dag.dependencies, *last) for path in job.input}
    read -= {str(path) for job in dag.jobs for path in job.output}
    modules = {*told.modules, *(module for path in read for module in MODULES.get(path, ()))}
    files = {os.path.relpath(path) for path in read if not path.startswith(".snakemake")}
    files |= {*glob.glob(told.sources), *(map(os.path.relpath, [*workflow.configfiles, *PAPER_LAWS]) if last else [])}
    return [*(f"--module={name}" for name in sorted(modules)), *(f"--source={name}" for name in sorted(files))]


STUDY_TABLES = {"samples": "samples.csv", "timings": "timings.md"}
STUDY_TABLES |= {"ladder": "ladder.csv"} if COMMON_LAW else {}
STUDY_TABLES |= {name: f"{name}.csv" for name in ("bond_readings", "reconstructions") if name in PAGES}

PUBLISHED = {
    "publish": Published(
        STUDY["study"],
        [
            *(f"figures/{name}.png" for name in FIGURES),
            *(f"{name}.csv" for name in PAGES if f"<results>/{name}.csv" not in EXPORTED),
            *(path.removeprefix("<results>/") for path in [*DIAGNOSED, *COMMON_LAW]),
            "provenance.json",
        ],
        STUDY_TABLES,
        ["README.md", "docs"],
    ),
    "publish_forecast": Published(
        "forecast",
        [
            *(f"mixes/{name}.csv" for name in ("overall", "errors")),
            *(f"{name}.csv" for name in ("voids", "slopes", "paper_mix", "blind")),
            *(f"blind_{name}.csv" for name in ("mixes", "overall", "tried", "left_out", "binders")),
            "figures/fig_forecast.png",
            "provenance.json",
        ],
        {
            "forecast": "mixes/overall.csv",
            "forecast_blind": "blind_overall.csv",
            "forecast_tried": "blind_tried.csv",
            "forecast_left_out": "blind_left_out.csv",
            "forecast_binders": "blind_binders.csv",
            "forecast_slopes": "slopes.csv",
        },
    ),
    "publish_measured": Published(
        "measured",
        [
            *("ladder.csv", "means.csv", "excess.csv", "budget.csv", "figures/fig_excess.png", "provenance.json"),
            *("amplitude.csv", "contacts.csv", "sign.csv", "binder.csv", "clock.csv"),
        ],
        {
            "measured_means": "means.csv",
            "excess_budget": "budget.csv",
            "measured_amplitude": "amplitude.csv",
            "contacts_sign": "sign.csv",
        },
    ),
    "publish_excess": Published(
        "excess", ["excess.csv", "summary.csv", "provenance.json"], {"drawn_excess": "summary.csv"}
    ),
    "publish_intervals": Published(
        "intervals", ["grid.csv", "summary.csv", "provenance.json"], {"intervals": "summary.csv"}
    ),
    "publish_verification": Published(
        "verification",
        ["verification.csv", "provenance.json"],
        {"verification": "summary.csv"},
    ),
    "publish_benchmark": Published(
        "benchmark",
        ["benchmark.csv", "beside.csv", "growth.csv", "million.csv", "provenance.json"],
        {"benchmark": "beside.csv", "growth": "growth.csv"},
    ),
    "publish_diagnosis_times": Published("benchmark", ["diagnosis.csv"], {"diagnosis_times": "diagnosis.csv"}),
    "publish_density": Published("benchmark", ["density.csv"], {"density": "density.csv"}),
    "publish_outside": Published("benchmark", ["outside.csv"]),
    "publish_mapping": Published(
        "mapping",
        ["mapping.csv", "poisson.csv", "figures/fig_mapping.png", "provenance.json"],
        {"mapping": "summary.csv"},
    ),
    "publish_fatigue": Published(
        "fatigue",
        ["fatigue.csv", "summary.csv", "figures/fig_fatigue.png", "provenance.json"],
        {"fatigue_summary": "summary.csv"},
    ),
    "publish_rigs": Published("rigs", ["rigs.csv", "provenance.json"], {"rigs": "summary.csv"}),
    "publish_fall": Published("fall", ["falls.csv", "figures/fig_fall.png", "provenance.json"]),
    "publish_ramp": Published(
        "ramp", ["ramps.csv", "curve.csv", "figures/fig_ramp.png", "provenance.json"], {"ramp": "ramps.csv"}
    ),
    # These are of programs that are no rules: `make faults`, `make fuzz`, trials/mutants.py, trials/cluster.
    "publish_faults": Published(
        "faults",
        ["faults.csv", "provenance.json"],
        {"faults": "summary.csv"},
        modules=[*modules_of("files"), *modules_of("workflow_support")],
        sources="trials/faults/*.py",
    ),
    "publish_fuzz": Published(
        "fuzz",
        ["wild.csv", "wild_failures.csv", "provenance.json"],
        modules=["cli.diagnose", *modules_of("diagnosis.causes")],
        sources="trials/fuzz/*.py",
    ),
    "publish_calls": Published(
        "calls",
        ["calls.csv", "call_failures.csv", "calls_provenance.json"],
        modules=modules_of("api"),
        sources="trials/fuzz/*.py",
    ),
    "publish_mutants": Published(
        "mutants",
        ["mutants.csv", "provenance.json"],
        {"mutants": "summary.csv"},
        ["CONTRIBUTING.md"],
        sources="trials/mutants.*",
    ),
    "publish_cluster": Published("cluster", ["cluster.csv", "provenance.json"], sources="trials/cluster/*.py"),
    "publish_layouts": Published(
        "layouts",
        ["layouts.csv", "refusals.csv", "provenance.json"],
        {"layouts": "summary.csv", "mends": "mends.csv"},
        modules=["cli.diagnose", "cli.new_study"],
        sources="trials/layouts/*.*",
    ),
}

if ATTACK:
    PUBLISHED["attack"] = Published(
        "attack",
        [
            *(f"{name}.csv" for name in ATTACK_TABLES),
            *("figures/reliability.png", "campaign.json", "nonlinear.csv", "nonlinear_summary.csv"),
            *("power.csv", "power_limits.csv", "power_cases.csv", "power_summary.csv", "power_bound.csv"),
        ],
        {
            "attack": "summary.csv",
            "nonlinear": "nonlinear_summary.csv",
            "power": "power.csv",
            "power_summary": "power_summary.csv",
            "power_bound": "power_bound.csv",
        },
    )
    PUBLISHED["publish_machines"] = Published(
        "attack",
        ["machines.csv", "machines_summary.csv", "machine_measured.csv"],
        {"machines": "machines_summary.csv", "machine_measured": "machine_measured.csv"},
    )
    PUBLISHED["publish_inside"] = Published("attack", ["inside.csv", "inside_summary.csv"])
for name, told in PUBLISHED.items():
    folder = f"results/{told.folder}"
    blocks = [f"--block {block}={folder}/{table}" for block, table in told.blocks.items()]

    rule:
        name:
            name
        input:
            files=[f"{folder}/{file}" for file in told.files],
            tables=[f"{folder}/{table}" for table in told.blocks.values()],
            code=code("publish"),
        params:
            root=folder,
            output=f"results/published/{told.folder}",
            noted=lambda wildcards, input, told=told: rests_on(input, told),
            name=name,
            blocks=[f"--document {document}" for document in told.documents if blocks] + blocks,
        message:
            f"Copy what is committed of {folder}" + ", and fill its tables in documents" * bool(blocks)
        shell:
            "asphalt-nscd publish {input.files} --root {params.root} --output {params.output} --name {params.name} {params.noted:q} {params.blocks}"
