# What the report holds, and from which files it is made.

MEASURED = ["<results>/measured.csv"]
USED_LAWS = expand(LAW, temperature=TEMPERATURES)
FITTED_LAWS = expand("<results>/laws/fitted/T{temperature}.json", temperature=TEMPERATURES)
TYPICAL = TEMPERATURES[len(TEMPERATURES) // 2]  # where the study names no other
SOFTER = label(SENSITIVITY["temperature_C"]) if SENSITIVITY else TYPICAL
FIRST = SAMPLES[0]

RESIDUALS = {"diagnosis": DIAGNOSED[:1], "residuals": DIAGNOSED[1:2]}

ELEMENT = {
    "laws": expand(LAW, temperature=label(AUDIT["temperature_C"]) if AUDIT else TYPICAL),
    "study": ["<results>/study.json"],
}

# name: category in the report, {kind of data: files}
FIGURES = {
    "fig_residual_map": ("0 Diagnosis", RESIDUALS),
    "fig_black": ("0 Diagnosis", RESIDUALS),
    "fig_master": ("0 Diagnosis", RESIDUALS),
    "fig_limits": ("0 Diagnosis", {"diagnosis": RESIDUALS["diagnosis"]}),
    "fig01": ("1 Measurements and laws", {"study": ["<results>/study.json"]}),
    "fig07": (
        "3 Bending tests",
        {"test": TESTS["simulate"].files(sample=FIRST, temperature=TYPICAL, frequency=max(FREQUENCIES, key=float))},
    ),
    "fig08": (
        "3 Bending tests",
        {
            "test": TESTS["simulate"].files(sample=FIRST, temperature=SOFTER, frequency=min(FREQUENCIES, key=float)),
            "specimen": [f"<results>/specimens/{FIRST}.h5"],
        },
    ),
    "fig09": ("3 Bending tests", {"simulations": SIMULATIONS, "measured": MEASURED, "laws": USED_LAWS}),
    "fig10": ("3 Bending tests", {"simulations": SIMULATIONS, "measured": MEASURED, "laws": USED_LAWS}),
    "fig_forces": (
        "3 Bending tests",
        {"model": [f"{model()}.h5".format(sample=FIRST)], "specimen": [f"<results>/specimens/{FIRST}.h5"]},
    ),
    "fig_ratio": ("3 Bending tests", {"simulations": SIMULATIONS}),
}
DEPOSITS = expand("<results>/deposits/{sample}.h5", sample=SAMPLES)
TABLES = {
    "samples": {"simulations": SIMULATIONS, "deposits": DEPOSITS},
    "table3": {
        "fitted": FITTED_LAWS,
        "measured": MEASURED,
        "published": [STUDY["laws"]["published"]["table"]] if "published" in STUDY["laws"] else [],
    },
    "table4": {
        "simulations": SIMULATIONS,
        "measured": MEASURED,
        "published": [STUDY["published"]["errors_table"]] if "published" in STUDY else [],
    },
    "ladder": {
        "simulations": SIMULATIONS,
        "likely": LIKELY_SIMULATIONS,
        "facets": FACET_SIMULATIONS,
        "extended": EXTENDED_SIMULATIONS,
        "measured": MEASURED,
        "diagnosis": DIAGNOSED[:1],
        "published": [STUDY["published"]["errors_table"]] if "published" in STUDY else [],
    },
}
# name: category in the report
PAGES = {
    "ladder": "0 Diagnosis",
    "measured": "1 Measurements and laws",
    "table3": "1 Measurements and laws",
    "samples": "2 Preparation",
    "simulations": "3 Bending tests",
    "table4": "3 Bending tests",
    "timings": "8 About this run",
}

if POURED:
    FIGURES["fig05"] = (
        "2 Preparation",
        {"deposit": [f"<results>/deposits/{FIRST}.h5"], "specimen": [f"<results>/specimens/{FIRST}.h5"]},
    )
    FIGURES["fig_compaction"] = ("2 Preparation", {"deposit": DEPOSITS})
    PAGES["preparation"] = "2 Preparation"
    TABLES["preparation"] = {"deposits": DEPOSITS}
if "published" in STUDY:
    FIGURES["fig02"] = ("2 Preparation", {"study": ["<results>/study.json"]})
    FIGURES["fig03"] = ("1 Measurements and laws", ELEMENT | {"specimen": [f"<results>/specimens/{FIRST}.h5"]})
    FIGURES["fig04"] = ("1 Measurements and laws", ELEMENT)
    PAGES["table1"] = "1 Measurements and laws"
    TABLES["table1"] = {"grading": [STUDY["published"]["grading_table"]], "used": [COUNTS]}
    PAGES["table2"] = "2 Preparation"
    TABLES["table2"] = {
        "grading": [STUDY["published"]["grading_table"]],
        "published": [STUDY["published"]["counts_table"]],
        "used": [COUNTS],
    }
    if "reconstruct" in STUDY["measurements"]:
        beside = ["smoothness", "ensemble"] if STUDY["study"] == "paper" else []  # 20 s that no smaller study needs
        for name in ("reconstructions", *beside):
            PAGES[name] = "1 Measurements and laws"
            TABLES[name] = {
                "laws": [STUDY["laws"]["published"]["table"]],
                "errors": [STUDY["published"]["errors_table"]],
            }
if STEPPING:
    FIGURES["fig06"] = ("4 Time step", {"solved": SOLVED, "part": PART_SOLVED, "stopped": STOPPED})
    PAGES["time_steps"] = "4 Time step"
    TABLES["time_steps"] = FIGURES["fig06"][1] | {
        "law": expand(LAW, temperature=STEPPED["temperature"]),
        "model": expand(f"{model()}.h5", sample=STEPPED["sample"]),
    }
if SENSITIVITY:
    PAGES["sensitivity"] = "5 Sensitivity"
    for name, parameter in {"fig11": "Em", "fig12": "eta_m", "fig13": "Ek", "fig14": "eta_k"}.items():
        if parameter in SENSITIVITY["parameters"]:
            FIGURES[name] = (
                "5 Sensitivity",
                {
                    "sensitivity": ["<results>/sensitivity.csv"],
                    "simulations": SIMULATIONS,
                    "measured": MEASURED,
                    "laws": expand(LAW, temperature=SOFTER),
                },
            )
if AUDIT:
    PAGES["readings"] = "6 Audit"
    FIGURES["fig_readings"] = ("6 Audit", {"readings": ["<results>/readings.csv"], "simulations": SIMULATIONS})
    PAGES["bond_readings"] = "6 Audit"
    TABLES["bond_readings"] = {
        "deposits": [*DEPOSITS, *expand("<results>/deposits/{sample}.h5", sample=PACKED[1:])],
        "specimens": expand("<results>/specimens/{sample}.h5", sample=SAMPLES),
        "simulations": SIMULATIONS,
        "packing": ["<results>/packing.csv"] if PACKING else [],
        "blocked": BLOCKED[:1],
    }
if LIKELY and "published" in STUDY:
    PAGES["likely"] = PAGES["levels"] = "6 Audit"
    TABLES["levels"] = {
        "simulations": SIMULATIONS,
        "likely": LIKELY_SIMULATIONS,
        "errors": [STUDY["published"]["errors_table"]],
    }
if PACKING:
    PAGES["packing"] = "2 Preparation"
    TABLES["packing"] = {
        "tests": PACKING_TESTS,
        "facets": PACKING_FACETS,
        "deposits": expand("<results>/deposits/{sample}.h5", sample=PACKED),
    }
    FIGURES["fig_packing"] = ("2 Preparation", {"packing": ["<results>/packing.csv"]})
if {"audit", "sensitivity", "packing_study", "time_step_study", "published"} <= set(STUDY):
    PAGES["audit"] = "6 Audit"
    TABLES["audit"] = {
        "statements": [shipped("data/paper/statements.csv")],
        "grading": [STUDY["published"]["grading_table"]],
        "counts": [STUDY["published"]["counts_table"]],
        "laws": [STUDY["laws"]["published"]["table"]],
        "errors": [STUDY["published"]["errors_table"]],
        "fitted": FITTED_LAWS,
        "measured": MEASURED,
        "simulations": SIMULATIONS,
        "sensitivity": ["<results>/sensitivity.csv"],
        "readings": ["<results>/readings.csv"],
        "bond_readings": ["<results>/bond_readings.csv"],
        "packing": ["<results>/packing.csv"],
        "facets": FACET_SIMULATIONS,
        "table4": ["<results>/table4.csv"],
        "deposits": DEPOSITS,
        "specimens": expand("<results>/specimens/{sample}.h5", sample=SAMPLES),
        "time_steps": ["<results>/time_steps.csv"],
        "stopped": STOPPED,
        "waveform": FIGURES["fig07"][1]["test"],
        "profile": FIGURES["fig08"][1]["test"],
    }

if COMMON_LAW:
    PAGES["extended"] = "0 Diagnosis"
    PAGES["prony"] = "0 Diagnosis"
    PAGES["dynamic_modulus"] = "0 Diagnosis"
    FIGURES["fig10_extended"] = (
        "0 Diagnosis",
        {
            "simulations": SIMULATIONS,
            "extended": EXTENDED_SIMULATIONS,
            "measured": MEASURED,
            "laws": USED_LAWS,
            "common": COMMON_LAW,
        },
    )
if REMAPPED:
    PAGES["facets"] = "0 Diagnosis"
    PAGES["fracture"] = "3 Bending tests"
    TABLES["fracture"] = {"simulations": SIMULATIONS, "facets": FACET_SIMULATIONS}

if FAMILIES:
    PAGES["rivals"] = "0 Diagnosis"
    TABLES["rivals"] = {"measured": [*MEASURED, *expand(f"{FAMILY}measured.csv", family=FAMILIES)]}
    PAGES["families"] = "0 Diagnosis"
    TABLES["families"] = {
        "measured": [*MEASURED, *expand(f"{FAMILY}measured.csv", family=FAMILIES)],
        "diagnosis": [DIAGNOSED[0], *expand(f"{FAMILY}diagnosis.json", family=FAMILIES)],
        "law": [*COMMON_LAW, *expand(f"{FAMILY}law.json", family=FAMILIES)],
        "specimen": [f"<results>/diagnosis/specimens/{FIRST}.h5"],
        "ladder": ["<results>/ladder.csv"],
    }

FORECAST = MAIN and CLONE and not BARE and STUDY["study"] == "paper"  # beside the study: mixes from their recipes
if FORECAST:
    FIGURES["fig_forecast"] = ("7 Forecast", {"points": ["results/forecast/mixes/points.csv"]})
    PAGES["forecasts"] = "7 Forecast"
    TABLES["forecasts"] = {"overall": ["results/forecast/mixes/overall.csv"]}

COMPUTED = [
    DIAGNOSED,
    [f"<results>/{name}.csv" for name in PAGES if name != "timings"],
    EXPORTED,
    [f"<results>/figures/{name}.{kind}" for name in FIGURES for kind in ("pdf", "png", "svg")],
]
RESULTS = [
    COMPUTED,
    "<results>/timings.csv",
    "<results>/provenance.json",
    [f"<results>/pages/{name}.html" for name in ("diagnosis", *PAGES)],
]

# `all` asks for each file by name. Of one that a failed run left missing between others, which are there and newer,
# Snakemake would say that nothing is to be done.
KEPT += [
    RESULTS,
    "<results>/timings.md",
    "<results>/study.json",
    rules.reconstruct.output if "reconstruct" in STUDY["measurements"] else [],
    MEASURED,
    FITTED_LAWS,
    USED_LAWS,
    expand("<results>/deposits/{sample}.h5", sample=[*SAMPLES, *PACKED]),
    [made.files() for made in SPECIMENS.values()],
    [files for _, files, _ in COLLECTED.values()],
    [f"<results>/{table}" for table, *_ in COLLECTED.values()],
    expand("<results>/diagnosis/specimens/{sample}.h5", sample=SAMPLES if COMMON_LAW else FIRST),
]
if COMMON_LAW:
    KEPT += [
        COMMON_LAW,
        expand(EXTENDED_LAWS, sample=SAMPLES, temperature=TEMPERATURES, frequency=FREQUENCIES),
        expand("<results>/extended/rigs/{sample}.json", sample=SAMPLES),
    ]
if FAMILIES:
    KEPT += [
        expand(rules.draw_family.output, family=DRAWN),
        expand(rules.reduce_family.output, family=FAMILIES),
        expand(rules.diagnose_family.output, family=FAMILIES),
    ]
