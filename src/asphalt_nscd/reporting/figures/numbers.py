"""Numbers as they are printed."""

from __future__ import annotations

import numpy as np


def celsius(temperature: float) -> str:
    """15 -> "15 °C", with a true minus.

    Parameters
    ----------
    temperature : float
        [degC].

    Returns
    -------
    str
        In print.
    """
    return minus(f"{temperature:g} °C")


def minus(number: str) -> str:
    """A number in text with a true minus.

    Parameters
    ----------
    number : str
        In text.

    Returns
    -------
    str
        In print.
    """
    return number.replace("-", "\N{MINUS SIGN}")


def power(value: float, digits: int = 2) -> str:
    """2.4e7 -> 2.4 times a power of ten, as mathematical text.

    Parameters
    ----------
    value : float
        Above zero.
    digits : int
        Of the factor.

    Returns
    -------
    str
        For Matplotlib.
    """
    # 1e-9: rounding must not take a power of ten below its own exponent.
    exponent = int(np.floor(np.log10(value) + 1e-9))
    return rf"${value / 10.0**exponent:.{digits}g}\times10^{{{exponent}}}$"
