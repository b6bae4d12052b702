"""Decorators for every compiled kernel, with a cache that cannot go stale.

Numba's cache notices an edit only in the file of the function itself, not in a callee from
another file (numba issue 1833). The cache folder is therefore named by a hash of all core sources.
"""

from __future__ import annotations

try:
    from numba import config, njit
except ModuleNotFoundError as missing:
    missing.add_note("Simulated specimens need the extra: pip install 'asphalt-nscd[simulation]'")
    raise

from asphalt_nscd.nscd.core_cache import core_folder

setattr(config, "CACHE_DIR", core_folder())  # noqa: B010 - numba declares none of its settings
# no fastmath, which may add in another order: equal bits are promised. A division by zero gives inf or NaN
compiled = njit(cache=True, error_model="numpy")
compiled_for_teams = njit(cache=True, error_model="numpy", nogil=True)  # run by many threads at once
