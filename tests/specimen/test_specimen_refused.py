"""What is refused before hours are spent on it, beside the nearest that is not."""

from __future__ import annotations

import numpy as np
import pytest

from asphalt_nscd.files.errors import InputError
from asphalt_nscd.measurements.twopoint import Geometry
from asphalt_nscd.specimen import preparation, settings
from asphalt_nscd.specimen.given_spheres import overlaps, require_spheres
from asphalt_nscd.specimen.granular_bed import LARGEST_RATIO, PouringNumerics
from asphalt_nscd.specimen.lattice import random_lattice
from asphalt_nscd.specimen.settings import Pouring, Vibration
from asphalt_nscd.specimen.trimming import layer_height, trim

BOX = (0.06, 0.01, 0.14)
GEOMETRY = Geometry(b=10e-3, B=20e-3, e=10e-3, h=60e-3, mass=0.02, mobile_mass=0.008)


def strewn(counts, box=(0.008, 0.012, 0.016)):
    """Spheres of 2 and 4 mm in 24 cells of 4 mm."""
    return random_lattice(np.array([2e-3, 4e-3]), np.array(counts), box, np.random.default_rng(1))


def poured_on(apart):
    """Two spheres of 4 mm at this distance."""
    position = np.array([[0.03, 0.005, 0.02], [0.03, 0.005, 0.02 + apart]])
    return preparation.pour_on(position, np.full(2, 2e-3), Pouring(BOX))


def shaken(frequency=30.0, duration=1.0, time_step=4e-4):
    return Pouring(BOX, vibration=Vibration(frequency=frequency, duration=duration), time_step=time_step)


def trimmed(long=1.0, high=1.3, reach=2e-3, larger=1.0):
    """A jittered lattice as wide as the specimen, so many times as long, and as high as its foot is wide."""
    rng = np.random.default_rng(2)
    cells = np.indices((18, 3, 8)).reshape(3, -1).T
    radius = larger * rng.uniform(1.2e-3, 1.6e-3, len(cells))
    position = np.array([60e-3, 10e-3, 26.4e-3]) / [18, 3, 8] * (cells + 0.5)
    position += rng.uniform(-5e-5, 5e-5, cells.shape)
    position *= [long, 1.0, high * GEOMETRY.width / layer_height(position, radius)]
    return trim(position, radius, GEOMETRY, 0.1, reach)


def far_off(place, size=1.0):
    position = np.array([[0.0, 0.0, 0.0], [0.0, place, 0.0]])
    require_spheres("these", position, np.array([1.0, size]))


def test_overlaps_of_some_spheres():
    """The largest is not that of the largest share; a hundredth of the smaller radius counts, and 1 um is touching."""
    radius = np.array([2.0, 2.0, 1.0, 1.0, 2.0, 2.0])
    position = np.zeros((6, 3))
    position[:, 0] = np.array([0.0, 3.85, 6.75, 8.749, 11.7490005, 15.7490025])
    found = overlaps(position, radius)
    assert found.touching.tolist() == [[0, 1], [1, 2], [2, 3], [4, 3]]
    assert (found.largest, found.share) == pytest.approx((0.15, 0.1)) and (found.pair, found.count) == (
        (2, 3),
        2,
    )
    apart = overlaps(2.0 * position, radius)
    assert (apart.largest, apart.share, apart.pair, apart.count, len(apart.touching)) == (
        0.0,
        0.0,
        (0, 0),
        0,
        0,
    )


# What is asked, the first that is refused, the last that is not, and the mend.
LIMITS = {
    "box of one sphere": (lambda side: strewn([1, 1], (0.01, side, 0.01)), 3.9e-3, 4e-3, "largest sphere.*enlarge"),
    "octants of 20 cells": (lambda small: strewn([small, 4]), 161, 160, "its 24 lattice cells cannot hold 165 spheres"),
    "cells": (lambda large: strewn([0, large]), 25, 24, "cannot hold 25 spheres; enlarge the box or lower the counts"),
    "largest box": (lambda side: Pouring((side, 0.02, 0.12)), 10.1, 10.0, "is longer than 10 m; give its sides in m"),
    "flat box": (lambda side: Pouring((0.06, side, 0.12)), 0.0, 1e-9, "in m, greater than zero"),
    "sides of a box": (lambda sides: Pouring(BOX[:sides]), 2, 3, "give length, width and height"),
    "fast vibration": (shaken, 251.0, 250.0, "steps of 0.0004 s in a period of 251 Hz .* step of 0.0004 s or less"),
    "no vibration": (lambda time: shaken(1000.0, time), 1e-3, 0.0, "do not follow it"),
    "steps": (lambda time: shaken(duration=time, time_step=1e-5), 1.11, 1.09, "raise the time step, or vibrate"),
    "threads": (lambda threads: Pouring(BOX, threads=threads), 3, 2, "threads = 3: give a whole number from 1 to 2"),
    "no thread": (lambda threads: Pouring(BOX, threads=threads), 0, 1, "threads = 0: give a whole number from 1 to 2"),
    "spheres in one place": (poured_on, 0.0, 3.01e-3, "spheres 1 and 2 overlap by 200% of the smaller radius"),
    "overlap": (poured_on, 2.98e-3, 3.02e-3, "overlap by 51% of the smaller radius"),
    "sizes": (
        lambda times: PouringNumerics.of(1e-3 * np.array([1.0, times * LARGEST_RATIO]), 4e-4),
        1.01, 1.0, "leave out the smallest",
    ),
    "far": (far_off, -1.01e6, -0.99e6, "these: sphere 2 is more than 1000 km away or wide"),
    "wide": (lambda size: far_off(1.0, size), 1.01e6, 0.99e6, "sphere 2 is more than 1000 km away or wide"),
    "masked": (lambda kind: require_spheres("", kind([[0, 0, 0]]), np.ones(1)), np.ma.array, np.array, "masked arrays"),
    "low layer": (lambda high: trimmed(high=high, larger=0.7), 0.99, 1.01, r"19\.8 mm high, less than the foot .*20"),
    "bonds": (lambda reach: trimmed(reach=reach), 1e-5, 2e-3, "no sphere is left after trimming"),
    "box shorter than the specimen": (lambda long: trimmed(long), 0.95, 0.98, r"no chain .* is high \(60.0 mm\)"),
    "box longer than the specimen": (lambda long: trimmed(long), 1.02, 1.0, r"overlap by 0\.\d+ mm.*the box as long"),
    "thick spheres": (lambda larger: trimmed(larger=larger), 1.3, 1.0, r"overlap by 0\.\d+ mm; raise the reduction"),
}  # fmt: skip


@pytest.mark.parametrize("limit", LIMITS)
def test_limit(monkeypatch, limit):
    monkeypatch.setattr(settings, "cores", lambda: 2)
    monkeypatch.setattr(preparation, "_settled", lambda *bed: None)
    ask, refused, nearest, mend = LIMITS[limit]
    ask(nearest)
    with pytest.raises(InputError, match=mend):
        ask(refused)
