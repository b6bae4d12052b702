# Quezada & Chazallon (2020), "Complex modulus modeling of asphalt concrete mixes using the
# NonSmooth Contact Dynamics method", in the order of the paper.
#
#   snakemake --cores all                                   the paper
#   snakemake --cores all --configfile config/smoke.yaml    the same chain at reduced size


include: "workflow/rules/common.smk"


rule all:
    # Everything the study asks for.
    default_target: True
    input:
        "<results>/measured.csv",
        expand("<results>/laws/fitted/T{temperature}.json", temperature=TEMPERATURES),


include: "workflow/rules/data.smk"  # Section 2
include: "workflow/rules/fit.smk"  # Section 4.1
