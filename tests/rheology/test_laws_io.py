"""Law files come back as they went, and a damaged one is named."""

import json
import math

import pytest

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.rheology.burgers import Burgers
from asphalt_nscd.rheology.chain import KelvinChain
from asphalt_nscd.rheology.laws_io import read_bond_law, read_law, write_chain, write_law

LAW = Burgers(24.3e9, 3.71e9, 48.4e9, 0.773e9)
CHAIN = KelvinChain(30e9, math.inf, (50e9, 70e9), (2e9, 0.3e9))


def test_burgers_round_trip(tmp_path):
    path = tmp_path / "laws" / "T15.json"
    errors = {"modulus_m": 1e8, "viscosity_m": 2e7, "modulus_k": 3e8, "viscosity_k": 4e6}
    write_law(path, LAW, source="fitted", temperature=15, std_error=errors, rms_log_residual=0.01)
    assert read_law(path) == LAW
    assert json.loads(path.read_text()) == {
        "law": "burgers",
        "source": "fitted",
        "temperature_C": 15.0,
        "Em_Pa": 24.3e9,
        "eta_m_Pa_s": 3.71e9,
        "Ek_Pa": 48.4e9,
        "eta_k_Pa_s": 0.773e9,
        "std_error": {"Em_Pa": 1e8, "eta_m_Pa_s": 2e7, "Ek_Pa": 3e8, "eta_k_Pa_s": 4e6},
        "rms_log_residual": 0.01,
    }


def test_chain_round_trip(tmp_path):
    path = tmp_path / "chain.json"
    write_chain(path, CHAIN, source="spectrum.json", temperature=15, error=4e-4, lowest_hz=3, highest_hz=40)
    assert read_bond_law(path) == CHAIN
    assert json.loads(path.read_text()) == {
        "law": "kelvin_chain", "source": "spectrum.json", "temperature_C": 15.0, "E_Pa": 30e9, "eta_Pa_s": None,
        "Ek_Pa": [50e9, 70e9], "eta_k_Pa_s": [2e9, 0.3e9],
        "largest_log_error": 4e-4, "lowest_Hz": 3.0, "highest_Hz": 40.0,
    }  # fmt: skip


def test_bonds_follow_a_burgers_law_too(tmp_path):
    write_law(tmp_path / "T15.json", LAW, source="fitted", temperature=15)
    assert read_bond_law(tmp_path / "T15.json") == LAW


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"law": "2s2p1d"}, "holds law '2s2p1d', not 'burgers' or 'kelvin_chain'; .* asphalt-nscd chain-law"),
        ({"Ek_Pa": [1e9]}, "1 springs and 2 dashpots"),
        ({"Ek_Pa": 1e9}, "key 'Ek_Pa' is missing or no list of numbers"),
        ({"Ek_Pa": [1e9, "x"]}, "key 'Ek_Pa' is missing or no list of numbers"),
        ({"E_Pa": "stiff"}, "key 'E_Pa' is missing or not a number"),
        ({"E_Pa": -1.0}, "not positive"),
        ({"E_Pa": math.nan}, "key 'E_Pa' is missing or not a number"),
        ({"Ek_Pa": [1e9, math.inf]}, "key 'Ek_Pa' is missing or no list of numbers"),
    ],
)
def test_bad_chains_are_refused_by_name(tmp_path, changes, words):
    path = tmp_path / "chain.json"
    content = write_chain(path, CHAIN, source="", temperature=15, error=0, lowest_hz=3, highest_hz=40)
    path.write_text(json.dumps(content | changes))
    with pytest.raises(InputError, match=words) as caught:
        read_bond_law(path)
    assert str(path) in str(caught.value)


@pytest.mark.parametrize(
    ("temperature", "frequency", "words"),
    [
        (15.0, 3.0, ""),
        (15.0, 40.0, ""),
        (35.0, 10.0, "holds at 15 degC only, not at 35; ask for 15 degC"),
        (5.0, 10.0, "holds at 15 degC only, not at 5; "),
        (15.0, 100.0, "a Kelvin chain for 3 to 40 Hz, which says nothing at 100 Hz"),
        (15.0, 0.5, "says nothing at 0.5 Hz"),
    ],
)
def test_a_law_is_used_where_it_holds(tmp_path, temperature, frequency, words):
    path = tmp_path / "chain.json"
    write_chain(path, CHAIN, source="", temperature=15, error=0, lowest_hz=3, highest_hz=40)
    if not words:
        assert read_bond_law(path, temperature, [frequency]) == CHAIN
        return
    with pytest.raises(InputError, match=words):
        read_bond_law(path, temperature, [10.0, frequency])


@pytest.mark.parametrize(
    ("content", "words"),
    [
        ('{"law": "2s2p1d"}', "holds law '2s2p1d', not 'burgers'"),
        ("[1, 2]", "no key 'law'; give the right file"),
        ("{", "not valid JSON"),
        ('{"law": "burgers", "Em_Pa": 1.0}', "'eta_m_Pa_s' is missing"),
        ('{"law": "burgers", "Em_Pa": "stiff"}', "'Em_Pa' is missing or not a number"),
        ('{"law": "burgers", "Em_Pa": -1, "eta_m_Pa_s": 1, "Ek_Pa": 1, "eta_k_Pa_s": 1}', "modulus_m = -1"),
    ],
)
def test_bad_law_files_are_refused_by_name(tmp_path, content, words):
    path = tmp_path / "law.json"
    path.write_text(content)
    with pytest.raises(InputError, match=words) as caught:
        read_law(path)
    assert str(path) in str(caught.value)
