# Blind tests of the diagnosis: effects hidden in drawn measurements and inside NSCD runs, found or not.
#   make blind
#   snakemake blind --cores all --configfile config/blind.yaml

sys.path.insert(0, str(Path(workflow.basedir, "trials")))
from blind import plan

BLIND = f"env PYTHONPATH={Path(workflow.basedir, 'trials')}:${{{{PYTHONPATH-}}}} OPENBLAS_NUM_THREADS=1 {sys.executable} -m blind"
GENERATOR = ["causes", "design", "generator", "laws", "outside", "plan", "records", "rig", "score", "sealed", "strength"]
CHUNKS = expand("<results>/chunks/{number}.jsonl", number=range(len(plan.chunks())))
INSIDE = expand("<results>/inside/{mix}/{effect}.jsonl", mix=plan.MIXES, effect=["nothing", *plan.INSIDE])
RATES = "cases efficiency isolation false_alarms coverage gains outside removal inside_runs summary".split()
BLIND_FIGURES = ["efficiency", "isolation"]


def blind_code(*names):
    return [f"trials/blind/{name}.py" for name in names]


rule blind_chunk:
    # Two dozen cases: drawn, sealed, diagnosed; one line each.
    input:
        code=code("diagnose", *modules_of("diagnosis.causes")),
        generator=blind_code(*GENERATOR),
    output:
        "<results>/chunks/{number}.jsonl",
    params:
        seed=plan.SEED,
    log:
        "<results>/logs/chunks/{number}.log",
    benchmark:
        "<results>/benchmarks/chunks/{number}.tsv"
    message:
        "Diagnose sealed cases, part {wildcards.number}"
    shell:
        BLIND + " chunk {wildcards.number} --seed {params.seed} --output {output} > {log} 2>&1"


rule blind_inside:
    # One effect hidden inside the runs of all samples, for one mix; scaled by the limits of the empty ones.
    input:
        compiled="<results>/compiled/simulate",
        models=expand("<results>/models/free/{sample}.h5", sample=SAMPLES),
        limits=lambda wildcards: []
        if wildcards.effect == "nothing"
        else f"<results>/inside/{wildcards.mix}/nothing.jsonl",
        code=code("simulate"),
        diagnosis=code("diagnose", *modules_of("diagnosis.causes")),
        generator=blind_code("inside", *GENERATOR),
    output:
        "<results>/inside/{mix}/{effect}.jsonl",
    params:
        limits=lambda wildcards, input: f"--limits {input.limits}" if input.limits else "",
    log:
        "<results>/logs/inside/{mix}/{effect}.log",
    benchmark:
        "<results>/benchmarks/inside/{mix}/{effect}.tsv"
    message:
        "Hide {wildcards.effect} inside NSCD runs, mix {wildcards.mix}"
    shell:
        BLIND + " inside {wildcards.effect} {input.models} {params.limits} --seed {wildcards.mix} --output {output} > {log} 2>&1"


rule blind_tables:
    # The seals are opened.
    input:
        lines=[*CHUNKS, *INSIDE],
        code=blind_code("tables", "score", "plan"),
    output:
        [f"<results>/{name}.csv" for name in RATES],
        "<results>/campaign.json",
    params:
        folder=lambda wildcards, output: os.path.dirname(output[0]),
    log:
        "<results>/logs/blind_tables.log",
    message:
        "Compare what was hidden with what was found"
    shell:
        BLIND + " tables {input.lines} --folder {params.folder} > {log} 2>&1"


rule blind_figure:
    input:
        table="<results>/{name}.csv",
        code=blind_code("figures"),
    output:
        multiext("<results>/figures/{name}", ".pdf", ".png", ".svg"),
    params:
        stem=lambda wildcards, output: output[0].removesuffix(".pdf"),
    wildcard_constraints:
        name="|".join(BLIND_FIGURES),
    log:
        "<results>/logs/blind_figure/{name}.log",
    message:
        "Draw {wildcards.name}"
    shell:
        BLIND + " figure {wildcards.name} {input.table} --output-stem {params.stem} > {log} 2>&1"


rule blind:
    # What is committed of the campaign, and its summary in the README.
    input:
        summary="<results>/summary.csv",
        files=[
            *(f"<results>/{name}.csv" for name in RATES),
            *(f"<results>/figures/{name}.png" for name in BLIND_FIGURES),
            "<results>/campaign.json",
        ],
        code=code("publish"),
    params:
        root=f"results/{STUDY['study']}",
        output=f"results/published/{STUDY['study']}",
    message:
        "Copy what is committed of the blind tests, and fill their table in the README"
    shell:
        "asphalt-nscd publish {input.files} --root {params.root} --output {params.output} --document README.md --block blind={input.summary}"
