"""What planning a study must know of the paper's test: no numpy, as Snakemake alone has none."""

BENDING = "bending"  # the test: two-point, of a trapezoid
PAPER_AMPLITUDE = 63e-6  # m, of a head 250 mm above a foot 56 mm wide
