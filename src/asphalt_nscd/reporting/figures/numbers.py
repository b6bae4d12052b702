"""Numbers as they are printed."""

from __future__ import annotations

import numpy as np


def celsius(temperature: float) -> str:
    """A temperature [degC] in print: 15 -> "15 °C", with a true minus."""
    return minus(f"{temperature:g} °C")


def minus(number: str) -> str:
    """A number in text with a true minus."""
    return number.replace("-", "\N{MINUS SIGN}")


def plain(value: float) -> str:
    """A power of ten without an exponent where it is short: 0.001, 1000, 1e5, 1e-6."""
    text = f"{value:g}" if 1e-3 <= value < 1e5 else f"{value:.0e}".replace("e+0", "e").replace("e-0", "e-")
    return minus(text)


def power(value: float, digits: int = 2) -> str:
    """A positive number as mathematical text for Matplotlib: 2.4e7 -> 2.4 times a power of ten."""
    # 1e-9: rounding must not take a power of ten below its own exponent.
    exponent = int(np.floor(np.log10(value) + 1e-9))
    return rf"${value / 10.0**exponent:.{digits}g}\times10^{{{exponent}}}$"
