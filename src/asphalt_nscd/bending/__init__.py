"""One test on one specimen: rig, layers, steps, fatigue, the table of tests."""
