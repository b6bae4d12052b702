"""The recipe of a mix: what a forecast knows of it, read and checked."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from importlib.resources import files
from pathlib import Path
from typing import Any

import numpy as np
import yaml
from jsonschema import Draft202012Validator

from asphalt_nscd.files.csvinput import read_csv
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.paths import require_readable
from asphalt_nscd.files.schema_words import first_wrong, sentence_on
from asphalt_nscd.forecasting.binders import UNSTATED, Binder, BinderLaw, Blend, read_binder
from asphalt_nscd.forecasting.rheometer import TableReader
from asphalt_nscd.forecasting.solid import Solid

DEFAULT_FREQUENCIES = (0.1, 0.3, 1.0, 3.0, 10.0, 25.0)  # Hz
DEFAULT_TEMPERATURES = (-10.0, 0.0, 10.0, 15.0, 20.0, 30.0, 40.0)  # degC, of a binder with a shift
WOBBLE = 0.5  # K, of the temperatures of a table about what was set
COARSE = 0.5e-3  # m, the coarsest sieve of a grading at least
FINE = 0.15e-3  # m, the finest sieve of a grading at most, unless nothing passes it
NUMBERED = {  # mm, of the sieves of ASTM E11
    "4": 4.75, "6": 3.35, "8": 2.36, "10": 2.0, "12": 1.7, "16": 1.18, "20": 0.85, "30": 0.6, "40": 0.425, "50": 0.3,
    "60": 0.25, "80": 0.18, "100": 0.15, "140": 0.106, "200": 0.075, "230": 0.063,
}  # fmt: skip
INCHES = {  # mm, of sieves named in inches
    "3": 75.0,
    "2 1/2": 63.0,
    "2": 50.0,
    "1 1/2": 37.5,
    "1": 25.0,
    "3/4": 19.0,
    "1/2": 12.5,
    "3/8": 9.5,
    "1/4": 6.3,
}
EXAMPLE = "asphalt-nscd forecast --help shows a recipe"
LEAST_VOIDS = 0.15  # per cent of air voids, if not none: less was given as a share of one
DENSEST = 0.97  # of the volume without air: more solids than any mix has
USUAL: dict[
    str, Any
] = {  # crushed rock and paving bitumen; voids of dry compacted filler, mostly 28 to 38 % (EN 13043)
    "density_kg_m3": {"aggregate": 2670.0, "binder": 1030.0},
    "aggregate": {"E_GPa": 60.0, "poisson": 0.2},
    "rigden_voids_percent": 35.0,
}


@dataclass(frozen=True)
class Grading:
    """Share (s,) of mass (and volume) of the aggregate that passes each sieve (s,) [m], rising with it to 1."""

    sieve: np.ndarray
    passing: np.ndarray

    def passing_at(self, diameter: np.ndarray | float) -> np.ndarray:
        """Share finer than a diameter [m], straight between sieves over the logarithm of size, level beyond them."""
        return np.interp(np.log(diameter), np.log(self.sieve), self.passing)


@dataclass(frozen=True)
class Recipe:
    """What a mix is made of.

    `binder` is the law of Young's modulus, `shifted` where it holds at other temperatures than its reference; `caveat`
    says what a reader must know of it; `measured` [degC] is the range of its table, if it has one. `binder_share` of
    the mass, `voids` of the volume of the mix; `rigden_voids` of compacted filler; densities in kg/m3; `temperature`
    [degC] and `frequency` [Hz] (n,) of each point of the forecast. `file` is for messages.
    """

    name: str
    source: str
    file: str
    binder: BinderLaw
    shifted: bool
    caveat: str
    binder_share: float
    voids: float
    aggregate_density: float
    binder_density: float
    aggregate: Solid
    grading: Grading
    temperature: np.ndarray
    frequency: np.ndarray
    rigden_voids: float = 0.35
    measured: tuple[float, float] | None = None

    @property
    def aggregate_fraction(self) -> float:
        """Volume of the aggregate over that of aggregate and binder."""
        stone = (1.0 - self.binder_share) / self.aggregate_density
        return stone / (stone + self.binder_share / self.binder_density)

    def outside(self, temperature: np.ndarray) -> np.ndarray:
        """Whether the binder's table does not reach to temperatures (n,) [degC]."""
        return _outside(self.measured, temperature)

    def binder_modulus(self) -> np.ndarray:
        """E* [Pa] of the binder at each point."""
        return self.binder.complex_modulus(2.0 * np.pi * self.frequency, self.temperature)


def read_recipe(path: str | Path, read_table: TableReader = read_csv) -> Recipe:
    """Read and check a recipe, a YAML file; `read_table` as in `read_rheometer`."""
    require_readable(path, "check the path of the recipe")
    try:
        text = Path(path).read_text(encoding="utf-8")
        if number := re.search(r"(?:^|[\s{,])#(\d+)\s*:", text):
            raise InputError(
                f"{path}: #{number[1]} begins a remark in YAML; write No. {number[1]} for the sieve."
            )
        content = yaml.safe_load(text)
    except (yaml.YAMLError, UnicodeDecodeError) as error:
        raise InputError(f"{path}: not YAML ({' '.join(str(error).split())}); {EXAMPLE}.") from None
    return recipe_of(content, path, read_table)


