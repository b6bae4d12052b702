"""What must not lose, damage or falsify a result: `PYTHONPATH=tests python -m faults`, or `make faults`."""
