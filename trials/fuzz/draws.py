"""Calls of the public Python functions with valid arguments, drawn from their ranges."""

from __future__ import annotations

import tempfile
from collections.abc import Callable
from dataclasses import fields
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from drawn.design import factorial

import asphalt_nscd as an
from asphalt_nscd.exports.formats import FORMATS, format_of
from asphalt_nscd.files.ranges import Range
from fuzz import wild
from fuzz.hostile import hostile

Random = np.random.Generator
Call = Callable[[], Any]


def number(rng: Random, allowed: Range, usual: float) -> float:
    """One of a range: an end of it, one near the usual, or any size of up to twelve decades."""
    ends = [end for end in (allowed.low, allowed.high) if np.isfinite(end)]
    if ends and rng.random() < 0.1:
        return float(rng.choice(ends))
    while True:
        wide = rng.random() < 0.2
        drawn = (usual or 1.0) * 10.0 ** (rng.uniform(-6.0, 6.0) if wide else rng.normal(0.0, 0.4))
        if allowed.holds(drawn):
            return float(drawn)


def of_ranges(kind: type, rng: Random, **usual: float) -> dict[str, Any]:
    """Arguments of a class with ranges: those with a usual value drawn about it, choices among all."""
    drawn: dict[str, Any] = {}
    for one in fields(kind):
        allowed, choices = one.metadata.get("range"), one.metadata.get("choices")
        if choices:
            drawn[one.name] = str(rng.choice(choices))
        elif allowed and one.name in usual:
            found = number(rng, allowed, usual[one.name])
            drawn[one.name] = round(found) if one.type == "int" else found
    return drawn


# --- what is called ---------------------------------------------------------------------------------------------


@cache
def packings() -> list[an.Packing]:
    """Of few spheres, which all calls share."""
    still = an.Vibration(duration=0.0)
    return [
        an.pour({6.0: 260}, (0.1, 0.02, 0.1), vibration=still),
        an.pour({5.0: 250, 8.0: 80}, (0.06, 0.03, 0.3), vibration=still, seed=3),
        an.pour({8.0: 12}, (0.03, 0.02, 0.1), vibration=still),
    ]


@cache
def specimens() -> list[an.Specimen]:
    """Of each test, and two of them by each kind of bonds."""
    masses = {"mass_kg": 0.06, "mobile_mass_kg": 0.1}
    beam = {"b_mm": 16, "B_mm": 20, "e_mm": 20, "h_mm": 100, **masses}
    rod = {"d_mm": 25, "h_mm": 60, "mass_kg": 0.05, "mobile_mass_kg": 0.0}
    first, second, _ = packings()
    prism = {"L_mm": 100, "H_mm": 16, "B_mm": 20, **masses}
    asked = [(first, beam, "paper"), (first, beam, "facets"), (second, rod, "paper"), (second, rod, "facets")]
    asked.append((first, prism, "facets"))
    return [an.specimen(packing, shape, area=area) for packing, shape, area in asked]


