"""What can be wrong with a campaign: causes of the catalogue, faults that it lacks, bad tests, slips of the pen.

    table = put(campaign, [Fault("phase_offset", 1.2), Fault("loose_clamp", 3e-12, specimen="S2")])

A signal passes specimen, clamp, head and channel in this order (`Chain`); what a pen does comes last. Sizes are in the
unit of `UNITS`.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd

from .laboratory import Campaign, written
from .mixes import GAS, KELVIN, Complex

# The trapezoid of the paper: EN 12697-26, annex A, and the mass of its own that a head would feel is not in this.
SMALL, LARGE, THICK, HIGH = 0.025, 0.056, 0.025, 0.25  # m
_RATIO = SMALL / LARGE
FORM_FACTOR = (
    12.0 * HIGH**3 / (THICK * (LARGE - SMALL) ** 3) * ((2.0 - _RATIO / 2.0) * _RATIO - 1.5 - np.log(_RATIO))
)  # 1/m: E* = FORM_FACTOR F/z


@dataclass(frozen=True)
class Fault:
    """kind: a key of CHAIN or PEN; size in the unit of UNITS; what it is confined to; other: a second place.

    shape: of a secondary process (ln time at 20 degC, J/mol, exponent), else empty.
    """

    kind: str
    size: float = 0.0
    specimen: str | None = None
    temperature: float | None = None
    frequencies: tuple[float, ...] = ()
    other: str | float | None = None
    shape: tuple[float, ...] = ()

    def rows(self, campaign: Campaign) -> np.ndarray:
        """(n,) tests that it hits."""
        rows = campaign.at(self.specimen, self.temperature)
        if self.frequencies:
            rows &= campaign.tests["frequency_Hz"].isin(self.frequencies).to_numpy()
        return rows


class Chain:
    """What a signal passes, for each test (n,): the specimen, its clamp, the head, the channel."""

    def __init__(self, campaign: Campaign):
        n = len(campaign.tests)
        self.campaign = campaign
        self.warming, self.tuning = np.zeros(n), np.ones(n)  # K; true frequency over the stated one
        self.softer = np.ones(n)  # factor on the specimen's modulus
        self.branch = np.zeros(n, complex)  # Pa, in parallel within the mix
        self.compliance = np.zeros(n)  # 1/Pa, in series
        self.head = np.zeros(n, complex)  # Pa, in parallel beside the specimen
        self.channel = np.zeros(n, complex)  # ln of what the channels make of F/z

    def log_modulus(self) -> Complex:
        """ln E* (n,) [Pa] that is recorded."""
        campaign = self.campaign
        whole = campaign.response(self.warming, self.tuning) + campaign.own
        modulus = np.exp(whole) * self.softer + self.branch
        return np.log(modulus / (1.0 + self.compliance * modulus) + self.head) + self.channel


def _delay(chain: Chain, fault: Fault) -> None:
    chain.channel += 1j * chain.campaign.omega * fault.size * fault.rows(chain.campaign)


def _offset(chain: Chain, fault: Fault) -> None:
    chain.channel += 1j * np.radians(fault.size) * fault.rows(chain.campaign)


def _warmer(chain: Chain, fault: Fault) -> None:
    chain.warming += fault.size * fault.rows(chain.campaign)


def _self_heating(chain: Chain, fault: Fault) -> None:
    campaign = chain.campaign
    power = campaign.omega * np.exp(campaign.unmoved()).imag
    if "amplitude_m" in campaign.tests:
        power = power * campaign.tests["amplitude_m"].to_numpy() ** 2
    chain.warming += fault.size * power / power.max()


def _geometry(chain: Chain, fault: Fault) -> None:
    chain.softer *= 1.0 + fault.size * fault.rows(chain.campaign)


def _clamp(chain: Chain, fault: Fault) -> None:
    chain.compliance += fault.size * fault.rows(chain.campaign)


def _friction(chain: Chain, fault: Fault) -> None:
    tests = chain.campaign.tests
    share = 1.0 if "amplitude_m" not in tests else tests["amplitude_m"].median() / tests["amplitude_m"]
    chain.head += 1j * fault.size * np.asarray(share)


def _mass(chain: Chain, fault: Fault) -> None:
    chain.head -= FORM_FACTOR * fault.size * chain.campaign.omega**2


def _softening(chain: Chain, fault: Fault) -> None:
    amplitude = chain.campaign.tests["amplitude_m"].to_numpy()
    chain.softer *= 1.0 - fault.size * amplitude / amplitude.max()


def _damage(chain: Chain, fault: Fault) -> None:
    order = chain.campaign.tests["order"].to_numpy(float)
    chain.softer *= 1.0 - fault.size * (order - order.min()) / np.ptp(order)


def _secondary(chain: Chain, fault: Fault) -> None:
    """A loss peak beside the law, with a shift of its own."""
    log_time, energy, exponent = fault.shape
    campaign = chain.campaign
    shift = energy / GAS * (1.0 / (campaign.temperature + KELVIN) - 1.0 / (20.0 + KELVIN))
    s = np.exp(exponent * (np.log(campaign.omega) + log_time + shift + 0.5j * np.pi))
    chain.branch += fault.size * s / (1.0 + s)


def _gain_with_temperature(chain: Chain, fault: Fault) -> None:
    chain.channel += np.log1p(fault.size / 100.0 * (chain.campaign.temperature - 20.0))


def _aliased(chain: Chain, fault: Fault) -> None:
    """Too few samples in a cycle: what is held for one of them comes half of it late, and smaller."""
    half = np.pi / fault.size
    chain.channel += (1j * half + np.log(np.sin(half) / half)) * fault.rows(chain.campaign)


def _retuned(chain: Chain, fault: Fault) -> None:
    chain.tuning *= np.where(fault.rows(chain.campaign), fault.size, 1.0)


def _zero_drift(chain: Chain, fault: Fault) -> None:
    """A force that runs off at a steady rate: over one cycle a ramp, whose first harmonic is in quadrature."""
    unmoved = np.exp(chain.campaign.unmoved())
    slowest = chain.campaign.omega.min()
    chain.head += 1j * fault.size * np.abs(unmoved).min() * slowest / chain.campaign.omega


def _low_pass(chain: Chain, fault: Fault) -> None:
    """One pole at fault.size [Hz] in the displacement channel."""
    chain.channel += np.log1p(1j * chain.campaign.omega / (2.0 * np.pi * fault.size))


def _resonance(chain: Chain, fault: Fault) -> None:
    """The frame's mode at fault.size [Hz], damped by 3 %, in the force channel; it takes a fiftieth part."""
    x = chain.campaign.omega / (2.0 * np.pi * fault.size)
    chain.channel += np.log1p(0.02 * x**2 / (1.0 - x**2 + 0.06j * x))


