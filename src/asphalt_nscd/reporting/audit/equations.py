"""Equations and units: what holds, what contradicts itself."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from scipy.integrate import quad

from asphalt_nscd.measurements.twopoint import Geometry, form_factor, mass_factor
from asphalt_nscd.nscd.bonds.law import BondLaw
from asphalt_nscd.reporting.audit.statement import (
    DIFFERS,
    INCONSISTENT,
    Statement,
    compared,
    judged,
    spanned,
)
from asphalt_nscd.rheology.burgers import Burgers

PAPER = Geometry(b=0.025, B=0.056, e=0.025, h=0.25, mass=0.6, mobile_mass=0.235)
AMPLITUDE = 63e-6  # m
TIME_STEP = 5e-5  # s


def equations(laws_as_kpa: dict[float, Burgers]) -> Iterator[Statement]:
    """Rows that need no simulation. laws_as_kpa: Table 3 by temperature [degC], read in kPa."""
    law = laws_as_kpa[15.0]
    yield _form_factor()
    yield _cantilever_limit()
    yield _mass_term()
    yield _strain()
    yield _unit_of_moduli(laws_as_kpa)
    yield _compliance(law)
    yield _discrete_law(law)
    yield _kelvin_update(law)
    yield Statement(
        "Eq. (13)",
        "A bond breaks when one component of R exceeds its yield force.",
        "component by component",
        "length of the tangential vector",
        "",
        INCONSISTENT,
        "The directions t and s are arbitrary, so a test on each of them depends on the frame: a force of "
        "1.2 times the yield force along t + s passes it. We test the length of the tangential part.",
    )


def _width(x: Any) -> Any:
    return PAPER.B + (PAPER.b - PAPER.B) * x / PAPER.h


def _form_factor() -> Statement:
    # deflection of a tapered cantilever under a force at its free end: F/E int (h-x)^2 / I dx
    bending, _ = quad(lambda x: (PAPER.h - x) ** 2 * 12.0 / (PAPER.e * _width(x) ** 3), 0.0, PAPER.h)
    return compared(
        "Eq. (3)",
        "Form factor gamma of the trapezoid.",
        form_factor(PAPER) / 1e3,
        bending / 1e3,
        "1/mm",
        1e-8,
        "Ours: Euler-Bernoulli deflection of the tapered cantilever, integrated numerically. The head must be "
        "free to rotate.",
    )


def _cantilever_limit() -> Statement:
    prism = Geometry(b=PAPER.B, B=PAPER.B, e=PAPER.e, h=PAPER.h, mass=0.6, mobile_mass=0.0)
    exact = 4.0 * PAPER.h**3 / (PAPER.e * PAPER.B**3)
    return compared(
        "Eq. (3)",
        "gamma tends to the prismatic cantilever 4 h^3/(e B^3) as b tends to B.",
        exact / 1e3,
        form_factor(prism) / 1e3,
        "1/mm",
        1e-12,
        "The bracket of Eq. (3) summed as a series near the limit.",
    )


def _mass_term() -> Statement:
    omega = 2.0 * np.pi * 40.0
    term = form_factor(PAPER) * mass_factor(PAPER) * omega**2 / 1e6
    return Statement(
        "Eq. (1)",
        "The mass term is 1e-6 mu omega^2, with gamma in 1/mm and masses in kg.",
        term / 1e3,
        term,
        "MPa at 40 Hz",
        INCONSISTENT,
        "The factor 1e-6 belongs to N, mm, g and MPa (EN 12697-26). With the masses in kg that the paper "
        "gives, the term is a thousand times too small; in SI there is no factor.",
    )


def _strain() -> Statement:
    along = np.linspace(0.0, PAPER.h, 2001)
    strain = AMPLITUDE / form_factor(PAPER) * (PAPER.h - along) * 6.0 / (PAPER.e * _width(along) ** 2)
    largest = 1e6 * float(strain.max())
    return Statement(
        "2.1",
        "An amplitude of 63e-6 m keeps the strain below 50e-6.",
        50.0,
        largest,
        "1e-6",
        judged(largest < 50.0),
        f"Largest bending strain, at {1e3 * along[strain.argmax()]:.0f} mm above the foot, from beam theory.",
    )


def _unit_of_moduli(laws: dict[float, Burgers]) -> Statement:
    coldest = laws[min(laws)]
    return Statement(
        "Table 3",
        f"Em = 3.98e7 Pa at {min(laws):g} degC.",
        coldest.modulus_m / 1e12,
        coldest.modulus_m / 1e9,
        "GPa",
        INCONSISTENT,
        "Asphalt concrete has glassy moduli of 20 to 45 GPa; 39.8 MPa would be a soft rubber. With gamma in "
        "1/mm and the displacement in m, Eq. (1) gives kPa: read so, Table 3 is in the expected range.",
    )


def _compliance(law: Burgers) -> Statement:
    omega = 2.0 * np.pi * np.array([3.0, 6.0, 10.0, 25.0, 40.0])
    kelvin = law.modulus_k**2 + (omega * law.viscosity_k) ** 2
    storage = 1.0 / law.modulus_m + law.modulus_k / kelvin
    loss = 1.0 / (omega * law.viscosity_m) + omega * law.viscosity_k / kelvin
    ours = np.array([_bond(law).discrete_modulus(w, 0.0) for w in omega])
    error = float(np.abs(ours * (storage - 1j * loss) - 1.0).max())
    return Statement(
        "Eqs. (27)-(29)",
        "Complex compliance of the Burgers law.",
        1.0,
        1.0 + error,
        "product of D* and E*",
        judged(error < 1e-12),
        "Compared with springs and dashpots in series at five frequencies; the largest difference counts.",
    )


def _bond(law: Burgers) -> BondLaw:
    return BondLaw(law.modulus_m, law.viscosity_m, np.array([law.modulus_k]), np.array([law.viscosity_k]))


def _discrete_law(law: Burgers) -> Statement:
    printed = -1.0 / (TIME_STEP * law.modulus_m) + 1.0 / law.viscosity_m + 1.0 / law.viscosity_k
    ours = _bond(law).step(TIME_STEP).compliance
    return Statement(
        "Eq. (25)",
        "Step compliance -1/(dt Km) + 1/Cm + 1/Ck.",
        printed,
        ours,
        "1/(Pa s)",
        INCONSISTENT,
        "Eqs. (17)-(24) give +1/(dt Km) + 1/Cm + 1/(Ck + dt Kk). As printed the compliance is negative at "
        "the paper's dt: a compressed bond would grow longer. Ours is tested against creep, relaxation "
        "and harmonic response.",
    )


def _kelvin_update(law: Burgers) -> Statement:
    """One step of a Kelvin element under a tension of one: it must open."""
    damped = law.viscosity_k + TIME_STEP * law.modulus_k
    tension = -1.0  # R is positive in repulsion
    return Statement(
        "Eq. (26)",
        "Kelvin displacement dk+ = (+dt R+ + Ck dk-)/(Ck + dt Kk).",
        TIME_STEP * tension / damped,
        -TIME_STEP * tension / damped,
        "m for R = -1 Pa",
        INCONSISTENT,
        "By Eq. (22), R = -Kk dk - Ck dk', the sign of dt R+ is minus. Under tension (R < 0) the element must open; "
        "with the printed sign it closes.",
    )


def readings(c: float, pascal: dict[float, float], blocked: dict[float, float]) -> Iterator[Statement]:
    """c: |E*| over its law; pascal, blocked: the same ratio by frequency [Hz] under these readings."""
    listed = ", ".join(f"{ratio / c:.2f} at {f:g} Hz" for f, ratio in sorted(pascal.items()))
    worst = max(pascal.values(), key=lambda ratio: abs(np.log(ratio / c)))
    yield Statement(
        "Table 3",
        "The parameters in Pa describe the tested material.",
        1.0,
        worst / c,
        "|E*| over its law, relative to the reading in kPa",
        INCONSISTENT,
        f"Read in Pa, the specimen is so soft that it resonates at a tested frequency. |E*| over its law, relative to "
        f"the reading in kPa: {listed} (15 degC). No law of Eqs. (27)-(29) could be fitted to such tests.",
    )
    ratios = np.array(list(blocked.values())) / c
    yield Statement(
        "2.2, 3.2.1",
        "Eqs. (1)-(3) describe the specimen with its head plate fixed on top.",
        1.0,
        float(ratios.mean()),
        "|E*| over that with a free head",
        DIFFERS if ratios.min() > 1.05 else judged(True),
        f"If the head cannot rotate, |E*| is {spanned(ratios, '.2f')} times that of a head free to rotate, "
        "which Eq. (3) assumes. The paper does not say which of the two it simulated.",
    )
