# What a reader sees: figures, tables, audit, and one report that holds them all.

SIMULATIONS = ["<results>/simulations.csv"]
MEASURED = ["<results>/measured.csv"]
USED_LAWS = expand(f"<results>/laws/{LAWS}/T{{temperature}}.json", temperature=TEMPERATURES)
FITTED_LAWS = expand("<results>/laws/fitted/T{temperature}.json", temperature=TEMPERATURES)
TYPICAL = TEMPERATURES[len(TEMPERATURES) // 2]  # where the study names no other
SOFTER = label(SENSITIVITY["temperature_C"]) if "sensitivity" in STUDY else TYPICAL
FIRST = SAMPLES[0]

# name: category in the report, {kind of data: files}
FIGURES = {
    "fig01": ("Set-up", {"study": ["<results>/study.json"]}),
    "fig05": (
        "Preparation",
        {"deposit": [f"<results>/deposits/{FIRST}.h5"], "specimen": [f"<results>/specimens/{FIRST}.h5"]},
    ),
    "fig07": (
        "Bending tests",
        {"test": expand(TESTS, sample=FIRST, temperature=TYPICAL, frequency=max(FREQUENCIES, key=float))},
    ),
    "fig08": (
        "Bending tests",
        {
            "test": expand(TESTS, sample=FIRST, temperature=SOFTER, frequency=min(FREQUENCIES, key=float)),
            "specimen": [f"<results>/specimens/{FIRST}.h5"],
        },
    ),
    "fig09": ("Bending tests", {"simulations": SIMULATIONS, "measured": MEASURED, "laws": USED_LAWS}),
    "fig10": ("Bending tests", {"simulations": SIMULATIONS, "measured": MEASURED, "laws": USED_LAWS}),
    "fig_ratio": ("Bending tests", {"simulations": SIMULATIONS}),
}
TABLES = {
    "table3": (
        "Laws",
        {
            "fitted": FITTED_LAWS,
            "measured": MEASURED,
            "published": [STUDY["laws"]["published"]["table"]] if "published" in STUDY["laws"] else [],
        },
    ),
    "table4": (
        "Bending tests",
        {
            "simulations": SIMULATIONS,
            "measured": MEASURED,
            "published": [STUDY["published"]["errors_table"]] if "published" in STUDY else [],
        },
    ),
}
if "published" in STUDY:
    TABLES["table2"] = (
        "Preparation",
        {
            "grading": [STUDY["published"]["grading_table"]],
            "published": [STUDY["published"]["counts_table"]],
            "used": [STUDY["specimens"]["counts_table"]],
        },
    )
if "time_step_study" in STUDY:
    FIGURES["fig06"] = (
        "Time step",
        {"converged": expand(STEPPED, method="reduced"), "stopped": expand(STEPPED, method="sweeps")},
    )
if "sensitivity" in STUDY:
    for name, parameter in {"fig11": "Em", "fig12": "eta_m", "fig13": "Ek", "fig14": "eta_k"}.items():
        if parameter in SENSITIVITY["parameters"]:
            FIGURES[name] = (
                "Sensitivity",
                {
                    "sensitivity": ["<results>/sensitivity.csv"],
                    "simulations": SIMULATIONS,
                    "measured": MEASURED,
                    "laws": [f"<results>/laws/{LAWS}/T{label(SENSITIVITY['temperature_C'])}.json"],
                },
            )
if "audit" in STUDY:
    FIGURES["fig_readings"] = ("Audit", {"readings": ["<results>/readings.csv"], "simulations": SIMULATIONS})
if "packing_study" in STUDY:
    FIGURES["fig_packing"] = ("Preparation", {"packing": ["<results>/packing.csv"]})

COMPUTED = [
    MEASURED,
    FITTED_LAWS,
    SIMULATIONS,
    "<results>/sensitivity.csv" if "sensitivity" in STUDY else [],
    "<results>/readings.csv" if "audit" in STUDY else [],
    "<results>/packing.csv" if "packing_study" in STUDY else [],
    [f"<results>/figures/{name}.{kind}" for name in FIGURES for kind in ("pdf", "png", "svg")],
    [f"<results>/{name}.csv" for name in TABLES],
]
RESULTS = [*COMPUTED, "<results>/timings.csv", "<results>/provenance.json"]


for name, (category, data) in FIGURES.items():

    rule:
        name:
            name
        input:
            **data,
            code=code("figure", f"figures.{name}"),
        output:
            f"<results>/figures/{name}.pdf",
            f"<results>/figures/{name}.svg",
            report(f"<results>/figures/{name}.png", caption=f"../report/{name}.rst", category=category),
        params:
            data=pairs,
            stem=lambda wildcards, output: output[0].removesuffix(".pdf"),
        log:
            f"<results>/logs/{name}.log",
        benchmark:
            f"<results>/benchmarks/{name}.tsv"
        message:
            f"Draw {name}"
        shell:
            "asphalt-nscd figure {rule} {params.data} --output-stem {params.stem} > {log} 2>&1"


for name, (category, data) in TABLES.items():

    rule:
        name:
            name
        input:
            **data,
            code=code("table", f"tables.{name}"),
        output:
            report(f"<results>/{name}.csv", caption=f"../report/{name}.rst", category=category),
        params:
            data=pairs,
        log:
            f"<results>/logs/{name}.log",
        benchmark:
            f"<results>/benchmarks/{name}.tsv"
        message:
            f"Make {name}"
        shell:
            "asphalt-nscd table {rule} {params.data} --output {output} > {log} 2>&1"


rule study:
    # The study in full, defaults included.
    output:
        "<results>/study.json",
    params:
        study=json.dumps(STUDY),
    log:
        "<results>/logs/study.log",
    benchmark:
        "<results>/benchmarks/study.tsv"
    message:
        "Write down the study in full"
    shell:
        "asphalt-nscd study {params.study:q} --output {output} > {log} 2>&1"


rule timings:
    # Where the time goes, from the benchmark files of all that was computed.
    input:
        COMPUTED,
        code=code("timings"),
    output:
        report("<results>/timings.csv", caption="../report/timings.rst", category="About this run"),
    log:
        "<results>/logs/timings.log",
    benchmark:
        "<results>/benchmarks/timings.tsv"
    params:
        benchmarks=f"results/{STUDY['study']}/benchmarks",
    message:
        "Sum the time by rule"
    shell:
        "asphalt-nscd timings {params.benchmarks} --output {output} > {log} 2>&1"


rule provenance:
    # What made these results: study, commit, versions.
    input:
        COMPUTED,
        study="<results>/study.json",
        code=code("provenance"),
    output:
        report("<results>/provenance.json", caption="../report/provenance.rst", category="About this run"),
    log:
        "<results>/logs/provenance.log",
    benchmark:
        "<results>/benchmarks/provenance.tsv"
    message:
        "Write down commit and versions"
    shell:
        "asphalt-nscd provenance {input.study} --output {output} > {log} 2>&1"


rule results:
    # Everything but the report about it.
    input:
        RESULTS,


rule report:
    # Snakemake's own report, from the results and the records of how they were made.
    input:
        RESULTS,
        study="<results>/study.json",
    output:
        "<results>/report.html",
    params:
        snakefile=os.path.relpath(workflow.main_snakefile),
    log:
        "<results>/logs/report.log",
    benchmark:
        "<results>/benchmarks/report.tsv"
    message:
        "Put figures, tables and audit into one report: {output}"
    shell:
        "snakemake results --snakefile {params.snakefile} --configfile {input.study} --report {output} > {log} 2>&1"
