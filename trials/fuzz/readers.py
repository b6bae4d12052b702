"""Every reader of files from people or disks, with valid files to begin from."""

from __future__ import annotations

import io
import json
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import h5py
import numpy as np
import openpyxl
import yaml
from reporting.figures.tiny_results import Results

from asphalt_nscd.bending.rig import Rig, read_rig, write_rig
from asphalt_nscd.contact_problems import fclib
from asphalt_nscd.diagnosis.observed.reading import PAPER_GEOMETRY, read_observations
from asphalt_nscd.diagnosis.written import read_diagnosis
from asphalt_nscd.files.csvinput import read_csv
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.files.store import load, save
from asphalt_nscd.measurements.geometry import read_geometry
from asphalt_nscd.measurements.reduction import reduce_table
from asphalt_nscd.reporting.tables.table4 import read_errors
from asphalt_nscd.rheology.chain import KelvinChain
from asphalt_nscd.rheology.laws_io import read_bond_law, write_chain
from asphalt_nscd.rheology.published_laws import read_published
from asphalt_nscd.rheology.spectrum_io import read_spectrum
from asphalt_nscd.specimen.counts import read_counts
from asphalt_nscd.study.configuration import complete_study, refuse_repeated_keys
from asphalt_nscd.table_import.campaign import read_campaign
from asphalt_nscd.table_import.spheres import read_grading

ROOT = Path(__file__).parents[2]
KEYS = "specimen,temperature_C,frequency_Hz"
MODULI = f"{KEYS},origin,E_MPa,phase_deg\n1,0,1,measured,9000,20\n1,0,10,measured,12000,16\n2,20,10,synthetic,4000,30\n"
PEAKS = f"{KEYS},F0_N,z0_m,psi_deg\n1,0,3,60,6.3e-5,20\n1,0,10,80,6.3e-5,16\n"
RECORDS = f"{KEYS},record\n1,20,10,record.csv\n"
RECORD = "time_s,force_N,displacement_m\n" + "".join(
    f"{n * 1e-3},{20 * np.sin(0.0628 * n + 0.3):.6f},{6.3e-5 * np.sin(0.0628 * n):.6e}\n" for n in range(250)
)
GEOMETRY = "specimen,b_mm,B_mm,e_mm,h_mm,mass_kg,mobile_mass_kg\n1,25,56,25,250,0.6,0.235\n"
OWN = "Probe;T (°C);f (Hz);|E*| [GPa];phi (rad);Note\nA;0;1;9,1;0,3;=1+1\nA;0;10;12,4;0,25;x\nB;20;10;4,2;0,5;\n"


@dataclass(frozen=True)
class Reader:
    """read: takes the path of a file; begin: contents of valid files."""

    name: str
    read: Callable[[Path], object]
    begin: tuple[bytes, ...]
    suffix: str = ".csv"


def _reduced(path: Path) -> None:
    (path.parent / "record.csv").write_text(RECORD)
    reduce_table(path, PAPER_GEOMETRY, path.parent / "reduced.csv", cycles=1)


def _record(path: Path) -> None:
    (path.parent / "table.csv").write_text(RECORDS.replace("record.csv", path.name))
    reduce_table(path.parent / "table.csv", PAPER_GEOMETRY, path.parent / "reduced.csv", cycles=1)


def _understood(path: Path) -> None:
    read_campaign([path])


def _observed(path: Path) -> None:
    read_observations(path, PAPER_GEOMETRY)


def _geometry(path: Path) -> None:
    read_geometry(path, ["1"])


def _study(path: Path) -> None:
    """As Snakemake gives it: what YAML makes of the file, once no key appears twice."""
    refuse_repeated_keys(path)
    try:
        config = yaml.safe_load(path.read_text(encoding="utf-8"))
    except (yaml.YAMLError, ValueError):  # Snakemake's own message
        return
    if isinstance(config, dict):
        complete_study(config, str(path))


def _written(write: Callable[[Path], object]) -> bytes:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "file")
        write(path)
        return path.read_bytes()


def _workbook() -> bytes:
    book = openpyxl.Workbook()
    for line in OWN.splitlines():
        book.active.append([_cell(text) for text in line.split(";")])
    book.save(stream := io.BytesIO())
    return stream.getvalue()


