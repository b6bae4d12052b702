"""Several campaigns of one machine, with a fault of the machine too small for one of them, and without any.

Five invented campaigns of one bench stand for a machine. The size of its offset is a share of the limit that one of
them states in the median. The share of machines where the offset gets its name is what pooling is worth.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import pandas as pd

from asphalt_nscd.api.tables import campaign_in
from asphalt_nscd.diagnosis.machine.pooled import Pooled, pool
from asphalt_nscd.diagnosis.observed.reading import PAPER_GEOMETRY, read_observations
from asphalt_nscd.diagnosis.search.diagnose import Diagnosis, diagnose

from .faults import Fault, put
from .laboratory import CYLINDER, Campaign, invented
from .measured import SHIPPED
from .rates import line

SEED = 20261125
CAMPAIGNS = 5
OF_LIMIT = 0.4  # size of the offset over the limit of one campaign
DRAWS = 1000


def campaigns(machine: int, seed: int = SEED) -> list[Campaign]:
    """Those of one machine: one bench, mixes and designs in turn."""
    first = 2 * CAMPAIGNS * machine + machine % 2  # benches alternate
    return [invented(first + 2 * k, seed) for k in range(CAMPAIGNS)]


def tried(machine: int, seed: int = SEED) -> list[dict[str, Any]]:
    """A row for the machine without a fault, and one with an offset in all of its campaigns."""
    each = campaigns(machine, seed)
    sound = [_diagnosed(one, ()) for one in each]
    limit = float(np.median([one.ladder.limits["phase_offset", None] for one in sound]))
    sign = 1.0 if machine % 4 < 2 else -1.0
    fault = Fault("phase_offset", sign * OF_LIMIT * limit)
    wrong = [_diagnosed(one, (fault,)) for one in each]
    return [
        _row(machine, each, 0.0, limit, _pooled(each, sound)),
        _row(machine, each, fault.size, limit, _pooled(each, wrong)),
    ]


def _diagnosed(campaign: Campaign, faults: Sequence[Fault]) -> Diagnosis:
    table = campaign_in(put(campaign, faults), measured_in=campaign.bench)
    return diagnose(read_observations(table, PAPER_GEOMETRY)[0], draws=DRAWS)


def _pooled(each: Sequence[Campaign], found: Sequence[Diagnosis]) -> Pooled:
    return pool(dict(zip([one.name for one in each], found, strict=True)), DRAWS)


def _row(machine: int, each: Sequence[Campaign], size: float, limit: float, found: Pooled) -> dict[str, Any]:
    named = [one for one in found.found if one.named]
    right = [one for one in named if one.cause.name == "phase_offset" and one.value * size > 0.0]
    by_group = [one for one in named if one not in right and "phase_offset" in one.as_good and size]
    return {
        "machine": machine, "bench": each[0].bench, "offset_deg": size, "limit_of_one_deg": limit,
        "limit_pooled_deg": found.limits.get("phase_offset"), "named": bool(right), "as_good": bool(by_group),
        "wrong_names": " ".join(one.cause.name for one in named if one not in right and one not in by_group),
        "nameless": " ".join(one.cause.name for one in found.found if not one.named),
        "told_deg": right[0].value if right else None,
        "covered": abs(right[0].value - size) <= 1.96 * right[0].std_error if right else None,
    }  # fmt: skip


def measured() -> pd.DataFrame:
    """What the nine NCAT campaigns are found to share: as a whole, by campaign, isotherm and frequency."""
    found = {}
    for path in sorted(SHIPPED.glob("*.csv")):
        if path.name != "volumetrics.csv":
            observed, _ = read_observations(campaign_in(path, measured_in=CYLINDER), PAPER_GEOMETRY)
            found[path.stem] = diagnose(observed, draws=DRAWS)
    return pool(found, DRAWS).table.round({"value": 4, "std_error": 4})


def summary(rows: pd.DataFrame) -> pd.DataFrame:
    """What is named of machines with an offset, and of machines without a fault."""
    wrong = rows["wrong_names"].fillna("") != ""
    put = rows["offset_deg"] != 0.0
    shifted = rows[put]
    return pd.DataFrame(
        [
            line(f"five campaigns, an offset of {OF_LIMIT:g} limits: named", ">= 90 %", shifted["named"], low=0.9),
            line("the same, or as one of those that fit as well", "reported", shifted["named"] | shifted["as_good"]),
            line("the same: within its 95 % interval", ">= 92 %", shifted["covered"], low=0.92),
            line("the same: another name", "<= 3 %", wrong[put], high=0.03),
            line("five campaigns without a fault: a name", "<= 1 %", wrong[~put], high=0.01),
        ]
    )  # fmt: skip
