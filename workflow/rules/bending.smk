# Section 4.2: two-point bending of every sample at every temperature and frequency.

HEAD = STUDY["test"]["head"]
LAWS = STUDY["laws"]["simulate"]
TESTS = "<results>/tests/{sample}/T{temperature}/f{frequency}.h5"


rule simulate:
    # One test: one sample, one temperature, one frequency.
    input:
        compiled="<results>/compiled/simulate",
        model=f"<results>/models/{HEAD}/{{sample}}.h5",
        law=f"<results>/laws/{LAWS}/T{{temperature}}.json",
        code=code("simulate"),
    output:
        TESTS,
    params:
        source=LAWS,
        test=options(STUDY["test"], "amplitude_m", "cycles", "time_step_s", "rest_steps"),
    resources:
        mem_mb=1200,
    log:
        "<results>/logs/simulate/{sample}/T{temperature}/f{frequency}.log",
    benchmark:
        "<results>/benchmarks/simulate/{sample}/T{temperature}/f{frequency}.tsv"
    message:
        "Test sample {wildcards.sample} at {wildcards.temperature} degC, {wildcards.frequency} Hz"
    shell:
        "asphalt-nscd simulate {input.model} --law {input.law} --law-source {params.source} --temperature-c {wildcards.temperature} --frequency-hz {wildcards.frequency} {params.test} --output {output} > {log} 2>&1"


rule simulations:
    # One row for each test.
    input:
        tests=expand(TESTS, sample=SAMPLES, temperature=TEMPERATURES, frequency=FREQUENCIES),
        code=code("collect"),
    output:
        "<results>/simulations.csv",
    log:
        "<results>/logs/simulations.log",
    benchmark:
        "<results>/benchmarks/simulations.tsv"
    message:
        "Collect the bending tests"
    shell:
        "asphalt-nscd collect {input.tests} --output {output} > {log} 2>&1"
