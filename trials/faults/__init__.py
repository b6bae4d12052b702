"""What must not lose, damage or falsify a result: `PYTHONPATH=trials python -m faults`, or `make faults`."""
