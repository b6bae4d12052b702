"""A law file of any kind as exports need it: the law, its shift, and the band in which it was tested."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from asphalt_nscd.diagnosis.written import read_residuals
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.paths import is_file
from asphalt_nscd.files.store import read_json
from asphalt_nscd.rheology.burgers import Burgers
from asphalt_nscd.rheology.chain import KelvinChain
from asphalt_nscd.rheology.laws_io import bond_law_of, numbers_of, require_holds
from asphalt_nscd.rheology.shift import GAS_CONSTANT, WLF, ZERO_CELSIUS, Arrhenius
from asphalt_nscd.rheology.spectrum import LAWS, Spectrum
from asphalt_nscd.rheology.spectrum_io import Uncertainty, spectrum_of, uncertainty_of

Vector = NDArray[np.float64]
Complex = NDArray[np.complex128]

ONE_TEMPERATURE = {"burgers": "Burgers", "kelvin_chain": "Kelvin chain"}
LAW_OF_DIAGNOSIS = "law.json"
# Where neither the file nor the user says what was tested.
USUAL_TEMPERATURES = (-10.0, 0.0, 10.0, 20.0, 30.0, 40.0)  # degC
USUAL_FREQUENCIES = (0.1, 1.0, 10.0, 40.0)  # Hz
_SAID = ("temperature_C", "rms_log_residual")


@dataclass(frozen=True)
class Band:
    """Tested temperatures (n,) [degC] and frequencies (n,) [Hz], one of each for every test; `origin`: who says so."""

    temperature: Vector
    frequency: Vector
    origin: str

    def __str__(self) -> str:
        frequencies = f"{self.frequency.min():g} to {self.frequency.max():g} Hz ({self.origin})"
        low, high = self.temperature.min(), self.temperature.max()
        return f"{low:g} degC, {frequencies}" if low == high else f"{low:g} to {high:g} degC, {frequencies}"


@dataclass(frozen=True)
class ExportedLaw:
    """A law in SI units and what its file says.

    `kind` is "burgers", "kelvin_chain" or one of LAWS; `temperature` in degC is the only one, or the reference of the
    shift; `shift` is None for a law of one temperature; `band` is where it was tested; `parameters` (with `std_error`
    of some, and 95 % `intervals`) have the keys of the file, which carry the units; `rms_log_residual` is that of the
    fit to tests; `unseen` are parameters that the tests do not determine at all. `misses` are the errors that the
    diagnosis beside the file tells.
    """

    path: Path
    kind: str
    source: str
    law: Spectrum | Burgers | KelvinChain
    temperature: float
    shift: WLF | Arrhenius | None
    band: Band
    parameters: dict[str, float]
    std_error: dict[str, float]
    rms_log_residual: float | None
    unseen: tuple[str, ...] = ()
    uncertainty: Uncertainty | None = None
    intervals: Mapping[str, Sequence[float]] = field(default_factory=dict)
    misses: Mapping[str, float] | None = None

    @property
    def name(self) -> str:
        """Kind of law and of shift, in words."""
        shift = {WLF: ", WLF shift", Arrhenius: ", Arrhenius shift"}.get(type(self.shift), "")
        title = ONE_TEMPERATURE.get(self.kind) or LAWS[self.kind].title
        return f"{title}{shift}"

    @property
    def is_forecast(self) -> bool:
        """Whether it comes of a recipe, so that no test of the mix stands behind it."""
        return self.source.startswith("forecast ")

    def loose(self) -> str:
        """A sentence on parameters that the tests do not determine; empty where there are none."""
        if not self.unseen:
            return ""
        return f"The tests do not determine {', '.join(self.unseen)}: do not trust the law beyond them."

    def reference_modulus(self, omega: Vector) -> Complex:
        """E* (n,) [Pa] at `temperature` and angular frequencies `omega` (n,) [rad/s]."""
        if self.shift is None:
            return self.law.complex_modulus(omega)  # type: ignore[call-arg]
        return self.law.complex_modulus(omega, self.temperature)  # type: ignore[call-arg]

    def factor(self, temperature: Vector) -> Vector:
        """The shift factor a_T (n,) at temperatures (n,) [degC]; 1 for a law of one temperature."""
        return np.ones_like(temperature) if self.shift is None else self.shift.factor(temperature)

    def defined(self, temperature: Vector) -> NDArray[np.bool_]:
        """Whether the shift is defined at temperatures (n,) [degC]; a WLF shift ends C2 below its reference."""
        if not isinstance(self.shift, WLF):
            return np.full(temperature.shape, True)
        return temperature - self.shift.reference_temperature + self.shift.c2 > 0.0

    def half_widths(self, omega: Vector) -> Complex | None:
        """Half of the 95 % intervals at `temperature` and `omega` (n,) [rad/s]; None where the file does not tell.

        Complex (n,): of ln|E*| and, imaginary, of the phase [rad].
        """
        if self.uncertainty is None or isinstance(self.law, Burgers | KelvinChain):
            return None
        return self.uncertainty.half(self.law, omega, np.full(omega.shape, self.temperature))

    def reduced_band(self) -> tuple[float, float]:
        """Lowest and highest angular frequency [rad/s] of the tested band, shifted to `temperature`."""
        reduced = 2.0 * np.pi * self.band.frequency * self.factor(self.band.temperature)
        return float(reduced.min()), float(reduced.max())

    def wlf(self) -> WLF | None:
        """The shift as WLF constants, which an Arrhenius shift has too (`wlf_of`); None for one temperature."""
        if not isinstance(self.shift, Arrhenius):
            return self.shift
        return wlf_of(self.shift)


def wlf_of(shift: Arrhenius) -> WLF:
    """WLF constants of an Arrhenius shift, the same at all temperatures: C1 = E_a / (ln(10) R T0), C2 = T0 [K].

    Both shifts have the same reference temperature T0.

    >>> arrhenius = Arrhenius(activation_energy=200e3, reference_temperature=15.0)
    >>> (wlf_of(arrhenius).factor([-20, 40]) / arrhenius.factor([-20, 40])).round(12).tolist()
    [1.0, 1.0]
    """
    # WLF with C2 = T0 in kelvin is Arrhenius: C2 + T - T0 is then T, and the same fraction remains.
    reference = shift.reference_temperature + ZERO_CELSIUS
    c1 = shift.activation_energy / (GAS_CONSTANT * reference * math.log(10.0))
    return WLF(c1, reference, shift.reference_temperature)


def read_law_file(
    path: str | Path,
    temperatures: tuple[float, ...] | None = None,
    frequencies: tuple[float, ...] | None = None,
) -> ExportedLaw:
    """Read a law of a study, of a diagnosis (or the folder of one), or of the extended simulation.

    `temperatures` [degC] and `frequencies` [Hz] are the tested ones, every pair. Where they are absent, the band is
    that of residuals.csv beside the law of a diagnosis, or of a Kelvin chain, or a usual one.
    """
    path = Path(path)
    if path.is_dir():
        if not (path / LAW_OF_DIAGNOSIS).is_file():
            raise InputError(
                f"{path}: a folder without {LAW_OF_DIAGNOSIS}; give a law, or the folder of a diagnosis."
            )
        path /= LAW_OF_DIAGNOSIS
    return law_of(path, read_json(path), temperatures, frequencies)


def law_of(
    path: Path,
    content: Any,
    temperatures: tuple[float, ...] | None = None,
    frequencies: tuple[float, ...] | None = None,
) -> ExportedLaw:
    """The law in the content of a file, with the band as `read_law_file` takes it [degC, Hz].

    Refuses `temperatures` for a law of one temperature.
    """
    kind = content.get("law") if isinstance(content, dict) else None
    known = [*ONE_TEMPERATURE, *LAWS]
    if kind not in known:
        # Both files lie in the folder of a diagnosis.
        if isinstance(content, dict) and "ladder" in content:
            raise InputError(f"{path}: is a diagnosis; give the law.json beside it.")
        holds = "no law file, for it has no key 'law'" if kind is None else f"holds law {kind!r}"
        raise InputError(f"{path}: {holds}; give a file with one of {', '.join(known)}.")
    law: Any
    if kind in LAWS:
        law = spectrum_of(path, content)
        shift, temperature = law.shift, law.shift.reference_temperature
    else:
        law, shift = bond_law_of(path, content), None
        temperature = numbers_of(path, content, {"temperature": "temperature_C"})["temperature"]
        if temperatures is not None:
            raise InputError(
                f"{path}: a law of one temperature, {temperature:g} degC; leave out --temperatures-c, "
                "or give a law of all temperatures, such as law.json of a diagnosis."
            )
        temperatures = (temperature,)
        require_holds(path, content, None, frequencies or ())
    band = _band(path, content, temperatures, frequencies)
    rms = content.get("rms_log_residual")
    return ExportedLaw(
        path,
        kind,
        str(content.get("source")),
        law,
        temperature,
        shift,
        band,
        _numbers(content),
        _numbers(content.get("std_error")),
        rms if isinstance(rms, float) else None,
        tuple(str(name) for name in content.get("unseen") or ()),
        uncertainty_of(path, content, law) if kind in LAWS else None,
        content.get("interval_95") or {},
        _misses(path),
    )


def _misses(path: Path) -> Mapping[str, float] | None:
    """Errors of a law.json as the diagnosis beside it has them; None without one, or if it is too old to have them."""
    beside = path.with_name("diagnosis.json")
    if path.name != LAW_OF_DIAGNOSIS or not is_file(beside):
        return None
    misses = read_json(beside).get("law_misses") or {}
    return misses if "off_phase_deg" in misses else None


def _numbers(content: Any) -> dict[str, float]:
    """The numbers in a part of the file by their keys, without those of _SAID, which are told elsewhere."""
    if not isinstance(content, dict):
        return {}
    # A flag is no parameter, although Python's bool is an int.
    return {
        key: float(value)
        for key, value in content.items()
        if key not in _SAID and isinstance(value, int | float) and not isinstance(value, bool)
    }


def _band(
    path: Path,
    content: dict[str, Any],
    temperatures: tuple[float, ...] | None,
    frequencies: tuple[float, ...] | None,
) -> Band:
    """What was tested: as stated, else by residuals.csv beside the law, else by the chain, else a usual band."""
    one = content["law"] in ONE_TEMPERATURE
    residuals = path.with_name("residuals.csv")
    origin = "as stated"
    # What the user states goes first; what he leaves open is that of the tests beside the law.
    if not one and None in (temperatures, frequencies) and is_file(residuals):
        tests = read_residuals([residuals])
        tested = tests["temperature_C"].to_numpy(float), tests["frequency_Hz"].to_numpy(float)
        if temperatures is None and frequencies is None:
            return Band(*tested, "the tests in residuals.csv")
        given = "temperatures" if temperatures else "frequencies"
        origin = f"{given} as stated, the rest from residuals.csv"
        temperatures = temperatures or tuple(np.unique(tested[0]).tolist())
        frequencies = frequencies or tuple(np.unique(tested[1]).tolist())
    if frequencies is None and content["law"] == "kelvin_chain":
        ends = numbers_of(path, content, {"low": "lowest_Hz", "high": "highest_Hz"})
        frequencies, origin = (ends["low"], ends["high"]), "band of the chain"
    if frequencies is None or temperatures is None:
        origin = "assumed, the file does not say what was tested"
    pairs = np.array(
        [(t, f) for t in temperatures or USUAL_TEMPERATURES for f in frequencies or USUAL_FREQUENCIES]
    )
    return Band(pairs[:, 0], pairs[:, 1], origin)
