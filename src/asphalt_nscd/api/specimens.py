"""Packings of spheres, and specimens cut from them and bonded."""

from __future__ import annotations

import sys
import warnings
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from asphalt_nscd.api.arguments import checked
from asphalt_nscd.api.pictures import sheet
from asphalt_nscd.api.results import Result
from asphalt_nscd.diagnosis.observed.reading import PAPER_GEOMETRY
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.words import counted
from asphalt_nscd.measurements.geometry import read_shape
from asphalt_nscd.measurements.shape import Shape
from asphalt_nscd.nscd.core_cache import is_compiled
from asphalt_nscd.packings.incoming import deposit_content
from asphalt_nscd.packings.incoming import read_packing as read_spheres
from asphalt_nscd.specimen.contents import DEPOSIT, SPECIMEN
from asphalt_nscd.specimen.counts import MOST_SPHERES, read_counts
from asphalt_nscd.specimen.cutting import bonded, specimen_of
from asphalt_nscd.specimen.given_spheres import overlaps, require_spheres
from asphalt_nscd.specimen.preparation import layer_statistics, pour_on, unrest
from asphalt_nscd.specimen.preparation import pour as pour_spheres
from asphalt_nscd.specimen.settings import Cutting, Pouring, Surfaces, Vibration
from asphalt_nscd.specimen.trimming import Specimen as BondedSpheres

Number = int | float | np.number
SPHERE_COLUMNS = ["x_m", "y_m", "z_m", "radius_m"]


class Spheres(Result):
    """What packings and specimens have in common."""

    @property
    def position_m(self) -> np.ndarray:
        """Centres of the spheres.

        Returns
        -------
        ndarray (n, 3)
            One row x, y, z [m] for each sphere.
        """
        return self.arrays["position"]

    @property
    def radius_m(self) -> np.ndarray:
        """Radii of the spheres.

        Returns
        -------
        ndarray (n,)
            Radii [m].
        """
        return self.arrays["radius"]

    @property
    def _radii(self) -> str:
        return f"radii {1e3 * self.radius_m.min():.3g} to {1e3 * self.radius_m.max():.3g} mm"


