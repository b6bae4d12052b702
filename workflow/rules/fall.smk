# A beam of bonded spheres, sawn in two, that falls and comes to rest (docs/core.md). A few minutes of a core, on request:
#   snakemake fall --cores all --configfile config/paper.yaml

FALLS = [f"results/fall/{step}.h5" for step in ("8e-4", "4e-4", "2e-4")]  # s


rule fall_deposit:
    """Large grains, for a small beam."""
    input:
        counts=shipped("config/fall_counts.csv"),
        code=code("deposit"),
    output:
        "results/fall/deposit.h5",
    log:
        "results/fall/logs/deposit.log",
    conda:
        ENVIRONMENT
    message:
        "Pour the grains of a small beam"
    shell:
        "asphalt-nscd deposit --counts {input.counts:q} --box-m 0.1,0.02,0.2 --seed 1 --vibration-s 0 --output {output} > {log} 2>&1"


use rule trim as fall_specimen with:
    """A small beam of large grains."""
    input:
        deposit="results/fall/deposit.h5",
        code=code("trim"),
    output:
        "results/fall/specimen.h5",
    log:
        "results/fall/logs/specimen.log",
    benchmark:
        "results/fall/benchmarks/specimen.tsv"
    params:
        geometry=text({"b_mm": 18, "B_mm": 20, "e_mm": 20, "h_mm": 100, "mass_kg": 0.09, "mobile_mass_kg": 0.1}),
        bonds="--area facets",
    message:
        "Cut and bond a small beam"


rule fall_run:
    """It is sawn in the middle and falls by 40 mm on its edge."""
    input:
        specimen="results/fall/specimen.h5",
        law="<results>/laws/published/T15.json",
        code=code("fall"),
    output:
        "results/fall/{step}.h5",
    log:
        "results/fall/logs/{step}.log",
    benchmark:
        "results/fall/benchmarks/{step}.tsv"
    wildcard_constraints:
        step="[0-9]e-[0-9]",
    conda:
        ENVIRONMENT
    message:
        "Let a sawn beam fall, in steps of {wildcards.step} s"
    shell:
        "asphalt-nscd fall {input.specimen} --law {input.law} --height-mm 40 --tilt-deg 50 --duration-s 0.8 --frames 81 --time-step-s {wildcards.step} --output {output} > {log} 2>&1"


rule fall_film:
    """For ParaView."""
    input:
        fall=FALLS[-1],
        code=code("export"),
    output:
        "results/fall/film.pvd",
    log:
        "results/fall/logs/film.log",
    conda:
        ENVIRONMENT
    message:
        "Film the fall for ParaView: {output}"
    shell:
        "asphalt-nscd export {input.fall} --format vtk --output {output} > {log} 2>&1"
