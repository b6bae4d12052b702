# Campaigns beside the study, each only on request: snakemake NAME --cores all --configfile config/paper.yaml

from snakemake.utils import format as fill


class Made(NamedTuple):
    """What one command of a campaign makes."""

    message: str
    command: str  # a program of benchmarks/, on one core, or a step; less its output unless it says --output
    output: str
    input: dict = {}
    steps: str = ""  # further ones, whose source counts
    files: list = []  # sources that count
    modules: list = []  # that the step picks by name
    threads: int = 1
    more: dict = {}  # outputs

    @property
    def program(self):
        """The file in benchmarks/, or the step."""
        return self.command.split()[0]

    @property
    def measured(self):
        """By a program of benchmarks/."""
        return self.program.endswith(".py")

    def job(self, name):
        """Name of the log and the benchmark of a job of this rule."""
        return f"{name}/{Path(self.output).stem}" if "{" in self.output else name

    def filled(self, wildcards, input, output, threads):
        """The command of a job. In `shell` it would be that of the last rule of a loop, for jobs read that when they run."""
        command = self.command if "--output " in self.command else f"{self.command} --output {{output.table}}"
        start = f"{MEASURE}/" if self.measured else "asphalt-nscd "
        return start + fill(command, wildcards=wildcards, input=input, output=output, threads=threads)


class Scripted(NamedTuple):
    """What one script of studies/ makes."""

    message: str
    script: str
    output: dict
    input: dict = {}
    threads: int = 1


MEASURE = f"env OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 NUMBA_NUM_THREADS=1 {sys.executable} benchmarks"
# Of each by its name:
MADE = {}
SCRIPTED = {}
SHOWN = {}  # step and what it shows, its file less the ending of a figure, {kind of data: files}
RECORDED = {}  # folder of a campaign, and what is made before what made it is written down


include: "forecast.smk"  # a mix from its binder and recipe alone
include: "verification.smk"  # is the core right
include: "measured.smk"  # the phase of measured mixes


if POURED:

    include: "benchmark.smk"  # how fast is it beside its peers
    include: "mapping.smk"  # how bonds carry the law, by size and packing
    include: "rigs.smk"  # the specimens of all tests against the law
    include: "fatigue.smk"  # bonds that tire
    include: "fall.smk"  # bonds that turn, and pieces that fall
    include: "ramp.smk"  # a specimen pulled to failure


for name, made in MADE.items():

    rule:
        name:
            name
        input:
            **made.input,
            code=[
                f"benchmarks/{made.program}" if made.measured else code(made.program, *made.modules),
                *made.files,
                *map(code, made.steps.split()),
            ],
        output:
            **made.more,
            table=made.output,
        log:
            f"results/{Path(made.output).parts[1]}/logs/{made.job(name)}.log",
        benchmark:
            f"<results>/benchmarks/{made.job(name)}.tsv"
        conda:
            None if made.measured else ENVIRONMENT
        threads: made.threads
        params:
            command=made.filled,
        message:
            made.message
        shell:
            "{params.command} > {log} 2>&1"


for name, made in SCRIPTED.items():

    rule:
        name:
            name
        input:
            **made.input,
            code=studied(".".join(Path(made.script).parts)),
        output:
            **made.output,
        log:
            f"results/{Path(made.script).parts[0]}/logs/{name}.log",
        benchmark:
            f"<results>/benchmarks/{name}.tsv"
        conda:
            ENVIRONMENT
        threads: made.threads
        params:
            script=made.script,
        message:
            made.message
        script:
            SCRIPT


for name, (shown, target, files) in SHOWN.items():
    step, module = shown.split()
    drawn = step == "figure"

    rule:
        name:
            name
        input:
            **files,
            code=code(step, f"reporting.{step}s.{module}"),
        output:
            multiext(target, ".pdf", ".png", ".svg") if drawn else target,
        log:
            f"results/{Path(target).parts[1]}/logs/{name}.log",
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
