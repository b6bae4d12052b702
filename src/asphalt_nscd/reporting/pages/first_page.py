"""What the report opens with: what was measured, what simulated, what is wrong, why, and what was gained."""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import pandas as pd

from asphalt_nscd.diagnosis.words import sentences
from asphalt_nscd.diagnosis.written import read_diagnosis, three_digits
from asphalt_nscd.files.csvinput import read_csv
from asphalt_nscd.files.words import counted, joined
from asphalt_nscd.measurements.tables import only_file
from asphalt_nscd.reporting.pages.diagnosis_page import first, scatter
from asphalt_nscd.reporting.pages.style import typeset
from asphalt_nscd.reporting.pages.way import LIKELIEST, held_out, means, read_ladder

ENOUGH = 5000  # spheres
ELSEWHERE = (
    "Tests",
    "Note",
    "Scatter",
    "Not visible",
    "Next tests",
)  # parts of the answer with a card of their own
TABLE4 = " (Table 4)"
LEFT_OUT = (
    "temperatures between the ends",
    "coldest and warmest",
    "frequencies between the ends",
    "lowest and highest",
)
ONE_LAW = "one law for all temperatures in place of a Burgers law at each"
TOO_FEW = "No specimen this small was measured. Laws, phase and diagnosis are final; simulated |E*| is not."


def first_page(
    measured: Sequence[Path],
    simulations: Sequence[Path],
    samples: Sequence[Path],
    diagnosis: list[Path],
    pictures: list[Path],
    ladder: Sequence[Path],
    beside: Sequence[Path] = (),
) -> dict[str, Any]:
    """What the template of the first page asks for: sentences of each part, and rows of the gain.

    Each sequence holds one file; the PNG in `pictures` opens the page. `ladder` is ladder.csv, the errors of each
    campaign. `beside` holds rivals.csv, the errors of tests left out, and ensemble.csv, the gain on data that meet the
    paper's tables.
    """
    content = read_diagnosis(diagnosis)
    told = first(content, ladder)
    way = read_ladder(ladder)
    left_out = _left_out(way, [path for path in beside if path.stem == "rivals"])
    moduli, tests = _frame(measured, "measured"), _frame(simulations, "simulations")
    gained = _gained(way)
    return {
        "lead": _lead(content, way, gained, told["orders"]),
        "bars": _bars(gained),
        "data": _heading(content["origin"]),
        "measured": [*_measured(moduli), *sentences.origin(content), scatter(content)],
        "simulated": _simulated(tests, _frame(samples, "samples")),
        "wrong": _wrong(way),
        "found": [(label, _typed(said)) for label, said in told["answer"] if label not in ELSEWHERE],
        "causes": _typed(told["causes"]),
        "law": _typed(told["law"] or []),
        "orders": [typeset(" ".join([one["text"], *one["why"]])) for one in told["orders"]],
        "notes": _typed(content["notes"]),
        "gained": gained,
        "left_out": left_out,
        "held_out": None if left_out else _held_out(way),
        "elsewhere": _gain_on_other_data([path for path in beside if path.stem == "ensemble"]),
        "as_table4": " as in Table 4" * ("mre_E_published_percent" in way),
        "pictures": [b64encode(path.read_bytes()).decode() for path in pictures],
    }


def _lead(
    content: Mapping[str, Any], way: pd.DataFrame, gained: list[tuple[str, ...]], orders: list[dict[str, Any]]
) -> list[tuple[str, str]]:
    """Four sentences beside the pictures: what is wrong, why and how sure that is, what was gained, what to do."""
    sure: list[str] = []
    unsure: list[str] = []
    for rung in content["ladder"]:
        words = ONE_LAW if rung["cause"] == sentences.LAW else sentences.cause_words(rung)
        (sure if rung["established"] else unsure).append(words)
    why = [f"{joined(sure)}: established"] if sure else []
    why += [f"{joined(unsure)}: likely, not certain"] if unsure else []
    said = typeset("; ".join(why))
    # The scatter stands in the last row, below the rungs.
    last, scatter_of_one = gained[-2], gained[-1]
    act = typeset(orders[0]["text"]) if orders else ""
    invented = "reconstructed" in content["origin"]
    if invented:
        act = "Get the measurements of the paper's figures: these data are reconstructed, nobody can test them again."
    return [
        ("What is wrong", _wrong(way)[0]),
        ("Why, and how sure", f"{said[:1].upper()}{said[1:]}." if said else "No cause is named."),
        (
            "What that gains",
            f"With it ({last[0]}) the tests miss {last[1]} % in |E*| and {last[2]} % in the phase; one test scatters "
            f"by {scatter_of_one[1]} % and {scatter_of_one[2]} %.{' The data are invented.' * invented}",
        ),
        ("What to do", act or "No further test is asked for."),
    ]


