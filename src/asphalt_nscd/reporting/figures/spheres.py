"""Shaded pictures of many spheres: an orthographic view with a depth buffer, in plain numpy."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray
from scipy.ndimage import uniform_filter

OVERSAMPLING = 2  # per direction, averaged away at the end
LIGHT = np.array([-0.45, 0.62, 0.64])  # right, up, towards the viewer; a unit vector within rounding
AMBIENT = 0.42
CREVICES = 0.55  # how strongly places below their surroundings are darkened
PER_MM = 8.0  # pixels of a view from the side
SURROUNDINGS = 1.5  # mean radii over which surroundings are averaged


@dataclass(frozen=True)
class View:
    """Orthographic camera, turned about the vertical by `azimuth`, then raised by `elevation` [degrees].

    Untilted it looks along +y: x is to the right and z up.
    """

    azimuth: float
    elevation: float

    def project(self, position: NDArray[np.float64]) -> NDArray[np.float64]:
        """Positions (n, 3) [m] as the camera sees them: right, up and towards the viewer [m]."""
        a, e = np.radians([self.azimuth, self.elevation])
        right = np.array([np.cos(a), np.sin(a), 0.0])
        ahead = np.array([-np.sin(a) * np.cos(e), np.cos(a) * np.cos(e), -np.sin(e)])
        up = np.cross(right, ahead)
        return np.asarray(position) @ np.stack([right, up, -ahead], axis=1)


def picture(
    position: NDArray[np.float64],
    radius: NDArray[np.float64],
    colour: NDArray[np.float64],
    view: View,
    resolution: float,
) -> tuple[NDArray[np.float64], tuple[float, float, float, float]]:
    """RGBA image (height, width, 4) of shaded spheres, and its extent in the view's plane [m].

    The extent is (left, right, bottom, top). `position` (n, 3) and `radius` (n,) in m; `colour` (n, 3) from 0 to 1;
    `resolution` in pixels per metre.
    """
    scale = resolution * OVERSAMPLING
    seen = view.project(position)
    low = (seen[:, :2] - radius[:, None]).min(axis=0)
    high = (seen[:, :2] + radius[:, None]).max(axis=0)
    size = (np.ceil((high - low) * resolution).astype(int) + 2) * OVERSAMPLING
    depth = np.full((size[1], size[0]), -np.inf)
    owner = np.full(depth.shape, -1)
    centre = (seen[:, :2] - low) * scale + OVERSAMPLING
    for n in range(radius.size):
        _splat(depth, owner, n, centre[n], radius[n] * scale, seen[n, 2] * scale)
    image = _shade(depth, owner, centre, radius * scale, colour)
    image = image.reshape(size[1] // OVERSAMPLING, OVERSAMPLING, size[0] // OVERSAMPLING, OVERSAMPLING, 4)
    image = image.mean(axis=(1, 3))
    image[..., :3] /= np.maximum(image[..., 3:], 1e-9)  # colours were weighted with their opacity
    left, bottom = low - 1.0 / resolution
    # imshow draws the first row on top.
    return image[::-1], (left, left + size[0] / scale, bottom, bottom + size[1] / scale)


def side_view(axes: Axes, position: np.ndarray, radius: np.ndarray, colour: np.ndarray) -> None:
    """Draw spheres (n, 3), (n,) [m] of colours (n, 3) as seen along y, in mm."""
    image, extent = picture(position, radius, colour, View(azimuth=0.0, elevation=0.0), 1e3 * PER_MM)
    left, right, bottom, top = (1e3 * side for side in extent)
    axes.imshow(image, extent=(left, right, bottom, top), interpolation="none")
    axes.set_axis_off()


def _splat(
    depth: np.ndarray, owner: np.ndarray, n: int, centre: np.ndarray, radius: float, height: float
) -> None:
    """Enter sphere n into the buffers where nothing lies before it."""
    x0, y0 = np.floor(centre - radius).astype(int)
    x1, y1 = np.ceil(centre + radius).astype(int) + 1
    dx = np.arange(x0, x1) + 0.5 - centre[0]
    dy = np.arange(y0, y1) + 0.5 - centre[1]
    cap = radius**2 - dx**2 - dy[:, None] ** 2
    surface = height + np.sqrt(np.maximum(cap, 0.0))
    window = depth[y0:y1, x0:x1]
    nearer = (cap > 0.0) & (surface > window)
    window[nearer] = surface[nearer]
    owner[y0:y1, x0:x1][nearer] = n


def _shade(
    depth: np.ndarray, owner: np.ndarray, centre: np.ndarray, radius: np.ndarray, colour: np.ndarray
) -> NDArray[np.float64]:
    """Diffuse light on each pixel's sphere, less in crevices; RGB is weighted with alpha."""
    image = np.zeros((*depth.shape, 4))
    row, column = np.nonzero(owner >= 0)
    sphere = owner[row, column]
    normal = np.empty((row.size, 3))
    normal[:, 0] = (column + 0.5 - centre[sphere, 0]) / radius[sphere]
    normal[:, 1] = (row + 0.5 - centre[sphere, 1]) / radius[sphere]
    normal[:, 2] = np.sqrt(np.maximum(0.0, 1.0 - normal[:, 0] ** 2 - normal[:, 1] ** 2))
    light = AMBIENT + (1.0 - AMBIENT) * np.maximum(0.0, normal @ LIGHT)
    # Unsharp mask of the depth buffer (Luft, Colditz & Deussen 2006).
    width = SURROUNDINGS * float(radius.mean())
    covered = owner >= 0
    share = _blurred(covered.astype(float), width)
    mean = _blurred(np.where(covered, depth, 0.0), width) / np.maximum(share, 1e-9)
    below = np.maximum(0.0, (mean - depth)[row, column]) / (2.0 * width)
    light *= 1.0 - CREVICES * np.minimum(1.0, below)
    image[row, column, :3] = np.minimum(1.0, colour[sphere] * light[:, None])
    image[row, column, 3] = 1.0
    return image


def _blurred(image: NDArray[np.float64], width: float) -> NDArray[np.float64]:
    """Two box filters: about a Gaussian of standard deviation `width` [pixels], but as fast for any width."""
    # Two boxes of n pixels have a variance of n^2 / 6.
    size = max(1, round(width * np.sqrt(6.0)))
    return uniform_filter(uniform_filter(image, size, mode="constant"), size, mode="constant")
