# Sample 1 of the study pulled to failure at 0 degC, in 100 steps and in 200 (docs/geometries.md). Eight minutes of a core, on request:
#   snakemake ramp --cores all --configfile config/paper.yaml

RAMPS = [f"results/ramp/{steps}.h5" for steps in (100, 200)]

MADE |= {
    "ramp_run": Made(
        "Pull sample 1 to failure in {wildcards.steps} steps",
        "ramp {input.model} --law {input.law} --temperature-c 0 --displacement-m 250e-6 --duration-s 0.02 --frames 21"
        " --steps {wildcards.steps}",
        "results/ramp/{steps}.h5",
        {"model": f"{model()}.h5".format(sample=SAMPLES[0]), "law": "<results>/laws/published/T0.json"},
    ),
    "ramp_film": Made(
        "Film the failure for ParaView: {output}",
        "export {input.ramp} --format vtk",
        "results/ramp/film.pvd",
        {"ramp": RAMPS[-1]},
    ),
    "ramp_curve": Made(
        "Write the curve of the failure",
        "export {input.ramp} --format csv",
        "results/ramp/curve.csv",
        {"ramp": RAMPS[-1]},
    ),
}
SHOWN |= {
    "ramp_table": ("table ramps", "results/ramp/ramps.csv", {"ramp": RAMPS}),
    "ramp_figure": ("figure fig_ramp", "results/ramp/figures/fig_ramp", {"ramp": RAMPS[::-1]}),
}
RECORDED["ramp"] = (
    "ramp",
    ["ramps.csv", "curve.csv", "film.pvd", *multiext("figures/fig_ramp", ".pdf", ".png", ".svg")],
)
