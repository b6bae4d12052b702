# Each stage of the chain by its name, as docs/workflow.md lists them: `snakemake deposits`, `snakemake tests`, ...
# `diagnose`, `simulations` and the other rules without wildcards are targets too.

STAGES = {
    "deposits": ("Spheres poured and vibrated", DEPOSITS),
    "specimens": (
        "Trimmed and bonded, and condensed for tests",
        expand(["<results>/specimens/{sample}.h5", f"{model()}.h5", f"{model()}.excerpt.h5"], sample=SAMPLES),
    ),
    "laws": ("Laws that the tests use, and those fitted to the measurements", [*USED_LAWS, *FITTED_LAWS]),
    "tests": ("The campaign, and one row for each test", [*TESTS["simulate"].files(), *SIMULATIONS]),
    "tables": (
        "All tables of the report but those of the run itself",
        [f"<results>/{name}.csv" for name in PAGES if name != "timings"],
    ),
    "figures": (
        "All figures",
        [f"<results>/figures/{name}.{kind}" for name in FIGURES for kind in ("pdf", "png", "svg")],
    ),
    "diagnosis": (
        "What the simulation gets wrong, and why; with its page",
        [*DIAGNOSED, *COMMON_LAW, "<results>/pages/diagnosis.html"],
    ),
    "extended": ("The tests run again with what the diagnosis named", [*EXTENDED_SIMULATIONS, "<results>/ladder.csv"]),
}
if "audit" not in PAGES:  # statements of the paper; a study without its parts has none to judge
    STAGES["audit"] = ("Tests under readings of the paper", ["<results>/readings.csv"] if AUDIT else [])

for name, (message, files) in STAGES.items():

    rule:
        name:
            name
        input:
            files,
        message:
            message
