"""Write data/tutorial/campaign.csv, synthetic moduli as a laboratory might save them: python tools/tutorial_data.py"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from asphalt_nscd.rheology.parabolic import TwoS2P1D
from asphalt_nscd.rheology.shift import WLF

PATH = Path(__file__).resolve().parents[1] / "data/tutorial/campaign.csv"
# A usual mix for surface courses, at 15 degC.
MIX = TwoS2P1D(30e6, 36e9, k=0.2, h=0.58, delta=2.2, tau=0.06, beta=250.0, shift=WLF(24.0, 160.0, 15.0))
TEMPERATURES = (0, 10, 20, 30)  # degC
FREQUENCIES = (1, 3, 10, 30)  # Hz
SPECIMENS = {"A": 1.02, "B": 0.97, "C": 1.01}  # stiffness over that of the mix
SCATTER = 0.01  # of |E*|, relative
PHASE_SCATTER = np.radians(0.2)
DELAY = 0.5e-3  # s, by which the displacement is recorded late; the diagnosis is to find it
SEED = 5

HEAD = """\
# Synthetic: no mix was measured. Drawn about a 2S2P1D law by tools/tutorial_data.py, with a displacement channel
# that is 0.5 ms late.
Sample;origin;Temp °C;f (Hz);|E*| [GPa];delta_rad;Operator
"""


def page() -> str:
    """The whole file."""
    random = np.random.default_rng(SEED)
    lines = []
    for specimen, scale in SPECIMENS.items():
        for temperature in TEMPERATURES:
            for frequency in FREQUENCIES:
                omega = 2.0 * np.pi * frequency
                modulus = scale * complex(MIX.complex_modulus(omega, temperature))
                norm = abs(modulus) * np.exp(SCATTER * random.standard_normal())
                phase = np.angle(modulus) + PHASE_SCATTER * random.standard_normal() + omega * DELAY
                line = f"{specimen};synthetic;{temperature:g};{frequency:g};{norm * 1e-9:.3f};{phase:.4f};nn"
                lines.append(line.replace(".", ","))
    return HEAD + "\n".join(lines) + "\n"


if __name__ == "__main__":
    PATH.parent.mkdir(parents=True, exist_ok=True)
    PATH.write_text(page(), encoding="utf-8")
