"""Charts of a workbook, drawn by the program that opens it from the cells of its sheets."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from openpyxl import Workbook
from openpyxl.chart import Reference, ScatterChart, Series
from openpyxl.worksheet.properties import PageSetupProperties
from openpyxl.worksheet.worksheet import Worksheet

WIDE, HIGH = 16.5, 9.5  # cm
ROWS = 20  # of the sheet that a chart covers
COLOURS = ("1F4E79", "C0504D", "9BBB59", "8064A2", "F79646", "4BACC6", "7F7F7F", "B8860B")


@dataclass(frozen=True)
class Line:
    """A line of a chart: the column of a sheet with heading `y` over the one with heading `x`.

    `name` stands in the legend; `rows` are first and last, from 1, None for all below the heading; `points` draws marks
    alone; `dashed` marks the end of an interval.
    """

    name: str
    sheet: str
    x: str
    y: str
    rows: tuple[int, int] | None = None
    points: bool = False
    dashed: bool = False


@dataclass(frozen=True)
class Plot:
    """Lines over common axes, with titles `x` and `y`."""

    title: str
    x: str
    y: str
    lines: Sequence[Line]
    log_x: bool = True
    log_y: bool = False


def draw(book: Workbook, plots: Sequence[Plot]) -> None:
    """Add a sheet with charts, below each other; a line whose sheet or column is absent is left out."""
    sheet = book.create_sheet("Charts")
    for number, plot in enumerate(plots):
        chart = ScatterChart()
        chart.title, chart.style, chart.width, chart.height = plot.title, 2, WIDE, HIGH
        for axis, title, log in ((chart.x_axis, plot.x, plot.log_x), (chart.y_axis, plot.y, plot.log_y)):
            # Said, because openpyxl 3.1 leaves it open and Excel then draws no axis.
            axis.title, axis.delete = title, False
            axis.number_format = "General"
            # Else the axes cross at 1 of a logarithmic scale, in the middle of the curves.
            axis.crosses = "min"
            if log:
                axis.scaling.logBase = 10
        chart.legend.position = "b"
        drawn: dict[str, str] = {}  # colour of each name without its interval
        for line in plot.lines:
            series = _series(book, line, drawn)
            if series is not None:
                chart.series.append(series)
        sheet.add_chart(chart, f"A{1 + number * ROWS}")
    fit_to_page(sheet)
    sheet.page_setup.fitToHeight = 1


def fit_to_page(sheet: Worksheet, landscape: bool = False) -> None:
    """Print all columns within the width of an A4 page."""
    sheet.sheet_properties.pageSetUpPr = PageSetupProperties(fitToPage=True)
    sheet.page_setup.paperSize = sheet.PAPERSIZE_A4
    sheet.page_setup.orientation = "landscape" if landscape else "portrait"
    # A height of 0 pages: as many as the rows take.
    sheet.page_setup.fitToWidth, sheet.page_setup.fitToHeight = 1, 0


def _series(book: Workbook, line: Line, drawn: dict[str, str]) -> Series | None:
    if line.sheet not in book.sheetnames:
        return None
    sheet: Worksheet = book[line.sheet]
    heads = [cell.value for cell in sheet[1]]
    if line.x not in heads or line.y not in heads:
        return None
    first, last = line.rows or (2, sheet.max_row)
    x, y = (
        Reference(sheet, min_col=heads.index(name) + 1, min_row=first, max_row=last)
        for name in (line.x, line.y)
    )
    series = Series(y, x, title=line.name)
    owner = line.name.split(",")[0]
    colour = drawn.setdefault(owner, COLOURS[len(drawn) % len(COLOURS)])
    # Said, because openpyxl leaves it open, and a smoothed line overshoots the data.
    series.smooth = False
    again = (list(drawn).index(owner) // len(COLOURS)) % 2 == 1  # a colour that comes a second time
    look = series.graphicalProperties.line
    if line.points:
        series.marker.symbol, series.marker.size = "circle", 5
        series.marker.graphicalProperties.solidFill = colour
        series.marker.graphicalProperties.line.solidFill = colour
        look.noFill = True
    else:
        series.marker.symbol = "none"
        look.solidFill, look.width = colour, 9525 if line.dashed else 19050  # EMU
        if line.dashed or again:
            look.dashStyle = "dash" if line.dashed else "lgDashDot"
    return series


def bands(name: str, sheet: str, x: str, columns: tuple[str, str, str]) -> list[Line]:
    """Lines of an estimate and both ends of its 95 % interval, by their three headings `columns`, over heading `x`."""
    value, low, high = columns
    return [
        Line(name, sheet, x, value),
        Line(f"{name}, 95 % from", sheet, x, low, dashed=True),
        Line(f"{name}, 95 % to", sheet, x, high, dashed=True),
    ]
