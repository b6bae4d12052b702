# Beyond the paper: what the simulation gets wrong about the measurements, and which cause that has.

SETTINGS = dict(STUDY["diagnosis"])
SETTINGS |= SETTINGS.pop("scatter", {})
DIAGNOSED = [f"<results>/diagnosis/{name}" for name in ("diagnosis.json", "residuals.csv", "causality.csv")]


rule reduced_specimen:
    """The numerical specimen as two small matrices, from which its test follows for any law."""
    input:
        model=f"{model(FACETS)}.h5",
        code=code("reduced-specimen"),
    output:
        "<results>/diagnosis/specimens/{sample}.h5",
    log:
        "<results>/logs/reduced_specimen/{sample}.log",
    benchmark:
        "<results>/benchmarks/reduced_specimen/{sample}.tsv"
    conda:
        ENVIRONMENT
    message:
        "Reduce sample {wildcards.sample} to what a diagnosis needs of it"
    shell:
        "asphalt-nscd reduced-specimen {input.model} --output {output} > {log} 2>&1"


COMPARED = {
    "measured": "<results>/measured.csv",
    "simulations": "<results>/simulations.csv",
    "facets": FACET_SIMULATIONS,
    "specimen": f"<results>/diagnosis/specimens/{SAMPLES[0]}.h5",
    "shapes": SHAPES,
}


rule diagnose:
    """What the simulation gets wrong: residuals, ladder of causes, verdict; the log holds the ladder."""
    input:
        **COMPARED,
        code=code("diagnose", *modules_of("diagnosis.causes")),
    output:
        DIAGNOSED,
        COMMON_LAW,
    log:
        "<results>/logs/diagnose.log",
    benchmark:
        "<results>/benchmarks/diagnose.tsv"
    conda:
        ENVIRONMENT
    params:
        geometry=text(STUDY["geometry"]),
        settings=options(SETTINGS),
        campaigns=lambda wildcards, input: f"--simulations {input.simulations}"
        + (f" --facets {input.facets}" if input.facets else ""),
        folder=lambda wildcards, output: os.path.dirname(output[0]),
    message:
        "Diagnose where simulation and measurements differ, and why"
    shell:
        "asphalt-nscd diagnose {input.measured} --specimen {input.specimen} {params.campaigns} --geometry {params.geometry:q} {params.settings} --no-page --output {params.folder} > {log} 2>&1"


rule diagnosis_page:
    """The diagnosis as a page: what to make of it, for who has to act on it."""
    input:
        diagnosis=DIAGNOSED[0],
        residuals=DIAGNOSED[1],
        causality=DIAGNOSED[2],
        table4="<results>/table4.csv",
        ladder="<results>/ladder.csv",
        code=code("diagnosis-page"),
        template=page_files("diagnosis_page.html", "charts.html", "table.html"),
    output:
        report(
            "<results>/pages/diagnosis.html",
            caption="../report/diagnosis.rst",
            category="0 Diagnosis",
            labels={"result": title("diagnosis")},
        ),
    log:
        "<results>/logs/page/diagnosis.log",
    benchmark:
        "<results>/benchmarks/page/diagnosis.tsv"
    conda:
        ENVIRONMENT
    params:
        title=title("diagnosis"),
        data=lambda wildcards, input: [
            f"{kind}={input.get(kind)}" for kind in ("diagnosis", "residuals", "causality", "table4", "ladder")
        ],
    message:
        "Show the diagnosis as a page"
    shell:
        "asphalt-nscd diagnosis-page {params.data:q} --title {params.title:q} --output {output} > {log} 2>&1"
