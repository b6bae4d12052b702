"""What diagnosis.json says would have been found."""

from __future__ import annotations

from typing import Literal, NotRequired, TypedDict

from asphalt_nscd.diagnosis.content.numbers import Count, Positive, Probability, Some


class Limit(TypedDict):
    """Limit.

    value: The limit, the least of all places.
    unit: Its unit.
    confined_to: What such a cause is confined to, one specimen or one temperature.
    places: Limits by specimen or temperature, for a cause confined to one.
    """

    value: Positive
    unit: str
    confined_to: NotRequired[Literal["specimen", "temperature_C"]]
    places: NotRequired[dict[str, Positive]]


class PlaceLimit(TypedDict):
    """Place limit.

    specimen: Specimen; null for one isotherm of all.
    temperature_C: Isotherm, degrees Celsius; null for a channel.
    value: In the unit.
    """

    specimen: str | None
    temperature_C: float | None
    value: Positive


class LimitOfPlace(TypedDict):
    """Limit of place.

    value: The limit, the least of all places.
    unit: Its unit.
    places: The limit at each place.
    """

    value: Positive
    unit: str
    places: list[PlaceLimit]


class TriedAt(TypedDict):
    """Tried at.

    tried: Places and signs tried.
    named: How often the cause was named where it was put in.
    within_interval: How often its size lay within the 95 % interval.
    other_named: How often another cause was named that was not there before.
    stated_power: Chance to find it as stated.
    """

    tried: Some
    named: Count
    within_interval: Count
    other_named: Count
    stated_power: Probability
