# The law of a film (docs/film.md) against elasticity: two spheres by finite elements, many by FFT. About an hour, on request:
#   pip install -e ".[film]" && snakemake film --cores all --configfile config/paper.yaml

FILM_CELLS = [
    *(f"two-{fraction}-{voxels}" for fraction in ("0.37", "0.51") for voxels in (72, 108)),
    *("two-0.58-108", "four-0.37-72", "four-0.51-108"),
]


rule film_packing:
    # Spheres that just touch, in a periodic cell.
    input:
        ["benchmarks/film_cells.py", "benchmarks/film_packings.py"],
    output:
        "results/film/packings/{packing}.csv",
    log:
        "results/film/logs/packing-{packing}.log",
    message:
        "Grow spheres until they touch: {wildcards.packing}"
    shell:
        MEASURE + "/film_cells.py packing {wildcards.packing} --output {output} > {log} 2>&1"


rule film_cell:
    # Stiffness of the cell at one fraction, in so many voxels along its edge.
    input:
        spheres="results/film/packings/{packing}.csv",
        code=["benchmarks/film_cells.py", "benchmarks/film_voxels.py"],
    output:
        "results/film/cells/{packing}-{fraction}-{voxels}.csv",
    resources:
        mem_mb=lambda wildcards: 500 + int(wildcards.voxels) ** 3 // 3000,
    log:
        "results/film/logs/cell-{packing}-{fraction}-{voxels}.log",
    benchmark:
        "results/film/benchmarks/cell-{packing}-{fraction}-{voxels}.tsv"
    message:
        "Solve {wildcards.fraction} of spheres in {wildcards.voxels} voxels: {wildcards.packing}"
    shell:
        MEASURE + "/film_cells.py cell {input.spheres} {wildcards.fraction} {wildcards.voxels} --output {output} > {log} 2>&1"


rule film_cells:
    # The network of films beside each cell.
    input:
        rows=expand("results/film/cells/{cell}.csv", cell=FILM_CELLS),
        code=["benchmarks/film_law.py", "src/asphalt_nscd/forecasting/film.py"],
    output:
        "results/film/cells.csv",
    log:
        "results/film/logs/cells.log",
    message:
        "Compare networks of films with cells of voxels"
    shell:
        MEASURE + "/film_law.py cells --rows {input.rows} --output {output} > {log} 2>&1"


rule film_pairs:
    # One film by finite elements; needs scikit-fem and gmsh.
    input:
        ["benchmarks/film_law.py", "benchmarks/film_pair.py", "src/asphalt_nscd/forecasting/film.py"],
    output:
        "results/film/pairs.csv",
    log:
        "results/film/logs/pairs.log",
    benchmark:
        "results/film/benchmarks/pairs.tsv"
    message:
        "Press two spheres together by finite elements"
    shell:
        MEASURE + "/film_law.py pairs --output {output} > {log} 2>&1"


rule film_shears:
    # One film that slides, likewise.
    input:
        ["benchmarks/film_law.py", "benchmarks/film_pair.py", "src/asphalt_nscd/forecasting/film.py"],
    output:
        "results/film/shears.csv",
    log:
        "results/film/logs/shears.log",
    benchmark:
        "results/film/benchmarks/shears.tsv"
    message:
        "Slide two spheres along each other by finite elements"
    shell:
        MEASURE + "/film_law.py shears --output {output} > {log} 2>&1"


rule film_summary:
    # What docs/film.md shows of the cells.
    input:
        cells="results/film/cells.csv",
        code="benchmarks/film_law.py",
    output:
        "results/film/cells_summary.csv",
    log:
        "results/film/logs/summary.log",
    message:
        "Sum up the cells of films"
    shell:
        MEASURE + "/film_law.py summary {input.cells} --output {output} > {log} 2>&1"


rule film:
    # What was solved, and by what.
    input:
        [f"results/film/{file}.csv" for file in ("pairs", "shears", "cells_summary")],
        code=code("provenance"),
    output:
        "results/film/provenance.json",
    log:
        "results/film/logs/provenance.log",
    message:
        "Write down what was solved"
    shell:
        "asphalt-nscd provenance --output {output} > {log} 2>&1"


rule publish_film:
    # What is committed of it. Only on request:
    #   snakemake publish_film --cores 1 --configfile config/paper.yaml
    input:
        files=[f"results/film/{file}" for file in ("pairs.csv", "shears.csv", "cells.csv", "provenance.json")],
        cells="results/film/cells_summary.csv",
        code=code("publish"),
    message:
        "Copy the tables of films, and fill that of docs/film.md"
    shell:
        "asphalt-nscd publish {input.files} --root results/film --output results/published/film --document docs --block film_cells={input.cells}"
