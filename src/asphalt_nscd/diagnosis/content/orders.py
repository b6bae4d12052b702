"""What diagnosis.json says to test next."""

from __future__ import annotations

from typing import TypedDict

from asphalt_nscd.diagnosis.content.numbers import NotNegative, Positive


class Order(TypedDict):
    """Order.

    text: The order with its hours, a sentence.
    act: What to do, a clause.
    purpose: What it is for, a few words; empty where the order says it.
    why: What it would tell, sentences.
    hours: Hours of the machine; zero where a word is enough.
    nats: Expected gain, ln of the Bayes factor for the right answers.
    specimens: Specimens to test.
    temperature_C: Temperature, degrees Celsius; null for a metal reference and for an order at several temperatures.
    frequencies_Hz: Frequencies, Hz.
    half_strain: Whether at half of the usual strain.
    """

    text: str
    act: str
    purpose: str
    why: list[str]
    hours: NotNegative
    nats: NotNegative
    specimens: list[str]
    temperature_C: float | None
    frequencies_Hz: list[Positive]
    half_strain: bool


class Instructions(TypedDict):
    """What to test next: doubtful tests first, then by expected gain per hour.

    costs: What was counted as the cost of a test, a sentence.
    orders: At most five.
    """

    costs: str
    orders: list[Order]
