"""Deposits, specimens and tests for other programs, read back by VTK's own reader and as CSV."""

from __future__ import annotations

from xml.etree import ElementTree

import numpy as np
import pandas as pd
import pytest

import asphalt_nscd as an
from asphalt_nscd import cli
from asphalt_nscd.bending.model import model_of
from asphalt_nscd.files.store import load, save

vtk = pytest.importorskip("vtk")
from vtk.util.numpy_support import vtk_to_numpy  # noqa: E402

SHAPE = {"b_mm": 16, "B_mm": 24, "e_mm": 20, "h_mm": 100, "mass_kg": 0.1, "mobile_mass_kg": 0.1}

LAW = an.Law.burgers(Em_Pa=24.3e9, eta_m_Pa_s=3.71e9, Ek_Pa=48.4e9, eta_k_Pa_s=0.773e9, temperature_C=15)


@pytest.fixture(scope="module")
def packing() -> an.Packing:
    return an.pour({5.0: 100, 6.0: 200}, (0.1, 0.02, 0.12), vibration=an.Vibration(duration=0.0))


@pytest.fixture(scope="module")
def beam(packing) -> an.Specimen:
    return an.specimen(packing, SHAPE, area="facets")


def read(path):
    reader = vtk.vtkXMLPolyDataReader()
    reader.SetFileName(str(path))
    reader.Update()
    return reader.GetOutput()


def array(data, name):
    return vtk_to_numpy(data.GetArray(name))


def test_spheres_in_paraview(packing, tmp_path):
    packing.write(tmp_path / "deposit.h5")
    run("export", tmp_path / "deposit.h5", "--format", "vtk", "--output", tmp_path / "d.vtp")
    data = read(tmp_path / "d.vtp")
    assert data.GetNumberOfVerts() == 300
    assert np.allclose(vtk_to_numpy(data.GetPoints().GetData()), packing.position_m)
    assert np.array_equal(array(data.GetPointData(), "radius_m"), packing.radius_m)
    assert set(array(data.GetPointData(), "class")[packing.radius_m < 2.6e-3]) == {0}


def test_what_went_out_comes_in_again(packing, tmp_path):
    for form, ending in (("vtk", "vtp"), ("csv", "csv")):
        an.export(packing, tmp_path / f"d.{ending}", form)
        again = an.read_packing(tmp_path / f"d.{ending}")
        assert np.allclose(again.radius_m, packing.radius_m, rtol=1e-9)
        apart = again.position_m - packing.position_m
        assert np.allclose(apart, apart[0], atol=1e-11)  # shifted into its own box


def test_bonds_in_paraview(beam, tmp_path):
    said = an.export(beam, tmp_path / "s.vtp", "vtk")
    data = read(tmp_path / "s-bonds.vtp")
    bonds, points = beam.bonds, vtk_to_numpy(data.GetPoints().GetData())
    assert data.GetNumberOfLines() == len(bonds) and f"{len(bonds)} bonds" in said
    assert np.allclose(array(data.GetCellData(), "area_m2"), bonds["area_m2"])
    ends = vtk_to_numpy(data.GetLines().GetConnectivityArray()).reshape(-1, 2)
    between = (bonds[["first", "second"]] < len(beam.radius_m)).all(axis=1).to_numpy()
    length = np.linalg.norm(points[ends[:, 1]] - points[ends[:, 0]], axis=1)
    assert np.allclose(length[between], bonds["length_m"][between])
    on_plates = points[ends[~between]][:, :, 2]
    assert (np.isclose(on_plates, 0.0) | np.isclose(on_plates, 0.1)).any(axis=1).all()
    assert np.array_equal(array(data.GetCellData(), "plate") == 1, ~between)


def test_tables_of_a_specimen_and_a_test(beam, tmp_path):
    test = an.bend(beam, LAW, 20.0, 15.0)
    an.export(beam, tmp_path / "s.csv", "csv")
    an.export(test, tmp_path / "t.csv", "csv")
    spheres, bonds = (pd.read_csv(tmp_path / f"s{of}.csv") for of in ("", "-bonds"))
    assert np.allclose(spheres[["x_m", "y_m", "z_m"]], beam.position_m, atol=1e-12)
    assert np.allclose(spheres["radius_m"], beam.radius_m)
    assert np.array_equal(spheres["class"], beam.radius_m > 2.6e-3)
    assert list(bonds) == ["first", "second", "area_m2", "gap_m", "length_m"]
    assert np.allclose(bonds[list(beam.bonds)], beam.bonds, rtol=1e-9, atol=1e-15)
    assert np.allclose(pd.read_csv(tmp_path / "t.csv"), test.history, rtol=1e-8)
    with pytest.raises(an.InputError, match=r"holds no motion of spheres.*Load\(frames=24\)"):
        an.export(test, tmp_path / "t.pvd", "vtk")


