"""What a laboratory needs works without the extra `simulation`; what does not says which extra it needs."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[2]
WITHOUT = """
import sys


class Absent:
    def find_spec(self, name, path=None, target=None):
        if name.split(".")[0] in ("numba", "llvmlite", "pyamg", "vtk"):
            raise ModuleNotFoundError(f"No module named {name!r}", name=name.split(".")[0])


sys.meta_path.insert(0, Absent())
"""


def run(program: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run([sys.executable, "-c", WITHOUT + program], cwd=ROOT, capture_output=True, text=True)


def test_a_table_is_read_fitted_and_diagnosed():
    done = run(
        "import asphalt_nscd as an\n"
        "table = an.read('data/ncat/N1-1_RH.csv', measured_in='tension-compression')\n"
        "print(an.fit(table).kind)\n"
        "print(an.diagnose(table, measured_in='tension-compression', draws=an.Draws(500)))\n"
    )
    assert done.stdout.startswith("2s2p1d\nTests "), done.stderr


def test_a_step_of_the_simulation_names_the_extra():
    done = run("from asphalt_nscd.cli import main\nmain(['compile', 'simulate'])")
    assert done.returncode == 2
    assert done.stderr == "error: this step needs numba; pip install 'asphalt-nscd[simulation]'.\n"


def test_so_does_a_function_of_the_simulation():
    done = run("import asphalt_nscd as an\nan.pour({4.0: 9}, (0.06, 0.012, 0.15))")
    assert "No module named 'numba'" in done.stderr and "asphalt-nscd[simulation]" in done.stderr