@dataclass(frozen=True)
class Packing(Spheres):
    """Spheres at rest in a box [0, length] x [0, width] x [0, height], z upwards.

    Parameters
    ----------
    arrays : mapping of str to ndarray
        Of the file: "position" (n, 3) and "radius" (n,) [m], "box" (3,) [m], and of what was poured
        "contacts/bodies" (c, 2) and "contacts/force" (c, 3) [N].
    attributes : mapping
        Of the file; names end in their unit: layer_height_m, solid_fraction, largest_overlap_m.
    name : str, optional
        Of the packing in messages.

    Raises
    ------
    InputError
        With one sentence, where the arrays are not those of spheres in a box.

    Examples
    --------
    >>> packing = pour({8.0: 40}, (0.04, 0.03, 0.12), vibration=Vibration(duration=0.0))
    >>> list(packing.spheres), len(packing.spheres), packing.box_m.tolist()
    (['x_m', 'y_m', 'z_m', 'radius_m'], 40, [0.04, 0.03, 0.12])
    """

    kind = DEPOSIT

    def __post_init__(self) -> None:
        missing = {"position", "radius", "box"} - set(self.arrays)
        if missing:
            raise InputError(f"packing: no array {min(missing)!r}; give position, radius and box.")
        require_spheres("packing", self.position_m, self.radius_m)
        sides = np.asarray(self.box_m)
        if sides.shape != (3,) or not ((sides > 0.0) & np.isfinite(sides)).all():
            raise InputError(
                f"packing: box {sides.tolist()}; give length, width and height in m, greater than zero."
            )

    @property
    def notes(self) -> tuple[str, ...]:
        """How a file of another program was read.

        Returns
        -------
        tuple of str
            Sentences; none for what was poured here.
        """
        return tuple(filter(None, str(self.attributes.get("notes", "")).split("\n")))

    @property
    def box_m(self) -> np.ndarray:
        """The box that the spheres were poured into.

        Returns
        -------
        ndarray (3,)
            Length, width and height [m].
        """
        return self.arrays["box"]

    @property
    def spheres(self) -> pd.DataFrame:
        """The spheres as a table.

        Returns
        -------
        DataFrame
            One row for each sphere: x_m, y_m, z_m, radius_m.
        """
        return pd.DataFrame(np.column_stack([self.position_m, self.radius_m]), columns=SPHERE_COLUMNS)

    @property
    def contacts(self) -> pd.DataFrame:
        """The contacts that bear something.

        Returns
        -------
        DataFrame
            One row for each contact: bodies first and second, and the force on the second, force_x_N,
            force_y_N, force_z_N [N]. Bodies n and above are planes: x = 0, y = 0, the floor, then the sides
            across and the top.

        Raises
        ------
        InputError
            For spheres that were not poured here, of which no force is known.

        Examples
        --------
        >>> packing = pour({8.0: 40}, (0.04, 0.03, 0.12), vibration=Vibration(duration=0.0))
        >>> floor = packing.contacts.query("second == 40 + 2")
        >>> bool(abs(floor["force_z_N"].sum() / (2600 * 9.81 * 40 * np.pi / 6 * 0.008**3) + 1) < 0.01)  # their weight
        True
        """
        # Files of other programs hold spheres alone.
        if "contacts/force" not in self.arrays:
            raise InputError("packing: it holds no forces; pour it here, or go on from it with `pour`.")
        bodies, force = self.arrays["contacts/bodies"], self.arrays["contacts/force"]
        columns = dict(zip(("force_x_N", "force_y_N", "force_z_N"), force.T, strict=True))
        return pd.DataFrame({"first": bodies[:, 0], "second": bodies[:, 1], **columns})

    @property
    def _said(self) -> Mapping[str, Any]:
        """The attributes; of arrays of one's own, which may come without, what the spheres show."""
        if {"layer_height_m", "solid_fraction", "coordination", "largest_overlap_m"} <= set(self.attributes):
            return self.attributes
        position, radius = (np.ascontiguousarray(x, float) for x in (self.position_m, self.radius_m))
        length, width, height = (float(side) for side in self.box_m)
        found = overlaps(position, radius)
        shown = layer_statistics(position, radius, (length, width, height), found.touching)
        return {**shown, "largest_overlap_m": found.largest, **self.attributes}

    def __repr__(self) -> str:
        said = self._said
        return (
            f"Packing({counted(self.radius_m.size, 'sphere')}, {self._radii}, layer "
            f"{1e3 * said['layer_height_m']:.3g} mm high, solid fraction {said['solid_fraction']:.3f})"
        )

    def _repr_html_(self) -> str:
        said, box = self._said, 1e3 * self.box_m
        return sheet(
            f"Packing of {counted(self.radius_m.size, 'sphere')}",
            {
                "spheres": self._radii,
                "box (length, width, height)": f"{box[0]:.4g} × {box[1]:.4g} × {box[2]:.4g} mm",
                "height of the layer": f"{1e3 * said['layer_height_m']:.4g} mm",
                "solid fraction": f"{said['solid_fraction']:.3f}",
                "contacts of a sphere": f"{said['coordination']:.2f} in the mean",
                "largest overlap": f"{1e6 * said['largest_overlap_m']:.3g} µm",
            },
            self.notes,
        )


