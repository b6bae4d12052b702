"""What particles say: samples and bonds (section 3), numerics (3.2.2), results (4)."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import pandas as pd

from asphalt_nscd.files.store import Record
from asphalt_nscd.files.words import counted, joined
from asphalt_nscd.measurements.twopoint import PAPER
from asphalt_nscd.reporting.figures.records import last_cycle
from asphalt_nscd.reporting.tables import time_steps
from asphalt_nscd.specimen.system import affine_poisson
from studies.paper.bond_readings import AFTER, BARYCENTRES, MEAN_RADIUS, OURS
from studies.paper.equations import ELASTIC_TIME, TIME_STEP
from studies.paper.finding import INCONSISTENT, LEFT_OPEN, UNCHECKED, Finding, spanned

BOX = (0.25, 0.025, 1.6)  # m
CELL = 0.010  # m
LAYER = 0.060  # m
LAYER_FRACTION = 0.695  # solid fraction of Table 2's spheres in a layer so high
SPHERES = 14_160
KEPT = 12_000
DENSITY = 3415.0  # kg/m3
REDUCTION = 0.10
LIFT = 4e-3  # m, difference of the largest and the smallest radius of Table 2
SEGREGATED = 0.05  # of the height of the layer
POISSON = 0.35
DENSITY_TOLERANCE, COUNT_TOLERANCE = 0.03, 0.05
LARGEST = 0.010  # m, diameter
PAPER_COST = 2e-4  # CPU s per particle and step
CYCLE_HZ = 10.0  # of the test whose cost is measured


def lattice(count: np.ndarray) -> Finding:
    """count (s,): Table 2."""
    # 1e-9: a side of whole cells must not lose one to rounding.
    cells = int(np.prod(np.floor(np.array(BOX) / CELL + 1e-9)))
    return Finding("lattice", int(count.sum()), values={"cells": cells})


def grading(curve: pd.DataFrame, diameter: np.ndarray, count: np.ndarray) -> Finding:
    """Volumes of Table 2's spheres, diameter (s,) [m] and count (s,), against what the sieves of Table 1 retain."""
    curve = curve.sort_values("diameter_mm")
    retained = pd.Series(np.diff(curve["passing_percent"], append=100.0), index=curve["diameter_mm"])
    volume = pd.Series(count * diameter**3, index=(1e3 * diameter).round(9))
    retained = retained[volume.index]
    apart = (volume / volume.sum() / (retained / retained.sum()) - 1.0).abs()
    return Finding("counts", 100.0 * float(apart.max()), values={"diameter": apart.idxmax()})


def samples(
    deposits: Sequence[Mapping[str, Any]], specimens: Sequence[Mapping[str, Any]], moved: np.ndarray
) -> Iterator[Finding]:
    """The poured and trimmed samples, from the attributes of their files.

    moved (n, 3): share of the squared displacements by vibration that the top of each layer has, see `moved_on_top`.
    """
    # The paper's layer has this many; what fewer spheres do says nothing of it.
    full = all(deposit["spheres"] == SPHERES for deposit in deposits)
    for row in [*_of_layers(deposits, moved), *_of_specimens(specimens)]:
        values = {**row.values, "fewer": None if full or row.verdict == INCONSISTENT else ""}
        yield replace(row, values=values, verdict=row.verdict if values["fewer"] is None else UNCHECKED)


def _of_layers(deposits: Sequence[Mapping[str, Any]], moved: np.ndarray) -> Iterator[Finding]:
    height, poured, fraction, segregation = (
        float(np.mean([deposit[name] for deposit in deposits]))
        for name in ("layer_height_m", "poured_layer_height_m", "solid_fraction", "poured_segregation")
    )
    small, of_size = abs(segregation) < SEGREGATED, LIFT / poured
    unclear = SEGREGATED <= abs(segregation) < SEGREGATED + of_size
    values = {"lift_mm": 1e3 * LIFT, "of_size": of_size, "none": SEGREGATED, "sure": SEGREGATED + of_size}
    yield Finding("segregation", segregation, UNCHECKED if unclear else small, values)
    values = {"samples": len(deposits), "fraction": fraction, "of_paper": LAYER_FRACTION}
    values["sunk_mm"] = 1e3 * (poured - height)
    values["touched"] = min(deposit["periods_with_contact"] for deposit in deposits)
    values["overlap"] = max(deposit["largest_overlap_moving_m"] for deposit in deposits)
    yield Finding("layer", height, abs(height - LAYER) <= 0.01 * LAYER, values)
    shares = zip(("one", "two", "half"), 100.0 * np.asarray(moved).T, strict=True)
    told = {name: spanned(share, ".0f") for name, share in shares}
    yield Finding("top_layers", 100.0 * float(np.mean(moved, axis=0)[0]), values=told)


