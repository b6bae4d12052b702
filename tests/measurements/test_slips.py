"""Slips of unit and label in tables that are right but for them, and none in tables that are right or merely bad."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest

from asphalt_nscd.measurements.slips import digit_too_many, slips, unit_in_question
from asphalt_nscd.rheology.parabolic import HuetSayegh
from asphalt_nscd.rheology.shift import WLF

FREQUENCIES = np.array([0.1, 0.5, 1.0, 5.0, 10.0, 25.0])


def campaign(specimens=3):
    """|E*| = 9 GPa (f a_T)^0.2 and the phase that belongs to it, with scatter; isotherms as AASHTO has them."""
    rng = np.random.default_rng(3)
    rows = [
        (name, t, f, 9e3 * (f * 10 ** (-0.12 * t)) ** 0.2, 18.0)
        for name in "ABCDE"[:specimens]
        for t in (-10.0, 4.0, 21.0, 37.0)
        for f in FREQUENCIES
    ]
    table = pd.DataFrame(rows, columns=["specimen", "temperature_C", "frequency_Hz", "E_MPa", "phase_deg"])
    table["E_MPa"] *= np.exp(0.05 * rng.standard_normal(len(table)))
    table["phase_deg"] += rng.standard_normal(len(table))
    return table


USUAL = HuetSayegh(80e6, 32e9, k=0.22, h=0.6, delta=2.3, tau=0.3, shift=WLF(18.0, 140.0, 15.0))
SOFT_WHERE_WARM = HuetSayegh(30e6, 28e9, k=0.22, h=0.62, delta=2.0, tau=0.1, shift=WLF(24.0, 110.0, 20.0))
AT_THREE = (4.0, 20.0, 40.0)


def bitumen(celsius=(-10.0, 0.0, 10.0, 20.0, 30.0), said=None, law=USUAL):
    """A law of Huet and Sayegh, three specimens with scatter; `said`: temperatures as the table has them."""
    rng = np.random.default_rng(4)
    rows = [(name, t, f) for name in "ABC" for t in celsius for f in (1.0, 3.0, 10.0, 25.0)]
    table = pd.DataFrame(rows, columns=["specimen", "temperature_C", "frequency_Hz"])
    modulus = law.complex_modulus(
        2.0 * np.pi * table["frequency_Hz"].to_numpy(), table["temperature_C"].to_numpy()
    )
    table["E_MPa"] = np.abs(modulus) * 1e-6 * np.exp(0.02 * rng.standard_normal(len(table)))
    table["phase_deg"] = np.degrees(np.angle(modulus)) + 0.3 * rng.standard_normal(len(table))
    return table.assign(temperature_C=table["temperature_C"].replace(said or {}))


def at(celsius, column, of, table=None):
    """The table with a column of an isotherm, or of all (None), replaced by a function of it."""
    table = bitumen() if table is None else table
    rows = table["temperature_C"] == celsius if celsius is not None else table["temperature_C"] > -99.0
    return table.assign(**{column: table[column].where(~rows, of(table[column]))})


@pytest.mark.parametrize(
    "table, said",
    [
        (at(None, "phase_deg", lambda x: 90.0 - x), "look like 90 deg less the phase"),
        (at(10.0, "phase_deg", lambda x: 90.0 - x), "the phases at 10 degC"),
        (at(None, "E_MPa", lambda x: x / 6.895), "is the unit ksi"),
        (at(None, "E_MPa", lambda x: x * 145.04), "is the unit psi"),
        (at(10.0, "E_MPa", lambda x: x / 6.895), "at 10 degC |E*| is about 0.145 times"),
        (at(30.0, "E_MPa", lambda x: x / 6.895), "degC |E*| is about 0.145 times"),
        (at(0.0, "E_MPa", lambda x: x / 6.895), "as it would be in ksi"),
        (at(40.0, "E_MPa", lambda x: x / 6.895, bitumen(AT_THREE)), "as it would be in ksi"),
        (at(20.0, "E_MPa", lambda x: x * 145.04), "at 20 degC |E*| is about 145 times"),
        (bitumen(said={10.0: 50.0}), "was 50 degF, that is 10 degC, meant?"),
        (bitumen(said={0.0: 32.0}), "was 32 degF, that is 0 degC, meant?"),
        (bitumen((-20.0, 0.0, 10.0, 30.0), {-20.0: 20.0}), "was -20 degC meant?"),
    ],
)
def test_slips_of_a_mix_are_told_by_name(table, said):
    assert said in next(slips(table))


@pytest.mark.parametrize(
    "rows, where",
    [
        ("specimen == 'B' and temperature_C == 10", "of specimen B at 10 degC (median"),
        ("specimen == 'B'", "of specimen B in all its tests"),
        ("specimen in ['A', 'B'] and temperature_C == 0", "of specimen A at 0 degC"),
    ],
)
def test_complements_of_a_specimen_are_told_of_it_alone(rows, where):
    table = bitumen()
    wrong = table.eval(rows)
    table["phase_deg"] = table["phase_deg"].where(~wrong, 90.0 - table["phase_deg"])
    told = [said for said in slips(table) if "90 deg less" in said]
    assert where in told[0] and len(told) == table[wrong]["specimen"].nunique()


def test_phases_that_are_high_in_one_specimen_are_not_taken_for_complements():
    table = bitumen()
    table.loc[table.eval("specimen == 'B' and temperature_C == 20"), "phase_deg"] += 25.0
    assert not list(slips(table))


@pytest.mark.parametrize("name, factor", [("E_MPa", 100.0), ("E_MPa", 1000.0), ("phase_deg", 10.0)])
def test_a_value_with_a_digit_too_many_is_held_against_its_sweep(name, factor):
    table = bitumen()
    row = int(np.flatnonzero(table.eval("specimen == 'B' and temperature_C == 10 and frequency_Hz == 10"))[0])
    table.loc[row, name] *= factor
    found, told = digit_too_many(table, name)
    assert found == row and "digit too many" in told
    assert f"{table.loc[row, name] / factor:g} " in told
    for off, tells in ((1.25, True), (1.6, False)):  # of what its sweep asks for
        assert (
            digit_too_many(
                table.assign(**{name: table[name].where(table.index != row, off * table[name])}), name
            )
            is not None
        ) == tells
    neighbours = table[table.eval("specimen == 'B' and temperature_C == 10")][name].drop(row)
    assert neighbours.min() < float(told.split("about ")[1].split()[0]) < neighbours.max()
    # A whole column in another unit is none.
    table[name] *= factor
    assert digit_too_many(table, name) is None


@pytest.mark.parametrize(
    "celsius", [(-10.0, 0.0, 10.0, 20.0, 30.0), (4.0, 20.0, 40.0), (-10.0, 4.0, 21.0, 37.0, 54.0)]
)
def test_a_mix_without_a_slip_has_none(celsius):
    assert not list(slips(bitumen(celsius)))


def test_a_mix_that_softens_fast_is_not_in_another_unit_there():
    """From 11 GPa at 20 degC to 400 MPa at 40 degC, as its slopes over the frequency ask for."""
    assert not list(slips(bitumen(AT_THREE, law=SOFT_WHERE_WARM)))


def test_a_right_table_has_none():
    assert not list(slips(campaign())) and not list(slips(campaign(1)))


def changed(rows, column, factor):
    table = campaign()
    table.loc[table.eval(rows), column] *= factor
    return table


@pytest.mark.parametrize(
    "table, said",
    [
        (changed("specimen == 'B'", "E_MPa", 0.145), "at every condition |E*| of specimen B is 0.145"),
        (changed("specimen == 'C' and temperature_C == 21", "E_MPa", 0.145), "at 21 degC |E*| of specimen C"),
        (changed("specimen == 'A'", "E_MPa", 145.0), "as it would be in psi"),
        (changed("temperature_C == 37", "E_MPa", 1e3), "as it would be in kPa"),
        (
            changed("specimen == 'A' and temperature_C == 4", "phase_deg", np.pi / 180),
            "of specimen A at 4 degC",
        ),
        (campaign().assign(frequency_Hz=lambda t: 2.0 * np.pi * t["frequency_Hz"]), "look like rad/s"),
        (
            campaign().assign(frequency_Hz=np.tile([0.6283, 2.9, 7.1, 31.0, 55.0, 628.3], 12)),
            "0.6283, 2.9, 7.1, 31, 55 and 628.3 are 2 pi times 0.1, 0.4615, 1.13, 4.934, 8.754 and 100:",
        ),
        (
            campaign().assign(temperature_C=lambda t: 32.0 + 1.8 * t["temperature_C"]),
            "14, 39.2, 69.8 and 98.6 are",
        ),
        (
            campaign().assign(frequency_Hz=np.tile(FREQUENCIES[::-1], 12)),
            "the frequencies look listed in reverse order",
        ),
    ],
)
def test_each_slip_is_the_first_thing_said(table, said):
    assert said in next(slips(table))


@pytest.mark.parametrize("frequencies", [FREQUENCIES, FREQUENCIES[2:], FREQUENCIES[::2]])
def test_frequencies_of_one_sweep_in_reverse_order(frequencies):
    table = campaign()
    table = table[table["frequency_Hz"].isin(frequencies)]
    sweep = (table["specimen"] == "B") & (table["temperature_C"] == 21.0)
    table.loc[sweep, "frequency_Hz"] = frequencies[::-1]
    (said,) = slips(table)
    modulus = table.loc[sweep, "E_MPa"].to_numpy()  # from the lowest frequency, which is called the highest
    fall = 100.0 * (1.0 - modulus[0] / modulus[-1])
    assert said.startswith(f"|E*| of specimen B at 21 degC falls by {fall:.0f} %") and "reverse order" in said
    table.loc[sweep, "frequency_Hz"] = np.roll(
        frequencies, 1
    )  # one step up: no order, and another's work to find
    assert not list(slips(table))


def test_one_frequency_ten_times_what_every_other_sweep_has():
    table = campaign()
    row = table.index[(table["specimen"] == "B") & (table["frequency_Hz"] == 25.0)][2]
    table.loc[row, "frequency_Hz"] = 250.0
    (told,) = slips(table)
    assert told.startswith("specimen B at 21 degC has 250 Hz, which no other sweep has, and lacks 25 Hz")
    # A frequency more, or one in place of another that is no slip of the point, is a laboratory's choice.
    table.loc[row, "frequency_Hz"] = 20.0
    assert not list(slips(table))
    assert not list(slips(pd.concat([campaign(), campaign().loc[[row]].assign(frequency_Hz=250.0)])))


def test_exchanged_isotherms_of_one_specimen():
    table = campaign()
    table.loc[table["specimen"] == "B", "temperature_C"] = table["temperature_C"].replace(
        {21.0: 37.0, 37.0: 21.0}
    )
    (said,) = slips(table)
    assert said.startswith("specimen B is ") and "at 37 degC as at 21 degC" in said


@pytest.mark.parametrize("factor, told", [(1.78, False), (1.82, True)])
def test_a_specimen_is_not_1_8_times_stiffer_where_it_is_warmer(factor, told):
    table = campaign()
    cold, warm = ((table["specimen"] == "B") & (table["temperature_C"] == t) for t in (21.0, 37.0))
    table.loc[warm, "E_MPa"] = factor * table.loc[cold, "E_MPa"].to_numpy()
    assert [said.partition(": ")[0] for said in slips(table)] == [
        "specimen B is 1.82 times as stiff at 37 degC as at 21 degC"
    ] * told


@pytest.mark.parametrize("specimens, every", [(3, " in every specimen, by 2.2"), (1, ", by 2.1")])
def test_isotherm_that_lost_its_minus(specimens, every):
    table = campaign(specimens)
    table["temperature_C"] = table["temperature_C"].replace({-10.0: 10.0})
    said = next(slips(table))
    of = "" if specimens == 3 else " of specimen A"
    assert said.startswith(
        f"the tests{of} at 10 degC are stiffer than those at 4 degC at every frequency{every} times: was -10 "
        "degC meant? correct the temperatures."
    )


def test_minus_lost_by_one_specimen_of_three():
    table = campaign()
    lost = (table["specimen"] == "B") & (table["temperature_C"] == -10.0)
    table.loc[lost, "temperature_C"] = 10.0
    assert "of specimen B at 10 degC are stiffer than those at 4 degC" in next(slips(table))


@pytest.mark.parametrize("specimens, least", [(3, 1.25), (1, 1.45)])
def test_one_specimen_must_be_stiffer_by_more_than_three(specimens, least):
    table = campaign(specimens)
    cold = table[table["temperature_C"] == 4.0].reset_index(drop=True)
    for factor in (least / 1.25, least):
        warm = cold.assign(temperature_C=10.0, E_MPa=factor * cold["E_MPa"])
        found = list(slips(pd.concat([cold, warm])))
        assert bool(found) == (factor == least)
        near = warm.assign(temperature_C=6.9)  # two isotherms are further apart
        assert not list(slips(pd.concat([cold, near])))


@pytest.mark.parametrize(
    "table",
    [
        changed("specimen == 'B'", "E_MPa", 0.5),  # dimensions
        changed("temperature_C == 21", "E_MPa", 0.6),  # gain of a channel
        changed("phase_deg > 0", "phase_deg", 0.5),
        campaign().assign(phase_deg=lambda t: t["phase_deg"] - 15.0),  # an offset of the channel
        campaign().assign(E_MPa=70e3, phase_deg=0.1),  # metal
        campaign().assign(temperature_C=lambda t: t["temperature_C"].replace({4.0: 4.1, 21.0: 20.9})),
        campaign().query("temperature_C == 4"),
        campaign().query("frequency_Hz == 1"),
        campaign().assign(temperature_C=lambda t: 32.1 + 1.8 * t["temperature_C"]),  # no whole degF
        campaign().assign(frequency_Hz=lambda t: 6.31 * t["frequency_Hz"]),  # nor 2 pi
    ],
)
def test_what_is_bad_but_no_slip_goes_on_to_the_diagnosis(table):
    assert not list(slips(table))


def cold(unit=1.0, glassy=30e3, fall=0.062):
    """Isotherms at 4 and 20 degC whose phases grow as they warm, of a mix that is stiff as its phase says."""
    rng = np.random.default_rng(5)
    rows = []
    for name in "ABC":
        for t in (4.0, 20.0):
            phase = 12.0 + 0.5 * (t - 4.0) - 1.5 * np.log(FREQUENCIES)
            # d ln|E*| / d ln f is the phase over 90 deg, by Kramers and Kronig.
            rise = (np.log(FREQUENCIES) * (12.0 + 0.5 * (t - 4.0)) - 0.75 * np.log(FREQUENCIES) ** 2) / 90.0
            modulus = glassy * np.exp(-fall * (12.0 + 0.5 * (t - 4.0)) + rise + 0.03 * rng.standard_normal(6))
            rows += [(name, t, f, unit * e, p) for f, e, p in zip(FREQUENCIES, modulus, phase, strict=True)]
    return pd.DataFrame(rows, columns=["specimen", "temperature_C", "frequency_Hz", "E_MPa", "phase_deg"])


@pytest.mark.parametrize(
    "glassy, asks", [(6.2e3, "less than any asphalt has at such a phase: is the unit ksi?"),
                     (1e5, "more than any asphalt has at such a phase: is the unit another, such as ksi or GPa?")]
)  # fmt: skip
def test_no_mix_has_a_glassy_modulus_below_7_or_above_100_gigapascals(glassy, asks):
    table = cold(glassy=glassy)
    (said,) = slips(table)
    median = table.query("specimen == 'A' and temperature_C == 4")["E_MPa"].median()
    assert f"is {float(f'{median:.3g}'):g} MPa at a phase of 11 deg, {asks}" in said


@pytest.mark.parametrize(
    "unit, name", [(0.145038, "ksi"), (1e-3, "GPa"), (145.038, "psi"), (10.1972, "kgf/cm2")]
)
def test_a_whole_table_in_another_unit_is_asked_for_it(unit, name):
    (said,) = slips(cold(unit))
    assert f"is the unit {name}?" in said and f"as in E ({name})" in said
    assert said.startswith("at 4 degC |E*| of specimen A is ") and "MPa at a phase of 11 deg, " in said
    # A delay of 2 ms hides that the phase falls with the frequency.
    late = cold(unit)
    late["phase_deg"] += 360.0 * 0.7e-3 * late["frequency_Hz"]
    assert f"is the unit {name}?" in next(slips(late))


@pytest.mark.parametrize(
    "table",
    [
        cold(),
        cold(glassy=6.7e3),  # cold recycled
        cold(glassy=9.6e4),
        cold(0.145038).assign(
            temperature_C=lambda t: t["temperature_C"] + 30.0
        ),  # warm: the phase says nothing
        cold(0.145038).assign(phase_deg=lambda t: t["phase_deg"] - 9.0),  # phase and slope disagree
        cold(0.145038).assign(
            frequency_Hz=lambda t: t["frequency_Hz"],
            phase_deg=lambda t: 24.0 - t["phase_deg"] + 2.0,
            E_MPa=lambda t: t["E_MPa"] * np.exp(0.05 * np.log(t["frequency_Hz"]) ** 2),
        ),  # the warm side, where a softer mix has a smaller phase
        cold(0.145038).query("frequency_Hz == 1 or frequency_Hz == 10"),
    ],
)
def test_a_soft_table_that_may_be_true_goes_on(table):
    assert not list(slips(table))


@pytest.mark.parametrize(
    "unit, said",
    [("ksi", "reaches 139000 MPa, too stiff"), ("psi", "reaches only 139 MPa, too soft")],
)
def test_megapascals_under_another_unit_are_asked_for(unit, said):
    factor = {"ksi": 6.894757, "psi": 6.894757e-3}[unit]
    assert unit_in_question(cold(), unit) is None
    assert unit_in_question(cold(factor), unit) == (
        f"read as {unit} |E*| {said} for asphalt; read as MPa it fits: is the unit MPa?"
    )
    assert unit_in_question(cold(factor**2), unit) is None  # MPa would not fit, either
    warm = campaign()
    warm.loc[0, "E_MPa"] = 3e5
    assert unit_in_question(warm, unit) is None  # one slip is no unit


def test_each_specimen_in_another_unit_is_told():
    table = campaign(5)
    for name, factor in {"A": 1e-3, "B": 1e3}.items():
        table.loc[table["specimen"] == name, "E_MPa"] *= factor
    told = [said for said in slips(table) if "every condition" in said]
    assert [said.split(" is ")[0][-1] for said in told] == ["A", "B"]
    assert "in GPa" in told[0] and "in kPa" in told[1]
