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
    """Write the Kelvin chain of a continuous law at temperature [degC], its moduli times factor.

    It follows the law within `tolerance`, |ln(E_chain / E)|, from lowest_hz to highest_hz [Hz].
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
    """The chain of a law called `name`, as its file has it; band: lowest and highest frequency [Hz]."""
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
        chain.scaled(factor),
        source=name,
        temperature=temperature,
        error=error,
        lowest_hz=lowest_hz,
        highest_hz=highest_hz,
    )
