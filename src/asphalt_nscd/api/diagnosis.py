"""The diagnosis of measurements as one object: verdict, ladder, suspects, limits, law, figures."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from importlib import import_module
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd

from asphalt_nscd.api.arguments import checked
from asphalt_nscd.api.laws import Law
from asphalt_nscd.api.pictures import shown_in_notebooks
from asphalt_nscd.api.tables import Measurements, campaign_in
from asphalt_nscd.diagnosis.observed.reading import PAPER_GEOMETRY
from asphalt_nscd.diagnosis.record.measured_limits import Progress, Trials, verify
from asphalt_nscd.diagnosis.run import Outcome, Stated, conclude
from asphalt_nscd.diagnosis.settings import Draws, Known, Simulated
from asphalt_nscd.diagnosis.words.answer import answer, rows, summary
from asphalt_nscd.diagnosis.written import mean_averages, read_diagnosis
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.paths import is_file
from asphalt_nscd.files.store import read_json, write_json
from asphalt_nscd.files.words import counted

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclass(frozen=True)
class Diagnosis:
    """What the simulation gets wrong about measurements, how sure that is, and what could not have been seen.

    `str(diagnosis)` is what the command line prints.

    Parameters
    ----------
    outcome : diagnosis.run.Outcome
        What `diagnose` or `Diagnosis.read` found.

    Examples
    --------
    >>> diagnosis = diagnose("data/tutorial/exports", draws=Draws(500))
    >>> diagnosis.verdict, diagnosis.law.kind
    ('explained', '2s2p1d')
    >>> diagnosis.suspects[["specimen", "temperature_C", "frequency_Hz", "status"]]
      specimen  temperature_C  frequency_Hz    status
    0    Mix-B            4.0          25.0  left out
    """

    outcome: Outcome

    @classmethod
    def read(cls, folder: str | Path) -> Diagnosis:
        """Read the diagnosis that `write` or `asphalt-nscd diagnose` left.

        Parameters
        ----------
        folder : path
            Its folder, with diagnosis.json, residuals.csv and causality.csv.

        Returns
        -------
        Diagnosis
            The same diagnosis, without what `verify_limits` and `same_machine` need.

        Raises
        ------
        InputError
            Where a file is missing or is not of a diagnosis.
        """
        folder = Path(folder)
        content = read_diagnosis([folder / "diagnosis.json"])
        tables = []
        for name in ("residuals.csv", "causality.csv"):
            if not is_file(folder / name):
                raise InputError(
                    f"{folder / name}: no such file; it belongs to diagnosis.json, diagnose again."
                )
            # A specimen called 01 is not 1.
            tables.append(pd.read_csv(folder / name, dtype={"specimen": str}))
        # An empty cell of a CSV is a NaN to pandas, and a NaN is true: each test would be suspect.
        tables[1]["reasons"] = tables[1]["reasons"].fillna("")
        law = read_json(folder / "law.json") if is_file(folder / "law.json") else None
        return cls(Outcome(dict(content), tables[0], tables[1], law))

    @property
    def content(self) -> Mapping[str, Any]:
        """Everything, as in diagnosis.json.

        Returns
        -------
        mapping
            Its keys are described in diagnosis/content/.
        """
        return self.outcome.content

    @property
    def verdict(self) -> str:
        """The answer in one word.

        Returns
        -------
        str
            "explained", "unexplained_structure" or "nothing_to_explain".
        """
        return str(self.content["verdict"])

    @property
    def notes(self) -> tuple[str, ...]:
        """What a reader must know of how the table was read and of what was found.

        Returns
        -------
        tuple of str
            Sentences.
        """
        return (*self.content["reading"]["notes"], *self.content["notes"])

    @property
    def ladder(self) -> pd.DataFrame:
        """The causes that were named, in the order found.

        Returns
        -------
        DataFrame
            One row for each. value and std_error [unit] are those of its amplitude. error_...: mean relative
            errors [%] without and with it. established: whether it stays whichever isotherm, frequency or
            specimen is left out; else it is the likeliest, `hangs_on` names what must not be left out,
            `as_good` what fits as well, and `doubts` says why an unknown effect may stand behind it.
        """
        # Named columns, which a ladder without a rung has too.
        return pd.DataFrame([_rung(rung) for rung in self.content["ladder"]], columns=_LADDER)

    @property
    def suspects(self) -> pd.DataFrame:
        """The doubtful tests.

        Returns
        -------
        DataFrame
            One row for each: specimen, temperature_C, frequency_Hz, status, reasons, decided_by.
        """
        rows = [{**one, "reasons": "; ".join(one["reasons"])} for one in self.content["suspect_tests"]]
        names = ["specimen", "temperature_C", "frequency_Hz", "status", "reasons", "decided_by"]
        return pd.DataFrame(rows, columns=names)

    @property
    def limits(self) -> pd.DataFrame:
        """The least amplitude of each cause that these data would show in 19 of 20 cases.

        Returns
        -------
        DataFrame
            One row for each cause and place: cause, confined_to, where (a specimen or degC), value [unit],
            unit.
        """
        rows = []
        for cause, limit in self.content["detection_limits"].items():
            for where, value in limit.get("places", {"": limit["value"]}).items():
                rows.append((cause, limit.get("confined_to", ""), where, value, limit["unit"]))
        return pd.DataFrame(rows, columns=["cause", "confined_to", "where", "value", "unit"])

    @property
    def residuals(self) -> pd.DataFrame:
        """Measured and simulated moduli of each test used.

        Returns
        -------
        DataFrame
            One row for each test: measured, simulated before and after, and ln(measured / simulated) in % and
            degrees.
        """
        return self.outcome.residuals

    @property
    def causality(self) -> pd.DataFrame:
        """The phase that causality allows each test (Kramers and Kronig).

        Returns
        -------
        DataFrame
            One row for each test: phase measured, and phase that its |E*| and its isotherm require [degrees].
        """
        return self.outcome.causality

    @property
    def laws(self) -> pd.DataFrame:
        """How well each law follows the tests.

        Returns
        -------
        DataFrame
            One row for each law that can be fitted: its number of parameters, mean relative errors [%], and
            whether it is `law`.
        """
        return pd.DataFrame(self.content["laws"])

    @cached_property
    def law(self) -> Law | None:
        """The law of the mix without the named causes, with a shift.

        Returns
        -------
        Law or None
            None where one isotherm was tested.
        """
        return None if self.outcome.law is None else Law(self.outcome.law)

    def plot_black(self) -> Figure:
        """Draw the Black diagram and the Cole-Cole plane: points measured, lines simulated.

        Returns
        -------
        Figure
            A Matplotlib figure.
        """
        return self._figure("fig_black")

    def plot_master_curve(self) -> Figure:
        """Draw |E*| and phase against reduced frequency, and the shift factors.

        Returns
        -------
        Figure
            A Matplotlib figure.
        """
        return self._figure("fig_master")

    def plot_residuals(self) -> Figure:
        """Draw the residuals over temperature and frequency, before and after.

        Returns
        -------
        Figure
            A Matplotlib figure.
        """
        return self._figure("fig_residual_map")

    def verify_limits(self, processes: int | None = None, progress: Progress = lambda *_: None) -> Diagnosis:
        """The same with measured limits: each cause put into the tests at 1, 2 and 3 times its stated limit.

        Takes minutes.

        Parameters
        ----------
        processes : int, optional
            At once; one for each core if None. They change no number.
        progress : callable
            progress(stage, done, total), called after each.

        Returns
        -------
        Diagnosis
            With the table in `content["measured_limits"]`, which `write` writes as limits.csv.

        Raises
        ------
        InputError
            For a diagnosis that was read from files.
        """
        made, stated = self.outcome.diagnosis, self.content["provenance"]["scatter_stated"]
        # Files hold the answer, not what it was computed from.
        if made is None:
            raise InputError("This diagnosis was read from files; diagnose the measurements again.")
        scatter = None if stated is None else (float(stated[0]), float(stated[1]))
        trials = Trials(scatter, self.content["provenance"]["seed"], processes)
        return Diagnosis(self.outcome.add_limits(verify(made, trials, progress)))

    def to_json(self, path: str | Path | None = None) -> str:
        """The content of diagnosis.json as text.

        Parameters
        ----------
        path : path, optional
            Also written there, if one is given.

        Returns
        -------
        str
            JSON.
        """
        text = json.dumps(self.content, indent=2)
        if path is not None:
            write_json(path, self.content)
        return text

    def write(self, folder: str | Path) -> str:
        """Write diagnosis.json, residuals.csv, causality.csv, law.json, limits.csv if verified, and what is reported.

        Parameters
        ----------
        folder : path
            Made where it does not exist.

        Returns
        -------
        str
            What the command line prints.
        """
        return self.outcome.written(folder)

    def _figure(self, name: str) -> Figure:
        # By name: a step of the workflow that imports this module must not run again after a change to a figure.
        draw = import_module(f"asphalt_nscd.reporting.figures.{name}").draw
        # Figures are made from files, as in a study.
        with TemporaryDirectory() as folder:
            self.outcome.write(folder)
            files = [Path(folder) / "residuals.csv"], [Path(folder) / "diagnosis.json"]
            figure = draw(*files)
        return shown_in_notebooks(figure)

    @property
    def details(self) -> str:
        """The answer with its reasons.

        Returns
        -------
        str
            Text, as `asphalt-nscd diagnose --details` prints it.
        """
        return summary(self.content)

    def __str__(self) -> str:
        return answer(self.content)

    def __repr__(self) -> str:
        named = [
            f"{row.cause}{f' ({row.where})' if row.where else ''} {row.value:.3g} {row.unit} "
            f"({'established' if row.established else 'likely'})"
            for row in self.ladder.itertuples()
            # It stands for the law of the mix, and is no fault of a test.
            if row.cause != "relaxation_spectrum"
        ]
        aside = self.content["trust"]["not_used"]
        used = counted(self.content["tests"], "test")
        return f"Diagnosis({self.verdict}: {'; '.join(named) or 'no cause named'}; {used} used, {aside} not used)"

    def _repr_html_(self) -> str:
        from html import escape

        ladder = self.ladder[["cause", "where", "value", "std_error", "unit", "p_value", "established"]]
        parts = [
            f"<p><b>{escape(label)}</b><br>{'<br>'.join(map(escape, said))}</p>"
            for label, said in rows(self.content)
        ]
        parts.append(ladder.to_html(index=False, float_format="{:.3g}".format, na_rep=""))
        if len(self.suspects):
            parts += [
                "<p>Doubtful tests:</p>",
                self.suspects.to_html(index=False, float_format="{:g}".format),
            ]
        if self.notes:
            items = "".join(f"<li>{escape(note)}</li>" for note in self.notes)
            parts.append(f"<details><summary>Notes</summary><ul>{items}</ul></details>")
        return "".join(parts)


_ERRORS = ("E", "phase")
_LADDER = [
    "cause",
    "where",
    "parameter",
    "value",
    "std_error",
    "unit",
    "p_value",
    *(f"error_{q}_{when}_percent" for q in _ERRORS for when in ("before", "after")),
    "established",
    "as_good",
    "hangs_on",
    "doubts",
    "sentence",
    "confirmed_by",
]


def _rung(rung: Mapping[str, Any]) -> dict[str, Any]:
    """A row of the ladder, in the columns of _LADDER."""
    # A cause gives its amplitude first (`causes._cause.Cause`).
    name, amplitude = next(iter(rung["parameters"].items()))
    inside = mean_averages(rung["gain"]["in_sample"])
    return {
        "cause": rung["cause"],
        "where": "" if rung["where"] is None else rung["where"],
        "parameter": name,
        "value": amplitude["value"],
        "unit": amplitude["unit"],
        "std_error": np.nan if amplitude["std_error"] is None else amplitude["std_error"],
        "p_value": rung["p_value"],
        **{
            f"error_{q}_{when}_percent": inside[f"mre_{q}_percent"][when]
            for q in _ERRORS
            for when in ("before", "after")
        },
        "established": bool(rung["established"]),
        "as_good": ", ".join(rung["as_good"]),
        "hangs_on": ", ".join(map(str, rung["hangs_on"])),
        "doubts": ". ".join(rung["doubts"]),
        "sentence": rung["sentence"],
        "confirmed_by": rung["confirmed_by"],
    }


@checked
def diagnose(
    measurements: Measurements,
    *,
    measured_in: str | None = None,
    geometry: str | Path | Mapping[str, Any] = PAPER_GEOMETRY,
    known: Known = Known(),  # noqa: B008  frozen, and the next two
    simulated: Simulated = Simulated(),  # noqa: B008
    draws: Draws = Draws(),  # noqa: B008
    progress: Progress = lambda *_: None,
) -> Diagnosis:
    """Say which tests can be trusted, what is wrong with the others, which law they follow and what to test next.

    Parameters
    ----------
    measurements : path, folder, several of them, or DataFrame
        The tests, read as `read` says.
    measured_in : str, optional
        "bending", "tension-compression", "four-point bending" or "indirect tension"; else what the files say, and
        bending of a DataFrame of one's own.
    geometry : mapping or path
        b_mm, B_mm, e_mm, h_mm, mass_kg, mobile_mass_kg of the specimens, or a table of them; of ready moduli only the
        form factor counts.
    known : Known
        Static modulus and scatter, where they are known beside the table, and the form of the law.
    simulated : Simulated
        What was simulated of the same tests.
    draws : Draws
        Of the chance level: how many, and their seed.
    progress : callable
        progress(stage, done, total), called as the work goes on.

    Returns
    -------
    Diagnosis
        `str` of it is what the command line prints.

    Raises
    ------
    InputError
        With one sentence, for tables that cannot be diagnosed.

    Examples
    --------
    >>> diagnosis = diagnose("data/tutorial/exports", draws=Draws(500))
    >>> diagnosis
    Diagnosis(explained: channel_delay 0.000787 s (established); 71 tests used, 1 not used)
    >>> diagnosis.ladder[["cause", "error_E_before_percent", "error_E_after_percent"]].round()
                     cause  error_E_before_percent  error_E_after_percent
    0  relaxation_spectrum                    16.0                    3.0
    1        channel_delay                     3.0                    0.0
    """
    scatter, static = known.scatter, known.static_modulus_MPa
    stated = None if scatter is None else (scatter[0] / 100.0, float(np.radians(scatter[1])))
    return Diagnosis(
        conclude(
            campaign_in(measurements, measured_in=measured_in),
            geometry,
            stated=Stated(
                None if static is None else 1e6 * static,
                stated,
                known.law,
                known.vma_percent,
                known.vfa_percent,
            ),
            simulated=simulated,
            draws=draws,
            progress=progress,
        )
    )
