# Quezada & Chazallon (2020), "Complex modulus modeling of asphalt concrete mixes using the
# NonSmooth Contact Dynamics method", in the order of the paper.
#
#   snakemake --cores all                                   the paper
#   snakemake --cores all --configfile config/smoke.yaml    the same chain at reduced size


include: "workflow/rules/common.smk"


report: "workflow/report/study.rst"


onsuccess:
    if any(REPORT in job.output for job in workflow.dag.jobs):  # it was asked for
        logger.info(f"Report: {Path(REPORT).resolve()}")


onerror:
    # Last, and without the noise above.
    for sentence in failures(log):
        print(sentence, file=sys.stderr)


include: "workflow/rules/data.smk"  # Section 2: tests and their reduction
include: "workflow/rules/fit.smk"  # Section 4.1: Burgers laws
include: "workflow/rules/specimen.smk"  # Section 3.2: numerical samples
include: "workflow/rules/bending.smk"  # Section 4.2: bending tests
include: "workflow/rules/facets.smk"  # the same tests with bonds that fill the specimen
include: "workflow/rules/time_step.smk"  # Fig. 6: time step
include: "workflow/rules/sensitivity.smk"  # Section 4.3: sensitivity of the law's parameters
include: "workflow/rules/audit.smk"  # other readings, looser samples
include: "workflow/rules/diagnosis.smk"  # what the simulation gets wrong, and why
include: "workflow/rules/extension.smk"  # the simulation extended by it
include: "workflow/rules/families.smk"  # what it gains on data of other families
include: "workflow/rules/exports.smk"  # the law for other programs
include: "workflow/rules/contents.smk"  # figures and tables, and their data
include: "workflow/rules/report.smk"  # figures, tables, report
include: "workflow/rules/stages.smk"  # each stage by its name
include: "workflow/rules/publish.smk"  # what is committed
include: "workflow/rules/verification.smk"  # is the core right

if POURED:

    include: "workflow/rules/benchmark.smk"  # how fast is it beside its peers
    include: "workflow/rules/mapping.smk"  # how bonds carry the law, by size and packing


if STUDY["study"] == "blind":

    include: "workflow/rules/blind.smk"  # blind tests of the diagnosis


rule all:
    # Everything the study asks for.
    default_target: True
    input:
        "<results>/report.html",
        "<results>/workflow.html",
        KEPT,
