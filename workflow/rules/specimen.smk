# Section 3.2: numerical samples, from loose spheres to a bonded trapezoid.


rule compile:
    # Once before jobs run side by side. A stamp and kernels for each step, so that editing the tests pours nothing anew.
    input:
        code=lambda wildcards: code(wildcards.step),
    output:
        touch("<results>/compiled/{step}"),
    priority: 30  # pouring waits for it, and a core would idle; small jobs run beside it
    conda:
        ENVIRONMENT
    log:
        "<results>/logs/compile/{step}.log",
    benchmark:
        "<results>/benchmarks/compile/{step}.tsv"
    message:
        "Compile the core for {wildcards.step}"
    shell:
        "asphalt-nscd compile {wildcards.step} > {log} 2>&1"


rule deposit:
    # Table 2's spheres rain into the box and are vibrated by the top wall.
    input:
        compiled="<results>/compiled/deposit",
        counts=COUNTS,
        code=code("deposit"),
    output:
        "<results>/deposits/s{seed}.h5",
    params:
        box=text(STUDY["specimens"].get("box_m")),
        pouring=options(STUDY["specimens"].get("deposit", {})),
    priority: 10  # the longest jobs first
    threads: THREADS  # which change no number
    conda:
        ENVIRONMENT
    log:
        "<results>/logs/deposit/s{seed}.log",
    benchmark:
        "<results>/benchmarks/deposit/s{seed}.tsv"
    message:
        "Pour and vibrate sample s{wildcards.seed}; to watch: tail -f {log}"
    shell:
        "asphalt-nscd deposit --counts {input.counts:q} --box-m {params.box} --seed {wildcards.seed} {params.pouring} --threads {threads} --output {output} > {log} 2>&1"


if not POURED:

    rule import_packing:
        # Spheres that another program poured, in place of ours.
        input:
            packing=lambda wildcards: STUDY["specimens"]["packings"][int(wildcards.seed) - 1],
            code=code("import-packing"),
        output:
            "<results>/deposits/s{seed}.h5",
        params:
            read=" ".join(
                f"--{key} {STUDY['specimens'][f'packing_{key}']}"
                for key in ("unit", "up")
                if f"packing_{key}" in STUDY["specimens"]
            ),
        conda:
            ENVIRONMENT
        log:
            "<results>/logs/import_packing/s{seed}.log",
        benchmark:
            "<results>/benchmarks/import_packing/s{seed}.tsv"
        message:
            "Take the packing {input.packing} as sample s{wildcards.seed}"
        shell:
            "asphalt-nscd import-packing {input.packing:q} {params.read} --output {output} > {log} 2>&1"

    ruleorder: import_packing > deposit


rule trim:
    # Cut the trapezoid, turn it upright, shrink the spheres to make room for mastic, bond them.
    input:
        deposit="<results>/deposits/{sample}.h5",
        code=code("trim"),
    output:
        "<results>/specimens/{sample}.h5",
    params:
        geometry=text(STUDY["specimens"]["geometry"]),
        bonds=options(STUDY["specimens"]["bonds"], "area", "volume_reduction", "gap_max_mm"),
    conda:
        ENVIRONMENT
    log:
        "<results>/logs/trim/{sample}.log",
    benchmark:
        "<results>/benchmarks/trim/{sample}.tsv"
    message:
        "Trim sample {wildcards.sample} and bond its spheres"
    shell:
        "asphalt-nscd trim {input.deposit} --geometry {params.geometry:q} {params.bonds} --output {output} > {log} 2>&1"


rule condense:
    # Assemble the bonded system once for all tests on a sample, with its reduced form and the excerpt most tests need.
    input:
        compiled="<results>/compiled/simulate",
        specimen="<results>/specimens/{sample}.h5",
        code=code("condense"),
    output:
        model="<results>/models/{head}/{sample}.h5",
        excerpt="<results>/models/{head}/{sample}.excerpt.h5",
    params:
        bonds=options(STUDY["specimens"]["bonds"], "poisson", "kt_over_kn", "yield_Pa", "friction"),
        # steady oscillation breaks nothing, and a looser sample is tested once
        ready=lambda wildcards: "" if wildcards.head == HEAD and wildcards.sample in SAMPLES else "--stand-by 0",
    resources:
        mem_mb=lambda wildcards, attempt: 2700 * attempt,
    conda:
        ENVIRONMENT
    log:
        "<results>/logs/condense/{head}/{sample}.log",
    benchmark:
        "<results>/benchmarks/condense/{head}/{sample}.tsv"
    message:
        "Condense the bonds of sample {wildcards.sample}, head {wildcards.head} to rotate"
    shell:
        "asphalt-nscd condense {input.specimen} --head {wildcards.head} {params.bonds} {params.ready} --output {output.model} --excerpt-output {output.excerpt} > {log} 2>&1"


use rule deposit as deposit_loose with:
    # More friction leaves a looser layer.
    output:
        "<results>/deposits/s{seed}-friction{friction}.h5",
    params:
        box=text(STUDY["specimens"].get("box_m")),
        pouring=lambda wildcards: options(STUDY["specimens"]["deposit"] | {"friction": wildcards.friction}),
    log:
        "<results>/logs/deposit/s{seed}-friction{friction}.log",
    benchmark:
        "<results>/benchmarks/deposit_loose/s{seed}-friction{friction}.tsv"
    message:
        "Pour sample s{wildcards.seed} with friction {wildcards.friction}; to watch: tail -f {log}"
