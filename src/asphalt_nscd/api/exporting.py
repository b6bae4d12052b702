"""What comes out for other programs: laws as Prony series, workbooks and tables; spheres and bonds."""

from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

from asphalt_nscd.api.arguments import checked
from asphalt_nscd.api.laws import Law
from asphalt_nscd.api.results import Result
from asphalt_nscd.exports.export import export_law, require_form
from asphalt_nscd.exports.law import law_of, read_law_file
from asphalt_nscd.exports.settings import ExportSettings
from asphalt_nscd.files.errors import InputError

if TYPE_CHECKING:
    from asphalt_nscd.api.diagnosis import Diagnosis


@checked
def export(
    law: Law | Diagnosis | Result | str | Path,
    output: str | Path,
    form: str,
    *,
    settings: ExportSettings = ExportSettings(),  # noqa: B008  frozen
    temperatures_C: tuple[float, ...] | None = None,
    frequencies_Hz: tuple[float, ...] | None = None,
) -> str:
    """Write a law, or spheres and bonds, for another program.

    Parameters
    ----------
    law : Law, Diagnosis, Packing, Specimen, Test or path
        What is written; of a diagnosis, its law.
    output : path
        File to write.
    form : str
        Of a law a format of docs/laws-out.md, as abaqus, xlsx or mepdg; of spheres and bonds vtk (.vtp, for ParaView;
        bonds in a file beside) or csv.
    settings : ExportSettings
        Largest errors of the Prony series, Poisson's ratio, units, name of the material.
    temperatures_C, frequencies_Hz : tuple of float, optional
        The tested ones [degC], [Hz], over which the series holds; else those of the diagnosis, or usual ones, and the
        file says which.

    Returns
    -------
    str
        One line that says what was written and how well it follows the law.

    Raises
    ------
    InputError
        With one sentence, for a form that this cannot be written in, or settings that cannot be met.

    Examples
    --------
    >>> law = Law.burgers(Em_Pa=24.3e9, eta_m_Pa_s=3.71e9, Ek_Pa=48.4e9, eta_k_Pa_s=0.773e9, temperature_C=15)
    >>> with TemporaryDirectory() as folder:  # doctest: +ELLIPSIS
    ...     print(export(law, f"{folder}/T15.csv", "csv", frequencies_Hz=(3.0, 40.0)))
    /.../T15.csv: 2 Prony terms at 15 degC, largest errors less than 1e-06 % of |E*| ...
    """
    # By the ending, for a law is JSON and a result HDF5.
    if isinstance(law, Result) or Path(str(law)).suffix.lower() in (".h5", ".hdf5"):
        return _export_result(law, output, form)
    tested = temperatures_C, frequencies_Hz
    require_form(form, Path(output))
    if isinstance(law, str | Path):
        return export_law(read_law_file(law, *tested), settings, form, output)
    if isinstance(law, Law):
        return export_law(law_of(law.source, dict(law.content), *tested), settings, form, output)
    from asphalt_nscd.api.diagnosis import Diagnosis

    if not isinstance(law, Diagnosis):
        raise InputError(
            f"export: cannot write a value of type {type(law).__name__}; give a Law, a Diagnosis, a result or a path."
        )
    if law.law is None:
        raise InputError("a diagnosis of one isotherm has no law; diagnose tests at more temperatures.")
    with TemporaryDirectory() as folder:  # the export finds the tests beside the law
        law.write(folder)
        return export_law(read_law_file(Path(folder, "law.json"), *tested), settings, form, output)


def _export_result(result: Result | str | Path | Law | Diagnosis, output: str | Path, form: str) -> str:
    from asphalt_nscd.packings.outgoing import export_result

    if not isinstance(result, Result):
        return export_result(str(result), form, output)
    with TemporaryDirectory() as folder:
        path = Path(folder, "result.h5")
        result.write(path)
        return export_result(path, form, output)
