"""What a user sets of a diagnosis. No numpy, for command line and schema ask it."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from asphalt_nscd.files.options import option

LAWS = ("2s2p1d", "huet-sayegh", "sigmoid", "cam")  # written out: to load those of rheology takes 0.2 s


@dataclass(frozen=True)
class Draws:
    """Of the chance level: how many, and the seed of their random numbers.

    Parameters
    ----------
    number : int
        Draws of the chance level.
    seed : int
        Seed of the random draws that give the chance level.

    Examples
    --------
    >>> Draws(500)
    Draws(number=500, seed=0)
    """

    number: int = option(default=4000, key="draws", low=500, high=10**6)
    seed: int = option(default=0, low=0)


@dataclass(frozen=True)
class Simulated:
    """What was simulated of the tests that are diagnosed.

    Parameters
    ----------
    campaign : path, optional
        Simulated tests of the campaign, to say what in them is numerics.
    facets : path, optional
        The same tests on specimens bonded by facets, to say what the paper's bonds make of |E*|.
    specimen : path, optional
        Numerical specimen, a file of `reduced-specimen`; else, of two-point bending, the one shipped.

    Examples
    --------
    >>> Simulated(campaign="results/smoke/simulations.csv").specimen is None
    True
    """

    campaign: str | Path | None = option(default=None, key="simulations")
    facets: str | Path | None = option(default=None)
    specimen: str | Path | None = option(default=None)


@dataclass(frozen=True)
class Known:
    """What is known beside the table.

    Parameters
    ----------
    static_modulus_MPa : float, optional
        Modulus of the mix at long times, MPa, if another test gave it. Only then can a spring at the head be
        found.
    scatter : tuple of float, optional
        Standard deviations of one test: |E*| in % and phase in degrees; else they come from replicates.
    vma_percent : float, optional
        Voids in mineral aggregate, %. With VFA it gives the glassy modulus of law.json, by AASHTO R 84.
    vfa_percent : float, optional
        Voids filled with binder, %.
    law : str
        Form of the law in law.json; sigmoid is that of AASHTO R 84. Misfits of all four are compared.

    Examples
    --------
    >>> Known(scatter=(3.0, 0.5)).static_modulus_MPa is None
    True
    """

    static_modulus_MPa: float | None = option(default=None, low=0.0)
    scatter: tuple[float, float] | None = None
    vma_percent: float | None = option(default=None, low=5.0, high=40.0)
    vfa_percent: float | None = option(default=None, low=10.0, high=100.0)
    law: str = option(default="2s2p1d", choices=LAWS)


@dataclass(frozen=True)
class Scatter:
    """Standard deviations of one test, in percent and in degrees; None where replicates give them."""

    modulus_scatter_percent: float | None = option(
        "Scatter of |E*| of one test, its relative standard deviation, percent; else from replicates.",
        None,
        above=0.0,
    )
    phase_scatter_deg: float | None = option(
        "Scatter of the phase of one test, degrees; else from replicates.", None, above=0.0
    )
