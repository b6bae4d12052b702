"""report.pdf, to hand on: what was tested, the moduli with their intervals, pictures, and what was left out and why."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from datetime import UTC, datetime
from io import BytesIO
from pathlib import Path
from typing import Any

import matplotlib
import pandas as pd
from fpdf import FPDF
from fpdf.fonts import FontFace

from asphalt_nscd.diagnosis.content.doubts import DOUBTFUL, HELD_BACK, LEFT_OUT
from asphalt_nscd.diagnosis.record.reported import R_84, TESTS
from asphalt_nscd.diagnosis.words.answer import Words
from asphalt_nscd.diagnosis.words.facts import grouped_tests
from asphalt_nscd.diagnosis.words.sentences import band
from asphalt_nscd.diagnosis.written import read_diagnosis, read_residuals
from asphalt_nscd.files.store import atomic_path
from asphalt_nscd.files.words import capital, joined, numbers
from asphalt_nscd.measurements.further_kinds import ALL_KINDS
from asphalt_nscd.reporting.figures import fig_master, panels, style
from asphalt_nscd.reporting.figures.numbers import celsius
from asphalt_nscd.reporting.figures.save import figure_bytes
from asphalt_nscd.reporting.pages.charts import every_test
from asphalt_nscd.reporting.pages.diagnosis_page import law
from asphalt_nscd.reporting.pages.style import typeset
from asphalt_nscd.reporting.settings import Heading

PDF = "report.pdf"
FONT = "DejaVu"
SIZE = 9.0  # points
PALE = (238, 240, 243)
# Rows of the answer that a client reads; the others tell the laboratory what to do next.
FINDINGS = ("Data", "Fault", "Possible fault", "Effect", "Possible effect", "Scatter", "Law", "Unexplained")
FOR_THE_LABORATORY = ("--", ".csv", "can be used now")  # sentences that tell it what to do
ROOM = "\N{NO-BREAK SPACE}\n" * 2  # for a name by hand
ABREAST = 6  # specimens
MARKS = {DOUBTFUL: " ?", HELD_BACK: " ??", LEFT_OUT: " X"}  # behind the result of a test


class _Report(FPDF):
    """Pages with the title at their head and their number at their foot."""

    def __init__(self, title: str, made_by: str) -> None:
        super().__init__(format="A4")
        self.made_by = made_by
        folder = Path(matplotlib.get_data_path(), "fonts", "ttf")
        for look, name in {"": "DejaVuSans", "B": "DejaVuSans-Bold", "I": "DejaVuSans-Oblique"}.items():
            self.add_font(FONT, look, folder / f"{name}.ttf")
        self.set_font(FONT, size=SIZE)
        self.set_margins(20.0, 18.0, 20.0)
        self.set_auto_page_break(True, 20.0)
        # Without the time of day, so that the same diagnosis gives the same file.
        self.set_creation_date(datetime(2000, 1, 1, tzinfo=UTC))
        self.set_title(title)
        self.set_creator("asphalt-nscd")

    def footer(self) -> None:
        """The programme and the number of the page."""
        self.set_y(-14.0)
        self.set_font(FONT, size=7.0)
        self.cell(0, 4, self.made_by)
        self.cell(0, 4, f"{self.page_no()} of {{nb}}", align="R")
        self.set_font(FONT, size=SIZE)

    def heading(self, text: str, size: float = 11.0) -> None:
        """A heading, never alone at the foot of a page."""
        if self.get_y() > self.eph + self.t_margin - 30.0:
            self.add_page()
        self.ln(3.0)
        self.set_font(FONT, "B", size)
        self.multi_cell(0, 0.5 * size, text, new_x="LMARGIN", new_y="NEXT")
        self.set_font(FONT, size=SIZE)
        self.ln(1.0)

    def text_block(self, text: str) -> None:
        """A paragraph."""
        self.multi_cell(0, 4.4, text, new_x="LMARGIN", new_y="NEXT")
        self.ln(0.8)

    def rows(self, cells: Iterable[Sequence[str]], widths: Sequence[float], **options: Any) -> None:
        """A table, its first row a heading unless `first_row_as_headings` is False; widths in shares."""
        look = {
            "line_height": 4.6,
            "borders_layout": "HORIZONTAL_LINES",
            "padding": 0.6,
            "text_align": "LEFT",
        }
        look["headings_style"] = FontFace(emphasis="BOLD", fill_color=PALE)
        with self.table(col_widths=tuple(widths), **look | options) as table:
            for line in cells:
                table.row([typeset(cell) for cell in line])

    def picture(self, *figures: Any) -> None:
        """Figures side by side over the width of the page."""
        width = self.epw / len(figures)
        pictures = [BytesIO(figure_bytes(figure, "png")) for figure in figures]
        height = max(width * f.get_figheight() / f.get_figwidth() for f in figures)
        if self.get_y() + height > self.eph + self.t_margin:
            self.add_page()
        top = self.get_y()
        for n, picture in enumerate(pictures):
            self.image(picture, x=self.l_margin + n * width, y=top, w=width - 2.0)
        self.set_y(top + height)


def write_handout(folder: Path, title: str, heading: Heading = Heading()) -> Path:  # noqa: B008  frozen
    """Write report.pdf from the files of a diagnosis; `heading` holds what the laboratory states of it."""
    content = read_diagnosis([folder / "diagnosis.json"])
    made = content["provenance"]
    by = f"asphalt-nscd, commit {made['git_commit'][:10]}, tests from {made['measurements']}"
    pdf = _Report(heading.mix or title, by)
    pdf.add_page()
    pdf.heading("Complex modulus of an asphalt mix", 15.0)
    pdf.rows(_tested(content, heading), (1.0, 3.0), first_row_as_headings=False)
    pdf.heading("Result")
    pdf.set_font(FONT, "B", 10.5)
    pdf.text_block(typeset(Words(content)("value")[0]))
    pdf.set_font(FONT, size=SIZE)
    master = _master(folder, content)
    pdf.text_block(f"{_explained(master)}{_resting_on(content['trust'])}")
    pdf.picture(*_pictures(master))
    reported = pd.read_csv(folder / "reported.csv")
    axial = content["reading"]["test_type"] == "tension-compression"
    for asked_by, where in {TESTS: "where tests were made", R_84: f"for {R_84}"}.items():
        if asked_by == TESTS or axial:
            pdf.heading(f"|E*| in MPa and phase in ° {where}")
            _grid(pdf, reported[reported["asked_by"] == asked_by])
    pdf.heading("What was found")
    pdf.rows(_findings(content, FINDINGS), (1.0, 4.0), first_row_as_headings=False)
    pdf.heading("What was left out or is in doubt, and why")
    _left_out(pdf, content)
    _law(pdf, content)
    _each_specimen(pdf, folder)
    pdf.heading("Signed")
    pdf.rows([("Date", "Name", "Signature"), (ROOM, "", "")], (1.0, 2.0, 2.0))
    with atomic_path(folder / PDF) as path:
        pdf.output(str(path))
    return folder / PDF


def _tested(content: Mapping[str, Any], heading: Heading) -> list[tuple[str, str]]:
    """Names and values of what was tested, by whom and how; what is not stated is left out."""
    reading, voids = content["reading"], content["scatter"]["air_voids"]
    kind = ALL_KINDS.get(reading["test_type"], "not stated")
    temperatures = ", ".join(f"{at:g}" for at in reading["isotherms_C"])
    tested = {
        "kind of test": kind[:1].upper() + kind[1:],
        "specimens": ", ".join(reading["specimens"]),
        "air voids": "{lowest_percent:g} to {highest_percent:g} %".format(**voids) if voids else "",
        "temperatures": f"{temperatures} degC",
        "tests": str(content["tests"] + content["trust"]["not_used"]),
    }
    return [(name.capitalize(), text) for name, text in (vars(heading) | tested).items() if text]


def _resting_on(trust: Mapping[str, Any]) -> str:
    """A sentence on how many tests, and how many doubtful ones, the values rest; empty where none is doubtful."""
    doubtful = trust["check"] - trust["held_back"]
    return f" They rest on {trust['use'] + doubtful} tests, {doubtful} of them doubtful." if doubtful else ""


def _explained(master: fig_master.Master) -> str:
    """Sentences on what line, band and points of the pictures are."""
    law = " Dashed: the law below, of few parameters, for other programs." * (master.law is not None)
    return (
        "In brackets: 95 % intervals. The line and its band are the mix, of which all values below are: certain faults "
        f"are taken off, possible ones by their probability. Points: {master.points}.{law}"
    )


def _master(folder: Path, content: Mapping[str, Any]) -> fig_master.Master:
    """Every test and the curves."""
    tests, used = every_test([folder / "causality.csv"], content), read_residuals([folder / "residuals.csv"])
    return fig_master.master(tests, used, content, [folder / "master_curve.csv"], [folder / "corrected.csv"])


@style.journal
def _pictures(master: fig_master.Master) -> list[Any]:
    """Master curves of |E*| and phase."""
    figures = []
    for quantity in panels.QUANTITIES:
        figure, axes = style.new_figure(86.0, 62.0)
        master.panel(axes, quantity)
        panels.isotherm_legends(figure, master.keys("test"), master.isotherms)
        figures.append(figure)
    return figures


def _grid(pdf: _Report, table: pd.DataFrame) -> None:
    """Moduli with intervals, a row for each frequency; a star where no test was made near."""
    table = table.assign(cell=[_interval(row) for row in table.itertuples()])
    cells = table.pivot(index="frequency_Hz", columns="temperature_C", values="cell").fillna("")
    lines = [[f"{f:g}", *cells.loc[f]] for f in cells.index[::-1]]
    pdf.set_font(FONT, size=7.0 * min(1.0, 5.5 / cells.shape[1]))  # an interval in one line
    look = {"text_align": "CENTER", "line_height": 3.6, "padding": 0.0}
    pdf.rows([["Hz", *map(celsius, cells)], *lines], (0.6, *[1.4] * cells.shape[1]), **look)
    pdf.set_font(FONT, size=SIZE)
    if not table["within_the_tests"].all():
        pdf.text_block("*: no test was made near it; by the law of few parameters, with its band.")


def _interval(row: Any) -> str:
    """Cell of |E*| and phase with their intervals; a star where no test was made near."""
    if pd.isna(row.E_MPa):
        return "not known"
    modulus = (
        f"{row.E_MPa:.0f}{' *' * (not row.within_the_tests)}\n{row.E_low_MPa:.0f} to {row.E_high_MPa:.0f}"
    )
    return f"{modulus}\n{row.phase_deg:.1f} deg ({row.phase_low_deg:.1f} to {row.phase_high_deg:.1f})"


def _findings(content: Mapping[str, Any], wanted: Sequence[str]) -> list[tuple[str, str]]:
    """Rows of the answer with a label of `wanted`, without sentences that are for the laboratory alone."""
    kept = [
        (label, [one for one in said if not any(word in one for word in FOR_THE_LABORATORY)])
        for label, said in Words(content).rows()
        if label in wanted
    ]
    return [(label, capital(" ".join(said).replace("law.json", "the law"))) for label, said in kept if said]


def _left_out(pdf: _Report, content: Mapping[str, Any]) -> None:
    """Tests that are not simply used, and why; specimens and then isotherms with the same reasons in one line."""
    alike: dict[tuple[str, str, str, str], list[float]] = {}
    for status in (LEFT_OUT, HELD_BACK, DOUBTFUL):
        own = [one for one in content["suspect_tests"] if one["status"] == status]
        of_isotherm: dict[tuple[Any, ...], list[str]] = {}
        for specimen, at, reasons, hertz in grouped_tests(own):
            of_isotherm.setdefault((at, band(hertz), "; ".join(reasons)), []).append(specimen)
        for (at, hertz, why), specimens in of_isotherm.items():
            alike.setdefault((joined(specimens), hertz, status, why), []).append(at)
    lines = [
        (specimens, f"{numbers(at)} degC", hertz, status, why)
        for (specimens, hertz, status, why), at in alike.items()
    ]
    if lines:
        pdf.rows(
            [("Specimen", "Temperature", "Frequency", "Status", "Why"), *lines], (1.1, 1.4, 1.4, 0.9, 3.8)
        )
    else:
        pdf.text_block(f"No test was left out: all {content['tests']} were used.")


def _each_specimen(pdf: _Report, folder: Path) -> None:
    """|E*| and phase of each specimen as recorded, a mark behind what is not simply used."""
    tests = pd.read_csv(folder / "corrected.csv", dtype={"specimen": str})
    cells = [
        f"{row.recorded_E_MPa:.0f}  {row.recorded_phase_deg:.1f} deg{MARKS.get(row.status, '')}"
        for row in tests.itertuples()
    ]
    keys = ["nominal_temperature_C", "frequency_Hz"]
    grid = (
        tests.assign(cell=cells)
        .pivot_table("cell", keys, "specimen", aggfunc="; ".join, sort=False)
        .fillna("")
    )
    pdf.heading("Each specimen as measured: |E*| in MPa and phase in °")
    pdf.set_font(FONT, size=7.0)
    for first in range(0, grid.shape[1], ABREAST):
        own = grid.iloc[:, first : first + ABREAST].sort_index(ascending=[True, False])
        lines = [
            (celsius(at), f"{hertz:g}", *row)
            for (at, hertz), row in zip(own.index, own.to_numpy(), strict=True)
        ]
        look = {"text_align": "CENTER", "line_height": 3.6, "padding": 0.3}
        pdf.rows([("", "Hz", *own), *lines], (0.7, 0.6, *[1.4] * own.shape[1]), **look)
        pdf.ln(2.0)
    pdf.set_font(FONT, size=SIZE)
    kinds = [
        f"{mark.strip()} {status}" for status, mark in MARKS.items() if (tests["status"] == status).any()
    ]
    if kinds:
        pdf.text_block(f"{joined(kinds)}.")


def _law(pdf: _Report, content: Mapping[str, Any]) -> None:
    """Write the law of the mix with its parameters, if one was fitted."""
    found = law(content)
    if found is None:
        return
    pdf.heading(f"Law of the mix: {found['title']}")
    head = ("Parameter", "Value", "95 % interval", "Unit", "Determined by these tests")
    pdf.rows([head, *found["parameters"]], (1.2, 1.0, 1.6, 1.0, 1.6))
