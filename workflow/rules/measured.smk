# Measured mixes: laws of them, and the phase that no law explains beside what a machine reads of a haversine. On request:
#   snakemake measured --cores all --configfile config/paper.yaml

MIXES = sorted(f"data/ncat/{path.name}" for path in (CLONE / "data/ncat").glob("*_*.csv"))


rule measured_ladder:
    """Burgers laws, one law, that law as it is read: in sample, and of what was left out. Three minutes."""
    input:
        mixes=MIXES,
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
    """By mix, temperature and frequency; and, by population and temperature, what the reading explains."""
    input:
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
        "Lay the reading of a haversine beside the excess phase of measured mixes"
    script:
        "../../studies/measured/excess.py"


rule fig_excess:
    """The excess phase by temperature, and the reading."""
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


RECORDED["measured"] = (
    "measured",
    ["ladder.csv", "means.csv", "excess.csv", "budget.csv", "figures/fig_excess.png"],
)
