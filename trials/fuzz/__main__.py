"""Inputs to all readers, as many as told (100 000), none twice the same; a line for each reader.

PYTHONPATH=trials:tests python -m fuzz [NUMBER]     or     make fuzz
"""

from __future__ import annotations

import resource
import sys
import tempfile
import time
from pathlib import Path

from hypothesis import HealthCheck, Phase, given, settings

from fuzz.damage import binaries, texts
from fuzz.readers import BINARIES, TEXTS, Reader, tried

MOST_MEMORY = 3 * 2**30  # bytes of addresses: beyond, a reader fails


def main(number: int) -> int:
    resource.setrlimit(resource.RLIMIT_AS, (MOST_MEMORY, MOST_MEMORY))
    readers = [*TEXTS, *BINARIES]
    # Workbooks and HDF5 take ten times as long.
    shares = [0.15 if reader in BINARIES else 1.0 for reader in readers]
    total = 0
    for reader, share in zip(readers, shares):
        wanted = round(number * share / sum(shares))
        began = time.monotonic()
        count, refused = run(reader, wanted)
        total += count
        memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss // 1024
        print(
            f"{reader.name}: {count} inputs, {refused} refused, {time.monotonic() - began:.0f} s, {memory} MB at most",
            flush=True,
        )
    print(f"{total} inputs, no unhandled exception.")
    return 0


def run(reader: Reader, wanted: int) -> tuple[int, int]:
    count = refused = 0
    contents = (binaries if reader in BINARIES else texts)(reader.begin)
    with tempfile.TemporaryDirectory() as folder:

        @settings(
            max_examples=wanted,
            deadline=None,
            database=None,
            phases=[Phase.generate, Phase.shrink],
            suppress_health_check=list(HealthCheck),
        )
        @given(content=contents)
        def check(content: bytes) -> None:
            nonlocal count, refused
            count += 1
            refused += tried(reader, content, Path(folder)) is not None

        check()
    return count, refused


if __name__ == "__main__":
    sys.exit(main(int(sys.argv[1]) if len(sys.argv) > 1 else 100_000))
