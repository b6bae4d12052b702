# What is committed of a study: figures, tables, and the tables of README and docs. Only on request:
#   snakemake --cores 1 publish

BLOCKS = {"samples": "<results>/samples.csv", "timings": "<results>/timings.md"}
BLOCKS |= {"ladder": "<results>/ladder.csv"} if COMMON_LAW else {}
BLOCKS |= {name: f"<results>/{name}.csv" for name in ("bond_readings", "reconstructions") if name in TABLES}


rule publish:
    # After a run; README.md shows what was published last.
    input:
        **BLOCKS,
        files=[
            *(f"<results>/figures/{name}.png" for name in FIGURES),
            *(table for name in PAGES if (table := f"<results>/{name}.csv") not in EXPORTED),
            *DIAGNOSED,
            *COMMON_LAW,
            "<results>/provenance.json",
        ],
        code=code("publish"),
    params:
        root=f"results/{STUDY['study']}",
        output=f"results/published/{STUDY['study']}",
        blocks=lambda wildcards, input: [f"--block {name}={input[name]}" for name in BLOCKS],
    message:
        "Copy what is committed, and fill the tables of README and docs"
    shell:
        "asphalt-nscd publish {input.files} --root {params.root} --output {params.output} --document README.md --document docs {params.blocks}"


if STUDY["study"] == "paper":

    rule ship_specimen:
        # The specimen that `asphalt-nscd diagnose` takes where none is given. Only on request, like the above:
        #   snakemake --cores 1 ship_specimen
        input:
            f"<results>/diagnosis/specimens/{SAMPLES[0]}.h5",
        message:
            "Put the reduced specimen into the package"
        shell:
            "cp {input} src/asphalt_nscd/diagnosis/simulation/specimen.h5"


rule simulate_frames:
    # One test that keeps what all spheres and bonds do in its last cycle.
    input:
        compiled="<results>/compiled/simulate",
        model=FACET_MODEL,
        law=f"<results>/laws/{LAWS}/T{{temperature}}.json",
        code=code("simulate"),
    output:
        "<results>/frames/{sample}/T{temperature}/f{frequency}.h5",
    params:
        test=lambda wildcards: f"--temperature-c {wildcards.temperature} --frequency-hz {wildcards.frequency}",
        amplitude=STUDY["test"]["amplitude_m"],
    log:
        "<results>/logs/frames/{sample}/T{temperature}/f{frequency}.log",
    message:
        "Test sample {wildcards.sample} and keep 12 instants of a cycle"
    shell:
        "asphalt-nscd simulate {input.model} --law {input.law} {params.test} --amplitude-m {params.amplitude} --frames 12 --output {output} > {log} 2>&1"


rule specimen_picture:
    # A specimen and the forces in its bonds, for docs/packings.md; needs VTK. Only on request:
    #   snakemake --cores 1 specimen_picture --configfile config/smoke.yaml
    input:
        test=f"<results>/frames/{SAMPLES[0]}/T{TEMPERATURES[-1]}/f{FREQUENCIES[-1]}.h5",
        tool=shipped("tools/picture.py"),
        code=code("export"),
    output:
        "docs/specimen_forces.png",
    params:
        series=lambda wildcards, input: input.test.removesuffix("h5") + "pvd",
        python=sys.executable,
    log:
        "<results>/logs/specimen_picture.log",
    message:
        "Draw a specimen and the forces in its bonds"
    shell:
        "bash -c 'asphalt-nscd export {input.test} --format vtk --output {params.series} && "
        "{params.python} {input.tool} {params.series} --output {output}' > {log} 2>&1"


rule first_page:
    # The report's first page as a picture for the README; needs Chromium. Only on request, like the above:
    #   snakemake --cores 1 first_page
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


rule publish_faults:
    # After `make faults`, whose tables these are. Only on request:
    #   snakemake --cores 1 publish_faults
    input:
        summary="results/faults/summary.csv",
        files=["results/faults/faults.csv", "results/faults/provenance.json"],
        code=code("publish"),
    message:
        "Copy the table of faults, and fill its summary into docs"
    shell:
        "asphalt-nscd publish {input.files} --root results/faults --output results/published/faults --document docs --block faults={input.summary}"


rule publish_fuzz:
    # After `make fuzz`, whose tables of wild measurements these are. Only on request:
    #   snakemake --cores 1 publish_fuzz
    input:
        table="results/fuzz/wild.csv",
        files=["results/fuzz/wild_failures.csv", "results/fuzz/provenance.json"],
        code=code("publish"),
    message:
        "Copy how wild tables ended"
    shell:
        "asphalt-nscd publish {input.table} {input.files} --root results/fuzz --output results/published/fuzz"


rule publish_calls:
    # After `make fuzz`, which makes these calls of the Python functions. Only on request:
    #   snakemake --cores 1 publish_calls
    input:
        table="results/calls/calls.csv",
        files=["results/calls/call_failures.csv", "results/calls/calls_provenance.json"],
        code=code("publish"),
    message:
        "Copy how drawn calls ended"
    shell:
        "asphalt-nscd publish {input.table} {input.files} --root results/calls --output results/published/calls"


rule publish_mutants:
    # After a run of `mutants`, whose tables these are. Only on request:
    #   snakemake --cores 1 publish_mutants
    input:
        summary="results/mutants/summary.csv",
        files=["results/mutants/mutants.csv", "results/mutants/provenance.json"],
        code=code("publish"),
    message:
        "Copy which mutants the tests noticed, and fill their number into CONTRIBUTING.md"
    shell:
        "asphalt-nscd publish {input.files} --root results/mutants --output results/published/mutants --document CONTRIBUTING.md --block mutants={input.summary}"


rule publish_cluster:
    # After a run of trials/cluster, whose table this is. Only on request:
    #   snakemake --cores 1 publish_cluster
    input:
        table="results/cluster/cluster.csv",
        provenance="results/cluster/provenance.json",
        code=code("publish"),
    message:
        "Copy what a run through Slurm cost"
    shell:
        "asphalt-nscd publish {input.table} {input.provenance} --root results/cluster --output results/published/cluster"


rule rule_graph:
    # Which rule needs which, as a picture for docs/workflow.md. Only on request: snakemake --cores 1 rule_graph
    localrule: True
    input:
        rules=sorted(
            os.path.relpath(path) for path in [CLONE / "workflow/Snakefile", *(CLONE / "workflow/rules").glob("*.smk")]
        ),
        tool=shipped("tools/rule_graph.py"),
    output:
        "docs/rule_graph.svg",
    params:
        snakefile=os.path.relpath(workflow.main_snakefile),
        study=PAPER,
        python=sys.executable,
    log:
        "<results>/logs/rule_graph.log",
    message:
        "Draw which rule needs which: {output}"
    shell:
        "snakemake --snakefile {params.snakefile} --configfile {params.study} --nolock --rulegraph 2> {log} | {params.python} {input.tool} {output} >> {log} 2>&1"


rule step_picture:
    # How a step is made and checked, as a picture for docs/stepping.md. Only on request: snakemake --cores 1 step_picture
    localrule: True
    input:
        tool=shipped("tools/step_picture.py"),
    output:
        "docs/stepping.svg",
    params:
        python=sys.executable,
    log:
        "<results>/logs/step_picture.log",
    message:
        "Draw how a step is made: {output}"
    shell:
        "{params.python} {input.tool} {output} > {log} 2>&1"
