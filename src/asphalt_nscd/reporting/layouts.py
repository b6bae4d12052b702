"""How published tables are shown in README.md and docs/: which columns, under which headings.

A page shows at most 120 characters in a line. A table with more columns is shown in parts, and its CSV holds the rest.
A block that is not named here shows all columns of its table.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import pandas as pd


@dataclass(frozen=True)
class Layout:
    """One table of a block: its columns with their headings, below a sentence. A column the table lacks is left out.

    figures: significant figures. shorter: cells that are too long for a page, and what stands there instead.
    where: by column, the values of the rows that a page shows; all if empty. but: those of rows that it does not show.
    """

    columns: Mapping[str, str]
    sentence: str = ""
    figures: int = 4
    shorter: Mapping[str, str] = field(default_factory=dict)
    where: Mapping[str, Sequence[object]] = field(default_factory=dict)
    but: Mapping[str, Sequence[object]] = field(default_factory=dict)

    def markdown(self, table: pd.DataFrame) -> str:
        """The table for a page of the documents, its sentence above it."""
        for column, values in self.where.items():
            table = table[table[column].isin(values)]
        for column, values in self.but.items():
            table = table[~table[column].isin(values)]
        columns = [column for column in self.columns if column in table]
        shown = table[columns].rename(columns=dict(self.columns)).replace(dict(self.shorter))
        return (f"{self.sentence}\n\n" if self.sentence else "") + _grid(shown, self.figures)


@dataclass(frozen=True)
class Notes:
    """A list of sentences: the text of one column behind the names in others."""

    names: Sequence[str]
    text: str

    def markdown(self, table: pd.DataFrame) -> str:
        """Rows without a text are left out. Raises KeyError if the table lacks a column."""
        rows = table[table[self.text].notna()]
        return "".join(f"* {', '.join(row[: len(self.names)])}: {row[-1]}\n" for row in self._rows(rows))

    def _rows(self, table: pd.DataFrame) -> list[tuple[str, ...]]:
        return [tuple(map(str, row)) for row in table[[*self.names, self.text]].itertuples(index=False)]


@dataclass(frozen=True)
class Rungs:
    """Errors of one quantity in ladder.csv: a row for each temperature, a column for each rung."""

    quantity: str
    sentence: str

    def markdown(self, table: pd.DataFrame) -> str:
        """The table for a page of the documents, a column for each rung."""
        error = f"mre_{self.quantity}"
        by = {rung: rows.set_index("temperature_C") for rung, rows in table.groupby("rung", sort=False)}
        first = next(iter(by.values()))
        columns = {}
        if f"{error}_published_percent" in first:
            columns["printed"] = first[f"{error}_published_percent"]
        columns |= {rung: rows[f"{error}_percent"] for rung, rows in by.items()}
        shown = pd.DataFrame(columns).rename_axis("T, °C").reset_index()
        return f"{self.sentence}\n\n" + _grid(shown, figures=3)


@dataclass(frozen=True)
class Crossed:
    """One quantity of a long table: a row for each value of one column, and a column for each value of another."""

    row: str
    column: str
    quantity: str
    heading: str
    names: Mapping[str, str]  # of the columns that are shown
    sentence: str

    @property
    def columns(self) -> tuple[str, ...]:
        """Those that the table must have."""
        return self.row, self.column, self.quantity

    def markdown(self, table: pd.DataFrame) -> str:
        """The table for a page of the documents, rows in the order of the long one."""
        wide = table.pivot(index=self.row, columns=self.column, values=self.quantity).loc[
            table[self.row].unique()
        ]
        shown = wide[[*self.names]].rename(columns=dict(self.names)).rename_axis(self.heading).reset_index()
        return f"{self.sentence}\n\n" + _grid(shown, figures=3)


def shown(block: str, table: pd.DataFrame) -> str:
    """The published table of a block in Markdown, in lines of at most 120 characters."""
    parts = BLOCKS.get(block, [Layout({str(name): str(name) for name in table.columns})])
    return "\n".join(part.markdown(table) for part in parts)


def _grid(table: pd.DataFrame, figures: int) -> str:
    table = table.convert_dtypes()  # whole numbers stay so beside empty fields
    filled = table.astype(object).where(table.notna(), None)
    return filled.to_markdown(index=False, floatfmt=f".{figures}g", missingval="") + "\n"


_CRITERIA = {
    "what": "what",
    "target": "target",
    "percent": "%",
    "interval_percent": "interval",
    "met": "met",
}
_MODELS = {
    "forecast": "forecast",
    "hirsch": "Hirsch",
    "witczak": "Witczak 1-40D",
    "differential": "differential scheme",
    "witczak_its_own_binder": "Witczak, its own binder",
}
_SHIFTED = {"forecast_shifted": "forecast, time shifted", "hirsch_shifted": "Hirsch, time shifted"}
BLOCKS: dict[str, list[Layout | Notes | Rungs | Crossed]] = {
    "verification": [Layout({name: name for name in ("theme", "passed")})],
    "faults": [Layout({name: name for name in ("kind", "faults", "passed")})],
    "ladder": [
        Rungs("E", "Modulus |E\\*|, mean relative error in percent:"),
        Rungs("phase", "Phase angle, mean relative error in percent:"),
    ],
    "samples": [
        Layout(
            {
                "sample": "sample",
                "solid_fraction": "solid fraction",
                "tests_with_broken_bonds": "breaks",
                "E_over_law": "E over law",
                "largest_phase_difference_deg": "phase off, °",
            }
        ),
    ],
    "nonlinear": [Layout(_CRITERIA)],
    "drawn_excess": [Layout(_CRITERIA)],
    "power": [
        Layout(
            {
                "campaign": "campaign",
                "laboratory": "laboratory",
                "cause": "cause",
                "unit": "unit",
                "named_50%": "named in half",
                "named_95%": "in 95 %",
            }
        )
    ],
    "power_summary": [Layout(_CRITERIA)],
    "machines": [Layout(_CRITERIA, where={"met": ("yes", "no")})],
    "machine_measured": [
        Layout(
            {
                "cause": "shared",
                "where": "where",
                "value": "value",
                "std_error": "standard error",
                "unit": "unit",
            },
            where={
                "where": (
                    "all campaigns",
                    "4 degC",
                    "20 degC",
                    "35 degC",
                    "40 degC",
                    "0.1 Hz",
                    "1 Hz",
                    "10 Hz",
                )
            },
        )
    ],
    "intervals": [
        Layout(
            {
                "population": "tables",
                "at": "at",
                "values": "values",
                "E_held_percent": "|E*| held, %",
                "E_half_percent": "half-width, %",
                "phase_held_percent": "phase held, %",
                "phase_half_deg": "half-width, °",
            },
            figures=3,
            where={"at": ("-10 to 54 degC", "-10 degC", "54.4 degC")},
        )
    ],
    "attack": [Layout(_CRITERIA, where={"met": ("no",)})],
    "mutants": [
        Layout({"room": "folder", "mutants": "tried", "noticed": "noticed"}),
        Notes(["room"], "alive"),
    ],
    "fatigue_summary": [
        Layout(
            {"what": "what", "here": "here", "beside": "beside", "beside_is": "which is"},
            figures=3,
            shorter={
                "strain that a bond endures a million times, 1e-6": "`endured` of a bond, 1e-6",
                "epsilon6 of the samples, 1e-6": "epsilon6, 1e-6",
                "standard deviation of log N between samples": "standard deviation of log N",
                "height of most damage over h, lowest sample": "height of most damage over h, lowest",
                "height of most damage over h, highest sample": "the same, highest",
                "set on what is published": "set on the published mix",
                "largest strain of bending theory": "by bending theory",
                "cycles of a small sample at a large strain": "cycles of a small sample",
                "the same by jumps ten times as fine": "the same, finer jumps",
            },
        )
    ],
    "rigs": [
        Layout(
            {
                "test": "test",
                "spheres": "spheres",
                "kind": "kind",
                "least": "least",
                "largest": "largest",
                "phase_deg": "phase, °",
            },
            figures=5,
        )
    ],
    "mapping": [
        Layout(
            {
                "mapping": "bonds",
                "kt_over_kn": "kt / kn",
                "least E / law": "least",
                "mean": "mean",
                "largest": "largest",
                "in tension": "in tension",
                "Poisson's ratio": "ν",
            },
            # The paper's number; other sizes are in mapping.csv.
            where={"spheres": (14160,), "mapping": ("facets", "paper")},
        )
    ],
    "benchmark": [
        Layout(
            {
                "topic": "topic",
                "case": "case",
                "time_step_s": "time step, s",
                "cpu_s": "CPU time, s",
            },
            where={"topic": ("pouring", "cycle of 10 Hz")},
            shorter={"cycle of 10 Hz": "a cycle", "reduced, 8 Kelvin elements": "reduced, 8 Kelvin"},
        ),
    ],
    "bond_readings": [
        Layout(
            {
                "reading": "reading",
                "expected": "expected",
            },
            # The paper's own coefficient; other ones are in bond_readings.csv.
            where={"friction": (0.2,)},
        )
    ],
    "reconstructions": [
        Layout(
            {
                "temperature_C": "T, °C",
                "published_phase_percent": "published",
                "smooth_law_phase_percent": "smooth law",
                "above_phase_percent": "above published",
            },
            "Phase angle, mean relative error of Table 3's laws in percent:",
            figures=3,
        )
    ],
    "diagnosis_times": [
        Layout(
            {"case": "table", "cpu_s": "CPU time, s", "memory_MB": "memory, MB"},
        )
    ],
    "forecast": [
        Layout(
            {
                "forecast": "forecast",
                "parameters": "fitted",
                "factor_all": "factor of modulus",
                "phase_all_deg": "phase, °",
            },
            figures=3,
        ),
    ],
    "measured_means": [
        Layout(
            {
                "rung": "law",
                "fitted": "fitted",
                "E_percent": "E, %",
                "phase_percent": "phase, %",
                "simulated_E_percent": "simulated: E",
                "simulated_phase_percent": "phase ",
            },
            figures=3,
        ),
        Layout(
            {
                "rung": "law",
                "left_out_isotherm_E_percent": "isotherm out: E, %",
                "left_out_isotherm_phase_percent": "phase, %",
                "left_out_specimen_E_percent": "specimen out: E, %",
                "left_out_specimen_phase_percent": "phase, % ",
            },
            "Of what was left out:",
            figures=3,
        ),
    ],
    "measured_amplitude": [
        Layout(
            {
                "test": "test",
                "mechanism": "mechanism",
                "measured_E_percent": "E, %",
                "standard_error_E_percent": "+-",
                "predicted_E_percent": "predicted",
                "measured_phase_deg": "phase, °",
                "standard_error_phase_deg": "+- ",
                "predicted_phase_deg": "predicted ",
                "contradicted": "contradicted",
            },
            figures=2,
        )
    ],
    "excess_budget": [
        Layout(
            {
                "population": "population",
                "temperature_C": "T, °C",
                "mixes": "mixes",
                "measured_deg": "excess",
                "standard_error_deg": "+-",
                "reading_deg": "reading",
                "contacts_deg": "contacts",
                "softening_deg": "softening",
                "verdict": "verdict",
            },
            figures=3,
        ),
        Layout(
            {
                "population": "population",
                "temperature_C": "T, °C",
                "correlation": "r",
                "rms_deg": "rms",
                "rms_less_reading_deg": "less reading",
                "rms_less_all_deg": "less all",
                "rms_less_mean_deg": "less mean",
            },
            "Root mean squares over the mixes:",
            figures=3,
        ),
    ],
    "forecast_blind": [
        Layout(
            {
                "model": "model",
                "factor": "factor of modulus",
                "bias": "bias",
                "phase_deg": "phase, °",
                "phase_bias_deg": "its bias, °",
                "mixes_nearer_than_hirsch": "mixes nearer than Hirsch",
            },
            # Each temperature is below, and its phases are in blind_overall.csv.
            where={"temperature_C": ("4.4 to 54.4",)},
            figures=3,
            shorter=_MODELS | _SHIFTED,
        ),
        Crossed(
            "temperature_C",
            "model",
            "factor",
            "T, °C",
            _MODELS,
            "Factor of modulus at each temperature:",
        ),
    ],
    "forecast_tried": [
        Layout(
            {
                "contacts": "contacts",
                "gap_nm": "gap, nm",
                "factor_all": "factor",
                "phase_all_deg": "phase, °",
                "factor_even": "half of the mixes",
                "phase_even_deg": "phase, ° ",
                "factor_odd": "the other half",
                "phase_odd_deg": "phase, °  ",
            },
            where={"gap_nm": (1,)},
            figures=3,
        )
    ],
    "growth": [
        Layout(
            {
                "stage": "stage",
                "last_exponent_of_time": "exponent",
                "cpu_s_of_largest": "CPU time, s",
                "memory_MB_of_largest": "memory, MB",
            },
        ),
    ],
}