def _bad(chain: Chain, fault: Fault) -> None:
    """Single readings that are wrong: |E*| by a factor of 1 + size, and four degrees of phase with the same sign."""
    turn = 1j * np.radians(4.0) * np.sign(fault.size)
    chain.channel += (np.log1p(fault.size) + turn) * fault.rows(chain.campaign)


def _slip_of_ten(chain: Chain, fault: Fault) -> None:
    chain.channel += np.log(10.0) * fault.size * fault.rows(chain.campaign)


CAUSES: dict[str, Callable[[Chain, Fault], None]] = {
    "channel_delay": _delay,
    "phase_offset": _offset,
    "temperature_bias": _warmer,
    "self_heating": _self_heating,
    "specimen_geometry": _geometry,
    "loose_clamp": _clamp,
    "guide_friction": _friction,
    "moving_mass": _mass,
    "strain_softening": _softening,
    "damage": _damage,
    "secondary_process": _secondary,
}
CATALOGUE = tuple(CAUSES)
CHAIN = CAUSES | {
    "offset of one specimen": _offset,
    "delay of one specimen": _delay,
    "offset of one isotherm": _offset,
    "temperature of one specimen on one isotherm": _warmer,
    "gain with temperature": _gain_with_temperature,
    "aliasing": _aliased,
    "wrong top frequency": _retuned,
    "zero drift": _zero_drift,
    "low-pass filter": _low_pass,
    "resonance": _resonance,
    "single bad test": _bad,
    "masked pair of bad tests": _bad,
    "slip of ten": _slip_of_ten,
}
UNITS = {
    "channel_delay": "s", "phase_offset": "deg", "temperature_bias": "K", "self_heating": "K", "specimen_geometry": "1",
    "loose_clamp": "1/Pa", "guide_friction": "Pa", "moving_mass": "kg", "strain_softening": "1", "damage": "1",
    "secondary_process": "Pa", "offset of one specimen": "deg", "delay of one specimen": "s",
    "offset of one isotherm": "deg", "temperature of one specimen on one isotherm": "K", "gain with temperature": "%/K",
    "aliasing": "samples in a cycle", "wrong top frequency": "true over stated", "zero drift": "of the least |E*|",
    "low-pass filter": "Hz", "resonance": "Hz", "single bad test": "1", "masked pair of bad tests": "1",
    "slip of ten": "powers", "wrong recorded temperature": "K",
}  # fmt: skip


