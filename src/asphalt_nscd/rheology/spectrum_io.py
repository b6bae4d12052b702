"""Law files of all temperatures: a continuous law with its origin and its standard errors, as JSON."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Any

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.store import write_json
from asphalt_nscd.rheology.laws_io import content_of, numbers_of, renamed
from asphalt_nscd.rheology.shift import SHIFTS
from asphalt_nscd.rheology.spectrum import LAWS, Spectrum, parameter_names, parameters

_KEYS = {
    "static_modulus": "E_static_Pa",
    "glassy_modulus": "E_glassy_Pa",
    "k": "k",
    "h": "h",
    "delta": "delta",
    "tau": "tau_s",
    "beta": "beta",
    "c1": "wlf_C1",
    "c2": "wlf_C2_K",
    "activation_energy": "activation_energy_J_mol",
}
_REFERENCE = {"reference_temperature": "reference_temperature_C"}


def spectrum_content(
    law: Spectrum,
    *,
    source: str,
    rms_log_residual: float,
    std_error: dict[str, float] | None = None,
    unseen: Iterable[str] = (),
    from_prior: Iterable[str] | None = None,
) -> dict[str, Any]:
    """A continuous law, which holds for all temperatures, as its file has it.

    unseen: parameters that the tests do not determine; from_prior: those of them that have the value of a prior,
    None where none was used. See `fitting.Fit`.
    """
    content = {
        "law": next(name for name, kind in LAWS.items() if type(law) is kind),
        "shift": next(name for name, kind in SHIFTS.items() if type(law.shift) is kind),
        "source": source,
        **renamed(parameters(law), _KEYS),
        **renamed({"reference_temperature": law.shift.reference_temperature}, _REFERENCE),
        "std_error": None if std_error is None else renamed(std_error, _KEYS),
        "unseen": [_KEYS[name] for name in unseen],
        "rms_log_residual": rms_log_residual,
    }
    if from_prior is not None:
        content["from_prior"] = [_KEYS[name] for name in from_prior]
    return content


def write_spectrum(path: str | Path, law: Spectrum, **said: Any) -> dict[str, Any]:
    """Write a continuous law; said: as in `spectrum_content`."""
    content = spectrum_content(law, **said)
    write_json(path, content)
    return content


def read_spectrum(path: str | Path) -> Spectrum:
    """Read a continuous law."""
    return spectrum_of(path, content_of(path, list(LAWS)))


def spectrum_of(path: str | Path, content: dict[str, Any]) -> Spectrum:
    """The law in the content of a file."""
    if content.get("shift") not in SHIFTS:
        raise InputError(
            f"{path}: key 'shift' is {content.get('shift')!r}; give one of {', '.join(SHIFTS)} "
            "or delete the file and make it again."
        )
    kind, shift = LAWS[content["law"]], SHIFTS[content["shift"]]
    values = numbers_of(path, content, _keys_of(kind))
    if (
        not 0.0 < values["k"] <= values["h"] < 1.0
        or not 0.0 <= values["static_modulus"] < values["glassy_modulus"]
    ):
        raise InputError(
            f"{path}: needs 0 < k <= h < 1 and 0 <= E_static_Pa < E_glassy_Pa; correct it or make it again."
        )
    return kind(**values, shift=shift(**numbers_of(path, content, _keys_of(shift) | _REFERENCE)))


def _keys_of(kind: type) -> dict[str, str]:
    return {name: _KEYS[name] for name in parameter_names(kind)}
