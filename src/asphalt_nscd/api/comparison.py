"""Several mixes beside each other: one diagnosis each, their curves at one temperature, and who is stiffer."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import combinations
from pathlib import Path

import numpy as np
import pandas as pd

from asphalt_nscd.api.arguments import checked
from asphalt_nscd.api.diagnosis import Diagnosis, diagnose
from asphalt_nscd.api.tables import Measurements
from asphalt_nscd.diagnosis.criteria import CONFIDENCE
from asphalt_nscd.diagnosis.machine.common_faults import Pooled
from asphalt_nscd.diagnosis.machine.pooled import pool
from asphalt_nscd.diagnosis.observed.copies import refuse_copied_campaign
from asphalt_nscd.diagnosis.record.mixture import Mixture
from asphalt_nscd.diagnosis.record.reported import EN_12697_26, master_curve, mix_modulus, table_of, tested
from asphalt_nscd.diagnosis.settings import Draws, Known
from asphalt_nscd.diagnosis.words import sentences
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.store import write_table

DRAWS = 20_000  # of the moduli, for the ranks
# What a client asks at which temperature [degC], at the frequency of EN 12697-26.
ASKED = {15.0: "stiffness, EN 12697-26", 20.0: "fatigue", 40.0: "rutting", 50.0: "rutting"}
Progress = Callable[[str, float, float], None]


@dataclass(frozen=True)
class Comparison:
    """Several mixes beside each other.

    Parameters
    ----------
    diagnoses : mapping of str to Diagnosis
        By the name of the mix.

    Examples
    --------
    >>> both = compare(["data/ncat/N1-1_RH.csv", "data/ncat/N2-1_RH.csv"])  # doctest: +SKIP
    """

    diagnoses: Mapping[str, Diagnosis]

    def same_machine(self, draws: Draws = Draws()) -> Pooled:  # noqa: B008  frozen
        """What one machine does to all of these campaigns; for campaigns that it alone has tested.

        Parameters
        ----------
        draws : Draws
            Of the chance level.

        Returns
        -------
        Pooled
            `str` of it says what was found; its `table` has the sizes from each campaign, isotherm and frequency.

        Raises
        ------
        InputError
            For diagnoses that were read from files.
        """
        made = {name: one.outcome.diagnosis for name, one in self.diagnoses.items()}
        known = {name: one for name, one in made.items() if one is not None}
        if len(known) < len(made):
            raise InputError("These diagnoses were read from files; compare the measurements again.")
        return pool(known, draws.number, draws.seed)

    @property
    def table(self) -> pd.DataFrame:
        """The mixes by their modulus at 15 degC and 10 Hz.

        Returns
        -------
        DataFrame
            One row for each mix, the stiffest first: |E*| [MPa] and phase [degrees] of the mix, certain causes
            taken off and possible ones by their probability, with 95 % intervals; test that gave it; verdict;
            causes that are certain; possible ones with their probability; tests, those to check first, those left
            out.
            rank_low, rank_high: 95 % interval of the rank, from what the moduli leave open.
        """
        rows = []
        for name, diagnosis in self.diagnoses.items():
            content = diagnosis.content
            named = [rung for rung in content["ladder"] if rung["cause"] != "relaxation_spectrum"]
            likely = [
                f"{sentences.cause_words(rung)} ({sentences.probability(rung)})"
                for rung in named
                if not rung["established"]
            ]
            rows.append(
                {
                    "mix": name,
                    "test": content["reading"]["test_type"],
                    **content["reported"],
                    "verdict": diagnosis.verdict,
                    "causes": ", ".join(sentences.cause_words(rung) for rung in named if rung["established"]),
                    "possible_causes": ", ".join(likely),
                    "tests": content["tests"],
                    "check_first": content["trust"]["check"],
                    "left_out": content["trust"]["not_used"],
                }
            )
        table = pd.DataFrame(rows).sort_values("E_MPa", ascending=False, ignore_index=True)
        low, high = _ranks(table)
        table.insert(1, "rank_low", low)
        table.insert(2, "rank_high", high)
        return table

    @property
    def curves(self) -> pd.DataFrame:
        """E* of each mix over its tested band at 15 degC.

        Returns
        -------
        DataFrame
            One row for each mix and frequency, with 95 % intervals.
        """
        return self._made_of_each(lambda mix: master_curve(mix, EN_12697_26[0]))

    @property
    def conditions(self) -> pd.DataFrame:
        """E* of each mix at the temperatures that clients ask for, where its tests reach.

        Returns
        -------
        DataFrame
            One row for each mix and condition, with 95 % intervals; asked_for says for what.
        """
        return self._made_of_each(_asked)

    @property
    def differences(self) -> pd.DataFrame:
        """By how much one mix is stiffer than another, where the tests of both reach.

        Returns
        -------
        DataFrame
            One row for each condition and pair of mixes, the stiffer at 15 degC first: |E*| of `mix` over that of
            `than` less one [%] with its 95 % interval, and whether zero lies outside it.
        """
        order, rows = list(self.table["mix"]), []
        for (at, hertz), own in self.conditions.groupby(["temperature_C", "frequency_Hz"]):
            own = own.set_index("mix")
            half = np.log(own["E_high_MPa"] / own["E_low_MPa"]) / 2.0
            for mix, than in combinations([name for name in order if name in own.index], 2):
                ratio = float(np.log(own["E_MPa"][mix] / own["E_MPa"][than]))
                off = float(np.hypot(half[mix], half[than]))
                ends = 100.0 * np.expm1([ratio, ratio - off, ratio + off])
                rows.append((at, hertz, mix, than, *ends, abs(ratio) > off))
        parts = [f"stiffer{end}_percent" for end in ("", "_low", "_high")]
        names = ["temperature_C", "frequency_Hz", "mix", "than", *parts, "told_apart"]
        return pd.DataFrame(rows, columns=names)

    def _made_of_each(self, make: Callable[[Mixture], pd.DataFrame]) -> pd.DataFrame:
        """What is made of each mix, its name first; of a diagnosis read from files nothing can be."""
        made = {name: one.outcome.mix for name, one in self.diagnoses.items()}
        parts = [make(one).assign(mix=name) for name, one in made.items() if one is not None]
        whole = pd.concat(parts, ignore_index=True)
        return whole[["mix", *(column for column in whole if column != "mix")]]

    def write(self, folder: str | Path, machine: Pooled | None = None) -> list[str]:
        """Write comparison.html and comparison.xlsx, and all that `diagnose` writes into a folder for each mix.

        Parameters
        ----------
        folder : path
            Made where it does not exist.
        machine : Pooled, optional
            What `same_machine` found; written as machine.csv too.

        Returns
        -------
        list of str
            Names of the files of the comparison.
        """
        from asphalt_nscd.api.written import write_all
        from asphalt_nscd.exports.formats.xlsx import write_sheets
        from asphalt_nscd.reporting.pages import comparison
        from asphalt_nscd.reporting.settings import Heading

        folder, table, curves = Path(folder), self.table, self.curves
        for name, diagnosis in self.diagnoses.items():
            own = folder / comparison.folder_of(name)
            write_all(diagnosis.outcome, own, f"Diagnosis of {name}", Heading(mix=name))
        conditions, differences = self.conditions, self.differences
        sheets = {"Ranking": table, "Conditions": conditions, "Differences": differences}
        sheets["Curves at 15 degC"] = curves
        if machine is not None:
            write_table(folder / "machine.csv", machine.table)
            sheets["Machine"] = machine.table
        write_sheets(folder / "comparison.xlsx", sheets)
        said = "" if machine is None else str(machine)
        comparison.write_page(folder / comparison.PAGE, table, curves, (conditions, differences), said)
        return [comparison.PAGE, "comparison.xlsx", *(["machine.csv"] if machine is not None else [])]


def _asked(mix: Mixture) -> pd.DataFrame:
    """E* of a mix at the conditions of ASKED that its tests reach."""
    temperature = np.array(list(ASKED))
    frequency = np.full(temperature.size, EN_12697_26[1])
    there = tested(mix, temperature, frequency)
    at = temperature[there], frequency[there]
    return table_of(*at, mix_modulus(mix, *at)).assign(asked_for=[ASKED[t] for t in at[0]])


def _ranks(table: pd.DataFrame) -> tuple[list[int], list[int]]:
    """95 % interval of the rank of each row, 1 for the stiffest."""
    # Intervals of |E*| are even on its logarithm, and 1.96 standard deviations to each side.
    size = np.log(table["E_high_MPa"] / table["E_low_MPa"]).to_numpy() / (2.0 * CONFIDENCE)
    # The same ranks at each call.
    random = np.random.default_rng(0)
    drawn = np.log(table["E_MPa"].to_numpy()) + size * random.standard_normal((DRAWS, len(table)))
    # Twice: the first gives the order, the second the place of each in it.
    ranks = 1 + np.argsort(np.argsort(-drawn, axis=1), axis=1)
    low, high = np.quantile(ranks, [0.025, 0.975], axis=0, method="nearest")
    return low.astype(int).tolist(), high.astype(int).tolist()


@checked
def compare(
    mixes: Mapping[str, Measurements] | Sequence[str | Path],
    *,
    measured_in: str | None = None,
    law: str = Known.law,
    draws: Draws = Draws(),  # noqa: B008  frozen
    progress: Progress = lambda *_: None,
) -> Comparison:
    """Diagnose several mixes, each a file or a folder, and set them beside each other.

    Parameters
    ----------
    mixes : mapping or list of paths
        By the name of the mix what `diagnose` takes; of a list the names are those of files and folders.
    measured_in : str, optional
        "bending", "tension-compression", "four-point bending" or "indirect tension"; else what the files say.
    law : str
        "2s2p1d", "huet-sayegh", "sigmoid" or "cam": the form of each mix's law.
    draws : Draws
        Of the chance level, as in `diagnose`.
    progress : callable
        progress(stage, done, total), called as the mixes are diagnosed.

    Returns
    -------
    Comparison
        Whose `table` ranks the mixes.

    Raises
    ------
    InputError
        With the name of the mix, where one cannot be diagnosed; of two mixes that hold the same tests.

    Examples
    --------
    >>> compare(["mix.csv"])
    Traceback (most recent call last):
    asphalt_nscd.files.errors.InputError: one mix is no comparison; give the files or folders of two or more.
    """
    paths = _named(mixes)
    found: dict[str, Diagnosis] = {}
    for n, (name, path) in enumerate(paths.items()):
        within = partial(_part_of, progress, n, len(paths))
        try:
            found[name] = diagnose(
                path, measured_in=measured_in, known=Known(law=law), draws=draws, progress=within
            )
        except InputError as error:
            raise InputError(f"mix {name}: {error}") from None
        made = {mix: one.outcome.diagnosis for mix, one in found.items()}
        refuse_copied_campaign({mix: one.whole or one.observed for mix, one in made.items() if one})
    return Comparison(found)


def _part_of(progress: Progress, mixes: int, total: int, _: str, done: float, steps: float) -> None:
    """Tell the progress of one diagnosis as a part of all."""
    progress("Compare", mixes + done / steps, total)


def _named(mixes: Mapping[str, Measurements] | Sequence[str | Path]) -> dict[str, Measurements]:
    """What to diagnose, by the name of the mix; refuses fewer than two, or two of one name."""
    paths = (
        mixes
        if isinstance(mixes, Mapping)
        else named_apart((name_of(path), path) for path in map(Path, mixes))
    )
    if len(paths) < 2:
        raise InputError("one mix is no comparison; give the files or folders of two or more.")
    return dict(paths)


def name_of(path: Path) -> str:
    """The name of a mix by its file or folder."""
    # A folder has no ending: "Mix 5.2" is no "Mix 5".
    return path.name if path.is_dir() else path.stem


def named_apart(mixes: Iterable[tuple[str, Measurements]]) -> dict[str, Measurements]:
    """What to diagnose by the name of the mix; refuses two of one name."""
    paths: dict[str, Measurements] = {}
    for name, measurements in mixes:
        if name in paths:
            of = f"{measurements}: " if isinstance(measurements, str | Path) else ""
            raise InputError(f"{of}two mixes are called {name}; rename one.")
        paths[name] = measurements
    return paths
