"""One decorator for every compiled kernel, with a cache that cannot go stale.

Numba's cache notices an edit only in the file of the function itself, not in a callee from
another file (numba issue 1833). The cache folder is therefore named by a hash of all core sources.
"""

from __future__ import annotations

import hashlib
import os
from pathlib import Path

import numba
from platformdirs import user_cache_dir


def _cache_folder() -> str:
    digest = hashlib.sha256()
    for source in sorted(Path(__file__).parent.rglob("*.py")):
        digest.update(source.read_bytes())
    base = os.environ.get("ASPHALT_NSCD_CACHE") or user_cache_dir("asphalt-nscd")
    return str(Path(base) / f"core-{digest.hexdigest()[:16]}")


numba.config.CACHE_DIR = _cache_folder()
compiled = numba.njit(cache=True, error_model="numpy")
