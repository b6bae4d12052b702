"""One decorator for every compiled kernel, with a cache that cannot go stale.

Numba's cache notices an edit only in the file of the function itself, not in a callee from
another file (numba issue 1833). The cache folder is therefore named by a hash of all core sources.
"""

from __future__ import annotations

import numba

from asphalt_nscd.nscd.core_cache import core_folder

numba.config.CACHE_DIR = core_folder()
compiled = numba.njit(cache=True, error_model="numpy")
