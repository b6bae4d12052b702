# Beside the paper: readings of it that fail, and looser samples.

AUDIT = STUDY.get("audit", {"seed": 0, "temperature_C": 0})
PACKING = STUDY.get("packing_study", {"frictions": [], "seed": 0, "temperature_C": 0, "frequency_Hz": 0})
PACKED = [f"s{PACKING['seed']}", *(f"s{PACKING['seed']}-friction{label(value)}" for value in PACKING["frictions"])]
PACKED_TEST = "<results>/packing/{sample}/T{temperature}/f{frequency}.h5"
LIKELY = "likeliest_friction" in AUDIT
LIKELY_SAMPLE = f"s{AUDIT['seed']}-friction{label(AUDIT['likeliest_friction'])}" if LIKELY else ""
LIKELY_MODEL = f"<results>/likely/models/{HEAD}/{{sample}}"
LIKELY_TESTS = "<results>/likely/tests/{sample}/T{temperature}/f{frequency}.h5"
LIKELY_SIMULATIONS = ["<results>/likely.csv"] if LIKELY else []
AUDITED = expand(
    "<results>/{{reading}}/s{seed}/T{temperature}/f{frequency}.h5",
    seed=AUDIT["seed"],
    temperature=label(AUDIT["temperature_C"]),
    frequency=FREQUENCIES,
)


use rule published_law as pascal_law with:
    # Table 3 in the unit that the paper prints.
    output:
        "<results>/laws/pascal/T{temperature}.json",
    params:
        table=STUDY["laws"].get("published", {}).get("table"),
        unit="Pa",
    log:
        "<results>/logs/pascal_law/T{temperature}.log",
    benchmark:
        "<results>/benchmarks/pascal_law/T{temperature}.tsv"
    message:
        "Take the published Burgers law at {wildcards.temperature} degC in Pa, as printed"


use rule simulate as simulate_pascal with:
    # A specimen a thousand times softer: its own resonance falls among the tests.
    input:
        compiled="<results>/compiled/simulate",
        model=MODEL,
        excerpt=EXCERPT,
        law="<results>/laws/pascal/T{temperature}.json",
        code=code("simulate"),
    output:
        expand("<results>/pascal/{sample}/T{temperature}/f{frequency}.h5", frequency=FREQUENCIES, allow_missing=True),
    params:
        source="pascal",
        tests=tests,
        # steady oscillation: waves from the start do not die out in so soft a specimen
        test=options(STUDY["test"], "amplitude_m", "cycles", "time_step_s") + " --method harmonic",
    log:
        "<results>/logs/simulate_pascal/{sample}/T{temperature}.log",
    benchmark:
        "<results>/benchmarks/simulate_pascal/{sample}/T{temperature}.tsv"
    message:
        "Test with Table 3 in Pa"


use rule simulate as simulate_blocked with:
    # A head that cannot rotate, against the beam theory behind Eqs. (1)-(3).
    input:
        compiled="<results>/compiled/simulate",
        model="<results>/models/blocked/{sample}.h5",
        excerpt="<results>/models/blocked/{sample}.excerpt.h5",
        law=f"<results>/laws/{LAWS}/T{{temperature}}.json",
        code=code("simulate"),
    params:
        source=LAWS,
        tests=tests,
        # steady oscillation: a head that cannot rotate overloads bonds, which would hide its own effect
        test=options(STUDY["test"], "amplitude_m", "cycles", "time_step_s") + " --method harmonic",
    output:
        expand("<results>/blocked/{sample}/T{temperature}/f{frequency}.h5", frequency=FREQUENCIES, allow_missing=True),
    log:
        "<results>/logs/simulate_blocked/{sample}/T{temperature}.log",
    benchmark:
        "<results>/benchmarks/simulate_blocked/{sample}/T{temperature}.tsv"
    message:
        "Test with the head's rotation blocked"


use rule simulations as readings with:
    # One row for each of these tests.
    input:
        tests=expand(AUDITED, reading=["pascal", "blocked"]),
        code=code("collect"),
    output:
        "<results>/readings.csv",
    log:
        "<results>/logs/readings.log",
    benchmark:
        "<results>/benchmarks/readings.tsv"
    message:
        "Collect the tests under other readings"


use rule simulate as simulate_packed with:
    # One test on a sample poured with more friction, and on one poured as the others.
    output:
        PACKED_TEST,
    log:
        "<results>/logs/simulate_packed/{sample}/T{temperature}/f{frequency}.log",
    benchmark:
        "<results>/benchmarks/simulate_packed/{sample}/T{temperature}/f{frequency}.tsv"
    message:
        "Test sample {wildcards.sample} for its packing"