def _cell(text: str) -> object:
    try:
        return float(text.replace(",", "."))
    except ValueError:
        return text


def _contact_problem(path: Path) -> None:
    with h5py.File(path, "w") as file:
        group = file.create_group("fclib_local")
        group.create_dataset("spacedim", data=[3])
        matrix = group.create_group("W")
        for name, value in {"m": [3], "n": [3], "nz": [-2], "nzmax": [3]}.items():
            matrix.create_dataset(name, data=value)
        for name, value in {"p": [0, 1, 2, 3], "i": [0, 1, 2], "x": [1.0, 1.0, 1.0]}.items():
            matrix.create_dataset(name, data=value)
        group.create_dataset("vectors/q", data=[-1.0, 0.5, 0.0])
        group.create_dataset("vectors/mu", data=[0.5])


def _diagnosis() -> bytes:
    with tempfile.TemporaryDirectory() as folder:
        return Results(Path(folder)).diagnosis()["diagnosis"][0].read_bytes()


def _kept(*names: str) -> tuple[bytes, ...]:
    """Files of the repository."""
    return tuple((ROOT / name).read_bytes() for name in names)


LAW = {
    "law": "burgers", "temperature_C": 20.0, "Em_Pa": 2e10, "eta_m_Pa_s": 1e9, "Ek_Pa": 3e10, "eta_k_Pa_s": 1e8,
}  # fmt: skip
ELEMENTS = KelvinChain(1e10, 1e9, (1e10, 2e10), (1e8, 1e7))
STATED = {"source": "fuzz", "temperature": 0.0, "error": 0.1, "lowest_hz": 1.0, "highest_hz": 10.0}
CHAIN = _written(lambda path: write_chain(path, ELEMENTS, **STATED))
ARRAYS = {"a/b": np.arange(6.0), "c": np.arange(3)}
HDF5 = _written(lambda path: save(path, "test", ARRAYS, {"x": 1.5, "y": "z"}))

TEXTS = [
    Reader("any CSV table", read_csv, (MODULI.encode(), GEOMETRY.encode())),
    Reader("measurements", _reduced, (MODULI.encode(), PEAKS.encode(), RECORDS.encode())),
    Reader("record", _record, (RECORD.encode(),)),
    Reader("observations", _observed, (MODULI.encode(), PEAKS.encode())),
    Reader("own table", _understood, (OWN.encode(), OWN.encode("cp1252", "replace"), MODULI.encode())),
    Reader("sieve table", read_grading, (b"sieve (mm);passing (%)\n2;20\n4;55,5\n8;100\n",)),
    Reader("counts", read_counts, (b"diameter_mm,count\n2,600\n3,200\n",)),
    Reader("geometry table", _geometry, (GEOMETRY.encode(),)),
    Reader("published laws", read_published, _kept("data/paper/table3_burgers.csv")),
    Reader("published errors", read_errors, _kept("data/paper/table4_errors.csv")),
    Reader("geometry in JSON", _geometry, (json.dumps(PAPER_GEOMETRY).encode(),), ".json"),
    Reader("law", read_bond_law, (json.dumps(LAW).encode(), CHAIN), ".json"),
    Reader("spectrum", read_spectrum, _kept("results/published/paper/diagnosis/law.json"), ".json"),
    Reader("rig", read_rig, (_written(lambda path: write_rig(path, Rig())),), ".json"),
    Reader("diagnosis", lambda path: read_diagnosis([path]), (_diagnosis(),), ".json"),
    Reader("study", _study, _kept("config/smoke.yaml", "config/paper.yaml"), ".yaml"),
]
BINARIES = [
    Reader("own workbook", _understood, (_workbook(),), ".xlsx"),
    Reader("result", lambda path: load(path, "test"), (HDF5,), ".h5"),
    Reader("contact problem", fclib.read_problem, (_written(_contact_problem),), ".h5"),
]


def tried(reader: Reader, content: bytes, folder: Path) -> str | None:
    """The sentence of a refusal, None where the file was taken; any other exception goes through."""
    path = folder / f"file{reader.suffix}"
    path.write_bytes(content)
    try:
        reader.read(path)
    except InputError as error:
        assert "\n" not in str(error).strip() and len(str(error)) < 3000, f"not one sentence: {error}"
        return str(error)
    return None
