# What the report holds, and from which files it is made.

MEASURED = ["<results>/measured.csv"]
USED_LAWS = expand(LAW, temperature=TEMPERATURES)
FITTED_LAWS = expand("<results>/laws/fitted/T{temperature}.json", temperature=TEMPERATURES)
TYPICAL = TEMPERATURES[len(TEMPERATURES) // 2]  # where the study names no other
SOFTER = label(SENSITIVITY["temperature_C"]) if SENSITIVITY else TYPICAL
FIRST = SAMPLES[0]
DEPOSITS = expand("<results>/deposits/{sample}.h5", sample=SAMPLES)
PRINTED = STUDY.get("published", {})  # tables of it
PAPER_LAWS = [STUDY["laws"]["published"]["table"]] if "published" in STUDY["laws"] else []
ERRORS = [PRINTED["errors_table"]] if PRINTED else []

# Files of a kind of data, where it is not the table of its name.
FILES = {
    "common": COMMON_LAW,
    "deposits": DEPOSITS,
    "diagnosis": DIAGNOSED[:1],
    "errors": ERRORS,
    "extended": EXTENDED_SIMULATIONS,
    "facets": FACET_SIMULATIONS,
    "fitted": FITTED_LAWS,
    "laws": USED_LAWS,
    "likely": LIKELY_SIMULATIONS,
    "residuals": DIAGNOSED[1:2],
    "specimen": [f"<results>/specimens/{FIRST}.h5"],
    "specimens": expand("<results>/specimens/{sample}.h5", sample=SAMPLES),
}


def data(kinds, **others):
    """{kind of data: files} for figures and tables."""
    return {kind: FILES.get(kind, [f"<results>/{kind}.csv"]) for kind in kinds.split()} | others


def waveform(temperature, frequency):
    """The test of the first sample."""
    return TESTS["simulate"].files(sample=FIRST, temperature=temperature, frequency=frequency)


FASTEST, SLOWEST = (which(FREQUENCIES, key=float) for which in (max, min))
SHAPE = {
    "specimens": {"geometry": STUDY["specimens"]["geometry"]},
    "test": {"amplitude_m": STUDY["test"]["amplitude_m"]},
}
ELEMENT = {
    "laws": expand(LAW, temperature=label(AUDIT["temperature_C"]) if AUDIT else TYPICAL),
    "study": part_of_study("bonds", specimens={"bonds": BONDS}),
}

# Name: part of the report, {kind of data: files}.
FIGURES = {
    "fig_residual_map": ("0 Diagnosis", data("diagnosis residuals")),
    "fig_black": ("0 Diagnosis", data("diagnosis residuals")),
    "fig_master": ("0 Diagnosis", data("diagnosis residuals")),
    "fig_limits": ("0 Diagnosis", data("diagnosis")),
    "fig01": ("1 Measurements and laws", {"study": part_of_study("shape", **SHAPE)}),
    "fig07": ("3 Simulated tests", {"test": waveform(TYPICAL, FASTEST)}),
    "fig08": ("3 Simulated tests", {"test": waveform(SOFTER, SLOWEST)} | data("specimen")),
    "fig09": ("3 Simulated tests", data("simulations measured laws")),
    "fig10": ("3 Simulated tests", data("simulations measured laws")),
    "fig_forces": ("3 Simulated tests", {"model": expand(f"{model()}.h5", sample=FIRST)} | data("specimen")),
    "fig_ratio": ("3 Simulated tests", data("simulations")),
}
# Name: {kind of data: files}.
TABLES = {
    "samples": data("simulations deposits"),
    "table3": data("fitted measured", published=PAPER_LAWS),
    "table4": data("simulations measured", published=ERRORS),
    "ladder": data("simulations likely facets extended measured diagnosis", published=ERRORS),
}
PAPER_TABLES = {}  # those of studies/paper; a file alone is handed on as such
# Name of a table: part of the report.
PAGES = {
    "ladder": "0 Diagnosis",
    "measured": "1 Measurements and laws",
    "table3": "1 Measurements and laws",
    "samples": "2 Preparation",
    "simulations": "3 Simulated tests",
    "table4": "3 Simulated tests",
    "timings": "8 About this run",
}

if POURED:
    FIGURES["fig05"] = ("2 Preparation", {"deposit": DEPOSITS[:1]} | data("specimen"))
    FIGURES["fig_compaction"] = ("2 Preparation", {"deposit": DEPOSITS})
    PAGES["preparation"] = "2 Preparation"
    TABLES["preparation"] = data("deposits")
if PRINTED:
    FILES |= {"grading": [PRINTED["grading_table"]], "counts": [PRINTED["counts_table"]]}
    FIGURES["fig02"] = ("2 Preparation", {"study": ELEMENT["study"]})
    FIGURES["fig03"] = ("1 Measurements and laws", ELEMENT | data("specimen"))
    FIGURES["fig04"] = ("1 Measurements and laws", ELEMENT)
    PAGES["table1"] = "1 Measurements and laws"
    TABLES["table1"] = data("grading", used=[COUNTS])
    PAGES["table2"] = "2 Preparation"
    TABLES["table2"] = data("grading", published=FILES["counts"], used=[COUNTS])
    if "reconstruct" in STUDY["measurements"]:
        beside = ["smoothness", "ensemble"] if STUDY["study"] == "paper" else []  # 20 s that no smaller study needs
        PAGES |= dict.fromkeys(["reconstructions", *beside], "1 Measurements and laws")
        PAPER_TABLES |= dict.fromkeys(["reconstructions", *beside], {"laws": PAPER_LAWS[0], "errors": ERRORS[0]})
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
            shown = data("sensitivity simulations measured", laws=expand(LAW, temperature=SOFTER))
            FIGURES[name] = ("5 Sensitivity", shown)
if AUDIT:
    PAGES |= {"readings": "6 Audit", "bond_readings": "6 Audit"}
    FIGURES["fig_readings"] = ("6 Audit", data("readings simulations"))
    PAPER_TABLES["bond_readings"] = {
        "deposits": [*DEPOSITS, *expand("<results>/deposits/{sample}.h5", sample=PACKED[1:])],
        "tests": [*SIMULATIONS, *["<results>/packing.csv"] * bool(PACKING)],
        "blocked": BLOCKED[0],
        **data("specimens"),
    }
if LIKELY and PRINTED:
    PAGES |= {"likely": "6 Audit", "levels": "6 Audit"}
    PAPER_TABLES["levels"] = {"simulations": SIMULATIONS[0], "likely": LIKELY_SIMULATIONS[0], "errors": ERRORS[0]}
if PACKING:
    PAGES["packing"] = "2 Preparation"
    TABLES["packing"] = {
        "tests": PACKING_TESTS,
        "facets": PACKING_FACETS,
        "deposits": expand("<results>/deposits/{sample}.h5", sample=PACKED),
    }
    FIGURES["fig_packing"] = ("2 Preparation", data("packing"))
if AUDIT and SENSITIVITY and PACKING and STEPPING and PRINTED:
    PAGES["audit"] = "6 Audit"
    alone = "grading counts errors simulations sensitivity readings bond_readings packing table4 time_steps"
    PAPER_TABLES["audit"] = {
        "statements": shipped("studies/paper/statements.yaml"),
        "design": shipped("studies/paper/design_moduli.csv"),
        "laws": PAPER_LAWS[0],
        **{kind: files[0] for kind, files in data(alone).items()},
        **data("fitted measured facets deposits specimens"),
        "costs": shipped("results/published/benchmark/benchmark.csv"),
        "waveform": waveform(TYPICAL, FASTEST)[0],
        "profile": waveform(SOFTER, SLOWEST)[0],
    }
if COMMON_LAW:
    PAGES |= dict.fromkeys(["extended", "prony", "dynamic_modulus"], "0 Diagnosis")
    FIGURES["fig_residual_map"] = ("0 Diagnosis", data("diagnosis residuals extended"))
    FIGURES["fig10_extended"] = ("0 Diagnosis", data("simulations extended measured laws common"))
if REMAPPED:
    PAGES |= {"facets": "0 Diagnosis", "fracture": "3 Simulated tests"}
    TABLES["fracture"] = data("simulations facets")
if FAMILIES:
    PAGES |= {"rivals": "0 Diagnosis", "families": "0 Diagnosis"}
    TABLES["rivals"] = {"measured": [*MEASURED, *expand(f"{FAMILY}measured.csv", family=FAMILIES)]}
    TABLES["families"] = TABLES["rivals"] | {
        "diagnosis": [DIAGNOSED[0], *expand(f"{FAMILY}diagnosis.json", family=FAMILIES)],
        **data("ladder"),
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
        NAMED,
        expand(EXTENDED_LAWS, sample=SAMPLES, temperature=TEMPERATURES, frequency=FREQUENCIES),
        expand("<results>/extended/rigs/{sample}.json", sample=SAMPLES),
    ]
if FAMILIES:
    KEPT += [
        expand(rules.draw_family.output, family=DRAWN),
        expand(rules.reduce_family.output, family=FAMILIES),
        expand(rules.diagnose_family.output, family=FAMILIES),
    ]