def pour(rng: Random) -> Call:
    """A few spheres of one to three sizes, into a box that mostly holds them."""
    sizes = rng.integers(1, 4)
    smallest = number(rng, Range(low=0.01, high=100.0), 6.0)
    diameters = np.round(smallest * 10 ** rng.uniform(0.0, 1.05, sizes), 3)
    counts = {float(min(d, 100.0)): int(rng.integers(0, 40 // sizes)) for d in diameters}
    box = tuple(1e-3 * diameters.max() * rng.uniform([1.0, 1.0, 3.0], [6.0, 6.0, 30.0]))
    vibration = of_ranges(an.Vibration, rng, stroke=3e-3, frequency=30.0, duration=0.1)
    how: dict[str, Any] = {"time_step_s": number(rng, Range(low=1e-6, high=1e-3), 4e-4)}
    surfaces = of_ranges(an.Surfaces, rng, friction=0.3, wall_friction=0.3, restitution=0.1)
    how["seed"] = int(rng.integers(0, 2**32))
    return lambda: an.pour(
        counts, box, surfaces=an.Surfaces(**surfaces), vibration=an.Vibration(**vibration), **how
    )


def specimen(rng: Random) -> Call:
    """Any shape that is about as large as its packing."""
    packing = packings()[rng.integers(3)]
    length, width, _ = 1e3 * packing.box_m
    height = length * (1.0 if rng.random() < 0.7 else rng.uniform(0.2, 1.05))
    across, wide = width * rng.uniform(0.3, 1.02), rng.uniform(4.0, 20.0)
    mass = number(rng, Range(low=1e-3, high=20.0), 0.1)
    masses = {"mass_kg": mass, "mobile_mass_kg": rng.choice([0.0, 0.1, 5.0])}
    shapes: list[dict[str, float]] = [
        {"b_mm": wide * rng.uniform(0.3, 1.0), "B_mm": wide, "e_mm": across, "h_mm": height},
        {"d_mm": across, "h_mm": height},
        {"L_mm": height, "H_mm": wide, "B_mm": across},
    ]
    shape = shapes[rng.integers(3)]
    area = str(rng.choice(["paper", "facets"]))
    reduction, gap = number(rng, Range(low=0.0, below=1.0), 0.1), number(rng, Range(above=0.0), 2.0)
    return lambda: an.specimen(packing, shape | masses, area=area, volume_reduction=reduction, gap_max_mm=gap)


def burgers(rng: Random) -> dict[str, float]:
    """Parameters of any size."""
    usual = {"Em_Pa": 2e10, "eta_m_Pa_s": 4e9, "Ek_Pa": 4e10, "eta_k_Pa_s": 8e8}
    drawn = {name: number(rng, Range(above=0.0), size) for name, size in usual.items()}
    return drawn | {"temperature_C": 15.0}


@cache
def of_all_temperatures() -> an.Law:
    """A 2S2P1D, fitted."""
    tests = factorial("A", [0.0, 20.0, 40.0], [0.1, 1.0, 10.0]).drop(columns="specimen")
    modulus = [15e3, 18e3, 21e3, 4e3, 7e3, 11e3, 6e2, 1.2e3, 2.6e3]
    return an.fit(tests.assign(E_MPa=modulus, phase_deg=[10.0, 8, 6, 28, 22, 16, 38, 36, 32]))


def law(rng: Random) -> Call:
    """A Burgers law, its modulus and the law of bonds that follows it."""
    parameters, f = burgers(rng), number(rng, Range(above=0.0), 10.0)

    def call() -> tuple[Any, Any]:
        made = an.Law.burgers(**parameters)
        return made.complex_modulus([f, 2 * f]), made.of_bonds(f, 15.0).parameters

    return call


def bend(rng: Random) -> Call:
    """A test of few steps: any law, load, bonds, method and scheme."""
    given, parameters = specimens()[rng.integers(5)], burgers(rng)
    frequency = number(rng, Range(above=0.0), 10.0)
    steps = round(number(rng, Range(low=2, high=2000), 50))
    bonds = of_ranges(an.Bonds, rng, poisson=0.3, kt_over_kn=1.0, yield_Pa=2.7e6, friction=0.7)
    load: dict[str, Any] = {"cycles": rng.uniform(1.0, 3.0), "frames": int(rng.choice([0, 0, 0, 4]))}
    if rng.random() < 0.5:
        load["amplitude_m"] = number(rng, Range(above=0.0), 2e-5)
    if rng.random() < 0.3:
        load["rig"] = an.Rig(*np.abs(rng.normal(0.0, [1e-8, 1e5, 1.0, 0.1])), *rng.normal(0.0, [1e-4, 0.01]))
    numerics = of_ranges(an.Numerics, rng) | {"rest_steps": int(rng.choice([0, 20]))}
    numerics |= {"time_step": 1.0 / frequency / steps, "most_sweeps": 20}

    def call() -> an.Test:
        how = {"load": an.Load(**load), "bonds": an.Bonds(**bonds), "numerics": an.Numerics(**numerics)}
        return an.bend(given, an.Law.burgers(**parameters), frequency, 15.0, **how)

    return call


def hold(rng: Random) -> Call:
    """A force or a displacement of any size, held for any time in few steps."""
    given, parameters = specimens()[rng.integers(5)], burgers(rng)
    duration = number(rng, Range(above=0.0), 1.0)
    how: dict[str, Any] = {"duration_s": duration, "steps": int(rng.integers(10, 60))}
    if rng.random() < 0.8:
        kind, usual = [("force_N", 100.0), ("displacement_m", 1e-5)][rng.integers(2)]
        how[kind] = rng.choice([1.0, -1.0]) * number(rng, Range(above=0.0), usual)
    bonds = of_ranges(an.Bonds, rng, poisson=0.3, kt_over_kn=1.0, yield_Pa=2.7e6, friction=0.7)
    return lambda: an.hold(
        given, an.Law.burgers(**parameters), 15.0, held=an.Hold(**how), bonds=an.Bonds(**bonds)
    )


def fatigue(rng: Random) -> Call:
    """A specimen of any test, at any strain."""
    given, strain = specimens()[rng.integers(5)], number(rng, Range(above=0.0), 1e-4)
    law = of_ranges(an.FatigueLaw, rng, endured=1e-4, exponent=5.0)
    bonds = of_ranges(an.Bonds, rng, poisson=0.3, kt_over_kn=1.0, yield_Pa=2.7e6, friction=0.7)
    return lambda: an.fatigue(given, strain, law=an.FatigueLaw(**law), bonds=an.Bonds(**bonds))


def solve_contacts(rng: Random) -> Call:
    """Bodies of masses over decades that touch at few or many points, with as many contacts as they need or more."""
    contacts = round(np.exp(rng.uniform(0.0, np.log(60.0))))
    bodies = max(1, round(contacts * rng.uniform(0.1, 2.0)))
    arms = rng.normal(size=(3 * contacts, 6 * bodies))
    arms *= rng.random(arms.shape) < rng.uniform(0.05, 1.0)
    mass = np.exp(rng.uniform(-20.0, 20.0, 6 * bodies) * rng.random() ** 3)
    w = (arms / mass) @ arms.T
    w = 0.5 * (w + w.T) * 10.0 ** rng.choice([0.0, 0.0, 0.0, -80.0, 80.0])
    q = rng.normal(size=3 * contacts) * 10.0 ** rng.choice([0.0, 0.0, 0.0, -300.0, 300.0])
    q *= rng.random(3 * contacts) < rng.choice([1.0, 0.5])
    mu = [rng.uniform(0.0, 2.0), 0.0, 1e-6, 1e10, np.exp(rng.uniform(-5.0, 3.0, contacts))][rng.integers(5)]
    order, tolerance = str(rng.choice(["nts", "tns", "tsn"])), 10.0 ** rng.uniform(-16.0, -1.0)
    return lambda: an.solve_contacts(w, q, mu, order=order, tolerance=tolerance)


def fit(rng: Random) -> Call:
    """Any law to a wild table."""
    table, _ = wild.draw(int(rng.integers(2**32)))
    kind, shift = str(rng.choice(["burgers", "2s2p1d", "huet-sayegh"])), str(rng.choice(["wlf", "arrhenius"]))
    temperature = float(table["temperature_C"].iloc[0]) if kind == "burgers" else None
    return lambda: an.fit(table.iloc[:60], kind, temperature_C=temperature, shift=shift)


def read(rng: Random) -> Call:
    """A wild table."""
    table, _ = wild.draw(int(rng.integers(2**32)))
    return lambda: an.read(table)


def export(rng: Random) -> Call:
    """A law, a packing or a specimen, in any form."""
    made = an.Law.burgers(**burgers(rng))
    what = [made, of_all_temperatures(), packings()[0], specimens()[rng.integers(5)]][rng.integers(4)]
    endings = {name: format_of(name).ENDINGS[0] for name in FORMATS} | {"vtk": ".vtp"}
    form = str(rng.choice(list(endings)))
    settings = {
        "error_percent": number(rng, Range(above=0.0), 1.0),
        "error_deg": number(rng, Range(above=0.0), 0.5),
        "poisson": rng.choice([None, 0.2, 0.35, 0.49]),
        "units": str(rng.choice(["SI", "mm-N-MPa"])),
    }
    low, decades = number(rng, Range(above=0.0), 0.1), rng.uniform(0.0, 6.0)
    band = (low, low * 10.0**decades) if rng.random() < 0.7 else None

    def call() -> str:
        with tempfile.TemporaryDirectory() as folder:
            output = Path(folder, f"out{endings[form]}")
            made = an.ExportSettings(**settings)
            return an.export(what, output, form, settings=made, frequencies_Hz=band)

    return call


def read_packing(rng: Random) -> Call:
    """Spheres of any place and size, as text."""
    number = rng.integers(1, 50)
    if rng.random() < 0.5:  # apart, of the size of aggregate
        places = 9.0 * rng.permutation(np.indices((4, 4, 4)).reshape(3, -1).T)[:number]
        spheres = np.column_stack([places, rng.uniform(1.0, 4.4, number)])
        unit = rng.choice([None, "mm", "mm"])
    else:
        spheres = np.abs(rng.normal(size=(number, 4))) * 10.0 ** rng.uniform(-4.0, 2.0)
        unit = rng.choice([None, "m", "cm", "mm", "um"])
    up = str(rng.choice(["x", "y", "z"]))

    def call() -> an.Packing:
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder, "pile.csv")
            pd.DataFrame(spheres, columns=["x", "y", "z", "radius"]).to_csv(path, index=False)
            return an.read_packing(path, unit=unit, up=up)

    return call


def diagnose(rng: Random) -> Call:
    """A wild table of at most 60 tests; more of them, and larger ones, go through `fuzz.diagnoses`."""
    table, _ = wild.draw(int(rng.integers(2**32)))
    return lambda: an.diagnose(table.iloc[:60])


SHARES = {
    solve_contacts: 0.16, hostile: 0.1, law: 0.14, specimen: 0.14, bend: 0.12, hold: 0.05, fatigue: 0.03,
    export: 0.08, read: 0.06, read_packing: 0.05, pour: 0.04, fit: 0.02, diagnose: 0.01,
}  # fmt: skip


def called(seed: int) -> str:
    """The function that a seed calls."""
    return _chosen(seed)[0].__name__


def draw(seed: int) -> Call:
    """The call of a seed."""
    chosen, rng = _chosen(seed)
    return chosen(rng)


def _chosen(seed: int) -> tuple[Callable[[Random], Call], Random]:
    rng = np.random.default_rng([seed, 36])
    return list(SHARES)[rng.choice(len(SHARES), p=list(SHARES.values()))], rng
