"""What a laboratory reports of blind tables: E* at 15 degC and 10 Hz in its interval, corrected tests diagnosed again.

The modulus is that of the drawn mix. A secondary process belongs to the mix, so that no table holds one.
"""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from asphalt_nscd.diagnosis.observed.reading import read_observations
from asphalt_nscd.diagnosis.record.reported import EN_12697_26, corrected, mix_modulus
from asphalt_nscd.diagnosis.search.diagnose import Diagnosis, diagnose
from asphalt_nscd.measurements.campaign import Campaign
from asphalt_nscd.table_import.campaign import read_campaign

from . import generator, score
from .causes import CATALOGUE
from .design import factorial
from .generator import Hidden
from .laws import SHAPES, Law
from .plan import AT_LIMIT, NEEDS
from .strength import Scatter

HIDDEN = tuple(cause for cause in CATALOGUE if cause not in (*NEEDS, "secondary_process"))
RATIOS = (0.5, 1.0, 2.0, 3.0)  # of the hidden effect, times what shows at its limit
SPECIMENS = ("AB", "ABC", "ABCD")
BETWEEN = (0.015, 0.03, 0.045)  # standard deviations of ln|E*| between specimens
DRAWS = 500


def run(number: int, seed: int) -> Iterator[dict[str, Any]]:
    """One row for each of `number` tables; every other one holds one effect."""
    for n in range(number):
        random = np.random.default_rng([seed, n])
        hidden = []
        if n % 2:
            cause = HIDDEN[n // 2 % len(HIDDEN)]
            hidden = [Hidden(cause, visible_strength=float(random.choice(RATIOS)) * AT_LIMIT)]
        case = generator.draw(
            int(random.integers(2**31)),
            hidden,
            design=factorial(specimens=SPECIMENS[n % len(SPECIMENS)]),
            law=list(SHAPES)[n % len(SHAPES)],
            scatter=Scatter(specimen=float(random.choice(BETWEEN))),
            form="moduli",
        )
        with tempfile.TemporaryDirectory() as folder:
            yield {"table": n, "hidden": hidden[0].cause if hidden else ""} | _row(case, Path(folder))


def _row(case: generator.Case, folder: Path) -> dict[str, Any]:
    case.table.to_csv(folder / "tests.csv", index=False)
    found = _diagnosed(folder / "tests.csv", case.geometry)
    named = _names(found)
    corrected(found).to_csv(folder / "corrected.csv", index=False)
    campaign, _ = read_campaign([folder / "corrected.csv"], test_type="bending")
    again = _names(_diagnosed(campaign, case.geometry))
    sealed = case.seal["law"]
    law = Law(sealed["shape"], sealed["parameters"], sealed["shift"], sealed["shift_parameters"])
    temperature, frequency = EN_12697_26
    true = complex(law.modulus(2.0 * np.pi * frequency, temperature))
    said = mix_modulus(found, np.array([temperature]), np.array([frequency])).table().iloc[0]
    return {
        "specimens": case.table["specimen"].nunique(),
        "named": "; ".join(named),
        "named_again": "; ".join(again),
        "new": not set(again) <= set(named),
        "E_error_percent": 100.0 * np.log(said["E_MPa"] * 1e6 / abs(true)),
        "E_covered": said["E_low_MPa"] <= abs(true) * 1e-6 <= said["E_high_MPa"],
        "phase_error_deg": said["phase_deg"] - np.degrees(np.angle(true)),
        "phase_covered": said["phase_low_deg"] <= np.degrees(np.angle(true)) <= said["phase_high_deg"],
    }


def _diagnosed(measurements: Path | Campaign, geometry: dict[str, float]) -> Diagnosis:
    return diagnose(read_observations(measurements, geometry)[0], draws=DRAWS)


def _names(found: Diagnosis) -> list[str]:
    return [rung.candidate.cause.name for rung in found.ladder.rungs]


def summary(rows: pd.DataFrame) -> pd.DataFrame:
    """Rates in percent with their 95 % intervals, as the summary of the campaign has them."""
    out = []
    for what, target, hits, met in (
        ("modulus of the mix at 15 degC, 10 Hz within its 95 % interval", "90 - 98 %", rows["E_covered"], (90.0, 98.0)),
        ("phase of the mix at 15 degC, 10 Hz within its 95 % interval", "90 - 98 %", rows["phase_covered"],
         (90.0, 98.0)),
        ("corrected tests diagnosed again: no new name", ">= 95 %", ~rows["new"], (95.0, 100.0)),
    ):  # fmt: skip
        low, high = score.clopper_pearson(int(hits.sum()), hits.size)
        percent = round(100.0 * float(hits.mean()), 1)
        out.append(
            {
                "what": what,
                "target": target,
                "percent": percent,
                "interval_percent": f"{100.0 * low:.1f} - {100.0 * high:.1f}",
                "of": hits.size,
                "met": "yes" if met[0] <= percent <= met[1] else "no",
            }
        )
    return pd.DataFrame(out)
