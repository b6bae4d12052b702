"""Numbers of diagnosis.json: counts, chances, estimates with their errors."""

from __future__ import annotations

from typing import Annotated, NotRequired, TypedDict

from msgspec import Meta

Count = Annotated[int, Meta(ge=0)]
Some = Annotated[int, Meta(ge=1)]
Positive = Annotated[float, Meta(gt=0)]
NotNegative = Annotated[float, Meta(ge=0)]
Probability = Annotated[float, Meta(ge=0, le=1)]
Interval = Annotated[list[float], Meta(min_length=2, max_length=2)]


class Estimate(TypedDict):
    """A value with its error.

    value: Value.
    std_error: Standard error; null where the fit does not give one.
    unit: Unit.
    interval_95: The 95 % interval as the page has it, widened where tests lie far from the fit; absent without a
        standard error.
    """

    value: float
    std_error: float | None
    unit: str
    interval_95: NotRequired[Interval]


class Variation(TypedDict):
    """Scatter of tests.

    E_percent: Coefficient of variation of |E*|, percent.
    phase_deg: Standard deviation of the phase, degrees.
    """

    E_percent: NotNegative
    phase_deg: NotNegative


class BeforeAfter(TypedDict):
    """A number before a rung and after it."""

    before: NotNegative
    after: NotNegative
