"""A mix from its binder and recipe, before it is made."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pandas as pd

from asphalt_nscd.api.arguments import checked
from asphalt_nscd.api.laws import Law
from asphalt_nscd.api.pictures import shown_in_notebooks
from asphalt_nscd.forecasting import written
from asphalt_nscd.forecasting.forecast import Forecast as ForecastOfRecipe
from asphalt_nscd.forecasting.forecast import forecast as forecast_of
from asphalt_nscd.forecasting.recipe import read_recipe, recipe_of
from asphalt_nscd.table_import.shear import read_sweeps

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclass(frozen=True)
class Forecast:
    """|E*| and phase of a mix that follow from its recipe alone; nothing is fitted to the mix.

    Parameters
    ----------
    found : forecasting.forecast.Forecast
        What `forecast` computed.

    Examples
    --------
    >>> mix = forecast("data/forecast/recipe.yaml")  # doctest: +SKIP
    >>> mix.table, mix.law, mix.summary["largest"], mix.plot()  # doctest: +SKIP
    """

    found: ForecastOfRecipe

    @cached_property
    def table(self) -> pd.DataFrame:
        """The forecast at each temperature and frequency of the recipe.

        Returns
        -------
        DataFrame
            One row for each temperature [degC] and frequency [Hz]: |E*| [MPa], phase [degrees], low and high
            of both.
        """
        return written.points(self.found)

    @cached_property
    def rivals(self) -> pd.DataFrame:
        """The same points as regressions and a mean field forecast them.

        Returns
        -------
        DataFrame
            One row for each point: |E*| [MPa] and phase [degrees] of the forecast and of each rival.
        """
        return written.rival_points(self.found)

    @cached_property
    def law(self) -> Law:
        """The law of the mix.

        Returns
        -------
        Law
            2S2P1D where the binder's law has a shift, else a Kelvin chain at its temperature.
        """
        return Law(written.law_of_mix(self.found))

    @cached_property
    def summary(self) -> Mapping[str, Any]:
        """What the forecast rests on.

        Returns
        -------
        mapping
            Volumes, amplifications, and what each input moves.
        """
        return written.summary(self.found)

    def plot(self) -> Figure:
        """Draw |E*| and phase against reduced frequency, and the Black diagram, beside rivals.

        Returns
        -------
        Figure
            A Matplotlib figure.
        """
        from asphalt_nscd.reporting.figures.forecast_panels import curves

        return shown_in_notebooks(curves(self.found, self.table, self.rivals))

    def plot_parts(self) -> Figure:
        """Draw the grading, the volumes, and how much volumes, contacts and dry skeleton amplify the binder.

        Returns
        -------
        Figure
            A Matplotlib figure.
        """
        from asphalt_nscd.reporting.figures.forecast_panels import parts

        return shown_in_notebooks(parts(self.found))

    def write(self, folder: str | Path) -> list[str]:
        """Write the files of `asphalt-nscd forecast`, its page excepted.

        Parameters
        ----------
        folder : path
            Made where it does not exist.

        Returns
        -------
        list of str
            Names of the files.
        """
        return written.write(self.found, folder)

    def __repr__(self) -> str:
        sizes = self.table["E_MPa"]
        return f"Forecast({self.found.recipe.name}: {len(sizes)} points, {sizes.min():.0f} to {sizes.max():.0f} MPa)"


@checked
def forecast(recipe: str | Path | Mapping[str, Any]) -> Forecast:
    """Forecast |E*| and phase of a mix from its binder and recipe.

    Parameters
    ----------
    recipe : path or mapping
        A YAML file as data/forecast/recipe.yaml, or its content (docs/forecast.md).

    Returns
    -------
    Forecast
        |E*| and phase with their band, the law of the mix, and what rivals forecast.

    Raises
    ------
    InputError
        Names the key of a recipe that cannot be used.

    Examples
    --------
    >>> grading = {19: 100, 9.5: 85, 4.75: 60, 2.36: 42, 0.6: 20, 0.15: 8, 0.075: 5}
    >>> known = {"binder": {"grade": "PG 64-22"}, "binder_percent_by_mass": 5.2, "air_voids_percent": 7.0}
    >>> mix = forecast({**known, "grading": grading, "temperatures_C": [21.1], "frequencies_Hz": [10.0]})
    >>> mix.table[["E_MPa", "phase_deg"]].round(-1).iloc[0].tolist()
    [6740.0, 20.0]
    >>> forecast({"name": "a mix"})
    Traceback (most recent call last):
    asphalt_nscd.files.errors.InputError: recipe: key 'binder' is missing from the recipe; add it.
    """
    if isinstance(recipe, Mapping):
        return Forecast(forecast_of(recipe_of(recipe, read_table=read_sweeps)))
    return Forecast(forecast_of(read_recipe(recipe, read_sweeps)))
