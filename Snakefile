# The workflow stands in workflow/Snakefile.
#
#   snakemake --cores all                                   the paper
#   snakemake --cores all --configfile config/smoke.yaml    the same chain at reduced size


include: "workflow/Snakefile"


workflow.default_target = "all"  # an included rule is none by itself
