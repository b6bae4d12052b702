"""Laws of measured mixes and their excess phase, on a mix whose law, reading and offset are known."""

from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest
from theory.specimens import jittered_beam

from asphalt_nscd.bending.condensing import condensed
from asphalt_nscd.bending.excerpt import read_excerpt, write_excerpt
from asphalt_nscd.bending.model import read_model
from asphalt_nscd.bending.settings import Bonds
from asphalt_nscd.files.store import save
from asphalt_nscd.nscd.stepping.skeleton import Skeleton
from asphalt_nscd.rheology.as_run import Programme, modulus_as_read
from asphalt_nscd.rheology.conversion import kelvin_chain
from asphalt_nscd.rheology.parabolic import TwoS2P1D
from asphalt_nscd.rheology.shift import WLF
from studies.measured.contacts import HAVERSINE, followed
from studies.measured.excess import BESIDE, PARTS, budget, excess
from studies.measured.ladder import averages, errors, rungs
from studies.measured.mechanisms import Mechanisms, excess_of
from studies.measured.reading import PROGRAMME
from studies.measured.simulated import modulus_of_cylinder

LAW = TwoS2P1D(150e6, 28e9, k=0.2, h=0.6, delta=2.3, tau=0.02, beta=300.0, shift=WLF(17.0, 150.0, 20.0))
PREDICTED = Path(__file__).parents[3] / "results/published/measured"
MECHANISMS = Mechanisms(
    SimpleNamespace(**{name: PREDICTED / f"{name}.csv" for name in ("contacts", "binder", "clock")})
)
RUNGS = rungs(MECHANISMS)
FREQUENCIES = (0.1, 1.0, 10.0)
TEMPERATURES = (4.0, 20.0, 40.0)


def table(of_one_test):
    """Two equal specimens; `of_one_test` gives E* [Pa] at a temperature [degC] and a frequency [Hz]."""
    rows = []
    for specimen in ("a", "b"):
        for temperature in TEMPERATURES:
            for frequency in FREQUENCIES:
                modulus = of_one_test(temperature, frequency)
                rows.append(
                    (specimen, temperature, frequency, abs(modulus) / 1e6, np.degrees(np.angle(modulus)))
                )
    return pd.DataFrame(rows, columns=["specimen", "temperature_C", "frequency_Hz", "E_MPa", "phase_deg"])


def true(temperature, frequency):
    return LAW.complex_modulus(np.array([2.0 * np.pi * frequency]), np.array([temperature]))[0]


def as_the_machine_reads(temperature, frequency):
    chain, _ = kelvin_chain(lambda w: LAW.complex_modulus(w, np.full_like(w, temperature)), 1e-5, 1e3)
    return modulus_as_read(chain, [frequency], Programme())[0]


@pytest.fixture(scope="module")
def read_table():
    return table(as_the_machine_reads)


def test_the_reading_without_a_parameter_finds_the_law_that_was_read(read_table):
    laws = (RUNGS[name](*averages(read_table)).modulus for name in ("one_law", "as_run"))
    plain, read = (errors(law, read_table).mean(axis=0) for law in laws)
    assert (read < 0.6 * plain).all() and read[1] < 0.6


def test_an_offset_is_found_and_a_law_alone_needs_none():
    turned = table(lambda t, f: true(t, f) * np.exp(1j * np.radians(1.5)))
    fit = RUNGS["phase_offset"](*averages(turned))
    assert errors(fit.modulus, turned).max() < 0.2
    assert (
        fit.fitted == 10 and RUNGS["one_law"](*averages(turned)).fitted == 9
    )  # seven of 2S2P1D and two of WLF
    assert errors(RUNGS["one_law"](*averages(table(true))).modulus, table(true)).max() < 0.05


def test_burgers_laws_between_their_temperatures_follow_straight_lines():
    tests = table(true)
    law, fitted, *_ = RUNGS["burgers"](*averages(tests[tests["temperature_C"] != 20.0]))
    omega = np.array([2.0 * np.pi])
    cold, warm = (law(omega, np.array([t]))[0] for t in (4.0, 40.0))
    between, exact = law(omega, np.array([20.0]))[0], law(omega, np.array([4.0 + 1e-9]))[0]
    assert fitted == 8 and abs(warm) < abs(between) < abs(cold) and exact == pytest.approx(cold, rel=1e-6)


def test_the_excess_of_a_mix_that_is_only_read_is_what_the_reading_predicts(read_table):
    found = excess("drawn", "mix", read_table, MECHANISMS)
    at = found.groupby("temperature_C")[["isotherm_deg", "reading_deg", "isotherm_standard_error_deg"]].mean()
    off = (at["isotherm_deg"] - at["reading_deg"]) / at["isotherm_standard_error_deg"]
    assert np.abs(off).max() < 2.0 and at["reading_deg"].max() > 1.0
    summed = budget(found)
    assert summed["mixes"].tolist() == [1, 1, 1]
    assert (summed["rms_less_reading_deg"] < summed["rms_deg"]).all()


