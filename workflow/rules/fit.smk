# Section 4.1: one Burgers law for each temperature, Eqs. (27)-(29) and Table 3.


rule fit:
    # To the measurements, by least squares on the complex modulus.
    input:
        measured="<results>/measured.csv",
        code=code("fit"),
    output:
        "<results>/laws/fitted/T{temperature}.json",
    priority: 20  # before anything is poured: the measurements may yet be refused
    conda:
        ENVIRONMENT
    log:
        "<results>/logs/fit/T{temperature}.log",
    benchmark:
        "<results>/benchmarks/fit/T{temperature}.tsv"
    message:
        "Fit a Burgers law to the measurements at {wildcards.temperature} degC, Eqs. (27)-(29)"
    shell:
        "asphalt-nscd fit {input.measured} --temperature-c {wildcards.temperature} --output {output} > {log} 2>&1"


rule published_law:
    # As printed in Table 3, read in the unit that the study states. Other rows of the table do not count.
    input:
        row=row_at(STUDY["laws"].get("published", {}).get("table")),
        code=code("published-law"),
    output:
        "<results>/laws/published/T{temperature}.json",
    params:
        table=STUDY["laws"].get("published", {}).get("table"),
        unit=STUDY["laws"].get("published", {}).get("unit"),
    priority: 20  # before anything is poured: the measurements may yet be refused
    conda:
        ENVIRONMENT
    log:
        "<results>/logs/published_law/T{temperature}.log",
    benchmark:
        "<results>/benchmarks/published_law/T{temperature}.tsv"
    message:
        "Take the published Burgers law at {wildcards.temperature} degC, Table 3"
    shell:
        "asphalt-nscd published-law {params.table:q} --temperature-c {wildcards.temperature} --unit {params.unit} --output {output} > {log} 2>&1"
