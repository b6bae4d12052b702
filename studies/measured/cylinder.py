"""A cylinder of full size, poured and bonded by facets, on which laws of measured mixes are tested as machines test."""

from typing import Any

import numpy as np

import asphalt_nscd as an
from asphalt_nscd.bending.condensing import condensed
from asphalt_nscd.bending.excerpt import write_excerpt
from asphalt_nscd.bending.model import read_model
from asphalt_nscd.bending.settings import Bonds
from asphalt_nscd.cli import run_script
from asphalt_nscd.files.store import save
from asphalt_nscd.measurements.tension import AMPT

SPHERES = {8.0: 1640, 12.6: 264, 16.0: 113, 20.0: 38}  # mm: those of `new-study`, the volume of 4 mm as 8 mm
BOX = 0.15, 0.1, 1.2  # m


def run(job: Any) -> None:
    """The condensed model without weight, and its excerpt, HDF5."""
    packing = an.pour(SPHERES, BOX, vibration=an.Vibration(duration=0.0), seed=1)
    specimen = an.specimen(packing, AMPT.keys(), area="facets")
    arrays, attributes = condensed(specimen.bonded, "cylinder", Bonds(), stand_by=0)
    save(job.output.model, "model", arrays | {"load": np.zeros_like(arrays["load"])}, attributes)
    model = read_model(job.output.model)
    write_excerpt(job.output.excerpt, model, model.digest)


if __name__ == "__main__":
    run_script(globals()["snakemake"], run)
