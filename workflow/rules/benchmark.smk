# How fast is it beside its peers, and how does that grow? On the paper's sample 1: `make benchmark`.
#   make benchmark FCLIB="problems/*.hdf5" SIZES="1000 3000 10000 30000 200000"
# CPU times are compared side by side: run it alone, on one core. A peer that is not installed is said to be absent.

import glob

SIZES = os.environ.get("SIZES", "1000 3000 10000").split()
PROBLEMS = sorted(glob.glob(os.environ.get("FCLIB", "")))
DIAGNOSED_TESTS = [54, 120, 1000]
METHODS = ["sweeps", "condensed", "reduced", "chain", "yade"]
MEASURE = f"env OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 NUMBA_NUM_THREADS=1 {sys.executable} benchmarks"
PEERS = ["liggghts", "yade"]


rule benchmark_pouring:
    # The paper's spheres poured and settled by NSCD; leaves the positions at rest for peers.
    input:
        compiled="<results>/compiled/deposit",
        counts=STUDY["specimens"]["counts_table"],
        code=["benchmarks/pouring.py", code("deposit")],
    output:
        row="results/benchmark/rows/pouring-nscd.csv",
        rest="results/benchmark/rest.npy",
    log:
        "results/benchmark/logs/pouring-nscd.log",
    message:
        "Pour 14 160 spheres"
    shell:
        MEASURE + "/pouring.py nscd {input.counts} --rest {output.rest} --output {output.row} > {log} 2>&1"


rule benchmark_pouring_peer:
    # The same lattice and physical time by another code.
    input:
        counts=STUDY["specimens"]["counts_table"],
        rest="results/benchmark/rest.npy",
        code=["benchmarks/pouring.py", "benchmarks/pour.liggghts", "benchmarks/yade_pour.py"],
    output:
        "results/benchmark/rows/pouring-{peer}.csv",
    wildcard_constraints:
        peer="|".join(PEERS),
    log:
        "results/benchmark/logs/pouring-{peer}.log",
    message:
        "Pour 14 160 spheres by {wildcards.peer}"
    shell:
        MEASURE + "/pouring.py {wildcards.peer} {input.counts} --rest {input.rest} --output {output} > {log} 2>&1"


rule benchmark_cycle:
    # One cycle of bending by one method.
    input:
        compiled="<results>/compiled/simulate",
        model=f"<results>/models/{HEAD}/{SAMPLES[0]}.h5",
        specimen=f"<results>/specimens/{SAMPLES[0]}.h5",
        law=f"<results>/laws/{LAWS}/T{label(AUDIT['temperature_C'])}.json",
        code=["benchmarks/cycle.py", "benchmarks/yade_bonds.py", code("simulate")],
    output:
        "results/benchmark/rows/cycle-{method}.csv",
    log:
        "results/benchmark/logs/cycle-{method}.log",
    message:
        "One cycle of bending: {wildcards.method}"
    shell:
        MEASURE + "/cycle.py {wildcards.method} {input.model} {input.law} --specimen {input.specimen} --output {output} > {log} 2>&1"


rule benchmark_preparation:
    # So many spheres poured, vibrated, trimmed and bonded.
    input:
        compiled="<results>/compiled/deposit",
        counts=STUDY["specimens"]["counts_table"],
        code=["benchmarks/growth.py", code("deposit"), code("trim")],
    output:
        row="results/benchmark/rows/preparation-{size}.csv",
        specimen="results/benchmark/specimens/{size}.h5",
    log:
        "results/benchmark/logs/preparation-{size}.log",
    message:
        "Pour and bond {wildcards.size} spheres"
    shell:
        MEASURE + "/growth.py prepare {wildcards.size} {input.counts} --specimen {output.specimen} --output {output.row} > {log} 2>&1"


rule benchmark_growth:
    # A test on them: condensed, reduced.
    input:
        compiled="<results>/compiled/simulate",
        specimen="results/benchmark/specimens/{size}.h5",
        law=f"<results>/laws/{LAWS}/T{label(AUDIT['temperature_C'])}.json",
        code=["benchmarks/growth.py", code("condense"), code("simulate")],
    output:
        "results/benchmark/rows/growth-{size}.csv",
    log:
        "results/benchmark/logs/growth-{size}.log",
    message:
        "Test a specimen of {wildcards.size} spheres poured"
    shell:
        MEASURE + "/growth.py test {wildcards.size} {input.specimen} {input.law} --output {output} > {log} 2>&1"


rule benchmark_fclib:
    # Frictional contact problems of others.
    input:
        problems=PROBLEMS,
        code=["benchmarks/fclib.py", code("fclib")],
    output:
        "results/benchmark/rows/fclib.csv",
    log:
        "results/benchmark/logs/fclib.log",
    message:
        "Solve problems in FCLIB's format"
    shell:
        MEASURE + "/fclib.py {input.problems} --output {output} > {log} 2>&1"


rule benchmark_law:
    # One law fitted to tests at all temperatures.
    input:
        code=["benchmarks/law.py", code("diagnose")],
    output:
        "results/benchmark/rows/law.csv",
    log:
        "results/benchmark/logs/law.log",
    message:
        "Fit a law to 54, 120 and 1000 tests"
    shell:
        MEASURE + "/law.py --output {output} > {log} 2>&1"


