# Honest gains: reconstructed measurements are drawn from the family of laws that the extended simulation fits. The same
# design and scatter about mixes of two other families, diagnosed in the same way and predicted by the law on facets.

FAMILIES = ["huet_sayegh", "maxwell_ladder", "havriliak_negami"] if "reconstruct" in STUDY["measurements"] and COMMON_LAW else []
FAMILY = "<results>/families/{family}/"


rule draw_family:
    input:
        code=[os.path.relpath(Path(workflow.basedir, f"trials/{name}.py")) for name in ("families", "blind/laws")],
    output:
        FAMILY + "moduli.csv",
    params:
        python=f"env PYTHONPATH={Path(workflow.basedir, 'trials')} {sys.executable}",
        seed=STUDY["measurements"].get("reconstruct", {"seed": 0})["seed"],
        temperatures=text(STUDY["temperatures_C"]),
        frequencies=text(STUDY["frequencies_Hz"]),
    log:
        "<results>/logs/draw_family/{family}.log",
    benchmark:
        "<results>/benchmarks/draw_family/{family}.tsv"
    message:
        "Draw measurements from the family {wildcards.family}"
    shell:
        "{params.python} -m families {wildcards.family} --seed {params.seed} --temperatures={params.temperatures} --frequencies {params.frequencies} --output {output} > {log} 2>&1"


use rule reduce as reduce_family with:
    input:
        measurements=FAMILY + "moduli.csv",
        code=code("reduce"),
    output:
        FAMILY + "measured.csv",
    log:
        "<results>/logs/reduce_family/{family}.log",
    benchmark:
        "<results>/benchmarks/reduce_family/{family}.tsv"
    message:
        "Read the measurements of {wildcards.family}"


use rule diagnose as diagnose_family with:
    # One law for all temperatures, as for the measurements of the study.
    input:
        measured=FAMILY + "measured.csv",
        specimen=f"<results>/diagnosis/specimens/{SAMPLES[0]}.h5",
        code=code("diagnose", *modules_of("diagnosis.causes")),
    output:
        [FAMILY + os.path.basename(path) for path in [*DIAGNOSED, "law.json"]],
    params:
        geometry=text(STUDY["geometry"]),
        settings=options(SETTINGS),
        campaigns="",
        folder=lambda wildcards, output: os.path.dirname(output[0]),
    log:
        "<results>/logs/diagnose_family/{family}.log",
    benchmark:
        "<results>/benchmarks/diagnose_family/{family}.tsv"
    message:
        "Diagnose the measurements of {wildcards.family}"
