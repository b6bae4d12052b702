# Fatigue of the samples in two-point bending (docs/fatigue.md). Twenty minutes of a core, on request:
#   snakemake fatigue --cores all --configfile config/paper.yaml

FATIGUE_SPECIMEN = f"<results>/{FACETS}specimens/{{sample}}.h5"


rule fatigue_course:
    """A sample whose bonds tire, until half of its stiffness is left."""
    input:
        specimen=FATIGUE_SPECIMEN,
        code=code("fatigue"),
    output:
        course="results/fatigue/courses/{sample}.csv",
        profile="results/fatigue/profiles/{sample}.csv",
    log:
        "results/fatigue/logs/course-{sample}.log",
    benchmark:
        "results/fatigue/benchmarks/course-{sample}.tsv"
    conda:
        ENVIRONMENT
    message:
        "Tire sample {wildcards.sample}"
    shell:
        "asphalt-nscd fatigue {input.specimen} --strain 100e-6 --profile {output.profile} --output {output.course} > {log} 2>&1"


use rule trim as fatigue_small with:
    """One so small that each of its cycles can be stepped."""
    input:
        deposit=f"results/mapping/deposits/1000-s1-friction{MAPPING_FRICTION}.h5",
        code=code("trim"),
    output:
        "results/fatigue/small.h5",
    log:
        "results/fatigue/logs/small.log",
    benchmark:
        "results/fatigue/benchmarks/small.tsv"
    params:
        geometry=text(
            {
                "b_mm": 10.3336,
                "B_mm": 23.1473,
                "e_mm": 10.3336,
                "h_mm": 103.336,
                "mass_kg": 0.0424,
                "mobile_mass_kg": 0.0166,
            }
        ),
        bonds=options(BONDS | {"area": "facets"}, *CUT),
    message:
        "Trim a small sample"


rule fatigue_checked:
    """Cycle jumps at a large strain, jumps ten times as fine, and every cycle."""
    input:
        specimen="results/fatigue/small.h5",
        law="<results>/laws/published/T10.json",
        code=code("fatigue"),
    output:
        "results/fatigue/check/{way}.csv",
    log:
        "results/fatigue/logs/check-{way}.log",
    benchmark:
        "results/fatigue/benchmarks/check-{way}.tsv"
    conda:
        ENVIRONMENT
    params:
        way=lambda wildcards, input: {"jumps": "", "fine": "--finer 10", "every_cycle": f"--every-cycle {input.law}"}[
            wildcards.way
        ],
    message:
        "Tire a small sample: {wildcards.way}"
    shell:
        "asphalt-nscd fatigue {input.specimen} --strain 500e-6 {params.way} --output {output} > {log} 2>&1"
