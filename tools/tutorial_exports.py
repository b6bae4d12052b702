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
ARTEFACT = "B", 4, 25.0  # specimen, degC, Hz: one gauge slips in this test alone
ARTEFACT_PHASE, ARTEFACT_UNIFORMITY = np.radians(5.0), 6.4  # rad; deg, of which the standard allows 3
QUALITY = {  # bounds, and how it is written
    " Average micro-strain": ((92, 108), ".0f"),
    " Load drift (%)": ((-1, 1), ".1f"),
    " Load standard error (%)": ((0.4, 4), ".1f"),
    " Average deformation drift (%)": ((-60, -10), ".1f"),
    " Average deformation standard error (%)": ((1.5, 6), ".1f"),
    " Deformation uniformity (%)": ((8, 24), ".1f"),
}

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
    modulus = SPECIMENS[specimen] * MIX.complex_modulus(omega, measured)
    norm = np.abs(modulus) * np.exp(SCATTER * random.standard_normal(count))
    phase = np.angle(modulus) + PHASE_SCATTER * random.standard_normal(count) + omega * DELAY
    uniformity = random.uniform(0.4, 1.6, count)
    if (specimen, temperature) == ARTEFACT[:2]:
        hit = FREQUENCIES.index(ARTEFACT[2])
        phase[hit] += ARTEFACT_PHASE
        uniformity[hit] = ARTEFACT_UNIFORMITY
    rows = {
        " Dynamic modulus (MPa)": [f"{value:{'.0f' if value > 1e3 else '.4g'}}" for value in norm * 1e-6],
        " Phase angle (Degrees)": [f"{value:.2f}" for value in np.degrees(phase)],
        " Average temperature  (°C)": [f"{value:.1f}" for value in measured],
        " Average confining pressure  (kPa)": ["0.0"] * count,
    }
    for label, (ends, form) in QUALITY.items():
        rows[label] = [f"{value:{form}}" for value in random.uniform(*ends, count)]
    rows[" Phase uniformity (Degrees)"] = [f"{value:.1f}" for value in uniformity]
    frequencies = ",".join(f"{value:g} Hz" for value in FREQUENCIES)
    head = HEAD.format(temperature=temperature, specimen=specimen, frequencies=frequencies)
    lines = [",".join([label, *values]) for label, values in rows.items()]
    return head + "\n".join(lines) + "\n\n"


if __name__ == "__main__":
    FOLDER.mkdir(parents=True, exist_ok=True)
    for name, content in pages().items():
        (FOLDER / name).write_bytes(content)
