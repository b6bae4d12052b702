"""Packings of other programs: every form gives the same spheres, and what is no packing is refused."""

from __future__ import annotations

import numpy as np
import pytest
from click.testing import CliRunner

import asphalt_nscd as an
from asphalt_nscd import cli

vtk = pytest.importorskip("vtk")
MADE = np.random.default_rng(5)
CELLS = np.stack(np.meshgrid(range(6), range(4), range(5), indexing="ij"), axis=-1).reshape(-1, 3)
RADIUS = MADE.uniform(2e-3, 3e-3, len(CELLS))  # m
POSITION = 3e-3 + 6.01e-3 * CELLS  # m
TABLE = np.column_stack([POSITION, RADIUS])


def lines(numbers: np.ndarray, separator: str) -> str:
    return "\n".join(separator.join(f"{value:.12g}" for value in row) for row in numbers) + "\n"


def dump(numbers: np.ndarray, atoms: int | str | None = None) -> str:
    atoms = len(numbers) if atoms is None else atoms
    rows = np.column_stack([np.arange(1, len(numbers) + 1), np.ones(len(numbers)), numbers])
    head = f"ITEM: TIMESTEP\n7000\nITEM: NUMBER OF ATOMS\n{atoms}\nITEM: BOX BOUNDS ff ff ff\n0 1\n0 1\n0 1\n"
    return head + "ITEM: ATOMS id type x y z radius \n" + lines(rows, " ").replace("\n", " \n")


FORMS = {
    "metres.csv": "x_m,y_m,z_m,radius_m\n" + lines(TABLE, ","),
    "plain.csv": "# from a scan\nx,y,z,radius\n" + lines(TABLE, ","),
    "mm.csv": "X [mm];Y [mm];Z [mm];diameter (mm)\n" + lines(1e3 * TABLE * [1, 1, 1, 2], ";"),
    "shuffled.tsv": "id\tradius_mm\tz_mm\ty_mm\tx_mm\n"
    + lines(np.column_stack([np.arange(len(TABLE)), 1e3 * TABLE[:, ::-1]]), "\t"),
    "yade.txt": "#format x_y_z_r\n" + lines(TABLE, "\t"),
    "yade_ids.txt": "#format x_y_z_r_matId\n" + lines(np.column_stack([TABLE, np.zeros(len(TABLE))]), "\t"),
    "four.xyz": lines(1e3 * TABLE, " "),
    "dump.liggghts": dump(1e-3 * TABLE) + dump(TABLE),
}


@pytest.mark.parametrize("name", FORMS)
def test_each_form_gives_the_same_spheres(tmp_path, name):
    (tmp_path / name).write_text(FORMS[name])
    packing = an.read_packing(tmp_path / name)
    low = (POSITION - RADIUS[:, None]).min(axis=0)
    assert np.allclose(packing.position_m, POSITION - low, atol=1e-11)
    assert np.allclose(packing.radius_m, RADIUS, atol=1e-12)


@pytest.mark.parametrize(
    ("ending", "name", "length", "times", "said"),
    [
        (".vtp", "Radius", 1e3, 1.0, "lengths taken as mm"),
        (".vtu", "diameter_m", 1.0, 2.0, "lengths in m, as the file says"),
        (".vtk", "Diameter", 1e3, 2.0, "lengths taken as mm"),
    ],
)
def test_points_of_vtk(tmp_path, ending, name, length, times, said):
    from vtk.util.numpy_support import numpy_to_vtk

    points = vtk.vtkPoints()
    points.SetData(numpy_to_vtk(length * POSITION, deep=True))
    kind = vtk.vtkPolyData if ending == ".vtp" else vtk.vtkUnstructuredGrid
    data, size = kind(), numpy_to_vtk(times * length * RADIUS, deep=True)
    data.SetPoints(points)
    size.SetName(name)
    data.GetPointData().AddArray(size)
    writers = {
        ".vtp": vtk.vtkXMLPolyDataWriter,
        ".vtu": vtk.vtkXMLUnstructuredGridWriter,
        ".vtk": vtk.vtkUnstructuredGridWriter,
    }
    writer = writers[ending]()
    writer.SetFileName(str(tmp_path / f"spheres{ending}"))
    writer.SetInputData(data)
    writer.Write()
    packing = an.read_packing(tmp_path / f"spheres{ending}")
    assert np.allclose(packing.radius_m, RADIUS) and said in " ".join(packing.notes)
    assert np.allclose(packing.position_m, POSITION - (POSITION - RADIUS[:, None]).min(axis=0))


