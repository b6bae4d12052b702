"""A specimen cut from a deposit, its spheres shrunk and bonded; its file, and back."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from asphalt_nscd.files.ranges import Ranged, one_of, within
from asphalt_nscd.files.store import load, save
from asphalt_nscd.measurements.geometry import read_shape, require_within, shape_of
from asphalt_nscd.measurements.shape import Shape
from asphalt_nscd.specimen.contents import DEPOSIT, SPECIMEN, Content
from asphalt_nscd.specimen.network import AREAS, Network
from asphalt_nscd.specimen.trimming import Specimen, trim

# of a deposit, in the specimen; source: of an import
KEPT = ("seed", "source", "layer_height_m", "solid_fraction")


@dataclass(frozen=True)
class Cutting(Ranged):
    """What becomes of the spheres that are cut out: shrunk, and bonded.

    Parameters
    ----------
    volume_reduction : float
        Part of each volume, where mastic goes.
    gap_max_mm : float
        Pairs with a smaller gap are bonded [mm], by area "paper".
    area : str
        Of a bond, one of `network.AREAS`.
    """

    volume_reduction: float = within(0.1, low=0.0, below=1.0)
    gap_max_mm: float = within(2.0, above=0.0, high=100.0)
    area: str = one_of("paper", AREAS)


def trim_deposit(
    deposit_file: str | Path,
    geometry: Mapping[str, float] | str | Path,
    cutting: Cutting,
    output: str | Path,
) -> Mapping[str, float | int | str]:
    """Cut a specimen from a deposit, bond its spheres (`trim`), and save.

    Parameters
    ----------
    deposit_file : path
        HDF5 file of a deposit.
    geometry : mapping or path
        Mapping of mm and kg, or a JSON file with it.
    cutting : Cutting
        Reduction of volume, and bonds.
    output : path
        HDF5 file to write.

    Returns
    -------
    mapping
        What it holds.

    Raises
    ------
    InputError
        Where the deposit cannot hold the specimen.
    """
    record = load(deposit_file, DEPOSIT)
    shape = read_shape(geometry)
    arrays, said = bonded((record.arrays, record.attributes), shape, cutting)
    save(output, SPECIMEN, arrays, said)
    return said


def bonded(deposited: Content, shape: Shape, cutting: Cutting) -> Content:
    """A specimen file's content, cut from that of a deposit file. See `trim_deposit`.

    Parameters
    ----------
    deposited : Content
        Arrays and attributes of a deposit file.
    shape : Shape
        Geometry of the specimen.
    cutting : Cutting
        Reduction of volume, and bonds.

    Returns
    -------
    tuple of dict
        Arrays and attributes of a specimen file.

    Raises
    ------
    InputError
        Where the deposit cannot hold the specimen.
    """
    arrays, attributes = deposited
    require_within(shape, arrays["box"].tolist())
    volume_reduction, gap_max, area = cutting.volume_reduction, 1e-3 * cutting.gap_max_mm, cutting.area
    specimen = trim(arrays["position"], arrays["radius"], shape, volume_reduction, gap_max, area)
    network = specimen.network
    said: dict[str, float | int | str] = {
        **{name: attributes[name] for name in KEPT if name in attributes},
        **specimen.geometry.attributes(),
        "spheres": specimen.radius.size,
        "bonds": network.first.size,
        "density": specimen.density,
        "volume_reduction": volume_reduction,
        "gap_max_m": gap_max,
        "area": area,
        "loose_grains": specimen.loose_grains,
        "smallest_gap_m": float(network.gap.min()),
    }
    bodies = {"position": specimen.position, "radius": specimen.radius}
    return bodies | {f"network/{name}": value for name, value in network.arrays().items()}, said


def read_specimen(path: str | Path) -> Specimen:
    """The specimen in a file made by `trim_deposit`.

    Parameters
    ----------
    path : path
        HDF5 file.

    Returns
    -------
    Specimen
        Bonded spheres.

    Raises
    ------
    InputError
        Where the file is missing, damaged or of another kind.
    """
    record = load(path, SPECIMEN)
    return specimen_of((record.arrays, record.attributes))


def specimen_of(content: Content) -> Specimen:
    """The specimen in the content of its file.

    Parameters
    ----------
    content : Content
        Arrays and attributes.

    Returns
    -------
    Specimen
        Bonded spheres.
    """
    arrays, attributes = content
    return Specimen(
        geometry=shape_of(attributes),
        position=arrays["position"],
        radius=arrays["radius"],
        density=attributes["density"],
        network=Network(**{name: arrays[f"network/{name}"] for name in Network.__dataclass_fields__}),
        loose_grains=attributes["loose_grains"],
        area=attributes.get("area", "paper"),  # files of older versions know no other
    )
