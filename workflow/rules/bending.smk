# Section 4.2: two-point bending of every sample at every temperature and frequency.

HEAD = STUDY["test"]["head"]
LAWS = STUDY["laws"]["simulate"]
MODEL, EXCERPT = (f"<results>/models/{HEAD}/{{sample}}.{kind}" for kind in ("h5", "excerpt.h5"))
STEPS = "steps_per_cycle" if "steps_per_cycle" in STUDY["test"] else "time_step_s"
TEST = options(STUDY["test"], "amplitude_m", "cycles", STEPS, "rest_steps")
TESTS = "<results>/tests/{sample}/T{temperature}/f{frequency}.h5"


def tests(wildcards, input, output):
    """One test for each file: its frequency, the law of all or its own, and the file."""
    frequencies = [wildcards.frequency] if "frequency" in wildcards.keys() else FREQUENCIES
    laws = [input.law] * len(frequencies) if isinstance(input.law, str) else input.law
    return " ".join(
        f"--frequency-hz {frequency} --law {law} --output {path}"
        for frequency, law, path in zip(frequencies, laws, output, strict=True)
    )


rule simulate:
    # One test: a sample, a temperature, a frequency.
    input:
        compiled="<results>/compiled/simulate",
        model=MODEL,
        excerpt=EXCERPT,
        law=f"<results>/laws/{LAWS}/T{{temperature}}.json",
        code=code("simulate"),
    output:
        TESTS,
    params:
        source=LAWS,
        tests=tests,
        test=TEST,
    resources:
        mem_mb=lambda wildcards, attempt: 1600 * attempt,
    conda:
        ENVIRONMENT
    log:
        "<results>/logs/simulate/{sample}/T{temperature}/f{frequency}.log",
    benchmark:
        "<results>/benchmarks/simulate/{sample}/T{temperature}/f{frequency}.tsv"
    message:
        "Test sample {wildcards.sample} at {wildcards.temperature} degC and {wildcards.frequency} Hz"
    shell:
        "asphalt-nscd simulate {input.model} --excerpt {input.excerpt} --law-source {params.source} --temperature-c {wildcards.temperature} {params.test} {params.tests} > {log} 2>&1"


rule simulations:
    # One row for each test.
    input:
        tests=expand(TESTS, sample=SAMPLES, temperature=TEMPERATURES, frequency=FREQUENCIES),
        code=code("collect"),
    output:
        "<results>/simulations.csv",
    conda:
        ENVIRONMENT
    log:
        "<results>/logs/simulations.log",
    benchmark:
        "<results>/benchmarks/simulations.tsv"
    message:
        "Collect the bending tests"
    shell:
        "asphalt-nscd collect {input.tests} --output {output} > {log} 2>&1"
