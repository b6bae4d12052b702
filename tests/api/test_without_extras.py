"""What a laboratory needs works without extras; what does not says which extra it needs."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

pytestmark = pytest.mark.slow

ROOT = Path(__file__).parents[2]
OF_EXTRAS = "numba", "llvmlite", "pyamg", "vtk", "flask"
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
        "print(made.plot_black().axes[0].get_title(loc='left'))\n"
    )


def test_a_table_is_read_fitted_and_diagnosed(diagnosed):
    assert diagnosed.stdout.startswith("2s2p1d\nTests "), diagnosed.stderr
    assert diagnosed.stdout.endswith("Black diagram\n")


def test_a_step_of_the_simulation_names_the_extra():
    done = run("from asphalt_nscd.cli import main\nmain(['compile', 'simulate'])")
    assert done.returncode == 2
    assert done.stderr == "error: this step needs numba; pip install 'asphalt-nscd[simulation]'.\n"


def test_so_does_a_function_of_the_simulation():
    done = run("import asphalt_nscd as an\nan.pour({4.0: 9}, (0.06, 0.012, 0.15))")
    assert "ModuleNotFoundError" in done.stderr and "asphalt-nscd[simulation]" in done.stderr
