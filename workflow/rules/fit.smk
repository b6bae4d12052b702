# Section 4.1: one Burgers law for each temperature, Eqs. (27)-(29) and Table 3.


# Of a table of one's own the law of a temperature depends on the rows of this temperature alone, and on how they are reduced.
OWN_TABLE = "table" in STUDY["measurements"]


rule fit:
    """Section 4.1: the Burgers law of a temperature, by least squares on the complex modulus."""
    input:
        measured=[] if OWN_TABLE else "<results>/measured.csv",
        row=row_at(MEASUREMENTS if OWN_TABLE else None),
        records=lambda wildcards: records(MEASUREMENTS, float(wildcards.temperature)) if OWN_TABLE else [],
        shapes=SHAPES,
        code=code("fit"),
    output:
        "<results>/laws/fitted/T{temperature}.json",
    log:
        "<results>/logs/fit/T{temperature}.log",
    benchmark:
        "<results>/benchmarks/fit/T{temperature}.tsv"
    priority: 20  # before anything is poured: the measurements may yet be refused
    conda:
        ENVIRONMENT
    params:
        measured=lambda wildcards, input: MEASUREMENTS if OWN_TABLE else input.measured,
        reduced=f"--geometry {shlex.quote(REDUCED_BY['geometry'])} {REDUCED_BY['window']}" if OWN_TABLE else "",
    message:
        "Fit a Burgers law to the measurements at {wildcards.temperature} degC, Eqs. (27)-(29)"
    shell:
        "asphalt-nscd fit {params.measured:q} {params.reduced} --temperature-c {wildcards.temperature} --output {output} > {log} 2>&1"


rule published_law:
    """The Burgers law of a temperature in Table 3, in the unit that the study states; other rows do not count."""
    input:
        row=row_at(STUDY["laws"].get("published", {}).get("table")),
        code=code("published-law"),
    output:
        "<results>/laws/published/T{temperature}.json",
    log:
        "<results>/logs/published_law/T{temperature}.log",
    benchmark:
        "<results>/benchmarks/published_law/T{temperature}.tsv"
    priority: 20  # before anything is poured: the measurements may yet be refused
    conda:
        ENVIRONMENT
    params:
        table=STUDY["laws"].get("published", {}).get("table"),
        unit=STUDY["laws"].get("published", {}).get("unit"),
    message:
        "Take the published Burgers law at {wildcards.temperature} degC, Table 3"
    shell:
        "asphalt-nscd published-law {params.table:q} --temperature-c {wildcards.temperature} --unit {params.unit} --output {output} > {log} 2>&1"


rule scale_law:
    """Section 4.3: the law of the tests with one parameter times a factor."""
    input:
        law=LAW,
        code=studied("paper.scale_law"),
    output:
        "<results>/laws/scaled/{parameter}_{factor}/T{temperature}.json",
    log:
        "<results>/logs/scale_law/{parameter}_{factor}/T{temperature}.log",
    benchmark:
        "<results>/benchmarks/scale_law/{parameter}_{factor}/T{temperature}.tsv"
    conda:
        ENVIRONMENT
    params:
        script="paper/scale_law",
    message:
        "Law at {wildcards.temperature} degC with {wildcards.parameter} times {wildcards.factor}"
    script:
        SCRIPT


use rule published_law as pascal_law with:
    """The same in the unit that the paper prints."""
    output:
        "<results>/laws/pascal/T{temperature}.json",
    log:
        "<results>/logs/pascal_law/T{temperature}.log",
    benchmark:
        "<results>/benchmarks/pascal_law/T{temperature}.tsv"
    params:
        table=STUDY["laws"].get("published", {}).get("table"),
        unit="Pa",
    message:
        "Take the published Burgers law at {wildcards.temperature} degC in Pa, as printed"
