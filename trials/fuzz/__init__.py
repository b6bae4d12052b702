"""Whatever a file holds, a reader takes it or refuses it in one sentence, and so does the diagnosis.

Run by `make fuzz`, or `PYTHONPATH=trials:tests python -m fuzz 100000` and `python -m fuzz.diagnoses 1000`.
"""
