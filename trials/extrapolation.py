"""Do the intervals of what is reported hold the mix, where it was not tested too?

    python -m extrapolation 10 100 --seed 20281128 --folder results/extrapolation

Three populations, each of three temperatures: T 378 campaigns of invented 2S2P1D mixes; tables as laboratories hand
them over (`attack.laboratory`, no law and no shift of the diagnosis), thinned; and the 25 measured mixes of
data/mixes50, of whose five temperatures three are given and all are asked for.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pandas as pd
from attack.laboratory import CYLINDER, everyday, written
from attack.mixes import LAWS, SHIFTS, Mix

import asphalt_nscd as an

T_378 = ((4.0, (0.1, 1.0, 10.0)), (20.0, (0.1, 1.0, 10.0)), (40.0, (0.01, 0.1, 1.0, 10.0)))
THINNED = (4.4, 21.1, 37.8)  # degC
FREQUENCIES = ((0.1, 1.0, 10.0), (0.1, 0.5, 1.0, 5.0, 10.0, 25.0))  # Hz
MISSING = 0.1  # share of the tests of a thinned table
LEVEL, PHASE_DEG, SINGLE, SINGLE_DEG = 0.05, 0.3, 0.012, 0.25  # of a specimen; of a test
COLUMNS = ["specimen", "temperature_C", "frequency_Hz", "E_MPa", "phase_deg"]
Table = tuple[str, pd.DataFrame, "object"]


def invented(number: int, seed: int) -> Iterator[Table]:
    """Mixes of 2S2P1D laws drawn about published ones, with WLF shifts."""
    rng = np.random.default_rng(seed)
    for k in range(number):
        static, glassy = rng.uniform(20.0, 150.0), rng.uniform(22e3, 32e3)
        delta, k_, h = rng.uniform(1.8, 2.6), rng.uniform(0.17, 0.23), rng.uniform(0.5, 0.65)
        tau, beta = 10.0 ** rng.uniform(-2.2, -0.5), 10.0 ** rng.uniform(1.5, 3.0)
        c1, c2 = rng.uniform(14.0, 26.0), rng.uniform(110.0, 180.0)

        def mix(t, f, p=(static, glassy, delta, k_, h, tau, beta, c1, c2)):
            static, glassy, delta, k_, h, tau, beta, c1, c2 = p
            s = 2j * np.pi * f * tau * 10.0 ** (-c1 * (t - 20.0) / (c2 + t - 20.0))
            return static + (glassy - static) / (1.0 + delta * s**-k_ + s**-h + 1.0 / (s * beta))

        rows = []
        for specimen in "ABC":
            level, phase = rng.normal(0.0, LEVEL), rng.normal(0.0, PHASE_DEG)
            for t, frequencies in T_378:
                for f in frequencies:
                    star = mix(t, f) * np.exp(level + rng.normal(0.0, SINGLE))
                    angle = np.degrees(np.angle(star)) + phase + rng.normal(0.0, SINGLE_DEG)
                    rows.append((specimen, t, f, abs(star), angle))
        yield f"invented {k + 1}", pd.DataFrame(rows, columns=COLUMNS), mix


def thinned(number: int, seed: int) -> Iterator[Table]:
    """Laws and shifts of `attack.mixes` in turn, with the errors that no laboratory is without."""
    for k in range(number):
        rng = np.random.default_rng([seed, k])
        mix = Mix.draw(list(LAWS)[k % len(LAWS)], list(SHIFTS)[k % len(SHIFTS)], rng)
        every = [(s, t, f) for s in "ABC" for t in THINNED for f in FREQUENCIES[k % 2]]
        tests = pd.DataFrame([row for row in every if rng.random() > MISSING], columns=COLUMNS[:3])
        campaign = everyday(f"thinned {k + 1}", CYLINDER, tests, mix, rng)

        def of_mix(t, f, mix=mix):
            return np.exp(mix.log_modulus(np.asarray(f), np.asarray(t))) * 1e-6

        yield campaign.name, written(campaign, campaign.unmoved()), of_mix


def measured(path: str | Path) -> Iterator[Table]:
    """Averages of replicates as one specimen; the tests left out are what the mix has."""
    for name, rows in pd.read_csv(path).groupby("mix"):
        given = rows[rows["temperature_C"].isin(THINNED)].assign(specimen="average")
        star = rows.set_index(["temperature_C", "frequency_Hz"])[["E_MPa", "phase_deg"]]

        def of_mix(t, f, star=star):
            there = star.reindex(pd.MultiIndex.from_arrays([t, f]))
            return there["E_MPa"].to_numpy() * np.exp(1j * np.radians(there["phase_deg"].to_numpy()))

        yield f"measured {name}", given[COLUMNS], of_mix


def held(tables: Iterator[Table], draws: int = 500) -> pd.DataFrame:
    """One row for each table and condition of the grid: the mix, what is reported, whether the interval holds it."""
    rows = []
    for name, tests, mix in tables:
        diagnosis = an.diagnose(tests, measured_in="tension-compression", draws=an.Draws(draws))
        grid = diagnosis.outcome.to_report["reported"].query("asked_by != 'the tests'")
        star = mix(grid["temperature_C"].to_numpy(), grid["frequency_Hz"].to_numpy())
        norm, phase = np.abs(star), np.degrees(np.angle(star))
        rows.append(
            grid.assign(
                table=name,
                mix_E_MPa=norm,
                mix_phase_deg=phase,
                E_held=(grid["E_low_MPa"] <= norm) & (norm <= grid["E_high_MPa"]),
                phase_held=(grid["phase_low_deg"] <= phase) & (phase <= grid["phase_high_deg"]),
            )[np.isfinite(norm)]
        )
    return pd.concat(rows, ignore_index=True)


def summary(rows: pd.DataFrame) -> pd.DataFrame:
    """Shares that the intervals hold, by population and temperature, and of all of a population."""
    population = rows["table"].str.split().str[0]
    wide = np.log(rows["E_high_MPa"] / rows["E_low_MPa"]) / 2.0
    about = rows.assign(
        population=population,
        tables=rows["table"],
        E_error=(np.log(rows["E_MPa"] / rows["mix_E_MPa"])).abs() * 100.0,
        E_half=wide * 100.0,
        phase_error=(rows["phase_deg"] - rows["mix_phase_deg"]).abs(),
        phase_half=(rows["phase_high_deg"] - rows["phase_low_deg"]) / 2.0,
    )
    parts = [
        about.assign(at="-10 to 54 degC"),
        about.assign(at=about["temperature_C"].map("{:g} degC".format)),
    ]
    found = pd.concat(parts).groupby(["population", "at"], sort=False)
    return found.agg(
        tables=("tables", "nunique"),
        values=("E_held", "size"),
        E_held_percent=("E_held", lambda held: 100.0 * held.mean()),
        phase_held_percent=("phase_held", lambda held: 100.0 * held.mean()),
        E_off_percent=("E_error", "median"),
        E_half_percent=("E_half", "median"),
        phase_off_deg=("phase_error", "median"),
        phase_half_deg=("phase_half", "median"),
    ).reset_index()


def main(arguments: list[str] | None = None) -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("invented", type=int)
    parser.add_argument("thinned", type=int)
    parser.add_argument("--seed", type=int, required=True)
    parser.add_argument("--measured", type=Path, help="modulus.csv of data/mixes50")
    parser.add_argument("--folder", type=Path, required=True)
    given = parser.parse_args(arguments)
    populations = [invented(given.invented, given.seed), thinned(given.thinned, given.seed)]
    populations += [measured(given.measured)] if given.measured else []
    rows = pd.concat([held(one) for one in populations], ignore_index=True)
    given.folder.mkdir(parents=True, exist_ok=True)
    rows.round(4).to_csv(given.folder / "grid.csv", index=False, lineterminator="\n")
    summary(rows).round(2).to_csv(given.folder / "summary.csv", index=False, lineterminator="\n")


if __name__ == "__main__":
    main()
