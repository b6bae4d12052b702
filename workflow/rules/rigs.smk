# Specimens of every test at full size against the law: E*, creep, relaxation. Ten minutes of a core, on request:
#   snakemake rigs --cores all --configfile config/paper.yaml
#   RIGS=cylinder tests one of them; the prism takes 45 000 spheres.
# Publish with: snakemake publish_rigs --cores 1 --configfile config/paper.yaml

RIGS = {"cylinder": "tension-compression", "prism": "four-point bending"}
TESTED_RIGS = os.environ.get("RIGS", " ".join(RIGS)).split()


rule rigs_rows:
    # One specimen, poured and tested by the public calls.
    input:
        laws=expand("<results>/laws/published/T{temperature}.json", temperature=[0, 15, 30]),
        code=["benchmarks/rigs.py", code("deposit"), code("trim"), code("condense"), code("simulate"), code("hold")],
    output:
        "results/rigs/rows/{rig}.csv",
    params:
        test=lambda wildcards: RIGS[wildcards.rig],
    log:
        "results/rigs/logs/{rig}.log",
    benchmark:
        "results/rigs/benchmarks/{rig}.tsv"
    message:
        "Test a {wildcards.rig} of full size"
    shell:
        MEASURE + "/rigs.py measure {params.test:q} {input.laws} --output {output} > {log} 2>&1"


rule rigs_table:
    input:
        rows=expand("results/rigs/rows/{rig}.csv", rig=TESTED_RIGS),
        code="benchmarks/rigs.py",
    output:
        table="results/rigs/rigs.csv",
        summary="results/rigs/summary.csv",
    log:
        "results/rigs/logs/table.log",
    message:
        "Collect the tests of full size"
    shell:
        MEASURE + "/rigs.py collect {input.rows} --output {output.table} --summary {output.summary} > {log} 2>&1"


rule rigs:
    # What was tested, and by what.
    input:
        "results/rigs/rigs.csv",
        code=code("provenance"),
    output:
        "results/rigs/provenance.json",
    conda:
        ENVIRONMENT
    log:
        "results/rigs/logs/provenance.log",
    message:
        "Write down what was tested"
    shell:
        "asphalt-nscd provenance --output {output} > {log} 2>&1"


rule publish_rigs:
    # What is committed of it. Only on request.
    input:
        table="results/rigs/rigs.csv",
        summary="results/rigs/summary.csv",
        provenance="results/rigs/provenance.json",
        code=code("publish"),
    conda:
        ENVIRONMENT
    message:
        "Copy the tables of the rigs, and fill the table of docs/geometries.md"
    shell:
        "asphalt-nscd publish {input.table} {input.provenance} --root results/rigs --output results/published/rigs --document docs --block rigs={input.summary}"
