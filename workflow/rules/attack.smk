# A program against the diagnosis: tables as laboratories produce them, faults put in, and what is said of them.
#   make attack
#   snakemake attack --cores all --configfile config/paper.yaml config/attack.yaml
# Faults are put into NCAT's measured tables too, and into those of the folder that ASPHALT_NSCD_TABLES names.

sys.path.insert(0, str(CLONE / "trials"))
from attack.trial import Size

ATTACK_COMMAND = (
    f"env PYTHONPATH={CLONE / 'trials'}:${{{{PYTHONPATH-}}}} OPENBLAS_NUM_THREADS=1 {sys.executable} -m attack"
)
TRIALS = CLONE / "trials"
ATTACK_CODE = sorted(os.path.relpath(path) for path in [*TRIALS.glob("attack/*.py"), *TRIALS.glob("drawn/*.py")])
ATTACK_PARTS = 48  # jobs, each with every 48th campaign: an interrupt costs the minutes of one at most
ATTACK_TABLES = "cases names by_fault coverage reliability before summary".split()
SOME_PARTS = 8  # jobs of each trial of a hundred tables or so
MACHINES = 32  # of five campaigns each
BEFORE = "results/published/attack/before.csv"


rule attack_part:
    """Some campaigns diagnosed, as they are and with faults: one line for each diagnosis."""
    input:
        code=code("diagnose", *modules_of("diagnosis.causes")),
        generator=ATTACK_CODE,
    output:
        "results/attack/parts/{number}.jsonl",
    log:
        "results/attack/logs/parts/{number}.log",
    benchmark:
        "results/attack/benchmarks/parts/{number}.tsv"
    params:
        campaigns=lambda wildcards: [*range(int(wildcards.number), Size(**ATTACK).all, ATTACK_PARTS)],
        size=options(ATTACK),
    message:
        "Attack the diagnosis, part {wildcards.number}"
    shell:
        ATTACK_COMMAND + " part {params.campaigns} {params.size} --output {output} > {log} 2>&1"


rule attack_tables:
    """What was put in against what was said, beside the rates of an earlier commit."""
    input:
        lines=expand("results/attack/parts/{number}.jsonl", number=range(min(ATTACK_PARTS, Size(**ATTACK).all))),
        generator=ATTACK_CODE,
        before=BEFORE if Path(BEFORE).is_file() else [],
    output:
        [f"results/attack/{name}.csv" for name in ATTACK_TABLES],
        multiext("results/attack/figures/reliability", ".pdf", ".png", ".svg"),
        "results/attack/campaign.json",
    log:
        "results/attack/logs/tables.log",
    params:
        before=lambda wildcards, input: f"--before {input.before}" if input.before else "",
    message:
        "Compare what was put in with what was said"
    shell:
        ATTACK_COMMAND + " tables {input.lines} {params.before} --folder results/attack > {log} 2>&1"


rule attack_some:
    """Some tables of a trial: a minute of one core."""
    input:
        code=code("diagnose", *modules_of("diagnosis.causes")),
        generator=ATTACK_CODE,
    output:
        "results/attack/some/{kind}-{part}.csv",
    log:
        "results/attack/logs/some/{kind}-{part}.log",
    params:
        parts=SOME_PARTS,
    message:
        "Try some tables: {wildcards.kind}, part {wildcards.part}"
    shell:
        ATTACK_COMMAND + " some {wildcards.kind} {wildcards.part} {params.parts} --output {output} > {log} 2>&1"


# Subcommand: what it does, its option, the trials that it puts together, its tables.
for name, (told, more, kinds, tables) in {
    "machines": (  # and what NCAT's campaigns share: six minutes of one core
        "Look for an offset that no campaign of a machine shows alone",
        MACHINES,
        [],
        ("machines", "machines_summary", "machine_measured"),
    ),
    "nonlinear": (
        "Tell mixes that are not linear where they are soft from true offsets of the phase",
        "",
        ["nonlinear"],
        ("nonlinear", "nonlinear_summary"),
    ),
    "power": (
        "Say how small a fault is named in usual campaigns, and of a careful laboratory",
        "",
        ["limits", "careful"],
        ("power", "power_limits", "power_cases", "power_summary", "power_bound"),
    ),
}.items():

    rule:
        name:
            f"attack_{name}"
        input:
            parts=expand("results/attack/some/{kind}-{part}.csv", kind=kinds, part=range(SOME_PARTS)),
            code=code("diagnose", *modules_of("diagnosis.causes")),
            generator=ATTACK_CODE,
        output:
            [f"results/attack/{table}.csv" for table in tables],
        log:
            f"results/attack/logs/{name}.log",
        params:
            command=f"{name} {more}",
        message:
            told
        shell:
            ATTACK_COMMAND + " {params.command} {input.parts} --folder results/attack > {log} 2>&1"


rule attack_inside:
    """Faults inside simulated tests on the specimens of the study."""
    input:
        compiled="<results>/compiled/simulate",
        models=expand(f"{model()}.h5", sample=SAMPLES),
        code=code("simulate"),
        diagnosis=code("diagnose", *modules_of("diagnosis.causes")),
        generator=ATTACK_CODE,
    output:
        rows="results/attack/inside.csv",
        summary="results/attack/inside_summary.csv",
    log:
        "results/attack/logs/inside.log",
    message:
        "Hide faults inside NSCD runs"
    shell:
        ATTACK_COMMAND + " inside {input.models} --folder results/attack > {log} 2>&1"
