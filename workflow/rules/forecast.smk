# The forecast: a mix from its binder and recipe, with no measurement of the mix; held against mixes that were measured.
#   snakemake forecast --cores all --configfile config/paper.yaml
# Publish with: snakemake publish_forecast --cores 1 --configfile config/paper.yaml

RECIPE = "data/forecast/recipe.yaml"
FORECAST_FILES = ["forecast.csv", "rivals.csv", "law.json", "forecast.json", "forecast.html"]

# Scripts of studies/ import each other and, where the clone is not installed, its package.
_installed = not DEPLOYED and shutil.which("asphalt-nscd", path=Path(sys.executable).parent)
_roots = [CLONE / "studies", *([] if _installed else [CLONE / "src"]), os.environ.get("PYTHONPATH")]
os.environ["PYTHONPATH"] = os.pathsep.join(str(root) for root in _roots if root)


def studied(name):
    """What stands for the source behind a script of studies/forecast."""
    files = source_files(CLONE / f"studies/forecast/{name}.py")
    return local(stamp(".snakemake/code", f"studies-forecast-{name}", files).as_posix())


rule forecast_packings:
    # Filler, sand and stones, each poured from its own part of the grading.
    input:
        recipe=RECIPE,
        code=studied("packings"),
    output:
        directory("results/forecast/packings"),
    conda:
        ENVIRONMENT
    log:
        "results/forecast/logs/packings.log",
    benchmark:
        "<results>/benchmarks/forecast_packings.tsv"
    message:
        "Pour the levels of the recipe"
    script:
        "../../studies/forecast/packings.py"


rule forecast_recipe:
    # One recipe: modulus and phase with their doubts, law and page.
    input:
        recipe=RECIPE,
        packings="results/forecast/packings",
        code=code("forecast", "reporting.pages.forecast_page"),
    output:
        expand("results/forecast/recipe/{file}", file=FORECAST_FILES),
    params:
        folder=lambda wildcards, output: os.path.dirname(output[0]),
    conda:
        ENVIRONMENT
    log:
        "results/forecast/logs/recipe.log",
    benchmark:
        "<results>/benchmarks/forecast_recipe.tsv"
    message:
        "Forecast the mix of the recipe"
    shell:
        "asphalt-nscd forecast {input.recipe} --packings {input.packings} --output {params.folder} > {log} 2>&1"


rule forecast_mixes:
    # Six mixes whose binder was measured too: what each part of the physics is worth, and who else does as well.
    input:
        recipe=RECIPE,
        mixes="data/forecast/binder_mix.csv",
        packings="results/forecast/packings",
        code=studied("mixes"),
    output:
        **{table: f"results/forecast/mixes/{table}.csv" for table in ("errors", "points", "overall", "bands")},
    conda:
        ENVIRONMENT
    log:
        "results/forecast/logs/mixes.log",
    benchmark:
        "<results>/benchmarks/forecast_mixes.tsv"
    message:
        "Hold the forecast against six measured mixes"
    script:
        "../../studies/forecast/mixes.py"


rule forecast_voids:
    # What a percent of air costs, beside specimens that differ in it.
    input:
        recipe=RECIPE,
        campaign=[f"data/ncat/{table}" for table in sorted(os.listdir(CLONE / "data/ncat")) if table.endswith(".csv")],
        packings="results/forecast/packings",
        code=studied("voids"),
    output:
        "results/forecast/voids.csv",
    conda:
        ENVIRONMENT
    log:
        "results/forecast/logs/voids.log",
    benchmark:
        "<results>/benchmarks/forecast_voids.tsv"
    message:
        "Hold the cost of air voids against the NCAT specimens"
    script:
        "../../studies/forecast/voids.py"