def test_what_was_understood_is_said(tmp_path):
    (tmp_path / "dump.liggghts").write_text(FORMS["dump.liggghts"])
    notes = " ".join(an.read_packing(tmp_path / "dump.liggghts").notes)
    assert "step 7000, the last of 2 snapshots" in notes and "lengths taken as m," in notes
    assert "120 spheres, radii 2 to 3 mm" in notes


def test_attributes_are_those_of_the_spheres(tmp_path):
    (tmp_path / "pile.csv").write_text(FORMS["mm.csv"])
    packing = an.read_packing(tmp_path / "pile.csv")
    size = np.ptp([*(POSITION - RADIUS[:, None]), *(POSITION + RADIUS[:, None])], axis=0)
    assert np.allclose(packing.box_m, size)
    height = 2.0 * np.average(packing.position_m[:, 2], weights=RADIUS**3)
    solid = 4.0 / 3.0 * np.pi * (RADIUS**3).sum() / (size[0] * size[1] * height)
    expected = {"spheres": 120, "highest_point_m": size[2], "layer_height_m": height, "solid_fraction": solid}
    assert {name: packing.attributes[name] for name in expected} == pytest.approx(expected, rel=1e-9)
    assert packing.attributes["source"] == "pile.csv" and f"solid fraction {solid:.3f}" in packing.notes[-1]


def test_the_axis_against_gravity_becomes_the_height(tmp_path):
    """Whichever it is; and the longer of the other two, which is our x, becomes the length."""
    straight = POSITION - (POSITION - RADIUS[:, None]).min(axis=0)
    for names, up in (("xzy", "y"), ("yxz", "z"), ("zyx", "x"), ("yzx", "x")):
        header = ",".join(f"{name}_m" for name in names)
        (tmp_path / "turned.csv").write_text(f"{header},radius_m\n" + lines(TABLE, ","))
        packing = an.read_packing(tmp_path / "turned.csv", up=up)
        assert np.allclose(packing.position_m, straight), (names, up)
        assert f"axes {', '.join(names)} of the file became length, width, height" in packing.notes


def test_overlaps_are_measured(tmp_path):
    """Over the smaller of two radii: a tenth is taken, and from a hundredth on it is noted."""

    def read(apart):
        pair = np.array([[0, 0, 5, 5.0], [0, 0, 5 + apart, 4.0], [0, 0, 23, 4.0]])
        (tmp_path / "pair.csv").write_text("x_mm,y_mm,z_mm,radius_mm\n" + lines(pair, ","))
        return an.read_packing(tmp_path / "pair.csv")

    for overlap, words in ((0.396, "spheres 1 and 2 by 9.9 %"), (0.0404, "by 1.0 %"), (0.0396, "")):
        packing = read(9.0 - overlap)
        assert packing.attributes["largest_overlap_m"] == pytest.approx(1e-3 * overlap)
        assert packing.attributes["coordination"] == pytest.approx(2 / 3)
        noted = [note for note in packing.notes if "of the smaller radius" in note]
        assert all(words in note for note in noted) and bool(noted) == bool(words)
    with pytest.raises(an.InputError, match="spheres 1 and 2 overlap by 10 %.* 1 pair by more than 1 %"):
        read(9.0 - 0.404)


@pytest.mark.parametrize(
    ("unit", "inside", "outside"), [("m", 1.01e-4, 0.99e-4), ("m", 0.0499, 0.0501), ("mm", 49.9, 50.1)]
)
def test_radii_are_those_of_aggregate(tmp_path, unit, inside, outside):
    for radius in (inside, outside):
        rows = np.array([[0, 0, 0, radius], [0, 0, 2 * radius, radius]])
        (tmp_path / "two.csv").write_text(f"x_{unit},y_{unit},z_{unit},radius_{unit}\n" + lines(rows, ","))
        if radius == inside:
            assert len(an.read_packing(tmp_path / "two.csv").radius_m) == 2
    with pytest.raises(an.InputError, match="are not those of aggregate, 0.1 to 50 mm"):
        an.read_packing(tmp_path / "two.csv")


