# What ends a campaign beside the study: its figures and tables, and the record of what made them.

# Rule: step and what it shows, its file less the ending of a figure, {kind of data: files}.
SHOWN = {
    "forecast_figure": (
        "figure fig_forecast",
        "results/forecast/figures/fig_forecast",
        {"points": ["results/forecast/mixes/points.csv"]},
    ),
}
# Rule: folder of the campaign, and files in it that are made before.
RECORDED = {"forecast_provenance": ("forecast", ["mixes/overall.csv"])}

if POURED:
    COURSES, PROFILES = (
        expand(f"results/fatigue/{kind}/{{sample}}.csv", sample=SAMPLES) for kind in ("courses", "profiles")
    )
    SHOWN |= {
        "mapping": (
            "figure fig_mapping",
            "results/mapping/figures/fig_mapping",
            {"mapping": ["results/mapping/mapping.csv"]},
        ),
        "fatigue_table": ("table fatigue", "results/fatigue/fatigue.csv", {"course": COURSES}),
        "fatigue_summary": (  # beside what is published, theory, and every cycle
            "table fatigue_summary",
            "results/fatigue/summary.csv",
            {
                "course": COURSES,
                "profile": PROFILES,
                "check": expand("results/fatigue/check/{way}.csv", way=["jumps", "fine", "every_cycle"]),
                "specimen": expand(FATIGUE_SPECIMEN, sample=SAMPLES[0]),
            },
        ),
        "fatigue_figure": (
            "figure fig_fatigue",
            "results/fatigue/figures/fig_fatigue",
            {"course": COURSES, "profile": PROFILES},
        ),
        "fall_table": ("table falls", "results/fall/falls.csv", {"fall": FALLS}),
        "fall_figure": ("figure fig_fall", "results/fall/figures/fig_fall", {"fall": FALLS[-1:]}),
    }
    RECORDED |= {
        "benchmark_provenance": ("benchmark", ["benchmark.csv"]),
        "mapping_provenance": ("mapping", ["mapping.csv"]),
        "fatigue": (
            "fatigue",
            ["fatigue.csv", "summary.csv", *multiext("figures/fig_fatigue", ".pdf", ".png", ".svg")],
        ),
        "rigs": ("rigs", ["rigs.csv"]),
        "fall": ("fall", ["falls.csv", "film.pvd", *multiext("figures/fig_fall", ".pdf", ".png", ".svg")]),
    }

for name, (shown, target, data) in SHOWN.items():
    step, module = shown.split()
    drawn = step == "figure"

    rule:
        name:
            name
        input:
            **data,
            code=code(step, f"reporting.{step}s.{module}"),
        output:
            multiext(target, ".pdf", ".png", ".svg") if drawn else target,
        log:
            log_of(target),
        conda:
            ENVIRONMENT
        params:
            shown=shown,
            data=pairs,
            output=f"--output{'-stem' * drawn} {target}",
        message:
            f"Make {target}"
        shell:
            "asphalt-nscd {params.shown} {params.data:q} {params.output} > {log} 2>&1"


for name, (folder, files) in RECORDED.items():

    rule:
        name:
            name
        input:
            [f"results/{folder}/{file}" for file in files],
            code=code("provenance"),
        output:
            f"results/{folder}/provenance.json",
        log:
            f"results/{folder}/logs/provenance.log",
        conda:
            ENVIRONMENT
        message:
            f"Write down what made {folder}"
        shell:
            "asphalt-nscd provenance --output {output} > {log} 2>&1"
