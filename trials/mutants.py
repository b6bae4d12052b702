"""Faults put into a copy of the sources, one at a time, and the tests that must then fail: do the tests notice?

    PYTHONPATH=trials python -m mutants [WORDS] [--output mutants.csv]

Each stands for a kind of fault that tests once let pass: a variance that is dropped, a size, a sign, a condition, a
unit. `asphalt-nscd verify mutations` does the same to the equations of the core.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
from dataclasses import asdict, dataclass
from pathlib import Path

import click
import pandas as pd

ROOT = Path(__file__).parents[1]
PACKAGE = "src/asphalt_nscd"


@dataclass(frozen=True)
class Mutant:
    """One fault: what it is, `right` made `wrong` in a file of the package, and the tests that must notice."""

    what: str
    file: str
    right: str
    wrong: str
    tests: str


MUTANTS = [
    Mutant(
        "variance between the ripples of a phase",
        "diagnosis/kramers_kronig.py",
        "(np.maximum(variances, 0.0) + (np.array(means) - mean) ** 2)",
        "np.maximum(variances, 0.0)",
        "diagnosis/test_kramers_kronig.py",
    ),
    Mutant(
        "uncertain sizes in a standard error",
        "diagnosis/discrepancy.py",
        "**2 + spread.sum()",
        "**2",
        "diagnosis/test_uncertain_sizes.py",
    ),
    Mutant(
        "tests of a mounting",
        "diagnosis/scatter.py",
        "(between - within) / size",
        "(between - within)",
        "diagnosis/test_scatter.py",
    ),
    Mutant(
        "sign in a relative error",
        "diagnosis/gain.py",
        "np.expm1(-left.real)",
        "np.expm1(left.real)",
        "diagnosis/test_gain.py",
    ),
    Mutant(
        "the other temperature of an export",
        "table_import/contested.py",
        " and abs(other) < NEARER * abs(off)",
        "",
        "table_import/test_contested.py",
    ),
    Mutant(
        "ten kgf/cm2",
        "table_import/quantities.py",
        "(0.0980665, 0.0)",
        "(0.980665, 0.0)",
        "table_import/test_units_of_columns.py",
    ),
    Mutant(
        "cold end of the tested temperatures",
        "exports/mepdg.py",
        "coldest - 0.5 <=",
        "coldest + 0.5 <=",
        "exports/test_mepdg.py",
    ),
    Mutant(
        "tension in the bonds that a test keeps",
        "bending/bending_test.py",
        "* [-1.0, 1.0, 1.0]",
        "* [1.0, 1.0, 1.0]",
        "bending/test_bond_forces.py",
    ),
    Mutant(
        "prior in a score",
        "diagnosis/chance.py",
        "fitted.residual - fitted.jacobian @ to_best",
        "fitted.residual",
        "diagnosis/test_chance.py",
    ),
    Mutant(
        "one-sided effects in the chance level",
        "diagnosis/chance.py",
        "np.where(one_sided, normal, np.abs(normal))",
        "normal",
        "diagnosis/test_chance.py",
    ),
    Mutant(
        "scatter that is itself estimated",
        "diagnosis/chance.py",
        "normal.max(axis=1, initial=0.0), 0.0) * student",
        "normal.max(axis=1, initial=0.0), 0.0)",
        "diagnosis/test_chance.py",
    ),
    Mutant(
        "prior of the scales",
        "diagnosis/joint.py",
        "gradient[p : p + s] -= scales",
        "gradient[p : p + s] += scales",
        "diagnosis/test_joint.py",
    ),
    Mutant(
        "what the law takes of a limit",
        "diagnosis/limits.py",
        "threshold / np.sqrt(found.information[k])",
        "threshold / found.information[k]",
        "diagnosis/test_limits.py",
    ),
    Mutant(
        "causes alike",
        "diagnosis/limits.py",
        "(1.0 - correlation[i, k] ** 2)",
        "(1.0 - correlation[i, k])",
        "diagnosis/test_limits.py",
    ),
    Mutant(
        "freedom that the fit uses up",
        "diagnosis/ladder.py",
        "(fitted.residual.size - used)",
        "fitted.residual.size",
        "diagnosis/test_rungs_accepted.py",
    ),
    Mutant(
        "variance of a value within its isotherm",
        "diagnosis/within_isotherm.py",
        "(share * (spread + (left - mean[:, None]) ** 2))",
        "(share * spread)",
        "diagnosis/test_within_isotherm.py",
    ),
    Mutant(
        "evidence without the value judged",
        "diagnosis/within_isotherm.py",
        "+ 0.5 * left**2 / spread + 0.5 * np.log(spread)",
        "+ 0.5 * left**2 / spread",
        "diagnosis/test_within_isotherm.py",
    ),
]


def noticed(mutant: Mutant) -> str:
    """What pytest says of the tests with the mutant in a copy of the sources; empty if they pass."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for part in (PACKAGE, "tests", "trials"):
            shutil.copytree(ROOT / part, folder / part, ignore=shutil.ignore_patterns("__pycache__"))
        shutil.copy(ROOT / "pyproject.toml", folder)
        (folder / "data").symlink_to(ROOT / "data")
        file = folder / PACKAGE / mutant.file
        text = file.read_text(encoding="utf-8")
        file.write_text(text.replace(mutant.right, mutant.wrong), encoding="utf-8")
        command = [sys.executable, "-m", "pytest", "-x", "-p", "no:cacheprovider", f"tests/{mutant.tests}"]
        environment = os.environ | {"PYTHONPATH": str(folder / "src")}
        done = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True)
    failed = [line for line in done.stdout.splitlines() if line.startswith("FAILED")]
    return "" if not done.returncode else (failed or [done.stdout[-300:] + done.stderr[-300:]])[0]


@click.command()
@click.argument("words", nargs=-1)
@click.option("--output", type=click.Path(path_type=Path), help="Table of mutants and what noticed them.")
def main(words: tuple[str, ...], output: Path | None) -> None:
    """Try the mutants, or those of which WORDS say something."""
    rows = []
    for mutant in MUTANTS:
        if words and not any(word in mutant.what + mutant.file for word in words):
            continue
        rows.append(asdict(mutant) | {"noticed": noticed(mutant)})
        click.echo(f"{mutant.what} ({mutant.file}): {rows[-1]['noticed'] or 'ALIVE'}")
    if output is not None:
        pd.DataFrame(rows).to_csv(output, index=False)
    sys.exit(sum(not row["noticed"] for row in rows))


if __name__ == "__main__":
    main()
