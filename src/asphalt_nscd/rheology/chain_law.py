"""The law of the bonds at one temperature, taken from a law of all temperatures."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.store import write_json
from asphalt_nscd.rheology.conversion import kelvin_chain
from asphalt_nscd.rheology.laws_io import chain_content
from asphalt_nscd.rheology.spectrum import Spectrum
from asphalt_nscd.rheology.spectrum_io import read_spectrum


def chain_law(
    spectrum: str | Path,
    temperature: float,
    lowest_hz: float,
    highest_hz: float,
    tolerance: float,
    factor: float,
    output: str | Path,
) -> dict[str, Any]:
    """Write the Kelvin chain of a continuous law at one temperature [degC] as JSON, and return its content.

    The chain follows the law between `lowest_hz` and `highest_hz` within `tolerance`, the largest |ln(E_chain / E)|;
    then its moduli are multiplied by `factor`. Raises InputError where no chain of few enough elements does.
    """
    content = chain_at(
        read_spectrum(spectrum), str(spectrum), temperature, (lowest_hz, highest_hz), tolerance, factor
    )
    write_json(output, content)
    return content


def chain_at(
    law: Spectrum,
    name: str,
    temperature: float,
    band: tuple[float, float],
    tolerance: float,
    factor: float = 1.0,
) -> dict[str, Any]:
    """Content of the file of a law's Kelvin chain at one temperature [degC].

    `band` is the lowest and highest frequency [Hz], `tolerance` the largest |ln(E_chain / E)| in it; `factor`
    multiplies the moduli. Raises InputError where no chain of few enough elements meets the tolerance.
    """
    lowest_hz, highest_hz = band
    try:
        chain, error = kelvin_chain(
            lambda omega: law.complex_modulus(omega, temperature),
            2.0 * np.pi * lowest_hz,
            2.0 * np.pi * highest_hz,
            tolerance,
        )
    except InputError as refusal:
        raise InputError(f"{name} at {temperature:g} degC: {refusal}") from None
    return chain_content(
        # Scaled after the fit, whose error is relative: neither it nor a time changes.
        chain.scaled(factor),
        source=name,
        temperature=temperature,
        error=error,
        lowest_hz=lowest_hz,
        highest_hz=highest_hz,
    )
