"""Laws from Python: fitted, evaluated, turned into bonds, written and refused."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest

import asphalt_nscd as an
from asphalt_nscd.rheology.parabolic import TwoS2P1D
from asphalt_nscd.rheology.shift import WLF

MIX = TwoS2P1D(60e6, 31e9, 0.2, 0.55, 2.1, 0.02, 200.0, WLF(18.0, 150.0, 20.0))
TABLE3 = {"Em_Pa": 24.3e9, "eta_m_Pa_s": 3.71e9, "Ek_Pa": 48.4e9, "eta_k_Pa_s": 0.773e9}


def table(temperatures=(-10.0, 5.0, 20.0, 35.0, 50.0)) -> pd.DataFrame:
    grid = [(t, f) for t in temperatures for f in (0.1, 1.0, 10.0, 25.0)]
    temperature, frequency = np.array(grid).T
    modulus = MIX.complex_modulus(2 * np.pi * frequency, temperature)
    return pd.DataFrame(
        {
            "temperature_C": temperature,
            "frequency_Hz": frequency,
            "E_MPa": np.abs(modulus) / 1e6,
            "phase_deg": np.degrees(np.angle(modulus)),
            "origin": "synthetic",
        }
    )


def test_fit_finds_the_law_behind_a_table():
    law = an.fit(table())
    f, t = np.meshgrid([0.1, 1.0, 10.0], [0.0, 25.0, 45.0])
    assert np.abs(np.log(law.complex_modulus(f, t) / MIX.complex_modulus(2 * np.pi * f, t))).max() < 0.01
    assert law.temperature_C is None and law.content["source"] == "fitted (synthetic)"
    assert law.shift_factor(20.0) == 1.0 and law.shift_factor(35.0) < 1.0 < law.shift_factor(5.0)


def test_burgers_at_one_temperature_is_what_the_command_line_fits(tmp_path):
    from asphalt_nscd import cli

    whole = table().assign(specimen="A")
    whole.to_csv(tmp_path / "table.csv", index=False)
    with pytest.raises(SystemExit):
        cli.main(
            [
                "fit",
                str(tmp_path / "table.csv"),
                "--temperature-c",
                "20",
                "--output",
                str(tmp_path / "T20.json"),
            ]
        )
    ours, theirs = an.fit(whole, "burgers", temperature_C=20.0), an.read(tmp_path / "T20.json")
    # slopes by differences leave 3e-6 between two processors' sums of the same tests
    assert np.allclose(ours.parameters["value"], theirs.parameters["value"], rtol=1e-5)


def test_bonds_follow_a_law_of_all_temperatures_by_a_chain(tmp_path):
    law = an.fit(table())
    chain = law.of_bonds(frequency_Hz=10.0, temperature_C=20.0)
    f = np.array([5.0, 10.0, 20.0])
    assert chain.kind == "kelvin_chain" and chain.temperature_C == 20.0
    assert np.abs(np.log(chain.complex_modulus(f) / law.complex_modulus(f, 20.0))).max() < 1e-3
    chain.write(tmp_path / "chain.json")
    assert an.read(tmp_path / "chain.json").content == chain.content


@pytest.mark.parametrize(
    ("ask", "sentence"),
    [
        (lambda: an.fit(table(), "burgers"), "give temperature_C"),
        (lambda: an.fit(table(), "burgers", temperature_C=21.0), "no test at 21 degC; the table has -10, 5"),
        (lambda: an.fit(table(), "maxwell"), "'maxwell' is not known; give one of burgers, 2s2p1d"),
        (lambda: an.fit(table(), temperature_C=20.0), "holds at all temperatures"),
        (lambda: an.fit(table((20.0, 30.0))), "needs at least 3 temperatures"),
        (
            lambda: an.Law.burgers(**TABLE3, temperature_C=15).complex_modulus(10.0, 16.0),
            "holds at 15 degC only",
        ),
        (lambda: an.fit(table()).complex_modulus(10.0), "give temperature_C"),
        (lambda: an.Law.burgers(**(TABLE3 | {"Em_Pa": -1.0}), temperature_C=15), "must be at least 0.001"),
        (
            lambda: an.Law.burgers(**(TABLE3 | {"eta_k_Pa_s": 1e30}), temperature_C=15),
            "at most 1e.20; give Pa",
        ),
        (lambda: an.Law({"law": "spring"}), "holds law 'spring'"),
        (
            lambda: an.Law.burgers(**TABLE3, temperature_C=15).of_bonds(10.0, np.nan),
            "15 degC only, not at nan",
        ),
        (lambda: an.fit(table()).of_bonds(10.0, np.nan), "nan degC: the law says nothing finite"),
        (lambda: an.fit(table()).of_bonds(1e300, 15.0), "the law says nothing finite there; give another"),
    ],
)
def test_what_cannot_be_is_refused_in_a_sentence(ask, sentence):
    with pytest.raises(an.InputError, match=sentence):
        ask()


@pytest.mark.parametrize(
    "frequency,temperature,sentence",
    [
        (0.0, 15.0, "frequency_Hz: not all above zero"),
        ([1.0, -1.0], 15.0, "frequency_Hz: not all above zero"),
        (np.nan, 15.0, "frequency_Hz: not all finite"),
        ("ten", 15.0, "frequency_Hz: 'ten' is no number"),
        (1.0, np.inf, "temperature_C: not all finite"),
        (1.0, 20.0, "holds at 15 degC only, not at 20"),
    ],
)
def test_where_a_law_says_nothing(frequency, temperature, sentence):
    law = an.Law.burgers(**TABLE3, temperature_C=15.0)
    with pytest.raises(an.InputError, match=sentence):
        law.complex_modulus(frequency, temperature)


def test_a_chain_is_used_in_its_band():
    chain = an.fit(table()).of_bonds(frequency_Hz=10.0, temperature_C=20.0)
    assert chain.of_bonds(20.0, 20.0) is chain
    with pytest.raises(an.InputError, match="a Kelvin chain for 5 to 20 Hz, which says nothing at 100 Hz"):
        chain.of_bonds(100.0, 20.0)
