"""Sheets as laboratories lay them out, 20 families. Knows nothing of the reader."""

from __future__ import annotations

from collections.abc import Callable
from itertools import product

from layouts.laboratory import Laboratory, Rows, Sheets


def long(lab: Laboratory) -> Sheets:
    """A row for each test, with columns beside that say other things."""
    more = lab.chance(0.5)
    names, cells = (["Air voids (%)", "Operator"], [5.2, "me"]) if more else ([], [])
    rows = [[s, lab.t(t), f, *lab.both(s, t, f), *cells] for s, t, f in lab.tests.values]
    return {"Data": [[lab.specimen, *lab.names("tfep"), *names], *rows]}


def specimens_over_pairs(lab: Laboratory) -> Sheets:
    """A specimen over its modulus and phase; temperature and frequency merged down from the first line."""
    names = lab.tests.specimens
    first = [*lab.names("tf"), *(cell for s in names for cell in (s, None))]
    second = [None, None, *lab.names("ep") * len(names)]
    if lab.chance(0.5):
        first, second = [None, None, *first[2:]], [*first[:2], *second[2:]]
    merged = lab.chance(0.5)
    rows = [[shown, f, *(c for s in names for c in lab.both(s, t, f))] for shown, t, f in lab.grid(merged)]
    return {"E": [first, second, *rows]}


def quantities_over_specimens(lab: Laboratory, kinds: int = 0) -> Sheets:
    """Modulus merged over a column for each specimen, then the phase; statistics behind each, if any."""
    names = [*lab.tests.specimens, *lab.statistics[:kinds]]
    blank = [None] * (len(names) - 1)
    heads = [lab.names("tf"), [None, None]]
    above, beside = heads if lab.chance(0.5) else heads[::-1]
    rows: Rows = [[*above, lab.name["e"], *blank, lab.name["p"], *blank], [*beside, *names, *names]]
    for shown, t, f in lab.grid(lab.chance(0.5)):
        rows.append([shown, f, *lab.each(0, t, f, kinds), *lab.each(1, t, f, kinds)])
    return {"Results": rows}


def statistics_beside(lab: Laboratory) -> Sheets:
    """The same with a mean, a deviation and a CV."""
    return quantities_over_specimens(lab, int(lab.random.integers(1, 4)))


def statistics_below(lab: Laboratory) -> Sheets:
    """Rows of a mean, a deviation and a CV below the specimens of each condition."""
    kinds = int(lab.random.integers(1, 4))
    rows: Rows = [[*lab.names("tf"), lab.specimen, *lab.names("ep")]]
    for _, t, f in lab.grid():
        rows += [[lab.t(t), f, s, *lab.both(s, t, f)] for s in lab.tests.specimens]
        computed = zip(lab.computed(0, t, f, kinds), lab.computed(1, t, f, kinds), strict=True)
        rows += [[lab.t(t), f, word, *both] for word, both in zip(lab.statistics, computed, strict=False)]
    return {"Data": rows}


def numbered(lab: Laboratory) -> Sheets:
    """The number of the specimen in each name."""
    numbers = range(1, len(lab.tests.specimens) + 1)
    link = lab.pick("{} {n} ({})", "{} {n} [{}]", "{}_{n} ({})")
    name = {k: [link.format(lab.bare[k], lab.units[k], n=n) for n in numbers] for k in "ep"}
    rows = [[shown, f, *lab.each(0, t, f), *lab.each(1, t, f)] for shown, t, f in lab.grid()]
    return {"Sheet1": [[*lab.names("tf"), *name["e"], *name["p"]], *rows]}


def temperatures_across(lab: Laboratory) -> Sheets:
    """A column for each temperature."""
    at = [f"{lab.t(t)} {lab.units['t']}" for t in lab.temperatures]
    names = [lab.specimen, lab.name["f"], *(f"{name} {one}" for name in lab.names("ep") for one in at)]
    rows = [[s, f, *lab.sweep(s, f)] for s, f in product(lab.tests.specimens, lab.frequencies)]
    return {"Results": [names, *rows]}


