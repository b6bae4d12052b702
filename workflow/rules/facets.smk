# The first rung: where the study bonds spheres as the paper does, the same deposits bonded by facets (docs/mapping.md).

REMAPPED = STUDY["specimens"]["bonds"]["area"] == "paper"
FACETS = "<results>/facets" if REMAPPED else "<results>"  # what the rungs above it are simulated with
FACET_MODEL, FACET_EXCERPT = (f"{FACETS}/models/{HEAD}/{{sample}}.{kind}" for kind in ("h5", "excerpt.h5"))
FACET_TESTS = f"{FACETS}/tests/{{sample}}/T{{temperature}}/f{{frequency}}.h5"
FACET_SIMULATIONS = ["<results>/facets.csv"] if REMAPPED else []  # beside those of the study


if REMAPPED:

    use rule trim as trim_facets with:
        # The same spheres, bonded where their cells meet.
        output:
            "<results>/facets/specimens/{sample}.h5",
        params:
            geometry=text(STUDY["specimens"]["geometry"]),
            bonds=options(STUDY["specimens"]["bonds"] | {"area": "facets"}, "area", "volume_reduction", "gap_max_mm"),
        log:
            "<results>/logs/trim_facets/{sample}.log",
        benchmark:
            "<results>/benchmarks/trim_facets/{sample}.tsv"
        message:
            "Trim sample {wildcards.sample} and bond its spheres by facets"

    use rule condense as condense_facets with:
        input:
            compiled="<results>/compiled/simulate",
            specimen="<results>/facets/specimens/{sample}.h5",
            code=code("condense"),
        output:
            model="<results>/facets/models/{head}/{sample}.h5",
            excerpt="<results>/facets/models/{head}/{sample}.excerpt.h5",
        log:
            "<results>/logs/condense_facets/{head}/{sample}.log",
        benchmark:
            "<results>/benchmarks/condense_facets/{head}/{sample}.tsv"
        message:
            "Condense the facets of sample {wildcards.sample}, head {wildcards.head} to rotate"

    use rule simulate as simulate_facets with:
        # The tests of the paper, with the laws of the paper; all frequencies in one job, which starts once.
        input:
            compiled="<results>/compiled/simulate",
            model=FACET_MODEL,
            excerpt=FACET_EXCERPT,
            law=f"<results>/laws/{LAWS}/T{{temperature}}.json",
            code=code("simulate"),
        output:
            expand(FACET_TESTS, frequency=FREQUENCIES, allow_missing=True),
        log:
            "<results>/logs/simulate_facets/{sample}/T{temperature}.log",
        benchmark:
            "<results>/benchmarks/simulate_facets/{sample}/T{temperature}.tsv"
        message:
            "Test sample {wildcards.sample} with facets, at {wildcards.temperature} degC"

    use rule simulations as facet_simulations with:
        # One row for each test with facets.
        input:
            tests=expand(FACET_TESTS, sample=SAMPLES, temperature=TEMPERATURES, frequency=FREQUENCIES),
            code=code("collect"),
        output:
            FACET_SIMULATIONS,
        log:
            "<results>/logs/facet_simulations.log",
        benchmark:
            "<results>/benchmarks/facet_simulations.tsv"
        message:
            "Collect the bending tests with facets"
