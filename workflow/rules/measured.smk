# Measured mixes: laws of them, and the phase that no law explains beside what a machine reads of a haversine, grains that
# slip and films that soften. Fifteen CPU minutes. On request:
#   snakemake measured --cores all --configfile config/paper.yaml

MIXES = sorted(f"data/ncat/{path.name}" for path in (CLONE / "data/ncat").glob("*_*.csv"))
MECHANISMS = {name: f"results/measured/{name}.csv" for name in ("contacts", "binder", "clock")}


rule measured_contacts:
    """Poured stones that touch, open and slip, over modulus and phase of a mix; no mix is looked at. Three minutes."""
    input:
        code=studied("measured.contacts"),
    output:
        MECHANISMS["contacts"],
    log:
        "results/measured/logs/contacts.log",
    benchmark:
        "<results>/benchmarks/measured_contacts.tsv"
    conda:
        ENVIRONMENT
    threads: 4
    message:
        "Press stones that touch"
    script:
        "../../studies/measured/contacts.py"


rule measured_softening:
    """Binders by the published limit of their linear strain, and a clock that runs faster under stress."""
    input:
        recipe=RECIPE,
        code=studied("measured.softening"),
    output:
        binder=MECHANISMS["binder"],
        clock=MECHANISMS["clock"],
    log:
        "results/measured/logs/softening.log",
    benchmark:
        "<results>/benchmarks/measured_softening.tsv"
    conda:
        ENVIRONMENT
    message:
        "Soften binder films"
    script:
        "../../studies/measured/softening.py"


rule measured_amplitude:
    """What a larger strain does, measured by two laboratories and predicted."""
    input:
        **MECHANISMS,
        code=studied("measured.amplitude"),
    output:
        "results/measured/amplitude.csv",
    log:
        "results/measured/logs/amplitude.log",
    benchmark:
        "<results>/benchmarks/measured_amplitude.tsv"
    conda:
        ENVIRONMENT
    message:
        "Lay the mechanisms beside tests at several strains"
    script:
        "../../studies/measured/amplitude.py"


rule measured_cylinder:
    """A cylinder of full size with facets, for the laws of all mixes."""
    input:
        code=studied("measured.cylinder"),
    output:
        model="results/measured/cylinder.h5",
        excerpt="results/measured/cylinder_excerpt.h5",
    log:
        "results/measured/logs/cylinder.log",
    benchmark:
        "<results>/benchmarks/measured_cylinder.tsv"
    conda:
        ENVIRONMENT
    message:
        "Pour a cylinder of full size"
    script:
        "../../studies/measured/cylinder.py"


rule measured_ladder:
    """Burgers laws, one law, that law as it is tested: in sample, of what was left out, and simulated. Nine minutes."""
    input:
        **MECHANISMS,
        mixes=MIXES,
        model=rules.measured_cylinder.output.model,
        excerpt=rules.measured_cylinder.output.excerpt,
        code=studied("measured.ladder"),
    output:
        ladder="results/measured/ladder.csv",
        means="results/measured/means.csv",
    log:
        "results/measured/logs/ladder.log",
    benchmark:
        "<results>/benchmarks/measured_ladder.tsv"
    conda:
        ENVIRONMENT
    message:
        "Fit laws to nine measured mixes"
    script:
        "../../studies/measured/ladder.py"


rule measured_excess:
    """By mix, temperature and frequency; and, by population and temperature, what three mechanisms explain."""
    input:
        **MECHANISMS,
        ncat=MIXES,
        mixes="data/mixes50/modulus.csv",
        code=studied("measured.excess"),
    output:
        excess="results/measured/excess.csv",
        budget="results/measured/budget.csv",
    log:
        "results/measured/logs/excess.log",
    benchmark:
        "<results>/benchmarks/measured_excess.tsv"
    conda:
        ENVIRONMENT
    message:
        "Lay three mechanisms beside the excess phase of measured mixes"
    script:
        "../../studies/measured/excess.py"


rule fig_excess:
    """The excess phase by temperature, and its parts."""
    input:
        excess="results/measured/excess.csv",
        budget="results/measured/budget.csv",
        code=studied("measured.fig_excess"),
    output:
        multiext("results/measured/figures/fig_excess", ".pdf", ".png", ".svg"),
    log:
        "results/measured/logs/fig_excess.log",
    benchmark:
        "<results>/benchmarks/fig_excess.tsv"
    conda:
        ENVIRONMENT
    message:
        "Draw the excess phase of measured mixes"
    script:
        "../../studies/measured/fig_excess.py"


# A program of trials/, whose modules are beside it.
TRIAL = f"env PYTHONPATH={CLONE / 'trials'}:${{PYTHONPATH-}} OPENBLAS_NUM_THREADS=1 {sys.executable} -m"


rule drawn_excess:
    """Whether the excess phase of tables without one is none, and whether its interval says so. Three minutes."""
    input:
        code=code("diagnose", *modules_of("diagnosis.causes")),
        generator=[f"trials/{name}.py" for name in ("excess", "attack/laboratory", "attack/mixes")],
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
        generator=[f"trials/{name}.py" for name in ("extrapolation", "attack/laboratory", "attack/mixes")],
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
        size="10 100 --seed 20281128",
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
        *("amplitude.csv", "contacts.csv", "binder.csv", "clock.csv"),
    ],
)
