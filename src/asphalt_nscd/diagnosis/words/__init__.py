"""A diagnosis in plain sentences; `brief` puts the answer together.

Some are made where they are found: `screening.levels`, `search.told` and `doubts`, `next_tests`.
"""
