"""Slips of a unit or a label that tests show beside each other, though each value alone could be true.

A table has columns specimen, temperature_C (of the isotherm), frequency_Hz, E_MPa and phase_deg.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from asphalt_nscd.files.words import specimen_named
from asphalt_nscd.measurements.limits import LIMITS, least_modulus
from asphalt_nscd.measurements.units import MEGAPASCAL, celsius_of_fahrenheit

# What |E*| in another unit is of |E*| in MPa.
FACTORS = {unit: 1.0 / MEGAPASCAL[unit] for unit in ("psi", "ksi", "GPa", "kPa", "kgf/cm2")}
NEAR = 0.25  # of ln |E*|: a specimen is within a quarter of the others
ALIKE = 0.35  # of ln |E*|, to either side: how far the ratio to the others may vary over conditions
STIFFER = np.log(1.8)  # by which no mix grows stiffer as it warms, whatever else is wrong with a test
# Mean gain of a sweep where every test of it grew stiffer: three times what the level of one wobbles between isotherms.
STIFFER_OF_ONE = np.log(1.4)  # for one specimen; the mean of several wobbles less
SURE = 3.0  # standard errors of the mean gain
MOST_GAIN = np.log(10.0)  # beyond this gain a unit is as likely wrong
LEAST_STEP = 3.0  # K between two isotherms that are compared
LEAST = 3  # shared conditions
# Of ln |E*|, each step down: no mix and no machine lowers it so over four frequencies and more, or over three.
FALLING, FALLING_OF_THREE = 0.2, 0.4
LEAST_SLOPE = 0.05  # of ln |E*| over ln f that is no scatter: a phase of 4.5 deg
FULL_CIRCLE = 2.0 * np.pi
# On the cold side |E*| is the glassy modulus x exp(-0.062 phase), within 30 %, in 2S2P1D, Huet-Sayegh, Havriliak-Negami
# and Maxwell laws of mixes. Glassy moduli are 19 to 51 GPa (rheology/priors), and 8 GPa of cold recycled mixes.
FALL = 0.062  # of ln |E*| by a degree of phase
PHASE_SEEN = 27.0  # deg
GLASSY_OF_MIXES = (7e3, 1e5)  # MPa; no mix is beyond these
USUAL_GLASSY = (14e3, 60e3)  # MPa, which a table in another unit must come to
MOST_TESTS = 0.75  # of a table in the unit that it says; single ones may be wrong
TURNED = 10.0  # deg, within which 90 less a phase is what |E*| requires
SMOOTH = 0.15  # of ln |E*|
SWEEP = "specimen", "temperature_C"
OFF_SWEEP = 0.3  # of the logarithm, by which a value without its digit too many may leave its sweep
# Of ln |E*| over the isotherms, that few mixes leave of a parabola, or of a line where these are few.
ROUGH = 0.8
# The same over temperatures stretched by the slope of ln |E*| over ln f there, which no unit changes: 125 drawn or
# measured tables of three isotherms leave 0.2 at most, and 0.3 or more with one isotherm in ksi.
STEEP = 0.3
COLD = 25.0  # degC; at warmer ones the phase falls again as a mix grows softer


def slips(table: pd.DataFrame) -> Iterator[str]:
    """A sentence with the mend for each slip of a unit or a label; most tables have none."""
    yield from units_of_labels(table)
    yield from _lonely_frequencies(table)
    yield from _order_of_frequencies(table)
    yield from _radians(table)
    yield from _complements(table)
    moduli = [*_units_of_moduli(table), *_units_of_isotherms(table)]
    yield from moduli
    # A wrong unit makes isotherms seem exchanged, too: it is told alone.
    if not moduli:
        yield from _warmer_but_stiffer(table)
        yield from _order_of_isotherms(table)
        yield from _unit_of_all_moduli(table)


def digit_too_many(table: pd.DataFrame, name: str) -> tuple[int, str] | None:
    """Row, from 0, and a sentence on the first value of column `name` with a digit too many; None if there is none.

    It is above the limits of `name`, and the other frequencies of its sweep ask for a tenth or a hundredth of it.
    """
    limits, unit = LIMITS[name], name.rpartition("_")[2]
    words = "|E*|" if name == "E_MPa" else "phase"
    inside = table[table[name].between(limits.low, limits.high)]
    for row in np.flatnonzero(table[name] > limits.high):
        value, key = float(table[name].iloc[row]), table[list(SWEEP)].iloc[row]
        others = inside[(inside[list(SWEEP)] == key).all(axis=1)].sort_values("frequency_Hz")
        if len(others) < 2:
            continue
        log_f = np.log(table["frequency_Hz"].iloc[row])
        expected = float(np.interp(log_f, np.log(others["frequency_Hz"]), others[name]))
        times = 10.0 ** np.round(np.log10(value / expected)) if expected > 0.0 else 1.0
        if times > 1.0 and abs(np.log(value / times / expected)) < OFF_SWEEP:
            asked = f"{float(f'{expected:.3g}'):g} {unit}"
            return int(row), (
                f"{words} {value:g} {unit}, where its other frequencies ask for about {asked}: a digit too many, or a "
                f"lost decimal point? {value / times:g} {unit} would fit; correct it."
            )
    return None


def units_of_labels(table: pd.DataFrame) -> Iterator[str]:
    """Temperatures in degF and frequencies in rad/s below names that say degC and Hz."""
    temperature = np.sort(table["temperature_C"].unique())
    celsius = celsius_of_fahrenheit(temperature)
    # Of 39.2, 50 and 68 degF the last two are whole as they stand: two at least must not be.
    if temperature.size >= LEAST and _whole(celsius).all() and (~_whole(temperature)).sum() >= 2:
        yield (
            f"the temperatures {_listed(temperature)} are {_listed(np.round(celsius))} degC in degrees "
            "Fahrenheit; write the unit F into the name of the column."
        )
    frequency = np.sort(table["frequency_Hz"].unique())
    turns, ends = frequency / FULL_CIRCLE, frequency[[0, -1]]
    whole = _short(turns).all() and not _short(frequency).any()
    # A sweep from 0.628 to 62.8 may have other steps between.
    if frequency.size > LEAST and (whole or (_short(turns[[0, -1]], 1).all() and not _short(ends).any())):
        yield (
            f"the frequencies {_listed(frequency)} are 2 pi times {_listed(turns)}: they look like "
            "rad/s; divide them by 2 pi, or name their column (in an export, their line) 'omega (rad/s)'."
        )


def _lonely_frequencies(table: pd.DataFrame) -> Iterator[str]:
    """A sentence on a sweep with one frequency that no other has, a power of ten times the one that it alone lacks."""
    sweeps = table.groupby(["specimen", "temperature_C"])["frequency_Hz"].agg(set)
    for (specimen, temperature), own in sweeps.items() if len(sweeps) >= LEAST else ():
        others = list(sweeps.drop(index=(specimen, temperature)))
        alone, lacking = own.difference(*others), set.intersection(*others) - own
        if len(alone) != 1 or len(lacking) != 1:
            continue
        (lonely,), (usual,) = alone, lacking
        decades = np.log10(lonely / usual)
        if round(decades) and np.isclose(decades, round(decades)):
            yield (
                f"{specimen_named(str(specimen))} at {temperature:g} degC has {lonely:g} Hz, which no other sweep has, "
                f"and lacks {usual:g} Hz, which every other has: correct the frequency."
            )


def _order_of_frequencies(table: pd.DataFrame) -> Iterator[str]:
    """Sentences on |E*| that falls as the frequency rises: in most sweeps, else in single ones."""
    sweeps = [(slope, phase) for _, _, slope, phase in _sweeps(table)]
    if not sweeps:
        return
    slope, phase = np.array(sweeps).T
    if np.mean(slope < -LEAST_SLOPE) >= 0.8 and np.median(phase) > 90.0 * LEAST_SLOPE:
        yield (
            "|E*| falls as the frequency rises, while the phases say that it rises: the frequencies look listed in "
            "reverse order, or the names of |E*| and phase exchanged; correct them."
        )
        return
    for (specimen, temperature), tests in table.groupby(["specimen", "temperature_C"]):
        steps = np.diff(np.log(tests.groupby("frequency_Hz")["E_MPa"].mean()))
        least = FALLING if steps.size >= LEAST else FALLING_OF_THREE
        if steps.size >= 2 and (steps < 0.0).all() and steps.sum() < -least:
            fall = -100.0 * np.expm1(steps.sum())
            yield (
                f"|E*| of {specimen_named(str(specimen))} at {temperature:g} degC falls by {fall:.0f} % as the "
                "frequency rises: its frequencies look listed in reverse order; correct them."
            )


def _radians(table: pd.DataFrame) -> Iterator[str]:
    """A sentence on each sweep whose phases are small as in radians, beside what |E*| requires."""
    for specimen, temperature, slope, phase in _sweeps(table):
        required = 90.0 * slope  # deg, by Kramers and Kronig to first order
        # In radians it is a 57th of itself in degrees: far below what |E*| requires, and near to it once converted.
        if slope > LEAST_SLOPE and phase < 0.2 * required and 0.5 < np.degrees(phase) / required < 2.0:
            yield (
                f"the phases of {specimen_named(str(specimen))} at {temperature:g} degC (median {phase:.3g}) look "
                f"like radians: its moduli require about {required:.0f} deg; multiply them by 180/pi."
            )


def _complements(table: pd.DataFrame) -> Iterator[str]:
    """Sentences on phases given as 90 deg minus the phase: of a specimen, by the other specimens, else of isotherms."""
    seen = pd.DataFrame(_sweeps(table), columns=["specimen", "temperature_C", "slope", "phase_deg"])
    seen["required"] = 90.0 * seen["slope"]
    seen["turned"] = 90.0 - seen["phase_deg"]
    unclear = (seen["turned"] - seen["phase_deg"]).abs() <= 2.0 * TURNED  # near 45 deg the two are alike
    # Another specimen is the witness; of two sweeps, each 90 deg less the other, |E*| tells which one is wrong.
    nearer = (seen["turned"] - seen["required"]).abs() < (seen["phase_deg"] - seen["required"]).abs() - TURNED
    alike = [
        bool(
            ((seen["phase_deg"] - one.turned).abs() < TURNED)[
                seen["temperature_C"] == one.temperature_C
            ].any()
        )
        for one in seen.itertuples()
    ]
    alone = seen[nearer & np.array(alike, bool) & ~unclear]
    for specimen, own in alone.groupby("specimen", sort=False):
        whole = len(own) > 1 and not ((seen["specimen"] == specimen) & ~unclear).drop(own.index).any()
        where = "in all its tests" if whole else f"at {_listed(own['temperature_C'].to_numpy())} degC"
        yield _complement(
            f"of {specimen_named(str(specimen))} {where}", own, "|E*| and the other specimens ask for"
        )
    rest = seen.drop(columns="specimen").drop(alone.index).groupby("temperature_C", as_index=False).median()
    at = rest[(rest["turned"] - rest["required"]).abs() < TURNED]
    at = at[at["phase_deg"] - at["required"] > 2.0 * TURNED]
    if len(at):
        yield _complement(f"at {_listed(at['temperature_C'].to_numpy())} degC", at, "|E*| requires")


def _complement(where: str, sweeps: pd.DataFrame, who: str) -> str:
    phases, asked = sweeps["phase_deg"].to_numpy(), sweeps["turned"].round().to_numpy()
    return (
        f"the phases {where} (median {_listed(phases)}) look like 90 deg less the phase: {who} about {_listed(asked)} "
        "deg; subtract them from 90."
    )


def _units_of_isotherms(table: pd.DataFrame) -> Iterator[str]:
    """A sentence on an isotherm whose mean |E*| falls smoothly between the others only if it is in another unit."""
    logarithm = _pivot_conditions(table).mean(axis=1).unstack(level=0).dropna()
    temperature = logarithm.columns.to_numpy(float)
    if len(logarithm) < 2 or temperature.size < LEAST:
        return
    level = logarithm.mean().to_numpy()
    degree = 2 if temperature.size > LEAST + 1 else 1

    def roughness(values: NDArray[np.float64], along: NDArray[np.float64]) -> float:
        """Range of a level of ln |E*| (t,) about its parabola or line `along` (t,)."""
        return float(np.ptp(values - np.polyval(np.polyfit(along, values, degree), along)))

    slope = np.maximum(np.polyfit(np.log(logarithm.index), logarithm, 1)[0], LEAST_SLOPE)
    steep = np.cumsum(np.diff(temperature, prepend=temperature[0]) * (slope + np.roll(slope, 1)))
    tried = [
        (roughness(level - np.log(factor) * (temperature == t), temperature), float(t), unit)
        for t in temperature
        for unit, factor in FACTORS.items()
        if unit != "kgf/cm2"  # ten times: a temperature in degF moves |E*| as far
        if (np.diff(level - np.log(factor) * (temperature == t)) < 0.0).all()
    ]
    if not tried:
        return
    least = min(tried)[0]
    likely = [one for one in tried if one[0] < max(2.0 * least, SMOOTH)]
    if len({unit for _, _, unit in likely}) > 1 or roughness(level, steep) < STEEP:
        return
    if roughness(level, temperature) < max(4.0 * least, ROUGH):
        return
    at = " or ".join(f"{t:g}" for _, t, _ in likely)
    unit = likely[0][2]
    yield (
        f"at {at} degC |E*| is about {FACTORS[unit]:.3g} times what the other temperatures let expect, as it would be "
        f"in {unit}; give it in MPa."
    )


def _units_of_moduli(table: pd.DataFrame) -> Iterator[str]:
    """Sentences on specimens whose |E*| is to that of the others as in another unit, everywhere or at an isotherm."""
    logarithm = _pivot_conditions(table)
    if logarithm.shape[1] < 2:
        return
    # Without the specimen itself: of two or three its own slip would draw the median along.
    others = pd.DataFrame({name: logarithm.drop(columns=name).median(axis=1) for name in logarithm})
    apart = logarithm - others
    for specimen in apart:
        whole = _unit(apart[specimen].dropna())
        parts = {} if whole else {t: _unit(x.dropna()) for t, x in apart[specimen].groupby(level=0)}
        for where, unit in ({"every condition": whole} if whole else parts).items():
            if not unit:
                continue
            place = where if isinstance(where, str) else f"{where:g} degC"
            yield (
                f"at {place} |E*| of {specimen_named(str(specimen))} is {FACTORS[unit]:.3g} times that of the "
                f"others, as it would be in {unit}; give it in MPa."
            )
        if whole and logarithm.shape[1] == 2:
            return  # the other one is as far from it, and one sentence says so


def _warmer_but_stiffer(table: pd.DataFrame) -> Iterator[str]:
    """A sentence on each isotherm at which specimens are surely stiffer than at a colder one, at every frequency."""
    logarithm = _pivot_conditions(table)
    isotherms = logarithm.index.unique(level=0)
    for cold in isotherms:
        for warm in isotherms[isotherms >= cold + LEAST_STEP]:
            apart = logarithm.loc[warm] - logarithm.loc[cold]
            gains = apart.loc[:, apart.notna().sum() >= LEAST]
            if gains.empty or not (gains.isna() | (gains > 0.0)).all(axis=None):
                continue
            means = gains.mean().to_numpy()
            root = np.sqrt(means.size)
            error = means.std(ddof=1) / root if means.size > 1 else 0.0
            if max(STIFFER_OF_ONE / root, SURE * error) < means.mean() < MOST_GAIN:
                one = f" of {specimen_named(str(gains.columns[0]))}" if means.size == 1 else ""
                every = "at every frequency" + " in every specimen" * (means.size > 1)
                yield (
                    f"the tests{one} at {warm:g} degC are stiffer than those at {cold:g} degC {every}, "
                    f"by {np.exp(means.mean()):.2g} times: {_meant(logarithm, warm, cold)}correct the temperatures."
                )


def _meant(logarithm: pd.DataFrame, warm: float, cold: float) -> str:
    """The question for a temperature that lost its minus, or that is in degF, whichever |E*| lies nearer to."""
    level = logarithm.mean(axis=1).groupby(level=0).mean()
    others = level.drop(index=warm)
    if others.size < LEAST - 1:
        return f"was -{warm:g} degC meant? " if warm > 0.0 and -warm < cold else ""
    slope, base = np.polyfit(others.to_numpy(), others.index.to_numpy(), 1)
    expected, celsius = base + slope * level[warm], celsius_of_fahrenheit(np.array([warm]))
    options = {f"-{warm:g} degC": -warm} if warm > 0.0 and -warm < cold else {}
    if _whole(celsius).all() and celsius[0] < cold:
        options[f"{warm:g} degF, that is {celsius[0]:.0f} degC,"] = float(celsius[0])
    nearest = min(options, key=lambda words: abs(options[words] - expected), default="")
    return f"was {nearest} meant? " if nearest else ""


def _order_of_isotherms(table: pd.DataFrame) -> Iterator[str]:
    """A sentence for two isotherms of a specimen: the warmer one is stiffer by STIFFER or more, at every frequency."""
    for specimen, logarithm in _pivot_conditions(table).items():
        rows = logarithm.dropna().unstack(level=0)
        for cold in rows:
            for warm in rows.columns[rows.columns >= cold + LEAST_STEP]:
                gain = (rows[warm] - rows[cold]).dropna()
                if len(gain) >= LEAST and (gain > STIFFER).all():
                    yield (
                        f"{specimen_named(str(specimen))} is {np.exp(gain.median()):.3g} times as stiff at "
                        f"{warm:g} degC as at {cold:g} degC: a temperature or a unit is wrong, or the two are "
                        "exchanged; correct it."
                    )


def _unit_of_all_moduli(table: pd.DataFrame) -> Iterator[str]:
    """A sentence if |E*| of all specimens, each on its coldest isotherm with a slope, does not fit its phase."""
    glassy, told, done = [], "", set()
    for specimen, temperature, slope, phase in _sweeps(table):
        # In the cold the slope may be scatter, and the next isotherm tells.
        if specimen in done or slope <= LEAST_SLOPE:
            continue
        done.add(specimen)
        tests = table[(table["specimen"].astype(str) == specimen) & (table["temperature_C"] == temperature)]
        required = 90.0 * slope  # deg, by Kramers and Kronig: it knows no unit, and no offset of the phase
        seen = max(phase, required)
        agree = 0.6 < phase / required < 1.6
        if temperature > COLD or seen > PHASE_SEEN or not agree or not _is_cold_side(tests):
            continue
        modulus = float(tests["E_MPa"].median())
        glassy.append(modulus * np.exp(FALL * seen))
        told = told or (
            f"at {temperature:g} degC |E*| of {specimen_named(str(specimen))} is {float(f'{modulus:.3g}'):g} MPa "
            f"at a phase of {phase:.2g} deg"
        )
    low, high = GLASSY_OF_MIXES
    if 2 * len(glassy) < table["specimen"].nunique() or not (max(glassy) < low or min(glassy) > high):
        return
    middle, (least, most) = float(np.median(glassy)), USUAL_GLASSY
    units = [unit for unit, factor in FACTORS.items() if least < middle / factor < most]
    likely = f"is the unit {' or '.join(units)}?" if units else "is the unit another, such as ksi or GPa?"
    yield (
        f"{told}, {'less' if middle < low else 'more'} than any asphalt has at such a phase: {likely} Write the unit "
        f"into the name of the column, as in E ({units[0] if units else 'ksi'})."
    )


def unit_in_question(table: pd.DataFrame, unit: str) -> str | None:
    """What to ask if |E*|, converted from `unit`, is impossible, but the bare numbers fit in MPa; None otherwise."""
    as_megapascal = table.assign(E_MPa=table["E_MPa"] * FACTORS[unit])
    if _possible(table, MOST_TESTS) or not _possible(as_megapascal, 1.0):
        return None
    reached = float(f"{table['E_MPa'].max():.3g}")
    only, much = ("", "stiff") if FACTORS[unit] < 1.0 else ("only ", "soft")
    return (
        f"read as {unit} |E*| reaches {only}{reached:g} MPa, too {much} for asphalt; read as MPa "
        "it fits: is the unit MPa?"
    )


def _possible(table: pd.DataFrame, share: float) -> bool:
    """Whether at least `share` of the tests have |E*| as mixes do, and |E*| of the table fits its phases."""
    modulus, most = table["E_MPa"], LIMITS["E_MPa"].high
    least = least_modulus(table["temperature_C"], table["frequency_Hz"])
    return bool(modulus.between(least, most).mean() >= share) and not any(_unit_of_all_moduli(table))


def _is_cold_side(tests: pd.DataFrame) -> bool:
    """Whether a sweep is smooth, and its phase falls as f rises or, where a delay hides that, ln |E*| bends down."""
    logarithm, modulus = np.log(tests["frequency_Hz"]), np.log(tests["E_MPa"])
    parabola = np.polyfit(logarithm, modulus, 2)
    smooth = np.std(modulus - np.polyval(parabola, logarithm)) < SMOOTH
    falls = np.polyfit(logarithm, tests["phase_deg"], 1)[0] < 0.0
    return bool(smooth and (falls or parabola[0] < 0.0))


def _sweeps(table: pd.DataFrame) -> Iterator[tuple[str, float, float, float]]:
    """Specimen, isotherm, slope of ln |E*| over ln f, and median phase [deg] of each sweep over frequencies."""
    for (specimen, temperature), tests in table.groupby(["specimen", "temperature_C"]):
        if tests["frequency_Hz"].nunique() >= LEAST:
            slope = np.polyfit(np.log(tests["frequency_Hz"]), np.log(tests["E_MPa"]), 1)[0]
            yield str(specimen), float(temperature), float(slope), float(tests["phase_deg"].median())


def _pivot_conditions(table: pd.DataFrame) -> pd.DataFrame:
    """ln |E*|: a row for each temperature and frequency, a column for each specimen."""
    logarithm = table.assign(logarithm=np.log(table["E_MPa"]))
    return logarithm.pivot_table(
        index=["temperature_C", "frequency_Hz"], columns="specimen", values="logarithm", aggfunc="mean"
    )


def _unit(apart: pd.Series) -> str | None:
    """The unit whose ln of FACTORS these differences of ln |E*| are, within NEAR; None if they vary or fit none."""
    if len(apart) < LEAST or apart.max() - apart.min() > 2.0 * ALIKE:
        return None
    near = {unit: abs(apart.median() - np.log(factor)) for unit, factor in FACTORS.items()}
    unit = min(near, key=lambda name: near[name])
    return unit if near[unit] < NEAR else None


def _whole(values: NDArray[np.float64]) -> NDArray[np.bool_]:
    return np.abs(values - np.round(values)) < 0.03


def _short(values: NDArray[np.float64], digits: int = 2) -> NDArray[np.bool_]:
    """Whether each value (n,) is within a thousandth of a number of so many digits."""
    rounded = np.array([float(f"{value:.{digits}g}") for value in values])
    return np.abs(values / rounded - 1.0) < 1e-3


def _listed(values: NDArray[np.float64]) -> str:
    words = [f"{value:.4g}" for value in values]
    return f"{', '.join(words[:-1])} and {words[-1]}" if len(words) > 1 else words[0]
