# The forecast: a mix from its binder and recipe, with no measurement of the mix; held against mixes that were measured.
#   snakemake forecast --cores all --configfile config/paper.yaml

RECIPE = "data/forecast/recipe.yaml"
FORECAST_FILES = [
    f"results/forecast/recipe/{name}" for name in ("rivals.csv", "law.json", "forecast.json", "forecast.html")
]

MADE["forecast_recipe"] = Made(
    "Forecast the mix of one recipe: modulus and phase with their band, law and page",
    "forecast {input.recipe} --output results/forecast/recipe",
    "results/forecast/recipe/forecast.csv",
    {"recipe": RECIPE},
    modules=["reporting.pages.forecast_page"],
    more={"beside": FORECAST_FILES},
)
SCRIPTED |= {
    "forecast_mixes": Scripted(
        "Hold the forecast, and who else does as well, against six mixes whose binder was measured too",
        "forecast/mixes",
        {table: f"results/forecast/mixes/{table}.csv" for table in ("errors", "points", "overall")},
        {"recipe": RECIPE, "mixes": "data/forecast/binder_mix.csv"},
    ),
    "forecast_voids": Scripted(
        "Hold the cost of a percent of air against specimens that differ in it",
        "forecast/voids",
        {"table": "results/forecast/voids.csv"},
        {
            "recipe": RECIPE,
            "campaign": sorted(f"data/ncat/{path.name}" for path in (CLONE / "data/ncat").glob("*.csv")),
        },
    ),
    "forecast_slopes": Scripted(
        "Hold the cost of a percent of air and of binder against measured stiffness",
        "forecast/slopes",
        {"table": "results/forecast/slopes.csv"},
        {"recipe": RECIPE, "slopes": "data/forecast/slopes.csv"},
    ),
    "forecast_blind": Scripted(
        "Hold the forecast against 25 mixes",  # on request: who saw which of them, and when, is in seen.csv
        "forecast/blind",
        {
            table: f"results/forecast/{file}.csv"
            for table, file in {
                "points": "blind",
                "mixes": "blind_mixes",
                "overall": "blind_overall",
                "tried": "blind_tried",
                "left_out": "blind_left_out",
                "binders": "blind_binders",
            }.items()
        },
        {
            "recipe": RECIPE,
            "recipes": "data/mixes50/recipes.csv",
            "moduli": "data/mixes50/modulus.csv",
            "seen": "data/mixes50/seen.csv",
        },
    ),
    "forecast_paper": Scripted(
        "Forecast the paper's mix from its grading and the grade of its binder, beside its Table 3",
        "forecast/paper_mix",
        {"table": "results/forecast/paper_mix.csv"},
        {"recipe": RECIPE, "grading": "data/paper/table1_grading.csv", "laws": "data/paper/table3_burgers.csv"},
    ),
}
SHOWN["forecast_figure"] = (
    "figure fig_forecast",
    "results/forecast/figures/fig_forecast",
    {"points": ["results/forecast/mixes/points.csv"]},
)
RECORDED["forecast_provenance"] = ("forecast", ["mixes/overall.csv"])


rule forecast:
    """A mix from its binder and recipe alone, and what that is worth."""
    input:
        [MADE["forecast_recipe"].output, *FORECAST_FILES],
        [SCRIPTED[name].output.values() for name in ("forecast_mixes", "forecast_voids")],
        multiext("results/forecast/figures/fig_forecast", ".pdf", ".png", ".svg"),
        "results/forecast/provenance.json",
