# Fatigue of the samples in two-point bending (docs/fatigue.md). Twenty minutes of a core, on request:
#   snakemake fatigue --cores all --configfile config/paper.yaml
# Publish with: snakemake publish_fatigue --cores 1 --configfile config/paper.yaml

FATIGUE_SPECIMEN = f"{FACETS}/specimens/{{sample}}.h5"


rule fatigue_course:
    # A sample whose bonds tire, until half of its stiffness is left.
    input:
        specimen=FATIGUE_SPECIMEN,
        code=code("fatigue"),
    output:
        course="results/fatigue/courses/{sample}.csv",
        profile="results/fatigue/profiles/{sample}.csv",
    conda:
        ENVIRONMENT
    log:
        "results/fatigue/logs/course-{sample}.log",
    benchmark:
        "results/fatigue/benchmarks/course-{sample}.tsv"
    message:
        "Tire sample {wildcards.sample}"
    shell:
        "asphalt-nscd fatigue {input.specimen} --strain 100e-6 --profile {output.profile} --output {output.course} > {log} 2>&1"


use rule trim as fatigue_small with:
    # One so small that each of its cycles can be stepped.
    input:
        deposit=f"results/mapping/deposits/1000-s1-friction{MAPPING_FRICTION}.h5",
        code=code("trim"),
    output:
        "results/fatigue/small.h5",
    params:
        geometry=text({"b_mm": 10.3336, "B_mm": 23.1473, "e_mm": 10.3336, "h_mm": 103.336, "mass_kg": 0.0424, "mobile_mass_kg": 0.0166}),
        bonds=options(STUDY["specimens"]["bonds"] | {"area": "facets"}, "area", "volume_reduction", "gap_max_mm"),
    log:
        "results/fatigue/logs/small.log",
    benchmark:
        "results/fatigue/benchmarks/small.tsv"
    message:
        "Trim a small sample"


rule fatigue_checked:
    # Cycle jumps at a large strain, jumps ten times as fine, and every cycle.
    input:
        specimen="results/fatigue/small.h5",
        law="<results>/laws/published/T10.json",
        code=code("fatigue"),
    output:
        "results/fatigue/check/{way}.csv",
    params:
        way=lambda wildcards, input: {"jumps": "", "fine": "--finer 10", "every_cycle": f"--every-cycle {input.law}"}[
            wildcards.way
        ],
    conda:
        ENVIRONMENT
    log:
        "results/fatigue/logs/check-{way}.log",
    benchmark:
        "results/fatigue/benchmarks/check-{way}.tsv"
    message:
        "Tire a small sample: {wildcards.way}"
    shell:
        "asphalt-nscd fatigue {input.specimen} --strain 500e-6 {params.way} --output {output} > {log} 2>&1"


rule fatigue_table:
    # Lives at three strains.
    input:
        courses=expand("results/fatigue/courses/{sample}.csv", sample=SAMPLES),
        code=code("table", "reporting.tables.fatigue"),
    output:
        "results/fatigue/fatigue.csv",
    params:
        data=lambda wildcards, input: " ".join(f"course={path}" for path in input.courses),
    conda:
        ENVIRONMENT
    log:
        "results/fatigue/logs/fatigue.log",
    message:
        "Collect the lives of the samples"
    shell:
        "asphalt-nscd table fatigue {params.data} --output {output} > {log} 2>&1"


rule fatigue_summary:
    # Beside what is published, theory, and every cycle.
    input:
        course=expand("results/fatigue/courses/{sample}.csv", sample=SAMPLES),
        profile=expand("results/fatigue/profiles/{sample}.csv", sample=SAMPLES),
        check=expand("results/fatigue/check/{way}.csv", way=["jumps", "fine", "every_cycle"]),
        specimen=expand(FATIGUE_SPECIMEN, sample=SAMPLES[0]),
        code=code("table", "reporting.tables.fatigue_summary"),
    output:
        "results/fatigue/summary.csv",
    params:
        data=lambda wildcards, input: " ".join(
            f"{kind}={path}"
            for kind in ("course", "profile", "check", "specimen")
            for path in input[kind]
        ),
    conda:
        ENVIRONMENT
    log:
        "results/fatigue/logs/summary.log",
    message:
        "Sum up the fatigue of the samples"
    shell:
        "asphalt-nscd table fatigue_summary {params.data} --output {output} > {log} 2>&1"


rule fatigue_figure:
    input:
        courses=expand("results/fatigue/courses/{sample}.csv", sample=SAMPLES),
        profiles=expand("results/fatigue/profiles/{sample}.csv", sample=SAMPLES),
        code=code("figure", "reporting.figures.fig_fatigue"),
    output:
        multiext("results/fatigue/figures/fig_fatigue", ".pdf", ".png", ".svg"),
    params:
        data=lambda wildcards, input: " ".join(
            [f"course={path}" for path in input.courses] + [f"profile={path}" for path in input.profiles]
        ),
    conda:
        ENVIRONMENT
    log:
        "results/fatigue/logs/figure.log",
    message:
        "Draw the fatigue of the samples"
    shell:
        "asphalt-nscd figure fig_fatigue {params.data} --output-stem results/fatigue/figures/fig_fatigue > {log} 2>&1"


rule fatigue:
    # What was tired, and by what.
    input:
        "results/fatigue/fatigue.csv",
        "results/fatigue/summary.csv",
        rules.fatigue_figure.output,
        code=code("provenance"),
    output:
        "results/fatigue/provenance.json",
    conda:
        ENVIRONMENT
    log:
        "results/fatigue/logs/provenance.log",
    message:
        "Write down what was tired"
    shell:
        "asphalt-nscd provenance --output {output} > {log} 2>&1"


rule publish_fatigue:
    # What is committed of it. Only on request.
    input:
        table="results/fatigue/fatigue.csv",
        summary="results/fatigue/summary.csv",
        figure="results/fatigue/figures/fig_fatigue.png",
        provenance="results/fatigue/provenance.json",
        code=code("publish"),
    conda:
        ENVIRONMENT
    message:
        "Copy the tables of fatigue and its figure, and fill the summary of docs/fatigue.md"
    shell:
        "asphalt-nscd publish {input.table} {input.summary} {input.figure} {input.provenance} --root results/fatigue --output results/published/fatigue --document docs --block fatigue_summary={input.summary}"
