"""Where compiled kernels are kept: a folder named by a hash of all core sources, so that none can be stale."""

from __future__ import annotations

import hashlib
import os
from pathlib import Path

from platformdirs import user_cache_dir


def core_folder() -> str:
    """The folder of what has been compiled from these sources."""
    digest = hashlib.sha256()
    for source in sorted(Path(__file__).parent.rglob("*.py")):
        digest.update(source.read_bytes())
    base = os.environ.get("ASPHALT_NSCD_CACHE") or user_cache_dir("asphalt-nscd")
    return str(Path(base) / f"core-{digest.hexdigest()[:16]}")
