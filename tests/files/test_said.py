"""Words of sentences, and what a file that breaks its schema is told."""

from __future__ import annotations

import pytest
from jsonschema import Draft202012Validator

from asphalt_nscd.files import words
from asphalt_nscd.files.options import option, options_of
from asphalt_nscd.files.ranges import Range
from asphalt_nscd.files.schema_words import dotted, first_wrong, sentence_on
from asphalt_nscd.files.templates import items, template

SCHEMA = {
    "additionalProperties": False,
    "required": ["size"],
    "minProperties": 1,
    "properties": {
        "size": {"type": "number", "minimum": 1, "maximum": 9, "description": "Its size."},
        "share": {"type": "number", "exclusiveMinimum": 0, "exclusiveMaximum": 1},
        "count": {"type": "integer"},
        "kind": {"enum": ["a", "b"]},
        "name": {"type": "string", "pattern": "^[a-z]+$"},
        "list": {"type": "array", "minItems": 2, "maxItems": 3, "uniqueItems": True},
        "either": {"anyOf": [{"type": "number"}, {"type": "string"}, {"type": "object"}]},
        "one": {"type": "object", "maxProperties": 1, "properties": {"x": {}, "y": {}}},
        "many": {"type": "object", "minProperties": 3},
    },
}


@pytest.mark.parametrize(
    ("content", "said"),
    [
        ({"siz": 1}, "unknown key 'siz' in it; did you mean 'size'?"),
        ({"size": 1, "zzz": 1}, f"unknown key 'zzz' in it; allowed are {', '.join(SCHEMA['properties'])}."),
        ({"share": 0.5}, "key 'size' is missing from it; add it."),
        ({"size": 0}, "size is 0, but must be at least 1 (Its size)."),
        ({"size": 10}, "size is 10, but must be at most 9 (Its size)."),
        ({"size": "4,8"}, "size is '4,8', but must be a number (Its size); write 4.8."),
        ({"size": 1, "share": 0}, "share is 0, but must be greater than 0."),
        ({"size": 1, "share": 1}, "share is 1, but must be less than 1."),
        ({"size": 1, "count": 1.5}, "count is 1.5, but must be a whole number."),
        ({"size": 1, "kind": "c"}, "kind is 'c', but must be one of a, b."),
        ({"size": 1, "name": "A"}, "name is 'A', but must be letters, digits, - and _, the first a letter."),
        ({"size": 1, "list": [1]}, "list is [1], but must be a list of at least 2."),
        ({"size": 1, "list": [1, 2, 3, 4]}, "list is [1, 2, 3, 4], but must be a list of at most 3."),
        ({"size": 1, "list": [1, 1]}, "list is [1, 1], but must be a list without repetitions."),
        ({"size": 1, "either": []}, "either is [], but must be a number or text or a mapping."),
        ({"size": 1, "one": {"x": 1, "y": 2}}, "one needs exactly one of x, y."),
        ({"size": 1, "many": {"x": 1}}, "many is {'x': 1}, but must be a mapping of at least 3."),
    ],
)
def test_a_file_that_breaks_its_schema_is_told_in_one_sentence(content, said):
    wrong = first_wrong(Draft202012Validator(SCHEMA).iter_errors(content))
    assert sentence_on(wrong, "it") == said


def test_no_error_is_none_and_a_place_has_dots_and_brackets():
    assert first_wrong([]) is None
    assert dotted(["specimens", "seeds", 0, "x"]) == "specimens.seeds[0].x" and dotted([]) == ""


def test_words_by_number(monkeypatch):
    assert [words.joined("abcd"[:n]) for n in range(5)] == ["", "a", "a and b", "a, b and c", "a, b, c and d"]
    assert [words.counted(n, "test") for n in (0, 1, 2)] == ["0 tests", "1 test", "2 tests"]
    assert words.numbers([4.0, 20.5], "or") == "4 or 20.5" and words.capital("ab Cd") == "Ab Cd"
    assert [words.three_digits(x) for x in (1553.2, 0.02861, -7.0)] == ["1550", "0.0286", "-7"]
    assert words.specimen_named("A") == "specimen A" and words.specimen_named("Specimen A") == "Specimen A"
    assert words.choice("--law", "the menu") == "--law"
    monkeypatch.setenv(words.ON_PAGE, "1")
    assert words.choice("--law", "the menu") == "the menu"


def test_items_end_with_a_pilcrow_and_templates_of_pages_escape():
    assert items("a\n  b¶\n\n¶c") == ["a b", "c"]
    assert (
        template("reporting/pages/table.html", {"typeset": str, "worded": str}).environment.autoescape is True
    )
    assert template("exports/statements.j2").environment.autoescape is False


def test_limits_are_within_or_without():
    """Above and below exclude their number, low and high include it; nothing is ever not finite."""
    held = {
        Range(above=1.0): (False, True, True), Range(low=1.0): (True, True, True),
        Range(below=3.0): (True, True, False), Range(high=3.0): (True, True, True),
        Range(low=2.0, high=2.0): (False, True, False), Range(): (True, True, True),
    }  # fmt: skip
    for one, told in held.items():
        assert tuple(map(one.holds, (1.0, 2.0, 3.0))) == told, one
        assert not one.holds(float("inf")) and not one.holds(float("nan"))
    assert str(Range()) == "finite" and str(Range(low=1.0, below=2.0)) == "at least 1 and less than 2"


def test_an_option_in_another_unit_than_its_field():
    from dataclasses import dataclass

    @dataclass
    class Some:
        """Some.

        Parameters
        ----------
        gap : float
            How wide,
            in all.
        """

        gap: float | None = option(default=2e-3, unit=1e-3, key="gap_mm", low=0.0)
        other: int = 3

    (only,) = options_of(Some).values()
    assert (only.key, only.name, only.help, only.annotation) == (
        "gap_mm",
        "gap_mm",
        "How wide, in all.",
        float,
    )
    assert only.given(2e-3) == 2.0 and only.stored(5.0) == 5e-3 and only.given(None) is None
