"""The sensitivity study: one parameter of the bond law changed at a time."""

from pathlib import Path
from typing import Any

from asphalt_nscd.cli import run_script
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.store import read_json, write_json

PARAMETERS = {"Em": "Em_Pa", "eta_m": "eta_m_Pa_s", "Ek": "Ek_Pa", "eta_k": "eta_k_Pa_s"}
LEAST_FACTOR, LARGEST_FACTOR = 1e-6, 1e6


def scale_law(law: str | Path, parameter: str, factor: float, output: str | Path) -> dict[str, Any]:
    """Write a Burgers law with one parameter scaled; it says which, and drops what held for the fit.

    `parameter` is "Em", "eta_m", "Ek" or "eta_k".
    """
    if parameter not in PARAMETERS:
        raise InputError(f"the law has no parameter {parameter!r}; give one of {', '.join(PARAMETERS)}.")
    if not LEAST_FACTOR <= factor <= LARGEST_FACTOR:
        raise InputError(
            f"factor {factor:g} is out of range; give a number from {LEAST_FACTOR:g} to {LARGEST_FACTOR:g}."
        )
    content = read_json(law)
    key = PARAMETERS[parameter]
    if not isinstance(content, dict) or not isinstance(content.get(key), float):
        raise InputError(f"{law}: key {key!r} is missing or not a number; delete the file and make it again.")
    content.update({key: content[key] * factor, "std_error": None, "rms_log_residual": None})
    content["scaled"] = {"parameter": parameter, "factor": factor}
    write_json(output, content)
    return content


def run(job: Any) -> None:
    """From the files of the rule to its law."""
    scale_law(job.input.law, job.wildcards.parameter, float(job.wildcards.factor), job.output[0])


if __name__ == "__main__":
    run_script(globals()["snakemake"], run)