def _exchanged_specimens(table: pd.DataFrame, fault: Fault) -> pd.DataFrame:
    """The files of two specimens on one isotherm stand under each other's name."""
    here = table["temperature_C"] == fault.temperature
    names = {fault.specimen: fault.other, fault.other: fault.specimen}
    return table.assign(specimen=table["specimen"].where(~here, table["specimen"].replace(names)))


def _exchanged_isotherms(table: pd.DataFrame, fault: Fault) -> pd.DataFrame:
    """Two files of one specimen stand under each other's temperature."""
    mine = table["specimen"] == fault.specimen
    labels = {fault.temperature: fault.other, fault.other: fault.temperature}
    noted = table["temperature_C"]
    return table.assign(temperature_C=noted.where(~mine, noted.replace(labels)))


def _copied(table: pd.DataFrame, fault: Fault) -> pd.DataFrame:
    """A specimen's numbers on one isotherm are those of another one, to the last digit."""
    columns = ["E_MPa", "phase_deg"]
    keys = [name for name in ("frequency_Hz", "amplitude_m") if name in table]
    here = table["temperature_C"] == fault.temperature
    given = table[here & (table["specimen"] == fault.other)]
    own = table[here & (table["specimen"] == fault.specimen)]
    copied = own[keys].reset_index().merge(given[[*keys, *columns]], on=keys).set_index("index")
    table = table.copy()
    table.loc[copied.index, columns] = copied[columns]
    return table


def _recorded(table: pd.DataFrame, fault: Fault) -> pd.DataFrame:
    """The temperature of one sweep was noted wrongly; the specimen had the right one."""
    sweep = (table["specimen"] == fault.specimen) & (table["temperature_C"] == fault.temperature)
    return table.assign(temperature_C=table["temperature_C"] + fault.size * sweep)


PEN: dict[str, Callable[[pd.DataFrame, Fault], pd.DataFrame]] = {
    "exchanged specimens": _exchanged_specimens,
    "exchanged isotherms": _exchanged_isotherms,
    "copied block": _copied,
    "wrong recorded temperature": _recorded,
}


def put(campaign: Campaign, faults: Sequence[Fault]) -> pd.DataFrame:
    """The table of a campaign with these faults in it: columns of its tests, E_MPa and phase_deg."""
    chain = Chain(campaign)
    for fault in faults:
        if fault.kind in CHAIN:
            CHAIN[fault.kind](chain, fault)
    table = written(campaign, chain.log_modulus())
    for fault in faults:
        if fault.kind in PEN:
            table = PEN[fault.kind](table, fault)
    return table
