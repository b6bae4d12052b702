# Beyond the paper: the tests run again with what the diagnosis named in the simulation.
from itertools import product

EXTENDED = "<results>/extended/tests/{sample}/T{temperature}/f{frequency}.h5"
EXTENDED_LAWS = "<results>/extended/laws/{sample}/T{temperature}/f{frequency}.json"


rule extend:
    # One continuous law at the temperature of each test, as a Kelvin chain; causes at the head as a rig.
    input:
        diagnosis=DIAGNOSED[0],
        law=COMMON_LAW,
        measured="<results>/measured.csv",
        code=code("extend", *modules_of("diagnosis.causes")),
    output:
        laws=expand(EXTENDED_LAWS, temperature=TEMPERATURES, frequency=FREQUENCIES, allow_missing=True),
        rig="<results>/extended/rigs/{sample}.json",
    params:
        number=lambda wildcards: SAMPLES.index(wildcards.sample),
        geometry=text(STUDY["geometry"]),
        amplitude=STUDY["test"]["amplitude_m"],
        tests=lambda wildcards, output: " ".join(
            f"--test {temperature},{frequency},{law}"
            for (temperature, frequency), law in zip(product(TEMPERATURES, FREQUENCIES), output.laws, strict=True)
        ),
    conda:
        ENVIRONMENT
    log:
        "<results>/logs/extend/{sample}.log",
    benchmark:
        "<results>/benchmarks/extend/{sample}.tsv"
    message:
        "Extend the simulation of sample {wildcards.sample} by what the diagnosis named"
    shell:
        "asphalt-nscd extend {input.diagnosis} --law {input.law} --measured {input.measured} --geometry {params.geometry:q} --number {params.number} --amplitude-m {params.amplitude} {params.tests} --rig-output {output.rig} > {log} 2>&1"


use rule simulate as simulate_extended with:
    # The same tests, extended, in specimens with facets.
    input:
        compiled="<results>/compiled/simulate",
        model=FACET_MODEL,
        excerpt=FACET_EXCERPT,
        law=expand(EXTENDED_LAWS, frequency=FREQUENCIES, allow_missing=True),
        rig="<results>/extended/rigs/{sample}.json",
        code=code("simulate"),
    output:
        expand(EXTENDED, frequency=FREQUENCIES, allow_missing=True),
    params:
        source="diagnosis",
        tests=tests,
        test=lambda wildcards, input: f"{TEST} --rig {input.rig}",
    log:
        "<results>/logs/simulate_extended/{sample}/T{temperature}.log",
    benchmark:
        "<results>/benchmarks/simulate_extended/{sample}/T{temperature}.tsv"
    message:
        "Test sample {wildcards.sample} extended, at {wildcards.temperature} degC"


use rule simulations as extended_simulations with:
    # One row for each extended test.
    input:
        tests=expand(EXTENDED, sample=SAMPLES, temperature=TEMPERATURES, frequency=FREQUENCIES),
        code=code("collect"),
    output:
        "<results>/extended.csv",
    log:
        "<results>/logs/extended_simulations.log",
    benchmark:
        "<results>/benchmarks/extended_simulations.tsv"
    message:
        "Collect the extended bending tests"
