# Specimens of every test at full size against the law: E*, creep, relaxation. On request; the prism takes 90 minutes of a core:
#   snakemake rigs --cores all --configfile config/paper.yaml
#   RIGS=cylinder tests one of them; the prism takes 45 000 spheres.

RIGS = {"cylinder": "tension-compression", "prism": "four-point bending"}
TESTED_RIGS = os.environ.get("RIGS", " ".join(RIGS)).split()

for rig, test in RIGS.items():
    MADE[f"rigs_{rig}"] = Made(
        f"Test a {rig} of full size",
        f"rigs.py measure {test!r} {{input.laws}}",
        f"results/rigs/rows/{rig}.csv",
        {"laws": expand("<results>/laws/published/T{temperature}.json", temperature=[0, 15, 30])},
        "deposit trim condense simulate hold",
    )
MADE["rigs_table"] = Made(
    "Collect the tests of full size",
    "rigs.py collect {input.rows} --summary {output.summary}",
    "results/rigs/rigs.csv",
    {"rows": expand("results/rigs/rows/{rig}.csv", rig=TESTED_RIGS)},
    more={"summary": "results/rigs/summary.csv"},
)
RECORDED["rigs"] = ("rigs", ["rigs.csv"])
