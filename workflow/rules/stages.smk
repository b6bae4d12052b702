# Each stage of the chain by its name, as docs/workflow.md lists them: `snakemake deposits`, `snakemake tests`, ...
# `diagnose`, `simulations` and the other rules without wildcards are targets too.


rule deposits:
    """Spheres poured and vibrated."""
    input:
        DEPOSITS,


rule specimens:
    """Trimmed and bonded, and condensed for tests."""
    input:
        expand(["<results>/specimens/{sample}.h5", f"{model()}.h5", f"{model()}.excerpt.h5"], sample=SAMPLES),


rule laws:
    """Those that the tests use, and those fitted to the measurements."""
    input:
        USED_LAWS,
        FITTED_LAWS,


rule tests:
    """The campaign, and one row for each test."""
    input:
        TESTS["simulate"].files(),
        "<results>/simulations.csv",


rule tables:
    """All tables of the report but those of the run itself."""
    input:
        [f"<results>/{name}.csv" for name in PAGES if name != "timings"],


rule figures:
    """All figures."""
    input:
        [f"<results>/figures/{name}.{kind}" for name in FIGURES for kind in ("pdf", "png", "svg")],


rule diagnosis:
    """What the simulation gets wrong, and why; with its page."""
    input:
        DIAGNOSED,
        COMMON_LAW,
        "<results>/pages/diagnosis.html",


rule extended:
    """The tests run again with what the diagnosis named."""
    input:
        EXTENDED_SIMULATIONS,
        "<results>/ladder.csv",


if "audit" not in TABLES:

    rule audit:
        """Statements of the paper; a study without its parts has none to judge."""
        input:
            ["<results>/readings.csv"] if AUDIT else [],