def _bars(gained: list[tuple[str, ...]]) -> list[tuple[str, list[tuple[str, str, float]]]]:
    """Of |E*| and of the phase: name, error and length in percent of the longest, for each rung."""
    return [
        (
            name,
            [
                (row[0], row[n], 100.0 * float(row[n]) / max(float(one[n]) for one in gained))
                for row in gained
            ],
        )
        for n, name in ((1, "|E*|"), (2, "phase"))
    ]


def _heading(origin: str) -> str:
    if origin in ("measured", "digitised"):
        return "What was measured" + (", read off figures" if origin == "digitised" else "")
    return f"The data: {origin}, not measured"


def _typed(value: Any) -> Any:
    """Sentences of the terminal as they are printed on a page."""
    return typeset(value) if isinstance(value, str) else [_typed(part) for part in value]


def _frame(paths: Sequence[Path], name: str) -> pd.DataFrame:
    table = read_csv(only_file(paths, name))
    # Only these: a specimen called 01 is no number.
    numbers = ("temperature_C", "frequency_Hz", "E_MPa", "phase_deg", "spheres", "bonds", "E_over_law")
    return pd.DataFrame(
        {name: table.numbers(name) if name in numbers else values for name, values in table.columns.items()}
    )


def _measured(frame: pd.DataFrame) -> list[str]:
    names = ("temperature_C", "frequency_Hz", "E_MPa", "phase_deg")
    temperature, frequency, modulus, phase = (_range(frame[name]) for name in names)
    return [
        f"{len(frame)} complex moduli of {counted(frame['specimen'].nunique(), 'specimen')}, {temperature} °C, "
        f"{frequency} Hz: |E*| {modulus} MPa, phase {phase}°.",
    ]


def _simulated(tests: pd.DataFrame, samples: pd.DataFrame) -> list[str]:
    origin = "poured from the grading"
    if "packing" in samples:
        origin = f"from packings of another program ({', '.join(samples['packing'])})"
    conditions = tests[["temperature_C", "frequency_Hz"]].drop_duplicates()
    return [
        f"{counted(len(samples), 'sample')} of {_range(samples['spheres'])} bonded spheres, {origin}, "
        f"tested at {counted(len(conditions), 'condition')}: {counted(len(tests), 'test')}.",
        f"They return the law of their bonds: the same phase, and |E*| times {_range(samples['E_over_law'])}.",
        *([TOO_FEW] if samples["spheres"].max() < ENOUGH else []),
    ]


def _wrong(way: pd.DataFrame) -> list[str]:
    """What the campaign that the ladder begins with misses, how much of it is its law's, and what others printed."""
    rungs = list(dict.fromkeys(way["rung"]))
    # As an index True is 1: the rung behind the likeliest reading, which one sample alone was tested by.
    likeliest = rungs[0] == LIKELIEST
    begin = way[way["rung"] == rungs[likeliest]]
    printed = "mre_E_published_percent" in way
    mean, worst = begin.mean(numeric_only=True), begin.set_index("temperature_C")
    modulus, phase = (worst[f"mre_{name}_percent"] for name in ("E", "phase"))
    return [
        f"Our simulated tests miss averages over specimens{TABLE4 * printed} of |E*| by {three_digits(modulus.mean())} "
        f"%, most at {_number(modulus.idxmax())} °C, and of the phase by {three_digits(phase.mean())} %, most at "
        f"{_number(phase.idxmax())} °C.",
        f"Of this the Burgers laws in their bonds miss {three_digits(mean['mre_E_law_percent'])} % and "
        f"{three_digits(mean['mre_phase_law_percent'])} % themselves.",
        *_printed(mean),
        *(_likeliest(way) if likeliest else []),
    ]


