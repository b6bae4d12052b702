"""Figs. 1 and 5: the shaded spheres, the section, and the drawing of the specimen."""

from __future__ import annotations

import json

import numpy as np
import pytest
from matplotlib.collections import EllipseCollection, LineCollection
from matplotlib.patches import Polygon

from asphalt_nscd.files.store import load, save
from asphalt_nscd.measurements.geometry import read_shape
from asphalt_nscd.reporting.figures import fig01, fig05, style
from asphalt_nscd.reporting.figures.section import draw_section
from asphalt_nscd.reporting.figures.spheres import View, picture

FRONT = View(0.0, 0.0)
RED, BLUE = np.array([1.0, 0.0, 0.0]), np.array([0.0, 0.0, 1.0])


def test_untilted_view_shows_x_to_the_right_and_z_up():
    assert FRONT.project(np.eye(3)) == pytest.approx(np.array([[1, 0, 0], [0, 0, -1], [0, 1, 0]]))


def test_any_view_is_a_rotation():
    turned = View(-31.0, 17.0).project(np.eye(3))
    assert turned @ turned.T == pytest.approx(np.eye(3))
    assert np.linalg.det(turned) == pytest.approx(1.0)
    # Seen from above, what is higher appears higher and what is farther away appears higher too.
    assert turned[2, 1] > 0.0 and View(0.0, 17.0).project([0.0, 1.0, 0.0])[1] > 0.0


