"""The notebooks run from top to bottom, and show what their text says."""

from __future__ import annotations

from pathlib import Path

import nbformat
import pytest
from nbclient import NotebookClient

NOTEBOOKS = Path(__file__).parents[2] / "notebooks"
SHOWN = {  # in some output
    "diagnosis": ["channel_delay", "0.000787", "Mix-B", "2S2P1D", "71 tests used"],
    "forecast": [
        "Forecast(HMA H0: 20 points",
        "the modulus of the aggregate, x 1.25",
        "factor, rms",
        "in the band",
    ],
    "specimen": ["Packing(700 spheres", "bonds by facets", "E_law_MPa", "0.02943", "0.00981"],
}
PICTURES = {"diagnosis": 2, "forecast": 2, "specimen": 1}


def test_each_notebook_is_checked():
    assert {path.stem for path in NOTEBOOKS.glob("*.ipynb")} == set(SHOWN)


@pytest.mark.slow
@pytest.mark.parametrize("name", SHOWN)
def test_notebook_runs(name):
    notebook = nbformat.read(NOTEBOOKS / f"{name}.ipynb", as_version=4)
    code = [cell for cell in notebook.cells if cell.cell_type == "code"]
    assert not any(cell.outputs or cell.execution_count for cell in code), (
        "save notebooks without their outputs"
    )
    NotebookClient(notebook, timeout=300, resources={"metadata": {"path": str(NOTEBOOKS)}}).execute()
    data = [output.data for cell in code for output in cell.outputs if "data" in output]
    text = "\n".join(str(value) for one in data for kind, value in one.items() if kind != "image/png")
    for words in SHOWN[name]:
        assert words in text, words
    assert sum("image/png" in one for one in data) == PICTURES[name]
