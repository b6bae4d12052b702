"""A diagnosis in plain sentences; `answer` puts it together, words.j2 holds it.

Some are made where they are found: `screening.levels`, `search.told` and `doubts`, `next_tests`.
"""
