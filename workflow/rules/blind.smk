# Blind tests of the diagnosis: effects hidden in drawn measurements and inside NSCD runs, found or not.
#   make blind
#   snakemake blind --cores all --configfile config/blind.yaml
# Causes are put into real tables too, if ASPHALT_NSCD_TABLES names a folder of them.

sys.path.insert(0, str(CLONE / "trials"))
from blind import plan, real_plan

BLIND = f"env PYTHONPATH={CLONE / 'trials'}:${{{{PYTHONPATH-}}}} OPENBLAS_NUM_THREADS=1 {sys.executable} -m blind"
GENERATOR = [
    "causes",
    "design",
    "generator",
    "laws",
    "outside",
    "plan",
    "records",
    "rig",
    "score",
    "sealed",
    "strength",
]
CHUNKS = expand("<results>/chunks/{number}.jsonl", number=range(len(plan.chunks())))
INSIDE = expand("<results>/inside/{mix}/{effect}.jsonl", mix=plan.MIXES, effect=["nothing", *plan.INSIDE])
RATES = "cases efficiency isolation false_alarms coverage gains outside removal inside_runs summary".split()
BLIND_FIGURES = ["efficiency", "isolation"]
REAL = expand("<results>/real/{number}.jsonl", number=range(len(real_plan.tasks())))
REAL_RATES = [f"real_{name}" for name in "cases efficiency false_names coverage limits summary".split()]


def blind_code(*names):
    return [f"trials/blind/{name}.py" for name in names]


rule blind_chunk:
    """Two dozen cases: drawn, sealed, diagnosed; one line each."""
    input:
        code=code("diagnose", *modules_of("diagnosis.causes")),
        generator=blind_code(*GENERATOR),
    output:
        "<results>/chunks/{number}.jsonl",
    log:
        "<results>/logs/chunks/{number}.log",
    benchmark:
        "<results>/benchmarks/chunks/{number}.tsv"
    params:
        seed=plan.SEED,
    message:
        "Diagnose sealed cases, part {wildcards.number}"
    shell:
        BLIND + " chunk {wildcards.number} --seed {params.seed} --output {output} > {log} 2>&1"


rule blind_inside:
    """One effect hidden inside the runs of all samples, for one mix; scaled by the limits of the empty ones."""
    input:
        compiled="<results>/compiled/simulate",
        models=expand("<results>/models/free/{sample}.h5", sample=SAMPLES),
        limits=lambda wildcards: (
            [] if wildcards.effect == "nothing" else f"<results>/inside/{wildcards.mix}/nothing.jsonl"
        ),
        code=code("simulate"),
        diagnosis=code("diagnose", *modules_of("diagnosis.causes")),
        generator=blind_code("inside", *GENERATOR),
    output:
        "<results>/inside/{mix}/{effect}.jsonl",
    log:
        "<results>/logs/inside/{mix}/{effect}.log",
    benchmark:
        "<results>/benchmarks/inside/{mix}/{effect}.tsv"
    params:
        limits=lambda wildcards, input: f"--limits {input.limits}" if input.limits else "",
    message:
        "Hide {wildcards.effect} inside NSCD runs, mix {wildcards.mix}"
    shell:
        BLIND
        + " inside {wildcards.effect} {input.models} {params.limits} --seed {wildcards.mix} --output {output} > {log} 2>&1"


rule blind_real:
    """Some tables, measured or drawn like measured ones: as they are, and with causes put into them."""
    input:
        code=code("diagnose", *modules_of("diagnosis.causes")),
        generator=blind_code("backgrounds", "fitted", "real", "real_plan", "real_score", "reallike", *GENERATOR),
        tables=lambda wildcards: sorted({task.path for task in real_plan.tasks()[int(wildcards.number)] if task.path}),
    output:
        "<results>/real/{number}.jsonl",
    log:
        "<results>/logs/real/{number}.log",
    benchmark:
        "<results>/benchmarks/real/{number}.tsv"
    params:
        seed=plan.SEED,
    message:
        "Put causes into real tables and tables like them, part {wildcards.number}"
    shell:
        BLIND + " real {wildcards.number} --seed {params.seed} --output {output} > {log} 2>&1"


rule blind_real_tables:
    """The same for real tables, rates only: a table need not be redistributable."""
    input:
        lines=REAL,
        code=blind_code("real_tables", "tables", "score", "plan"),
    output:
        [f"<results>/{name}.csv" for name in REAL_RATES],
        "<results>/real_campaign.json",
    log:
        "<results>/logs/blind_real_tables.log",
    params:
        folder=lambda wildcards, output: os.path.dirname(output[0]),
    message:
        "Compare what was put into real tables with what was found"
    shell:
        BLIND + " real-tables {input.lines} --folder {params.folder} > {log} 2>&1"


rule blind_tables:
    """The seals are opened: what was hidden against what was found."""
    input:
        lines=[*CHUNKS, *INSIDE],
        code=blind_code("tables", "score", "plan"),
    output:
        [f"<results>/{name}.csv" for name in RATES],
        "<results>/campaign.json",
    log:
        "<results>/logs/blind_tables.log",
    params:
        folder=lambda wildcards, output: os.path.dirname(output[0]),
    message:
        "Compare what was hidden with what was found"
    shell:
        BLIND + " tables {input.lines} --folder {params.folder} > {log} 2>&1"


rule blind_reported:
    """Drawn tables whose mix is known: what is reported of it, and the corrected tests diagnosed again."""
    input:
        code=code("diagnose", *modules_of("diagnosis.causes")),
        generator=blind_code("reported", *GENERATOR),
    output:
        "<results>/reported.csv",
        summary="<results>/reported_summary.csv",
    log:
        "<results>/logs/blind_reported.log",
    params:
        seed=plan.SEED,
        tables=120,
        folder=lambda wildcards, output: os.path.dirname(output[0]),
    message:
        "Compare what is reported of blind tables with their mixes"
    shell:
        BLIND + " reported {params.tables} --seed {params.seed} --folder {params.folder} > {log} 2>&1"


rule blind_figure:
    """Figures of the blind tests."""
    input:
        table="<results>/{name}.csv",
        code=blind_code("figures"),
    output:
        multiext("<results>/figures/{name}", ".pdf", ".png", ".svg"),
    log:
        "<results>/logs/blind_figure/{name}.log",
    wildcard_constraints:
        name="|".join(BLIND_FIGURES),
    params:
        stem=lambda wildcards, output: output[0].removesuffix(".pdf"),
    message:
        "Draw {wildcards.name}"
    shell:
        BLIND + " figure {wildcards.name} {input.table} --output-stem {params.stem} > {log} 2>&1"
