"""Spheres and bonds in files of VTK, which ParaView opens. VTK itself is the extra `vtk`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from html import escape
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.store import atomic_path
from asphalt_nscd.packings.spheres import Spheres

ENDINGS = (".vtk", ".vtp", ".vtu")
RADII = {"radius": 1.0, "radii": 1.0, "r": 1.0, "radius_m": 1.0, "diameter": 0.5, "diameter_m": 0.5}


def read_points(path: Path) -> Spheres:
    """Read spheres from points of a VTK file with an array of radii or diameters, in the unit of the file."""
    vtk = require_vtk()
    kinds = {
        ".vtp": vtk.vtkXMLPolyDataReader,
        ".vtu": vtk.vtkXMLUnstructuredGridReader,
        ".vtk": vtk.vtkDataSetReader,
    }
    reader = kinds[path.suffix.lower()]()
    reader.SetFileName(str(path))
    reader.GlobalWarningDisplayOff()  # what is wrong is said below, in one sentence
    # the reader of legacy files takes the first array alone unless told
    if hasattr(reader, "ReadAllScalarsOn"):
        reader.ReadAllScalarsOn()
    reader.Update()
    data = reader.GetOutput()
    if reader.GetErrorCode() or data is None or not data.GetNumberOfPoints():
        raise InputError(f"{path}: VTK reads no points from it; give points with an array radius.")
    from vtk.util.numpy_support import vtk_to_numpy

    arrays = data.GetPointData()
    names = {arrays.GetArrayName(k): k for k in range(arrays.GetNumberOfArrays())}
    name = next((name for name in names if str(name).lower() in RADII), None)
    if name is None:
        raise InputError(
            f"{path}: its points have no array radius or diameter (found: {', '.join(map(str, names)) or 'none'}); "
            "add one."
        )
    position = vtk_to_numpy(data.GetPoints().GetData()).astype(float)
    size = vtk_to_numpy(arrays.GetArray(names[name])).astype(float)
    if size.ndim > 1:
        raise InputError(f"{path}: array {name} has {size.shape[1]} components; give one radius a point.")
    unit = "m" if str(name).endswith("_m") else None
    return Spheres(
        path, position, RADII[str(name).lower()] * size, unit, [f"points of VTK, sizes from {name!r}"]
    )


def write_poly_data(
    path: Path,
    position: NDArray[np.float64],
    of_points: Mapping[str, NDArray[Any]],
    lines: NDArray[np.int64] | None = None,
    of_lines: Mapping[str, NDArray[Any]] | None = None,
) -> None:
    """Write points, or lines between them, as .vtp.

    `position` (n, 3) in m; `of_points` holds arrays (n,) by name. `lines` (l, 2) are the points that each line joins;
    `of_lines` holds arrays (l,) by name.
    """
    vtk = require_vtk()
    from vtk.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray

    def cells(ends: NDArray[np.int64]) -> Any:
        made = vtk.vtkCellArray()
        count, size = ends.shape
        made.SetData(
            numpy_to_vtkIdTypeArray(np.arange(0, size * count + 1, size, dtype=np.int64), deep=True),
            numpy_to_vtkIdTypeArray(np.ascontiguousarray(ends.ravel(), np.int64), deep=True),
        )
        return made

    data, points = vtk.vtkPolyData(), vtk.vtkPoints()
    points.SetData(numpy_to_vtk(np.ascontiguousarray(position, float), deep=True))
    data.SetPoints(points)
    if lines is None:
        data.SetVerts(cells(np.arange(len(position), dtype=np.int64)[:, None]))
    else:
        data.SetLines(cells(lines))
    for attributes, arrays in ((data.GetPointData(), of_points), (data.GetCellData(), of_lines or {})):
        for name, values in arrays.items():
            # deep: VTK would point into an array that numpy frees
            array = numpy_to_vtk(np.ascontiguousarray(values), deep=True)
            array.SetName(name)
            attributes.AddArray(array)
    with atomic_path(path) as temporary:
        writer = vtk.vtkXMLPolyDataWriter()
        writer.SetFileName(str(temporary))
        writer.SetInputData(data)
        writer.SetDataModeToBinary()
        if not writer.Write():
            raise OSError(None, "VTK could not write the file", str(path))


def write_series(path: Path, steps: Sequence[tuple[float, Sequence[Path]]]) -> None:
    """Write files of several times [s] as one series, .pvd of ParaView, which names them from its own folder on."""
    rows = "".join(
        f'<DataSet timestep="{time:.9g}" part="{part}" file="{escape(file.relative_to(path.parent).as_posix())}"/>\n'
        for time, files in steps
        for part, file in enumerate(files)
    )
    with atomic_path(path) as temporary:
        temporary.write_text(
            '<?xml version="1.0"?>\n<VTKFile type="Collection" version="0.1" byte_order="LittleEndian">\n'
            f"<Collection>\n{rows}</Collection>\n</VTKFile>\n",
            encoding="utf-8",
        )


def require_vtk() -> Any:
    """The module vtk; raises InputError where it is not installed."""
    try:
        import vtk
    except ImportError:
        raise InputError("files of VTK need its library; pip install 'asphalt-nscd[vtk]'.") from None
    return vtk