@dataclass(frozen=True)
class Specimen(Spheres):
    """Bonded spheres between the foot (z = 0) and the head (z = h).

    The head is driven along x in bending, along z in tension-compression. The origin is the middle of the
    foot. Radii are those after the reduction of volume.

    Parameters
    ----------
    arrays : mapping of str to ndarray
        Of the file: spheres, bonds and their areas; `bonds` and `position_m` show them.
    attributes : mapping
        Of the file: lengths [m] and masses [kg] of the geometry, and how it was cut.
    name : str, optional
        Of the specimen in messages.

    Examples
    --------
    >>> packing = pour({6.0: 260}, (0.1, 0.02, 0.1), vibration=Vibration(duration=0.0))
    >>> g = {"b_mm": 16, "B_mm": 24, "e_mm": 20, "h_mm": 100, "mass_kg": 0.1, "mobile_mass_kg": 0.1}
    >>> beam = specimen(packing, g)
    >>> list(beam.bonds), f"{beam.geometry.h:g} m", bool((beam.bonds["gap_m"] < 2e-3).all())
    (['first', 'second', 'gap_m', 'length_m', 'area_m2'], '0.1 m', True)
    """

    kind = SPECIMEN

    @cached_property
    def bonded(self) -> BondedSpheres:
        """The same as the core takes it.

        Returns
        -------
        specimen.trimming.Specimen
            Positions, radii, network and geometry.
        """
        return specimen_of((dict(self.arrays), dict(self.attributes)))

    @property
    def geometry(self) -> Shape:
        """The geometry of the test that the specimen was cut for.

        Returns
        -------
        Shape
            Lengths [m] and masses [kg]; a class for each test (docs/geometries.md).
        """
        return self.bonded.geometry

    @property
    def bonds(self) -> pd.DataFrame:
        """The bonds as a table.

        Returns
        -------
        DataFrame
            One row for each bond: bodies first and second (n and above: plates), gap_m, length_m [m], area_m2
            [m2].
        """
        network = self.bonded.network
        return pd.DataFrame(
            {
                "first": network.first,
                "second": network.second,
                "gap_m": network.gap,
                "length_m": network.length,
                "area_m2": network.area,
            }
        )

    def __repr__(self) -> str:
        return (
            f"Specimen({counted(self.radius_m.size, 'sphere')}, {counted(self._bonds, 'bond')} by {self.bonded.area}, "
            f"{self._lengths})"
        )

    @property
    def _lengths(self) -> str:
        lengths = {
            key.removesuffix("_mm"): x for key, x in self.geometry.keys().items() if key.endswith("_mm")
        }
        return ", ".join(f"{name} = {x:g}" for name, x in lengths.items()) + " mm"

    @property
    def _bonds(self) -> int:
        return int(self.bonded.network.first.size)

    def _repr_html_(self) -> str:
        g = self.geometry
        return sheet(
            f"Specimen of {counted(self.radius_m.size, 'sphere')}",
            {
                "bonds": f"{self._bonds}, their area by {self.bonded.area}",
                "test": g.test,
                "lengths": self._lengths,
                "mass, mobile mass": f"{g.mass:g} and {g.mobile_mass:g} kg",
                "spheres": f"{self._radii}, {self.bonded.density:.4g} kg/m³",
            },
        )


@checked
def pour(
    counts: str | Path | pd.DataFrame | Mapping[float, int] | Packing,
    box_m: tuple[float, float, float],
    *,
    seed: int = 0,
    surfaces: Surfaces = Surfaces(),  # noqa: B008  frozen
    vibration: Vibration = Vibration(),  # noqa: B008  frozen
    time_step_s: float = Pouring.time_step,
    threads: int = 1,
) -> Packing:
    """Pour spheres from a random lattice by gravity, then vibrate the layer with the top wall.

    Parameters
    ----------
    counts : mapping, path or DataFrame
        Number of spheres by diameter in mm, {6.0: 120, 10.0: 30}, or a table diameter_mm,count. A packing goes on
        from where its spheres stand: with other surfaces, or vibrated again.
    box_m : tuple of float
        Length, width and height [m].
    seed : int
        Of the lattice. The same seed gives the same packing.
    surfaces : Surfaces
        Friction between spheres and with walls, and restitution of impacts.
    vibration : Vibration
        Stroke [m], frequency [Hz], duration [s]; a duration of 0 is none.
    time_step_s : float
        Time step [s].
    threads : int
        To compute on, at most as many as the cores granted; they change no number.

    Returns
    -------
    Packing
        Spheres at rest.

    Raises
    ------
    InputError
        With one sentence, where the box cannot hold the spheres.

    Warns
    -----
    UserWarning
        If the layer is not at rest.

    Examples
    --------
    >>> packing = pour({8.0: 40}, (0.04, 0.03, 0.12), vibration=Vibration(duration=0.0))
    >>> packing.radius_m.size, 0.4 < packing.attributes["solid_fraction"] < 0.7
    (40, True)
    """
    pouring = Pouring(box_m, seed, surfaces, vibration, time_step_s, threads)
    if not is_compiled("granular.step"):
        # To stderr, since a script may print its results; half a minute of silence looks like a hang.
        print("pour: compiling the core, once for this version: half a minute", file=sys.stderr)
    if isinstance(counts, Packing):
        arrays, attributes = pour_on(counts.position_m, counts.radius_m, pouring)
    else:
        arrays, attributes = pour_spheres(_counts(counts), pouring)
    if doubt := unrest(attributes):
        warnings.warn(doubt, stacklevel=3)
    return Packing(arrays, attributes)