def test_one_sphere_is_a_disc_of_its_size():
    image, (left, right, bottom, top) = picture(np.zeros((1, 3)), np.array([0.01]), RED[None], FRONT, 10000.0)
    covered = image[..., 3].sum() / 10000.0**2
    assert covered == pytest.approx(np.pi * 0.01**2, rel=2e-3)
    assert (right - left, top - bottom) == pytest.approx((0.02, 0.02), abs=4e-4)
    assert 0.5 * (left + right) == pytest.approx(0.0, abs=1e-4)
    middle = image[image.shape[0] // 2, image.shape[1] // 2]
    assert middle[0] > 0.5 and middle[1] == middle[2] == 0.0 and middle[3] == 1.0
    assert image.min() >= 0.0 and image.max() <= 1.0


def test_light_comes_from_above():
    image, _ = picture(np.zeros((1, 3)), np.array([0.01]), np.ones((1, 3)), FRONT, 4000.0)
    upper, lower = np.split(image[: image.shape[0] // 2 * 2], 2)
    assert upper[..., :3].sum() > 1.2 * lower[..., :3].sum()


@pytest.mark.parametrize("order", [[0, 1], [1, 0]])
def test_nearer_sphere_hides_the_farther_one(order):
    position = np.array([[0.0, -0.03, 0.0], [0.0, 0.03, 0.0]])[order]  # the viewer is at negative y
    colour = np.stack([RED, BLUE])[order]
    image, _ = picture(position, np.array([0.01, 0.01]), colour, FRONT, 2000.0)
    assert image[..., 0].max() > 0.5 and image[..., 2].max() == 0.0


def test_stages_and_sizes(results):
    poured, cut = load(results.deposit()[0], "deposit"), load(results.specimen()[0], "specimen")
    figure = fig05.draw(deposit=results.deposit(), specimen=results.specimen())
    scenes = [axes for axes in figure.axes if axes.images]
    stages = [poured.arrays[name] for name in ("initial_position", "poured_position", "position")]
    stages = [(position, poured.arrays["radius"]) for position in stages]
    scales = []  # mm on paper for one of the view's plane
    for axes, (position, radius) in zip(scenes, [*stages, (cut.arrays["position"], cut.arrays["radius"])]):
        seen = fig05.VIEW.project(position)[:, :2]
        span = (seen + radius[:, None]).max(axis=0) - (seen - radius[:, None]).min(axis=0)
        extent = np.array(axes.images[0].get_extent())
        assert extent[[1, 3]] - extent[[0, 2]] == pytest.approx(span, rel=0.08)
        box = axes.get_position()
        paper = np.array([box.width * style.WIDE, box.height * fig05.HEIGHT]) / (
            extent[[1, 3]] - extent[[0, 2]]
        )
        assert paper[0] == pytest.approx(paper[1])
        scales.append(paper[0])
    assert scales[1:] == pytest.approx(3 * [scales[1]])
    edges = [np.linalg.norm(np.diff(line.get_xydata(), axis=0)) for line in scenes[0].lines]
    seen = np.linalg.norm(fig05.VIEW.project(np.diag(poured.arrays["box"]))[:, :2], axis=1)
    assert sorted(edges) == pytest.approx(sorted(np.repeat(seen, 4)))
    legend = figure.axes[-1]
    # one millimetre of the legend's axes is one on paper
    assert [circle.get_radius() for circle in legend.patches] == pytest.approx(
        [2.5e-3 * scales[1], 1e-3 * scales[1]]
    )
    assert np.allclose(fig05._poured_radius(cut), [1e-3, 1e-3, 2.5e-3, 1e-3])
    titles = [text.get_text() for text in figure.texts]
    assert [title[5] for title in titles] == ["a", "b", "c", "d", "e"]
    assert titles[1].endswith("poured, 24.0 mm high") and titles[2].endswith("vibrated, 20.3 mm high")
    labels = [text.get_text() for axes in figure.axes for text in axes.texts]
    assert labels == ["diameter", "5 mm", "2 mm"]
    assert sum(len(axes.images) for axes in figure.axes) == 4
    assert figure.get_size_inches()[0] * 25.4 == pytest.approx(style.WIDE)
    for axes in figure.axes:  # nothing beyond the paper
        box = axes.get_position()
        assert min(box.x0, box.y0) > 0.0 and max(box.x1, box.y1) < 1.0
    figure.draw_without_rendering()
    for item in (*legend.patches, *legend.texts):  # nor beyond its own place, however low the section is
        inside = item.get_window_extent().transformed(legend.transAxes.inverted())
        assert min(inside.x0, inside.y0) > -0.01 and max(inside.x1, inside.y1) < 1.01


def test_a_thick_layer_leaves_room_for_its_section(results, tmp_path):
    """As of a cylinder: layers as high as the specimen is wide, one above the other."""
    poured = load(results.deposit()[0], "deposit")
    arrays = dict(poured.arrays)
    for name in ("poured_position", "position"):
        arrays[name] = arrays[name] * np.array([1.0, 1.0, 3.0])
    save(tmp_path / "thick.h5", "deposit", arrays, poured.attributes)
    figure = fig05.draw(deposit=[tmp_path / "thick.h5"], specimen=results.specimen())
    for axes in figure.axes:
        box = axes.get_position()
        assert min(box.x0, box.y0) > 0.0 and max(box.x1, box.y1) < 1.0 and min(box.width, box.height) > 0.03


def test_shades_grow_darker_with_the_diameter():
    sizes = np.array([1e-3, 2e-3, 3.15e-3, 4e-3, 5e-3])
    grey = fig05._shades(sizes, sizes) @ [0.299, 0.587, 0.114]
    assert (np.diff(grey) < -0.05).all()


def test_section_cuts_spheres_and_leaves_out_bonds_to_plates(results):
    figure, axes = style.new_figure(90, 90)
    specimen = load(results.specimen()[0], "specimen")
    draw_section(axes, specimen, np.ones((4, 3)))
    discs = next(item for item in axes.collections if isinstance(item, EllipseCollection))
    bonds = next(item for item in axes.collections if isinstance(item, LineCollection))
    radius = 1e-3 * 0.9 ** (1.0 / 3.0)
    # The third sphere lies beside the plane; the second is met 0.4 mm off its middle.
    assert discs.get_widths() == pytest.approx(
        2.0 * np.array([radius, np.sqrt(radius**2 - 4e-4**2), radius]), rel=1e-9
    )
    assert [segment.tolist() for segment in bonds.get_segments()] == [[[0.0, 0.03], [0.003, 0.03]]]


CYLINDER = {"d_mm": 100, "h_mm": 150, "mass_kg": 2.8, "mobile_mass_kg": 0.3}
TRAPEZOID = {"b_mm": 10, "B_mm": 20, "e_mm": 12, "h_mm": 60, "mass_kg": 0.021, "mobile_mass_kg": 0.008}
PRISM = {"L_mm": 357, "H_mm": 50, "B_mm": 63, "mass_kg": 2.7, "mobile_mass_kg": 0.5}


@pytest.mark.parametrize(
    ("geometry", "amplitude", "held", "driven"),
    [
        (CYLINDER, "7.5", [0.0], [1.0]),
        (TRAPEZOID, "10", [0.0], [1.0]),
        (PRISM, "24", [0.0, 1.0], [1 / 3, 2 / 3]),
    ],
)
def test_drawing_carries_the_numbers_of_the_study(tmp_path, geometry, amplitude, held, driven):
    study = {"specimens": {"geometry": geometry}, "test": {"amplitude_m": 1e-6 * float(amplitude)}}
    (path := tmp_path / "study.json").write_text(json.dumps(study))
    left, right = fig01.draw(study=[path]).axes
    texts = " ".join(text.get_text() for axes in (left, right) for text in axes.texts)
    lengths = [f"${name[:-3]}$ = {value} mm" for name, value in geometry.items() if name.endswith("_mm")]
    masses = [f"$M$ = {geometry['mass_kg']} kg", f"$m$ = {geometry['mobile_mass_kg']} kg"]
    for words in (*lengths, *masses, f"{amplitude} µm"):
        assert words in texts, words
    shape = read_shape(geometry)
    foot, head = (
        1e-3 * geometry[name]
        for name in {0: ("d_mm",) * 2, 1: ("B_mm", "b_mm"), 2: ("H_mm",) * 2}[
            [CYLINDER, TRAPEZOID, PRISM].index(geometry)
        ]
    )
    front = np.array([[-foot / 2, 0.0], [foot / 2, 0.0], [head / 2, shape.h], [-head / 2, shape.h]])
    body, *plates = right.patches
    assert body.get_xy()[:4] == pytest.approx(front)
    assert any(
        patch.get_xy()[:4] == pytest.approx(front) for patch in left.patches if isinstance(patch, Polygon)
    )
    places = {round((plate.get_y() + 0.5 * plate.get_height()) / shape.h, 1): plate for plate in plates}
    assert sorted(places) == pytest.approx(sorted(np.round([*held, *driven], 1)))
    hatched = sorted(level for level, plate in places.items() if plate.get_hatch())
    assert hatched == held  # plates that rest
    arrows = [text for text in right.texts if text.get_text() == ""]
    for arrow, level in zip(arrows, sorted(driven, reverse=True), strict=True):
        along = np.subtract(arrow.xy, arrow.xyann)
        if geometry is CYLINDER:  # along its axis
            assert along[0] == 0.0 and along[1] > 0.0
        else:
            assert along[1] == 0.0 and along[0] > 0.0 and arrow.xy[1] == pytest.approx(level * shape.h)
    (west, upright), (east, _) = (line.get_data() for line in right.lines)
    middle, width = 0.5 * (west + east), east - west
    np.testing.assert_allclose(width, np.linspace(foot, head, 80))
    if geometry is CYLINDER:
        assert np.ptp(middle) == 0.0 and upright[-1] > 1.05 * shape.h
    else:
        line = shape.line(upright)
        np.testing.assert_allclose(upright, np.linspace(0.0, shape.h, 80))
        np.testing.assert_allclose(middle / np.abs(middle).max(), line / np.abs(line).max(), atol=1e-12)
        assert np.abs(middle).max() > 0.05 * shape.h