rule forecast_blind:
    # Mixes on which no rule of the forecast was chosen. Only on request.
    input:
        recipe=RECIPE,
        recipes="data/mixes50/recipes.csv",
        moduli="data/mixes50/modulus.csv",
        seen="data/mixes50/seen.csv",
        packings="results/forecast/packings",
        code=studied("blind"),
    output:
        points="results/forecast/blind.csv",
        mixes="results/forecast/blind_mixes.csv",
        overall="results/forecast/blind_overall.csv",
    conda:
        ENVIRONMENT
    log:
        "results/forecast/logs/blind.log",
    benchmark:
        "<results>/benchmarks/forecast_blind.tsv"
    message:
        "Hold the forecast against mixes that it has not seen"
    script:
        "../../studies/forecast/blind.py"


rule forecast_paper:
    # The paper's mix from its grading and the grade of its binder, beside its Table 3.
    input:
        recipe=RECIPE,
        grading="data/paper/table1_grading.csv",
        laws="data/paper/table3_burgers.csv",
        code=studied("paper_mix"),
    output:
        table="results/forecast/paper_mix.csv",
        packings=directory("results/forecast/paper_packings"),
    conda:
        ENVIRONMENT
    log:
        "results/forecast/logs/paper.log",
    benchmark:
        "<results>/benchmarks/forecast_paper.tsv"
    message:
        "Forecast the paper's mix from the grade of its binder"
    script:
        "../../studies/forecast/paper_mix.py"


rule forecast_wrong_recipes:
    # Recipes with one wrong input, drawn by models that are not the forecast's. Only on request.
    input:
        recipe=RECIPE,
        packings="results/forecast/packings",
        code=studied("wrong_recipes"),
    output:
        "results/forecast/wrong_recipes.csv",
    conda:
        ENVIRONMENT
    log:
        "results/forecast/logs/wrong_recipes.log",
    benchmark:
        "<results>/benchmarks/forecast_wrong_recipes.tsv"
    message:
        "Name the wrong inputs of drawn recipes"
    script:
        "../../studies/forecast/wrong_recipes.py"


rule forecast_figure:
    input:
        points="results/forecast/mixes/points.csv",
        code=code("figure", "reporting.figures.fig_forecast"),
    output:
        multiext("results/forecast/figures/fig_forecast", ".pdf", ".png", ".svg"),
    conda:
        ENVIRONMENT
    log:
        "results/forecast/logs/figure.log",
    benchmark:
        "<results>/benchmarks/forecast_figure.tsv"
    message:
        "Draw the forecasts beside the measurements"
    shell:
        "asphalt-nscd figure fig_forecast points={input.points} --output-stem results/forecast/figures/fig_forecast > {log} 2>&1"


rule forecast_provenance:
    input:
        "results/forecast/mixes/overall.csv",
        code=code("provenance"),
    output:
        "results/forecast/provenance.json",
    conda:
        ENVIRONMENT
    log:
        "results/forecast/logs/provenance.log",
    message:
        "Write down what was forecast"
    shell:
        "asphalt-nscd provenance --output {output} > {log} 2>&1"


rule forecast:
    # All of it.
    input:
        rules.forecast_packings.output,
        rules.forecast_recipe.output,
        rules.forecast_mixes.output,
        rules.forecast_figure.output,
        rules.forecast_voids.output,
        rules.forecast_provenance.output,


rule publish_forecast:
    # What is committed of it. Only on request.
    input:
        overall="results/forecast/mixes/overall.csv",
        errors="results/forecast/mixes/errors.csv",
        bands="results/forecast/mixes/bands.csv",
        voids="results/forecast/voids.csv",
        paper="results/forecast/paper_mix.csv",
        wrong="results/forecast/wrong_recipes.csv",
        blind=expand("results/forecast/blind{part}.csv", part=["", "_mixes", "_overall"]),
        figure="results/forecast/figures/fig_forecast.png",
        provenance="results/forecast/provenance.json",
        code=code("publish"),
    conda:
        ENVIRONMENT
    message:
        "Copy the table of forecasts and its figure, and fill the table of docs/forecast.md"
    shell:
        "asphalt-nscd publish {input.overall} {input.errors} {input.bands} {input.voids} {input.paper} {input.wrong} {input.blind} {input.figure} {input.provenance} --root results/forecast --output results/published/forecast --document docs --block forecast={input.overall} --block wrong_recipes={input.wrong} --block forecast_blind={input.blind[2]}"
