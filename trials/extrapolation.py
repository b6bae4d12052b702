"""Do the intervals of what is reported hold the mix, where it was not tested too?

    python -m extrapolation 10 40 100 --seed 20281128 --folder results/extrapolation

Four populations, each of three temperatures: T 378 campaigns of invented 2S2P1D mixes, whose specimens and tests
scatter and have no other error; such campaigns of mixes and errors as wide as the diagnosis takes for usual; tables as
laboratories hand them over (`attack.laboratory`, no law and no shift of the diagnosis), thinned; and the 25 measured
mixes of data/mixes50, of whose five temperatures three are given and all are asked for.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path

import numpy as np
import pandas as pd
from attack.laboratory import CYLINDER, everyday, written
from attack.mixes import LAWS, SHIFTS, Complex, Mix, Vector

import asphalt_nscd as an
from asphalt_nscd.diagnosis.criteria import LABORATORY
from asphalt_nscd.rheology.priors import REFERENCE_TEMPERATURE, USUAL
from asphalt_nscd.rheology.spectrum_io import DEPARTURE, DEPARTURE_KELVIN

T_378 = ((4.0, (0.1, 1.0, 10.0)), (20.0, (0.1, 1.0, 10.0)), (40.0, (0.01, 0.1, 1.0, 10.0)))
THINNED = (4.4, 21.1, 37.8)  # degC
FREQUENCIES = ((0.1, 1.0, 10.0), (0.1, 0.5, 1.0, 5.0, 10.0, 25.0))  # Hz
MISSING = 0.1  # share of the tests of a thinned table
LEVEL, PHASE_DEG, SINGLE, SINGLE_DEG = 0.05, 0.3, 0.012, 0.25  # of a specimen; of a test
LOG_TAU = -2.2, -0.5  # of s
COLUMNS = ["specimen", "temperature_C", "frequency_Hz", "E_MPa", "phase_deg"]
Response = Callable[..., Complex]
Table = tuple[str, pd.DataFrame, Response]


def invented(number: int, seed: int) -> Iterator[Table]:
    """Mixes of 2S2P1D laws drawn about published ones, with WLF shifts."""
    rng, none = np.random.default_rng(seed), dict.fromkeys(LABORATORY, 0.0)
    for k in range(number):
        mix = drawn_mix(rng)
        yield f"invented {k + 1}", campaign(mix, none, rng, np.random.default_rng(0)), mix


def usual(number: int, seed: int) -> Iterator[Table]:
    """Mixes and errors of laboratories as wide as the diagnosis takes for usual."""
    sizes = {kind: one.size for kind, one in LABORATORY.items()}
    for k in range(number):
        rng = np.random.default_rng([seed, k])
        mix = usual_mix(rng)
        yield f"usual {k + 1}", campaign(mix, sizes, rng, rng), mix


def drawn_mix(rng: np.random.Generator) -> Response:
    """A mix about published ones."""
    static, glassy = rng.uniform(20.0, 150.0), rng.uniform(22e3, 32e3)
    delta, k, h = rng.uniform(1.8, 2.6), rng.uniform(0.17, 0.23), rng.uniform(0.5, 0.65)
    tau, beta = 10.0 ** rng.uniform(*LOG_TAU), 10.0 ** rng.uniform(1.5, 3.0)
    c1, c2 = rng.uniform(14.0, 26.0), rng.uniform(110.0, 180.0)
    return of_2s2p1d(static, glassy, delta, k, h, tau, beta, c1, c2)


def usual_mix(rng: np.random.Generator) -> Response:
    """A mix of the priors of law.json, whose shift leaves WLF by as much as its band takes for usual."""
    p = {"k": 1.0, "h": 0.0}
    while not p["k"] <= p["h"] < 1.0:
        p = {name: one.median * np.exp(one.deviation * rng.standard_normal()) for name, one in USUAL.items()}
    # There C1 and C2 are at 15 degC.
    c2 = p["c2"] + 20.0 - REFERENCE_TEMPERATURE
    c1 = p["wlf_slope"] * p["c2"] ** 2 / c2
    moduli, tau = (p["static_modulus"] * 1e-6, p["glassy_modulus"] * 1e-6), 10.0 ** rng.uniform(*LOG_TAU)
    off = DEPARTURE * rng.standard_normal()
    return of_2s2p1d(*moduli, p["delta"], p["k"], p["h"], tau, p["beta"], c1, c2, off)


def of_2s2p1d(
    static: float,
    glassy: float,
    delta: float,
    k: float,
    h: float,
    tau: float,
    beta: float,
    c1: float,
    c2: float,
    departure: float = 0.0,
) -> Response:
    """E* [MPa] at temperature [degC], frequency [Hz] and ln of a factor on all times, about 20 degC.

    `departure`: of ln a_T from WLF, DEPARTURE_KELVIN away.
    """

    def mix(t: Vector, f: Vector, slower: float = 0.0) -> Complex:
        off = np.exp(slower + departure * ((t - 20.0) / DEPARTURE_KELVIN) ** 3)
        s = 2j * np.pi * f * tau * 10.0 ** (-c1 * (t - 20.0) / (c2 + t - 20.0)) * off
        return static + (glassy - static) / (1.0 + delta * s**-k + s**-h + 1.0 / (s * beta))

    return mix


def campaign(
    mix: Response, sizes: Mapping[str, float], rng: np.random.Generator, laboratory: np.random.Generator
) -> pd.DataFrame:
    """Tests of three specimens, which `rng` draws with their scatter; errors of these sizes are the `laboratory`'s."""

    def error(kind: str) -> float:
        return sizes[kind] * laboratory.standard_normal()

    chamber, rows = {t: error("isotherm temperature") for t, _ in T_378}, []
    for specimen in "ABC":
        level, phase = rng.normal(0.0, LEVEL), rng.normal(0.0, PHASE_DEG)
        slower = error("specimen times")
        for t, frequencies in T_378:
            warm = t + chamber[t] + error("specimen temperature")
            mounted, turned = error("mounting, modulus"), np.degrees(error("mounting, phase"))
            for f in frequencies:
                star = mix(warm, f, slower) * np.exp(level + mounted + rng.normal(0.0, SINGLE))
                angle = np.degrees(np.angle(star)) + phase + turned + rng.normal(0.0, SINGLE_DEG)
                rows.append((specimen, t, f, abs(star), angle))
    return pd.DataFrame(rows, columns=COLUMNS)


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
        try:
            diagnosis = an.diagnose(tests, measured_in="tension-compression", draws=an.Draws(draws))
        except an.InputError as refusal:  # at the ends of the priors
            print(f"{name}: {refusal}")
            continue
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
    parser.add_argument("usual", type=int)
    parser.add_argument("thinned", type=int)
    parser.add_argument("--seed", type=int, required=True)
    parser.add_argument("--measured", type=Path, help="modulus.csv of data/mixes50")
    parser.add_argument("--folder", type=Path, required=True)
    given = parser.parse_args(arguments)
    populations = [invented(given.invented, given.seed), usual(given.usual, given.seed)]
    populations += [thinned(given.thinned, given.seed)]
    populations += [measured(given.measured)] if given.measured else []
    rows = pd.concat([held(one) for one in populations], ignore_index=True)
    given.folder.mkdir(parents=True, exist_ok=True)
    rows.round(4).to_csv(given.folder / "grid.csv", index=False, lineterminator="\n")
    summary(rows).round(2).to_csv(given.folder / "summary.csv", index=False, lineterminator="\n")


if __name__ == "__main__":
    main()
