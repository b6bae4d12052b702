"""The excerpt of a condensed model: a small file with all that a test needs while no bond comes near to breaking."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from asphalt_nscd.bending.layers import LayerHeights
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.store import load, save
from asphalt_nscd.measurements.geometry import shape_of
from asphalt_nscd.measurements.shape import Shape
from asphalt_nscd.nscd.stepping.excerpt import Excerpt

if TYPE_CHECKING:  # sparse matrices, which take as long to import as a test to run
    from asphalt_nscd.bending.model import Model

KIND = "model excerpt"
REDUCED = "reduced/"


@dataclass(frozen=True)
class ModelExcerpt:
    """Stands for a `Model` in a test by its reduced form, and reads the model by `read_whole` where it must.

    `along` (k, l) turns coordinates of velocity into means over the layers; `reduced_form` holds no directions for
    breaks; `head` is "free" or "blocked"; `name` is that of the specimen.
    """

    reduced_form: tuple[Excerpt, None]
    along: np.ndarray
    layers: LayerHeights
    geometry: Shape
    name: str
    head: str
    spheres: int
    bonds: int
    read_whole: Callable[[], Model]

    @property
    def whole(self) -> Model:
        """The model, read once."""
        return self.read_whole()


def write_excerpt(path: str | Path, model: Model, digest: str) -> None:
    """Write what most tests need of a model as HDF5; `digest` is that of the file with the whole model."""
    reduced, _ = model.reduced_form
    excerpt = Excerpt.of(reduced, lambda: model.reduced_form)
    arrays = {
        "layer_height": model.layers.height,
        "layer_spheres": model.layers.spheres,
        # stored as it lies in memory: a product by columns would add in another order than the model's
        "along": model.along.T,
        **{REDUCED + name: value for name, value in excerpt.arrays().items()},
    }
    attributes = {
        "name": model.name,
        "head": model.head,
        "spheres": model.spheres,
        "bonds": model.bonds,
        "model_digest": digest,
        **model.geometry.attributes(),
    }
    save(path, KIND, arrays, attributes)


def read_excerpt(path: str | Path, model_file: str | Path) -> ModelExcerpt:
    """Read an excerpt made by `condense`; the whole model is read only if a test needs it."""
    arrays, attributes = (record := load(path, KIND)).arrays, record.attributes

    @cache
    def whole() -> Model:
        from asphalt_nscd.bending.model import read_model

        model = read_model(model_file)
        # `condense` may have run again since, and left this excerpt behind
        if model.digest != attributes["model_digest"]:
            raise InputError(
                f"{path}: belongs to another model than {model_file}; make both with one `condense`."
            )
        return model

    small = {name.removeprefix(REDUCED): value for name, value in arrays.items() if name.startswith(REDUCED)}
    return ModelExcerpt(
        reduced_form=(Excerpt.from_arrays(small, lambda: whole().reduced_form), None),
        along=arrays["along"].T,
        layers=LayerHeights(arrays["layer_height"], arrays["layer_spheres"]),
        geometry=shape_of(attributes),
        **{name: attributes[name] for name in ("name", "head", "spheres", "bonds")},
        read_whole=whole,
    )
