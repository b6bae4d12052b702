# Section 2: the two-point bending tests and their reduction, Eqs. (1)-(5).

MEASUREMENTS = STUDY["measurements"].get("table", "<results>/measurements.csv")


def records(table, temperature=None):
    """Sampled records that a table of measurements names, at all temperatures or one, as far as they are there."""
    if not Path(table).is_file():
        return []
    # what cannot be decoded is refused, with a sentence, by the rule that reads the table
    with open(table, encoding="utf-8-sig", errors="replace", newline="") as file:
        rows = csv.DictReader(file)
        wanted = (row for row in rows if temperature is None or is_number(row.get("temperature_C") or "", temperature))
        named = [row.get("record") for row in wanted]
        return [local(str(path)) for name in named if name and (path := Path(table).parent / name).is_file()]


rule reconstruct:
    """Measurements from the published laws, called "reconstructed" from here on: the authors' are not published."""
    input:
        table=STUDY["laws"]["published"]["table"] if "published" in STUDY["laws"] else [],
        shapes=SHAPES,
        code=code("reconstruct"),
    output:
        measurements="<results>/measurements.csv",
        law="<results>/laws/reconstruction.json",
    log:
        "<results>/logs/reconstruct.log",
    benchmark:
        "<results>/benchmarks/reconstruct.tsv"
    priority: 20  # before anything is poured: the measurements may yet be refused
    conda:
        ENVIRONMENT
    params:
        geometry=text(STUDY["geometry"]),
        frequencies=text(STUDY["frequencies_Hz"]),
        amplitude=options(STUDY["test"], "amplitude_m"),
        scatter=options(STUDY["measurements"].get("reconstruct", {})),
    message:
        "Reconstruct measurements from the published laws"
    shell:
        "asphalt-nscd reconstruct {input.table:q} --geometry {params.geometry:q} --frequencies-hz {params.frequencies} {params.amplitude} {params.scatter} --law-output {output.law} --output {output.measurements} > {log} 2>&1"


REDUCED_BY = {"geometry": text(STUDY["geometry"]), "window": options(STUDY.get("reduction", {}))}


rule reduce:
    """Section 2: forces and displacements at the head as complex moduli."""
    input:
        measurements=MEASUREMENTS,
        content=content_of(STUDY["measurements"].get("table")),
        records=records(MEASUREMENTS),
        shapes=SHAPES,
        code=code("reduce"),
    output:
        "<results>/measured.csv",
    log:
        "<results>/logs/reduce.log",
    benchmark:
        "<results>/benchmarks/reduce.tsv"
    priority: 20  # before anything is poured: the measurements may yet be refused
    conda:
        ENVIRONMENT
    params:
        **REDUCED_BY,
    message:
        "Reduce the measurements to complex moduli, Eqs. (1)-(5)"
    shell:
        "asphalt-nscd reduce {input.measurements:q} --geometry {params.geometry:q} {params.window} --output {output} > {log} 2>&1"
