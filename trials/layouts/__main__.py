"""Laboratory layouts, as many as told (40): how many are read, how many refused, and how many read wrongly.

PYTHONPATH=trials .venv/bin/python -m layouts [NUMBER] [SEED] [FOLDER]
"""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

from layouts.generator import draw
from layouts.score import outcome


def main(number: int, first: int, folder: Path) -> int:
    counts = {"read": 0, "refused": 0, "wrong": 0}
    for seed in range(first, first + number):
        _, path, tests = draw(seed, folder)
        result, said = outcome(path, tests)
        counts[result] += 1
        if result != "read":
            print(f"{result}: {path.name}: {said}")
    print(f"{number} files: " + ", ".join(f"{count} {name}" for name, count in counts.items()))
    return int(counts["wrong"] > 0 or counts["read"] < 0.95 * number)


if __name__ == "__main__":
    numbers = [int(text) for text in sys.argv[1:3]] + [40, 0][len(sys.argv[1:3]) :]
    with tempfile.TemporaryDirectory() as temporary:
        where = Path(sys.argv[3] if len(sys.argv) > 3 else temporary)
        where.mkdir(parents=True, exist_ok=True)
        sys.exit(main(numbers[0], numbers[1], where))