@pytest.mark.parametrize(
    ("radius", "unit"), [(0.4, "mm or cm"), (1.9, "mm or cm"), (2.1, "mm"), (0.09, "neither")]
)
def test_a_unit_is_guessed_where_no_other_is_likely(tmp_path, radius, unit):
    """Radii of 0.1 to 2 may be sand in mm or gravel in cm."""
    rows = np.array([[0, 0, 0, radius], [0, 0, 2 * radius, radius]])
    (tmp_path / "two.csv").write_text(HEADED + lines(rows, ","))
    if unit == "mm":
        assert an.read_packing(tmp_path / "two.csv").radius_m == pytest.approx([2.1e-3] * 2)
    else:
        with pytest.raises(an.InputError, match=unit):
            an.read_packing(tmp_path / "two.csv")


def test_a_gap_wider_than_any_sphere_parts_a_packing(tmp_path):
    for wide, parts in ((9.9, False), (10.1, True)):
        rows = np.array([[5, 5, 5, 5.0], [5, 5, 15, 5.0], [5, 5, 24 + wide, 4.0]])
        (tmp_path / "apart.csv").write_text("x_mm,y_mm,z_mm,radius_mm\n" + lines(rows, ","))
        if parts:
            with pytest.raises(an.InputError, match="gap of 10.1 mm along the height parts 1 sphere from"):
                an.read_packing(tmp_path / "apart.csv")
        else:
            assert len(an.read_packing(tmp_path / "apart.csv").radius_m) == 3


MM = 1e3 * TABLE
HEADED = "x,y,z,radius\n"
FAR = np.column_stack([np.round(MM[:, :3] + 5e6, -1), MM[:, 3]])


@pytest.mark.parametrize(
    ("text", "names"),
    [
        ("", "empty"),
        (HEADED, "without spheres"),
        ("x,y,z\n1,2,3\n", "radius"),
        (f"{HEADED}1,2,3,oops\n", "sphere 1: radius = 'oops'"),
        ("x,y,z,radius,diameter\n1,2,3,4,8\n1,2,9,4,4\n", "'radius' and 'diameter' give different sizes"),
        (f"{HEADED}1,2,3,-4\n", "sphere 1 has a radius of zero or less"),
        (f"{HEADED}1,2,3,inf\n", "sphere 1 is not finite"),
        (f"{HEADED}1,2,3,400\n", "--unit"),
        ("x_mm,y_mm,z_mm,radius_m\n1,2,3,0.004\n", "different units"),
        ("x_m,y_m,z_m,radius_m\n1,2,3,0.051\n", "not those of aggregate"),
        ("1 2 3\n", "3 columns without a header"),
        ('{"law": "burgers"}', "JSON"),
        (f"{HEADED}0,0,0,4\n0,0,4,4\n", "100 %"),
        (dump(TABLE, atoms=500), "120 of 500"),
        (dump(TABLE, atoms="a few"), "120 of a few"),
        ("ITEM: TIMESTEP\n0\n", "ITEM: ATOMS"),
        ("ITEM: TIMESTEP\n0\nITEM: ATOMS id xs ys zs radius\n1 0 0 0 1\n", "scaled coordinates"),
        ("x;y;z;radius\n1,5;2,5;3,5;4,5\n", "comma"),
        (HEADED + lines(MM[:1], ","), "one sphere alone"),
        (HEADED + lines(0.1 * MM, ","), "radii from 0.2.*--unit"),
        (HEADED + lines(np.vstack([MM, [0, 0, 2000, 2.5]]), ","), "gap of 19.* mm along the height"),
        (HEADED + lines(MM * [4, 1, 1, 1], ","), "gap of .* mm along the length"),
        (HEADED + lines(MM + [1e16, 0, 0, 0], ","), "1e.13 m leave no digits for radii of 0.002"),
        (HEADED + lines(FAR, ","), "rounded"),
        (b"\x89HDF\r\n\x1a\n" + bytes(64), "asphalt-nscd trim"),
    ],
)
def test_what_is_no_packing_is_refused_with_its_file_and_place(tmp_path, text, names):
    (tmp_path / "bad.csv").write_bytes(text.encode() if isinstance(text, str) else text)
    with pytest.raises(an.InputError, match=names) as refused:
        an.read_packing(tmp_path / "bad.csv")
    assert str(tmp_path / "bad.csv") in str(refused.value)


