# Section 4.2, Fig. 6: what the time step does, and what sweeps do that are stopped once reactions seem stable.

STEPPING = STUDY.get(
    "time_step_study",
    {"seed": 0, "temperature_C": 0, "frequency_Hz": 0, "time_steps_s": [], "tolerances": [], "part": 1},
)
STEPPED = "s{sample}/T{temperature}/f{frequency}".format(
    sample=STEPPING["seed"], temperature=label(STEPPING["temperature_C"]), frequency=label(STEPPING["frequency_Hz"])
)
SOLVED = [f"<results>/time_step/reduced/{STEPPED}/dt{label(step)}.h5" for step in STEPPING["time_steps_s"]]
STOPPED = [
    f"<results>/time_step/sweeps/{STEPPED}/tolerance{label(tolerance)}/dt{label(step)}.h5"
    for tolerance in STEPPING["tolerances"]
    for step in STEPPING["time_steps_s"]
    if step >= STUDY["test"]["time_step_s"]  # shorter ones take too long
]
PART_SOLVED = f"<results>/time_step/part/{STEPPED}.h5"
PART = {
    key: value / STEPPING["part"] ** (3 if key.endswith("_kg") else 1)
    for key, value in STUDY["specimens"]["geometry"].items()
}
PART_TEST = (
    f"--amplitude-m {STUDY['test']['amplitude_m'] / STEPPING['part']} --cycles 1.5 --rest-steps 0 --time-step-s "
)


use rule simulate as simulate_step with:
    # One cycle, every step solved to rounding.
    output:
        "<results>/time_step/reduced/{sample}/T{temperature}/f{frequency}/dt{time_step}.h5",
    params:
        source=LAWS,
        tests=tests,
        test=options(STUDY["test"], "amplitude_m", "rest_steps") + " --cycles 1 --time-step-s {time_step}",
    log:
        "<results>/logs/simulate_step/{sample}/T{temperature}/f{frequency}/dt{time_step}.log",
    benchmark:
        "<results>/benchmarks/simulate_step/{sample}/T{temperature}/f{frequency}/dt{time_step}.tsv"
    message:
        "Test with a time step of {wildcards.time_step} s"


use rule trim as trim_part with:
    # A specimen of the same shape, small enough for sweeps that go on for long.
    output:
        "<results>/time_step/specimens/{sample}.h5",
    params:
        geometry=text(PART),
        bonds=options(STUDY["specimens"]["bonds"], "area", "volume_reduction", "gap_max_mm"),
    log:
        "<results>/logs/trim_part/{sample}.log",
    benchmark:
        "<results>/benchmarks/trim_part/{sample}.tsv"
    message:
        "Trim a smaller specimen from sample {wildcards.sample}"


use rule condense as condense_part with:
    input:
        compiled="<results>/compiled/simulate",
        specimen="<results>/time_step/specimens/{sample}.h5",
        code=code("condense"),
    output:
        model="<results>/time_step/models/{head}/{sample}.h5",
        excerpt="<results>/time_step/models/{head}/{sample}.excerpt.h5",
    params:
        bonds=options(STUDY["specimens"]["bonds"], "poisson", "kt_over_kn", "yield_Pa", "friction"),
        ready="--stand-by 0",
    log:
        "<results>/logs/condense_part/{head}/{sample}.log",
    benchmark:
        "<results>/benchmarks/condense_part/{head}/{sample}.tsv"
    message:
        "Condense the bonds of the smaller specimen of sample {wildcards.sample}"


use rule simulate as simulate_part with:
    # The smaller specimen, every step solved: what sweeps should give.
    input:
        compiled="<results>/compiled/simulate",
        model=f"<results>/time_step/models/{HEAD}/{{sample}}.h5",
        excerpt=f"<results>/time_step/models/{HEAD}/{{sample}}.excerpt.h5",
        law=f"<results>/laws/{LAWS}/T{{temperature}}.json",
        code=code("simulate"),
    output:
        "<results>/time_step/part/{sample}/T{temperature}/f{frequency}.h5",
    params:
        source=LAWS,
        tests=tests,
        test=PART_TEST + str(STUDY["test"]["time_step_s"]),
    log:
        "<results>/logs/simulate_part/{sample}/T{temperature}/f{frequency}.log",
    benchmark:
        "<results>/benchmarks/simulate_part/{sample}/T{temperature}/f{frequency}.tsv"
    message:
        "Test the smaller specimen, every step solved"


use rule simulate_part as simulate_sweeps with:
    # Gauss-Seidel until a sweep changes the reactions by less than a tolerance.
    output:
        "<results>/time_step/sweeps/{sample}/T{temperature}/f{frequency}/tolerance{tolerance}/dt{time_step}.h5",
    params:
        source=LAWS,
        tests=tests,
        test=f"{PART_TEST}{{time_step}} --method sweeps --most-sweeps 20000 --tolerance {{tolerance}}",
    priority: 5
    log:
        "<results>/logs/simulate_sweeps/{sample}/T{temperature}/f{frequency}/tolerance{tolerance}/dt{time_step}.log",
    benchmark:
        "<results>/benchmarks/simulate_sweeps/{sample}/T{temperature}/f{frequency}/tolerance{tolerance}/dt{time_step}.tsv"
    message:
        "Test with a time step of {wildcards.time_step} s, sweeps to a tolerance of {wildcards.tolerance}"