def _of_specimens(specimens: Sequence[Mapping[str, Any]]) -> Iterator[Finding]:
    spheres = np.array([specimen["spheres"] for specimen in specimens])
    density = float(np.mean([specimen["density"] for specimen in specimens]))
    trapezoid = 0.5 * (PAPER.b + PAPER.B) * PAPER.e * PAPER.h
    share = trapezoid / (BOX[0] * BOX[1] * LAYER)
    left = round(share * SPHERES)
    verdict = INCONSISTENT if abs(left / KEPT - 1.0) > COUNT_TOLERANCE else True
    values = {"fewest": spheres.min(), "most": spheres.max(), "share": 100.0 * share, "left": left}
    yield Finding("particles_kept", float(spheres.mean()), verdict, values)
    solid = PAPER.mass / DENSITY / trapezoid
    reduced = LAYER_FRACTION * (1.0 - REDUCTION)
    verdict = INCONSISTENT if abs(solid / reduced - 1.0) > DENSITY_TOLERANCE else True
    values = {"solid": solid, "layer": LAYER_FRACTION, "reduced": reduced}
    yield Finding("density", density, verdict, values | {"unreduced": density * (1.0 - REDUCTION)})


def moved_on_top(deposit: Mapping[str, np.ndarray]) -> list[float]:
    """Shares (3,) of the squared displacements from the poured to the vibrated layer: of one and of two layers of the
    largest grains on top, and of the upper half.
    """
    height = deposit["poured_position"][:, 2]
    moved = ((deposit["position"] - deposit["poured_position"]) ** 2).sum(axis=1)
    depths = LARGEST, 2.0 * LARGEST, 0.5 * height.max()
    return [float(moved[height > height.max() - depth].sum() / moved.sum()) for depth in depths]


def bonds(readings: pd.DataFrame) -> Iterator[Finding]:
    """What the paper says of its bonds. readings: bond_readings.csv."""
    usual = _usual(readings)["E_over_law"]
    yield Finding("barycentre", f"{usual[BARYCENTRES]:.4g} or {usual[OURS]:.4g}")
    yield Finding("tangential", affine_poisson(0.5 / (1.0 + POISSON)))


def _usual(readings: pd.DataFrame) -> pd.DataFrame:
    """By reading, those of samples poured with the paper's friction."""
    return readings[readings["friction"] == readings["friction"].iloc[0]].set_index("reading")


def contacts(tests: pd.DataFrame) -> Finding:
    """tests: simulations.csv."""
    gap = float(tests["smallest_gap_m"].min())
    return Finding("both_act", 1e6 * gap, UNCHECKED if gap > 0.0 else True)


def numerics(tests: pd.DataFrame, table: pd.DataFrame, costs: pd.DataFrame) -> Iterator[Finding]:
    """Time step and cost. table: time_steps.csv; costs: the published benchmark.csv, of a cycle of 10 Hz."""
    steps = tests.groupby("frequency_Hz")["steps"].first()
    # The paper's numbers, which are those of five cycles.
    printed = {f: value for f, value in {3.0: 3.33e4, 40.0: 2.5e3}.items() if f in steps.index}
    apart = [abs(steps[f] / value - 1.0) for f, value in printed.items()]
    yield Finding("steps", ", ".join(str(int(steps[f])) for f in printed), bool(apart) and max(apart) < 0.002)
    solved, swept = (table[table["scheme"] == name] for name in (time_steps.SOLVED, time_steps.SWEPT))
    ratio, right = swept["E_over_solution"], int(swept["right"].sum())
    values: dict[str, Any] = {"scale": ELASTIC_TIME, "step": TIME_STEP}
    values["longest"] = longest_step(table, time_steps.SOLVED)
    values |= {"wrong": None if right else spanned(ratio, ".2g"), "right": right or None, "pairs": len(swept)}
    spread = float(solved["E_over_solution"].max() / solved["E_over_solution"].min() - 1.0)
    yield Finding("time_step", 100.0 * spread, values=values)
    by_tolerance = [
        f"{spanned(rows['E_over_solution'], '.2g')} of the solved |E*| at {tolerance:g}"
        for tolerance, rows in swept.groupby("tolerance", sort=False)
    ]
    values = {"by_tolerance": joined(by_tolerance), "spheres": int(swept["spheres"].iloc[0])}
    values["sweeps"] = spanned(swept["sweeps_per_step"], ".0f")
    yield Finding("stable_reactions", f"{ratio.min():.2g} to {ratio.max():.2g}", values=values)
    cycles = costs[costs["topic"] == "cycle of 10 Hz"].set_index("case")
    each = cycles["cpu_s"] * cycles["time_step_s"] * CYCLE_HZ / cycles["spheres"]  # s a step and sphere
    cost, sweep = each["reduced, Burgers"], each["sweeps"]
    bound = "less than a tenth of it" if sweep < 0.1 * PAPER_COST else "a tenth of it or more"
    values = {"reduced": "less" if cost < sweep else "more", "residual": tests["residual"].max()}
    yield Finding("cpu_time", bound, values=values)


