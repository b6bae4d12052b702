# Section 4.2: two-point bending of every sample at every temperature and frequency, and all tests that depart from it.


def tests(wildcards, input, output, together):
    """One test for each file: its frequency, the law of all or its own, and the file; the rig of all, if there is one."""
    frequencies = [wildcards.frequency] if "frequency" in wildcards.keys() else together
    laws = [input.law] * len(frequencies) if isinstance(input.law, str) else input.law
    return f"--rig {input.rig} " * bool(input.rig) + " ".join(
        f"--frequency-hz {frequency} --law {law} --output {path}"
        for frequency, law, path in zip(frequencies, laws, output, strict=True)
    )


for name, kind, together, number in [
    (name, kind, together, f"_{place}" * bool(place))
    for name, kind in TESTS.items()
    for place, together in enumerate(TOGETHER if kind.together else TOGETHER[:1])
]:

    rule:
        name:
            f"{name}{number}"
        input:
            compiled="<results>/compiled/simulate",
            model=f"{kind.model}.h5",
            excerpt=f"{kind.model}.excerpt.h5",
            law=expand(kind.law, frequency=together, allow_missing=True) if kind.own_laws else kind.law,
            rig=kind.rig,
            code=code("simulate"),
        output:
            expand(kind.record, frequency=together, allow_missing=True) if kind.together else kind.record,
        log:
            f"<results>/logs/{name}/{kind.place}{number}.log",
        benchmark:
            f"<results>/benchmarks/{name}/{kind.place}{number}.tsv"
        priority: kind.priority
        conda:
            ENVIRONMENT
        resources:
            mem_mb=lambda wildcards, attempt: 1600 * attempt,
        params:
            source=kind.source,
            tests=lambda wildcards, input, output, together=together: tests(wildcards, input, output, together),
            test=kind.test,
        message:
            kind.message
        shell:
            "asphalt-nscd simulate {input.model} --excerpt {input.excerpt} --law-source {params.source} --temperature-c {wildcards.temperature} {params.test} {params.tests} > {log} 2>&1"


for name, (table, files, kind) in COLLECTED.items():

    rule:
        name:
            name
        input:
            tests=files,
            code=code("collect"),
        output:
            f"<results>/{table}",
        log:
            f"<results>/logs/{name}.log",
        benchmark:
            f"<results>/benchmarks/{name}.tsv"
        conda:
            ENVIRONMENT
        message:
            f"Collect the {kind}"
        shell:
            "asphalt-nscd collect {input.tests} --output {output} > {log} 2>&1"
