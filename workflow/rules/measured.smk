# Measured mixes: the phase that no law explains, beside what a machine reads of a haversine that drifts. On request:
#   snakemake measured --cores all --configfile config/paper.yaml


rule measured_excess:
    """By mix, temperature and frequency; and, by population and temperature, what the reading explains."""
    input:
        ncat=sorted(f"data/ncat/{path.name}" for path in (CLONE / "data/ncat").glob("*_*.csv")),
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


RECORDED["measured"] = ("measured", ["excess.csv", "budget.csv"])
