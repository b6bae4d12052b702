# Measured mixes: laws of them, and the phase that no law explains beside what a machine reads of a haversine, grains that
# slip and films that soften. Fifteen CPU minutes. On request:
#   snakemake measured --cores all --configfile config/paper.yaml

MIXES = sorted(f"data/ncat/{path.name}" for path in (CLONE / "data/ncat").glob("*_*.csv"))
MECHANISMS = {name: f"results/measured/{name}.csv" for name in ("contacts", "binder", "clock")}
FIGURE_OF_EXCESS = multiext("results/measured/figures/fig_excess", ".pdf", ".png", ".svg")
CYLINDER = {
    name: f"results/measured/{file}.h5" for name, file in {"model": "cylinder", "excerpt": "cylinder_excerpt"}.items()
}

SCRIPTED |= {
    "measured_contacts": Scripted(
        "Press poured stones that touch, open and slip; no mix is looked at: nine minutes",
        "measured/contacts",
        {"table": MECHANISMS["contacts"], "sign": "results/measured/sign.csv"},
        threads=4,
    ),
    "measured_softening": Scripted(
        "Soften binder films by the published limit of their linear strain, and run a clock faster under stress",
        "measured/softening",
        {name: MECHANISMS[name] for name in ("binder", "clock")},
        {"recipe": RECIPE},
    ),
    "measured_amplitude": Scripted(
        "Lay the mechanisms beside tests of two laboratories at several strains",
        "measured/amplitude",
        {"table": "results/measured/amplitude.csv"},
        MECHANISMS,
    ),
    "measured_cylinder": Scripted(
        "Pour a cylinder of full size with facets, for the laws of all mixes", "measured/cylinder", CYLINDER
    ),
    "measured_ladder": Scripted(
        "Fit Burgers laws and one law to nine measured mixes, in sample and of what was left out: nine minutes",
        "measured/ladder",
        {name: f"results/measured/{name}.csv" for name in ("ladder", "means")},
        MECHANISMS | CYLINDER | {"mixes": MIXES},
    ),
    "measured_excess": Scripted(
        "Lay three mechanisms beside the excess phase of measured mixes",
        "measured/excess",
        {name: f"results/measured/{name}.csv" for name in ("excess", "budget")},
        MECHANISMS | {"ncat": MIXES, "mixes": "data/mixes50/modulus.csv"},
    ),
    "fig_excess": Scripted(
        "Draw the excess phase of measured mixes by temperature, measured and predicted",
        "measured/fig_excess",
        dict(zip(("pdf", "png", "svg"), FIGURE_OF_EXCESS)),
        {name: f"results/measured/{name}.csv" for name in ("excess", "budget")},
    ),
}


# A program of trials/, whose modules are beside it.
TRIAL = f"env PYTHONPATH={CLONE / 'trials'}:${{PYTHONPATH-}} OPENBLAS_NUM_THREADS=1 {sys.executable} -m"
# What such programs draw their tables by.
INVENTED = [f"trials/{name}.py" for name in ("attack/laboratory", "attack/mixes", "drawn/design", "drawn/laws")]


rule drawn_excess:
    """Whether the excess phase of tables without one is none, and whether its interval says so. Three minutes."""
    input:
        code=code("diagnose", *modules_of("diagnosis.causes")),
        generator=["trials/excess.py", *INVENTED],
    output:
        rows="results/excess/excess.csv",
        summary="results/excess/summary.csv",
    log:
        "results/excess/logs/excess.log",
    benchmark:
        "<results>/benchmarks/drawn_excess.tsv"
    conda:
        ENVIRONMENT
    params:
        program=f"{TRIAL} excess 200 --folder results/excess",
    message:
        "Find the excess phase of 200 tables that have none"
    shell:
        "{params.program} > {log} 2>&1"


rule reported_intervals:
    """Whether the intervals of what is reported hold the mix, where it was not tested too. Ten minutes."""
    input:
        measured="data/mixes50/modulus.csv",
        code=code("diagnose", *modules_of("diagnosis.causes")),
        generator=["trials/extrapolation.py", *INVENTED],
    output:
        grid="results/intervals/grid.csv",
        summary="results/intervals/summary.csv",
    log:
        "results/intervals/logs/intervals.log",
    benchmark:
        "<results>/benchmarks/intervals.tsv"
    conda:
        ENVIRONMENT
    params:
        program=f"{TRIAL} extrapolation",
        size="10 40 100 --seed 20281128",
    message:
        "Diagnose campaigns of three temperatures, and hold what is reported against their mixes"
    shell:
        "{params.program} {params.size} --measured {input.measured} --folder results/intervals > {log} 2>&1"


RECORDED["excess"] = ("excess", ["excess.csv", "summary.csv"])
RECORDED["intervals"] = ("intervals", ["grid.csv", "summary.csv"])
RECORDED["measured"] = (
    "measured",
    [
        *("ladder.csv", "means.csv", "excess.csv", "budget.csv", "figures/fig_excess.png"),
        *("amplitude.csv", "contacts.csv", "sign.csv", "binder.csv", "clock.csv"),
    ],
)
