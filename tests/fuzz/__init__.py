"""Whatever a file holds, a reader takes it or refuses it in one sentence: `PYTHONPATH=tests python -m fuzz 100000`."""
