"""What a layout gives: tests as a table with one row for each, and what the file says of all of them."""

from __future__ import annotations

from dataclasses import dataclass

from asphalt_nscd.table_import.cells import Cells


@dataclass(frozen=True)
class Block:
    """The tests of one table, as cells with one row for each test.

    Of a machine's export (`exported`), where a block is of one specimen at one temperature: `repeated`, the operator
    marked it as a repetition; `tested`, its date as the header has it; `contested`, the temperature [degC] that name or
    header say beside the one taken; `unnamed`, no header names the specimen, and the file's name says no temperature:
    it may be that of a test. `means`: all results are means of others.
    """

    cells: Cells
    exported: bool = False
    repeated: bool = False
    tested: str = ""
    contested: str = ""
    unnamed: bool = False
    means: bool = False