def _likeliest(way: pd.DataFrame) -> list[str]:
    """What the reading of the paper that its authors most likely had misses."""
    mean = way[way["rung"] == LIKELIEST].mean(numeric_only=True)
    return [
        f"By the likeliest of the readings tried, in one sample, it misses {three_digits(mean['mre_E_percent'])} % and "
        f"{three_digits(mean['mre_phase_percent'])} %: the level of |E*| depends on how bonds and packing are read."
    ]


def _printed(mean: pd.Series) -> list[str]:
    """What the paper prints of its own simulation, where that is known."""
    modulus, phase = (mean.get(f"mre_{name}_published_percent") for name in ("E", "phase"))
    if modulus is None or phase is None:
        return []
    return [
        f"The paper prints {three_digits(modulus)} % and {three_digits(phase)} % of its own simulation, against "
        "measurements that we do not have."
    ]


def _gained(way: pd.DataFrame) -> list[tuple[str, ...]]:
    """Errors after each rung, mean over temperatures; last the scatter of one test."""
    errors = means(way)
    rows = [
        (rung, *(three_digits(errors.loc[rung, f"mre_{name}_percent"]) for name in ("E", "phase")))
        for rung in errors.index
    ]
    scatter = (three_digits(errors[f"scatter_{name}_percent"].iloc[0]) for name in ("E", "phase"))
    return [*rows, ("scatter of one test", *scatter)]


def _left_out(way: pd.DataFrame, rivals: Sequence[Path]) -> list[tuple[str, ...]]:
    """Errors of the one law at tests left out of its fit: temperatures from the ladder, frequencies from the rivals."""
    temperatures = [held_out(way, ends) for ends in (False, True)]
    if not rivals or not all(temperatures):
        return []
    table = read_csv(only_file(rivals, "rivals"))
    frequencies = [
        {name: table.numbers_or_nan(f"{kind}_frequencies_{name}_percent")[0] for name in ("E", "phase")}
        for kind in ("inner", "end")
    ]
    return [
        (words, *(three_digits(errors[name]) for name in ("E", "phase")))
        for words, errors in zip(LEFT_OUT, [*temperatures, *frequencies], strict=True)
    ]


def _gain_on_other_data(ensemble: Sequence[Path]) -> str | None:
    """What the one law gains on data of which the paper's laws are the fit and its errors the residual."""
    if not ensemble:
        return None
    table = read_csv(only_file(ensemble, "ensemble"))
    one, burgers = (
        [three_digits(table.numbers_or_nan(f"{kind}_{quantity}_percent")[0]) for quantity in ("E", "phase")]
        for kind in ("mean", "burgers")
    )
    return (
        f"On data that meet Tables 3 and 4 of the paper, as these do not, one law misses |E*| by {one[0]} % and the "
        f"phase by {one[1]} %, the paper's Burgers laws by {burgers[0]} % and {burgers[1]} %: what is gained of the "
        "phase here is gained on invented data."
    )


def _held_out(way: pd.DataFrame) -> str | None:
    """Errors of temperatures that took no part in the fit, where there are enough to leave one out."""
    said = []
    for ends, words in (
        (False, "Each inner temperature predicted from the rest alone"),
        (True, "the coldest and the warmest"),
    ):
        held = held_out(way, ends)
        if not held:
            return None
        modulus, phase = (three_digits(held[name]) for name in ("E", "phase"))
        said.append(f"{words}: |E*| to {modulus} %, the phase to {phase} %")
    return f"{'; '.join(said)}."


def _range(values: pd.Series) -> str:
    low, high = (_number(value) for value in (values.min(), values.max()))
    return low if low == high else f"{low} to {high}"


def _number(value: float) -> str:
    """Four digits, or all before the point."""
    text = f"{value:.0f}" if abs(value) >= 1e4 else f"{value:.4g}"
    return text.replace("-", "\N{MINUS SIGN}")