@checked
def read_packing(path: str | Path, *, unit: str | None = None, up: str = "z") -> Packing:
    r"""Spheres that another program poured or a scanner saw, as a packing.

    Parameters
    ----------
    path : path
        CSV with columns x, y, z, radius (or diameter), with or without their unit; text of YADE; dump of LIGGGHTS or
        LAMMPS, of which the last snapshot is taken; VTK points with an array radius.
    unit : str, optional
        m, cm, mm or um, where the file does not say it; else m or mm, whichever makes aggregate of the radii.
    up : str
        The axis against gravity.

    Returns
    -------
    Packing
        Whose `notes` say what was understood.

    Raises
    ------
    InputError
        With one sentence, for what is no packing.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as folder:
    ...     table = Path(folder, "pile.csv")
    ...     _ = table.write_text("x_mm,y_mm,z_mm,diameter_mm\n5,5,5,10\n5,5,15,10\n")
    ...     read_packing(table).radius_m.tolist()
    [0.005, 0.005]
    """
    (arrays, attributes), notes = deposit_content(read_spheres(path), unit, up)
    # One text: an attribute of the file is a number or text.
    return Packing(arrays, {**attributes, "notes": "\n".join(notes)}, Path(path).stem)


def _counts(counts: Any) -> tuple[np.ndarray, np.ndarray]:
    """Diameters [m] and numbers of spheres."""
    if isinstance(counts, str | Path):
        return read_counts(counts)
    if isinstance(counts, pd.DataFrame):
        missing = [name for name in ("diameter_mm", "count") if name not in counts]
        if missing:
            raise InputError(f"counts: no column {missing[0]!r}; give diameter_mm and count.")
        pairs = list(zip(counts["diameter_mm"], counts["count"], strict=True))
    else:
        pairs = list(counts.items())
    for diameter, count in pairs:
        if not (isinstance(diameter, Number) and isinstance(count, Number)):
            raise InputError(
                f"counts: {diameter!r}: {count!r}; give a diameter in mm and a number of spheres."
            )
        if not 0.01 <= diameter <= 100.0:
            raise InputError(f"counts: a diameter of {diameter:g} mm; give diameters in mm, 0.01 to 100.")
        # pandas makes floats of a column with an empty cell: 12.0 is a number of spheres too.
        if float(count) % 1.0 or not 0 <= count <= MOST_SPHERES:
            raise InputError(
                f"counts: {count:g} spheres of {diameter:g} mm; give whole numbers, zero or more."
            )
    if not sum(count for _, count in pairs):
        raise InputError("counts: no sphere; give at least one.")
    diameters, numbers = zip(*pairs, strict=True)
    return 1e-3 * np.array(diameters, float), np.array(numbers, int)


@checked
def specimen(
    packing: Packing | str | Path,
    geometry: str | Path | Mapping[str, Any] = PAPER_GEOMETRY,
    *,
    area: str = Cutting.area,
    volume_reduction: float = Cutting.volume_reduction,
    gap_max_mm: float = Cutting.gap_max_mm,
) -> Specimen:
    """Cut a specimen from a packing, turn it upright, shrink its spheres and bond them.

    Parameters
    ----------
    packing : Packing or path
        Its length x becomes the height (or span) of the specimen, its width y the thickness; it is bent along z.
    geometry : mapping or path
        mass_kg, mobile_mass_kg, and of a trapezoid in two-point bending b_mm, B_mm, e_mm, h_mm, of a cylinder in
        tension-compression d_mm, h_mm, of a prism in four-point bending L_mm, H_mm, B_mm.
    area : str
        Of a bond: "paper", pi rmin^2 between spheres with a gap below gap_max_mm, or "facets", those of the cells that
        fill the specimen (docs/mapping.md).
    volume_reduction : float
        Part of each sphere's volume that makes room for the mastic.
    gap_max_mm : float
        Largest gap of a bond by the paper [mm].

    Returns
    -------
    Specimen
        Bonded spheres.

    Raises
    ------
    InputError
        With one sentence, where the packing cannot hold the specimen.

    Examples
    --------
    >>> packing = pour({6.0: 260}, (0.1, 0.02, 0.1), vibration=Vibration(duration=0.0))
    >>> g = {"b_mm": 16, "B_mm": 24, "e_mm": 20, "h_mm": 100, "mass_kg": 0.1, "mobile_mass_kg": 0.1}
    >>> specimen(packing, g, area="facets").bonded.area
    'facets'
    """
    cutting = Cutting(volume_reduction, area, gap_max_mm)
    given = packing if isinstance(packing, Packing) else Packing.read(packing)
    shape = read_shape(geometry)
    return Specimen(*bonded((dict(given.arrays), dict(given.attributes)), shape, cutting), given.name)
