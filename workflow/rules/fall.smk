# A beam of bonded spheres, sawn in two, that falls and comes to rest (docs/core.md). A few minutes of a core, on request:
#   snakemake fall --cores all --configfile config/paper.yaml
# Publish with: snakemake publish_fall --cores 1 --configfile config/paper.yaml

FALL_STEPS = ["8e-4", "4e-4", "2e-4"]  # s


rule fall_deposit:
    # Large grains, for a small beam.
    input:
        counts=shipped("config/fall_counts.csv"),
        code=code("deposit"),
    output:
        "results/fall/deposit.h5",
    conda:
        ENVIRONMENT
    log:
        "results/fall/logs/deposit.log",
    message:
        "Pour the grains of a small beam"
    shell:
        "asphalt-nscd deposit --counts {input.counts:q} --box-m 0.1,0.02,0.2 --seed 1 --vibration-s 0 --output {output} > {log} 2>&1"


use rule trim as fall_specimen with:
    input:
        deposit="results/fall/deposit.h5",
        code=code("trim"),
    output:
        "results/fall/specimen.h5",
    params:
        geometry=text({"b_mm": 18, "B_mm": 20, "e_mm": 20, "h_mm": 100, "mass_kg": 0.09, "mobile_mass_kg": 0.1}),
        bonds="--area facets",
    log:
        "results/fall/logs/specimen.log",
    benchmark:
        "results/fall/benchmarks/specimen.tsv"
    message:
        "Cut and bond a small beam"


rule fall_run:
    # It is sawn in the middle and falls by 40 mm on its edge.
    input:
        specimen="results/fall/specimen.h5",
        law="<results>/laws/published/T15.json",
        code=code("fall"),
    output:
        "results/fall/{step}.h5",
    wildcard_constraints:
        step="[0-9]e-[0-9]",
    conda:
        ENVIRONMENT
    log:
        "results/fall/logs/{step}.log",
    benchmark:
        "results/fall/benchmarks/{step}.tsv"
    message:
        "Let a sawn beam fall, in steps of {wildcards.step} s"
    shell:
        "asphalt-nscd fall {input.specimen} --law {input.law} --height-mm 40 --tilt-deg 50 --duration-s 0.8 --frames 81 --time-step-s {wildcards.step} --output {output} > {log} 2>&1"


rule fall_table:
    # Where its energy goes.
    input:
        falls=expand("results/fall/{step}.h5", step=FALL_STEPS),
        code=code("table", "reporting.tables.falls"),
    output:
        "results/fall/falls.csv",
    params:
        data=lambda wildcards, input: " ".join(f"fall={path}" for path in input.falls),
    conda:
        ENVIRONMENT
    log:
        "results/fall/logs/falls.log",
    message:
        "Sum up the energy of the falls"
    shell:
        "asphalt-nscd table falls {params.data} --output {output} > {log} 2>&1"


rule fall_figure:
    input:
        fall=f"results/fall/{FALL_STEPS[-1]}.h5",
        code=code("figure", "reporting.figures.fig_fall"),
    output:
        multiext("results/fall/figures/fig_fall", ".pdf", ".png", ".svg"),
    conda:
        ENVIRONMENT
    log:
        "results/fall/logs/figure.log",
    message:
        "Draw the fall"
    shell:
        "asphalt-nscd figure fig_fall fall={input.fall} --output-stem results/fall/figures/fig_fall > {log} 2>&1"


rule fall_film:
    # For ParaView.
    input:
        fall=f"results/fall/{FALL_STEPS[-1]}.h5",
        code=code("export"),
    output:
        "results/fall/film.pvd",
    conda:
        ENVIRONMENT
    log:
        "results/fall/logs/film.log",
    message:
        "Film the fall for ParaView: {output}"
    shell:
        "asphalt-nscd export {input.fall} --format vtk --output {output} > {log} 2>&1"


rule fall:
    # All of it.
    input:
        "results/fall/falls.csv",
        "results/fall/film.pvd",
        rules.fall_figure.output,
        code=code("provenance"),
    output:
        "results/fall/provenance.json",
    conda:
        ENVIRONMENT
    log:
        "results/fall/logs/provenance.log",
    message:
        "Write down what fell"
    shell:
        "asphalt-nscd provenance --output {output} > {log} 2>&1"


rule publish_fall:
    # What is committed of it. Only on request.
    input:
        table="results/fall/falls.csv",
        figure="results/fall/figures/fig_fall.png",
        provenance="results/fall/provenance.json",
        code=code("publish"),
    conda:
        ENVIRONMENT
    message:
        "Copy the table and the figure of the fall"
    shell:
        "asphalt-nscd publish {input.table} {input.figure} {input.provenance} --root results/fall --output results/published/fall"
