"""Kinds of test. No numpy, for the command line and the planning of a study ask it, and Snakemake alone has none."""

BENDING = "bending"  # the paper's test: two-point, of a trapezoid
PAPER_AMPLITUDE = 63e-6  # m, of a head 250 mm above a foot 56 mm wide
# A cycle, of other tests: 0.005 degrees at most at full size, where 50 us of implicit Euler leave 0.11.
FITTED_STEPS = 200
# Tests whose measurements can be diagnosed, as a reader calls them; `geometry.USUAL` has those that can be simulated.
TEST_TYPES = {
    BENDING: "two-point bending of trapezoids",
    "tension-compression": "axial tests of cylinders (AMPT or UTM)",
}
UNKNOWN = "unknown"  # of moduli where nothing says which test gave them
