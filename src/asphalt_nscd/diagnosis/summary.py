"""A diagnosis on the terminal: what can be trusted, what was found, how sure it is, what to do."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from tabulate import tabulate

from asphalt_nscd.diagnosis import sentences, table_rows, unexplained, verdict

Content = Mapping[str, Any]


def summary(content: Content) -> str:
    """The first page as text, one part after another; parts with nothing to say are left out."""
    read = content.get("reading", {"notes": []})
    answer = [f"Data: {verdict.on_data(content)}", verdict.answer(content), verdict.first_order(content)]
    answer += verdict.then(content)
    test, files = verdict.test_type(content), verdict.files(content)
    law, named = sentences.law_of_the_mix(content), sentences.causes(content)
    mixes = verdict.mixes(content)
    head = [*([mixes] if mixes else []), *([f"Test: {test}."] if test else [])]
    head += [f"Files: {files}"] if files else []
    head += [] if content.get("origin", "measured") == "measured" else sentences.origin(content)
    parts = [
        ("Verdict", [*head, *filter(None, answer)]),
        ("Tests not to be used" if sentences.not_used(content) else "Doubtful tests", _suspects(content)),
        ("Law of the mix", [*([f"{law[0]}. {law[1]}"] if law else []), *verdict.beyond_the_tests(content)]),
        ("Causes", [*(f"{cause}. {sure}" for cause, sure in named), *_on_others(content)]),
        ("", list(filter(None, [sentences.of_intervals(content)]))),
        ("What stays unexplained", _left(content)),
        ("What to do next", _orders(content)),
        ("Scatter", _scatter(content)),
        ("Limits, stated and measured", _limits(content)),
        ("Remarks", content["notes"]),
        ("What was read", read["notes"]),
    ]
    return "\n\n".join(_part(title, lines) for title, lines in parts if lines)


def _part(title: str, lines: Sequence[str]) -> str:
    return "\n".join([*([title.upper()] if title else []), *lines])


def _on_others(content: Content) -> list[str]:
    """Of the causes that were not named."""
    return list(filter(None, [unexplained.no_cause(content), unexplained.unseen(content)]))


def _suspects(content: Content) -> list[str]:
    lines = []
    for one in sentences.not_used(content):
        where = sentences.place_of_test(one)
        lines.append(f"{where[:1].upper()}{where[1:]}:")
        lines += [f"  {reason}" for reason in one["reasons"]]
    return lines + list(filter(None, [sentences.with_suspects(content), sentences.on_doubtful(content)]))


def _left(content: Content) -> list[str]:
    dropped = [sentences.in_words(name) for name in content["withdrawn"]]
    left = unexplained.left(content)
    left += [unexplained.OF_WHAT_IS_LEFT] if content.get("discrepancy") else []
    return left + (
        [f"Considered and dropped, since structure without a name fits as well: {', '.join(dropped)}."]
        if dropped
        else []
    )


def _orders(content: Content) -> list[str]:
    found = content.get("instructions", {"orders": []})
    lines = []
    for number, one in enumerate(found["orders"], 1):
        lines += [f"{number}. {one['text']}", *(f"   {why}" for why in one["why"])]
    return [*lines, f"{sentences.RANKED} {found['costs']}"] if lines else []


def _limits(content: Content) -> list[str]:
    rows = table_rows.measured_limits(content)
    if not rows:
        return []
    return [
        table_rows.LIMITS_STATED,
        *tabulate(rows, table_rows.LIMITS_HEAD, disable_numparse=True).splitlines(),
    ]


def _scatter(content: Content) -> list[str]:
    rows = table_rows.scatter_rows(content)
    if not rows:
        return []
    table = tabulate(rows, table_rows.SCATTER_HEAD, disable_numparse=True)
    return [
        table_rows.SCATTER_CAPTION,
        *table.splitlines(),
    ]
