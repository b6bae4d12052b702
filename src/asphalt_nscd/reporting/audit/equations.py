"""Equations, units and numbers of the paper that can be checked without a particle."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import pandas as pd
from scipy.integrate import quad

from asphalt_nscd.measurements.twopoint import PAPER, PAPER_AMPLITUDE, form_factor, mass_factor
from asphalt_nscd.nscd.bonds.law import BondLaw
from asphalt_nscd.reporting.audit.statement import (
    HOLDS,
    INCONSISTENT,
    LEFT_OPEN,
    UNCHECKED,
    Judgement,
    compared,
    judged,
    spanned,
)
from asphalt_nscd.rheology.burgers import Burgers

TIME_STEP = 5e-5  # s
OMEGA = 2.0 * np.pi * np.array([3.0, 6.0, 10.0, 25.0, 40.0])
DENSITIES = (2200.0, 2500.0)  # kg/m3, of compacted asphalt concrete
ELASTIC_TIME = 2e-5  # s at 15 degC, section 3.2.2
MEAN_MASS, MEAN_PRESSURE, MEAN_SIZE = 2.86e-5, 2.79e3, 2.52e-3  # kg, Pa, m: section 3.2.2


def laboratory() -> Iterator[Judgement]:
    """Section 2."""
    volume = 0.5 * (PAPER.b + PAPER.B) * PAPER.e * PAPER.h
    density = PAPER.mass / volume
    yield Judgement(
        "mass",
        PAPER.mass,
        density,
        "kg; kg/m3 over the volume of Fig. 1",
        judged(DENSITIES[0] < density < DENSITIES[1], HOLDS),
        "A density of compacted asphalt concrete.",
        f"A density outside {DENSITIES[0]:g} to {DENSITIES[1]:g} kg/m3.",
    )
    yield _strain()
    yield Judgement(
        "measurements",
        "four specimens",
        "reconstructed",
        "",
        UNCHECKED,
        "No table gives a number. Figs. 9 and 10 plot |E*| and phase; we have the text of the paper without its "
        "figures. Our measurements are reconstructed from Table 3 and called so everywhere.",
        "Figs. 9 and 10 digitised: `measurements: {table: FILE}` runs the whole study on them (data/paper/README.md).",
    )
    term = form_factor(PAPER) * mass_factor(PAPER) * OMEGA[-1] ** 2 / 1e6
    yield Judgement(
        "mass_term",
        term / 1e3,
        term,
        "MPa at 40 Hz, masses in kg or in g",
        LEFT_OPEN,
        "The unit of mu is not stated beside the equation. With masses in g, as in EN 12697-26 (N, mm, g, MPa), it is "
        "right; with the kg of section 2.1 the term is a thousand times too small.",
        "A unit beside mu.",
    )
    # deflection of a tapered cantilever under a force at its free end: F/E int (h-x)^2 / I dx
    bending, _ = quad(lambda x: (PAPER.h - x) ** 2 * 12.0 / (PAPER.e * _width(x) ** 3), 0.0, PAPER.h)
    yield compared(
        "form_factor",
        form_factor(PAPER) / 1e3,
        bending / 1e3,
        "1/mm",
        1e-8,
        "Ours: Euler-Bernoulli deflection of the tapered cantilever, integrated numerically. The head must be "
        "free to rotate.",
        HOLDS,
    )
    yield _mass_factor()


def _width(x: Any) -> Any:
    return PAPER.B + (PAPER.b - PAPER.B) * x / PAPER.h


def _strain() -> Judgement:
    along = np.linspace(0.0, PAPER.h, 2001)
    strain = PAPER_AMPLITUDE / form_factor(PAPER) * (PAPER.h - along) * 6.0 / (PAPER.e * _width(along) ** 2)
    largest = 1e6 * float(strain.max())
    return Judgement(
        "strain",
        50.0,
        largest,
        "1e-6",
        judged(largest < 50.0, HOLDS),
        f"Largest bending strain, at {1e3 * along[strain.argmax()]:.0f} mm above the foot, by beam theory.",
        "A strain above 50e-6: an amplitude above 64.8e-6 m.",
    )


def _mass_factor() -> Judgement:
    """Kinetic energy of the cantilever in its static deflection, over that of its mass at the head."""
    x = np.linspace(0.0, PAPER.h, 20_001)
    moving = np.trapezoid(_width(x) * PAPER.line(x) ** 2, x)
    share = float(moving / np.trapezoid(_width(x), x))
    apart = form_factor(PAPER) * (share - 0.135) * PAPER.mass * OMEGA[-1] ** 2 / 1e6
    return compared(
        "mass_factor",
        0.135,
        share,
        "of the mass of the specimen",
        0.05,
        f"Ours: Rayleigh's quotient with the static deflection. The difference is {apart:.0f} MPa at 40 Hz. The "
        "constant is that of EN 12697-26, and the study keeps it.",
        HOLDS,
    )


def contact_law(law: Burgers) -> Iterator[Judgement]:
    """Section 3.1. law: Table 3 at 15 degC, in kPa."""
    yield Judgement(
        "breaking",
        "component by component",
        "length of the tangential vector",
        "",
        LEFT_OPEN,
        "The directions t and s are arbitrary, so a test on each of them depends on the frame: a force of 1.2 times "
        "the yield force along t + s passes it in one frame and not in another. We test the length.",
        "A rule for the directions t and s.",
    )
    yield Judgement(
        "sum_of_velocities",
        "U+ = U- + Uk + Umk + Umc + W R dt",
        "U+ = Uk + Umk + Umc and U+ = U- + W R dt",
        "",
        INCONSISTENT,
        "By Eqs. (15)-(19) the velocities of the elements add up to U+. Put into Eq. (20) this leaves U- + W R+ dt = "
        "0, against Eq. (14). If U+ in Eq. (20) is the velocity of Eq. (12), zero in a bond that holds, the three "
        "terms need minus signs. The law is right with Eqs. (14) and (15).",
        "Eq. (14) or Eq. (15) read otherwise, so that all three hold.",
    )
    printed = -1.0 / (TIME_STEP * law.modulus_m) + 1.0 / law.viscosity_m + 1.0 / law.viscosity_k
    yield Judgement(
        "step_law",
        printed,
        float(_bond(law).step(TIME_STEP).compliance),
        "1/(Pa s)",
        INCONSISTENT,
        "Eqs. (17)-(24) give +1/(dt Km) + 1/Cm + 1/(Ck + dt Kk). As the text layer has it, the compliance is negative "
        "at the paper's dt: a compressed bond would grow longer. Its bracket adds W in 1/kg to 1/Cm in s/kg: a "
        "factor 1/dt is missing too. Ours is tested against creep, relaxation and harmonic response.",
        "Signs that the text layer has lost; the units would still differ.",
    )
    damped = law.viscosity_k + TIME_STEP * law.modulus_k
    tension = -1.0  # R is positive in repulsion
    yield Judgement(
        "kelvin_update",
        TIME_STEP * tension / damped,
        -TIME_STEP * tension / damped,
        "m for R = -1 Pa",
        INCONSISTENT,
        "By Eq. (22), R = -Kk dk - Ck Uk, the sign of dt R+ is minus. Under tension (R < 0) the element must open; "
        "with the printed sign it closes.",
        "R positive in tension; Eqs. (6) and (12) have it positive in repulsion.",
    )


def _bond(law: Burgers) -> BondLaw:
    return BondLaw(law.modulus_m, law.viscosity_m, np.array([law.modulus_k]), np.array([law.viscosity_k]))


def calibration(laws: dict[float, Burgers], pascal: dict[float, float]) -> Iterator[Judgement]:
    """Section 3.2.2. laws: Table 3 by temperature [degC], in kPa; pascal: |E*| over its law by frequency [Hz], read in
    Pa, relative to the reading in kPa.
    """
    law, coldest = laws[15.0], laws[min(laws)]
    kelvin = law.modulus_k**2 + (OMEGA * law.viscosity_k) ** 2
    storage = 1.0 / law.modulus_m + law.modulus_k / kelvin
    loss = 1.0 / (OMEGA * law.viscosity_m) + OMEGA * law.viscosity_k / kelvin
    ours = np.array([_bond(law).discrete_modulus(w, 0.0) for w in OMEGA])
    error = float(np.abs(ours * (storage - 1j * loss) - 1.0).max())
    yield Judgement(
        "compliance",
        1.0,
        1.0 + error,
        "product of D* and E*",
        judged(error < 1e-12, HOLDS),
        "Compared with springs and dashpots in series at five frequencies; the largest difference counts.",
        "A product that differs from one by more than rounding.",
    )
    listed = ", ".join(f"{ratio:.2f} at {f:g} Hz" for f, ratio in sorted(pascal.items()))
    yield Judgement(
        "table3_unit",
        coldest.modulus_m / 1e12,
        coldest.modulus_m / 1e9,
        "GPa",
        INCONSISTENT,
        "Asphalt concrete has glassy moduli of 20 to 45 GPa; 39.8 MPa would be a soft rubber. With gamma in 1/mm and "
        "the displacement in m, Eq. (1) gives kPa. A specimen of particles read in Pa resonates among the tests: |E*| "
        f"over its law, relative to the reading in kPa, is {listed} (15 degC), and no law of Eqs. (27)-(29) fits that.",
        "A unit of Eq. (1) that gives Pa and moduli of asphalt.",
    )
    yield Judgement(
        "limit_Em",
        1.0,
        abs(law.complex_modulus(np.array([1e9]))[0]) / law.modulus_m,
        "|E*| at 1e9 rad/s over Em",
        HOLDS,
        "The other elements are short-circuited by their dashpots.",
        "A spring in parallel with Em's element.",
    )


def table_4(laws: dict[float, Burgers], printed: pd.DataFrame) -> Iterator[Judgement]:
    """What Tables 3 and 4 say together. printed: temperature_C and mre_phase_percent of Table 4."""
    degrees = {
        row.temperature_C: row.mre_phase_percent
        / 100.0
        * float(np.degrees(np.angle(laws[row.temperature_C].complex_modulus(OMEGA))).mean())
        for row in printed.itertuples()
    }
    coldest = min(degrees)
    others = [value for t, value in degrees.items() if t != coldest]
    least = sum(value < degrees[coldest] for value in others)
    yield Judgement(
        "small_numbers",
        "small phases",
        degrees[coldest],
        f"deg, the printed error at {coldest:g} degC times the phase of Table 3",
        judged(least < len(others) / 2, HOLDS),
        f"At the other temperatures the printed errors are {spanned(others, '.2g')} deg: in degrees the coldest tests "
        f"agree better than {len(others) - least} of the {len(others)} others.",
        "An error in degrees at the lowest temperature above that at most others.",
    )


def typical_numbers(diameter: np.ndarray, count: np.ndarray, density: float) -> Iterator[Judgement]:
    """Averages and time scales of section 3.2.2: diameter (s,) [m], count (s,) of Table 2, density [kg/m3]."""
    mass = density * np.pi / 6.0 * diameter**3
    of_mean = density * np.pi / 6.0 * MEAN_SIZE**3
    yield Judgement(
        "mean_mass",
        MEAN_MASS,
        float((count * mass).sum() / count.sum()),
        "kg",
        INCONSISTENT,
        f"2.86e-5 kg is the mass of a sphere of the mean diameter ({of_mean:.3g} kg). The mean mass of Table 2's "
        "spheres is larger, as large spheres weigh with the cube of their size.",
        "A mean mass of Table 2's spheres within 5 % of the paper's.",
    )
    yield Judgement(
        "mean_pressure",
        MEAN_PRESSURE,
        density * 9.81 * PAPER.h / 3.0,
        "Pa",
        UNCHECKED,
        "No formula is given. rho g h/3 comes to this number, but we found it by trying.",
        "A formula, or the place where the pressure acts.",
    )
    mean = float((count * diameter).sum() / count.sum())
    yield compared("mean_size", MEAN_SIZE, mean, "m", 0.01, "Number average of Table 2.", HOLDS)
    yield compared(
        "rearrangement",
        2e-3,
        float(np.sqrt(MEAN_MASS / (MEAN_PRESSURE * MEAN_SIZE))),
        "s",
        0.05,
        "sqrt(m/(p d)); the text layer loses roots.",
        HOLDS,
    )
    yield Judgement(
        "elastic_time",
        ELASTIC_TIME,
        elastic_time(2.43e10),
        "s",
        INCONSISTENT,
        f"sqrt(m/Km). With Em in Pa and two touching 2 mm spheres it is {elastic_time(2.43e7):.2g} s, with "
        "Em in kPa 1/32 of that: the paper computed its time scale from the Pa reading that its moduli contradict.",
        "Table 3 in Pa after all.",
    )


def elastic_time(modulus: float) -> float:
    """sqrt(m/Km) [s] of two touching spheres of 2 mm whose bond has Em = modulus [Pa]."""
    return float(np.sqrt(MEAN_MASS / (np.pi * 1e-3**2 / 2e-3 * modulus)))


def head(blocked: dict[float, float]) -> str:
    """What a head that cannot turn would do. blocked: |E*| by frequency [Hz] over that with a free head."""
    return f"With a head that cannot turn |E*| is {spanned(list(blocked.values()), '.2f')} times as high. "
