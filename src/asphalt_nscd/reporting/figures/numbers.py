"""Numbers as they are printed."""

from __future__ import annotations


def celsius(temperature: float) -> str:
    """15 -> "15 °C", with a true minus."""
    return minus(f"{temperature:g} °C")


def minus(number: str) -> str:
    """A number in text with a true minus."""
    return number.replace("-", "\N{MINUS SIGN}")
