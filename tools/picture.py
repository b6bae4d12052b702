"""A specimen and the forces in its bonds, from the series that `asphalt-nscd export TEST.h5 --format vtk` wrote.

    python tools/picture.py TEST.pvd --output PICTURE.png

VTK draws it without a window. Spheres left; right the bonds at the instant of the largest forces, as thick as their
force: tension light, compression dark.
"""

from __future__ import annotations

import argparse
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import vtk
from PIL import Image
from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy

WIDTH, HEIGHT = 900, 900  # px
SPHERES, TENSION, COMPRESSION = (0.72, 0.70, 0.66), (0.85, 0.51, 0.17), (0.13, 0.33, 0.54)
THICKEST = 0.25  # of a tube over the mean radius of the spheres
ROOM = 1.1  # height of the picture over that of the specimen
LARGEST = 99.0  # percentile of force that is drawn thickest


def instants(series: Path) -> list[tuple[vtk.vtkPolyData, vtk.vtkPolyData]]:
    """Spheres and bonds at each time."""
    files: dict[str, dict[str, str]] = {}
    for one in ElementTree.parse(series).getroot().iter("DataSet"):
        files.setdefault(one.attrib["timestep"], {})[one.attrib["part"]] = one.attrib["file"]
    return [(_read(series.parent / two["0"]), _read(series.parent / two["1"])) for two in files.values()]


def _read(path: Path) -> vtk.vtkPolyData:
    reader = vtk.vtkXMLPolyDataReader()
    reader.SetFileName(str(path))
    reader.Update()
    return reader.GetOutput()


def force_of(bonds: vtk.vtkPolyData) -> np.ndarray:
    """Normal force (b,) [N], tension positive."""
    return vtk_to_numpy(bonds.GetCellData().GetArray("tension_N")).astype(float)


def actor(algorithm: vtk.vtkAlgorithm, colour: tuple[float, float, float]) -> vtk.vtkActor:
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputConnection(algorithm.GetOutputPort())
    mapper.ScalarVisibilityOff()
    made = vtk.vtkActor()
    made.SetMapper(mapper)
    made.GetProperty().SetColor(*colour)
    return made


def grains(spheres: vtk.vtkPolyData) -> vtk.vtkActor:
    shape = vtk.vtkSphereSource()
    shape.SetRadius(1.0)
    shape.SetThetaResolution(24)
    shape.SetPhiResolution(18)
    spheres.GetPointData().SetActiveScalars("radius_m")
    glyph = vtk.vtkGlyph3D()
    glyph.SetInputData(spheres)
    glyph.SetSourceConnection(shape.GetOutputPort())
    glyph.SetScaleModeToScaleByScalar()
    return actor(glyph, SPHERES)


def chains(
    bonds: vtk.vtkPolyData, force: np.ndarray, thickest: float, colour: tuple[float, float, float]
) -> vtk.vtkActor:
    """Tubes of the bonds with a force (b,) above zero; thickest [m] for a force of one."""
    lines = vtk_to_numpy(bonds.GetLines().GetConnectivityArray()).reshape(-1, 2)
    points, cells, sizes = vtk.vtkPoints(), vtk.vtkCellArray(), []
    place = vtk_to_numpy(bonds.GetPoints().GetData())
    for (first, second), size in zip(lines[force > 0.0], force[force > 0.0], strict=True):
        cells.InsertNextCell(2)
        for end in (first, second):
            cells.InsertCellPoint(points.InsertNextPoint(*place[end].tolist()))
        sizes += [size, size]
    data = vtk.vtkPolyData()
    data.SetPoints(points)
    data.SetLines(cells)
    array = numpy_to_vtk(thickest * np.minimum(np.array(sizes), 1.0), deep=True)
    array.SetName("size")
    data.GetPointData().SetScalars(array)
    tube = vtk.vtkTubeFilter()
    tube.SetInputData(data)
    tube.SetNumberOfSides(8)
    tube.SetVaryRadiusToVaryRadiusByAbsoluteScalar()
    return actor(tube, colour)


def draw(series: Path, output: Path) -> None:
    spheres, bonds = max(instants(series), key=lambda two: np.abs(force_of(two[1])).sum())
    force = force_of(bonds)
    force /= np.percentile(np.abs(force), LARGEST)
    thickest = THICKEST * float(vtk_to_numpy(spheres.GetPointData().GetArray("radius_m")).mean())
    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetSize(WIDTH, HEIGHT)
    window.SetMultiSamples(8)
    scenes = (
        [grains(spheres)],
        [chains(bonds, force, thickest, TENSION), chains(bonds, -force, thickest, COMPRESSION)],
    )
    for k, actors in enumerate(scenes):
        scene = vtk.vtkRenderer()
        scene.SetBackground(1.0, 1.0, 1.0)
        scene.SetViewport(0.5 * k, 0.0, 0.5 * (k + 1), 1.0)
        for one in actors:
            scene.AddActor(one)
        camera = scene.GetActiveCamera()
        camera.ParallelProjectionOn()
        camera.SetPosition(0.45, -1.0, 0.2)
        camera.SetFocalPoint(0.0, 0.0, 0.0)
        camera.SetViewUp(0.0, 0.0, 1.0)
        scene.ResetCamera(spheres.GetBounds())
        low, high = spheres.GetBounds()[4:]
        camera.SetParallelScale(ROOM * 0.5 * (high - low))
        window.AddRenderer(scene)
    window.Render()
    taken = vtk.vtkWindowToImageFilter()
    taken.SetInput(window)
    taken.ReadFrontBufferOff()
    writer = vtk.vtkPNGWriter()
    writer.SetFileName(str(output))
    writer.SetInputConnection(taken.GetOutputPort())
    writer.Write()
    # Few colours are enough, and a quarter of the file.
    Image.open(output).convert("RGB").quantize(64).save(output, optimize=True)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("series", type=Path)
    parser.add_argument("--output", type=Path, required=True)
    given = parser.parse_args()
    draw(given.series, given.output)
