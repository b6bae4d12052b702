"""Complex modulus of asphalt concrete by nonsmooth contact dynamics.

>>> import asphalt_nscd as an
>>> table = an.read("data/tutorial/exports")
>>> an.fit(table).kind
'2s2p1d'
"""

import sys as _sys
from importlib import import_module as _import_module
from types import ModuleType as _ModuleType

__version__ = "0.1.0"

# Name: its module, imported when the name is first asked for. The same names stand in __init__.pyi, which editors
# and type checkers read.
_NAMES = {
    "Bonds": "bending.settings",
    "Cycling": "bending.further_settings",
    "Comparison": "api.comparison",
    "Diagnosis": "api.diagnosis",
    "Draws": "diagnosis.settings",
    "ExportSettings": "exports.settings",
    "Failure": "api.ramp",
    "FatigueLaw": "bending.further_settings",
    "Forecast": "api.forecasting",
    "Hold": "bending.further_settings",
    "InputError": "files.errors",
    "Known": "diagnosis.settings",
    "Law": "api.laws",
    "Load": "bending.settings",
    "Numerics": "bending.settings",
    "Packing": "api.specimens",
    "Ramp": "bending.further_settings",
    "Rig": "bending.rig",
    "Simulated": "diagnosis.settings",
    "Specimen": "api.specimens",
    "Test": "api.bending",
    "Surfaces": "specimen.settings",
    "Vibration": "specimen.settings",
    "bend": "api.bending",
    "compare": "api.comparison",
    "cycle": "api.bending",
    "diagnose": "api.diagnosis",
    "export": "api.exporting",
    "fatigue": "api.fatigue",
    "fit": "api.laws",
    "forecast": "api.forecasting",
    "hold": "api.bending",
    "pour": "api.specimens",
    "ramp": "api.ramp",
    "read": "api.reading",
    "read_packing": "api.specimens",
    "solve_contacts": "api.contacts",
    "specimen": "api.specimens",
}
__all__ = [*_NAMES]


def __getattr__(name: str):
    # The package is there in 1 ms; all its names take 1.1 s.
    if name not in _NAMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    if name == _CallablePackage.NAME:
        return _import_module(f"{__name__}.{name}")
    value = getattr(_import_module(f"{__name__}.{_NAMES[name]}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted([*globals(), *__all__])


class _CallablePackage(_ModuleType):
    """The folder `specimen`, which is called as the function of this name: an import binds the name to the folder."""

    NAME = "specimen"

    @property
    def __wrapped__(self):
        return getattr(_import_module(f"asphalt_nscd.{_NAMES[self.NAME]}"), self.NAME)

    def __call__(self, *arguments, **options):
        return self.__wrapped__(*arguments, **options)


class _Package(_ModuleType):
    def __setattr__(self, name, value):
        if name == _CallablePackage.NAME and isinstance(value, _ModuleType):
            value.__class__ = _CallablePackage
        super().__setattr__(name, value)


_sys.modules[__name__].__class__ = _Package