def matrix(lab: Laboratory, s: str, which: int) -> Rows:
    """One quantity of a specimen, temperature down and frequency across."""
    head: Rows = [[None, lab.name["f"]], [lab.name["t"], *lab.frequencies]]
    return head + [[lab.t(t), *(lab.both(s, t, f)[which] for f in lab.frequencies)] for t in lab.temperatures]


def matrices_below(lab: Laboratory) -> Sheets:
    """Matrices of modulus and phase, one specimen below the other."""
    rows: Rows = []
    for s in lab.tests.specimens:
        rows.append([lab.specimen, s])
        for which, key in enumerate("ep"):
            rows += [[lab.name[key]], *matrix(lab, s, which), []]
    return {"Master": rows}


def matrices_by_sheet(lab: Laboratory) -> Sheets:
    """A sheet for each specimen with two matrices."""
    sheets: Sheets = {}
    for s in lab.tests.specimens:
        moduli, phases = ([[name], *matrix(lab, s, which)] for which, name in enumerate(lab.names("ep")))
        sheets[lab.sheet(s)] = [*moduli, [], *phases]
    return sheets


def isothermal_columns(lab: Laboratory) -> Sheets:
    """A specimen's frequencies down, temperatures across under the modulus and again under the phase, in sheets."""
    at = [f"{lab.t(t)} {lab.units['t']}" for t in lab.temperatures]
    blank = [None] * (len(at) - 1)
    head: Rows = [[None, lab.name["e"], *blank, lab.name["p"], *blank], [lab.name["f"], *at, *at]]
    return {
        lab.sheet(s): [*head, *([f, *lab.sweep(s, f)] for f in lab.frequencies)] for s in lab.tests.specimens
    }


def sheet_of_each_specimen(lab: Laboratory) -> Sheets:
    """A sheet for each specimen, and at times one of means."""
    sheets: Sheets = {}
    for s in lab.tests.specimens:
        rows = [[shown, f, *lab.both(s, t, f)] for shown, t, f in lab.grid(lab.chance(0.5))]
        sheets[lab.sheet(s)] = [lab.names("tfep"), *rows]
    if lab.chance(0.3):
        sheets[lab.statistics[0]] = [lab.names("tfep"), *lab.means()]
    return sheets


def sheet_of_each_temperature(lab: Laboratory) -> Sheets:
    """A sheet for each temperature, which its name says, at times with the minus sign of a word processor."""
    minus, unit = lab.pick("-", "\N{MINUS SIGN}"), "F" if lab.fahrenheit else "C"
    sheets: Sheets = {}
    for t in lab.temperatures:
        rows = [[s, f, *lab.both(s, t, f)] for s in lab.tests.specimens for f in lab.frequencies]
        named = f"{lab.t(t)} °{unit}".replace("-", minus)
        sheets[named] = [[lab.specimen, *lab.names("fep")], *rows]
    return sheets


def parts(lab: Laboratory) -> Sheets:
    """Real and imaginary part, or a modulus and tan delta."""
    tangent = lab.chance(0.4)
    unit = lab.unit
    names = [lab.name["e"], lab.pick("tan δ", "tan(φ)")] if tangent else [f"E1 ({unit})", f"E2 ({unit})"]
    rows: Rows = [[lab.specimen, *lab.names("tf"), *names]]
    for s, t, f in lab.tests.values:
        star = lab.star(s, t, f)
        two = [abs(star), star.imag / star.real] if tangent else [star.real, star.imag]
        rows.append([s, lab.t(t), f, *(float(f"{x:.6g}") for x in two)])
    return {"DMA": rows}