if REMAPPED:

    use rule simulate_facets as simulate_packed_facets with:
        # The same with facets.
        output:
            "<results>/facets/packing/{sample}/T{temperature}/f{frequency}.h5",
        log:
            "<results>/logs/simulate_packed_facets/{sample}/T{temperature}/f{frequency}.log",
        benchmark:
            "<results>/benchmarks/simulate_packed_facets/{sample}/T{temperature}/f{frequency}.tsv"
        message:
            "Test sample {wildcards.sample} with facets for its packing"


if LIKELY:
    BONDS = STUDY["specimens"]["bonds"]

    use rule trim as trim_likely with:
        # Pairs within dmin of the spheres as they are once reduced.
        output:
            "<results>/likely/specimens/{sample}.h5",
        params:
            geometry=text(STUDY["specimens"]["geometry"]),
            bonds=options(BONDS, "volume_reduction")
            + f" --gap-max-mm {BONDS['gap_max_mm'] * (1.0 - BONDS['volume_reduction']) ** (1.0 / 3.0)}",
        log:
            "<results>/logs/trim_likely/{sample}.log",
        benchmark:
            "<results>/benchmarks/trim_likely/{sample}.tsv"
        message:
            "Trim sample {wildcards.sample} as the authors most likely did"

    use rule condense as condense_likely with:
        input:
            compiled="<results>/compiled/simulate",
            specimen="<results>/likely/specimens/{sample}.h5",
            code=code("condense"),
        output:
            model="<results>/likely/models/{head}/{sample}.h5",
            excerpt="<results>/likely/models/{head}/{sample}.excerpt.h5",
        params:
            bonds=options(BONDS, "poisson", "kt_over_kn", "yield_Pa", "friction"),
            ready="",
        log:
            "<results>/logs/condense_likely/{head}/{sample}.log",
        benchmark:
            "<results>/benchmarks/condense_likely/{head}/{sample}.tsv"
        message:
            "Condense the bonds of sample {wildcards.sample} as the authors most likely read them"

    use rule simulate as simulate_likely with:
        # All frequencies of a temperature in one job.
        input:
            compiled="<results>/compiled/simulate",
            model=f"{LIKELY_MODEL}.h5",
            excerpt=f"{LIKELY_MODEL}.excerpt.h5",
            law=f"<results>/laws/{LAWS}/T{{temperature}}.json",
            code=code("simulate"),
        output:
            expand(LIKELY_TESTS, frequency=FREQUENCIES, allow_missing=True),
        log:
            "<results>/logs/simulate_likely/{sample}/T{temperature}.log",
        benchmark:
            "<results>/benchmarks/simulate_likely/{sample}/T{temperature}.tsv"
        message:
            "Test sample {wildcards.sample} as the authors most likely did, at {wildcards.temperature} degC"

    use rule simulations as likely_simulations with:
        input:
            tests=expand(LIKELY_TESTS, sample=LIKELY_SAMPLE, temperature=TEMPERATURES, frequency=FREQUENCIES),
            code=code("collect"),
        output:
            LIKELY_SIMULATIONS,
        log:
            "<results>/logs/likely_simulations.log",
        benchmark:
            "<results>/benchmarks/likely_simulations.tsv"
        message:
            "Collect the tests under the likeliest reading"


rule packing:
    # The same test on samples poured with more friction.
    input:
        tests=expand(
            PACKED_TEST,
            sample=PACKED,
            temperature=label(PACKING["temperature_C"]),
            frequency=label(PACKING["frequency_Hz"]),
        ),
        facets=expand(
            "<results>/facets/packing/{sample}/T{temperature}/f{frequency}.h5",
            sample=PACKED,
            temperature=label(PACKING["temperature_C"]),
            frequency=label(PACKING["frequency_Hz"]),
        )
        if REMAPPED
        else [],
        deposits=expand("<results>/deposits/{sample}.h5", sample=PACKED),
        code=code("table", "reporting.tables.packing"),
    output:
        "<results>/packing.csv",
    params:
        data=pairs,
    conda:
        ENVIRONMENT
    log:
        "<results>/logs/packing.log",
    benchmark:
        "<results>/benchmarks/packing.tsv"
    message:
        "Set the packing of samples beside their modulus"
    shell:
        "asphalt-nscd table packing {params.data:q} --output {output} > {log} 2>&1"
