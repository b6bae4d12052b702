"""What the report opens with: what was measured, what simulated, what is wrong, why, and what was gained."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pandas as pd

from asphalt_nscd.diagnosis.written import three_digits
from asphalt_nscd.files.csvinput import read_csv
from asphalt_nscd.measurements.agreement import mean_relative_error
from asphalt_nscd.measurements.tables import the_only
from asphalt_nscd.reporting.pages.diagnosis_page import in_type, sections

ENOUGH = 5000  # spheres
TOO_FEW = (
    "So few spheres are a smaller specimen than any that was measured, and do not stand for the mix: laws, phase and "
    "diagnosis are already what they will be, simulated |E*| is not."
)


def first_page(
    measured: Sequence[Path], simulations: Sequence[Path], samples: Sequence[Path], diagnosis: list[Path],
    map: list[Path],
) -> dict[str, Any]:  # fmt: skip
    """Sentences of each part, and rows of the gain.

    measured, simulations, samples: one CSV table each, as the workflow makes them; diagnosis: diagnosis.json;
    map: PNG picture of the residuals.
    """
    found = sections(diagnosis, map)
    ladder = found["diagnosis"]["ladder"]
    moduli, tests = _frame(measured, "measured"), _frame(simulations, "simulations")
    return {
        "measured": _measured(moduli, found),
        "simulated": _simulated(tests, _frame(samples, "samples")),
        "wrong": [*_wrong(found["diagnosis"]), _as_simulated(moduli, tests)],
        "found": {
            name: _typed(found["first"][name])
            for name in ("data", "simulation", "causes", "left", "with_suspects")
        },
        "not_used": [in_type(where) for where, _ in found["first"]["not_used"]],
        "orders": [in_type(" ".join([one["text"], *one["why"]])) for one in found["first"]["orders"]],
        "notes": _typed(found["diagnosis"]["notes"]),
        "gained": _gained(ladder),
        "held_out": _held_out(ladder),
        "map": found["map"],
    }


def _typed(value: Any) -> Any:
    """Sentences of the terminal as they are printed."""
    return in_type(value) if isinstance(value, str) else [_typed(part) for part in value]


def _frame(paths: Sequence[Path], name: str) -> pd.DataFrame:
    table = read_csv(the_only(paths, name))
    numbers = ("temperature_C", "frequency_Hz", "E_MPa", "phase_deg", "spheres", "bonds", "E_over_law")
    return pd.DataFrame(
        {name: table.numbers(name) if name in numbers else values for name, values in table.columns.items()}
    )


def _measured(frame: pd.DataFrame, found: dict[str, Any]) -> list[str]:
    names = ("temperature_C", "frequency_Hz", "E_MPa", "phase_deg")
    temperature, frequency, modulus, phase = (_range(frame[name]) for name in names)
    return [
        f"{len(frame)} complex moduli of {_many(frame['specimen'].nunique(), 'specimen')}, {temperature} °C, "
        f"{frequency} Hz: |E*| {modulus} MPa, phase {phase}°.",
        *found["origin"],
        found["scatter"],
    ]  # fmt: skip


def _simulated(tests: pd.DataFrame, samples: pd.DataFrame) -> list[str]:
    conditions = tests[["temperature_C", "frequency_Hz"]].drop_duplicates()
    return [
        f"{_many(len(samples), 'sample')} of {_range(samples['spheres'])} bonded spheres, poured from the grading, "
        f"in two-point bending at {_many(len(conditions), 'condition')}: {_many(len(tests), 'test')}.",
        f"They return the law of their bonds, |E*| times {_range(samples['E_over_law'])} by their packing.",
        *([TOO_FEW] if samples["spheres"].max() < ENOUGH else []),
    ]  # fmt: skip


def _wrong(diagnosis: dict[str, Any]) -> list[str]:
    modulus, phase = diagnosis["baseline"]["mre_E_percent"], diagnosis["baseline"]["mre_phase_percent"]
    return [
        "With one Burgers law for each temperature, as in the paper, and the packing taken out, the simulation misses "
        f"averages over specimens of |E*| by {_mean(modulus)} %, most at {_worst(modulus)} °C, and of the phase by "
        f"{_mean(phase)} %, most at {_worst(phase)} °C."
    ]


def _as_simulated(moduli: pd.DataFrame, tests: pd.DataFrame) -> str:
    errors = mean_relative_error(moduli, tests).mean()
    return (
        "The tests as they were simulated, packing and all (Table 4): |E*| by "
        f"{three_digits(errors['mre_E_percent'])} %, the phase by {three_digits(errors['mre_phase_percent'])} %."
    )


def _gained(ladder: list[dict[str, Any]]) -> list[tuple[str, str, str]]:
    """Quantity, before all causes and after all of them."""
    if not ladder:
        return []
    names = {
        "mre_E_percent": "error of |E*|, %", "mre_phase_percent": "error of the phase, %",
        "rms_over_scatter": "residual over scatter",
    }  # fmt: skip
    first, last = ladder[0]["gain"]["in_sample"], ladder[-1]["gain"]["in_sample"]
    return [
        (words, three_digits(first[name]["before"]), three_digits(last[name]["after"]))
        for name, words in names.items()
    ]


def _held_out(ladder: list[dict[str, Any]]) -> str | None:
    """Errors of temperatures that took no part in the fit, where there are enough to leave one out."""
    predicted = ladder[-1]["gain"]["held_out"].get("leave_one_isotherm_out") if ladder else None
    if predicted is None:
        return None
    modulus, phase = (
        three_digits(predicted[name]["after"]) for name in ("mre_E_percent", "mre_phase_percent")
    )
    return (
        f"Each inner temperature predicted from the rest alone: |E*| to {modulus} %, the phase to {phase} %."
    )


def _mean(by_temperature: dict[str, float]) -> str:
    return three_digits(sum(by_temperature.values()) / len(by_temperature))


def _worst(by_temperature: dict[str, float]) -> str:
    return _number(float(max(by_temperature, key=by_temperature.__getitem__)))


def _range(values: pd.Series) -> str:
    low, high = (_number(value) for value in (values.min(), values.max()))
    return low if low == high else f"{low} to {high}"


def _number(value: float) -> str:
    """Four digits, or all before the point."""
    text = f"{value:.0f}" if abs(value) >= 1e4 else f"{value:.4g}"
    return text.replace("-", "\N{MINUS SIGN}")


def _many(count: int, name: str) -> str:
    return f"{count} {name}" + ("" if count == 1 else "s")