def ampt(lab: Laboratory) -> Sheets:
    """Summaries of an AMPT, one for each specimen and temperature, as sheets."""
    sheets: Sheets = {}
    for n, (s, t) in enumerate(product(lab.tests.specimens, lab.temperatures), start=1):
        both = [lab.both(s, t, f) for f in lab.frequencies]
        phase = "Radians" if lab.radians else "Degrees"
        sheets[f"Summary {n}"] = [
            ["Test Information"], ["Project name", "Own"], [f"Target test temperature ({lab.units['t']})", lab.t(t)],
            ["Identification", s], ["Comments"], ["Test results summary"],
            [None, *(f"{f:g} Hz" for f in lab.frequencies)],
            [f"Dynamic modulus ({lab.unit})", *(e for e, _ in both)],
            [f"Phase angle ({phase})", *(p for _, p in both)],
            [f"Average temperature ({lab.units['t']})", *(lab.t(t) for _ in both)],
            ["Load drift (%)", *(0.4 for _ in both)], ["Average micro-strain", *(98 for _ in both)],
        ]  # fmt: skip
    return sheets


def utm(lab: Laboratory) -> Sheets:
    """The summary of a UTM: lines of the project, names, a line of units, a row for each test."""
    rows: Rows = [["Dynamic Modulus Test, AASHTO T 342"], ["Project:", "Own"], ["Operator:", "me"], []]
    named = "Specimen ID|Target Temperature|Frequency|Dynamic Modulus|Phase Angle|Axial micro-strain"
    rows.append(named.split("|"))
    rows.append([None, lab.units["t"], "Hz", lab.unit, "rad" if lab.radians else "degrees", "µε"])
    rows += [[s, lab.t(t), f, *lab.both(s, t, f), 97] for s, t, f in lab.tests.values]
    return {"Summary": rows}


def cooper(lab: Laboratory) -> Sheets:
    """Sections of a Cooper summary, one for each specimen, with both parts of the modulus beside it."""
    rows: Rows = [["Cooper Research Technology Ltd"], ["Complex modulus, EN 12697-26"], []]
    names = [f"Test Temp. / {lab.units['t']}", "Frequency / Hz", f"Complex Modulus / {lab.unit}"]
    names += [f"Phase Lag / {lab.units['p']}", f"Storage Modulus / {lab.unit}", f"Loss Modulus / {lab.unit}"]
    for s in lab.tests.specimens:
        rows += [["Specimen Ref.", s], ["Date of test", "12/05/2023"], names]
        for _, t, f in lab.grid():
            star = lab.star(s, t, f)
            rows.append([lab.t(t), f, *lab.both(s, t, f), round(star.real, 2), round(star.imag, 2)])
        rows.append([])
    return {"Report": rows}


def controls(lab: Laboratory) -> Sheets:
    """The summary of Controls: set and actual values, the mean over specimens and its CoV in a table of their own."""
    rows: Rows = [["CONTROLS - Dynapave", None, None, "EN 12697-26 annex D"], ["Customer", "Own"], []]
    names = ["Sample Name", f"Set Temperature ({lab.units['t']})", f"Actual Temperature ({lab.units['t']})"]
    names += ["Set Frequency (Hz)", "Actual Frequency (Hz)", f"E* ({lab.unit})"]
    rows.append([*names, f"Phase Angle ({lab.units['p']})", "No. cycles"])
    rows += [[s, lab.t(t), lab.t(t), f, f, *lab.both(s, t, f), 10] for s, t, f in lab.tests.values]
    mean: Rows = [["Mean values"], [*lab.names("tf"), f"Mean E* ({lab.unit})", "CoV (%)"]]
    mean += [[lab.t(t), f, *lab.computed(0, t, f, 3)[::2]] for _, t, f in lab.grid()]
    return {"Test data": rows} | ({"Summary": mean} if lab.chance(0.5) else {})


