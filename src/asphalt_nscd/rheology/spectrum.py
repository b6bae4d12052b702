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
        """What the law's own parameters must satisfy, if these do not.

        Parameters
        ----------
        values : mapping of str to float
            Parameters by name, in SI units.

        Returns
        -------
        str
            "needs 0 < k < 1", or nothing.
        """

    title: ClassVar[str]  # as a reader knows it

    @property
    def shift(self) -> WLF | Arrhenius:
        """How frequency and temperature stand for each other."""

    def complex_modulus(self, omega: ArrayLike, temperature: ArrayLike) -> NDArray[np.complex128]:
        """Complex modulus.

        Parameters
        ----------
        omega : array_like
            Angular frequencies [rad/s].
        temperature : array_like
            [degC], broadcast with omega.

        Returns
        -------
        ndarray of complex
            E* [Pa], of the shape of both together.
        """

    def log_slopes(self, omega: ArrayLike, temperature: ArrayLike) -> NDArray[np.complex128]:
        """Derivatives of ln E* with respect to the logarithm of each of its `parameters`.

        Parameters
        ----------
        omega : array_like (n,)
            Angular frequencies [rad/s].
        temperature : array_like (n,)
            [degC].

        Returns
        -------
        ndarray of complex
            (n, p) In the order of `parameters`.
        """


LAWS: dict[str, Any] = {"2s2p1d": TwoS2P1D, "huet-sayegh": HuetSayegh, "sigmoid": Sigmoid, "cam": CAM}


def parameter_names(kind: type) -> list[str]:
    """Names of a law's or a shift's own parameters; the reference temperature is a choice, none of them.

    Parameters
    ----------
    kind : type
        Class of the law or of the shift.

    Returns
    -------
    list of str
        In the order of its fields.
    """
    return [field.name for field in fields(kind) if field.name not in ("shift", "reference_temperature")]


def parameters(law: Any) -> dict[str, float]:
    """Parameters of a law by name, those of its shift, if it has one, at the end.

    Parameters
    ----------
    law : Spectrum
        In SI units.

    Returns
    -------
    dict of str to float
        In the order of `parameter_names`.
    """
    # A Burgers law is of one temperature and has no shift.
    parts = [law, law.shift] if hasattr(law, "shift") else [law]
    return {name: getattr(part, name) for part in parts for name in parameter_names(type(part))}
