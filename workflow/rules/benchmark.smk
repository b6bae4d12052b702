# How fast is it beside its peers, and how does that grow? On the paper's sample 1: `make benchmark`.
#   make benchmark FCLIB="problems/*.hdf5" SIZES="1000 3000 10000 30000 200000"
# CPU times are compared side by side: run it alone, on one core. A peer that is not installed is said to be absent.
# What `benchmark` does not ask for is made on request.

import glob

SIZES = os.environ.get("SIZES", "1000 3000 10000").split()
PROBLEMS = sorted(glob.glob(os.environ.get("FCLIB", "")))
METHODS = ["sweeps", "condensed", "reduced", "chain", "yade"]
PEERS = ["liggghts", "yade"]


wildcard_constraints:
    peer="|".join(PEERS),


COMPILED = {step: f"<results>/compiled/{step}" for step in ("deposit", "simulate")}
SPHERES = {"compiled": COMPILED["deposit"], "counts": COUNTS}
MODELLED = {"compiled": COMPILED["simulate"], "model": f"{model()}.h5".format(sample=SAMPLES[0])}
TYPICAL_LAW = {"law": LAW.format(temperature=TYPICAL)}

MADE |= {
    "benchmark_pouring": Made(
        "Pour 14 160 spheres",
        "pouring.py nscd {input.counts} --rest {output.rest}",
        "results/benchmark/rows/pouring-nscd.csv",
        SPHERES,
        "deposit",
        more={"rest": "results/benchmark/rest.npy"},  # where they lie, for peers
    ),
    "benchmark_pouring_peer": Made(
        "Pour 14 160 spheres by {wildcards.peer}",
        "pouring.py {wildcards.peer} {input.counts} --rest {input.rest}",  # the same lattice and physical time
        "results/benchmark/rows/pouring-{peer}.csv",
        {"counts": COUNTS, "rest": "results/benchmark/rest.npy"},
        files=["benchmarks/pour.liggghts", "benchmarks/yade_pour.py"],
    ),
    "benchmark_cycle": Made(
        "One cycle of bending: {wildcards.method}",
        "cycle.py {wildcards.method} {input.model} {input.law} --specimen {input.specimen}",
        "results/benchmark/rows/cycle-{method}.csv",
        MODELLED | TYPICAL_LAW | {"specimen": f"<results>/specimens/{SAMPLES[0]}.h5"},
        "simulate",
        ["benchmarks/yade_bonds.py"],
    ),
    "benchmark_preparation": Made(
        "Pour and bond {wildcards.size} spheres",
        "growth.py prepare {wildcards.size} {input.counts} --specimen {output.specimen}",
        "results/benchmark/rows/preparation-{size}.csv",
        SPHERES,
        "deposit trim",
        more={"specimen": "results/benchmark/specimens/{size}.h5"},
    ),
    "benchmark_growth": Made(
        "Test a specimen of {wildcards.size} spheres poured",
        "growth.py test {wildcards.size} {input.specimen} {input.law}",
        "results/benchmark/rows/growth-{size}.csv",
        TYPICAL_LAW | {"compiled": COMPILED["simulate"], "specimen": "results/benchmark/specimens/{size}.h5"},
        "condense simulate",
    ),
    "benchmark_fclib": Made(
        "Solve problems in FCLIB's format",
        "fclib.py {input.problems}",
        "results/benchmark/rows/fclib.csv",
        {"problems": PROBLEMS},
        "fclib",
    ),
    "benchmark_diagnosis": Made(
        "Diagnose 54, 120 and 1000 tests",
        "diagnosis.py 54 120 1000",
        "results/benchmark/diagnosis.csv",
        steps="diagnose",
    ),
    "benchmark_outside": Made(
        "Bend beams of spheres that LIGGGHTS poured, and of ours",
        "outside.py {input.counts} --box 0.06,0.01,0.2 --seeds 1,2,3",  # what is compared does not depend on the size
        "results/benchmark/outside.csv",
        {"compiled": [*COMPILED.values()], "counts": shipped("config/smoke_counts.csv")},
        "deposit trim simulate",
        ["benchmarks/pour.liggghts"],
    ),
    "benchmark_density": Made(
        "Pour from three heights, and between smooth walls",
        "density.py {input.counts}",
        "results/benchmark/density.csv",
        SPHERES,
        "deposit",
    ),
}
MADE["benchmark"] = Made(
    "Collect the benchmarks: all, those that stand beside peers, and how each stage grows",
    "collect.py {input.rows} --output {output.table} --beside {output.beside} --growth {output.growth} --million {output.million}"
    " --earlier results/published/benchmark",  # of sizes and peers that are not measured now
    "results/benchmark/benchmark.csv",
    {
        "rows": [
            "results/benchmark/rows/pouring-nscd.csv",
            *expand("results/benchmark/rows/pouring-{peer}.csv", peer=PEERS),
            *expand("results/benchmark/rows/cycle-{method}.csv", method=METHODS),
            *expand("results/benchmark/rows/{part}-{size}.csv", part=["preparation", "growth"], size=SIZES),
            "results/benchmark/rows/fclib.csv",
        ]
    },
    more={
        "beside": "results/benchmark/beside.csv",
        "growth": "results/benchmark/growth.csv",
        "million": "results/benchmark/million.csv",
    },
)
RECORDED["benchmark_provenance"] = ("benchmark", ["benchmark.csv"])
