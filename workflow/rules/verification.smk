# Is the core right? Apart from any study: `make verify`. Rows are computed by tests/theory.

THEORY = sorted((CLONE / "tests/theory").glob("*.py"))
TESTED = sorted({name for file in THEORY for name in re.findall(r"from asphalt_nscd\.(\S+) import", file.read_text())})


rule verify:
    """The core against theory; fails where a row has failed, which the log names."""
    input:
        tests=[os.path.relpath(path) for path in THEORY],
        code=noted_sources("theory", TESTED),
    output:
        multiext("results/verification/", "verification.csv", "summary.csv", "provenance.json"),
    log:
        "results/verification/logs/verification.log",
    benchmark:
        "results/verification/benchmarks/verification.tsv"
    threads: 4
    params:
        pytest=f"{sys.executable} -m pytest {CLONE / 'tests/theory'}",
    message:
        "Verify the core"
    shell:
        "env OPENBLAS_NUM_THREADS=1 {params.pytest} -n {threads} --dist loadfile --verification results/verification > {log} 2>&1"


rule mutants:
    """A wrong sign in the sources must turn a test red: hours, only on request; what was tried before stands."""
    log:
        "results/mutants/logs/mutants.log",
    params:
        mutants=f"env PYTHONPATH={CLONE / 'trials'} {sys.executable} -m mutants",
    message:
        "Try the mutants"
    shell:
        "{params.mutants} --output results/mutants > {log} 2>&1"


rule layouts:
    """Two hundred files as laboratories lay them out: each read as it was meant, or refused; never read wrongly."""
    input:
        trial=[shipped(f"trials/layouts/{path.name}") for path in sorted((CLONE / "trials/layouts").glob("*.*"))],
        code=local(stamp(".snakemake/code", "layouts", source_files("table_import.campaign", "api.reading")).as_posix()),
    output:
        multiext("results/layouts/", "layouts.csv", "summary.csv", "refusals.csv", "mends.csv", "provenance.json"),
    log:
        "results/layouts/logs/layouts.log",
    benchmark:
        "results/layouts/benchmarks/layouts.tsv"
    params:
        trial=f"env PYTHONPATH={CLONE / 'trials'}:$PYTHONPATH {sys.executable} -m layouts",
        number=200,
        seed=9_000_000,  # none that was looked at while the reader was written
    message:
        "Read files as laboratories lay them out"
    shell:
        "{params.trial} {params.number} {params.seed} --output results/layouts > {log} 2>&1"
