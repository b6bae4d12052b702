"""One test on one specimen: rig, layers, steps, checkpoints, fatigue, the table of tests."""
