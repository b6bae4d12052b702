# Honest gains: reconstructed measurements are drawn from the family of laws that the extended simulation fits. The same
# design and scatter about mixes of other families, and measured tables, diagnosed in the same way and predicted by the law
# on facets.

DRAWN = []
if CLONE and COMMON_LAW and "reconstruct" in STUDY["measurements"]:
    DRAWN = ["huet_sayegh", "maxwell_ladder", "havriliak_negami"]
BESIDE = STUDY.get("tables_beside", {"tables": [], "measured_in": "bending"})
# by folder and name: data/ncat/N1-1_RH.csv is ncat_N1-1_RH
TABLES_BESIDE = {
    "_".join([Path(path).parent.name, Path(path).stem]): local(path) for path in BESIDE["tables"] if COMMON_LAW
}
FAMILIES = [*DRAWN, *TABLES_BESIDE]
FAMILY = "<results>/families/{family}/"


rule draw_family:
    """Measurements of a mix of another family of laws, with the design and scatter of those of the study."""
    input:
        code=[shipped(f"trials/{name}.py") for name in ("families", "drawn/design", "drawn/laws")] if DRAWN else [],
    output:
        f"{FAMILY}moduli.csv",
    log:
        "<results>/logs/draw_family/{family}.log",
    benchmark:
        "<results>/benchmarks/draw_family/{family}.tsv"
    wildcard_constraints:
        family="|".join(DRAWN),
    conda:
        ENVIRONMENT
    params:
        program=f"env PYTHONPATH={os.path.relpath(CLONE / 'trials')} python -m families" if DRAWN else "",
        seed=STUDY["measurements"].get("reconstruct", {"seed": 0})["seed"],
        temperatures=text(STUDY["temperatures_C"]),
        frequencies=text(STUDY["frequencies_Hz"]),
    message:
        "Draw measurements from the family {wildcards.family}"
    shell:
        "{params.program} {wildcards.family} --seed {params.seed} --temperatures={params.temperatures} --frequencies {params.frequencies} --output {output} > {log} 2>&1"


use rule reduce as reduce_family with:
    """Those, or measurements of a real mix, as complex moduli."""
    input:
        measurements=lambda wildcards: TABLES_BESIDE.get(
            wildcards.family, f"<results>/families/{wildcards.family}/moduli.csv"
        ),
        code=code("reduce"),
    output:
        f"{FAMILY}measured.csv",
    log:
        "<results>/logs/reduce_family/{family}.log",
    benchmark:
        "<results>/benchmarks/reduce_family/{family}.tsv"
    message:
        "Read the measurements of {wildcards.family}"


use rule diagnose as diagnose_family with:
    """Those diagnosed: one law for all temperatures, as for the measurements of the study."""
    input:
        measured=f"{FAMILY}measured.csv",
        specimen=f"<results>/diagnosis/specimens/{SAMPLES[0]}.h5",
        shapes=SHAPES,
        code=code("diagnose", *modules_of("diagnosis.causes")),
    output:
        [f"{FAMILY}{os.path.basename(path)}" for path in [*DIAGNOSED, "law.json"]],
    log:
        "<results>/logs/diagnose_family/{family}.log",
    benchmark:
        "<results>/benchmarks/diagnose_family/{family}.tsv"
    params:
        geometry=text(STUDY["geometry"]),
        settings=lambda wildcards: options(
            SETTINGS | ({"measured_in": BESIDE["measured_in"]} if wildcards.family in TABLES_BESIDE else {})
        ),
        campaigns="",
        folder=lambda wildcards, output: os.path.dirname(output[0]),
    message:
        "Diagnose the measurements of {wildcards.family}"
