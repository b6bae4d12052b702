# Section 4.3: which parameter of the law does what. One is changed at a time.

SENSITIVITY = STUDY.get("sensitivity", {"temperature_C": 0, "factors": [], "parameters": []})
SCALED_LAW = "<results>/laws/scaled/{parameter}_{factor}/T{temperature}.json"
SCALED_TESTS = "<results>/sensitivity/{parameter}_{factor}/{sample}/T{temperature}/f{frequency}.h5"


rule scale_law:
    # The law of the tests with one parameter times a factor.
    input:
        law=f"<results>/laws/{LAWS}/T{{temperature}}.json",
        code=code("scale-law"),
    output:
        SCALED_LAW,
    conda:
        ENVIRONMENT
    log:
        "<results>/logs/scale_law/{parameter}_{factor}/T{temperature}.log",
    benchmark:
        "<results>/benchmarks/scale_law/{parameter}_{factor}/T{temperature}.tsv"
    message:
        "Law at {wildcards.temperature} degC with {wildcards.parameter} times {wildcards.factor}"
    shell:
        "asphalt-nscd scale-law {input.law} --parameter {wildcards.parameter} --factor {wildcards.factor} --output {output} > {log} 2>&1"


use rule simulate as simulate_scaled with:
    # The same tests with the changed law.
    input:
        compiled="<results>/compiled/simulate",
        model=MODEL,
        excerpt=EXCERPT,
        law=SCALED_LAW,
        code=code("simulate"),
    output:
        expand(SCALED_TESTS, frequency=FREQUENCIES, allow_missing=True),
    params:
        source="{parameter}:{factor}",
        tests=tests,
        test=TEST,
    log:
        "<results>/logs/simulate_scaled/{parameter}_{factor}/{sample}/T{temperature}.log",
    benchmark:
        "<results>/benchmarks/simulate_scaled/{parameter}_{factor}/{sample}/T{temperature}.tsv"
    message:
        "Test sample {wildcards.sample} with {wildcards.parameter} times {wildcards.factor}"


use rule simulations as sensitivity with:
    # One row for each test with a changed law.
    input:
        tests=expand(
            SCALED_TESTS,
            parameter=SENSITIVITY["parameters"],
            factor=[label(factor) for factor in SENSITIVITY["factors"]],
            sample=SAMPLES,
            temperature=label(SENSITIVITY["temperature_C"]),
            frequency=FREQUENCIES,
        ),
        code=code("collect"),
    output:
        "<results>/sensitivity.csv",
    log:
        "<results>/logs/sensitivity.log",
    benchmark:
        "<results>/benchmarks/sensitivity.tsv"
    message:
        "Collect the sensitivity tests"