def longest_step(table: pd.DataFrame, scheme: str) -> float:
    """The longest step [s] that a scheme can take. table: time_steps.csv."""
    return float(table.set_index("scheme")["time_step_s"][f"{scheme}, longest"])


def laws_and_samples(
    tests: pd.DataFrame,
    packing: pd.DataFrame,
    readings: pd.DataFrame,
    facets: pd.DataFrame | None = None,
    blocked: Sequence[float] = (),
) -> Iterator[Finding]:
    """How the simulation returns the law it was given.

    tests: simulations.csv; packing: packing.csv; readings: bond_readings.csv; facets: the tests of simulations.csv with
    bonds that are facets; blocked: |E*| over that with a free head, where the head cannot turn.
    """
    ratio = _ratios(tests)
    by_sample = ratio.groupby(tests["specimen"])
    paper = packing[packing["mapping"] == "paper"] if "mapping" in packing else packing
    seen = [
        f"{row.E_MPa / row.E_law_MPa:.3f} at {row.solid_fraction:.3f}"
        for row in paper.sort_values("solid_fraction").itertuples()
    ]
    near = abs(float(ratio.mean()) - 1.0) < 0.05
    values: dict[str, Any] = {"by_sample": spanned(by_sample.mean(), ".3f"), "packings": ", ".join(seen)}
    usual, possible = _usual(readings), readings[readings["possible"]]
    for name, reading in (("ours", OURS), ("after", AFTER)):
        row = usual.loc[reading]
        columns = {"mm": "gap_max_mm", "bonds": "bonds", "ratio": "E_over_law"}
        values |= {f"{name}_{kind}": row[column] for kind, column in columns.items()}
    rows = [f"{row.reading}, friction {row.friction:g}: {row.expected:.3f}" for row in possible.itertuples()]
    values |= {"possible": "; ".join(rows) or None, "blocked": spanned(blocked, ".2f")}
    values["crossed"] = usual.loc[OURS, "through_third_sphere_percent"]
    values["mean_radius"] = usual.loc[MEAN_RADIUS, "E_over_law"]
    remapped = () if facets is None else _ratios(facets).groupby(facets["specimen"]).mean()
    values["facets"] = spanned(remapped, ".3f")
    verdict = LEFT_OPEN if not near and rows else near
    yield Finding("macro_is_micro", float(ratio.mean()), verdict, values)
    yield Finding("one_ratio", 100.0 * float((by_sample.max() / by_sample.min() - 1.0).max()))
    whole = tests.loc[ratio.index]
    yield Finding("fluctuations", float((whole["phase_deg"] - whole["phase_law_deg"]).abs().max()))
    broken = tests[tests["broken_bonds"] > 0]
    values = {"tests": counted(len(tests), "test"), "number": len(broken), "lost": None}
    values["break"] = "test breaks" if len(broken) == 1 else "tests break"
    values["where"] = joined([f"{t:g}" for t in sorted(broken["temperature_C"].unique())]) or "none"
    if not broken.empty:
        most = tests.loc[tests["broken_bonds"].idxmax()]
        values |= {"lost": int(most["broken_bonds"]), "sample": most["specimen"]}
        values |= {"left": most["E_MPa"] / most["E_law_MPa"], "before": by_sample.mean()[most["specimen"]]}
    yield Finding("yield_stress", int(tests["broken_bonds"].sum()), broken.empty, values)


def _ratios(tests: pd.DataFrame) -> pd.Series:
    """|E*| over that of the law, of the tests in which no bond breaks."""
    whole = tests[tests["broken_bonds"] == 0]
    return whole["E_MPa"] / whole["E_law_MPa"]


