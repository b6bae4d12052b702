# Is the core right? Apart from any study: `make verify`.

from asphalt_nscd.verification.study import MUTATIONS, THEMES


rule verify_theme:
    # One theme of the verification.
    input:
        code=code("verify", *modules_of("verification")),
    output:
        "results/verification/themes/{theme}.csv",
    conda:
        ENVIRONMENT
    log:
        "results/verification/logs/{theme}.log",
    benchmark:
        "results/verification/benchmarks/{theme}.tsv"
    message:
        "Verify the core: {wildcards.theme}"
    shell:
        "asphalt-nscd verify {wildcards.theme} --output {output} > {log} 2>&1"


rule verification:
    # All rows in one table, red ones too.
    input:
        tables=expand("results/verification/themes/{theme}.csv", theme=THEMES),
        code=code("verdict"),
    output:
        "results/verification/verification.csv",
    conda:
        ENVIRONMENT
    log:
        "results/verification/logs/verification.log",
    benchmark:
        "results/verification/benchmarks/verification.tsv"
    message:
        "Collect the verification"
    shell:
        "asphalt-nscd verdict {input.tables} --output {output} > {log} 2>&1"


rule verify:
    # Fails where a row has failed; the table stays.
    input:
        "results/verification/verification.csv",
    conda:
        ENVIRONMENT
    log:
        "results/verification/logs/verify.log",
    benchmark:
        "results/verification/benchmarks/verify.tsv"
    message:
        "Judge the verification"
    shell:
        "asphalt-nscd verdict {input} > {log} 2>&1"


rule mutations:
    # A wrong sign in an equation of the core must turn a row red; takes several times as long as the rows.
    input:
        f"results/verification/themes/{MUTATIONS}.csv",
    conda:
        ENVIRONMENT
    log:
        "results/verification/logs/judge_mutations.log",
    benchmark:
        "results/verification/benchmarks/judge_mutations.tsv"
    message:
        "Judge the mutants"
    shell:
        "asphalt-nscd verdict {input} > {log} 2>&1"


rule verification_summary:
    # One row for each theme, the mutants among them.
    input:
        tables=["results/verification/verification.csv", f"results/verification/themes/{MUTATIONS}.csv"],
        code=code("verdict"),
    output:
        "results/verification/summary.csv",
    conda:
        ENVIRONMENT
    log:
        "results/verification/logs/summary.log",
    benchmark:
        "results/verification/benchmarks/summary.tsv"
    message:
        "Count the rows of the verification"
    shell:
        "asphalt-nscd verdict {input.tables} --summary --output {output} > {log} 2>&1"


rule verification_provenance:
    input:
        "results/verification/summary.csv",
        code=code("provenance"),
    output:
        "results/verification/provenance.json",
    conda:
        ENVIRONMENT
    log:
        "results/verification/logs/provenance.log",
    benchmark:
        "results/verification/benchmarks/provenance.tsv"
    message:
        "Write down what was verified"
    shell:
        "asphalt-nscd provenance --output {output} > {log} 2>&1"


rule publish_verification:
    # What is committed of the verification. Only on request:
    #   snakemake --cores 1 publish_verification
    input:
        summary="results/verification/summary.csv",
        files=[
            "results/verification/verification.csv",
            f"results/verification/themes/{MUTATIONS}.csv",
            "results/verification/provenance.json",
        ],
        code=code("publish"),
    conda:
        ENVIRONMENT
    message:
        "Copy what is committed of the verification, and fill its table in docs"
    shell:
        "asphalt-nscd publish {input.files} --root results/verification --output results/published/verification --document docs --block verification={input.summary}"
