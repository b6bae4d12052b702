"""Tests of a specimen from Python: those of the steps behind them, by a law that holds at the frequencies of each."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest
from pandas.testing import assert_frame_equal
from theory.specimens import as_if_poured, jittered_beam, save_specimen

import asphalt_nscd as an
from asphalt_nscd.api import specimens
from asphalt_nscd.api.specimens import _counts
from asphalt_nscd.bending.bending_test import outcome
from asphalt_nscd.bending.case import LoadCase, RunOptions
from asphalt_nscd.bending.condensing import condensed
from asphalt_nscd.bending.cycles import cycle
from asphalt_nscd.bending.fatigue import fatigue
from asphalt_nscd.bending.hold import hold
from asphalt_nscd.bending.model import model_of
from asphalt_nscd.bending.ramp import ramp
from asphalt_nscd.files.store import Record
from asphalt_nscd.measurements.twopoint import PAPER
from asphalt_nscd.specimen.settings import Cutting, Pouring

LAW = an.Law.burgers(Em_Pa=24.3e9, eta_m_Pa_s=0.06e9, Ek_Pa=48.4e9, eta_k_Pa_s=0.077e9, temperature_C=15)
BONDS = an.Bonds(kt_over_kn=0.8, yield_Pa=1e6)
STEP = 1e-4


@pytest.fixture(scope="module")
def beam(tmp_path_factory) -> an.Specimen:
    """A beam that was not poured, from a file."""
    save_specimen(
        path := tmp_path_factory.mktemp("api") / "beam.h5", as_if_poured(jittered_beam(area="facets"))
    )
    return an.Specimen.read(path)


@pytest.fixture(scope="module")
def model(beam):
    return model_of(Record(*condensed(beam.bonded, "beam", BONDS), ""))


@pytest.fixture
def asked(monkeypatch) -> list[tuple[float, ...]]:
    """Of what frequencies, lowest and highest, a law was asked for bonds, and at what temperature."""
    made, of_bonds = [], an.Law.of_bonds

    def spied(self, frequency_Hz, temperature_C, highest_Hz=None):
        made.append((frequency_Hz, highest_Hz or frequency_Hz, temperature_C))
        return of_bonds(self, frequency_Hz, temperature_C, highest_Hz)

    monkeypatch.setattr(an.Law, "of_bonds", spied)
    return made


def test_bend(beam, model, asked):
    load = an.Load(amplitude_m=1e-6, cycles=2.0, frames=3)
    test = an.bend(beam, LAW, 20.0, 15.0, load=load, bonds=BONDS, numerics=an.Numerics(STEP, 10))
    case = LoadCase(20.0, 1e-6, 2.0)
    arrays, said = outcome(model, LAW.bonds, 15.0, case, an.Numerics(STEP, 10), RunOptions(frames=3))
    assert test.attributes == pytest.approx(said, nan_ok=True) and asked == [(20.0, 20.0, 15.0)]
    assert (
        test.arrays.keys() == arrays.keys() and test.history["force_N"].tolist() == arrays["force_N"].tolist()
    )
    assert (test.E_MPa, test.phase_deg, test.broken_bonds) == (said["E_MPa"], said["phase_deg"], 0)
    star = 1e6 * said["E_MPa"] * np.exp(1j * np.pi / 180.0 * said["phase_deg"])
    assert test.complex_modulus == pytest.approx(star, rel=1e-13)
    (line,) = test.plot().axes[0].lines
    np.testing.assert_allclose(line.get_xdata(), 1e6 * arrays["displacement_m"])
    np.testing.assert_array_equal(line.get_ydata(), arrays["force_N"])
    assert "<td>1 µm</td>" in test._repr_html_() and "<td>3 instants</td>" in test._repr_html_()
    usual = an.bend(beam, LAW, 40.0, 15.0, load=an.Load(amplitude_m=1e-6, cycles=1.0)).attributes
    assert (usual["time_step_s"], usual["method"]) == (5e-5, "reduced")


def test_hold(beam, model, asked):
    held = an.Hold(0.02, 50, force_N=0.01)
    assert_frame_equal(an.hold(beam, LAW, 15.0, held=held, bonds=BONDS), hold(model, LAW.bonds, held))
    assert asked == [pytest.approx((0.5 / np.pi / 0.02, 0.5 / np.pi / 4e-4, 15.0))]


def test_cycle(beam, model, asked):
    cycling = an.Cycling(amplitude_m=1e-6, all_cycles=4, read_cycles=2, steps_in_cycle=20)
    assert_frame_equal(
        an.cycle(beam, LAW, 20.0, 15.0, cycling=cycling, bonds=BONDS), cycle(model, LAW.bonds, 20.0, cycling)
    )
    assert asked == [(5.0, 20.0, 15.0)]


def test_ramp(beam, model, asked):
    pulled = an.Ramp(duration_s=0.01, steps=40, displacement_m=-4e-5)
    found, (arrays, said) = (
        an.ramp(beam, LAW, 15.0, pulled=pulled, bonds=BONDS),
        ramp(model, LAW.bonds, pulled),
    )
    assert asked == [pytest.approx((0.5 / np.pi / 0.01, 0.5 / np.pi / 2.5e-4, 15.0))]
    assert found.attributes["broken_bonds"] == said["broken_bonds"] > 0
    assert found.attributes["temperature_C"] == 15.0 and found.name == "beam"
    for name in ("force_N", "broken_bonds", "broken"):
        np.testing.assert_array_equal(found.arrays[name], arrays[name])
    force, bonds = (axes.lines[0] for axes in found.plot().axes)
    np.testing.assert_allclose(force.get_xdata(), np.arange(1.0, 41.0))
    np.testing.assert_allclose(force.get_ydata(), np.abs(arrays["force_N"]))
    np.testing.assert_array_equal(bonds.get_ydata(), arrays["broken_bonds"])


def test_fatigue(beam):
    law = an.FatigueLaw(1e-3, 4.0)
    found, expected = an.fatigue(beam, 2e-4, law=law, bonds=BONDS), fatigue(beam.bonded, 2e-4, law, BONDS)
    assert found.cycles.tolist() == expected.cycles.tolist()


def test_a_choice_of_bonds_that_changes_nothing_is_told_by_each_test(beam):
    idle = an.Bonds(poisson=0.2)  # the beam has facets
    cycling = an.Cycling(amplitude_m=1e-6, all_cycles=1, read_cycles=1, steps_in_cycle=20)
    pulled = an.Ramp(duration_s=0.01, steps=10, displacement_m=1e-7)
    with pytest.warns(UserWarning) as told:
        an.cycle(beam, LAW, 20.0, 15.0, cycling=cycling, bonds=idle)
        an.ramp(beam, LAW, 15.0, pulled=pulled, bonds=idle)
        an.fatigue(beam, 2e-4, bonds=idle)
    assert ["poisson = 0.2 changes nothing" in str(each.message) for each in told] == [True] * 3
    assert {each.filename for each in told} == {__file__}


def test_a_specimen_is_condensed_once_for_each_kind_of_bonds(beam):
    from asphalt_nscd.api.bending import model_in_memory

    one = model_in_memory(beam, BONDS)
    assert model_in_memory(beam, an.Bonds(kt_over_kn=0.8, yield_Pa=1e6)) is one
    assert model_in_memory(beam, an.Bonds()) is not one


def test_pouring_and_cutting_hand_on_what_is_asked(monkeypatch, capsys):
    arrays = {"position": np.full((1, 3), 5e-3), "radius": np.array([3e-3]), "box": np.full(3, 0.1)}
    still, asked = {"weight_balance": 0.0, "unbalanced_force": 0.02}, []

    def spied(*given):
        asked.append(given)
        return arrays, still

    for name in ("pour_spheres", "pour_on", "bonded"):
        monkeypatch.setattr(specimens, name, spied)
    monkeypatch.setattr(specimens, "is_compiled", lambda _: False)
    box, surfaces, shaken = (0.1, 0.2, 0.3), an.Surfaces(0.4), an.Vibration(1e-3, 20.0, 0.5)
    with pytest.warns(UserWarning, match="not at rest") as told:
        packing = an.pour({6.0: 1}, box, seed=3, surfaces=surfaces, vibration=shaken, time_step_s=2e-4)
    assert "compiling the core" in capsys.readouterr().err and told[0].filename == __file__
    still["unbalanced_force"] = 0.0
    an.pour(packing, box)
    an.specimen(packing, {"d_mm": 60, "h_mm": 90, "mass_kg": 1, "mobile_mass_kg": 2})
    an.specimen(packing, area="facets", volume_reduction=0.2, gap_max_mm=1.5)
    poured, on, usual, cut = asked
    assert (poured[0][0].tolist(), poured[0][1].tolist()) == ([6e-3], [1])
    assert poured[1] == Pouring(box, 3, surfaces, shaken, 2e-4) and on[2] == Pouring(box)
    assert on[0] is arrays["position"] and on[1] is arrays["radius"]
    assert usual[2] == Cutting(0.1, "paper", 2.0) and usual[1].h == 0.09
    assert cut[2] == Cutting(0.2, "facets", 1.5) and cut[1] == PAPER


def test_what_a_specimen_shows(beam):
    network = beam.bonded.network
    expected = {
        "first": network.first, "second": network.second, "gap_m": network.gap, "length_m": network.length,
        "area_m2": network.area,
    }  # fmt: skip
    assert_frame_equal(beam.bonds, pd.DataFrame(expected))
    radii = 1e3 * beam.radius_m
    assert repr(beam) == (
        f"Specimen(54 spheres, {network.first.size} bonds by facets, b = 12, B = 12, e = 8, h = 36 mm)"
    )
    shown = beam._repr_html_()
    assert f"radii {radii.min():.3g} to {radii.max():.3g} mm, {beam.bonded.density:.4g} kg/m³" in shown
    assert "<td>0.004 and 0.002 kg</td>" in shown and beam.geometry == beam.bonded.geometry


def test_what_a_packing_shows():
    """Two spheres, one of which stands on the floor, body 2 + 2."""
    arrays = {
        "position": np.array([[0.01, 0.02, 0.003], [0.01, 0.02, 0.008]]), "radius": np.array([3e-3, 2e-3]),
        "box": np.array([0.02, 0.04, 0.06]), "contacts/bodies": np.array([[0, 4], [0, 1]]),
        "contacts/force": np.array([[1.0, 2.0, -3.0], [4.0, 5.0, 6.0]]),
    }  # fmt: skip
    said = {"layer_height_m": 8e-3, "solid_fraction": 0.51, "coordination": 1.0, "largest_overlap_m": 2e-6}
    packing = an.Packing(arrays, said | {"notes": "one\ntwo"})
    assert packing.spheres.to_numpy().tolist() == [[0.01, 0.02, 0.003, 3e-3], [0.01, 0.02, 0.008, 2e-3]]
    assert list(packing.spheres) == ["x_m", "y_m", "z_m", "radius_m"]
    assert packing.contacts.to_dict("list") == {
        "first": [0, 0], "second": [4, 1], "force_x_N": [1.0, 4.0], "force_y_N": [2.0, 5.0], "force_z_N": [-3.0, 6.0],
    }  # fmt: skip
    assert packing.notes == ("one", "two") and packing.box_m.tolist() == [0.02, 0.04, 0.06]
    assert repr(packing) == "Packing(2 spheres, radii 2 to 3 mm, layer 8 mm high, solid fraction 0.510)"
    for words in ("20 × 40 × 60 mm", "<td>8 mm</td>", "<td>1.00 in the mean</td>", "<td>2 µm</td>"):
        assert words in packing._repr_html_()
    alone = an.Packing({name: arrays[name] for name in ("position", "radius", "box")}, said)
    with pytest.raises(an.InputError, match="it holds no forces"):
        alone.contacts  # noqa: B018
    for side in (0.0, np.inf):
        with pytest.raises(an.InputError, match="greater than zero"):
            an.Packing(arrays | {"box": np.array([0.02, side, 0.06])}, said)


def test_counts_are_millimetres_and_whole_numbers():
    for counts in (
        {8: 20, 0.01: 3.0, 100.0: 0},
        pd.DataFrame({"diameter_mm": [8, 0.01, 100.0], "count": [20, 3.0, 0]}),
    ):
        diameters, numbers = _counts(counts)
        assert diameters == pytest.approx([8e-3, 1e-5, 0.1]) and numbers.tolist() == [20, 3, 0]
    for wrong, words in (
        ({0.0099: 1}, "a diameter of 0.0099 mm"),
        ({100.1: 1}, "a diameter of 100.1 mm"),
        ({8.0: 1.5}, "1.5 spheres of 8 mm"),
        ({8.0: -1}, "-1 spheres"),
        ({8.0: 10_000_001}, "1e.07 spheres"),
        ({8.0: 0}, "counts: no sphere"),
        (pd.DataFrame({"diameter_mm": [8.0]}), "no column 'count'"),
    ):
        with pytest.raises(an.InputError, match=words):
            _counts(wrong)


def test_a_result_is_read_as_it_was_written(beam, tmp_path):
    beam.write(tmp_path / "again.h5")
    again = an.read(tmp_path / "again.h5")
    assert isinstance(again, an.Specimen) and again.name == "again" and again.attributes == beam.attributes
    assert all(np.array_equal(again.arrays[name], values) for name, values in beam.arrays.items())


def test_a_packing_of_own_arrays_is_shown_without_attributes():
    """Two spheres of 8 mm, one on the other: 16 mm high, half of the section of a cube of 8 mm filled by pi/6."""
    arrays = {"position": np.array([[4, 4, 4], [4, 4, 12]]) * 1e-3, "radius": np.full(2, 4e-3)}
    packing = an.Packing(arrays | {"box": np.array([8e-3, 16e-3, 50e-3])}, {})
    assert repr(packing) == "Packing(2 spheres, radii 4 to 4 mm, layer 16 mm high, solid fraction 0.262)"
    assert "1.00 in the mean" in packing._repr_html_() and "0.262" in packing._repr_html_()
