"""What a notebook shows of packings, specimens and tests: small tables with units."""

from __future__ import annotations

from xml.etree import ElementTree

import pytest

import asphalt_nscd as an

pytestmark = pytest.mark.slow

SHAPE = {"b_mm": 16, "B_mm": 24, "e_mm": 20, "h_mm": 100, "mass_kg": 0.1, "mobile_mass_kg": 0.1}


@pytest.fixture(scope="module")
def packing() -> an.Packing:
    return an.pour({6.0: 260}, (0.1, 0.02, 0.1), vibration=an.Vibration(duration=0.0))


def rows(thing) -> dict[str, str]:
    """What stands in the table, by its first column; the whole must be well formed."""
    tree = ElementTree.fromstring(f"<div>{thing._repr_html_()}</div>")
    return {row[0].text: row[1].text for row in tree.iter("tr")}


def test_notes_of_a_packing_are_escaped(packing, tmp_path):
    an.export(packing, tmp_path / "a<b.csv", "csv")
    again = an.read_packing(tmp_path / "a<b.csv")
    assert "<li>260 spheres, radii 3 to 3 mm" in again._repr_html_() and rows(again)


def test_what_changes_nothing_and_sweeps_that_did_not_settle_are_told(packing):
    beam = an.specimen(packing, SHAPE)
    law = an.Law.burgers(Em_Pa=24.3e9, eta_m_Pa_s=3.71e9, Ek_Pa=48.4e9, eta_k_Pa_s=0.773e9, temperature_C=15)
    few = an.Numerics(rest_steps=0, method="sweeps", most_sweeps=5)
    load = an.Load(amplitude_m=2e-6, cycles=1.0)
    with pytest.warns(UserWarning) as told:
        an.bend(beam, law, 10.0, 15.0, load=load, bonds=an.Bonds(kt_over_kn=0.5), numerics=few)
    nothing, unsettled = (str(warning.message) for warning in told)
    assert nothing.startswith("bonds: kt_over_kn = 0.5 changes nothing in bonds by area 'paper'")
    assert unsettled.startswith("the sweeps did not settle: the last of 5") and told[0].filename == __file__
    facets = an.specimen(packing, SHAPE, area="facets")
    with pytest.warns(UserWarning, match="poisson = 0.2 changes nothing in bonds by area 'facets'"):
        an.bend(facets, law, 10.0, 15.0, load=load, bonds=an.Bonds(poisson=0.2))


def test_a_test_that_broke_bonds_says_so_where_it_was_asked_for(packing):
    beam = an.specimen(packing, SHAPE, area="facets")
    law = an.Law.burgers(Em_Pa=24.3e9, eta_m_Pa_s=3.71e9, Ek_Pa=48.4e9, eta_k_Pa_s=0.773e9, temperature_C=15)
    with pytest.warns(UserWarning, match="bonds broke at an amplitude of 200 um") as told:
        test = an.bend(beam, law, 10.0, 15.0, load=an.Load(amplitude_m=200e-6, cycles=1.0))
    assert told[0].filename == __file__ and test.broken_bonds > 0
    assert rows(test)["broken"] == f"{test.broken_bonds} of {len(beam.bonds)} bonds"
