"""Whatever a file holds, a reader takes it or refuses it in one sentence.

Run by `make fuzz`, or `PYTHONPATH=trials:tests python -m fuzz 100000`.
"""
