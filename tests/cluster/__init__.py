"""The smoke study on a real Slurm of one node: `PYTHONPATH=tests python -m cluster`, or `make cluster`."""
