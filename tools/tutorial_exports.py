"""Write data/tutorial/exports, synthetic exports in the layout of an AMPT: python tools/tutorial_exports.py"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from asphalt_nscd.rheology.parabolic import TwoS2P1D
from asphalt_nscd.rheology.shift import WLF

FOLDER = Path(__file__).resolve().parents[1] / "data/tutorial/exports"
# A usual mix for binder courses, at 20 degC.
MIX = TwoS2P1D(40e6, 32e9, k=0.21, h=0.6, delta=2.3, tau=0.03, beta=300.0, shift=WLF(22.0, 155.0, 20.0))
TEMPERATURES = (4, 20, 35, 50)  # degC
FREQUENCIES = (25.0, 10.0, 5.0, 1.0, 0.5, 0.1)  # Hz
SPECIMENS = {"A": 1.03, "B": 0.97, "C": 1.01}  # stiffness over that of the mix
SCATTER = 0.01  # of |E*|, relative
PHASE_SCATTER = np.radians(0.2)
SEED = 11
# Two faults, which the diagnosis is to find.
DELAY = 0.8e-3  # s, by which the deformation is recorded late in every test
ARTEFACT = {"specimen": "B", "temperature": 4, "frequency": 25.0}  # one gauge slips in this test alone
ARTEFACT_PHASE, ARTEFACT_UNIFORMITY = np.radians(5.0), 6.4  # rad; deg, of which the standard allows 3

HEAD = """\
Test Information
****************
Project name,Synthetic tutorial
Operator name,nn
Target test temperature,{temperature}
Target confining stress,0
Average dynamic strain range from 75 to 125 micro-strain
Axial gauge length,70
Comments,Synthetic: no mix was tested. Drawn about a 2S2P1D law by tools/tutorial_exports.py with two faults in it
 Specimen information
********************
Identification,Mix-{specimen}-{temperature}C (SYNTHETIC)

Properties/Comments
*********
Test results summary
,{frequencies}
"""


def pages() -> dict[str, bytes]:
    """Content of every file by its name."""
    random = np.random.default_rng(SEED)
    return {
        f"Mix-{specimen}-{temperature}C_Sum.csv": _page(random, specimen, temperature).encode("latin-1")
        for specimen in SPECIMENS
        for temperature in TEMPERATURES
    }


def _page(random: np.random.Generator, specimen: str, temperature: int) -> str:
    count = len(FREQUENCIES)
    measured = temperature + np.round(random.normal(0.0, 0.08, count), 1)
    omega = 2.0 * np.pi * np.array(FREQUENCIES)
    modulus = SPECIMENS[specimen] * np.array(
        [MIX.complex_modulus(one, at) for one, at in zip(omega, measured, strict=True)], complex
    ).reshape(count)
    norm = np.abs(modulus) * np.exp(SCATTER * random.standard_normal(count))
    phase = np.angle(modulus) + PHASE_SCATTER * random.standard_normal(count) + omega * DELAY
    uniformity = random.uniform(0.4, 1.6, count)
    hit = (
        (np.array(FREQUENCIES) == ARTEFACT["frequency"])
        & (temperature == ARTEFACT["temperature"])
        & (specimen == ARTEFACT["specimen"])
    )
    phase = np.where(hit, phase + ARTEFACT_PHASE, phase)
    uniformity = np.where(hit, ARTEFACT_UNIFORMITY, uniformity)
    rows = {
        " Dynamic modulus (MPa)": [
            f"{value * 1e-6:.0f}" if value > 1e9 else f"{value * 1e-6:.4g}" for value in norm
        ],
        " Phase angle (Degrees)": [f"{np.degrees(value):.2f}" for value in phase],
        " Average temperature  (°C)": [f"{value:.1f}" for value in measured],
        " Average confining pressure  (kPa)": ["0.0"] * count,
        " Average micro-strain": [f"{value:.0f}" for value in random.uniform(92, 108, count)],
        " Load drift (%)": [f"{value:.1f}" for value in random.uniform(-1, 1, count)],
        " Load standard error (%)": [f"{value:.1f}" for value in random.uniform(0.4, 4, count)],
        " Average deformation drift (%)": [f"{value:.1f}" for value in random.uniform(-60, -10, count)],
        " Average deformation standard error (%)": [
            f"{value:.1f}" for value in random.uniform(1.5, 6, count)
        ],
        " Deformation uniformity (%)": [f"{value:.1f}" for value in random.uniform(8, 24, count)],
        " Phase uniformity (Degrees)": [f"{value:.1f}" for value in uniformity],
    }
    frequencies = ",".join(f"{value:g} Hz" for value in FREQUENCIES)
    head = HEAD.format(temperature=temperature, specimen=specimen, frequencies=frequencies)
    lines = [",".join([label, *values]) for label, values in rows.items()]
    return head + "\n".join(lines) + "\n\n"


if __name__ == "__main__":
    FOLDER.mkdir(parents=True, exist_ok=True)
    for name, content in pages().items():
        (FOLDER / name).write_bytes(content)