def two_mixes(lab: Laboratory) -> Sheets:
    """Two mixes in one table with equal numbers, of which M1 is to be read."""
    (name, rows), *_ = long(lab).items()
    return {name: [[lab.mix, *rows[0]], *([mix, *row] for mix in ("M1", "M2") for row in rows[1:])]}


def quantities_below(lab: Laboratory) -> Sheets:
    """A column for each specimen; the phase below the modulus or on a sheet of its own; statistics behind."""
    kinds = int(lab.random.integers(0, 4))
    head = [*lab.names("tf"), *lab.tests.specimens, *lab.statistics[:kinds]]
    blocks: list[Rows] = []
    for which, name in enumerate(lab.names("ep")):
        rows = [[shown, f, *lab.each(which, t, f, kinds)] for shown, t, f in lab.grid(merged=True)]
        blocks.append([[name], head, *rows, []])
    return {"E": blocks[0], "P": blocks[1]} if lab.chance(0.5) else {"Results": [*blocks[0], *blocks[1]]}


def units_below(lab: Laboratory) -> Sheets:
    """Units in a line below the names, the mix above; specimen, temperature and the block of means are named once."""
    rows: Rows = [[f"{lab.mix}:", "AC 22 T S 30/45"], [], [lab.specimen, *(lab.bare[k] for k in "tfep")]]
    rows.append(["", *(lab.units[k] for k in "tfep")])
    for s in lab.tests.specimens:
        cells = [[shown, f, *lab.both(s, t, f)] for shown, t, f in lab.grid(merged=True)]
        rows += [[None if n else s, *row] for n, row in enumerate(cells)]
    if lab.chance(0.5) and lab.language in ("en", "fr", "de"):
        rows += [[None if n else lab.statistics[0], *row] for n, row in enumerate(lab.means())]
    return {"Data": rows}


def matrices_beside(lab: Laboratory) -> Sheets:
    """A sheet for each specimen, with the matrix of the modulus and that of the phase side by side."""
    sheets: Sheets = {}
    size = len(lab.frequencies) + 2
    for s in lab.tests.specimens:
        both = [[[name], *matrix(lab, s, which)] for which, name in enumerate(lab.names("ep"))]
        rows = zip(*both, strict=True)
        sheets[lab.sheet(s)] = [[*left, *[None] * (size - len(left)), *right] for left, right in rows]
    return sheets


def sheet_of_each_frequency(lab: Laboratory) -> Sheets:
    """A sheet for each frequency, which a column says too."""
    return {
        f"{f:g} Hz": [
            [lab.specimen, *lab.names("tfep")],
            *([s, lab.t(t), f, *lab.both(s, t, f)] for s in lab.tests.specimens for t in lab.temperatures),
        ]
        for f in lab.frequencies
    }


def specimens_beside(lab: Laboratory) -> Sheets:
    """Frequency, modulus and phase of each specimen side by side, below its name; a block for each temperature."""
    names = lab.tests.specimens
    rows: Rows = []
    for t in lab.temperatures:
        rows.append([f"{lab.bare['t']} {lab.t(t)} {lab.units['t']}"])
        rows.append([None, *(c for s in names for c in (s, None))])
        rows.append([lab.name["f"], *lab.names("ep") * len(names)])
        rows += [[f, *(c for s in names for c in lab.both(s, t, f))] for f in lab.frequencies]
        rows.append([])
    return {"Data": rows}


Family = Callable[[Laboratory], Sheets]
LATER_FAMILIES: tuple[Family, ...] = (matrices_beside, sheet_of_each_frequency, specimens_beside)
FAMILIES: tuple[Family, ...] = (
    long, specimens_over_pairs, quantities_over_specimens, statistics_beside, statistics_below, numbered,
    temperatures_across, matrices_below, matrices_by_sheet, isothermal_columns, sheet_of_each_specimen,
    sheet_of_each_temperature, parts, ampt, utm, cooper, controls, two_mixes, quantities_below,
    units_below,
)  # fmt: skip
