# Honest gains: reconstructed measurements are drawn from the family of laws that the extended simulation fits. The same
# design and scatter about mixes of two other families, diagnosed in the same way and predicted by the law on facets. Real
# tables too, if ASPHALT_NSCD_TABLES names a folder of them, those of cylinders in its folder tension-compression.

HONEST = "reconstruct" in STUDY["measurements"] and COMMON_LAW
DRAWN = ["huet_sayegh", "maxwell_ladder", "havriliak_negami"] if HONEST else []
REAL_TABLES = {}
if HONEST and "ASPHALT_NSCD_TABLES" in os.environ:
    sys.path.insert(0, str(Path(workflow.basedir, "trials")))
    from blind.real_plan import real_tables

    REAL_TABLES = {f"real_table_{number}": path for number, path in enumerate(real_tables(), 1)}
FAMILIES = [*DRAWN, *REAL_TABLES]
FAMILY = "<results>/families/{family}/"
OF_FAMILIES = f"env PYTHONPATH={Path(workflow.basedir, 'trials')} {sys.executable} -m families"


def of_test(family):
    """In which test a real table was measured."""
    path = REAL_TABLES.get(family)
    return " --measured-in tension-compression" if path and path.resolve().parent.name == "tension-compression" else ""


rule draw_family:
    input:
        code=[os.path.relpath(Path(workflow.basedir, f"trials/{name}.py")) for name in ("families", "blind/laws")],
    output:
        FAMILY + "moduli.csv",
    wildcard_constraints:
        family="|".join(DRAWN),
    params:
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
        OF_FAMILIES + " {wildcards.family} --seed {params.seed} --temperatures={params.temperatures} --frequencies {params.frequencies} --output {output} > {log} 2>&1"


rule copy_real_table:
    input:
        table=lambda wildcards: str(REAL_TABLES[wildcards.family]),
        code=[os.path.relpath(Path(workflow.basedir, f"trials/{name}.py")) for name in ("families", "blind/backgrounds")],
    output:
        FAMILY + "moduli.csv",
    wildcard_constraints:
        family=r"real_table_\d+",
    log:
        "<results>/logs/copy_real_table/{family}.log",
    benchmark:
        "<results>/benchmarks/copy_real_table/{family}.tsv"
    message:
        "Copy {wildcards.family}"
    shell:
        OF_FAMILIES + " {input.table:q} --output {output} > {log} 2>&1"


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
        settings=lambda wildcards: options(SETTINGS) + of_test(wildcards.family),
        campaigns="",
        folder=lambda wildcards, output: os.path.dirname(output[0]),
    log:
        "<results>/logs/diagnose_family/{family}.log",
    benchmark:
        "<results>/benchmarks/diagnose_family/{family}.tsv"
    message:
        "Diagnose the measurements of {wildcards.family}"
