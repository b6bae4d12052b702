# How do bonds carry the law of the mix, whatever the size and packing of a specimen? Static solutions, on request:
#   snakemake mapping --cores all --configfile config/paper.yaml
#   MAPPING_SIZES="1000 3000" names other numbers of spheres. Other frictions than the study's are of its full size.

MAPPING_FULL = 14160  # spheres of the paper's table, poured by the study itself
MAPPING_SIZES = [int(size) for size in os.environ.get("MAPPING_SIZES", f"1000 3000 10000 {MAPPING_FULL} 30000").split()]
MAPPING_FRICTION = label(STUDY["specimens"]["deposit"]["friction"])
MAPPING_ROWS = [f"{size}-s{seed}-friction{MAPPING_FRICTION}" for size in MAPPING_SIZES for seed in (1, 2, 3)]
if MAPPING_FULL in MAPPING_SIZES:
    MAPPING_ROWS += [f"{MAPPING_FULL}-s4-friction{MAPPING_FRICTION}"]
    MAPPING_ROWS += [f"{MAPPING_FULL}-s1-friction{label(value)}" for value in PACKING.get("frictions", [])]

MADE |= {
    "mapping_counts": Made(
        "Scale the grading to {wildcards.spheres} spheres",
        "mapping.py counts {wildcards.spheres} {input.counts:q}",
        "results/mapping/counts/{spheres}.csv",
        {"counts": COUNTS},
    ),
    "mapping_poisson": Made(
        "Pull a prism of facets with other tangential stiffnesses",  # which Poisson's ratios facets can have
        f"mapping.py poisson {MAPPING_FULL} {{input.deposit}}",
        "results/mapping/poisson.csv",
        {"deposit": f"<results>/deposits/{SAMPLES[0]}.h5"},
        "condense trim",
    ),
    "mapping_table": Made(
        "Collect the mappings",
        "mapping.py collect {input.rows} --summary {output.summary}",
        "results/mapping/mapping.csv",
        {"rows": expand("results/mapping/rows/{packing}.csv", packing=MAPPING_ROWS)},
        more={"summary": "results/mapping/summary.csv"},
    ),
}
SHOWN["mapping"] = (
    "figure fig_mapping",
    "results/mapping/figures/fig_mapping",
    {"mapping": ["results/mapping/mapping.csv"]},
)
RECORDED["mapping_provenance"] = ("mapping", ["mapping.csv"])


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


use rule deposit as mapping_pour with:
    """So many spheres, poured into a box of their own."""
    input:
        compiled="<results>/compiled/deposit",
        counts="results/mapping/counts/{spheres}.csv",
        code=code("deposit"),
    output:
        "results/mapping/deposits/{spheres}-s{seed}-friction{friction}.h5",
    log:
        "results/mapping/logs/deposit-{spheres}-s{seed}-friction{friction}.log",
    benchmark:
        "results/mapping/benchmarks/deposit-{spheres}-s{seed}-friction{friction}.tsv"
    params:
        box=mapping_box,
        pouring=lambda wildcards: options(STUDY["specimens"]["deposit"] | {"friction": wildcards.friction}),
    message:
        "Pour {wildcards.spheres} spheres, seed {wildcards.seed}, friction {wildcards.friction}"


rule mapping_rows:
    """Static modulus and Poisson's ratio of one packing, by each mapping."""
    input:
        deposit=mapping_deposit,
        code=["benchmarks/mapping.py", code("condense"), code("trim")],
    output:
        "results/mapping/rows/{spheres}-s{seed}-friction{friction}.csv",
    log:
        "results/mapping/logs/rows-{spheres}-s{seed}-friction{friction}.log",
    resources:
        mem_mb=lambda wildcards, attempt: max(2700, int(wildcards.spheres) // 4) * attempt,
    message:
        "Bond {wildcards.spheres} spheres by each mapping, seed {wildcards.seed}, friction {wildcards.friction}"
    shell:
        f"{MEASURE}/mapping.py solve {{wildcards.spheres}} {{input.deposit}} --output {{output}} > {{log}} 2>&1"
