"""Kinds of test. No numpy, for the command line and the planning of a study ask it, and Snakemake alone has none."""

BENDING = "bending"  # the paper's test: two-point, of a trapezoid
PAPER_AMPLITUDE = 63e-6  # m, of a head 250 mm above a foot 56 mm wide
# Steps of a cycle by the fitted scheme, of other tests. At full size it errs by 0.005 degrees of phase at most, and
# implicit Euler with steps of 50 us by 0.11.
FITTED_STEPS = 200
# Tests whose measurements can be diagnosed, as a reader calls them; `geometry.USUAL` has those that can be simulated.
TEST_TYPES = {
    BENDING: "two-point bending of trapezoids",
    "tension-compression": "axial tests of cylinders (AMPT or UTM)",
}
UNKNOWN = "unknown"  # of moduli where nothing says which test gave them


def usual_steps_per_cycle(test: str) -> int | None:
    """Steps by the scheme fitted to the frequency that a simulated test takes unless told otherwise.

    None for the paper's test, whose steps of implicit Euler have a length instead.
    """
    return None if test == BENDING else FITTED_STEPS
