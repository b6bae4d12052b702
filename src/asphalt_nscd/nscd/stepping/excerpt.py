"""What a test needs of a reduced model while no bond comes near to breaking: small matrices and a few bonds."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from asphalt_nscd.nscd.stepping.bond_bounds import BondBounds, Rest

if TYPE_CHECKING:  # whose import takes as long as a test
    from asphalt_nscd.nscd.stepping.break_modes import StandBy
    from asphalt_nscd.nscd.stepping.reduced_model import ReducedModel

SMALL = ("mass", "stiffness", "load", "residual_factor")
NUMBERS = ("head_norm", "load_norm")


@dataclass(frozen=True)
class Excerpt:
    """Part of a `ReducedModel` without broken bonds, with equal bits; `whole` gives the rest of it."""

    mass: np.ndarray  # (k, k) kg
    stiffness: np.ndarray  # (k, k) m
    load: np.ndarray  # (k,) N
    residual_factor: np.ndarray
    head_norm: float
    load_norm: float
    bounds: BondBounds
    reaction: np.ndarray  # (n, 3, k) of the bonds listed, over their strength, per unit s
    closing: np.ndarray  # (n, k) share of their gaps, per unit q
    whole: Callable[[], tuple[ReducedModel, StandBy | None]] = field(compare=False)

    @property
    def size(self) -> int:
        """Number k of coordinates."""
        return self.load.size

    def reaction_of(self, bonds: np.ndarray) -> np.ndarray:
        """Reactions (n, 3, k) over their strength, per unit s, of listed bonds (n,), as of a ReducedModel."""
        return self.reaction[self.bounds.places(bonds)]

    def closing_of(self, bonds: np.ndarray) -> np.ndarray:
        """Shares (n, k) of the gaps of listed bonds (n,) that close per unit q, as of a ReducedModel."""
        return self.closing[self.bounds.places(bonds)]

    def arrays(self) -> dict[str, np.ndarray]:
        """Arrays by name, for a file; contributions follow from reactions."""
        rest = {f"rest/{name}": np.asarray(value) for name, value in vars(self.bounds.rest).items()}
        own = {name: np.asarray(getattr(self, name)) for name in (*SMALL, *NUMBERS, "reaction", "closing")}
        return own | rest | {"number": self.bounds.number, "gap": self.bounds.gap}

    @classmethod
    def of(cls, model: ReducedModel, whole: Callable[[], Any]) -> Excerpt:
        """Excerpt of a model without broken bonds; `whole` gives the model and its directions when needed."""
        bounds, chosen = model.bounds.excerpt()
        return cls(
            **{name: getattr(model, name) for name in (*SMALL, *NUMBERS)},
            bounds=bounds,
            reaction=model.reaction_of(chosen),
            closing=model.closing_of(chosen),
            whole=whole,
        )

    @classmethod
    def from_arrays(cls, arrays: dict[str, np.ndarray], whole: Callable[[], Any]) -> Excerpt:
        """Excerpt from the `arrays` of a file; `whole` gives the model and its directions when needed."""
        rest = {name: arrays[f"rest/{name}"] for name in ("utilised", "closed", "travel")}
        reaction, closing = arrays["reaction"], arrays["closing"]
        # summed as `bound` does, so that the excerpt has the bits of the whole model
        utilised = np.sqrt(reaction[:, 0] ** 2 + reaction[:, 1] ** 2 + reaction[:, 2] ** 2)
        bounds = BondBounds(
            arrays["number"],
            utilised,
            np.abs(closing),
            arrays["gap"],
            Rest(**rest, gap=arrays["rest/gap"].item()),
        )
        small: dict[str, Any] = {name: arrays[name] for name in SMALL}
        small |= {name: arrays[name].item() for name in NUMBERS}
        return cls(
            **small,
            bounds=bounds,
            reaction=reaction,
            closing=closing,
            whole=whole,
        )
