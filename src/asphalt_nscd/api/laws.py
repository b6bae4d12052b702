"""Laws of the material: fitted, read, evaluated, written, exported."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike, NDArray

from asphalt_nscd.api.arguments import checked
from asphalt_nscd.api.tables import observed_in
from asphalt_nscd.exports.law import ONE_TEMPERATURE, ExportedLaw, law_of
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.store import read_json, write_json
from asphalt_nscd.rheology.burgers import Burgers
from asphalt_nscd.rheology.chain import KelvinChain
from asphalt_nscd.rheology.chain_law import chain_at
from asphalt_nscd.rheology.fitted_laws import burgers_at
from asphalt_nscd.rheology.laws_io import law_content, require_holds
from asphalt_nscd.rheology.priors import prior_of
from asphalt_nscd.rheology.spectrum import LAWS
from asphalt_nscd.rheology.spectrum_fitting import Form, fit_spectrum
from asphalt_nscd.rheology.spectrum_io import fit_content

TITLES: dict[str, str] = {name: kind.title for name, kind in LAWS.items()}  # of laws of all temperatures
CHAIN_ERROR = 1e-3  # of ln E*, of the chain that bonds follow
MARGIN = 2.0  # of its band to either side of the tested frequency, for the transient


@dataclass(frozen=True)
class Law:
    """A law of E*, of one temperature (Burgers, Kelvin chain) or of all (with their shift).

    Parameters
    ----------
    content : mapping
        As its JSON file has it; `Law.read` and `fit` make it.
    source : path
        Of the file; the frequencies and temperatures in a table of tests beside it are the band of an export.

    Raises
    ------
    InputError
        Where the content is that of no law.

    Examples
    --------
    >>> law = Law.burgers(Em_Pa=24.3e9, eta_m_Pa_s=3.71e9, Ek_Pa=48.4e9, eta_k_Pa_s=0.773e9, temperature_C=15)
    >>> print(f"{abs(law.complex_modulus(10.0)) / 1e9:.2f} GPa")  # Table 3 of the paper, at 10 Hz
    18.70 GPa
    """

    content: Mapping[str, Any]
    source: Path = Path("in memory", "law.json")

    def __post_init__(self) -> None:
        if not isinstance(self.content, Mapping):
            raise InputError(f"Law: {self.content!r} is no content of a law; give a path to Law.read.")
        self._parsed  # noqa: B018  refuses a content that is no law

    @classmethod
    def read(cls, path: str | Path) -> Law:
        """Read a law from the file that `fit`, `diagnose` or `chain-law` wrote.

        Parameters
        ----------
        path : path
            JSON file.

        Returns
        -------
        Law
            The law.

        Raises
        ------
        InputError
            Where the file is missing or holds no law.
        """
        return cls(read_json(path), Path(path))

    @classmethod
    @checked
    def burgers(
        cls, *, Em_Pa: float, eta_m_Pa_s: float, Ek_Pa: float, eta_k_Pa_s: float, temperature_C: float
    ) -> Law:
        """A Burgers law of one temperature, Eqs. (27)-(29).

        Parameters
        ----------
        Em_Pa, eta_m_Pa_s : float
            Spring [Pa] and dashpot [Pa s] of the Maxwell element.
        Ek_Pa, eta_k_Pa_s : float
            Spring [Pa] and dashpot [Pa s] of the Kelvin element.
        temperature_C : float
            At which it holds [degC].

        Returns
        -------
        Law
            Of this temperature alone.
        """
        law = Burgers(Em_Pa, eta_m_Pa_s, Ek_Pa, eta_k_Pa_s)
        return cls(law_content(law, source="stated", temperature=temperature_C))

    @cached_property
    def _parsed(self) -> ExportedLaw:
        return law_of(self.source, dict(self.content))

    @property
    def kind(self) -> str:
        """The form of the law.

        Returns
        -------
        str
            "burgers", "kelvin_chain", "2s2p1d", "huet-sayegh", "sigmoid" or "cam".
        """
        return self._parsed.kind

    @property
    def temperature_C(self) -> float | None:
        """The only temperature for which the law holds.

        Returns
        -------
        float or None
            [degC]; None if it holds for all.
        """
        return self._parsed.temperature if self.kind in ONE_TEMPERATURE else None

    @property
    def parameters(self) -> pd.DataFrame:
        """The parameters of the law.

        Returns
        -------
        DataFrame
            value and std_error of each parameter, and whether the tests determine it. The index carries the
            units: E_glassy_Pa, tau_s.
        """
        parsed = self._parsed
        # The reference temperature is chosen, not fitted.
        names = [name for name in parsed.parameters if name != "reference_temperature_C"]
        return pd.DataFrame(
            {
                "value": [parsed.parameters[name] for name in names],
                "std_error": [parsed.std_error.get(name, np.nan) for name in names],
                "determined": [name not in parsed.unseen for name in names],
            },
            index=pd.Index(names, name="parameter"),
        )

    def complex_modulus(
        self, frequency_Hz: ArrayLike, temperature_C: ArrayLike | None = None
    ) -> NDArray[np.complex128]:
        """Complex modulus.

        Parameters
        ----------
        frequency_Hz : array_like
            Frequencies [Hz], above zero.
        temperature_C : array_like, optional
            Temperatures [degC], broadcast with the frequencies; left out for a law of one temperature.

        Returns
        -------
        ndarray of complex
            E* [Pa].

        Raises
        ------
        InputError
            Where a law of all temperatures is given none, or a law of one temperature another.
        """
        frequencies = _numbers(frequency_Hz, "frequency_Hz")
        if not (frequencies > 0.0).all():
            raise InputError("frequency_Hz: not all above zero; give frequencies in Hz.")
        omega = 2.0 * np.pi * frequencies
        law: Any = self._parsed.law
        if self.temperature_C is None:
            if temperature_C is None:
                raise InputError(f"{self.source}: a law of all temperatures; give temperature_C.")
            return np.asarray(law.complex_modulus(omega, _numbers(temperature_C, "temperature_C")))
        if temperature_C is not None:
            # Each once, for the other argument may be an array of thousands.
            for temperature in np.unique(_numbers(temperature_C, "temperature_C")):
                require_holds(self.source, dict(self.content), float(temperature), ())
        return np.asarray(law.complex_modulus(omega))

    def shift_factor(self, temperature_C: ArrayLike) -> NDArray[np.float64]:
        """Shift of frequency with temperature.

        Parameters
        ----------
        temperature_C : array_like
            Temperatures [degC].

        Returns
        -------
        ndarray
            a_T: reduced frequency over frequency; 1 at the reference temperature.

        Raises
        ------
        InputError
            For a law of one temperature.
        """
        if self.temperature_C is not None:
            raise InputError(f"{self.source}: a law of one temperature has no shift; give a law of all.")
        return self._parsed.factor(_numbers(temperature_C, "temperature_C"))

    def write(self, path: str | Path) -> None:
        """Write the law as JSON, as the command line does.

        Parameters
        ----------
        path : path
            File to write.
        """
        write_json(path, dict(self.content))

    def of_bonds(self, frequency_Hz: float, temperature_C: float, highest_Hz: float | None = None) -> Law:
        """The law that bonds follow in a test: itself, or a Kelvin chain of it.

        Parameters
        ----------
        frequency_Hz, temperature_C : float
            Of the test [Hz], [degC].
        highest_Hz : float or None
            Of a test of several frequencies [Hz], whose lowest is frequency_Hz.

        Returns
        -------
        Law
            Within 0.1 % of this law from half to twice the frequency, or from half the lowest to twice the highest.
        """
        highest = highest_Hz or frequency_Hz
        if self.temperature_C is not None:
            require_holds(self.source, dict(self.content), temperature_C, [frequency_Hz, highest])
            return self
        law: Any = self._parsed.law
        band = frequency_Hz / MARGIN, highest * MARGIN
        return Law(chain_at(law, str(self.source), temperature_C, band, CHAIN_ERROR))

    @property
    def bonds(self) -> Burgers | KelvinChain:
        """What a bond needs of a law of one temperature.

        Returns
        -------
        Burgers or KelvinChain
            The law, see `of_bonds`.

        Raises
        ------
        InputError
            For a law of all temperatures.
        """
        law = self._parsed.law
        if not isinstance(law, Burgers | KelvinChain):
            raise InputError(f"{self.source}: a law of all temperatures; take `of_bonds` at one.")
        return law

    def __repr__(self) -> str:
        said = ", ".join(f"{name} = {value:.4g}" for name, value in self.parameters["value"].items())
        return f"Law({self._parsed.name}{self._holds()}: {said})"

    def _repr_html_(self) -> str:
        return f"<p><b>{self._parsed.name}</b>{self._holds()}</p>{self.parameters.to_html()}"

    def _holds(self) -> str:
        if self.temperature_C is not None:
            return f" at {self.temperature_C:g} degC"
        return f", reference {self._parsed.temperature:g} degC"


def _numbers(values: ArrayLike, name: str) -> NDArray[np.float64]:
    """Finite numbers as an array, or InputError."""
    try:
        found = np.asarray(values, float)
    except (TypeError, ValueError):
        raise InputError(f"{name}: {values!r} is no number; give numbers.") from None
    if not np.isfinite(found).all():
        raise InputError(f"{name}: not all finite; give numbers.")
    return found


@checked
def fit(table: Any, law: str = "2s2p1d", *, temperature_C: float | None = None, shift: str = "wlf") -> Law:
    """Fit a law to the moduli of a table.

    Laws of all temperatures stand under priors of what asphalt concrete can be; `Law.parameters` says what the tests do
    not determine. Errors of |E*| and of the phase count alike.

    Parameters
    ----------
    table : path, folder or DataFrame
        Tests: temperature_C, frequency_Hz, E_MPa and phase_deg, or what `read` understands as these.
    law : str
        "burgers" at one temperature, Eqs. (27)-(29); "2s2p1d", "huet-sayegh", "sigmoid" or "cam" at all.
    temperature_C : float, optional
        Of a Burgers law [degC].
    shift : str
        "wlf" or "arrhenius", of a law of all temperatures.

    Returns
    -------
    Law
        With the standard errors of its parameters.

    Raises
    ------
    InputError
        With one sentence that names the file and what it lacks.

    Examples
    --------
    >>> made = Law.burgers(Em_Pa=24.3e9, eta_m_Pa_s=3.71e9, Ek_Pa=48.4e9, eta_k_Pa_s=0.773e9, temperature_C=15)
    >>> f = np.array([3.0, 10.0, 25.0, 40.0])
    >>> E = made.complex_modulus(f)
    >>> table = pd.DataFrame({"temperature_C": 15.0, "frequency_Hz": f, "E_MPa": abs(E) / 1e6,
    ...                       "phase_deg": np.degrees(np.angle(E))})
    >>> print(f"{fit(table, 'burgers', temperature_C=15).parameters.loc['Em_Pa', 'value']:.3g}")
    2.43e+10
    """
    observed, name, origin = observed_in(table)
    if law == "burgers":
        if temperature_C is None:
            raise InputError(
                'fit: a Burgers law holds at one temperature; give temperature_C, or law="2s2p1d".'
            )
        frame = pd.DataFrame(
            {
                # By isotherm: a Burgers law is of one set temperature, and readings wander about it.
                "temperature_C": observed.isotherm,
                "frequency_Hz": observed.frequency,
                "E_MPa": 1e-6 * np.abs(observed.modulus),
                "phase_deg": np.degrees(np.angle(observed.modulus)),
            }
        )
        return Law(burgers_at(frame, temperature_C, name))
    if law not in LAWS:
        raise InputError(f"fit: law {law!r} is not known; give one of burgers, {', '.join(LAWS)}.")
    if temperature_C is not None:
        raise InputError(f"fit: a law of kind {law} holds at all temperatures; leave out temperature_C.")
    reference = float(observed.isotherms[observed.isotherms.size // 2])
    try:
        fitted = fit_spectrum(
            observed.omega,
            observed.temperature,
            observed.modulus,
            reference,
            Form(law, shift),
            # Without it the tests of an AMPT gave a glassy modulus of 259 GPa.
            prior=prior_of(law),
        )
    except InputError as error:
        raise InputError(f"{name}: {error}") from None
    return Law(fit_content(fitted, f"fitted ({origin})"))
