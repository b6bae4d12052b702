"""Law files of one temperature: a law that bonds can follow, with its origin, as JSON.

A new one that is no chain is read by `read_bond_law` and `bond_law_of`, exported by `ONE_TEMPERATURE` of
`exports/law.py`, and made into bonds by `bond_law` of `bending/bending_test.py`.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.store import read_json, write_json
from asphalt_nscd.rheology.burgers import Burgers
from asphalt_nscd.rheology.chain import KelvinChain

SAME_TEMPERATURE = 1e-6  # K
IN_BAND = 1e-9  # of a frequency: rounding
_BURGERS_KEYS = {
    "modulus_m": "Em_Pa",
    "viscosity_m": "eta_m_Pa_s",
    "modulus_k": "Ek_Pa",
    "viscosity_k": "eta_k_Pa_s",
}
_CHAIN_KEYS = {"spring": "E_Pa", "dashpot": "eta_Pa_s"}
_ELEMENT_KEYS = {"kelvin_springs": "Ek_Pa", "kelvin_dashpots": "eta_k_Pa_s"}


def law_content(
    law: Burgers,
    *,
    source: str,
    temperature: float,
    std_error: dict[str, float] | None = None,
    rms_log_residual: float | None = None,
) -> dict[str, Any]:
    """Content of the file of a Burgers law that holds at one temperature [degC].

    `source` is "published", "fitted" or "stated"; `std_error` is by field name, in the unit of each parameter.
    """
    return {
        "law": "burgers",
        "source": source,
        "temperature_C": float(temperature),
        **renamed(asdict(law), _BURGERS_KEYS),
        "std_error": None if std_error is None else renamed(std_error, _BURGERS_KEYS),
        "rms_log_residual": rms_log_residual,
    }


def write_law(path: str | Path, law: Burgers, **said: Any) -> dict[str, Any]:
    """Write the Burgers law of one temperature as JSON, `said` as in `law_content`, and return the content."""
    content = law_content(law, **said)
    write_json(path, content)
    return content


def read_law(path: str | Path) -> Burgers:
    """Read a Burgers law from JSON; raises InputError where the file holds another law."""
    return _burgers_of(path, content_of(path, ["burgers"]))


def _burgers_of(path: str | Path, content: dict[str, Any]) -> Burgers:
    return _built(path, Burgers, numbers_of(path, content, _BURGERS_KEYS))


def chain_content(
    chain: KelvinChain,
    *,
    source: str,
    temperature: float,
    error: float,
    lowest_hz: float,
    highest_hz: float,
) -> dict[str, Any]:
    """Content of the file of a Kelvin chain that stands for the law `source` at one temperature [degC].

    `error` is its largest |ln(E_chain / E)| between `lowest_hz` and `highest_hz`, the band for which it holds.
    """
    return {
        "law": "kelvin_chain",
        "source": source,
        "temperature_C": float(temperature),
        **{key: _null_if_infinite(getattr(chain, name)) for name, key in _CHAIN_KEYS.items()},
        **{key: list(getattr(chain, name)) for name, key in _ELEMENT_KEYS.items()},
        "largest_log_error": float(error),
        "lowest_Hz": float(lowest_hz),
        "highest_Hz": float(highest_hz),
    }


def write_chain(path: str | Path, chain: KelvinChain, **said: Any) -> dict[str, Any]:
    """Write a Kelvin chain as JSON, `said` as in `chain_content`, and return the content."""
    content = chain_content(chain, **said)
    write_json(path, content)
    return content


def read_bond_law(
    path: str | Path, temperature: float | None = None, frequencies: Sequence[float] = ()
) -> Burgers | KelvinChain:
    """Read a law that bonds can follow, a Burgers law or a Kelvin chain.

    It must hold for tests at `temperature` [degC] (None for any) and `frequencies` [Hz]; else it is refused.
    """
    content = content_of(path, ["burgers", "kelvin_chain"])
    require_holds(path, content, temperature, frequencies)
    return bond_law_of(path, content)


def require_holds(
    path: str | Path, content: dict[str, Any], temperature: float | None, frequencies: Sequence[float]
) -> None:
    """Refuse a law of one temperature at another [degC] (None for any), and a Kelvin chain beyond its band [Hz]."""
    own = numbers_of(path, content, {"temperature": "temperature_C"})["temperature"]
    if temperature is not None and not abs(temperature - own) <= SAME_TEMPERATURE:  # NaN is no temperature
        raise InputError(
            f"{path}: holds at {own:g} degC only, not at {temperature:g}; ask for {own:g} degC, or give a law of all "
            "temperatures."
        )
    if content["law"] != "kelvin_chain" or not frequencies:
        return
    band = numbers_of(path, content, {"low": "lowest_Hz", "high": "highest_Hz"})
    low, high = min(frequencies), max(frequencies)
    if low < band["low"] * (1.0 - IN_BAND) or high > band["high"] * (1.0 + IN_BAND):
        beyond = high if high > band["high"] else low
        raise InputError(
            f"{path}: a Kelvin chain for {band['low']:g} to {band['high']:g} Hz, which says nothing at {beyond:g} Hz; "
            "make one for that frequency by asphalt-nscd chain-law, or stay in its band."
        )


def bond_law_of(path: str | Path, content: dict[str, Any]) -> Burgers | KelvinChain:
    """The law that bonds can follow in the content of a file; `path` is for a message."""
    if content["law"] == "burgers":
        return _burgers_of(path, content)
    absent = {name for name, key in _CHAIN_KEYS.items() if key in content and content[key] is None}
    present = {name: key for name, key in _CHAIN_KEYS.items() if name not in absent}
    values: dict[str, Any] = {**numbers_of(path, content, present), **dict.fromkeys(absent, math.inf)}
    for name, key in _ELEMENT_KEYS.items():
        elements = content.get(key)
        if not isinstance(elements, list) or not all(_is_number(value) for value in elements):
            raise InputError(
                f"{path}: key {key!r} is missing or no list of numbers; correct it, or make the file again."
            )
        values[name] = tuple(float(value) for value in elements)
    return _built(path, KelvinChain, values)


def renamed(values: dict[str, float], keys: dict[str, str]) -> dict[str, float]:
    """Values by field name, put under the keys of a file."""
    return {keys[name]: float(value) for name, value in values.items()}


def _null_if_infinite(value: float) -> float | None:
    # JSON has no infinity: an absent part is null.
    return None if math.isinf(value) else value


def _is_number(value: Any) -> bool:
    """Whether it is finite and one that a float can hold; JSON knows whole numbers without end."""
    # True is an int in Python.
    if isinstance(value, bool) or not isinstance(value, int | float):
        return False
    return abs(value) <= sys.float_info.max


def content_of(path: str | Path, laws: list[str]) -> dict[str, Any]:
    """Read a law file, refused where it holds none of `laws`."""
    content = read_json(path)
    found = content.get("law") if isinstance(content, dict) else None
    if found is None:
        raise InputError(f"{path}: no law file, for it has no key 'law'; give the right file.")
    if found not in laws:
        wanted = " or ".join(repr(law) for law in laws)
        mend = " or make the chain of this one by asphalt-nscd chain-law" if "kelvin_chain" in laws else ""
        raise InputError(f"{path}: holds law {found!r}, not {wanted}; give the right law file{mend}.")
    return content


def numbers_of(path: str | Path, content: dict[str, Any], keys: dict[str, str]) -> dict[str, float]:
    """Numbers of a law file by field name; `keys` gives the file's key of each field, `path` is for a message."""
    for key in keys.values():
        if not _is_number(content.get(key)):
            raise InputError(
                f"{path}: key {key!r} is missing or not a number; correct it, or make the file again."
            )
    return {name: float(content[key]) for name, key in keys.items()}


def _built(path: str | Path, kind: type, values: dict[str, Any]) -> Any:
    try:
        return kind(**values)
    except InputError as error:
        raise InputError(f"{path}: {error}") from None
