"""How bonds carry the law of the mix: E of a specimen over that of the law, by mapping, size and packing.

    python benchmarks/mapping.py counts SPHERES COUNTS.csv --output SCALED.csv
    python benchmarks/mapping.py solve SPHERES DEPOSIT.h5 --output ROWS.csv
    python benchmarks/mapping.py poisson SPHERES DEPOSIT.h5 --output POISSON.csv
    python benchmarks/mapping.py collect ROWS.csv... --output MAPPING.csv --summary SUMMARY.csv

The paper's grading, box and specimen, all lengths but those of spheres and the drop scaled alike. Static solutions:
the bending test by Eq. (1), and a prism cut out of the packing and pulled.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
import pandas as pd

from asphalt_nscd.files.store import load, write_table
from asphalt_nscd.measurements.twopoint import Geometry
from asphalt_nscd.specimen.counts import read_counts
from asphalt_nscd.specimen.network import Network, bond_network, facet_network, region_of
from asphalt_nscd.specimen.power_diagram import power_diagram
from asphalt_nscd.specimen.prism import cut_prism, pull, static_ratio
from asphalt_nscd.specimen.system import affine_modulus, affine_poisson, bending_system, facet_share
from asphalt_nscd.specimen.trimming import Specimen, layer_height, trim

PAPER_SPHERES = 14160
GEOMETRY = Geometry(b=25e-3, B=56e-3, e=25e-3, h=250e-3, mass=0.6, mobile_mass=0.235)
REDUCTION, REACH, POISSON = 0.1, 2e-3, 0.35
EQS_8_11 = 0.5 / (1.0 + POISSON)  # kt / kn
KT_OVER_KN = [0.02, 0.1, 0.2, EQS_8_11, 0.5, 0.7, 1.0, 1.5, 2.0, 4.0, 10.0]
COLUMNS = [
    "mapping", "kt_over_kn", "spheres", "seed", "friction", "packing", "solid_fraction", "spheres_in_specimen",
    "bonds", "constant", "E_over_law", "E_tension_over_law", "macroscopic_poisson", "affine_poisson",
]  # fmt: skip


def scaled_counts(spheres: int, counts_table: str) -> pd.DataFrame:
    """The table of about so many spheres, graded as those of counts_table."""
    diameters, counts = read_counts(counts_table)
    scaled = np.rint(counts * spheres / counts.sum()).astype(int)
    return pd.DataFrame({"diameter_mm": 1e3 * diameters, "count": scaled})


def scaled_geometry(spheres: int) -> Geometry:
    """The paper's specimen for so many spheres poured."""
    share = spheres / PAPER_SPHERES
    lengths = {name: share ** (1.0 / 3.0) * getattr(GEOMETRY, name) for name in ("b", "B", "e", "h")}
    return Geometry(**lengths, mass=share * GEOMETRY.mass, mobile_mass=share * GEOMETRY.mobile_mass)


def solve(spheres: int, deposit: str) -> list[dict[str, object]]:
    """A row for each mapping of one deposit."""
    record, geometry = load(deposit, "deposit"), scaled_geometry(spheres)
    position, radius = record.arrays["position"], record.arrays["radius"]
    paper = trim(position, radius, geometry, REDUCTION, REACH)
    facets = trim(position, radius, geometry, REDUCTION, REACH, "facets")
    prism = prism_geometry(geometry)

    def pulled(bond: Callable[[np.ndarray, np.ndarray], Network], tangential: float) -> tuple[float, float]:
        return pull(prism_of(position, radius, prism, bond), np.array([1.0, tangential, tangential]))

    cases: list[tuple[str, Specimen, float, Callable[[np.ndarray, np.ndarray], Network]]] = [
        ("paper", paper, EQS_8_11, lambda p, r: bond_network(p, r, prism.h, REACH))
    ]
    for name, change in (
        ("facets", as_is),
        ("facets at mid-gap", at_mid_gap),
        ("facets with moments", moments),
    ):
        changed = replace(facets, network=change(facets.network, facets))
        for tangential in (1.0, EQS_8_11):
            cases.append(
                (name, changed, tangential, lambda p, r, change=change: facets_of(p, r, prism, change))
            )
    rows, of = [], record.attributes
    packing = f"{spheres}-s{of['seed']}-friction{of['friction']:g}"
    for name, specimen, tangential, bond in cases:
        system = bending_system(specimen, POISSON, np.inf, 0.7, kt_over_kn=tangential)
        tension, poisson = pulled(bond, tangential)
        rows.append(
            {
                "mapping": name,
                "kt_over_kn": tangential,
                "spheres": spheres,
                "packing": packing,
                **{key: of[key] for key in ("seed", "friction", "solid_fraction")},
                "spheres_in_specimen": specimen.radius.size,
                "bonds": specimen.network.first.size,
                "constant": 1.0 if name == "paper" else facet_share(geometry, tangential)[0],
                "E_over_law": static_ratio(system, geometry),
                "E_tension_over_law": tension,
                "macroscopic_poisson": poisson,
                "affine_poisson": affine_poisson(tangential),
            }
        )
        print(rows[-1], flush=True)
    return rows


