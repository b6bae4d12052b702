"""Complex modulus of asphalt concrete by nonsmooth contact dynamics.

>>> import asphalt_nscd as an
>>> diagnosis = an.diagnose("data/tutorial/exports", draws=an.Draws(500))
>>> diagnosis.verdict
'explained'
"""

__version__ = "0.1.0"

# Name: its module in `asphalt_nscd.api`, imported when the name is first asked for. The same names stand in
# __init__.pyi, which editors and type checkers read.
_NAMES = {
    "Diagnosis": "diagnosis",
    "Draws": "diagnosis",
    "ExportSettings": "exporting",
    "Law": "laws",
    "diagnose": "diagnosis",
    "export": "exporting",
    "fit": "laws",
    "read": "reading",
    "solve_contacts": "contacts",
}
__all__ = [*_NAMES, "InputError"]


def __getattr__(name: str):
    from importlib import import_module

    if name == "InputError":
        value = import_module("asphalt_nscd.files.errors").InputError
    elif name in _NAMES:
        value = getattr(import_module(f"asphalt_nscd.api.{_NAMES[name]}"), name)
    else:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted([*globals(), *__all__])
