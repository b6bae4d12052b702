# Which specimens are cut, which bending tests are run on them, and which tables collect those tests: first the paper's, then
# what departs from them. specimen.smk and bending.smk make a rule of each entry, under its name.

from typing import NamedTuple

HEAD = STUDY["test"]["head"]
LAWS = STUDY["laws"]["simulate"]
LAW = f"<results>/laws/{LAWS}/T{{temperature}}.json"
EXTENDED_LAWS = "<results>/extended/laws/{sample}/T{temperature}/f{frequency}.json"
BONDS = STUDY["specimens"]["bonds"]
CUT = ("area", "volume_reduction", "gap_max_mm")  # what `trim` takes of the bonds
STEP = "steps_per_cycle" if "steps_per_cycle" in STUDY["test"] else "time_step_s"
TEST = options(STUDY["test"], "amplitude_m", "cycles", STEP, "rest_steps")
ONE_TEST = "{sample}/T{temperature}/f{frequency}"
STEADY = options(STUDY["test"], "amplitude_m", "cycles", "time_step_s") + " --method harmonic"

AUDIT = STUDY.get("audit", {})
PACKING = STUDY.get("packing_study", {})
SENSITIVITY = STUDY.get("sensitivity", {})
STEPPING = STUDY.get("time_step_study", {})

REMAPPED = BONDS["area"] == "paper"  # the first rung: the same deposits bonded by facets (docs/mapping.md)
FACETS = "facets/" if REMAPPED else ""  # what the rungs above it are simulated with
LIKELY = "likeliest_friction" in AUDIT
# One law for all temperatures, for the extended simulation; one temperature determines none.
COMMON_LAW = ["<results>/diagnosis/law.json"] if len(TEMPERATURES) > 1 else []


def loose(sample, *frictions):
    """Names of a sample that is poured with more friction."""
    return [f"{sample}-friction{label(friction)}" for friction in frictions]


def model(folder="", head=HEAD):
    """File of a condensed specimen, less its ending."""
    return f"<results>/{folder}models/{head}/{{sample}}"


PACKED = [f"s{PACKING['seed']}", *loose(f"s{PACKING['seed']}", *PACKING["frictions"])] if PACKING else []


class Specimens(NamedTuple):
    """Specimens of one kind."""

    folder: str
    how: str = ""  # they differ from the paper's
    bonds: str = options(BONDS, *CUT)
    geometry: dict = STUDY["specimens"]["geometry"]
    tested: list = SAMPLES  # by a campaign, for which bonds are made ready to break
    others: list = [sample for sample in PACKED if sample not in SAMPLES]

    def files(self):
        """Of all samples: bonded, condensed, and the excerpt that most tests need."""
        stem = model(self.folder)
        patterns = [f"<results>/{self.folder}specimens/{{sample}}.h5", f"{stem}.h5", f"{stem}.excerpt.h5"]
        return expand(patterns, sample=[*self.tested, *self.others])


class Tests(NamedTuple):
    """Bending tests of one kind."""

    folder: str
    message: str
    place: str = "{sample}/T{temperature}"  # of a job: frequencies asked for together in one, which starts once
    model: str = model()
    law: str = LAW
    source: str = LAWS
    test: str = TEST
    rig: str | list = []
    priority: int = 0

    @property
    def own_laws(self):
        """A law for each frequency."""
        return "{frequency}" in self.law and self.together

    @property
    def together(self):
        """Several frequencies in one job."""
        return "{frequency}" not in self.place

    @property
    def record(self):
        """File of a test."""
        stem = f"<results>/{self.folder}/{self.place}"
        return f"{stem}/f{{frequency}}.h5" if self.together else f"{stem}.h5"

    def files(self, **wildcards):
        """Of tests at all temperatures and frequencies, of all samples, but where others are given."""
        campaign = {"sample": SAMPLES, "temperature": TEMPERATURES, "frequency": FREQUENCIES}
        return expand(self.record, **(wildcards | campaign | wildcards))


SPECIMENS = {"": Specimens("")}
TESTS = {
    "simulate": Tests(
        "tests",
        "Test sample {wildcards.sample} at {wildcards.temperature} degC and {wildcards.frequency} Hz",
        place=ONE_TEST,
    ),
}
# Rule: its table, the tests in it, and what they are.
COLLECTED = {"simulations": ("simulations.csv", TESTS["simulate"].files(), "bending tests")}
SIMULATIONS, FACET_SIMULATIONS, EXTENDED_SIMULATIONS, LIKELY_SIMULATIONS = (
    [f"<results>/{name}.csv"] if made else []
    for name, made in [("simulations", True), ("facets", REMAPPED), ("extended", COMMON_LAW), ("likely", LIKELY)]
)
KEPT = []  # files that `all` asks for beside specimens, tables and the tests in them

