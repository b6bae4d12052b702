"""Measurements of which we have no numbers, reconstructed from Table 3.

The paper plots them, and prints no F0, z0, Psi. What it prints, one Burgers law for each temperature, was fitted to
them. Here one smooth law (2S2P1D with a WLF shift) is fitted to the points these Burgers laws
imply, specimens are drawn around it, and Eqs. (1)-(5) are inverted. Table 4 is not used, so the
distance between these data and the Burgers laws is a prediction of it. The rows say
`origin=reconstructed`, and so must whatever is made of them.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from asphalt_nscd.files.store import write_table
from asphalt_nscd.measurements import twopoint
from asphalt_nscd.measurements.geometry import read_geometry
from asphalt_nscd.rheology.fitting import Fit
from asphalt_nscd.rheology.published_laws import read_published
from asphalt_nscd.rheology.sampling import FREQUENCIES, Sampling
from asphalt_nscd.rheology.spectrum import Spectrum
from asphalt_nscd.rheology.spectrum_fitting import fit_spectrum
from asphalt_nscd.rheology.spectrum_io import write_spectrum

REFERENCE_TEMPERATURE = 15.0  # degC; any choice gives the same law


def reconstruct_table(
    table3: str | Path,
    geometry: str | Path | Mapping[str, Any],
    output: str | Path,
    sampling: Sampling,
    law_output: str | Path | None = None,
) -> pd.DataFrame:
    """Draw peaks (F0, z0, Psi) of specimens "1".."N" at all temperatures of Table 3, and write them as CSV.

    Eqs. (1)-(5) are inverted for `geometry`; `law_output` is where to write the smooth law, if at all. Returns a row
    for each specimen, temperature and frequency.
    """
    names = [str(number + 1) for number in range(sampling.specimens)]
    geometries = read_geometry(geometry, names)
    temperatures, fit = fit_published(table3)
    if law_output is not None:
        write_spectrum(
            law_output,
            fit.law,
            source="reconstructed",
            rms_log_residual=fit.rms_log_residual,
            std_error=fit.std_error,
            unseen=fit.unseen,
        )

    temperature, frequency = (
        grid.ravel() for grid in np.meshgrid(temperatures, sampling.frequencies, indexing="ij")
    )
    modulus = fit.law.complex_modulus(2.0 * np.pi * frequency, temperature)
    parts = []
    for number, name in enumerate(names):
        # A stream of its own for each specimen: specimen 2 is the same among two or among ten.
        random = np.random.default_rng([sampling.seed, number])
        scale = sampling.specimen_scatter * random.standard_normal()
        log_norm = scale + sampling.modulus_scatter * random.standard_normal(modulus.size)
        phase = np.radians(sampling.phase_scatter_deg) * random.standard_normal(modulus.size)
        drawn = modulus * np.exp(log_norm + 1j * phase)
        force, psi = twopoint.head_response(geometries[name], frequency, drawn, sampling.amplitude)
        parts.append(
            pd.DataFrame(
                {
                    "specimen": name,
                    "temperature_C": temperature,
                    "frequency_Hz": frequency,
                    "F0_N": force,
                    "z0_m": sampling.amplitude,
                    "psi_deg": np.degrees(psi),
                    "origin": "reconstructed",
                }
            )
        )
    frame = pd.concat(parts, ignore_index=True)
    write_table(output, frame)
    return frame


def fit_published(table3: str | Path) -> tuple[np.ndarray, Fit[Spectrum]]:
    """Temperatures (t,) [degC] of Table 3, read in kPa, and the smooth 2S2P1D law of its isotherms.

    Isotherms are taken at the paper's frequencies, those at which the laws were fitted; the shift is WLF.
    """
    temperatures, laws = read_published(table3)
    # At no others: between and beyond them a Burgers law has bumps that its data had not.
    omega = 2.0 * np.pi * np.array(FREQUENCIES)
    modulus = np.concatenate([law.complex_modulus(omega) for law in laws])
    fit = fit_spectrum(
        np.tile(omega, temperatures.size), np.repeat(temperatures, omega.size), modulus, REFERENCE_TEMPERATURE
    )
    return temperatures, fit
