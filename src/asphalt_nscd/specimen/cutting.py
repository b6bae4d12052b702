"""A specimen cut from a deposit, its spheres shrunk and bonded; its file, and back."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from asphalt_nscd.files.store import load, save
from asphalt_nscd.measurements.geometry import read_shape, require_within, shape_of
from asphalt_nscd.measurements.shape import Shape
from asphalt_nscd.specimen.contents import DEPOSIT, SPECIMEN, Content
from asphalt_nscd.specimen.given_spheres import require_spheres
from asphalt_nscd.specimen.network import Network
from asphalt_nscd.specimen.settings import Cutting
from asphalt_nscd.specimen.trimming import Specimen, trim

# what a specimen keeps of the attributes of its deposit; an imported one has a source and no seed
KEPT = ("seed", "source", "layer_height_m", "solid_fraction")


def trim_deposit(
    deposit_file: str | Path,
    geometry: Mapping[str, float] | str | Path,
    cutting: Cutting,
    output: str | Path,
) -> Mapping[str, float | int | str]:
    """Cut a specimen from a deposit file, bond its spheres (`trim`), and save; returns what the new file holds.

    `geometry` is a mapping of mm and kg, or a JSON file with it.
    """
    record = load(deposit_file, DEPOSIT)
    shape = read_shape(geometry)
    arrays, said = bonded((record.arrays, record.attributes), shape, cutting)
    save(output, SPECIMEN, arrays, said)
    return said


def bonded(deposited: Content, shape: Shape, cutting: Cutting) -> Content:
    """Arrays and attributes of a specimen file, cut from those of a deposit file; see `trim_deposit`."""
    arrays, attributes = deposited
    require_spheres("packing", arrays["position"], arrays["radius"])
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
    """Read the specimen in an HDF5 file made by `trim_deposit`."""
    record = load(path, SPECIMEN)
    return specimen_of((record.arrays, record.attributes))


def specimen_of(content: Content) -> Specimen:
    """The specimen in the arrays and attributes of its file."""
    arrays, attributes = content
    return Specimen(
        geometry=shape_of(attributes),
        position=arrays["position"],
        radius=arrays["radius"],
        density=attributes["density"],
        network=Network(**{name: arrays[f"network/{name}"] for name in Network.__dataclass_fields__}),
        loose_grains=attributes["loose_grains"],
        area=attributes["area"],
        volume_reduction=attributes["volume_reduction"],
    )
