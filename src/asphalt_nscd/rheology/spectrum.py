"""Continuous spectra: laws smooth over all frequencies, carried to all temperatures by a shift; the list of them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields
from typing import Any, ClassVar, Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from asphalt_nscd.rheology.laws_of_modulus import CAM, Sigmoid
from asphalt_nscd.rheology.parabolic import HuetSayegh, TwoS2P1D
from asphalt_nscd.rheology.shift import WLF, Arrhenius


class Spectrum(Protocol):
    """A law of all temperatures and frequencies."""

    @staticmethod
    def refusal(values: Mapping[str, float]) -> str:
        """What the law's own parameters (SI units) must satisfy, as "needs 0 < k < 1", if they do not; else empty."""

    title: ClassVar[str]  # as a reader knows it

    @property
    def shift(self) -> WLF | Arrhenius:
        """How frequency and temperature stand for each other."""

    def complex_modulus(self, omega: ArrayLike, temperature: ArrayLike) -> NDArray[np.complex128]:
        """E* [Pa] at angular frequencies [rad/s] and temperatures [degC], broadcast together."""

    def log_slopes(self, omega: ArrayLike, temperature: ArrayLike) -> NDArray[np.complex128]:
        """Derivatives (n, p) of ln E* by ln of each of `parameters`, at `omega` [rad/s] and `temperature` [degC]."""


LAWS: dict[str, Any] = {"2s2p1d": TwoS2P1D, "huet-sayegh": HuetSayegh, "sigmoid": Sigmoid, "cam": CAM}


def parameter_names(kind: type) -> list[str]:
    """Names of a law's or a shift's own parameters; the reference temperature is a choice, none of them."""
    return [field.name for field in fields(kind) if field.name not in ("shift", "reference_temperature")]


def parameters(law: Any) -> dict[str, float]:
    """Parameters of a law by name in SI units, those of its shift, if it has one, at the end."""
    # A Burgers law is of one temperature and has no shift.
    parts = [law, law.shift] if hasattr(law, "shift") else [law]
    return {name: getattr(part, name) for part in parts for name in parameter_names(type(part))}
