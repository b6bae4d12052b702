"""The recipe of the tests of the forecast."""

from forecasting.conftest import content, recipe  # noqa: F401
