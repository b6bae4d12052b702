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

# Keys of parameters with a unit; others have the name of the parameter.
_KEYS = {
    "static_modulus": "E_static_Pa",
    "glassy_modulus": "E_glassy_Pa",
    "tau": "tau_s",
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
    keys = _keys_of(type(law)) | _keys_of(type(law.shift))
    content = {
        "law": next(name for name, kind in LAWS.items() if type(law) is kind),
        "shift": next(name for name, kind in SHIFTS.items() if type(law.shift) is kind),
        "source": source,
        **renamed(parameters(law), keys),
        **renamed({"reference_temperature": law.shift.reference_temperature}, _REFERENCE),
        "std_error": None if std_error is None else renamed(std_error, keys),
        "unseen": [keys[name] for name in unseen],
        "rms_log_residual": rms_log_residual,
    }
    if from_prior is not None:
        content["from_prior"] = [keys[name] for name in from_prior]
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
            "or make the file again."
        )
    kind, shift = LAWS[content["law"]], SHIFTS[content["shift"]]
    values = numbers_of(path, content, _keys_of(kind))
    refusal = kind.refusal(values)
    if refusal:
        raise InputError(f"{path}: {refusal}; correct it or make it again.")
    of_shift = _keys_of(shift)
    shifted = numbers_of(path, content, of_shift | _REFERENCE)
    for name, key in of_shift.items():
        if shifted[name] <= 0.0:
            raise InputError(
                f"{path}: {key} = {shifted[name]:g}; give one above zero, with which a warmer mix is softer."
            )
    return kind(**values, shift=shift(**shifted))


def _keys_of(kind: type) -> dict[str, str]:
    return {name: _KEYS.get(name, name) for name in parameter_names(kind)}
