"""Tests that the example notebooks run in a kernel and show images."""

import runpy
from pathlib import Path

import pytest

nbformat = pytest.importorskip("nbformat")
nbclient = pytest.importorskip("nbclient")
pytest.importorskip("anywidget")

EXAMPLES = Path(__file__).parents[1] / "examples"
MADE = runpy.run_path(str(EXAMPLES / "notebooks.py"))["all_notebooks"]()


def test_notebooks_match_their_programs():
    assert {path.stem for path in EXAMPLES.glob("*.ipynb")} == set(MADE)
    for name, text in MADE.items():
        assert (EXAMPLES / f"{name}.ipynb").read_text() == text, f"run {EXAMPLES / 'notebooks.py'}"


@pytest.mark.parametrize("name", MADE)
def test_each_notebook_runs(name):
    notebook = nbformat.reads(MADE[name], as_version=4)
    nbformat.validate(notebook)
    nbclient.NotebookClient(notebook, timeout=300, kernel_name="python3", resources={"metadata": {"path": EXAMPLES}}).execute()
    shown = [kind for cell in notebook.cells for output in cell.get("outputs", []) for kind in output.get("data", {})]
    assert "image/png" in shown
    if name == "pictures":
        assert "application/vnd.jupyter.widget-view+json" in shown
