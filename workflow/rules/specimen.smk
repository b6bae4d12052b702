# Section 3.2: numerical samples, from loose spheres to a bonded trapezoid.


rule compile:
    """Kernels of a step, once before jobs run side by side; a stamp for each, so that editing the tests pours nothing anew."""
    input:
        code=lambda wildcards: code(wildcards.step),
    output:
        touch("<results>/compiled/{step}"),
    log:
        "<results>/logs/compile/{step}.log",
    benchmark:
        "<results>/benchmarks/compile/{step}.tsv"
    priority: 30  # pouring waits for it, and a core would idle; small jobs run beside it
    conda:
        ENVIRONMENT
    message:
        "Compile the core for {wildcards.step}"
    shell:
        "asphalt-nscd compile {wildcards.step} > {log} 2>&1"


rule deposit:
    """Section 3.2: the spheres of Table 2 rain into the box and are vibrated by the top wall."""
    input:
        compiled="<results>/compiled/deposit",
        counts=COUNTS,
        content=content_of(COUNTS),
        code=code("deposit"),
    output:
        "<results>/deposits/s{seed}.h5",
    log:
        "<results>/logs/deposit/s{seed}.log",
    benchmark:
        "<results>/benchmarks/deposit/s{seed}.tsv"
    priority: 10  # the longest jobs first
    conda:
        ENVIRONMENT
    threads: THREADS  # which change no number
    params:
        box=text(STUDY["specimens"].get("box_m")),
        pouring=options(STUDY["specimens"].get("deposit", {})),
    message:
        "Pour and vibrate sample s{wildcards.seed}; to watch: tail -f {log}"
    shell:
        "asphalt-nscd deposit --counts {input.counts:q} --box-m {params.box} --seed {wildcards.seed} {params.pouring} --threads {threads} --output {output} > {log} 2>&1"


if not POURED:

    rule import_packing:
        """Spheres that another program poured, in place of ours."""
        input:
            packing=lambda wildcards: STUDY["specimens"]["packings"][int(wildcards.seed) - 1],
            code=code("import-packing"),
        output:
            "<results>/deposits/s{seed}.h5",
        log:
            "<results>/logs/import_packing/s{seed}.log",
        benchmark:
            "<results>/benchmarks/import_packing/s{seed}.tsv"
        conda:
            ENVIRONMENT
        params:
            read=" ".join(
                f"--{key} {STUDY['specimens'][f'packing_{key}']}"
                for key in ("unit", "up")
                if f"packing_{key}" in STUDY["specimens"]
            ),
        message:
            "Take the packing {input.packing} as sample s{wildcards.seed}"
        shell:
            "asphalt-nscd import-packing {input.packing:q} {params.read} --output {output} > {log} 2>&1"

    ruleorder: import_packing > deposit


for kind, made in SPECIMENS.items():

    rule:
        name:
            f"trim{kind}"
        input:
            deposit="<results>/deposits/{sample}.h5",
            code=code("trim"),
        output:
            f"<results>/{made.folder}specimens/{{sample}}.h5",
        log:
            f"<results>/logs/trim{kind}/{{sample}}.log",
        benchmark:
            f"<results>/benchmarks/trim{kind}/{{sample}}.tsv"
        conda:
            ENVIRONMENT
        params:
            geometry=text(made.geometry),
            bonds=made.bonds,
        message:
            f"Trim and bond sample {{wildcards.sample}}{made.how}"
        shell:
            "asphalt-nscd trim {input.deposit} --geometry {params.geometry:q} {params.bonds} --output {output} > {log} 2>&1"

    rule:
        name:
            f"condense{kind}"
        input:
            compiled="<results>/compiled/simulate",
            specimen=f"<results>/{made.folder}specimens/{{sample}}.h5",
            code=code("condense"),
        output:
            model=f"{model(made.folder, '{head}')}.h5",
            excerpt=f"{model(made.folder, '{head}')}.excerpt.h5",
        log:
            f"<results>/logs/condense{kind}/{{head}}/{{sample}}.log",
        benchmark:
            f"<results>/benchmarks/condense{kind}/{{head}}/{{sample}}.tsv"
        conda:
            ENVIRONMENT
        resources:
            mem_mb=lambda wildcards, attempt: 2700 * attempt,
        params:
            bonds=options(BONDS, "poisson", "kt_over_kn", "yield_Pa", "friction"),
            # steady oscillation breaks nothing, and other samples are tested once
            ready=lambda wildcards, tested=made.tested: (
                "" if wildcards.head == HEAD and wildcards.sample in tested else "--stand-by 0"
            ),
        message:
            f"Condense the bonds of sample {{wildcards.sample}}{made.how}, head {{wildcards.head}} to rotate"
        shell:
            "asphalt-nscd condense {input.specimen} --head {wildcards.head} {params.bonds} {params.ready} --output {output.model} --excerpt-output {output.excerpt} > {log} 2>&1"


use rule deposit as deposit_loose with:
    """The same with more friction, which leaves a looser layer."""
    output:
        "<results>/deposits/s{seed}-friction{friction}.h5",
    log:
        "<results>/logs/deposit_loose/s{seed}-friction{friction}.log",
    benchmark:
        "<results>/benchmarks/deposit_loose/s{seed}-friction{friction}.tsv"
    params:
        box=text(STUDY["specimens"].get("box_m")),
        pouring=lambda wildcards: options(STUDY["specimens"]["deposit"] | {"friction": wildcards.friction}),
    message:
        "Pour sample s{wildcards.seed} with friction {wildcards.friction}; to watch: tail -f {log}"
