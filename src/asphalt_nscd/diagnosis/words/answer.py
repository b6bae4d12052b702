"""A diagnosis in words: rows of the first screen, the reasons behind them, and both as text (words.j2)."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache, partial
from textwrap import wrap
from typing import Any

from jinja2 import Template
from tabulate import tabulate

from asphalt_nscd.diagnosis.causes import CATALOGUE
from asphalt_nscd.diagnosis.criteria import LEAST_ISOTHERMS, NAMED
from asphalt_nscd.diagnosis.next_tests.fixed_orders import HALF
from asphalt_nscd.diagnosis.observed.apart import STANDS_OUT
from asphalt_nscd.diagnosis.screening import levels
from asphalt_nscd.diagnosis.words import facts, sentences, tables
from asphalt_nscd.files.templates import items, template
from asphalt_nscd.measurements.campaign import OFF_TARGET
from asphalt_nscd.measurements.further_kinds import ALL_KINDS
from asphalt_nscd.measurements.kinds import TEST_TYPES, UNKNOWN

Content = Mapping[str, Any]
WIDTH, LABEL = 100, 16  # columns of a terminal, and those of them for labels
MOST = 4  # sentences of a row; a reader finds the others in the reasons
MORE = "{} more: see the reasons."
FIRST_SCREEN = {  # label of a row, and the macro of words.j2 that fills it
    "Tests": "tests",
    "Note": "note",
    "Data": "data",
    "Fault": "fault",
    "Possible fault": "possible_fault",
    "Effect": "effect",
    "Possible effect": "possible_effect",
    "Leave out": "leave_out",
    "Check first": "check_first",
    "Next tests": "next_tests",
    "Not visible": "not_visible",
    "Scatter": "scatter",
    "Law": "law",
    "Unexplained": "unexplained",
}
CUT = {"Leave out": "if_kept", "Check first": "what_clears"}  # rows that are cut short, and what follows them
REASONS = {
    "Why tests are left out": "left_out",
    "Law of the mix": "law_of_the_mix",
    "Causes": "causes",
    "What stays unexplained": "what_is_left",
    "Why these tests next": "why_next",
}
REMARKS = {"Remarks": "notes", "What was read": "was_read"}
_fold = partial(wrap, width=WIDTH, break_long_words=False, break_on_hyphens=False)
ORIGINS = {
    "measured": "No file says that the data are synthetic or reconstructed: they are taken for measurements.",
    "digitised": "The data were read off figures; what is found may be an error of that reading.",
    "reconstructed": (
        "This diagnosis rests on reconstructed data. They are not measurements: they were drawn about one smooth "
        "law fitted to the published Burgers parameters, so that a cause found here is one of this reconstruction."
    ),
    "synthetic": "The data are synthetic: what is found here says nothing of a mix or of a rig.",
}


@cache
def _template() -> Template:
    names: dict[str, Any] = (
        vars(sentences) | vars(facts) | {"places": levels.places, "ONE_MIX": levels.ONE_MIX}
    )
    names |= {
        "CATALOGUE": CATALOGUE,
        "LEAST_ISOTHERMS": LEAST_ISOTHERMS,
        "NAMED": NAMED,
        "HALF": HALF,
        "STANDS_OUT": STANDS_OUT,
    }
    names |= {"OFF_TARGET": OFF_TARGET, "UNKNOWN": UNKNOWN, "TEST_TYPES": TEST_TYPES, "ORIGINS": ORIGINS}
    names |= {"TESTS_OF": ALL_KINDS | {UNKNOWN: "tests of another kind, or of one that was not said"}}
    return template("diagnosis/words/words.j2", vars(sentences), names)


class Words:
    """What a diagnosis says, by the macros of words.j2.

    `left`: errors [%] of "E" and "phase" that tests simulated with what was found have left, where a study has them.
    """

    def __init__(self, content: Content, left: Mapping[str, float] | None = None) -> None:
        self.simulated = left is not None or facts.BOND_MAPPING in [
            rung["cause"] for rung in content["ladder"]
        ]
        variables = {"c": content, "left": left, "simulated": self.simulated}
        self._module: Any = _template().make_module(variables)

    def __call__(self, part: str) -> list[str]:
        """The items of a macro, each without line breaks; empty where it has nothing to say."""
        return items(getattr(self._module, part)())

    def rows(self) -> list[tuple[str, list[str]]]:
        """Label and sentences of each row of the first screen in reading order, empty rows left out."""
        found = []
        for label, part in FIRST_SCREEN.items():
            said = self(part)
            if label in CUT:
                cut = [*said[: MOST - 1], MORE.format(len(said) - MOST + 1)] if len(said) > MOST else said
                said = [*cut, *self(CUT[label])]
            found.append(("Simulation" if label == "Law" and self.simulated else label, said))
        return [(label, said) for label, said in found if said]

    def reasons(self) -> list[tuple[str, list[str]]]:
        """Title and items of each part of the reasons, empty ones left out."""
        return [(title, said) for title, part in REASONS.items() if (said := self(part))]


def rows(content: Content, left: Mapping[str, float] | None = None) -> list[tuple[str, list[str]]]:
    """Rows of the first screen: what to use, to correct, to leave out, to test next; then how far it goes."""
    return Words(content, left).rows()


def answer(content: Content) -> str:
    """The rows as text of WIDTH columns: labels first, a blank line about the next tests; below what +- means."""
    words, lines, above = Words(content), list[str](), ""
    for label, said in words.rows():
        lines += [""] * ("Next tests" in (label, above))
        above = label
        for k, sentence in enumerate(said):
            first = f"{label if k == 0 else '':{LABEL}}"
            after = " " * (LABEL + 3 * (label == "Next tests"))
            lines += _fold(sentence, initial_indent=first, subsequent_indent=after)
    text = "\n".join(lines)
    return "\n\n".join([text, *(words("interval") if "+-" in text else [])])


def summary(content: Content) -> str:
    """The answer and the reasons, one titled part after another; parts with nothing to say are left out."""
    words = Words(content)
    remarks = [(title, words(part)) for title, part in REMARKS.items()]
    parts = [
        (title, [line for item in said for line in _fold(item, subsequent_indent="  ")])
        for title, said in [*words.reasons(), *remarks]
    ]
    for one in tables.tables(content):
        grid = tabulate(one.rows, one.head, disable_numparse=True)
        parts.append((one.title, [*_fold(one.caption), *grid.splitlines()]))
    told = ["\n".join([title.upper(), *lines]) for title, lines in parts if lines]
    return "\n\n".join([answer(content), *told])
