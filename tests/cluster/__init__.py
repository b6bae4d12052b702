"""The smoke study on a real Slurm of one node: `python -m tests.cluster`."""
