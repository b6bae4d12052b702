"""The layouts that are known: the first that matches reads."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Protocol

from asphalt_nscd.table_import import machine_exports, matrices, rows_of_tests
from asphalt_nscd.table_import.cells import Block, Sheet


class Layout(Protocol):
    """A module that knows one way to lay out tests."""

    def matches(self, sheets: Sequence[Sheet]) -> bool:
        """Whether the sheets of a file together, or one of them, have this layout."""

    def read(self, sheets: Sequence[Sheet], chosen: Mapping[str, str]) -> list[Block]:
        """The tests of the sheets; `chosen` has the columns that the user named by what they hold."""


LAYOUTS: tuple[Layout, ...] = (matrices, machine_exports, rows_of_tests)


def layout_of(sheets: Sequence[Sheet]) -> Layout | None:
    """The layout of sheets; None where they are to be read one by one."""
    return next((layout for layout in LAYOUTS if layout.matches(sheets)), None)
