"""The compiled core: arrays in, arrays out.

Imports nothing else of this package. Sign convention throughout: relative velocity positive =
opening, reaction on the second body positive = repulsion.
"""

from typing import Any


def __getattr__(name: str) -> Any:
    """`solve_contacts`, imported when asked for: the other kernels do without scipy.sparse."""
    if name == "solve_contacts":
        from asphalt_nscd.nscd.contacts.friction import solve_contacts

        return solve_contacts
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
