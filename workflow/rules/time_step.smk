# Section 4.2, Fig. 6: what the time step does, and what stopping the solver early does.

STEPPING = STUDY.get(
    "time_step_study",
    {"seed": 0, "temperature_C": 0, "frequency_Hz": 0, "sweeps_frequency_Hz": 0, "time_steps_s": [], "sweeps": 0},
)
SOLVED, STOPPED = (
    expand(
        f"<results>/time_step/{method}/s{{seed}}/T{{temperature}}/f{{frequency}}/dt{{time_step}}.h5",
        seed=STEPPING["seed"],
        temperature=label(STEPPING["temperature_C"]),
        frequency=label(STEPPING[frequency]),
        time_step=[label(value) for value in STEPPING["time_steps_s"]],
    )
    for method, frequency in (("reduced", "frequency_Hz"), ("sweeps", "sweeps_frequency_Hz"))
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


use rule simulate as simulate_sweeps with:
    # One cycle with Gauss-Seidel stopped after some sweeps of each step.
    output:
        "<results>/time_step/sweeps/{sample}/T{temperature}/f{frequency}/dt{time_step}.h5",
    params:
        source=LAWS,
        tests=tests,
        test=options(STUDY["test"], "amplitude_m")
        + " --cycles 1 --time-step-s {time_step} --rest-steps 0"
        + f" --method sweeps --most-sweeps {STEPPING['sweeps']} --tolerance 0",
    priority: 5
    log:
        "<results>/logs/simulate_sweeps/{sample}/T{temperature}/f{frequency}/dt{time_step}.log",
    benchmark:
        "<results>/benchmarks/simulate_sweeps/{sample}/T{temperature}/f{frequency}/dt{time_step}.tsv"
    message:
        "Test with a time step of {wildcards.time_step} s, Gauss-Seidel stopped early"
