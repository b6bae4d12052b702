"""Law files: one law with its origin and its standard errors, as JSON."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path
from typing import Any

from asphalt_nscd.errors import InputError
from asphalt_nscd.rheology.burgers import Burgers
from asphalt_nscd.rheology.spectrum import TwoS2P1D
from asphalt_nscd.store import read_json, write_json

_BURGERS_KEYS = {
    "modulus_m": "Em_Pa",
    "viscosity_m": "eta_m_Pa_s",
    "modulus_k": "Ek_Pa",
    "viscosity_k": "eta_k_Pa_s",
}
_SPECTRUM_KEYS = {
    "static_modulus": "E_static_Pa",
    "glassy_modulus": "E_glassy_Pa",
    "k": "k",
    "h": "h",
    "delta": "delta",
    "tau": "tau_s",
    "beta": "beta",
    "wlf_c1": "wlf_C1",
    "wlf_c2": "wlf_C2_K",
    "reference_temperature": "reference_temperature_C",
}


def write_law(
    path: str | Path,
    law: Burgers,
    *,
    source: str,
    temperature: float,
    std_error: dict[str, float] | None = None,
    rms_log_residual: float | None = None,
) -> dict[str, Any]:
    """Write the Burgers law of one temperature [degC]; source: "published" or "fitted"."""
    content = {
        "law": "burgers",
        "source": source,
        "temperature_C": float(temperature),
        **_renamed(asdict(law), _BURGERS_KEYS),
        "std_error": None if std_error is None else _renamed(std_error, _BURGERS_KEYS),
        "rms_log_residual": rms_log_residual,
    }
    write_json(path, content)
    return content


def read_law(path: str | Path) -> Burgers:
    """Read a Burgers law."""
    values = _fields(path, "burgers", _BURGERS_KEYS)
    try:
        return Burgers(**values)
    except InputError as error:
        raise InputError(f"{path}: {error}") from None


def write_spectrum(
    path: str | Path, law: TwoS2P1D, *, source: str, rms_log_residual: float
) -> dict[str, Any]:
    """Write a 2S2P1D law, which holds for all temperatures."""
    content = {
        "law": "2s2p1d",
        "source": source,
        **_renamed(asdict(law), _SPECTRUM_KEYS),
        "rms_log_residual": rms_log_residual,
    }
    write_json(path, content)
    return content


def read_spectrum(path: str | Path) -> TwoS2P1D:
    """Read a 2S2P1D law."""
    return TwoS2P1D(**_fields(path, "2s2p1d", _SPECTRUM_KEYS))


def _renamed(values: dict[str, float], keys: dict[str, str]) -> dict[str, float]:
    return {keys[name]: float(value) for name, value in values.items()}


def _fields(path: str | Path, law: str, keys: dict[str, str]) -> dict[str, float]:
    content = read_json(path)
    found = content.get("law") if isinstance(content, dict) else None
    if found != law:
        raise InputError(f"{path}: holds law {found!r}, not {law!r}; give the right law file.")
    values = {}
    for name, key in keys.items():
        value = content.get(key)
        if not isinstance(value, int | float) or isinstance(value, bool):
            raise InputError(
                f"{path}: key {key!r} is missing or not a number; delete the file and make it again."
            )
        values[name] = float(value)
    return values
