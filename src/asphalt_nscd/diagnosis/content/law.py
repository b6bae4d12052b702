"""The law of the mix in diagnosis.json."""

from __future__ import annotations

from typing import TypedDict

from asphalt_nscd.diagnosis.content.numbers import NotNegative, Some


class LawMisses(TypedDict):
    """Errors of law.json with the named causes, as in Table 4, over the tests it is fitted to; absent without
    law.json.

    mre_E_percent: Of the modulus.
    mre_phase_percent: Of the phase.
    off_phase_deg: Of the phase in degrees.
    """

    mre_E_percent: NotNegative
    mre_phase_percent: NotNegative
    off_phase_deg: NotNegative


class LawFitted(TypedDict):
    """Law fitted.

    law: As --law names it.
    title: As a reader knows it.
    parameters: Number of parameters, those of the shift among them.
    mre_E_percent: Of the modulus.
    mre_phase_percent: Of the phase.
    off_phase_deg: Of the phase in degrees.
    taken: Whether it is the one in law.json.
    """

    law: str
    title: str
    parameters: Some
    mre_E_percent: NotNegative
    mre_phase_percent: NotNegative
    off_phase_deg: NotNegative
    taken: bool


class LawParameter(TypedDict):
    """Law parameter.

    value: In the unit at the end of the name.
    interval_95: Null where the tests and the fit give none.
    determined: Whether the tests determine it.
    """

    value: float
    interval_95: list[float] | None
    determined: bool
