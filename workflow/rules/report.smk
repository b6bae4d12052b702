# One rule for each figure, table and page; then the report that holds them all.

from asphalt_nscd.reporting.figures import SEVERAL

# Part of the report by the name of figure or page.
PARTS = {"diagnosis": "0 Diagnosis"} | {name: part for name, (part, _) in FIGURES.items()} | PAGES


for name, (category, files) in FIGURES.items():
    if name == "fig_readings":
        continue  # of studies/paper

    rule:
        name:
            name
        input:
            **files,
            code=code("figure", f"reporting.figures.{SEVERAL.get(name, [name])[0]}"),
        output:
            f"<results>/figures/{name}.pdf",
            f"<results>/figures/{name}.svg",
            report(
                f"<results>/figures/{name}.png",
                caption=f"../report/{caption(name)}.rst",
                category=category,
                labels={"result": title(name)},
            ),
        log:
            f"<results>/logs/{name}.log",
        benchmark:
            f"<results>/benchmarks/{name}.tsv"
        group:
            "contents"
        conda:
            ENVIRONMENT
        params:
            name=name,
            data=pairs,
            stem=lambda wildcards, output: output[0].removesuffix(".pdf"),
        message:
            f"Draw {title(name)}"
        shell:
            "asphalt-nscd figure {params.name} {params.data:q} --output-stem {params.stem} > {log} 2>&1"


for name, files in TABLES.items():

    rule:
        name:
            name
        input:
            **files,
            code=code("table", f"reporting.tables.{name}"),
        output:
            f"<results>/{name}.csv",
        log:
            f"<results>/logs/{name}.log",
        benchmark:
            f"<results>/benchmarks/{name}.tsv"
        group:
            "contents"
        conda:
            ENVIRONMENT
        params:
            name=name,
            data=pairs,
        message:
            f"Make {title(name)}"
        shell:
            "asphalt-nscd table {params.name} {params.data:q} --output {output} > {log} 2>&1"


rule pages:
    """Each table as a page: one job, for a page takes less time than the start of a job."""
    input:
        tables=[f"<results>/{name}.csv" for name in PAGES],
        code=code("page"),
        template=page_files("table_page.html", "table.html"),
    output:
        [
            report(
                f"<results>/pages/{name}.html",
                caption=f"../report/{caption(name)}.rst",
                category=category,
                labels={"result": title(name)},
            )
            for name, category in PAGES.items()
        ],
    log:
        "<results>/logs/pages.log",
    benchmark:
        "<results>/benchmarks/pages.tsv"
    group:
        "pages"
    conda:
        ENVIRONMENT
    params:
        pages=lambda wildcards, output: [
            part
            for name, path in zip(PAGES, output, strict=True)
            for part in ("--title", title(name), "--output", path)
        ],
    message:
        "Show the tables as pages"
    shell:
        "asphalt-nscd page {input.tables} {params.pages:q} > {log} 2>&1"


rule study:
    """The study in full, defaults included."""
    output:
        "<results>/study.json",
    log:
        "<results>/logs/study.log",
    benchmark:
        "<results>/benchmarks/study.tsv"
    localrule: True
    conda:
        ENVIRONMENT
    params:
        study=json.dumps(STUDY),
    message:
        "Write down the study in full"
    shell:
        "asphalt-nscd study {params.study:q} --output {output} > {log} 2>&1"


def benchmarks(wildcards, input):
    """Files of all jobs behind the inputs; the folder may hold others, of jobs that are not asked for any more."""
    dag = workflow.dag
    last = [job for job in dag.jobs if not set(input).isdisjoint(job.output)]
    return sorted(job.benchmark for job in dag.bfs(dag.dependencies, *last) if job.benchmark)


