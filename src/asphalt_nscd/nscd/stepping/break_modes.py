"""Directions kept ready for the bonds most likely to break, so that a break needs no factorisation.

When a bond breaks, the motion changes within the Krylov space that starts from the three forces the
bond can no longer bear. A few of its vectors are found and projected while a factorisation is at
hand; taking them in is then a matter of small matrices.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.sparse.linalg import SuperLU

from asphalt_nscd.nscd.bonds.system import BondedSystem
from asphalt_nscd.nscd.stepping.projection import Projection, rows_of
from asphalt_nscd.nscd.stepping.reduced_model import Columns, ReducedModel

BONDS = 7  # each costs half a second to find; for others, that break all the same, the test factorises
FOLLOWED = 5  # of them: in the paper's tests no others break
DEPTH = 2  # blocks of the Krylov space: residuals of 1e-6 with one, 2e-8 with two, 3e-10 with three


@dataclass(frozen=True)
class StandBy:
    """bonds (n,); directions (d, m), of which column j belongs to the bond at place owner[j].

    In single precision: they are what they are, and the projection is that of the rounded ones.
    """

    bonds: np.ndarray
    owner: np.ndarray
    directions: np.ndarray
    projection: Projection  # on basis and directions, the bonds removable

    @classmethod
    def of(cls, system: BondedSystem, basis: np.ndarray, shifted: SuperLU, most: int = BONDS) -> StandBy:
        """For the bonds, at `most` so many, that the driven motion alone, either way, brings nearest to yield.

        First those FOLLOWED from break to break, then the most stressed of the unbroken system.
        """
        bonds: list[int] = []
        blocks: list[np.ndarray] = []
        opening = system.operator @ basis
        columns = Columns(system, basis)
        stress = _stress_without([], system, opening)
        unbroken = stress.copy()
        while len(bonds) < most and stress.any():
            bonds.append(int(np.argmax(stress)))
            blocks.append(_directions(system, columns, shifted, bonds[-1]))
            if len(bonds) < FOLLOWED:
                opening = np.hstack([opening, system.operator @ blocks[-1]])
                stress = _stress_without(bonds, system, opening)
            else:
                stress = unbroken
            stress[bonds] = 0.0
        directions = np.hstack([np.empty((system.mass.size, 0)), *blocks]).astype(np.float32)
        owner = np.repeat(np.arange(len(bonds)), [block.shape[1] for block in blocks])
        projection = Projection.of(system, np.hstack([basis, directions]), [], bonds)
        return cls(np.array(bonds, int), owner, directions, projection)

    def arrays(self) -> dict[str, np.ndarray]:
        """By name, for a file."""
        own = {"bonds": self.bonds, "owner": self.owner, "directions": self.directions}
        small = vars(self.projection).items()
        return own | {f"projection/{name}": np.asarray(value) for name, value in small}

    @classmethod
    def from_arrays(cls, arrays: dict[str, np.ndarray]) -> StandBy:
        """Of the `arrays` of a file."""
        own = {name: arrays[name] for name in ("bonds", "owner", "directions")}
        projection: dict[str, Any] = {
            name: arrays[f"projection/{name}"] for name in Projection.__dataclass_fields__
        }
        for name in ("head_norm", "load_norm"):
            projection[name] = projection[name].item()
        return cls(**own, projection=Projection(**projection))

    def model(self, system: BondedSystem, basis: np.ndarray, broken: list[int]) -> ReducedModel | None:
        """The reduced model without `broken`, on `basis` and the directions of these bonds in their order.

        None where a bond has no directions here, or none of its own.
        """
        places = [np.flatnonzero(self.bonds == bond) for bond in broken]
        if not all(place.size for place in places):
            return None
        removed = np.concatenate([np.empty(0, int), *places])
        chosen = np.concatenate([np.empty(0, int), *(np.flatnonzero(self.owner == p) for p in removed)])
        columns = np.concatenate([np.arange(basis.shape[1]), basis.shape[1] + chosen])
        # orthonormal in the stiffness of the unbroken system, each with those before it
        gram = self.projection.stiffness[np.ix_(columns[1:], columns[1:])]
        try:
            upper = np.linalg.inv(np.linalg.cholesky(gram)).T
        except np.linalg.LinAlgError:
            return None
        k = basis.shape[1] - 1
        upper[:k, :k] = np.eye(k)  # which it is to rounding: the basis itself must not change
        mixing = np.zeros((self.projection.load.size, columns.size))
        mixing[0, 0] = 1.0
        mixing[columns[1:], 1:] = upper
        extra = basis[:, 1:] @ upper[:k, k:] + self.directions[:, chosen].astype(float) @ upper[k:, k:]
        small = self.projection.combined(mixing, removed)
        return ReducedModel(system, np.hstack([basis, extra]), broken, small)


def _stress_without(broken: list[int], system: BondedSystem, opening: np.ndarray) -> np.ndarray:
    """Utilisation (b,) of each bond, either way, per unit of the driven motion at rest; zero where broken.

    opening (3 b, k): of columns, the first of which moves the driven degree of freedom and the others leave it.
    """
    weight = system.weight.copy()
    weight[rows_of(broken)] = 0.0
    stiffness = opening.T @ (weight[:, None] * opening)
    others = np.linalg.lstsq(stiffness[1:, 1:], -stiffness[1:, 0], rcond=None)[0]
    reaction = weight * (opening @ np.concatenate([[1.0], others]))
    return np.maximum(system.utilisation(reaction), system.utilisation(-reaction))


def _directions(system: BondedSystem, columns: Columns, shifted: SuperLU, bond: int) -> np.ndarray:
    """What the Krylov space of one bond's forces adds to the columns, orthonormal in the stiffness."""
    free = system.free
    force = system.operator[rows_of([bond])][:, free].T.toarray()
    found = np.zeros((system.mass.size, 0))
    for _ in range(DEPTH):
        motion = np.zeros((system.mass.size, 3))
        motion[free] = shifted.solve(force)
        force = system.mass[free, None] * motion[free]
        found = np.hstack([found, motion])
    return columns.new_in(found)
