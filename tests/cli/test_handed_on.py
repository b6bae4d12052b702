"""What commands hand on to the functions behind them, which are replaced here, and what they make of the answer."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pandas as pd
import pytest
from click.testing import CliRunner, Result

from asphalt_nscd import cli
from asphalt_nscd.bending.further_settings import Cycling, Fall, FatigueLaw, Hold, Ramp
from asphalt_nscd.bending.settings import Bonds, Numerics
from asphalt_nscd.contact_problems.fclib import Outcome
from asphalt_nscd.diagnosis.settings import Draws, Known
from asphalt_nscd.diagnosis.simulation.extension import Sample
from asphalt_nscd.exports.settings import ExportSettings
from asphalt_nscd.measurements.fourpoint import T321
from asphalt_nscd.measurements.twopoint import PAPER
from asphalt_nscd.nscd.bonds.fatigue import FatigueHistory, Jumps
from asphalt_nscd.reporting.pages.assemble import Entry
from asphalt_nscd.reporting.publish import Sources
from asphalt_nscd.specimen.settings import Cutting, Pouring, Surfaces, Vibration

A, B, C, OUT = Path("a"), Path("b"), Path("c"), Path("out")
TRAPEZOID = "b_mm=25,B_mm=56,e_mm=25,h_mm=250,mass_kg=0.6,mobile_mass_kg=0.235"
GEOMETRY = {"b_mm": 25, "B_mm": 56, "e_mm": 25, "h_mm": 250, "mass_kg": 0.6, "mobile_mass_kg": 0.235}


class Replaced:
    """Functions of the package that note what they are called with, and give what they are told."""

    def __init__(self, patch: pytest.MonkeyPatch) -> None:
        self._patch, self.calls = patch, {}

    def __call__(self, **given: Any) -> None:
        """By `folder__module__name`, what each gives."""
        for name, gives in given.items():
            self.calls[name] = calls = []
            self._patch.setattr(
                "asphalt_nscd." + name.replace("__", "."),
                lambda *arguments, _calls=calls, _gives=gives, **options: (
                    _calls.append((*arguments, *options.values())) or _gives
                ),
            )

    def was_called(self, name: str) -> tuple[Any, ...]:
        (call,) = self.calls[name]
        return call


@pytest.fixture
def replaced(monkeypatch, tmp_path) -> Replaced:
    monkeypatch.chdir(tmp_path)
    return Replaced(monkeypatch)


def run(words: str, status: int = 0) -> Result:
    done = CliRunner().invoke(cli.group, words.split())
    assert done.exit_code == status, (done.output, done.exception)
    return done


PLAIN = {
    "chain-law a --temperature-c 15 --lowest-hz 1 --highest-hz 40 --output out": (
        "rheology__chain_law__chain_law", (A, 15.0, 1.0, 40.0, 1e-3, 1.0, OUT),
    ),
    f"fit a --temperature-c 15 --geometry {TRAPEZOID} --cycles 3 --output out": (
        "rheology__fitted_laws__fit_temperature", (A, 15.0, OUT, GEOMETRY, 3),
    ),
    "fit a --temperature-c -10 --output out": (
        "rheology__fitted_laws__fit_temperature", (A, -10.0, OUT, None, None),
    ),
    "published-law a --temperature-c 15 --unit kPa --output out": (
        "rheology__published_laws__published_law", (A, 15.0, "kPa", OUT),
    ),
    f"extend a --law b --measured c --geometry {TRAPEZOID} --number 2 --amplitude-m 1e-5 --test 15,10,x,y "
    "--rig-output out": (
        "diagnosis__simulation__extension__extend",
        (A, B, C, GEOMETRY, Sample(2, 1e-5, ((15.0, 10.0, Path("x,y")),)), OUT),
    ),
    "export a --format abaqus --temperatures-c 5,-10 --frequencies-hz 1,10 --output out": (
        "api__exporting__export", (A, OUT, "abaqus", ExportSettings(), (5.0, -10.0), (1.0, 10.0)),
    ),
    "reduced-specimen a --output out": ("diagnosis__simulation__simulated__reduce_model", (A, OUT)),
    "ro-crate a b --root c --workflow s --provenance p --output out": (
        "reporting__crate__write_crate", ((A, B), C, Path("s"), Path("p"), OUT),
    ),
}  # fmt: skip


@pytest.mark.parametrize("words", PLAIN)
def test_arguments_are_handed_on(replaced, words):
    name, expected = PLAIN[words]
    replaced(**{name: None})
    run(words)
    assert replaced.was_called(name) == expected


def test_pouring_and_trimming(replaced):
    still = {"weight_balance": 0.02, "unbalanced_force": 0.0}
    replaced(nscd__core_cache__is_compiled=False, specimen__preparation__deposit=still)
    more = (
        "--seed 3 --friction 0.3 --wall-friction 0.1 --rolling-friction 0.05 --restitution 0.2 --stroke-mm 4"
    )
    done = run(
        f"deposit --counts a --box-m 1,2,3 {more} --vibration-hz 20 --vibration-s 2 --time-step-s 1e-4 --output out"
    )
    assert "compiling the core" in done.stderr and "warning: the layer is not at rest" in done.stderr
    surfaces, vibration = Surfaces(0.3, 0.1, 0.2, 0.05), Vibration(4e-3, 20.0, 2.0)
    expected = A, Pouring((1.0, 2.0, 3.0), 3, surfaces, vibration, 1e-4), OUT
    assert replaced.was_called("specimen__preparation__deposit")[:3] == expected
    replaced(specimen__cutting__trim_deposit={"spheres": 1, "bonds": 20, "area": "facets"})
    geometry = "d_mm=100,h_mm=150,mass_kg=3,mobile_mass_kg=1"
    done = run(
        f"trim a --geometry {geometry} --volume-reduction 0.2 --area facets --gap-max-mm 1.5 --output out"
    )
    assert done.output == "out: 1 sphere, 20 bonds by facets\n"
    cylinder = {"d_mm": 100.0, "h_mm": 150.0, "mass_kg": 3.0, "mobile_mass_kg": 1.0}
    assert replaced.was_called("specimen__cutting__trim_deposit") == (
        A,
        cylinder,
        Cutting(0.2, "facets", 1.5),
        OUT,
    )


def test_condensing(replaced):
    replaced(bending__condensing__condense=(120, 1.23456, "paper"))
    done = run("condense a --kt-over-kn 0.5 --head blocked --stand-by 4 --excerpt-output b --output out")
    assert "out: 120 unknowns; static |E*| is 1.235 of the modulus of the bonds" in done.output
    assert "kt_over_kn = 0.5 changes nothing" in done.stderr
    bonds = Bonds("blocked", kt_over_kn=0.5)
    assert replaced.was_called("bending__condensing__condense") == (A, bonds, OUT, B, 4)


LAWFUL = "--law b --temperature-c 15 --output out"


def test_holding_pulling_and_cycling(replaced):
    """A law is asked for at the frequencies of what is done with it."""
    table = pd.DataFrame({"x": [1.0]})
    replaced(
        bending__model__read_model="model", rheology__laws_io__read_bond_law="law", files__store__write_table=None,
        bending__hold__hold=table, bending__hold__told="held so", bending__hold__doubt="in doubt",
    )  # fmt: skip
    done = run(f"hold a {LAWFUL} --duration-s 2 --steps 40 --force-n 3")
    held = Hold(2.0, 40, 3.0)
    assert (done.stdout, done.stderr) == ("out: held so\n", "warning: in doubt\n")
    assert replaced.was_called("bending__hold__hold") == ("model", "law", held)
    assert replaced.was_called("rheology__laws_io__read_bond_law") == (B, 15.0, held.band)
    assert replaced.was_called("files__store__write_table") == (OUT, table)
    replaced(
        rheology__laws_io__read_bond_law="law", bending__cycles__cycle=table, bending__cycles__told="cycled so",
        files__store__write_table=None, bending__ramp__ramp=({"t": 1}, {"c": 2}), bending__ramp__told="pulled so",
        files__store__save=None,
    )  # fmt: skip
    assert run(f"cycle a {LAWFUL} --frequency-hz 4 --no-haversine --no-drift").output == "out: cycled so\n"
    assert replaced.was_called("bending__cycles__cycle") == (
        "model",
        "law",
        4.0,
        Cycling(haversine=False, drift=False),
    )
    assert replaced.was_called("rheology__laws_io__read_bond_law") == (B, 15.0, [4.0])
    replaced(rheology__laws_io__read_bond_law="law")
    assert (
        run(f"ramp a {LAWFUL} --duration-s 2 --steps 40 --displacement-m -1e-4").output == "out: pulled so\n"
    )
    pulled = Ramp(2.0, 40, -1e-4)
    assert replaced.was_called("bending__ramp__ramp")[:3] == ("model", "law", pulled)
    assert replaced.was_called("rheology__laws_io__read_bond_law") == (B, 15.0, pulled.band)
    assert replaced.was_called("files__store__save") == (
        OUT,
        "ramp",
        {"t": 1},
        {"c": 2, "temperature_C": 15.0},
    )


def test_falling_and_tiring(replaced):
    columns = {"fragments": 2, "speed_m_s": 0.1234, "energy_J": 0.5678, "error_percent": 0.05}
    course = FatigueHistory(np.array([0.0, 2000.0]), np.array([1.0, 0.5]), np.zeros(2, int), np.ones(1))
    replaced(
        specimen__cutting__read_specimen="specimen", rheology__laws_io__read_bond_law="law", files__store__save=None,
        bending__bending_test__bond_law="chain", bending__fall__fell=({"t": 1}, columns),
        files__store__write_table=None, bending__fatigue__fatigue=course, bending__fatigue__cycle_by_cycle=course,
        bending__fatigue__table_of="table", bending__fatigue__profile_of="profile",
    )  # fmt: skip
    done = run("fall a --law b --height-mm 5 --tilt-deg 30 --yield-pa 1e6 --friction 0.1 --output out")
    assert (
        done.output
        == "out: 2 pieces, the fastest sphere moves at 0.12 m/s; of 0.568 J the account misses 0.05 %\n"
    )
    expected = "specimen", "chain", Fall(5e-3, 30.0), Bonds(yield_Pa=1e6, friction=0.1)
    assert replaced.was_called("bending__fall__fell") == expected
    assert replaced.was_called("files__store__save") == (OUT, "fall", {"t": 1}, columns)
    done = run("fatigue a --strain 2e-4 --endured 2e-3 --exponent 4 --finer 2 --profile b --output out")
    assert done.output == "out: half of the stiffness is left after 2e+03 cycles\n"
    law = FatigueLaw(2e-3, 4.0)
    assert replaced.was_called("bending__fatigue__fatigue") == (
        "specimen",
        2e-4,
        law,
        Jumps(0.05, 5e-4, 5e-3),
    )
    assert replaced.calls["files__store__write_table"] == [(OUT, "table"), (B, "profile")]
    run("fatigue a --strain 2e-4 --every-cycle b --output out")
    each = replaced.was_called("bending__fatigue__cycle_by_cycle")
    assert each == ("specimen", 2e-4, FatigueLaw(), "chain", 25.0)


MADE = {
    "temperature_C": 15.0, "frequency_Hz": 10.0, "E_MPa": 1.0, "phase_deg": 2.0, "E_law_MPa": 3.0, "phase_law_deg": 4.0,
    "broken_bonds": 0, "method": "reduced",
}  # fmt: skip


@pytest.mark.parametrize(
    ("shape", "options", "numerics"),
    [
        (PAPER, "", Numerics()),
        (T321, "", Numerics(1 / 2000.0, scheme="fitted")),
        (T321, "--method condensed", Numerics(1 / 2000.0, method="condensed", scheme="fitted")),
        (T321, "--method sweeps", Numerics(method="sweeps")),
        (T321, "--time-step-s 1e-3", Numerics(1e-3)),
        (T321, "--scheme euler", Numerics()),
        (PAPER, "--steps-per-cycle 50", Numerics(1 / 500.0, scheme="fitted")),
        (T321, "--steps-per-cycle 50 --time-step-s 1e-3", Numerics(1 / 500.0, scheme="fitted")),
    ],
)
def test_simulating_takes_the_steps_of_its_test(replaced, shape, options, numerics):
    subject = SimpleNamespace(geometry=shape)
    replaced(bending__bending_test__read_subject=subject, bending__bending_test__simulate=MADE)
    more = "--law b --temperature-c 15 --cycles 3 --frames 4 --energy --rig c --law-source s --excerpt e"
    run(f"simulate a {more} {options} --frequency-hz 10 --output out --frequency-hz 20 --output b")
    one, two = replaced.calls["bending__bending_test__simulate"]
    files, temperature, case, found, kept, model = one
    assert (files.model, files.law, files.output, files.rig, files.law_source) == (A, B, OUT, C, "s")
    assert (temperature, case.frequency, case.cycles, case.amplitude) == (
        15.0,
        10.0,
        3.0,
        shape.usual_amplitude(),
    )
    assert found == numerics and model is subject and (kept.frames, kept.energy) == (4, True)
    halved = numerics.scheme == "fitted"
    assert two[3] == (replace(numerics, time_step=numerics.time_step / 2) if halved else numerics)
    assert (two[0].output, two[2].frequency) == (B, 20.0)
    assert replaced.was_called("bending__bending_test__read_subject") == (A, Path("e"))


def test_solving_contacts_tells_what_did_not_converge(replaced):
    one, other = (Outcome(name, 2, 3, 1e-9, 2e-9, 0.5, name == "a") for name in "ab")
    replaced(contact_problems__fclib__solve_files=[one, other], files__store__write_table=None)
    done = run("fclib a b --output out", status=1)
    assert done.stdout == f"{one}\n{other}\n" and "not converged to 1e-08: b" in done.stderr
    assert replaced.was_called("contact_problems__fclib__solve_files") == ((A, B), 1e-8)
    replaced(contact_problems__fclib__solve_files=[one])
    run("fclib a --tolerance 1e-6")
    assert replaced.was_called("contact_problems__fclib__solve_files")[1] == 1e-6


def compared(mixes: int) -> SimpleNamespace:
    """What `compare` gives: A is first, B and C share two places."""
    table = pd.DataFrame({
        "mix": ["A", "B", "C", "D"], "rank_low": [1, 2, 2, 4], "rank_high": [1, 3, 3, 4], "E_MPa": 9000.4,
        "E_low_MPa": 8000.0, "E_high_MPa": 10000.0, "causes": ["delay", "", "delay", ""],
        "possible_causes": ["", "clamp", "clamp", ""],
    })[:mixes]  # fmt: skip
    difference = {
        "temperature_C": 20.0,
        "frequency_Hz": 10.0,
        "mix": "A",
        "than": "B",
        "stiffer_percent": 12.4,
    }
    difference |= {"stiffer_low_percent": -1.0, "stiffer_high_percent": 20.0}
    rows = [difference | {"told_apart": True}, difference | {"told_apart": False, "than": "C"}]
    return SimpleNamespace(
        table=table, differences=pd.DataFrame(rows), same_machine=lambda draws: f"machine by {draws.number}",
        write=lambda output, machine: [f"{output}.html", str(machine)],
    )  # fmt: skip


def test_comparing(replaced):
    replaced(api__comparison__compare=compared(3))
    done = run("compare a b --measured-in bending --law cam --draws 500 --same-machine --output out")
    lines = done.output.splitlines()
    star = "|E*|(15 degC, 10 Hz) = 9000 MPa (8000 to 10000)"
    assert lines[:3] == [
        f"     1  A: {star}; delay", f"   2-3  B: {star}; possible: clamp",
        f"   2-3  C: {star}; delay; possible: clamp",
    ]  # fmt: skip
    assert lines[3] == "At 20 degC, 10 Hz A has +12 % (-1 to +20) of |E*| over B." and lines[4] == ""
    assert lines[5] == "machine by 500" and lines[7].startswith(
        "Written to out: out.html, machine by 500, and a"
    )
    mixes, *options, _ = replaced.was_called("api__comparison__compare")
    assert (mixes, *options) == ((A, B), "bending", "cam", Draws(500))
    replaced(api__comparison__compare=compared(4), api__tables__campaign_in="campaign")
    done = run("compare a b --sheet s --only-mix m --output out")
    assert "no cause named" in done.output and "At 20 degC" not in done.output and "None" in done.output
    assert replaced.was_called("api__comparison__compare")[0] == {"s": "campaign", "m": "campaign", "b": B}
    assert replaced.calls["api__tables__campaign_in"] == [(A, "s"), (A, "m")]


class Diagnosed:
    """A diagnosis that counts how often its limits were verified."""

    details, verified = "in detail", ()
    outcome = SimpleNamespace(write=lambda folder: ["diagnosis.json"])

    def verify_limits(self, jobs, progress):
        self.verified = (*self.verified, jobs)
        return self

    def __str__(self):
        return "in short"


def test_diagnosing(replaced):
    found, campaign = Diagnosed(), SimpleNamespace(stated={"mix": "of the file", "operator": "of the file"})
    replaced(
        api__tables__campaign_in=campaign, diagnosis__record__stiffness_only__has_no_phase=False,
        api__diagnosis__diagnose=found, api__written__write_all=["a.json", "diagnosis.html"],
    )  # fmt: skip
    scatter = "--modulus-scatter-percent 2 --phase-scatter-deg 0.5"
    done = run(
        f"diagnose a b --sheet s --column E_GPa=x --measured-in bending {scatter} --mix mine --output out"
    )
    assert done.output == (
        "in short\n\nWritten to out: a.json, diagnosis.html.\n"
        "For the reasons and figures, open out/diagnosis.html in a browser.\n"
    )
    assert replaced.was_called("api__tables__campaign_in") == ((A, B), "s", {"E_GPa": "x"}, "bending", None)
    given, geometry, known, *_ = replaced.was_called("api__diagnosis__diagnose")
    assert given is campaign and geometry == GEOMETRY and known == Known(scatter=(2.0, 0.5))
    outcome, folder, title, heading = replaced.was_called("api__written__write_all")
    assert (folder, title, outcome) == (OUT, "Diagnosis of a, b", found.outcome)
    assert (heading.mix, heading.operator) == ("mine", "of the file")
    done = run("diagnose a --no-page --details --verify-limits --jobs 2 --output out")
    assert done.output == "in detail\n\nWritten to out: diagnosis.json.\n" and found.verified == (2,)
    for words, sentence in (
        ("--modulus-scatter-percent 2", "together"), ("--phase-scatter-deg 2", "together"),
        ("--facets a", "--facets needs --simulations"),
    ):  # fmt: skip
        assert sentence in run(f"diagnose a {words} --output out", status=2).output


def test_diagnosing_tests_without_a_phase(replaced):
    curve = SimpleNamespace(write=lambda folder: ["curve.csv"], rows="rows")
    replaced(
        api__tables__campaign_in=SimpleNamespace(stated={}), diagnosis__record__stiffness_only__has_no_phase=True,
        diagnosis__record__stiffness_only__fit_stiffness=curve, reporting__pages__stiffness_page__write_page=C,
    )  # fmt: skip
    assert "Written to out: curve.csv, c." in run("diagnose a --output out").output
    expected = OUT, "Diagnosis of a", "rows"
    assert replaced.was_called("reporting__pages__stiffness_page__write_page") == expected
    assert "Written to out: curve.csv." in run("diagnose a --no-page --output out").output
    assert "--law is fitted to |E*| and phase" in run("diagnose a --law cam --output out", status=2).output


def test_importing_a_packing_tells_a_height_that_fits_the_box(replaced):
    Path("two.csv").write_text("x_mm,y_mm,z_mm,radius_mm\n0,0,0,3\n6.00999,0,0,3\n")
    done = run("import-packing two.csv --output out.h5")
    assert "--geometry h_mm=12," in done.output and "lengths in mm, as the file says" in done.output
    Path("two.csv").write_text("x,y,z,radius\n0,0,0,3\n0,0,6.019,3\n")
    assert "--geometry h_mm=12.01," in run("import-packing two.csv --unit mm --up x --output out.h5").output


def test_pages_reports_and_published_files(replaced, monkeypatch):
    replaced(
        reporting__pages__style__page="<p>", reporting__pages__assemble__assemble="whole",
        reporting__publish__fill_blocks=None, reporting__publish__publish=None,
    )  # fmt: skip
    monkeypatch.setattr("asphalt_nscd.reporting.pages.first_page.first_page", lambda: "first")
    run("page a b --title one --title two --output x --output y")
    assert replaced.calls["reporting__pages__style__page"] == [(A, "one"), (B, "two")]
    assert Path("x").read_text() == Path("y").read_text() == "<p>"
    assert (
        "give each table a --title and an --output"
        in run("page a b --title t --output x --output y", 2).output
    )
    words = "--entry part=f/b.png --entry other=c --source b=a --source x=c --caption k.rst --output o/report.html"
    run(f"report --study mine {words}")
    shown = [Entry("part", Path("f/b.png"), [A]), Entry("other", C, [])]
    expected = "mine", "first", shown, (Path("k.rst"),), Path("o")
    assert replaced.was_called("reporting__pages__assemble__assemble") == expected
    assert Path("o/report.html").read_text() == "whole"
    run("publish a b --root c --document d --block t=a --name n --module m --source s --output out")
    assert replaced.was_called("reporting__publish__fill_blocks") == ((Path("d"),), {"t": A})
    sources = Sources(("m",), ("s",))
    assert replaced.was_called("reporting__publish__publish") == ((A, B), C, OUT, "n", sources)
    run("publish a --root c --output out")
    assert replaced.calls["reporting__publish__publish"][1] == ((A,), C, OUT, "", None)


def test_reducing_and_reconstructing(replaced):
    replaced(measurements__reduction__reduce_table="table", measurements__signs__negative_phases="a note",
             rheology__reconstruct__reconstruct_table=None)  # fmt: skip
    assert run(f"reduce a --geometry {TRAPEZOID} --output out").stderr == "a note\n"
    assert replaced.was_called("measurements__reduction__reduce_table") == (A, GEOMETRY, OUT, None)
    run(f"reconstruct a --geometry {TRAPEZOID} --seed 4 --frequencies-hz 3,10 --law-output b --output out")
    table, geometry, output, sampling, law = replaced.was_called("rheology__reconstruct__reconstruct_table")
    assert (table, geometry, output, law) == (A, GEOMETRY, OUT, B)
    assert (sampling.seed, tuple(sampling.frequencies)) == (4, (3.0, 10.0))


def test_timings(replaced):
    replaced(reporting__timings__rule_times="table", reporting__timings__elapsed=7.0,
             reporting__timings__timing_summary="text", files__store__write_table=None)  # fmt: skip
    run("timings a b --folder c --markdown m.md --output out")
    assert replaced.was_called("reporting__timings__rule_times") == ((A, B), C)
    assert replaced.was_called("reporting__timings__timing_summary") == ("table", 7.0)
    assert replaced.was_called("files__store__write_table") == (OUT, "table")
    assert Path("m.md").read_text() == "text"


def test_provenance_and_new_studies(replaced):
    replaced(
        files__store__provenance={"commit": "x"}, files__store__made_by={"part": "y"}, files__store__write_json=None,
        files__store__read_json={"key": 1}, table_import__write__new_study=("config/mine.yaml", ["read so"]),
    )  # fmt: skip
    run("provenance a --folder b --output out")
    whole = {"commit": "x", "made_by": {"part": "y"}, "study": {"key": 1}}
    run("provenance --output out")
    assert replaced.calls["files__store__write_json"] == [(OUT, whole), (OUT, {"commit": "x"})]
    words = f"--sheet s --column E_GPa=x --geometry {TRAPEZOID} --measured-in bending --grading b --small"
    done = run(f"new-study mine --measurements a {words}")
    assert done.output.startswith("read so\nwrote config/mine.yaml; run: snakemake")
    name, tables, options = replaced.was_called("table_import__write__new_study")
    assert (name, tables, options.geometry, options.grading) == ("mine", (A,), GEOMETRY, B)
    assert (options.measured_in, options.small, options.sheet, options.columns) == (
        "bending",
        True,
        "s",
        {"E_GPa": "x"},
    )


def test_serving_this_machine_alone(monkeypatch):
    """On a free port; the page is opened unless it shall not be, and what was dropped is removed in the end."""
    done: list[Any] = []
    desks = SimpleNamespace(folder="folder", close=lambda: done.append("closed"))
    app = SimpleNamespace(config={"TOKEN": "secret", "DESKS": desks})
    janitor = SimpleNamespace(communicate=lambda: done.append("gone"))
    server = SimpleNamespace(server_port=5001, serve_forever=lambda: done.append("served"))
    monkeypatch.setattr("asphalt_nscd.web.app.create_app", lambda: app)
    monkeypatch.setattr("asphalt_nscd.web.janitor.watch", lambda folder: done.append(folder) or janitor)
    monkeypatch.setattr("werkzeug.serving.make_server", lambda *given, **more: done.append(given) or server)
    monkeypatch.setattr("webbrowser.open", done.append)
    monkeypatch.setattr("signal.signal", lambda *given: None)
    address = "http://127.0.0.1:5001/secret/"
    assert f"Drop measurements on {address}\n" in run("serve").output
    assert done == [("127.0.0.1", 0, app), "folder", address, "served", "closed", "gone"]
    done.clear()
    run("serve --port 8000 --no-browser")
    assert done == [("127.0.0.1", 8000, app), "folder", "served", "closed", "gone"]
