# Programs of benchmarks/ on one core: a rule for each entry of MEASURED.

for name, made in MEASURED.items():

    rule:
        name:
            name
        input:
            **made.input,
            code=[f"benchmarks/{made.command.split()[0]}", *made.files, *map(code, made.steps.split())],
        output:
            **made.more,
            table=made.output,
        log:
            log_of(made.output),
        threads: made.threads
        message:
            made.message
        shell:
            f"{MEASURE}/{made.command} --output {{output.table}} > {{log}} 2>&1"