rule timings:
    """Where the time goes, from the benchmark files of all that was computed."""
    input:
        COMPUTED,
        ["results/forecast/recipe/forecast.csv", "results/forecast/voids.csv"] if FORECAST else [],
        code=code("timings"),
    output:
        table="<results>/timings.csv",
        markdown="<results>/timings.md",
    log:
        "<results>/logs/timings.log",
    benchmark:
        "<results>/benchmarks/timings.tsv"
    localrule: True  # a job on a cluster knows its own part of the plan alone
    conda:
        ENVIRONMENT
    params:
        folder=lambda wildcards, output: f"{os.path.dirname(output.table)}/benchmarks",
        benchmarks=benchmarks,
    message:
        "Sum the time by rule"
    shell:
        "asphalt-nscd timings {params.benchmarks} --folder {params.folder} --markdown {output.markdown} --output {output.table} > {log} 2>&1"


rule provenance:
    """What made these results: study, commit, versions."""
    input:
        COMPUTED,
        study="<results>/study.json",
        code=code("provenance"),
    output:
        report(
            "<results>/provenance.json",
            caption="../report/provenance.rst",
            category="8 About this run",
            labels={"result": title("provenance")},
        ),
    log:
        "<results>/logs/provenance.log",
    benchmark:
        "<results>/benchmarks/provenance.tsv"
    conda:
        ENVIRONMENT
    params:
        folder=lambda wildcards, output: os.path.dirname(output[0]),
    message:
        "Write down commit and versions"
    shell:
        "asphalt-nscd provenance {input.study} --folder {params.folder} --output {output} > {log} 2>&1"


def sources_of_entries(results):
    """Name of each figure or page, and the tables in the folder of results that it shows."""
    tables = {name: [path for paths in data.values() for path in paths] for name, (_, data) in FIGURES.items()}
    tables |= {"diagnosis": DIAGNOSED} | {name: [f"<results>/{name}.csv"] for name in PAGES}
    for name, paths in tables.items():
        for path in sorted(set(paths)):
            if path.endswith(".csv"):
                yield name, path.replace("<results>", results)


rule results:
    """Everything but the report about it."""
    input:
        RESULTS,


rule report:
    """One file with everything, that opens with what was measured, simulated, wrong, why, and gained."""
    input:
        figures=[f"<results>/figures/{name}.png" for name in FIGURES],
        pages=[f"<results>/pages/{name}.html" for name in ("diagnosis", *PAGES)],
        captions=[shipped(f"workflow/report/{caption(name)}.rst") for name in ("diagnosis", *FIGURES, *PAGES)],
        data=["<results>/measured.csv", "<results>/simulations.csv", "<results>/samples.csv"],
        diagnosis=DIAGNOSED[0],
        ladder="<results>/ladder.csv",
        pictures=[
            f"<results>/figures/{name}.png"
            for name in ("fig_residual_map", "fig10_extended" if COMMON_LAW else "fig10")
        ],
        beside=[f"<results>/{name}.csv" for name in ("rivals", "ensemble", "audit") if name in PAGES],
        code=code("report"),
        template=page_files("report.html", "first_page.html"),
    output:
        "<results>/report.html",
    log:
        "<results>/logs/report.log",
    benchmark:
        "<results>/benchmarks/report.tsv"
    conda:
        ENVIRONMENT
    params:
        study=STUDY["study"],
        data=lambda wildcards, input: [
            *(f"{Path(path).stem}={path}" for path in input.data),
            f"diagnosis={input.diagnosis}",
            f"ladder={input.ladder}",
            *(f"pictures={path}" for path in input.pictures),
            *(f"beside={path}" for path in input.beside),
        ],
        entries=lambda wildcards, input: [
            f"--entry={PARTS[Path(path).stem]}={path}" for path in [*input.pages, *input.figures]
        ],
        sources=lambda wildcards, output: [
            f"--source={name}={path}" for name, path in sources_of_entries(os.path.dirname(output[0]))
        ],
        captions=lambda wildcards, input: [f"--caption={path}" for path in input.captions],
    message:
        "Put figures and tables into one report: {output}"
    shell:
        "asphalt-nscd report {params.data:q} --study {params.study} {params.entries:q} {params.sources:q} {params.captions:q} --output {output} > {log} 2>&1"
