"""The recipe and packings of the tests of the forecast."""

from forecasting.conftest import content, networks, packing, recipe  # noqa: F401
