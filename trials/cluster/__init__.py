"""A study on a real Slurm of one node: `PYTHONPATH=trials:src python -m cluster`, or `make cluster`."""
