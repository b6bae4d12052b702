"""What the parameters of asphalt concrete usually are, for fits to tests that do not determine them all.

Each parameter has a normal distribution of its logarithm. Its deviation is chosen so that 95 % of it holds
the published range. Informative tests outweigh it: within that range it moves a parameter by less than a
standard error, and by less than half of one where the standard error is a quarter of the deviation.

The shift is stated by its slope at 15 degC and by C2, because tests determine the slope and rarely C2. At another
reference temperature C1 and C2 follow from C1 C2 = const and C2 - T_ref = const.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from asphalt_nscd.rheology.hirsch import limiting_modulus

Vector = NDArray[np.float64]
REFERENCE_TEMPERATURE = 15.0  # degC, of c2 and wlf_slope below
# At 0.7 the tests say as much as the prior does: 1/0.7^2 = 2.
FROM_PRIOR = 0.7  # posterior over prior standard deviation above which the tests do not determine a parameter


@dataclass(frozen=True)
class Usual:
    """What one parameter usually is: a normal distribution of its logarithm.

    `median` in `unit`; `deviation` is the standard deviation of the natural logarithm; `source` says where both come
    from.
    """

    median: float
    deviation: float
    unit: str
    source: str


_SOME = "Some, Barthelemy, Mouillet & Hammoum (2022), 2S2P1D laws of six 0/10 mixes, fresh and aged"
_QUEZADA = "the law of Table 3 of Quezada & Chazallon (2020), reconstructed"
_SHRP = "Christensen & Anderson (1992), SHRP binders: C1 = 19, C2 = 92 K at the defining temperature"

USUAL: Mapping[str, Usual] = {
    "glassy_modulus": Usual(
        31e9,
        0.25,
        "Pa",
        f"19-51 GPa; 21-26 GPa in {_SOME}; 42 GPa in {_QUEZADA}; 22-24 GPa at VMA 13-18 % by the limiting modulus of "
        "AASHTO R 84",
    ),
    "static_modulus": Usual(70e6, 1.0, "Pa", f"10-500 MPa; 20-100 MPa in {_SOME}"),
    "k": Usual(0.2, 0.2, "1", f"0.13-0.30; 0.176-0.220 in {_SOME}; 0.20 in {_QUEZADA}"),
    "h": Usual(0.6, 0.15, "1", f"0.44-0.81; 0.59-0.65 in {_SOME}; 0.60 in {_QUEZADA}"),
    "delta": Usual(2.2, 0.35, "1", f"1.1-4.4; 2.4-2.7 in {_SOME}; 1.65 in {_QUEZADA}"),
    "beta": Usual(120.0, 1.6, "1", f"5-2900; 9.5-900 in {_SOME}; 26 in {_QUEZADA}"),
    "wlf_slope": Usual(
        0.14,
        0.3,
        "decades/K",
        f"C1/C2 at 15 degC, 0.08-0.25; 0.146 in {_QUEZADA}; 0.11-0.15 in {_SHRP}, of -20 to 0 degC",
    ),
    "c2": Usual(
        130.0,
        0.4,
        "K",
        f"at 15 degC, 60-285 K; 81 K in {_QUEZADA}; 107-127 K in {_SHRP}, of -20 to 0 degC",
    ),
    "activation_energy": Usual(
        200e3,
        0.2,
        "J/mol",
        f"135-300 kJ/mol; 261 kJ/mol below the defining temperature (Christensen & Anderson 1992); 0.146 decades/K at "
        f"15 degC ({_QUEZADA}) is 232 kJ/mol",
    ),
}


@dataclass(frozen=True)
class Prior:
    """Independent normal distributions of the logarithms of parameters; one that is not named in `usual` has none."""

    usual: Mapping[str, Usual]

    def standardised(
        self, values: Mapping[str, float], reference_temperature: float
    ) -> tuple[Vector, NDArray[np.float64]]:
        """Deviations (m,) from the medians in standard deviations, and their derivatives (m, p) by ln of each value.

        `values` are parameters (p,) of a law in SI units, c1 and c2 at the reference temperature [degC] of the shift.
        """
        names = list(values)
        log, slope = np.log(list(values.values())), np.eye(len(names))
        if "c2" in values:
            one, two = names.index("c1"), names.index("c2")
            c2 = values["c2"] + REFERENCE_TEMPERATURE - reference_temperature
            share = values["c2"] / c2
            # ln of the slope c1/c2 in the place of c1; both at the reference temperature of the prior.
            log[one], slope[one, two] = log[one] + log[two] - 2.0 * np.log(c2), 1.0 - 2.0 * share
            log[two], slope[two, two] = np.log(c2), share
            names[one] = "wlf_slope"
        rows = [row for row, name in enumerate(names) if name in self.usual]
        median = np.log([self.usual[names[row]].median for row in rows])
        deviation = np.array([self.usual[names[row]].deviation for row in rows])
        return (log[rows] - median) / deviation, slope[rows] / deviation[:, None]

    def largest(self, name: str) -> float:
        """A value ten deviations above the median [SI units], beyond what any tests will find; 0 without a prior."""
        usual = self.usual.get(name)
        return 0.0 if usual is None else usual.median * float(np.exp(10.0 * usual.deviation))

    def undetermined_names(
        self, values: Mapping[str, float], covariance: NDArray[np.float64], reference_temperature: float
    ) -> tuple[str, ...]:
        """Parameters that the tests do not narrow: posterior over prior deviation above FROM_PRIOR.

        `values` are parameters (p,) in SI units; `covariance` (p, p) is the posterior of their logarithms;
        `reference_temperature` in degC.
        """
        _, slope = self.standardised(values, reference_temperature)
        ratio = np.sqrt(np.einsum("mi,ij,mj->m", slope, covariance, slope))
        names = [self._written(name) for name in values if self._written(name) in self.usual]
        wide = {name for name, value in zip(names, ratio, strict=True) if value > FROM_PRIOR}
        # Where only the slope of the shift is determined, c1 comes from the prior as c2 does.
        return tuple(
            name for name in values if self._written(name) in wide or (name == "c1" and "c2" in wide)
        )

    @staticmethod
    def _written(name: str) -> str:
        return "wlf_slope" if name == "c1" else name


ASPHALT_CONCRETE = Prior(USUAL)
# A sigmoid has no end of its own power: what it takes for the static modulus lies below that of the other laws.
_LOW_END = Usual(
    10e6,
    1.5,
    "Pa",
    "0.5-190 MPa; 8-41 MPa in mixes of the NCAT Test Track whose tests determine it, less in those that do not",
)


_OF_HIRSCH = 0.15  # standard deviation of ln: the regression misses |E*| of its own mixes by about as much


def prior_of(law: str, volumetrics: tuple[float, float] | None = None) -> Prior:
    """What the parameters of a law, one of LAWS, usually are for asphalt concrete.

    Of a mix of known `volumetrics`, VMA and VFA in percent, the glassy modulus is near the limiting one of R 84.

    >>> prior_of("sigmoid").usual["static_modulus"].median, prior_of("cam") is ASPHALT_CONCRETE
    (10000000.0, True)
    """
    usual = {**USUAL, "static_modulus": _LOW_END} if law == "sigmoid" else USUAL
    if volumetrics is None:
        return ASPHALT_CONCRETE if usual is USUAL else Prior(usual)
    limit = Usual(limiting_modulus(*volumetrics), _OF_HIRSCH, "Pa", "AASHTO R 84 by VMA and VFA")
    return Prior({**usual, "glassy_modulus": limit})
