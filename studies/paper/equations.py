"""Equations, units and numbers of the paper that can be checked without a particle."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import pandas as pd
from scipy.integrate import quad

from asphalt_nscd.measurements.twopoint import PAPER, PAPER_AMPLITUDE, form_factor, mass_factor
from asphalt_nscd.nscd.bonds.law import BondLaw
from asphalt_nscd.rheology.burgers import Burgers
from studies.paper.finding import Finding, spanned

TIME_STEP = 5e-5  # s
OMEGA = 2.0 * np.pi * np.array([3.0, 6.0, 10.0, 25.0, 40.0])
ELASTIC_TIME = 2e-5  # s at 15 degC, section 3.2.2
MEAN_MASS, MEAN_PRESSURE, MEAN_SIZE = 2.86e-5, 2.79e3, 2.52e-3  # kg, Pa, m: section 3.2.2


def laboratory() -> Iterator[Finding]:
    """Section 2."""
    volume = 0.5 * (PAPER.b + PAPER.B) * PAPER.e * PAPER.h
    yield Finding("mass", PAPER.mass / volume)
    along = np.linspace(0.0, PAPER.h, 2001)
    strain = PAPER_AMPLITUDE / form_factor(PAPER) * (PAPER.h - along) * 6.0 / (PAPER.e * _width(along) ** 2)
    yield Finding("strain", 1e6 * float(strain.max()), values={"where": 1e3 * along[strain.argmax()]})
    term = form_factor(PAPER) * mass_factor(PAPER) * OMEGA[-1] ** 2 / 1e6
    yield Finding("mass_term", term, values={"in_kg": term / 1e3})
    # deflection of a tapered cantilever under a force at its free end: F/E int (h-x)^2 / I dx
    bending, _ = quad(lambda x: (PAPER.h - x) ** 2 * 12.0 / (PAPER.e * _width(x) ** 3), 0.0, PAPER.h)
    yield Finding("form_factor", bending / 1e3, abs(bending / form_factor(PAPER) - 1.0) < 1e-8)
    # kinetic energy of the cantilever in its static deflection, over that of its mass at the head
    x = np.linspace(0.0, PAPER.h, 20_001)
    share = float(np.trapezoid(_width(x) * PAPER.line(x) ** 2, x) / np.trapezoid(_width(x), x))
    apart = form_factor(PAPER) * (share - 0.135) * PAPER.mass * OMEGA[-1] ** 2 / 1e6
    yield Finding("mass_factor", share, values={"apart": apart})


def _width(x: Any) -> Any:
    return PAPER.B + (PAPER.b - PAPER.B) * x / PAPER.h


def contact_law(law: Burgers) -> Iterator[Finding]:
    """Section 3.1. law: Table 3 at 15 degC, in kPa."""
    printed = -1.0 / (TIME_STEP * law.modulus_m) + 1.0 / law.viscosity_m + 1.0 / law.viscosity_k
    yield Finding("step_law", float(_bond(law).step(TIME_STEP).compliance), values={"printed": printed})
    # of R = -1 Pa, a tension: R is positive in repulsion
    opening = TIME_STEP / (law.viscosity_k + TIME_STEP * law.modulus_k)
    yield Finding("kelvin_update", opening)


def _bond(law: Burgers) -> BondLaw:
    return BondLaw(law.modulus_m, law.viscosity_m, np.array([law.modulus_k]), np.array([law.viscosity_k]))


def calibration(
    laws: dict[float, Burgers], pascal: dict[float, float], explicit: float, design: pd.DataFrame
) -> Iterator[Finding]:
    """Section 3.2.2. laws: Table 3 by temperature [degC], in kPa; pascal: |E*| over its law by frequency [Hz], read in
    Pa, relative to the reading in kPa; explicit: longest step [s] that a DEM of the bonds can take; design: moduli of
    French mixes at 10 Hz, design_moduli.csv.
    """
    law, coldest = laws[15.0], laws[min(laws)]
    kelvin = law.modulus_k**2 + (OMEGA * law.viscosity_k) ** 2
    storage = 1.0 / law.modulus_m + law.modulus_k / kelvin
    loss = 1.0 / (OMEGA * law.viscosity_m) + OMEGA * law.viscosity_k / kelvin
    ours = np.array([_bond(law).discrete_modulus(w, 0.0) for w in OMEGA])
    error = float(np.abs(ours * (storage - 1j * loss) - 1.0).max())
    yield Finding("compliance", 1.0 + error, error < 1e-12)
    listed = ", ".join(f"{ratio:.2f} at {f:g} Hz" for f, ratio in sorted(pascal.items()))
    values = {"listed": listed, "explicit": explicit, "times": TIME_STEP / explicit}
    values |= {f"time_{unit}": elastic_time(modulus) for unit, modulus in (("Pa", 2.43e7), ("kPa", 2.43e10))}
    yield Finding("table3_unit", coldest.modulus_m / 1e9, values=values)
    moduli = [abs(laws[t].complex_modulus(2.0 * np.pi * 10.0)) / 1e6 for t in design["temperature_C"]]
    ratios = (np.array(moduli) / design["E_MPa"]).groupby(design["mix"])
    times = {mix: spanned(ratio, ".1f") for mix, ratio in ratios}
    yield Finding("level_of_table3", str(times["BBSG 2 and 3"]), values={"stiffer_mix": times["BBME 1"]})
    yield Finding("limit_Em", abs(law.complex_modulus(np.array([1e9]))[0]) / law.modulus_m)


def table_4(laws: dict[float, Burgers], printed: pd.DataFrame) -> Iterator[Finding]:
    """What Tables 3 and 4 say together. printed: temperature_C and mre_phase_percent of Table 4."""
    degrees = {}
    for t, percent in zip(printed["temperature_C"], printed["mre_phase_percent"], strict=True):
        phase = np.degrees(np.angle(laws[t].complex_modulus(OMEGA)))
        degrees[t] = percent / 100.0 * float(phase.mean())
    coldest = min(degrees)
    others = [value for t, value in degrees.items() if t != coldest]
    least = sum(value < degrees[coldest] for value in others)
    values = {"coldest": coldest, "others": spanned(others, ".2g"), "number": len(others)}
    values["better"] = len(others) - least
    yield Finding("small_numbers", degrees[coldest], least < len(others) / 2, values)


def typical_numbers(diameter: np.ndarray, count: np.ndarray, density: float) -> Iterator[Finding]:
    """Averages and time scales of section 3.2.2: diameter (s,) [m], count (s,) of Table 2, density [kg/m3]."""
    mass = density * np.pi / 6.0 * diameter**3
    of_mean = density * np.pi / 6.0 * MEAN_SIZE**3
    yield Finding("mean_mass", float((count * mass).sum() / count.sum()), values={"of_mean": of_mean})
    yield Finding("mean_pressure", density * 9.81 * PAPER.h / 3.0)
    yield Finding("mean_size", float((count * diameter).sum() / count.sum()))
    yield Finding("rearrangement", float(np.sqrt(MEAN_MASS / (MEAN_PRESSURE * MEAN_SIZE))))


def elastic_time(modulus: float) -> float:
    """sqrt(m/Km) [s] of two touching spheres of 2 mm whose bond has Em = modulus [Pa]."""
    return float(np.sqrt(MEAN_MASS / (np.pi * 1e-3**2 / 2e-3 * modulus)))
