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
from asphalt_nscd.diagnosis.words.facts import by_isotherm
from asphalt_nscd.diagnosis.words.sentences import numbers
from asphalt_nscd.diagnosis.written import read_diagnosis, read_residuals
from asphalt_nscd.files.store import atomic_path
from asphalt_nscd.measurements.kinds import TEST_TYPES
from asphalt_nscd.reporting.figures import fig_master, panels, style
from asphalt_nscd.reporting.figures.numbers import celsius
from asphalt_nscd.reporting.figures.save import figure_bytes
from asphalt_nscd.reporting.pages.diagnosis_page import law
from asphalt_nscd.reporting.pages.style import typeset
from asphalt_nscd.reporting.settings import Heading

PDF = "report.pdf"
FONT = "DejaVu"
SIZE = 9.0  # points
PALE = (238, 240, 243)
# Rows of the answer that a client reads; the others tell the laboratory what to do next.
FINDINGS = ("Data", "Fault", "Possible fault", "Effect", "Possible effect", "Scatter", "Law", "Unexplained")
DOUBTS = ("Check first",)  # what was left out is a table
AT_COMMAND_LINE = ("--", ".csv")  # what no client has


class _Report(FPDF):
    """Pages with the title at their head and their number at their foot."""

    def __init__(self, title: str, made_by: str) -> None:
        super().__init__(format="A4")
        self.title_text, self.made_by = title, made_by
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
        if self.get_y() > self.eph - 25.0:
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
    pdf.rows(_about(content, heading), (1.0, 3.0), first_row_as_headings=False)
    pdf.heading("Result")
    pdf.set_font(FONT, "B", 10.5)
    pdf.text_block(typeset(Words(content)("value")[0]))
    pdf.set_font(FONT, size=SIZE)
    pdf.text_block(
        "In brackets: 95 % intervals. Points: tests as measured. Values: the mix; certain faults are taken off, "
        "possible ones by their probability. Line and band: the law below, which has few parameters."
    )
    pdf.picture(*_pictures(folder, content))
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
    doubts = _findings(content, DOUBTS)
    if doubts:
        pdf.rows(doubts, (1.0, 4.0), first_row_as_headings=False)
    _law(pdf, content)
    with atomic_path(folder / PDF) as path:
        pdf.output(str(path))
    return folder / PDF


def _about(content: Mapping[str, Any], heading: Heading) -> list[tuple[str, str]]:
    """Names and values of what was tested, by whom and how; what is not stated is left out."""
    reading = content["reading"]
    kind = TEST_TYPES.get(reading["test_type"], "not stated")
    said = {name: getattr(heading, name) for name in ("project", "mix", "operator", "date", "standard")}
    temperatures = ", ".join(f"{at:g}" for at in reading["isotherms_C"])
    tested = {
        "kind of test": kind[:1].upper() + kind[1:],
        "specimens": ", ".join(reading["specimens"]),
        "temperatures": f"{temperatures} degC",
        "tests": str(content["tests"] + content["trust"]["not_used"]),
    }
    return [(name.capitalize(), text) for name, text in (said | tested).items() if text]


@style.journal
def _pictures(folder: Path, content: Mapping[str, Any]) -> list[Any]:
    """Master curves of |E*| and phase."""
    tests = read_residuals([folder / "residuals.csv"])
    curve = [path for path in [folder / "master_curve.csv"] if path.is_file()]
    master = fig_master.master(tests, tests, content, curve)
    figures = []
    for quantity in panels.QUANTITIES:
        figure, axes = style.new_figure(86.0, 74.0)
        master.panel(axes, quantity)
        style.isotherm_legends(figure, master.keys("test"), master.isotherms)
        figures.append(figure)
    return figures


def _grid(pdf: _Report, table: pd.DataFrame) -> None:
    """Moduli with intervals, a row for each frequency; a star where no test was made near."""
    table = table.assign(cell=[_interval(row) for row in table.itertuples()])
    cells = table.pivot(index="frequency_Hz", columns="temperature_C", values="cell").fillna("")
    lines = [[f"{f:g}", *cells.loc[f]] for f in cells.index[::-1]]
    pdf.set_font(FONT, size=7.0)
    look = {"text_align": "CENTER", "line_height": 3.6, "padding": 0.0}
    pdf.rows([["Hz", *map(celsius, cells)], *lines], (0.6, *[1.4] * cells.shape[1]), **look)
    pdf.set_font(FONT, size=SIZE)
    if not table["within_the_tests"].all():
        pdf.text_block("*: no test was made near it; by the law of the mix with its band.")


def _interval(row: Any) -> str:
    if pd.isna(row.E_MPa):
        return "not known"
    modulus = (
        f"{row.E_MPa:.0f}{' *' * (not row.within_the_tests)}\n{row.E_low_MPa:.0f} to {row.E_high_MPa:.0f}"
    )
    return f"{modulus}\n{row.phase_deg:.1f} deg ({row.phase_low_deg:.1f} to {row.phase_high_deg:.1f})"


def _findings(content: Mapping[str, Any], wanted: Sequence[str]) -> list[tuple[str, str]]:
    """Of the answer the rows with a label of `wanted`, as they are printed."""
    kept = [
        (label, [one for one in said if not any(word in one for word in AT_COMMAND_LINE)])
        for label, said in Words(content).rows()
        if label in wanted
    ]
    return [(label, " ".join(said).replace("law.json", "the law")) for label, said in kept if said]


def _left_out(pdf: _Report, content: Mapping[str, Any]) -> None:
    """Tests that are not simply used, and why."""
    lines = [
        (specimen, celsius(at), numbers(hertz), status, "; ".join(reasons))
        for status in (LEFT_OUT, HELD_BACK, DOUBTFUL)
        for specimen, at, reasons, hertz in by_isotherm(
            [one for one in content["suspect_tests"] if one["status"] == status]
        )
    ]
    if lines:
        pdf.rows([("Specimen", "Temperature", "Hz", "Status", "Why"), *lines], (1.1, 1.3, 1.0, 1.0, 4.0))
    else:
        pdf.text_block(f"No test was left out: all {content['tests']} were used.")


def _law(pdf: _Report, content: Mapping[str, Any]) -> None:
    found = law(content)
    if found is None:
        return
    pdf.heading(f"Law of the mix: {found['title']}")
    head = ("Parameter", "Value", "95 % interval", "Unit", "Determined by these tests")
    pdf.rows([head, *found["parameters"]], (1.2, 1.0, 1.6, 1.0, 1.6))