def run(*words):
    with pytest.raises(SystemExit) as done:
        cli.main(list(map(str, words)))
    assert done.value.code == 0, words


@pytest.fixture(scope="module")
def cycle(beam, tmp_path_factory):
    """A test with frames, its model, and its export as a series."""
    folder = tmp_path_factory.mktemp("cycle")
    beam.write(folder / "beam.h5")
    LAW.write(folder / "law.json")
    outputs = ["--output", folder / "model.h5", "--excerpt-output", folder / "model.excerpt.h5"]
    run("condense", folder / "beam.h5", "--head", "free", *outputs)
    test = [
        "simulate", folder / "model.h5", "--excerpt", folder / "model.excerpt.h5", "--law", folder / "law.json",
        "--temperature-c", 15, "--frequency-hz", 20, "--amplitude-m", 1e-6, "--cycles", 2, "--time-step-s", 1e-4,
    ]  # fmt: skip
    run(*test, "--output", folder / "plain.h5")
    run(*test, "--frames", 10, "--output", folder / "test.h5")
    run("export", folder / "test.h5", "--format", "vtk", "--output", folder / "test.pvd")
    return folder


def test_a_cycle_in_paraview(cycle, beam):
    series = ElementTree.parse(cycle / "test.pvd").getroot()
    sets = list(series.iter("DataSet"))
    times = sorted({float(one.get("timestep")) for one in sets})
    test = load(cycle / "test.h5", "test")
    assert series.get("type") == "Collection" and len(sets) == 20
    assert np.allclose(np.diff(times), 1.0 / 20.0 / 10) and times[-1] == pytest.approx(
        test.arrays["time_s"][-1]
    )
    for one in sets:
        data = read(cycle / one.get("file"))
        k = times.index(float(one.get("timestep")))
        if one.get("part") == "0":
            assert np.allclose(vtk_to_numpy(data.GetPoints().GetData()), beam.position_m)
            assert np.array_equal(
                array(data.GetPointData(), "displacement_m"), test.arrays["frames/displacement_m"][k]
            )
            assert array(data.GetPointData(), "velocity_m_s").shape == (len(beam.radius_m), 3)
        else:
            assert data.GetNumberOfLines() == len(beam.bonds)
            assert np.array_equal(
                array(data.GetCellData(), "tension_N"), test.arrays["frames/bond_force_N"][k, :, 0]
            )
            assert np.allclose(array(data.GetCellData(), "area_m2"), beam.bonds["area_m2"])


def test_utilisation_is_stress_over_strength(cycle):
    """By hand from force and area: the larger of tension and shear over 2.7 MPa; none of bonds to the plates."""
    largest = 0.0
    for one in ElementTree.parse(cycle / "test.pvd").getroot().iter("DataSet"):
        if one.get("part") == "0":
            continue
        data = read(cycle / one.get("file")).GetCellData()
        tension, shear, area, used = (
            array(data, name) for name in ("tension_N", "shear_N", "area_m2", "utilisation")
        )
        inside = array(data, "plate") == 0
        stress = np.maximum(tension, shear)[inside] / area[inside]
        assert np.allclose(used[inside], stress / 2.7e6, rtol=1e-5) and not used[~inside].any()
        largest = max(largest, used.max())
    said = load(cycle / "test.h5", "test").attributes["largest_utilisation"]
    assert 0.7 * said < largest <= said * (1.0 + 1e-6)  # which is of all cycles


