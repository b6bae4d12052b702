"""Where compiled kernels are kept: a folder named by a hash of all core sources, so that none can be stale."""

from __future__ import annotations

import hashlib
import os
from pathlib import Path


def core_folder() -> str:
    """The folder of what has been compiled from these sources."""
    digest = hashlib.sha256()
    for source in sorted(Path(__file__).parent.rglob("*.py")):  # a folder lists its files in any order
        digest.update(source.read_bytes())
    return str(Path(cache_base()) / f"core-{digest.hexdigest()[:16]}")


def is_compiled(kernel: str) -> bool:
    """Whether a kernel named as `granular.step` has been compiled from these sources."""
    return any(Path(core_folder()).glob(f"*/{kernel}-*.nbi"))


def cache_base() -> str:
    """The folder of all that is compiled, of these sources and others."""
    told = os.environ.get("ASPHALT_NSCD_CACHE")
    if told:
        return told
    from platformdirs import user_cache_dir  # a workflow tells its jobs, which need not load this

    return user_cache_dir("asphalt-nscd")
