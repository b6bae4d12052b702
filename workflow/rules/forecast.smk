# The forecast: a mix from its binder and recipe, with no measurement of the mix; held against mixes that were measured.
#   snakemake forecast --cores all --configfile config/paper.yaml

RECIPE = "data/forecast/recipe.yaml"
FORECAST_FILES = ["forecast.csv", "rivals.csv", "law.json", "forecast.json", "forecast.html"]


rule forecast_recipe:
    """One recipe: modulus and phase with their band, law and page."""
    input:
        recipe=RECIPE,
        code=code("forecast", "reporting.pages.forecast_page"),
    output:
        expand("results/forecast/recipe/{file}", file=FORECAST_FILES),
    log:
        "results/forecast/logs/recipe.log",
    benchmark:
        "<results>/benchmarks/forecast_recipe.tsv"
    conda:
        ENVIRONMENT
    params:
        folder=lambda wildcards, output: os.path.dirname(output[0]),
    message:
        "Forecast the mix of the recipe"
    shell:
        "asphalt-nscd forecast {input.recipe} --output {params.folder} > {log} 2>&1"


rule forecast_mixes:
    """Six mixes whose binder was measured too: who else does as well."""
    input:
        recipe=RECIPE,
        mixes="data/forecast/binder_mix.csv",
        code=studied("forecast.mixes"),
    output:
        **{table: f"results/forecast/mixes/{table}.csv" for table in ("errors", "points", "overall")},
    log:
        "results/forecast/logs/mixes.log",
    benchmark:
        "<results>/benchmarks/forecast_mixes.tsv"
    conda:
        ENVIRONMENT
    message:
        "Hold the forecast against six measured mixes"
    script:
        "../../studies/forecast/mixes.py"


rule forecast_voids:
    """What a percent of air costs, beside specimens that differ in it."""
    input:
        recipe=RECIPE,
        campaign=[f"data/ncat/{table}" for table in sorted(os.listdir(CLONE / "data/ncat")) if table.endswith(".csv")],
        code=studied("forecast.voids"),
    output:
        "results/forecast/voids.csv",
    log:
        "results/forecast/logs/voids.log",
    benchmark:
        "<results>/benchmarks/forecast_voids.tsv"
    conda:
        ENVIRONMENT
    message:
        "Hold the cost of air voids against the NCAT specimens"
    script:
        "../../studies/forecast/voids.py"


rule forecast_blind:
    """Mixes on which no rule of the forecast was chosen; only on request."""
    input:
        recipe=RECIPE,
        recipes="data/mixes50/recipes.csv",
        moduli="data/mixes50/modulus.csv",
        seen="data/mixes50/seen.csv",
        code=studied("forecast.blind"),
    output:
        points="results/forecast/blind.csv",
        mixes="results/forecast/blind_mixes.csv",
        overall="results/forecast/blind_overall.csv",
        tried="results/forecast/blind_tried.csv",
    log:
        "results/forecast/logs/blind.log",
    benchmark:
        "<results>/benchmarks/forecast_blind.tsv"
    conda:
        ENVIRONMENT
    message:
        "Hold the forecast against mixes that it has not seen"
    script:
        "../../studies/forecast/blind.py"


rule forecast_paper:
    """The paper's mix from its grading and the grade of its binder, beside its Table 3."""
    input:
        recipe=RECIPE,
        grading="data/paper/table1_grading.csv",
        laws="data/paper/table3_burgers.csv",
        code=studied("forecast.paper_mix"),
    output:
        "results/forecast/paper_mix.csv",
    log:
        "results/forecast/logs/paper.log",
    benchmark:
        "<results>/benchmarks/forecast_paper.tsv"
    conda:
        ENVIRONMENT
    message:
        "Forecast the paper's mix from the grade of its binder"
    script:
        "../../studies/forecast/paper_mix.py"


SHOWN["forecast_figure"] = (
    "figure fig_forecast",
    "results/forecast/figures/fig_forecast",
    {"points": ["results/forecast/mixes/points.csv"]},
)
RECORDED["forecast_provenance"] = ("forecast", ["mixes/overall.csv"])


rule forecast:
    """A mix from its binder and recipe alone, and what that is worth."""
    input:
        rules.forecast_recipe.output,
        rules.forecast_mixes.output,
        rules.forecast_voids.output,
        multiext("results/forecast/figures/fig_forecast", ".pdf", ".png", ".svg"),
        "results/forecast/provenance.json",
