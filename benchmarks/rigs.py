"""Specimens of every test at full size, through the public calls: E*, creep and relaxation over those of the law.

    python benchmarks/rigs.py measure TEST LAW.json... --output ROWS.csv
    python benchmarks/rigs.py collect ROWS.csv... --output RIGS.csv --summary SUMMARY.csv

TEST is one of measurements/geometry.py; its usual specimen, of the spheres of `new-study`, poured and not vibrated,
bonded by facets. Facets have no moment of their own: N over the depth of a prism take 1/N^2 of its modulus.
"""

from __future__ import annotations

import argparse

import numpy as np
import pandas as pd

import asphalt_nscd as an
from asphalt_nscd.files.csvinput import read_csv
from asphalt_nscd.files.store import write_table
from asphalt_nscd.measurements.geometry import USUAL
from asphalt_nscd.table_import.spheres import spheres_for

FREQUENCIES = (0.1, 1.0, 10.0, 25.0)  # Hz
TIMES = (0.1, 1.0)  # s
STEPS = 20_000  # while a force or a displacement is held
EULER = 5.3e-5  # s, as new-study writes for cylinders tested up to 25 Hz


def measure(test: str, laws: list[str]) -> pd.DataFrame:
    """A row for each law, kind of test, and frequency [Hz] or time [s]."""
    shape = USUAL[test]
    spheres = spheres_for(shape)
    packing = an.pour(dict(spheres.counts), spheres.box, vibration=an.Vibration(duration=0.0), seed=1)
    specimen = an.specimen(packing, shape.keys(), area="facets")
    same = {"test": test, "spheres": len(specimen.arrays["radius"])}
    rows = []
    for path in laws:
        law = an.Law.read(path)
        temperature = float(law.content["temperature_C"])
        for frequency in FREQUENCIES:
            for kind, step in (("fitted", 1.0 / frequency / 200.0), ("euler", EULER)):
                tested = an.bend(
                    specimen, law, frequency, temperature, numerics=an.Numerics(step, 1000, scheme=kind)
                )
                over = tested.complex_modulus / complex(law.complex_modulus(frequency))
                rows.append(
                    {"kind": kind, "temperature_C": temperature, "at": frequency, "over_law": abs(over)}
                    | {"phase_deg": np.degrees(np.angle(over)), "broken": tested.broken_bonds}
                )
        strained = shape.usual_amplitude()
        force = strained / shape.form_factor() * float(law.bonds.relaxation_modulus(TIMES[0]))
        for kind, what in (("creep", {"force_N": force}), ("relaxation", {"displacement_m": strained})):
            held = an.hold(specimen, law, temperature, held=an.Hold(TIMES[-1], STEPS, **what))
            over = (
                1.0 / (held.iloc[:, 3] / held.iloc[:, 4])
                if kind == "creep"
                else held.iloc[:, 3] / held.iloc[:, 4]
            )
            for time in TIMES:
                place = round(time / TIMES[-1] * STEPS) - 1
                rows.append(
                    {"kind": kind, "temperature_C": temperature, "at": time, "over_law": over.iloc[place]}
                    | {"phase_deg": np.nan, "broken": held.attrs["broken_bonds"]}
                )
    return pd.DataFrame([same | row for row in rows])


def summary(table: pd.DataFrame) -> pd.DataFrame:
    """Ranges of a kind of test: modulus over the law, least and largest; largest phase error; bonds broken."""
    groups = table.groupby(["test", "spheres", "kind"], sort=False)
    found = groups["over_law"].agg(least="min", largest="max")
    found["phase_deg"] = groups["phase_deg"].agg(lambda values: values.abs().max())
    found["broken"] = groups["broken"].sum()
    return found.reset_index()


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    commands = parser.add_subparsers(dest="command", required=True)
    measuring = commands.add_parser("measure")
    measuring.add_argument("test", choices=USUAL)
    measuring.add_argument("laws", nargs="+")
    collecting = commands.add_parser("collect")
    collecting.add_argument("rows", nargs="+")
    collecting.add_argument("--summary", required=True)
    for command in (measuring, collecting):
        command.add_argument("--output", required=True)
    options = parser.parse_args()
    if options.command == "measure":
        write_table(options.output, measure(options.test, options.laws))
        return
    table = pd.concat([pd.DataFrame(read_csv(path).columns) for path in options.rows], ignore_index=True)
    for name in ("spheres", "temperature_C", "at", "over_law", "phase_deg", "broken"):
        table[name] = pd.to_numeric(table[name], errors="coerce")
    write_table(options.output, table)
    write_table(options.summary, summary(table))


if __name__ == "__main__":
    main()