def test_a_fall_in_paraview_is_where_its_spheres_are_and_has_the_bonds_left(tmp_path):
    kept = {
        "time_s": [0.0, 0.1], "position_m": np.eye(3), "radius_m": [1.0, 2, 3], "first": [0, 1], "second": [1, 2],
        "area_m2": [0.5, 0.25], "strength_N": [10.0, 20.0], "displacement_m": np.arange(18.0).reshape(2, 3, 3),
        "velocity_m_s": np.ones((2, 3, 3)), "fragment": [[0, 0, 0], [0, 1, 1]], "broken": [[False] * 2, [True, False]],
        "bond_force_N": [[[4.0, 0, 3], [-9, 8, 6]], [[0, 0, 0], [12, 0, -5]]],
    }  # fmt: skip
    arrays = {f"frames/{name}": np.array(values) for name, values in kept.items()}
    save(
        tmp_path / "fall.h5",
        "fall",
        arrays | {"time_s": np.array([0.0, 0.1]), "load_J": np.array([0.0, -2])},
        {},
    )
    run("export", tmp_path / "fall.h5", "--format", "vtk", "--output", tmp_path / "f.pvd")
    run("export", tmp_path / "fall.h5", "--format", "csv", "--output", tmp_path / "f.csv")
    assert pd.read_csv(tmp_path / "f.csv").to_dict("list") == {"load_J": [0.0, -2.0], "time_s": [0.0, 0.1]}
    sets = list(ElementTree.parse(tmp_path / "f.pvd").getroot().iter("DataSet"))
    assert [(one.get("timestep"), one.get("part")) for one in sets] == [
        (t, p) for t in ("0", "0.1") for p in "01"
    ]
    last, lines = (read(tmp_path / one.get("file")) for one in sets[2:])
    place = np.eye(3) + np.arange(9.0, 18.0).reshape(3, 3)
    assert np.allclose(vtk_to_numpy(last.GetPoints().GetData()), place)
    assert np.allclose(vtk_to_numpy(lines.GetPoints().GetData()), place)
    assert vtk_to_numpy(lines.GetLines().GetConnectivityArray()).tolist() == [1, 2]
    found = {
        name: array(lines.GetCellData(), name)[0]
        for name in ("tension_N", "shear_N", "utilisation", "area_m2")
    }
    assert found == pytest.approx({"tension_N": 12.0, "shear_N": 5.0, "utilisation": 0.6, "area_m2": 0.25})
    assert array(last.GetPointData(), "fragment").tolist() == [0, 1, 1]
    both = read(tmp_path / sets[1].get("file")).GetCellData()
    assert array(both, "utilisation") == pytest.approx([0.4, 0.5])


def test_python_asks_for_instants_as_the_command_line_does(cycle, beam, tmp_path):
    law, load_ = an.read(cycle / "law.json"), an.Load(amplitude_m=1e-6, cycles=2.0, frames=10)
    test = an.bend(beam, law, 20.0, 15.0, load=load_, numerics=an.Numerics(time_step=1e-4))
    an.export(test, tmp_path / "test.pvd", "vtk")
    theirs = an.read(cycle / "test.h5")
    for name in ("frames/time_s", "frames/strength_N", "frames/displacement_m", "frames/bond_force_N"):
        ours, other = test.arrays[name], theirs.arrays[name]
        assert np.allclose(ours, other, atol=1e-6 * np.abs(other[np.isfinite(other)]).max()), name
    assert len(list((tmp_path / "test").glob("bonds-*.vtp"))) == 10
    with pytest.raises(an.InputError, match="frames = -1; give a number at least 0"):
        an.bend(beam, law, 20.0, 15.0, load=an.Load(frames=-1))


def test_forces_of_the_bonds_are_those_that_the_head_feels(cycle):
    """At each instant the head's bonds balance the actuator; one cycle closes, and velocity is the slope."""
    test, model = load(cycle / "test.h5", "test").arrays, load(cycle / "model.h5", "model")
    system = model_of(model).system
    at = np.searchsorted(test["time_s"], test["frames/time_s"] - 1e-9)
    reaction = test["frames/bond_force_N"].astype(float) * [-1.0, 1.0, 1.0]
    pulled = np.array([(system.operator.T @ one.ravel())[system.driven] for one in reaction])
    omega, z = 2.0 * np.pi * 20.0, test["displacement_m"][at]
    inertia = -system.mass[system.driven] * omega**2 * z
    largest = np.abs(test["force_N"]).max()
    assert np.abs(inertia).max() < 0.1 * largest
    assert np.allclose(inertia - pulled, test["force_N"][at], atol=0.01 * largest)
    top = np.argmax(test["frames/position_m"][:, 2])
    moved = test["frames/displacement_m"][:, top, 0]
    assert np.corrcoef(moved, z)[0, 1] > 0.99 and moved.max() < 1.1e-6
    rest = load(cycle / "plain.h5", "test").arrays
    assert np.allclose(rest["force_N"], test["force_N"], atol=1e-9 * largest)
    assert not any(name.startswith("frames/") for name in rest)
