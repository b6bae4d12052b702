"""A diagnosis in plain sentences; `brief` puts the answer together.

Some are made where they are found: `screening.levels` and `causality`, `search.confined` and `doubts`, `next_tests`.
"""
