"""A real notebook, from empty to a plot: what the cells of the guide show in a kernel of their own."""

from __future__ import annotations

import base64
import os
import sys
from pathlib import Path
from typing import Any

import pytest

from drivelint import demo
from drivelint.guide import FOLDER
from tests.guide.blocks import blocks
from tests.shared_data import ROOT

nbclient: Any = pytest.importorskip("nbclient", reason="nbclient is not installed (pip install nbclient)")
nbformat: Any = pytest.importorskip("nbformat")
pytest.importorskip("ipykernel", reason="ipykernel is not installed (pip install ipykernel)")

PROGRAMS = {block.argument: block.body for block in blocks(FOLDER / "python.md") if block.language == "python"}


def run(folder: Path, *cells: str, allow_errors: bool = False) -> list[list[dict[str, Any]]]:
    """Run the cells in a new notebook; return the outputs of each. With `allow_errors`, a cell may raise an error."""
    notebook = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(cell) for cell in cells])
    execute(notebook, folder, allow_errors=allow_errors)
    return [cell.outputs for cell in notebook.cells]


def execute(notebook: Any, folder: Path, *, allow_errors: bool = False) -> None:
    """Run all cells of a notebook in a folder, in a kernel of its own that finds this drivelint first."""
    path = os.pathsep.join([str(ROOT / "src"), os.environ.get("PYTHONPATH", "")])
    commands = os.pathsep.join([str(Path(sys.executable).parent), os.environ["PATH"]])
    where = {"metadata": {"path": str(folder)}}
    client = nbclient.NotebookClient(notebook, timeout=120, resources=where, allow_errors=allow_errors)
    client.execute(env={**os.environ, "PYTHONPATH": path, "PATH": commands})


def streams(outputs: list[dict[str, Any]]) -> dict[str, str]:
    told: dict[str, str] = {}
    for each in outputs:
        if each["output_type"] == "stream":
            told[each["name"]] = told.get(each["name"], "") + each["text"]
    return told


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    demo.write(tmp_path / "demo")
    return tmp_path


@pytest.mark.slow
def test_the_guides_programs_run_as_a_notebook(folder: Path) -> None:
    pytest.importorskip("matplotlib", reason="matplotlib is not installed (pip install matplotlib)")
    assert list(PROGRAMS) == ["gap.py", "headway.py", "timeline.py", "plot.py", "room.py", "speeds.py", "way.py"]
    first, _, _, plot, room, speeds, way, result, table = run(folder, *PROGRAMS.values(), "r", "r.findings")
    assert streams(first).keys() == {"stdout"}, "no progress, no warning"
    assert (folder / "report.html").read_text("utf-8").startswith("<!doctype html>")
    (picture,) = (each["data"]["image/png"] for each in plot if "image/png" in each.get("data", {}))
    assert base64.b64decode(picture).startswith(b"\x89PNG")
    assert (folder / "overlap.png").stat().st_size > 5000
    assert any("image/png" in each.get("data", {}) for each in room)
    assert any("image/png" in each.get("data", {}) for each in way)
    assert (folder / "way.png").stat().st_size > 5000
    assert streams(speeds)["stdout"].splitlines()[1] == "nominal,7.70,3,5.22,5.22"
    (shown,) = result
    assert "FAIL 1 critical" in shown["data"]["text/html"]
    assert "ukhc.r162.safe-distance-ahead [observed]" in shown["data"]["text/html"]
    assert "closing_mps" in table[0]["data"]["text/html"]


@pytest.mark.ci
def test_progress_is_drawn_under_the_cell(folder: Path) -> None:
    """Without ipywidgets, which rich would want, and warns of at each step."""
    asked = "r = drivelint.check('demo/safe.mcap', map='demo/road.xodr', rules='ukhc.no-collision', progress=True)"
    (outputs,) = run(folder, f"import drivelint\n{asked}")
    assert {each["output_type"] for each in outputs} == {"stream"}
    assert "checking" in streams(outputs)["stderr"]
    assert "1/1" in streams(outputs)["stderr"]
    assert "ipywidgets" not in streams(outputs)["stderr"]


@pytest.mark.ci
def test_an_error_stops_a_cell_and_not_the_kernel(folder: Path) -> None:
    caught = "try:\n    drivelint.check('nowhere.mcap')\nexcept drivelint.DriveLintError as error:\n    print(error)"
    first, second = run(folder, f"import drivelint\n{caught}", "print('still there')")
    assert streams(first) == {"stdout": "nowhere.mcap: no such file or folder: check the path\n"}
    assert streams(second) == {"stdout": "still there\n"}


@pytest.mark.ci
def test_an_error_is_a_line_and_its_traceback_is_there(folder: Path) -> None:
    shown, again = run(folder, "import drivelint\ndrivelint.check('nowhere.mcap')", "%tb", allow_errors=True)
    (error,) = (each for each in shown if each["output_type"] == "error")
    line = "nowhere.mcap: no such file or folder: check the path"
    assert error["traceback"] == [f"{error['ename']}: {line} (%tb shows the traceback)"]
    (error,) = (each for each in again if each["output_type"] == "error")
    assert error["traceback"][0].startswith("Traceback (most recent call last)")
    assert "drivelint.check('nowhere.mcap')" in "".join(error["traceback"])
    assert error["traceback"][-1].endswith(f"{line}\n")


@pytest.mark.ci
def test_the_notebook_of_the_fixtures_runs_in_an_empty_folder(tmp_path: Path) -> None:
    """It has an audit too: DuckDB 1.5.5 refuses to turn its progress bar off in a notebook without ipywidgets."""
    pytest.importorskip("matplotlib", reason="matplotlib is not installed (pip install matplotlib)")
    notebook = nbformat.read(ROOT / "fixtures" / "notebooks" / "first-steps.ipynb", 4)
    nbformat.validate(notebook)
    assert not any(cell.get("outputs") for cell in notebook.cells), "it is kept without outputs"
    execute(notebook, tmp_path)
    outputs = {cell.id: cell.outputs for cell in notebook.cells if cell.cell_type == "code"}
    assert "FAIL 1 critical" in outputs["check"][0]["data"]["text/html"]
    assert "&lt;svg" in outputs["timeline"][0]["data"]["text/html"]
    assert "ukhc.r162.safe-distance-ahead" in streams(outputs["explain"])["stdout"]
    assert "6 judged" in streams(outputs["audit"])["stdout"]
    (rates,) = outputs["rates"]
    assert "ukhc.contact-signature" in rates["data"]["text/html"]
    assert any("image/png" in each.get("data", {}) for each in outputs["plot"])