def recipe_of(content: Any, path: str | Path = "recipe", read_table: TableReader = read_csv) -> Recipe:
    """The recipe, checked, in a mapping as its YAML file has it; `path` is its name in messages."""
    schema = yaml.safe_load((files(__package__) / "recipe.schema.yaml").read_text(encoding="utf-8"))
    if not isinstance(content, Mapping):
        raise InputError(f"{path}: holds no keys with values; {EXAMPLE}.")
    content = dict(content) | {"grading": _keyed(content.get("grading"), path)}
    _require_finite(content, path)
    if wrong := first_wrong(Draft202012Validator(schema).iter_errors(content)):
        raise InputError(f"{path}: {sentence_on(wrong, 'the recipe')}")
    if 0.0 < content["air_voids_percent"] < LEAST_VOIDS:
        raise InputError(
            f"{path}: air_voids_percent: {content['air_voids_percent']:g} % is less than any mix has; give per cent, "
            f"or 0 for none."
        )
    content = USUAL | content
    aggregate = Solid(content["aggregate"]["E_GPa"] * 1e9, content["aggregate"]["poisson"])
    binder = _binder(content, path, read_table)
    stiffest = getattr(binder.law, "glassy_modulus", 0.0)
    if stiffest >= aggregate.modulus:
        raise InputError(
            f"{path}: the binder's glassy modulus, {stiffest / 1e9:.3g} GPa, is not below the aggregate's "
            f"{aggregate.modulus / 1e9:.3g} GPa; give E0_MPa in MPa and E_GPa in GPa."
        )
    temperature, frequency = _points(content, binder, path)
    recipe = Recipe(
        name=content.get("name", Path(path).stem),
        source=content.get("source", "not stated"),
        file=str(path),
        binder=binder.law,
        shifted=binder.shifted,
        caveat=_caveat(binder),
        measured=binder.measured,
        binder_share=content["binder_percent_by_mass"] / 100.0,
        voids=content["air_voids_percent"] / 100.0,
        aggregate_density=content["density_kg_m3"]["aggregate"],
        binder_density=content["density_kg_m3"]["binder"],
        aggregate=aggregate,
        grading=_grading(content["grading"], path),
        temperature=temperature,
        frequency=frequency,
        rigden_voids=content["rigden_voids_percent"] / 100.0,
    )
    if recipe.aggregate_fraction > DENSEST:
        raise InputError(
            f"{path}: aggregate fills {100 * recipe.aggregate_fraction:.0f} % of the volume without air, more than "
            f"grains can ({100 * DENSEST:.0f} %); correct binder_percent_by_mass or density_kg_m3."
        )
    return recipe


def _caveat(binder: Binder) -> str:
    """What a reader of the answer must know of the binder's law; empty if nothing."""
    unstated = f"The recipe states no temperature of its binder's law: {UNSTATED:g} °C stands for it."
    return " ".join(filter(None, [binder.caution, "" if binder.temperature_stated else unstated]))


def _outside(measured: tuple[float, float] | None, temperature: np.ndarray) -> np.ndarray:
    low, high = measured or (-np.inf, np.inf)
    return (temperature < low - WOBBLE) | (temperature > high + WOBBLE)


def _keyed(grading: Any, path: str | Path) -> Any:
    """The grading with its sieves as text, for YAML reads 0.063 as a number; refuses a sieve that is given twice."""
    if not isinstance(grading, Mapping):
        return grading
    keyed = {str(sieve): share for sieve, share in grading.items()}
    if len({_number(sieve) for sieve in keyed}) < len(grading):
        raise InputError(f"{path}: grading: a sieve is given twice; keep one.")
    return keyed


def _number(sieve: str) -> float | str:
    """Opening [mm] of a sieve by its text, a number or a name of ASTM E11; the text itself where it is neither."""
    name = " ".join(sieve.casefold().replace("-", " ").split())
    if (numbered := re.fullmatch(r"(?:#|no\.?)\s*(\d+)", name)) and numbered[1] in NUMBERED:
        return NUMBERED[numbered[1]]
    inches = re.sub(r"\s*(?:\"|”|″|in\.?|inch)$", "", name)
    if inches in INCHES and (inches != name or "/" in name):
        return INCHES[inches]
    try:
        return float(sieve)
    except ValueError:
        return sieve


