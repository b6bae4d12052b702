# Beyond the paper: the tests run again with what the diagnosis named in the simulation.
from itertools import product

# What only says in words what was found, or what to test next.
SAID = ("diagnosis.words", "diagnosis.next_tests", "diagnosis.record.instructions")
NAMED = ["<results>/extended/diagnosis/diagnosis.json", "<results>/extended/diagnosis/law.json"]


use rule diagnose as name_causes with:
    """The same without its words: a sentence or an advice that changes must not simulate anything anew."""
    input:
        **COMPARED,
        code=code("diagnose", *modules_of("diagnosis.causes"), without=SAID),
    output:
        NAMED,
    log:
        "<results>/logs/name_causes.log",
    benchmark:
        "<results>/benchmarks/name_causes.tsv"
    message:
        "Name the causes that the extended simulation holds"


rule extend:
    """Laws and rig of the extended tests: one continuous law as Kelvin chains, causes at the head as a rig."""
    input:
        diagnosis=NAMED[0],
        law=NAMED[1],
        measured="<results>/measured.csv",
        shapes=SHAPES,
        code=code("extend", *modules_of("diagnosis.causes"), without=SAID),
    output:
        laws=expand(EXTENDED_LAWS, temperature=TEMPERATURES, frequency=FREQUENCIES, allow_missing=True),
        rig="<results>/extended/rigs/{sample}.json",
    log:
        "<results>/logs/extend/{sample}.log",
    benchmark:
        "<results>/benchmarks/extend/{sample}.tsv"
    conda:
        ENVIRONMENT
    params:
        number=lambda wildcards: SAMPLES.index(wildcards.sample),
        geometry=text(STUDY["geometry"]),
        amplitude=STUDY["test"]["amplitude_m"],
        tests=lambda wildcards, output: " ".join(
            f"--test {temperature},{frequency},{law}"
            for (temperature, frequency), law in zip(product(TEMPERATURES, FREQUENCIES), output.laws, strict=True)
        ),
    message:
        "Extend the simulation of sample {wildcards.sample} by what the diagnosis named"
    shell:
        "asphalt-nscd extend {input.diagnosis} --law {input.law} --measured {input.measured} --geometry {params.geometry:q} --number {params.number} --amplitude-m {params.amplitude} {params.tests} --rig-output {output.rig} > {log} 2>&1"
