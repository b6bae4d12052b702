"""Deposits, specimens and tests for other programs, read back by VTK's own reader and as CSV."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest

import asphalt_nscd as an
from asphalt_nscd import cli

vtk = pytest.importorskip("vtk")
from vtk.util.numpy_support import vtk_to_numpy  # noqa: E402

SHAPE = {"b_mm": 16, "B_mm": 24, "e_mm": 20, "h_mm": 100, "mass_kg": 0.1, "mobile_mass_kg": 0.1}


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
    with pytest.raises(SystemExit) as done:
        cli.main(
            ["export", str(tmp_path / "deposit.h5"), "--format", "vtk", "--output", str(tmp_path / "d.vtp")]
        )
    data = read(tmp_path / "d.vtp")
    assert done.value.code == 0 and data.GetNumberOfVerts() == 300
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
    law = an.Law.burgers(Em_Pa=24.3e9, eta_m_Pa_s=3.71e9, Ek_Pa=48.4e9, eta_k_Pa_s=0.773e9, temperature_C=15)
    test = an.bend(beam, law, 20.0, 15.0)
    an.export(beam, tmp_path / "s.csv", "csv")
    an.export(test, tmp_path / "t.csv", "csv")
    assert np.allclose(pd.read_csv(tmp_path / "s.csv")["radius_m"], beam.radius_m)
    assert len(pd.read_csv(tmp_path / "s-bonds.csv")) == len(beam.bonds)
    assert np.allclose(pd.read_csv(tmp_path / "t.csv"), test.history, rtol=1e-8)
    with pytest.raises(an.InputError, match="no motion of spheres; give --format csv"):
        an.export(test, tmp_path / "t.vtp", "vtk")


@pytest.mark.parametrize(
    ("form", "name", "sentence"),
    [("vtk", "d.csv", "ends in .vtp"), ("abaqus", "d.inp", "is one of laws; give one of vtk, csv")],
)
def test_what_cannot_be_is_refused(packing, tmp_path, form, name, sentence):
    with pytest.raises(an.InputError, match=sentence):
        an.export(packing, tmp_path / name, form)
