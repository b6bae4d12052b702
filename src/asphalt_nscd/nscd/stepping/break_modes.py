"""Directions kept ready for the bonds most likely to break, so that a break needs no factorisation.

When a bond breaks, the motion changes within the Krylov space that starts from the three forces the
bond can no longer bear. A few of its vectors are found and projected while a factorisation is at
hand; taking them in is then a matter of small matrices.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.sparse.linalg import SuperLU

from asphalt_nscd.nscd.bonds.system import BondedSystem
from asphalt_nscd.nscd.stepping.projection import Projection, rows_of
from asphalt_nscd.nscd.stepping.reduced_model import Columns, ReducedModel

BONDS = 8  # kept ready; each costs half a second to find, and the paper's tests break six at most
AHEAD = 8  # found at once when another one breaks, which costs a factorisation
DEPTH = 2  # blocks of the Krylov space: residuals of 1e-6 with one, 2e-8 with two, 3e-10 with three


@dataclass(frozen=True)
class StandBy:
    """Directions ready for the break of some bonds, in single precision.

    Any directions serve, as the projection is that of the rounded ones. `owner` (m,) is the place in `bonds` (n,) of
    the bond that each column of `directions` (d, m) belongs to; `projection` is on basis and directions, the bonds
    removable.
    """

    bonds: np.ndarray
    owner: np.ndarray
    directions: np.ndarray
    projection: Projection

    @classmethod
    def of(cls, system: BondedSystem, basis: np.ndarray, shifted: SuperLU, most: int = BONDS) -> StandBy:
        """Directions for `most` bonds that the driven motion alone, either way, breaks one by one."""
        search = _Search(system, basis, shifted, {})
        return cls._make(search, search.following([], most))

    @classmethod
    def _make(cls, search: _Search, bonds: Sequence[int]) -> StandBy:
        """Directions of `bonds`, in this order, and their projection."""
        system = search.system
        blocks = [search.directions(bond).astype(np.float32) for bond in bonds]
        directions = np.hstack([np.empty((system.mass.size, 0), np.float32), *blocks])
        owner = np.repeat(np.arange(len(bonds)), [block.shape[1] for block in blocks])
        projection = Projection.of(system, np.hstack([search.basis, directions]), [], bonds)
        return cls(np.array(bonds, int), owner, directions, projection)

    def add_directions(
        self, bonds: Sequence[int], system: BondedSystem, basis: np.ndarray, shifted: SuperLU, ahead: int
    ) -> StandBy:
        """These directions with those of more bonds (m,), and of the next `ahead` that break once these have."""
        known = {int(bond): self.directions[:, self.owner == place] for place, bond in enumerate(self.bonds)}
        search = _Search(system, basis, shifted, known)
        # each once, as asked: a restart that asks for this list gets the same columns to the bit
        return self._make(search, list(dict.fromkeys([*known, *bonds, *search.following(bonds, ahead)])))

    def arrays(self) -> dict[str, np.ndarray]:
        """Arrays by name, for a file."""
        own = {"bonds": self.bonds, "owner": self.owner, "directions": self.directions}
        small = vars(self.projection).items()
        return own | {f"projection/{name}": np.asarray(value) for name, value in small}

    @classmethod
    def from_arrays(cls, arrays: dict[str, np.ndarray]) -> StandBy:
        """Directions from the `arrays` of a file."""
        own = {name: arrays[name] for name in ("bonds", "owner", "directions")}
        projection: dict[str, Any] = {
            name: arrays[f"projection/{name}"] for name in Projection.__dataclass_fields__
        }
        for name in ("head_norm", "load_norm"):
            projection[name] = projection[name].item()
        return cls(**own, projection=Projection(**projection))

    def model(self, system: BondedSystem, basis: np.ndarray, broken: list[int]) -> ReducedModel | None:
        """The reduced model without bonds `broken`; None where a bond has no directions here, or some coincide."""
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
        # directions that depend on each other, to the rounding of single precision: the stepper then finds
        # its own
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


class _Search:
    """Which bonds break one after another under the driven motion at rest, and their directions."""

    def __init__(
        self, system: BondedSystem, basis: np.ndarray, shifted: SuperLU, known: dict[int, np.ndarray]
    ) -> None:
        """basis (d, k): column 0 moves the driven degree of freedom. known: directions (d, any) of some bonds."""
        self.system, self.basis, self._shifted = system, basis, shifted
        self._columns, self._found = Columns(system, basis), dict(known)

    def directions(self, bond: int) -> np.ndarray:
        """What the Krylov space of one bond's forces adds to the basis, orthonormal in the stiffness."""
        if bond not in self._found:
            self._found[bond] = _directions(self.system, self._columns, self._shifted, bond)
        return self._found[bond]

    def following(self, broken: Sequence[int], most: int) -> list[int]:
        """The bonds, at `most` so many, that break one after another once `broken` have."""
        network = _Network(self.system, self.basis)
        for bond in broken:
            network.remove(bond, self.directions(bond))
        bonds: list[int] = []
        while len(bonds) < most and (stress := network.stress()).any():
            bonds.append(int(np.argmax(stress)))
            network.remove(bonds[-1], self.directions(bonds[-1]))
        return bonds


class _Network:
    """The bonds under the driven motion at rest, from which one after another is removed."""

    def __init__(self, system: BondedSystem, basis: np.ndarray) -> None:
        """basis (d, k): the first column moves the driven degree of freedom, the others leave it at rest."""
        self._system, self._weight = system, system.weight.copy()
        self._openings = [system.operator @ basis]
        self._stiffness = self._openings[0].T @ (self._weight[:, None] * self._openings[0])

    def remove(self, bond: int, directions: np.ndarray) -> None:
        """Let the bond break, and the motion answer in its `directions` (d, any) too."""
        new = self._system.operator @ directions.astype(float)
        weighted = self._weight[:, None] * new
        across = np.vstack([part.T @ weighted for part in self._openings])
        self._stiffness = np.block([[self._stiffness, across], [across.T, new.T @ weighted]])
        self._openings.append(new)
        rows = rows_of([bond])
        gone = np.hstack([part[rows] for part in self._openings])
        self._stiffness -= gone.T @ (self._weight[rows, None] * gone)
        self._weight[rows] = 0.0

    def stress(self) -> np.ndarray:
        """Utilisation (b,) of each bond, either way, per unit of the driven motion; zero where broken."""
        # least squares, for a break may leave a body loose and the stiffness singular
        others = np.linalg.lstsq(self._stiffness[1:, 1:], -self._stiffness[1:, 0], rcond=None)[0]
        shares = np.split(
            np.concatenate([[1.0], others]), np.cumsum([o.shape[1] for o in self._openings])[:-1]
        )
        opening = sum(part @ share for part, share in zip(self._openings, shares, strict=True))
        reaction = self._weight * opening
        # the head moves both ways
        return np.maximum(self._system.utilisation(reaction), self._system.utilisation(-reaction))


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