@pytest.mark.parametrize(("other", "verdict"), [(0.0, "explained"), (0.4, "in part"), (15.0, "not")])
def test_verdict_of_an_isotherm(other, verdict):
    """Three mixes whose parts say all, all but the same 0.4 degrees, or all but 15."""
    rows = [
        ("p", 20.0, mix, part + noise + other, part, 0.0, 0.0, 0.0)
        for mix, part, noise in zip("abc", (1, 2, 3), (-0.1, 0, 0.1))
    ]
    names = [
        "population",
        "temperature_C",
        "mix",
        "isotherm_deg",
        *(f"{name}_deg" for name in (*PARTS, BESIDE)),
    ]
    assert budget(pd.DataFrame(rows, columns=names))["verdict"].tolist() == [verdict]


def test_a_change_of_the_modulus_over_frequency_requires_a_phase_of_its_own():
    """A power law changed to another one, and a turn without a change of |E*|."""
    frequency = np.geomspace(0.1, 10.0, 5)
    modulus = 1e9 * (1j * frequency) ** 0.2
    softer = -0.05 * np.log(frequency)  # by itself it takes 4.5 degrees
    assert excess_of(frequency, modulus, softer + 0j)[2] == pytest.approx(4.5, abs=0.1)
    np.testing.assert_allclose(excess_of(frequency, modulus, np.full(5, 0.02j)), np.degrees(0.02))


def test_changes_of_a_mix_lie_between_those_that_were_simulated():
    row = MECHANISMS.contact.iloc[4]
    modulus = 1e6 * row["E_MPa"] * np.exp(1j * np.radians(row["phase_deg"]))
    found = MECHANISMS.contacts(np.array([modulus, 1e-3 * modulus]), 1e-6 * row["amplitude_1e6"])
    assert found[0] == pytest.approx(row["lnE"] + 1j * np.radians(row["change_deg"]), abs=2e-3)
    softest = 1e6 * MECHANISMS.contact["E_MPa"].min() * np.exp(1j * np.angle(modulus))
    assert found[1] == pytest.approx(MECHANISMS.contacts(np.array([softest]), 1e-6 * row["amplitude_1e6"])[0])


@pytest.mark.parametrize(("axis", "share"), [([0.0, 0.0, 1.0], 0.5), ([1.0, 0.0, 0.0], -0.15)])
def test_a_contact_that_follows_the_mean_strain(axis, share):
    """Along the axis it gains half of its strain over its overlap by a haversine; across it loses that times 0.3."""
    model = SimpleNamespace(
        shape={"first": [0], "second": [1], "position_m": np.array([[0.0, 0.0, 0.0], axis]) * 0.01},
        geometry=SimpleNamespace(h=0.1),
    )
    model.shape |= {end: np.array(model.shape[end]) for end in ("first", "second")}
    skeleton = Skeleton(np.array([0]), np.array([2e-3]), np.array([1e-6]), 31e9, 0.9, 0.5)
    angle, strain = HAVERSINE.angles(), 1e-6
    ran = SimpleNamespace(displacement=0.1 * strain * HAVERSINE.stress(angle), angle=angle)
    change = followed(model, skeleton, 0.3, ran, HAVERSINE)
    assert change.real == pytest.approx(share * strain * 0.01 / 1e-6, rel=0.02) and abs(change.imag) < 1e-4


def test_pressing_alone_stiffens_contacts_of_all_directions_up_to_a_ratio_of_0_65():
    """The mean of k times the cube of the opening, c^2 - nu s^2, over all directions."""
    cosine = (np.arange(20000) + 0.5) / 20000
    gain = [np.mean((cosine**2 - nu * (1.0 - cosine**2)) ** 3) for nu in (0.65, 0.66)]
    assert gain[0] > 0.0 > gain[1]


def test_a_softer_film_in_tension_compression_falls_as_its_binder_says():
    modulus = np.array([5e9 * np.exp(0.3j)])
    of = MECHANISMS.binder
    fall = 1e-4 * np.interp(5000.0, of["E_MPa"], of["fall"])
    assert MECHANISMS.softening(modulus, 1e-4, "pulled")[0].real == pytest.approx(-fall, rel=0.05)
    at = MECHANISMS.clock.set_index("slope").iloc[4]
    # another program found -5.5 percent and 1.4 degrees for b = 0.4 and a slope of 0.19
    assert at["pulled_lnE"] == pytest.approx(-0.13, abs=0.01) and at["pulled_deg"] == pytest.approx(
        3.3, abs=0.2
    )


def test_a_specimen_of_facets_shows_what_the_closed_form_says_of_its_law(tmp_path):
    arrays, attributes = condensed(jittered_beam(shape=(3, 2, 13), area="facets"), "beam", Bonds())
    save(tmp_path / "m.h5", "model", arrays | {"load": 0.0 * arrays["load"]}, attributes)
    model = read_model(tmp_path / "m.h5")
    write_excerpt(tmp_path / "e.h5", model, model.digest)
    chain, _ = kelvin_chain(lambda w: 1e8 * (1j * w) ** 0.3, 1e-3, 1e2)
    found = modulus_of_cylinder(read_excerpt(tmp_path / "e.h5", tmp_path / "m.h5"), chain, 1.0, PROGRAMME)
    exact = modulus_as_read(chain, [1.0], PROGRAMME)[0]
    assert np.degrees(np.angle(found / exact)) == pytest.approx(0.0, abs=0.1)