def agreement(table: pd.DataFrame, refit: pd.DataFrame) -> Iterator[Finding]:
    """Table 4. table: table4.csv; refit: errors of Burgers laws refitted to the same data."""
    cold = table.loc[table["temperature_C"].idxmin()]
    values: dict[str, Any] = {}
    for name, column in table.filter(like="mre_").items():
        errors = " ".join(f"{value:.3g}" for value in column)
        values[str(name).removeprefix("mre_").removesuffix("_percent")] = errors
    values |= {"data": joined(sorted(table["compared_with"].unique())), "coldest": cold["temperature_C"]}
    refitted = float(refit.set_index("temperature_C")["mre_phase_percent"][cold["temperature_C"]])
    values |= {"published": float(cold["mre_phase_published_percent"]), "refitted": refitted}
    yield Finding("fig10", float(cold["mre_phase_simulated_percent"]), values=values)
    mean = float(np.mean(table["mre_phase_published_percent"]))
    yield Finding("burgers_describes", "not known", values={"mean": mean})
    yield Finding("table3_fit", refitted, values={key: values[key] for key in ("coldest", "data")})


def reduction(tests: pd.DataFrame) -> Finding:
    """Peaks against harmonics. tests: simulations.csv."""
    modulus = 100.0 * float((tests["E_peak_MPa"] / tests["E_MPa"] - 1.0).abs().max())
    phase = (tests["phase_peak_deg"] - tests["phase_deg"]).abs()
    relative = 100.0 * float((phase / tests["phase_deg"]).max())
    values = {"modulus": modulus, "phase": relative}
    return Finding("reduction", float(phase.max()), modulus < 0.5 and relative < 5.0, values)


def waveform(test: Record) -> Finding:
    """Fig. 7, from its test: the last cycle of the force less offset, drift and harmonic."""
    time, _, force = last_cycle(test)
    angle = 2.0 * np.pi * test.attributes["frequency_Hz"] * time
    # With drift, for five cycles from rest still carry the start.
    basis = np.column_stack([np.ones_like(angle), angle, np.cos(angle), np.sin(angle)])
    solution, *_ = np.linalg.lstsq(basis, force, rcond=None)
    # Behind offset and drift come the two parts of the harmonic.
    return Finding("fig7", 100.0 * float(np.abs(force - basis @ solution).max() / np.hypot(*solution[2:])))


def profile(arrays: Mapping[str, Any]) -> Iterator[Finding]:
    """Fig. 8, from the arrays of one test."""
    names = "velocity_m_s", "spheres", "height_m"
    velocity, members, height = (arrays[f"profile/{name}"] for name in names)
    fastest = velocity[np.abs(velocity).sum(axis=1).argmax()]
    along, level = np.abs(fastest[members > 0]), height[members > 0]
    rises = bool((np.diff(along) > -0.02 * along.max()).all()) and along[0] < 0.01 * along[-1]
    yield Finding("fig8", f"{along[0] / along[-1]:.4f}", rises, {"layers": along.size})
    fine = np.linspace(0.0, PAPER.h, 1001)
    beam = np.interp(level, fine, PAPER.line(fine))
    yield Finding("fig8_beam", 100.0 * float(np.abs(along / along[-1] - beam / beam[-1]).max()))


def sensitivity(tests: pd.DataFrame, base: pd.DataFrame) -> Iterator[Finding]:
    """Figs. 11-14. tests: sensitivity.csv; base: simulations at the same temperature."""
    of_modulus, of_phase = (_effect(tests, base, column).abs() for column in ("E_MPa", "phase_deg"))
    modulus = of_modulus.groupby("parameter").mean()
    listed = ", ".join(f"{name} {value:.1f} %" for name, value in modulus.items())
    yield Finding("influence_Em", str(modulus.idxmax()), modulus.idxmax() == "Em", {"listed": listed})
    for id, name in (("grows_Em", "Em"), ("grows_eta_k", "eta_k")):
        along = of_modulus.loc[name].groupby("frequency_Hz").mean()
        grows = bool((np.diff(along) > 0.0).all()) and (name == "Em" or modulus[name] < modulus["Em"])
        values = {"where": along.idxmax(), "largest": along.max()}
        yield Finding(id, f"{along.iloc[0]:.1f} to {along.iloc[-1]:.1f}", grows, values)
    phase = of_phase.groupby("parameter").max()
    listed = ", ".join(f"{name} {value:.0f}" for name, value in phase.items())
    yield Finding("phase_sensitive", listed, bool((phase > 5.0).all()))


def _effect(tests: pd.DataFrame, base: pd.DataFrame, column: str) -> pd.Series:
    """Relative change of a column in percent, by parameter, factor and frequency."""
    reference = base.groupby("frequency_Hz")[column].mean()
    changed = tests.groupby(["parameter", "factor", "frequency_Hz"])[column].mean()
    return 100.0 * (changed / reference.reindex(changed.index, level="frequency_Hz") - 1.0)