if REMAPPED:
    SPECIMENS["_facets"] = Specimens("facets/", how=" with facets", bonds=options(BONDS | {"area": "facets"}, *CUT))
    TESTS["simulate_facets"] = Tests(
        "facets/tests",
        "Test sample {wildcards.sample} with facets, at {wildcards.temperature} degC",
        model=model("facets/"),
    )
    COLLECTED["facet_simulations"] = ("facets.csv", TESTS["simulate_facets"].files(), "bending tests with facets")

if COMMON_LAW:  # what the diagnosis named, beyond the paper
    TESTS["simulate_extended"] = Tests(
        "extended/tests",
        "Test sample {wildcards.sample} extended, at {wildcards.temperature} degC",
        model=model(FACETS),
        law=EXTENDED_LAWS,
        source="diagnosis",
        rig="<results>/extended/rigs/{sample}.json",
    )
    COLLECTED["extended_simulations"] = ("extended.csv", TESTS["simulate_extended"].files(), "extended bending tests")

if SENSITIVITY:  # Section 4.3
    TESTS["simulate_scaled"] = Tests(
        "sensitivity",
        "Test sample {wildcards.sample} with {wildcards.parameter} times {wildcards.factor}",
        place="{parameter}_{factor}/{sample}/T{temperature}",
        law="<results>/laws/scaled/{parameter}_{factor}/T{temperature}.json",
        source="{parameter}:{factor}",
    )
    SCALED = {
        "parameter": SENSITIVITY["parameters"],
        "factor": [label(factor) for factor in SENSITIVITY["factors"]],
        "temperature": label(SENSITIVITY["temperature_C"]),
    }
    COLLECTED["sensitivity"] = ("sensitivity.csv", TESTS["simulate_scaled"].files(**SCALED), "sensitivity tests")
    KEPT += expand(TESTS["simulate_scaled"].law, **SCALED)

if STEPPING:  # Section 4.2, Fig. 6: what the time step does, and sweeps that are stopped once reactions seem stable
    STEPPED = {
        "sample": f"s{STEPPING['seed']}",
        "temperature": label(STEPPING["temperature_C"]),
        "frequency": label(STEPPING["frequency_Hz"]),
    }
    _part = STEPPING["part"]  # a specimen of the same shape, small enough for sweeps that go on for long
    _amplitude = f"--amplitude-m {STUDY['test']['amplitude_m'] / _part} --cycles 1.5 --rest-steps 0"
    SPECIMENS["_part"] = Specimens(
        "time_step/",
        how=" made smaller",
        geometry={
            key: value / _part ** (3 if key.endswith("_kg") else 1)
            for key, value in STUDY["specimens"]["geometry"].items()
        },
        tested=[],
        others=[STEPPED["sample"]],
    )
    TESTS["simulate_step"] = Tests(
        "time_step/reduced",
        "Test with a time step of {wildcards.time_step} s",
        place=f"{ONE_TEST}/dt{{time_step}}",
        test=options(STUDY["test"], "amplitude_m", "rest_steps") + " --cycles 1 --time-step-s {time_step}",
    )
    TESTS["simulate_part"] = Tests(
        "time_step/part",
        "Test the smaller specimen, every step solved",
        place=ONE_TEST,
        model=model("time_step/"),
        test=f"{_amplitude} --time-step-s {STUDY['test']['time_step_s']}",
    )
    TESTS["simulate_sweeps"] = Tests(
        "time_step/sweeps",
        "Test with a time step of {wildcards.time_step} s, sweeps to a tolerance of {wildcards.tolerance}",
        place=f"{ONE_TEST}/tolerance{{tolerance}}/dt{{time_step}}",
        model=model("time_step/"),
        test=_amplitude + " --time-step-s {time_step} --method sweeps --most-sweeps 20000 --tolerance {tolerance}",
        priority=5,
    )
    _steps = STEPPING["time_steps_s"]
    SOLVED = TESTS["simulate_step"].files(**STEPPED, time_step=[label(step) for step in _steps])
    PART_SOLVED = TESTS["simulate_part"].files(**STEPPED)
    STOPPED = TESTS["simulate_sweeps"].files(
        **STEPPED,
        tolerance=[label(tolerance) for tolerance in STEPPING["tolerances"]],
        # shorter ones take too long
        time_step=[label(step) for step in _steps if step >= STUDY["test"]["time_step_s"]],
    )
    KEPT += [*SOLVED, *PART_SOLVED, *STOPPED]
