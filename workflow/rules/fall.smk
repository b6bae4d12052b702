# A beam of bonded spheres, sawn in two, that falls and comes to rest (docs/core.md). A few minutes of a core, on request:
#   snakemake fall --cores all --configfile config/paper.yaml
# Publish with: snakemake publish_fall --cores 1 --configfile config/paper.yaml

FALL_STEPS = ["8e-4", "4e-4", "2e-4"]  # s


rule fall_specimen:
    # A beam of large grains.
    input:
        counts=shipped("config/fall_counts.csv"),
        law=shipped("data/paper/table3_burgers.csv"),
        code=[code("deposit"), code("trim"), code("published-law")],
    output:
        deposit="results/fall/deposit.h5",
        specimen="results/fall/specimen.h5",
        law="results/fall/law.json",
    conda:
        ENVIRONMENT
    log:
        "results/fall/logs/specimen.log",
    message:
        "Pour, cut and bond a small beam"
    shell:
        "( asphalt-nscd deposit --counts {input.counts:q} --box-m 0.1,0.02,0.2 --seed 1 --vibration-s 0 --output {output.deposit}"
        " && asphalt-nscd trim {output.deposit} --geometry b_mm=18,B_mm=20,e_mm=20,h_mm=100,mass_kg=0.09,mobile_mass_kg=0.1 --area facets --output {output.specimen}"
        " && asphalt-nscd published-law {input.law:q} --temperature-c 15 --unit kPa --output {output.law} ) > {log} 2>&1"


rule fall_run:
    # It is sawn in the middle and falls by 40 mm on its edge.
    input:
        specimen="results/fall/specimen.h5",
        law="results/fall/law.json",
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


rule fall:
    # All of it, with its film for ParaView.
    input:
        "results/fall/falls.csv",
        rules.fall_figure.output,
        fall=f"results/fall/{FALL_STEPS[-1]}.h5",
        code=[code("provenance"), code("export")],
    output:
        film="results/fall/film.pvd",
        provenance="results/fall/provenance.json",
    conda:
        ENVIRONMENT
    log:
        "results/fall/logs/film.log",
    message:
        "Film the fall for ParaView: {output.film}"
    shell:
        "( asphalt-nscd export {input.fall} --format vtk --output {output.film} && asphalt-nscd provenance --output {output.provenance} ) > {log} 2>&1"


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
        "Copy the table and the figure of the fall, and fill the table of docs/core.md"
    shell:
        "asphalt-nscd publish {input.table} {input.figure} {input.provenance} --root results/fall --output results/published/fall --document docs --block falls={input.table}"
