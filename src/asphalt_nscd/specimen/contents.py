"""Files of deposits and specimens: their kinds, and what they hold."""

from __future__ import annotations

from typing import Any

import numpy as np

DEPOSIT, SPECIMEN = "deposit", "specimen"  # kinds of files
Content = tuple[dict[str, np.ndarray], dict[str, Any]]
"""Arrays and attributes, as a file has them."""
