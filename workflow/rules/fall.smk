# A beam of bonded spheres, sawn in two, that falls and comes to rest (docs/core.md). A few minutes of a core, on request:
#   snakemake fall --cores all --configfile config/paper.yaml

FALLS = [f"results/fall/{step}.h5" for step in ("8e-4", "4e-4", "2e-4")]  # s
_shape = {"b_mm": 18, "B_mm": 20, "e_mm": 20, "h_mm": 100, "mass_kg": 0.09, "mobile_mass_kg": 0.1}

MADE |= {
    "fall_deposit": Made(
        "Pour the large grains of a small beam",
        "deposit --counts {input.counts:q} --box-m 0.1,0.02,0.2 --seed 1 --vibration-s 0",
        "results/fall/deposit.h5",
        {"counts": shipped("config/fall_counts.csv")},
    ),
    "fall_specimen": Made(
        "Cut and bond a small beam",
        f"trim {{input.deposit}} --geometry {text(_shape)} --area facets",
        "results/fall/specimen.h5",
        {"deposit": "results/fall/deposit.h5"},
    ),
    "fall_run": Made(
        "Let a sawn beam fall by 40 mm on its edge, in steps of {wildcards.time_step} s",
        "fall {input.specimen} --law {input.law} --height-mm 40 --tilt-deg 50 --duration-s 0.8 --frames 81"
        " --time-step-s {wildcards.time_step}",
        "results/fall/{time_step}.h5",
        {"specimen": "results/fall/specimen.h5", "law": "<results>/laws/published/T15.json"},
    ),
    "fall_film": Made(
        "Film the fall for ParaView: {output}",
        "export {input.fall} --format vtk",
        "results/fall/film.pvd",
        {"fall": FALLS[-1]},
    ),
}
SHOWN |= {
    "fall_table": ("table falls", "results/fall/falls.csv", {"fall": FALLS}),  # where its energy goes
    "fall_figure": ("figure fig_fall", "results/fall/figures/fig_fall", {"fall": FALLS[-1:]}),
}
RECORDED["fall"] = ("fall", ["falls.csv", "film.pvd", *multiext("figures/fig_fall", ".pdf", ".png", ".svg")])
