"""What a laboratory needs works without extras; what does not says which extra it needs."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

pytestmark = pytest.mark.slow

ROOT = Path(__file__).parents[2]
OF_EXTRAS = "numba", "llvmlite", "pyamg", "vtk", "matplotlib", "flask"
WITHOUT = f"import sys\nsys.modules.update(dict.fromkeys({OF_EXTRAS}))\n"  # as if they were not installed


def run(program: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run([sys.executable, "-c", WITHOUT + program], cwd=ROOT, capture_output=True, text=True)


@pytest.fixture(scope="module")
def diagnosed() -> subprocess.CompletedProcess[str]:
    return run(
        "import asphalt_nscd as an\n"
        "table = an.read('data/ncat/N1-1_RH.csv', measured_in='tension-compression')\n"
        "print(an.fit(table).kind)\n"
        "made = an.diagnose(table, measured_in='tension-compression', draws=an.Draws(500))\n"
        "print(made)\n"
        "made.plot_black()\n"
    )


def test_a_table_is_read_fitted_and_diagnosed(diagnosed):
    assert diagnosed.stdout.startswith("2s2p1d\nTests "), diagnosed.stderr


def test_a_figure_names_its_extra(diagnosed):
    assert "ModuleNotFoundError" in diagnosed.stderr and "asphalt-nscd[figures]" in diagnosed.stderr


def test_a_step_of_the_simulation_names_the_extra():
    done = run("from asphalt_nscd.cli import main\nmain(['compile', 'simulate'])")
    assert done.returncode == 2
    assert done.stderr == "error: this step needs numba; pip install 'asphalt-nscd[simulation]'.\n"


def test_so_does_a_function_of_the_simulation():
    done = run("import asphalt_nscd as an\nan.pour({4.0: 9}, (0.06, 0.012, 0.15))")
    assert "ModuleNotFoundError" in done.stderr and "asphalt-nscd[simulation]" in done.stderr


DIAGNOSE = ["data/ncat/N1-1_RH.csv", "--measured-in", "tension-compression", "--draws", "500", "--output"]


def test_the_page_needs_no_matplotlib_and_the_handout_says_that_it_does(tmp_path):
    out = tmp_path / "out"
    done = run(f"from asphalt_nscd.cli import main\nmain(['diagnose', *{DIAGNOSE}, '{out}'])")
    assert done.returncode == 0, done.stderr
    assert done.stdout.endswith("report.pdf, pages to hand on: pip install 'asphalt-nscd[figures]'.\n")
    assert (out / "diagnosis.html").read_text(encoding="utf-8").count("<svg") > 5
    assert (out / "corrected.xlsx").is_file() and not (out / "report.pdf").exists()


def test_mixes_are_compared_without_matplotlib(tmp_path):
    mixes = "data/ncat/N1-1_RH.csv", "data/ncat/N2-1_RH.csv"
    options = "--measured-in", "tension-compression", "--draws", "500", "--output", str(tmp_path)
    done = run(f"from asphalt_nscd.cli import main\nmain(['compare', *{mixes}, *{options}])")
    assert done.returncode == 0, done.stderr
