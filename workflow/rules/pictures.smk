# Pictures of README and docs, and what ships with the package: each only on request.

if STUDY["study"] == "paper":

    rule ship_specimen:
        """The specimen that `asphalt-nscd diagnose` takes where none is given, put into the package."""
        input:
            f"<results>/diagnosis/specimens/{SAMPLES[0]}.h5",
        message:
            "Put the reduced specimen into the package"
        shell:
            "cp {input} src/asphalt_nscd/diagnosis/simulation/specimen.h5"


rule first_page:
    """The report's first page as a picture for the README. Needs Chromium."""
    input:
        "<results>/report.html",
    output:
        f"results/published/{STUDY['study']}/first_page.png",
    params:
        tests=shipped("trials"),
        python=sys.executable,
        folder=f"results/published/{STUDY['study']}",
    message:
        "Take a picture of the report's first page"
    shell:
        "bash -c 'env PYTHONPATH={params.tests} {params.python} -m browser {input} --picture {output} && "
        "asphalt-nscd publish {output} --root {params.folder} --output {params.folder}'"


rule rule_graph:
    """Which rule needs which, as a picture for docs/workflow.md."""
    input:
        snakefile=shipped("workflow/Snakefile"),
        rules=sorted(os.path.relpath(path) for path in (CLONE / "workflow/rules").glob("*.smk")),
        tool=shipped("tools/rule_graph.py"),
    output:
        "docs/rule_graph.svg",
    log:
        "<results>/logs/rule_graph.log",
    localrule: True
    params:
        study=PAPER,
        python=sys.executable,
    message:
        "Draw which rule needs which: {output}"
    shell:
        "snakemake --snakefile {input.snakefile} --configfile {params.study} --nolock --rulegraph 2> {log} | {params.python} {input.tool} {output} >> {log} 2>&1"
