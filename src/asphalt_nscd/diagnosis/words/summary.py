"""A diagnosis as text: the answer on one screen, and its reasons."""

from __future__ import annotations

from collections.abc import Sequence

from tabulate import tabulate

from asphalt_nscd.diagnosis.words import brief, sentences, table_rows, unexplained, verdict
from asphalt_nscd.diagnosis.words.sentences import Content


def answer(content: Content) -> str:
    """What to use, what to correct, what to leave out, what to test next; below it what +- means."""
    told = brief.text(content)
    return f"{told}\n\n{sentences.interval_note(content)}" if "+-" in told else told


def summary(content: Content) -> str:
    """The answer and the reasons, one titled part after another; parts with nothing to say are left out."""
    read = content["reading"]
    law, named = sentences.law_of_the_mix(content), sentences.causes(content)
    simulated, two_laws = verdict.simulation_miss(content), verdict.two_laws(content)
    none_named = list(filter(None, [unexplained.absence_note(content)]))
    scatter, limits = table_rows.scatter_rows(content), table_rows.measured_limits(content)
    excess = table_rows.excess_rows(content)
    parts = [
        ("", [answer(content)]),
        ("Why tests are left out", _suspects(content)),
        (
            "Law of the mix",
            [
                *([verdict.TWO_LAWS] if two_laws else []),
                sentences.capital(simulated),
                *two_laws,
                *([f"{law[0]}. {law[1]}".rstrip()] if law else []),
            ],
        ),
        ("Causes", [f"{cause}. {sure}" for cause, sure in named] + none_named),
        ("What stays unexplained", _left(content)),
        ("Why these tests next", _orders(content)),
        ("Scatter", _table(table_rows.SCATTER_CAPTION, table_rows.SCATTER_HEAD, scatter)),
        ("Phase above what |E*| requires", _table(table_rows.EXCESS_CAPTION, table_rows.EXCESS_HEAD, excess)),
        ("Limits, stated and measured", _table(table_rows.LIMITS_STATED, table_rows.LIMITS_HEAD, limits)),
        ("Remarks", content["notes"]),
        ("What was read", read["notes"]),
    ]
    return "\n\n".join("\n".join([*[title.upper()] * bool(title), *lines]) for title, lines in parts if lines)


def _suspects(content: Content) -> list[str]:
    lines = []
    for one in sentences.unused_tests(content):
        where = sentences.capital(sentences.place_of_test(one))
        lines += [f"{where}:", *(f"  {reason}" for reason in one["reasons"])]
    return lines + list(filter(None, [sentences.suspect_change(content), sentences.doubtful_change(content)]))


def _left(content: Content) -> list[str]:
    dropped = [sentences.spell_cause(name) for name in content["withdrawn"]]
    left = unexplained.left(content)
    left = [unexplained.OF_WHAT_IS_LEFT, *left] if content["discrepancy"] else left
    return left + ([f"Considered but not named, since too unsure: {', '.join(dropped)}."] if dropped else [])


def _orders(content: Content) -> list[str]:
    found = content["instructions"]
    lines = []
    for number, one in enumerate(found["orders"], 1):
        lines += [f"{number}. {one['text']}", *(f"   {why}" for why in one["why"])]
    return [*lines, f"{sentences.RANKED} {found['costs']}"] if lines else []


def _table(caption: str, head: Sequence[str], rows: list[list[str]]) -> list[str]:
    return [caption, *tabulate(rows, head, disable_numparse=True).splitlines()] if rows else []
