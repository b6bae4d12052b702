"""A mix from its binder and recipe, before it is made."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pandas as pd

from asphalt_nscd.api.arguments import checked
from asphalt_nscd.api.laws import Law
from asphalt_nscd.api.pictures import shown_in_notebooks
from asphalt_nscd.forecasting import written
from asphalt_nscd.forecasting.forecast import Forecast as ForecastOfLevels
from asphalt_nscd.forecasting.forecast import Networks, kept_in
from asphalt_nscd.forecasting.forecast import forecast as forecast_of
from asphalt_nscd.forecasting.recipe import read_recipe, recipe_of
from asphalt_nscd.nscd.core_cache import cache_base

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Progress = Callable[[str, float, float], None]


@dataclass(frozen=True)
class Forecast:
    """|E*| and phase of a mix that follow from its recipe alone; nothing is fitted to the mix.

    Parameters
    ----------
    found : forecasting.forecast.Forecast
        What `forecast` computed, level by level.

    Examples
    --------
    >>> mix = forecast("data/forecast/recipe.yaml")  # doctest: +SKIP
    >>> mix.table, mix.law, mix.summary["largest_doubt"], mix.plot()  # doctest: +SKIP
    """

    found: ForecastOfLevels

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
        """The same points as mean fields and regressions forecast them.

        Returns
        -------
        DataFrame
            One row for each point and rival.
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
            Levels, volume fractions, packings, amplifications, and what each doubt changes.
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

    def plot_levels(self) -> Figure:
        """Draw the grading, and a cut through the packing of each level.

        Returns
        -------
        Figure
            A Matplotlib figure.
        """
        from asphalt_nscd.reporting.figures.forecast_panels import levels

        return shown_in_notebooks(levels(self.found))

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
def forecast(
    recipe: str | Path | Mapping[str, Any],
    *,
    packings: str | Path | None = None,
    seeds: int = 2,
    progress: Progress = lambda stage, done, total: None,
) -> Forecast:
    """Forecast |E*| and phase of a mix from its binder and recipe.

    Parameters
    ----------
    recipe : path or mapping
        A YAML file as data/forecast/recipe.yaml, or its content (docs/forecast.md).
    packings : path, optional
        Folder of packings to use and to fill; else one in the user's cache.
    seeds : int
        Packings of each level, at least one; the forecast is their mean.
    progress : callable
        progress(stage, done, total), called as the work goes on.

    Returns
    -------
    Forecast
        |E*| and phase with their doubt, the law of the mix, and what rivals forecast.

    Raises
    ------
    InputError
        Names the key of a recipe that cannot be used.

    Examples
    --------
    >>> forecast({"name": "a mix"})
    Traceback (most recent call last):
    asphalt_nscd.files.errors.InputError: recipe: 'binder' is a required property; see data/forecast/recipe.yaml.
    """
    asked = recipe_of(recipe) if isinstance(recipe, Mapping) else read_recipe(recipe)
    # Kept for later forecasts: a packing depends on the grading alone.
    folder = Path(cache_base()) / "packings" if packings is None else Path(packings)
    networks = Networks(kept_in(folder, progress))
    return Forecast(forecast_of(asked, networks, seeds=tuple(range(1, seeds + 1)), progress=progress))