def _require_finite(content: Any, path: str | Path, *keys: str) -> None:
    """Refuse a number in the content, below `keys`, that is not finite: no bounds of the schema refuse a nan."""
    if isinstance(content, Mapping | list):
        pairs = content.items() if isinstance(content, Mapping) else enumerate(content)
        for key, value in pairs:
            _require_finite(value, path, *keys, str(key))
    elif isinstance(content, float) and not np.isfinite(content):
        raise InputError(f"{path}: {'.'.join(keys)}: {content} is no finite number; write one.")


def _grading(content: Mapping[str, float], path: str | Path) -> Grading:
    """The grading of a recipe, sieves ascending; refuses what is no curve of per cent passing by mm."""
    sizes = [_number(sieve) for sieve in content]
    if not all(isinstance(size, float) and np.isfinite(size) for size in sizes):
        raise InputError(
            f"{path}: grading: a sieve is no number; give it in mm, as 0.063, or as 3/4 or No. 4."
        )
    # A mapping of YAML has the order in which it was typed.
    sieve, passing = np.array(sorted(zip(sizes, content.values(), strict=True)), float).T * [[1e-3], [1e-2]]
    if sieve[0] < 1e-6 or not COARSE <= sieve[-1] <= 0.1:
        raise InputError(
            f"{path}: grading: sieves go from {1e3 * sieve[0]:g} to {1e3 * sieve[-1]:g} mm; the finest may be 0.001, "
            f"the coarsest {1e3 * COARSE:g} to 100; give them in mm."
        )
    if sieve[0] > FINE and passing[0] > 0.0:
        raise InputError(
            f"{path}: grading: {100 * passing[0]:g} % passes the finest sieve, {1e3 * sieve[0]:g} mm; add finer ones, "
            f"to 0.063 mm."
        )
    falls = np.flatnonzero(np.diff(passing) < 0.0)
    if falls.size:
        low, high = 1e3 * sieve[falls[0]], 1e3 * sieve[falls[0] + 1]
        raise InputError(
            f"{path}: grading: less passes {high:g} mm than {low:g} mm; give per cent that passes, not that stays."
        )
    if abs(passing[-1] - 1.0) > 1e-9:
        raise InputError(
            f"{path}: grading: {100 * passing[-1]:g} % passes the largest sieve; add one that 100 % pass, and give "
            f"per cent."
        )
    return Grading(sieve, passing)


def _binder(content: Mapping[str, Any], path: str | Path, read_table: TableReader) -> Binder:
    """The binder of the mix, blended with that of recycled asphalt where the recipe has some."""
    binder = read_binder(content["binder"], path, read_table)
    rap = content.get("rap")
    if rap is None:
        return binder
    old = read_binder(rap["binder"], path, read_table)
    share = rap["percent_by_mass"] * rap["binder_percent_by_mass"] / 100.0 / content["binder_percent_by_mass"]
    if share > 1.0:
        raise InputError(
            f"{path}: rap: brings {share * content['binder_percent_by_mass']:.3g} % of binder into a mix of "
            f"{content['binder_percent_by_mass']:g} %; binder_percent_by_mass is all binder, old and new."
        )
    if binder.shifted != old.shifted:
        raise InputError(f"{path}: rap.binder: one binder holds at one temperature alone; give both a shift.")
    caution = " ".join(filter(None, [binder.caution, old.caution]))
    tables = [one.measured for one in (binder, old) if one.measured]
    measured = (max(low for low, _ in tables), min(high for _, high in tables)) if tables else None
    return replace(binder, law=Blend(binder.law, old.law, share), caution=caution, measured=measured)


def _points(content: Mapping[str, Any], binder: Binder, path: str | Path) -> tuple[np.ndarray, np.ndarray]:
    """Temperature [degC] and frequency [Hz] (n,) of each point, all frequencies at each temperature."""
    if "frequencies_Hz" in content and "angular_frequencies_rad_s" in content:
        raise InputError(f"{path}: frequencies_Hz and angular_frequencies_rad_s; give one of them.")
    if "angular_frequencies_rad_s" in content:
        frequency = np.asarray(content["angular_frequencies_rad_s"], float) / (2.0 * np.pi)
    else:
        frequency = np.asarray(content.get("frequencies_Hz", DEFAULT_FREQUENCIES), float)
    reference = binder.law.shift.reference_temperature
    if binder.shifted:
        usual = np.array(DEFAULT_TEMPERATURES)
        usual = usual[~_outside(binder.measured, usual)]
        temperature = np.asarray(content.get("temperatures_C", usual if usual.size else [reference]), float)
    else:
        temperature = np.array([reference])
        for asked in content.get("temperatures_C", ()):
            if asked != reference:
                raise InputError(
                    f"{path}: temperatures_C: {asked:g} degC, but the binder's law has no shift from its "
                    f"{reference:g} degC; add binder.shift, or leave temperatures_C out."
                )
    try:
        binder.law.shift.factor(temperature)
    except InputError as error:
        raise InputError(f"{path}: temperatures_C: {error}") from None
    grid = np.meshgrid(temperature, frequency, indexing="ij")
    return grid[0].ravel(), grid[1].ravel()
