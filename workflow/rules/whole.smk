# What needs the whole workflow: Snakemake's own report, from the records of how each file was made, and the archive of a
# study. Not in a module: those records are of the workflow that the module is part of.


rule workflow_report:
    """Snakemake's own report, from the records of how each file was made. After ours, which looks for damaged files."""
    input:
        RESULTS,
        "<results>/report.html",
        study="<results>/study.json",
    output:
        "<results>/workflow.html",
    log:
        "<results>/logs/workflow_report.log",
    benchmark:
        "<results>/benchmarks/workflow_report.tsv"
    localrule: True
    params:
        snakefile=shipped("workflow/Snakefile"),
    message:
        "Put down how each file was made: {output}"
    shell:
        "snakemake results --snakefile {params.snakefile} --configfile {input.study} --report {output} > {log} 2>&1"


rule ro_crate:
    """The study as one archive for a repository of data. Only on request: snakemake --cores 1 ro_crate"""
    input:
        files=["<results>/report.html", RESULTS],
        provenance="<results>/provenance.json",
        workflow=shipped("workflow/Snakefile"),
        code=code("ro-crate"),
    output:
        f"<results>/{STUDY['study']}.crate.zip",
    log:
        "<results>/logs/ro_crate.log",
    benchmark:
        "<results>/benchmarks/ro_crate.tsv"
    params:
        root=lambda wildcards, input: os.path.dirname(input.provenance),
    message:
        "Put the study into one archive: {output}"
    shell:
        "asphalt-nscd ro-crate {input.files} --root {params.root} --workflow {input.workflow} --provenance {input.provenance} --output {output} > {log} 2>&1"