def test_a_packing_far_from_the_origin_is_moved_and_that_is_said(tmp_path):
    (tmp_path / "far.csv").write_text("x,y,z,radius\n" + lines(TABLE + [5000, -200, 0, 0], ","))
    packing = an.read_packing(tmp_path / "far.csv")
    assert "x -5000 m, y +200 m" in " ".join(packing.notes)
    assert np.allclose(packing.position_m, POSITION - (POSITION - RADIUS[:, None]).min(axis=0), atol=2e-8)
    (tmp_path / "near.csv").write_text("x,y,z,radius\n" + lines(TABLE, ","))
    assert "moved" not in " ".join(an.read_packing(tmp_path / "near.csv").notes)
    longest = np.ptp([*(POSITION - RADIUS[:, None]), *(POSITION + RADIUS[:, None])], axis=0).max()
    for boxes, told in ((9.8, False), (10.3, True)):
        (tmp_path / "far.csv").write_text(HEADED + lines(TABLE - [0, 0, boxes * longest, 0], ","))
        assert ("moved" in " ".join(an.read_packing(tmp_path / "far.csv").notes)) == told


def test_positions_must_resolve_a_ten_thousandth_of_a_radius(tmp_path):
    """Of 2.5 mm. Neighbours among floats are 0.12 um apart beyond 10^9 m, and 0.48 um from 2^31 m on."""
    rows = "x_m,y_m,z_m,radius_m\n{0},0,0,0.0025\n{0},0,0.005,0.0025\n"
    (tmp_path / "far.csv").write_text(rows.format(1e9))
    assert len(an.read_packing(tmp_path / "far.csv").radius_m) == 2
    (tmp_path / "far.csv").write_text(rows.format(2.2e9))
    with pytest.raises(an.InputError, match="leave no digits for radii of 0.0025 m"):
        an.read_packing(tmp_path / "far.csv")


@pytest.mark.parametrize("unit", ["in", "MM", ""])
def test_a_unit_that_is_none_is_refused_in_a_sentence(tmp_path, unit):
    (path := tmp_path / "pile.csv").write_text("x,y,z,radius\n5,5,5,5\n5,5,15,5\n")
    with pytest.raises(an.InputError, match=f"unit '{unit}' is not known; give one of m, cm, mm, um"):
        an.read_packing(path, unit=unit)


def test_two_columns_may_say_the_same_size(tmp_path):
    (path := tmp_path / "both.csv").write_text("x,y,z,radius,diameter\n1,2,3,4,8\n1,2,11,4,8.001\n")
    assert an.read_packing(path, unit="mm").radius_m.tolist() == [0.004, 0.004]


def test_a_stated_unit_decides(tmp_path):
    (tmp_path / "cm.csv").write_text("x,y,z,radius\n1,2,3,0.4\n1,2,4,0.4\n")
    assert an.read_packing(tmp_path / "cm.csv", unit="cm").radius_m.tolist() == [0.004, 0.004]
    (tmp_path / "mm.csv").write_text("x_mm,y_mm,z_mm,radius_mm\n1,2,3,4\n")
    with pytest.raises(an.InputError, match="--unit m"):
        an.read_packing(tmp_path / "mm.csv", unit="m")


def test_the_public_rules_go_on_from_an_imported_packing(tmp_path):
    """Cut, bonded and bent: |E*| of the beam is that of the law, whoever poured."""
    run = CliRunner()
    (tmp_path / "pile.csv").write_text(FORMS["mm.csv"])
    deposit, beam = tmp_path / "deposit.h5", tmp_path / "beam.h5"
    wrong, said = (
        run.invoke(cli.group, ["import-packing", str(tmp_path / "pile.csv"), "--output", str(output)])
        for output in ("q.csv", deposit)
    )
    assert (wrong.exit_code, said.exit_code) == (2, 0) and ".h5" in wrong.output
    h_mm = float(said.output.partition("h_mm=")[2].partition(",")[0])  # from wall to wall, as it says
    assert -0.01 <= h_mm - 1e3 * an.read(deposit).box_m[0] <= 0.0
    shape = f"b_mm=20,B_mm=24,e_mm=22,h_mm={h_mm},mass_kg=0.03,mobile_mass_kg=0.01"
    trim = ["trim", str(deposit), "--geometry", shape, "--area", "facets", "--output", str(beam)]
    done = run.invoke(cli.group, trim, standalone_mode=False)
    assert done.exception is None, done.exception
    specimen = an.read(beam)
    assert specimen.attributes["source"] == "pile.csv" and "seed" not in specimen.attributes
    law = an.Law.burgers(Em_Pa=24.3e9, eta_m_Pa_s=3.71e9, Ek_Pa=48.4e9, eta_k_Pa_s=0.773e9, temperature_C=15)
    test = an.bend(specimen, law, 10.0, 15.0)
    assert (
        test.phase_deg == pytest.approx(test.attributes["phase_law_deg"], abs=0.3) and not test.broken_bonds
    )
