"""Measurements in any form that people have them, as a campaign."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any, TypeAlias

import pandas as pd

from asphalt_nscd.diagnosis.observed.observations import Observations
from asphalt_nscd.diagnosis.observed.reading import PAPER_GEOMETRY, read_observations
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.measurements.campaign import Campaign
from asphalt_nscd.measurements.further_kinds import ALL_KINDS
from asphalt_nscd.table_import.campaign import read_campaign
from asphalt_nscd.table_import.frames import campaign_of

Measurements: TypeAlias = str | Path | pd.DataFrame | Campaign | list[str | Path] | tuple[str | Path, ...]


def campaign_in(
    measurements: Measurements,
    sheet: str | None = None,
    columns: Mapping[str, str] | None = None,
    measured_in: str | None = None,
    mix: str | None = None,
) -> Campaign:
    """Measurements in any form that people have them, as a campaign.

    Parameters
    ----------
    measurements : path, folder, several of them, DataFrame or Campaign
        What is read.
    sheet : str, optional
        Of a workbook; else every sheet that holds tests.
    columns : mapping of str to str, optional
        What a column holds where its name does not say it.
    measured_in : str, optional
        "bending", "tension-compression", "four-point bending" or "indirect tension"; else what the files say.
    mix : str, optional
        The only one to read of files with a column of mixes.

    Returns
    -------
    Campaign
        Tests in SI units, with notes on how they were read.

    Raises
    ------
    InputError
        For what holds no tests, or a test type that is not known.
    """
    if measured_in not in (None, *ALL_KINDS):
        raise InputError(
            f"measured_in {measured_in!r} is not known; give one of {', '.join(ALL_KINDS)}, or none for "
            "another test."
        )
    if isinstance(measurements, Campaign):
        return measurements if measured_in is None else replace(measurements, test_type=measured_in)
    if isinstance(measurements, pd.DataFrame):
        return campaign_of(measurements, columns, measured_in)
    several = measurements if isinstance(measurements, list | tuple) else [measurements]
    if not several or not all(isinstance(path, str | Path) for path in several):
        raise InputError(
            f"measurements: no table ({type(measurements).__name__}); give a file, a folder, several of "
            "them, or a DataFrame."
        )
    return read_campaign([Path(path) for path in several], sheet, columns, measured_in, mix)[0]


def observed_in(measurements: Any) -> tuple[Observations, str, str]:
    """The tests of measurements as arrays, taken at the geometry of the paper.

    Parameters
    ----------
    measurements : path, folder, several of them, or DataFrame
        What is read.

    Returns
    -------
    tuple (Observations, str, str)
        The tests, what a refusal calls their table, and their origin.

    Raises
    ------
    InputError
        For what holds no tests.
    """
    campaign = campaign_in(measurements)
    observed, origin = read_observations(campaign, PAPER_GEOMETRY)
    return observed, str(campaign.table.path), origin
