# Is the core right? Apart from any study: `make verify`. Rows are computed by tests/theory.

THEORY = sorted((CLONE / "tests/theory").glob("*.py"))
TESTED = sorted({name for file in THEORY for name in re.findall(r"from asphalt_nscd\.(\S+) import", file.read_text())})


rule verify:
    # The core against theory. Fails where a row has failed, which the log names.
    input:
        tests=[os.path.relpath(path) for path in THEORY],
        code=local(stamp(".snakemake/code", "theory", source_files(*TESTED)).as_posix()),
    output:
        multiext("results/verification/", "verification.csv", "summary.csv", "provenance.json"),
    threads: 4
    log:
        "results/verification/logs/verification.log",
    benchmark:
        "results/verification/benchmarks/verification.tsv"
    message:
        "Verify the core"
    shell:
        "env OPENBLAS_NUM_THREADS=1 {sys.executable} -m pytest {CLONE}/tests/theory -n {threads} --dist loadfile --verification results/verification > {log} 2>&1"


rule mutants:
    # A wrong sign in the sources must turn a test red; hours. What was tried before, with the same sources, stands.
    # Only on request:
    #   snakemake --cores 1 mutants
    log:
        "results/mutants/logs/mutants.log",
    message:
        "Try the mutants"
    shell:
        "env PYTHONPATH={CLONE}/trials {sys.executable} -m mutants --output results/mutants > {log} 2>&1"


rule publish_verification:
    # What is committed of the verification. Only on request:
    #   snakemake --cores 1 publish_verification
    input:
        files=["results/verification/verification.csv", "results/verification/provenance.json"],
        summary="results/verification/summary.csv",
        code=code("publish"),
    message:
        "Copy what is committed of the verification, and fill its table in docs"
    shell:
        "asphalt-nscd publish {input.files} --root results/verification --output results/published/verification --document docs --block verification={input.summary}"