def poisson(spheres: int, deposit: str) -> pd.DataFrame:
    """Modulus and Poisson's ratio of a pulled prism of facets by kt / kn, beside affine theory."""
    arrays, geometry = load(deposit, "deposit").arrays, prism_geometry(scaled_geometry(spheres))
    prism = prism_of(
        arrays["position"], arrays["radius"], geometry, lambda p, r: facets_of(p, r, geometry, as_is)
    )
    rows = []
    for ratio in KT_OVER_KN:
        modulus, lateral = pull(prism, np.array([1.0, ratio, ratio]))
        rows.append((ratio, affine_modulus(ratio), modulus, affine_poisson(ratio), lateral))
    columns = ["kt / kn", "affine E", "network E", "affine Poisson's ratio", "network Poisson's ratio"]
    return pd.DataFrame(rows, columns=columns).round(3) + 0.0


def prism_of(
    position: np.ndarray,
    radius: np.ndarray,
    geometry: Geometry,
    bond: Callable[[np.ndarray, np.ndarray], Network],
) -> Specimen:
    """A prism out of a layer, away from its moulded faces and ends; spheres shrunk as in a specimen."""
    corner = np.array([geometry.h / 3, geometry.e / 8, (layer_height(position, radius) - geometry.b) / 2])
    return cut_prism(position, radius * (1.0 - REDUCTION) ** (1.0 / 3.0), corner, geometry, bond)


def prism_geometry(geometry: Geometry) -> Geometry:
    """Within the moulded faces of the layer: 0.8 e by e, three times as long."""
    e = geometry.e
    return Geometry(b=e, B=e, e=0.8 * e, h=3.0 * e, mass=1.0, mobile_mass=0.0)


Change = Callable[[Network, Specimen], Network]


def facets_of(position: np.ndarray, radius: np.ndarray, geometry: Geometry, change: Change) -> Network:
    """The facets of a prism, changed."""
    network = facet_network(position, radius, geometry)
    return change(network, Specimen(geometry, position, radius, 1.0, network, 0, "facets"))


def as_is(network: Network, specimen: Specimen) -> Network:
    """Facets as the package forms them."""
    return network


def at_mid_gap(network: Network, specimen: Specimen) -> Network:
    """The same facets, acting between the spheres as the paper's bonds do, and not at their centroids."""
    reach = specimen.radius[network.first] + network.gap / 2.0
    return replace(network, point=specimen.position[network.first] + reach[:, None] * network.frame[:, 0])


def moments(network: Network, specimen: Specimen) -> Network:
    """Three bonds for each facet, with its area and its second moments: it resists bending and torsion.

    They lie on the ellipse of inertia, at twice the variance of the facet; a convex facet holds it (Kannan, Lovasz,
    Simonovits 1995).
    """
    facets = power_diagram(specimen.position, specimen.radius, region_of(specimen.geometry))
    uu, vv, uv = facets.spread[facets.second < specimen.radius.size + 2].T
    values, axes = np.linalg.eigh(np.stack([np.stack([uu, uv], -1), np.stack([uv, vv], -1)], axis=1))
    angle = np.radians([90.0, 210.0, 330.0])
    circle = np.sqrt(2.0) * np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    within = np.einsum("pk,bk,buk->bpu", circle, np.sqrt(np.maximum(values, 0.0)), axes)
    point = network.point[:, None] + np.einsum("bpu,bua->bpa", within, network.frame[:, 1:])
    thrice = {name: np.repeat(value, 3, axis=0) for name, value in network.arrays().items()}
    return Network(
        **thrice | {"point": point.reshape(-1, 3), "area": thrice["area"] / 3.0, "cell": network.cell}
    )


def collect(rows: Sequence[str]) -> pd.DataFrame:
    """All rows, by mapping and size."""
    table = pd.concat([pd.read_csv(path) for path in rows], ignore_index=True)
    order = ["spheres", "friction", "seed", "mapping", "kt_over_kn"]
    return table.sort_values(order, kind="stable")


def summary(table: pd.DataFrame) -> pd.DataFrame:
    """For each mapping and size: packings, and what they have in common."""
    groups = table.groupby(["mapping", "kt_over_kn", "spheres"], sort=True)
    found = groups.agg(
        packings=("packing", "size"),
        least=("E_over_law", "min"),
        mean=("E_over_law", "mean"),
        largest=("E_over_law", "max"),
        in_tension=("E_tension_over_law", "mean"),
        poisson=("macroscopic_poisson", "mean"),
    )
    found.columns = ["packings", "least E / law", "mean", "largest", "in tension", "Poisson's ratio"]
    return (found.round(3) + 0.0).reset_index().round({"kt_over_kn": 3})


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parts = parser.add_subparsers(dest="part", required=True)
    part = parts.add_parser("counts")
    part.add_argument("spheres", type=int)
    part.add_argument("counts")
    for name in ("solve", "poisson"):
        part = parts.add_parser(name)
        part.add_argument("spheres", type=int)
        part.add_argument("deposit")
    part = parts.add_parser("collect")
    part.add_argument("rows", nargs="+")
    part.add_argument("--summary", required=True)
    for part in parts.choices.values():
        part.add_argument("--output", required=True)
    given = parser.parse_args()
    if given.part == "counts":
        write_table(given.output, scaled_counts(given.spheres, given.counts))
    elif given.part == "solve":
        write_table(given.output, pd.DataFrame(solve(given.spheres, given.deposit), columns=COLUMNS))
    elif given.part == "poisson":
        write_table(given.output, poisson(given.spheres, given.deposit))
    else:
        table = collect(given.rows)
        write_table(given.output, table)
        write_table(given.summary, summary(table))


if __name__ == "__main__":
    main()
