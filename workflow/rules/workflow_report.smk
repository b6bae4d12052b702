# Snakemake's own report, from the records of how each file was made. Not in a module: those records are of the whole
# workflow that the module is part of.


rule workflow_report:
    # Snakemake's own report, from the records of how each file was made. After ours, which looks for damaged files.
    localrule: True
    input:
        RESULTS,
        "<results>/report.html",
        study="<results>/study.json",
    output:
        "<results>/workflow.html",
    params:
        snakefile=lambda wildcards: os.path.relpath(workflow.main_snakefile),
    log:
        "<results>/logs/workflow_report.log",
    benchmark:
        "<results>/benchmarks/workflow_report.tsv"
    message:
        "Put down how each file was made: {output}"
    shell:
        "snakemake results --snakefile {params.snakefile} --configfile {input.study} --report {output} > {log} 2>&1"
