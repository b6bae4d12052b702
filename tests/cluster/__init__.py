"""A study on a real Slurm of one node: `PYTHONPATH=tests:src python -m cluster`, or `make cluster`."""