rule benchmark_diagnosis:
    # The whole of `asphalt-nscd diagnose` on a table of so many tests.
    input:
        code=["benchmarks/diagnosis.py", code("diagnose")],
    output:
        "results/benchmark/diagnosis.csv",
    params:
        tests=DIAGNOSED_TESTS,
    log:
        "results/benchmark/logs/diagnosis.log",
    message:
        "Diagnose {params.tests} tests"
    shell:
        MEASURE + "/diagnosis.py {params.tests} --output {output} > {log} 2>&1"


rule publish_diagnosis_times:
    # What is committed of them, and their table in docs. Only on request: snakemake --cores 1 publish_diagnosis_times
    input:
        table="results/benchmark/diagnosis.csv",
        code=code("publish"),
    message:
        "Copy the times of a diagnosis, and fill their table in docs"
    shell:
        "asphalt-nscd publish {input.table} --root results/benchmark --output results/published/benchmark --document docs --block diagnosis_times={input.table}"


rule benchmark:
    # One table, the part of it that stands beside peers, and how each stage grows.
    input:
        rows=[
            "results/benchmark/rows/pouring-nscd.csv",
            *expand("results/benchmark/rows/pouring-{peer}.csv", peer=PEERS),
            *expand("results/benchmark/rows/cycle-{method}.csv", method=METHODS),
            *expand("results/benchmark/rows/{part}-{size}.csv", part=["preparation", "growth"], size=SIZES),
            "results/benchmark/rows/fclib.csv",
            "results/benchmark/rows/law.csv",
            "results/benchmark/diagnosis.csv",
        ],
        code="benchmarks/collect.py",
    output:
        table="results/benchmark/benchmark.csv",
        beside="results/benchmark/beside.csv",
        growth="results/benchmark/growth.csv",
    params:
        earlier="results/published/benchmark",  # of sizes and peers that are not measured now
    log:
        "results/benchmark/logs/collect.log",
    message:
        "Collect the benchmarks"
    shell:
        MEASURE + "/collect.py {input.rows} --output {output.table} --beside {output.beside} --growth {output.growth} --earlier {params.earlier} > {log} 2>&1"


rule benchmark_outside:
    # Packings of LIGGGHTS and ours, bonded and bent alike. At small size: what is compared does not depend on it.
    input:
        compiled=["<results>/compiled/deposit", "<results>/compiled/simulate"],
        counts=shipped("config/smoke_counts.csv"),
        code=["benchmarks/outside.py", "benchmarks/pour.liggghts", code("deposit"), code("trim"), code("simulate")],
    output:
        "results/benchmark/outside.csv",
    log:
        "results/benchmark/logs/outside.log",
    message:
        "Bend beams of spheres that LIGGGHTS poured, and of ours"
    shell:
        MEASURE + "/outside.py {input.counts} --box 0.06,0.01,0.2 --seeds 1,2,3 --output {output} > {log} 2>&1"


rule publish_outside:
    # What is committed of them. Only on request: snakemake --cores 1 publish_outside
    input:
        table="results/benchmark/outside.csv",
        code=code("publish"),
    message:
        "Copy the comparison of packings"
    shell:
        "asphalt-nscd publish {input.table} --root results/benchmark --output results/published/benchmark"


rule benchmark_density:
    # How dense a layer becomes, by the height of its fall and the friction of the walls. A minute: only on request.
    input:
        compiled="<results>/compiled/deposit",
        counts=STUDY["specimens"]["counts_table"],
        code=["benchmarks/density.py", code("deposit")],
    output:
        "results/benchmark/density.csv",
    log:
        "results/benchmark/logs/density.log",
    message:
        "Pour from three heights, and between smooth walls"
    shell:
        MEASURE + "/density.py {input.counts} --output {output} > {log} 2>&1"


rule publish_density:
    # What is committed of them, and their table in docs. Only on request: snakemake --cores 1 publish_density
    input:
        table="results/benchmark/density.csv",
        code=code("publish"),
    message:
        "Copy the densities of layers, and fill their table in docs"
    shell:
        "asphalt-nscd publish {input.table} --root results/benchmark --output results/published/benchmark --document docs --block density={input.table}"


rule benchmark_provenance:
    input:
        "results/benchmark/benchmark.csv",
        code=code("provenance"),
    output:
        "results/benchmark/provenance.json",
    log:
        "results/benchmark/logs/provenance.log",
    message:
        "Write down what was measured"
    shell:
        "asphalt-nscd provenance --output {output} > {log} 2>&1"


rule publish_benchmark:
    # What is committed of them, and their tables in docs. Only on request:
    #   snakemake --cores 1 publish_benchmark
    input:
        table="results/benchmark/benchmark.csv",
        beside="results/benchmark/beside.csv",
        growth="results/benchmark/growth.csv",
        provenance="results/benchmark/provenance.json",
        code=code("publish"),
    message:
        "Copy the benchmarks, and fill their tables in docs"
    shell:
        "asphalt-nscd publish {input.table} {input.beside} {input.growth} {input.provenance} --root results/benchmark --output results/published/benchmark --document docs --block benchmark={input.beside} --block growth={input.growth}"
