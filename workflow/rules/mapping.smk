# How do bonds carry the law of the mix, whatever the size and packing of a specimen? Static solutions, on request:
#   snakemake mapping --cores all --configfile config/paper.yaml
#   MAPPING_SIZES="1000 3000" names other numbers of spheres. Other frictions than the study's are of its full size.

MAPPING_FULL = 14160  # spheres of the paper's table, poured by the study itself
MAPPING_SIZES = [int(size) for size in os.environ.get("MAPPING_SIZES", f"1000 3000 10000 {MAPPING_FULL} 30000").split()]
MAPPING_FRICTION = label(STUDY["specimens"]["deposit"]["friction"])
MAPPING_ROWS = [f"{size}-s{seed}-friction{MAPPING_FRICTION}" for size in MAPPING_SIZES for seed in (1, 2, 3)]
if MAPPING_FULL in MAPPING_SIZES:
    MAPPING_ROWS += [f"{MAPPING_FULL}-s4-friction{MAPPING_FRICTION}"]
    MAPPING_ROWS += [f"{MAPPING_FULL}-s1-friction{label(value)}" for value in PACKING["frictions"]]


def mapping_box(wildcards):
    """Length and width as the cube root of the number of spheres; one height, so that all fall alike."""
    scale = (int(wildcards.spheres) / MAPPING_FULL) ** (1 / 3)
    length, width, height = STUDY["specimens"]["box_m"]
    return f"{scale * length:.6f},{scale * width:.6f},{height}"


def mapping_deposit(wildcards):
    if int(wildcards.spheres) != MAPPING_FULL:
        return f"results/mapping/deposits/{wildcards.spheres}-s{wildcards.seed}-friction{wildcards.friction}.h5"
    loose = "" if wildcards.friction == MAPPING_FRICTION else f"-friction{wildcards.friction}"
    return f"results/{STUDY['study']}/deposits/s{wildcards.seed}{loose}.h5"


rule mapping_counts:
    # The paper's grading with fewer or more spheres.
    input:
        counts=STUDY["specimens"]["counts_table"],
        code="benchmarks/mapping.py",
    output:
        "results/mapping/counts/{spheres}.csv",
    log:
        "results/mapping/logs/counts-{spheres}.log",
    message:
        "Scale the grading to {wildcards.spheres} spheres"
    shell:
        MEASURE + "/mapping.py counts {wildcards.spheres} {input.counts:q} --output {output} > {log} 2>&1"


use rule deposit as mapping_pour with:
    # So many spheres into a box of its own.
    input:
        compiled="<results>/compiled/deposit",
        counts="results/mapping/counts/{spheres}.csv",
        code=code("deposit"),
    output:
        "results/mapping/deposits/{spheres}-s{seed}-friction{friction}.h5",
    params:
        box=mapping_box,
        pouring=lambda wildcards: options(STUDY["specimens"]["deposit"] | {"friction": wildcards.friction}),
    log:
        "results/mapping/logs/deposit-{spheres}-s{seed}-friction{friction}.log",
    benchmark:
        "results/mapping/benchmarks/deposit-{spheres}-s{seed}-friction{friction}.tsv"
    message:
        "Pour {wildcards.spheres} spheres, seed {wildcards.seed}, friction {wildcards.friction}"


rule mapping_rows:
    # Static modulus and Poisson's ratio of one packing, by each mapping.
    input:
        deposit=mapping_deposit,
        code=["benchmarks/mapping.py", code("condense"), code("trim")],
    output:
        "results/mapping/rows/{spheres}-s{seed}-friction{friction}.csv",
    resources:
        mem_mb=lambda wildcards, attempt: max(2700, int(wildcards.spheres) // 4) * attempt,
    log:
        "results/mapping/logs/rows-{spheres}-s{seed}-friction{friction}.log",
    message:
        "Bond {wildcards.spheres} spheres by each mapping, seed {wildcards.seed}, friction {wildcards.friction}"
    shell:
        MEASURE + "/mapping.py solve {wildcards.spheres} {input.deposit} --output {output} > {log} 2>&1"


rule mapping_poisson:
    # Which Poisson's ratios facets can have.
    input:
        deposit=f"results/{STUDY['study']}/deposits/{SAMPLES[0]}.h5",
        code=["benchmarks/mapping.py", code("condense"), code("trim")],
    output:
        "results/mapping/poisson.csv",
    params:
        spheres=MAPPING_FULL,
    log:
        "results/mapping/logs/poisson.log",
    message:
        "Pull a prism of facets with other tangential stiffnesses"
    shell:
        MEASURE + "/mapping.py poisson {params.spheres} {input.deposit} --output {output} > {log} 2>&1"


rule mapping_table:
    # One row for each mapping and packing.
    input:
        rows=expand("results/mapping/rows/{packing}.csv", packing=MAPPING_ROWS),
        code="benchmarks/mapping.py",
    output:
        table="results/mapping/mapping.csv",
        summary="results/mapping/summary.csv",
    log:
        "results/mapping/logs/table.log",
    message:
        "Collect the mappings"
    shell:
        MEASURE + "/mapping.py collect {input.rows} --output {output.table} --summary {output.summary} > {log} 2>&1"


rule mapping:
    # And its figure.
    input:
        mapping="results/mapping/mapping.csv",
        code=code("figure", "reporting.figures.fig_mapping"),
    output:
        multiext("results/mapping/figures/fig_mapping", ".pdf", ".png", ".svg"),
    log:
        "results/mapping/logs/figure.log",
    message:
        "Draw the mappings"
    shell:
        "asphalt-nscd figure fig_mapping mapping={input.mapping} --output-stem results/mapping/figures/fig_mapping > {log} 2>&1"


rule mapping_provenance:
    input:
        "results/mapping/mapping.csv",
        code=code("provenance"),
    output:
        "results/mapping/provenance.json",
    log:
        "results/mapping/logs/provenance.log",
    message:
        "Write down what was solved"
    shell:
        "asphalt-nscd provenance --output {output} > {log} 2>&1"


rule publish_mapping:
    # What is committed of them. Only on request:
    #   snakemake publish_mapping --cores 1 --configfile config/paper.yaml
    input:
        table="results/mapping/mapping.csv",
        summary="results/mapping/summary.csv",
        poisson="results/mapping/poisson.csv",
        figure="results/mapping/figures/fig_mapping.png",
        provenance="results/mapping/provenance.json",
        code=code("publish"),
    message:
        "Copy the table of mappings and its figure, and fill the table of docs/mapping.md"
    shell:
        "asphalt-nscd publish {input.table} {input.poisson} {input.figure} {input.provenance} --root results/mapping --output results/published/mapping --document docs --block mapping={input.summary}"
