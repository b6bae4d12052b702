"""Layers of a specimen between its foot and its head, over which velocities are averaged: Fig. 8."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from scipy import sparse

    from asphalt_nscd.measurements.shape import Shape

LAYERS = 50


@dataclass(frozen=True)
class LayerHeights:
    """Layers of equal height: `height` (l,) of their middles above the foot in m, `spheres` (l,) the number in each."""

    height: np.ndarray
    spheres: np.ndarray


@dataclass(frozen=True)
class Layers(LayerHeights):
    """Layers with the matrix that averages the velocities of their spheres."""

    mean: sparse.csr_matrix  # (l, d): velocities of all bodies to mean velocities along the drive

    @classmethod
    def of(cls, sphere_height: np.ndarray, shape: Shape, degrees: int) -> Layers:
        """Layers of a specimen; `sphere_height` (n,) in m over the foot; `degrees` d, six for each sphere first."""
        from scipy import sparse

        edges = np.linspace(0.0, shape.h, LAYERS + 1)
        # centres at the very head or foot belong to the layer there
        layer = np.clip(np.digitize(sphere_height, edges) - 1, 0, LAYERS - 1)
        spheres = np.bincount(layer, minlength=LAYERS)
        entries = (1.0 / spheres[layer], (layer, 6 * np.arange(layer.size) + shape.axis))
        return cls(
            0.5 * (edges[1:] + edges[:-1]), spheres, sparse.csr_matrix(entries, shape=(LAYERS, degrees))
        )
