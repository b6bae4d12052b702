# Fatigue of the samples in two-point bending (docs/fatigue.md). Twenty minutes of a core, on request:
#   snakemake fatigue --cores all --configfile config/paper.yaml

_specimen = f"<results>/{FACETS}specimens/{{sample}}.h5"
# One so small that each of its cycles can be stepped.
_small = {
    "b_mm": 10.3336,
    "B_mm": 23.1473,
    "e_mm": 10.3336,
    "h_mm": 103.336,
    "mass_kg": 0.0424,
    "mobile_mass_kg": 0.0166,
}
# How it is tired at a large strain: by cycle jumps, by jumps ten times as fine, and every cycle.
_ways = {"jumps": "", "fine": "--finer 10", "every_cycle": "--every-cycle {input.law}"}

MADE["fatigue_course"] = Made(
    "Tire sample {wildcards.sample} until half of its stiffness is left",
    "fatigue {input.specimen} --strain 100e-6 --profile {output.profile}",
    "results/fatigue/courses/{sample}.csv",
    {"specimen": _specimen},
    more={"profile": "results/fatigue/profiles/{sample}.csv"},
)
MADE["fatigue_small"] = Made(
    "Trim a small sample",
    f"trim {{input.deposit}} --geometry {text(_small)} {options(BONDS | {'area': 'facets'}, *CUT)}",
    "results/fatigue/small.h5",
    {"deposit": f"results/mapping/deposits/1000-s1-friction{MAPPING_FRICTION}.h5"},
)
for way, option in _ways.items():
    MADE[f"fatigue_{way}"] = Made(
        f"Tire a small sample: {way}",
        f"fatigue {{input.specimen}} --strain 500e-6 {option}",
        f"results/fatigue/check/{way}.csv",
        {"specimen": "results/fatigue/small.h5", "law": "<results>/laws/published/T10.json"},
    )

_courses, _profiles = (
    expand(f"results/fatigue/{kind}/{{sample}}.csv", sample=SAMPLES) for kind in ("courses", "profiles")
)
SHOWN |= {
    "fatigue_table": ("table fatigue", "results/fatigue/fatigue.csv", {"course": _courses}),
    "fatigue_summary": (  # beside what is published, theory, and every cycle
        "table fatigue_summary",
        "results/fatigue/summary.csv",
        {
            "course": _courses,
            "profile": _profiles,
            "check": expand("results/fatigue/check/{way}.csv", way=_ways),
            "specimen": expand(_specimen, sample=SAMPLES[0]),
        },
    ),
    "fatigue_figure": (
        "figure fig_fatigue",
        "results/fatigue/figures/fig_fatigue",
        {"course": _courses, "profile": _profiles},
    ),
}
RECORDED["fatigue"] = (
    "fatigue",
    ["fatigue.csv", "summary.csv", *multiext("figures/fig_fatigue", ".pdf", ".png", ".svg")],
)
