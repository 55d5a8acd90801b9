"""Workflows and the action are what GitHub takes, and CI runs `.ci/run` on every Python that drivelint says it supports."""

from __future__ import annotations

import re
import subprocess
import sys
import tomllib
from pathlib import Path
from typing import Any

import pytest
import yaml

from drivelint.guide import FOLDER
from tests.guide.blocks import blocks
from tests.shared_data import ROOT

WORKFLOWS = sorted((ROOT / ".github" / "workflows").iterdir())
ACTION = ROOT / ".github" / "action" / "action.yml"
GUIDE_WORKFLOWS = {
    f"{page.stem}-{block.argument}": block.body
    for page in (FOLDER / "ci.md", FOLDER / "ready-made.md")
    for block in blocks(page)
    if block.word == "workflow" and block.body.startswith("name:")
}
"""The workflows that guides show."""


def faults(kind: str, *files: Path) -> str:
    """Return what GitHub's schema of workflows or actions says against files; '' for nothing. The schemas come with the program."""
    pytest.importorskip("check_jsonschema", reason="check-jsonschema is not installed: pip install check-jsonschema")
    words = [sys.executable, "-m", "check_jsonschema", "--builtin-schema", f"vendor.github-{kind}", *map(str, files)]
    done = subprocess.run(words, check=False, capture_output=True, text=True)
    assert done.returncode in {0, 1}, done.stderr
    return "" if done.returncode == 0 else done.stdout + done.stderr


def workflow(name: str) -> dict[str, Any]:
    text = (ROOT / ".github" / "workflows" / name).read_text(encoding="utf-8")
    told: dict[str, Any] = yaml.load(text, Loader=yaml.BaseLoader)  # noqa: S506 - text only: `on` is no truth value
    return told


def test_workflows_and_action_keep_to_their_schemas(tmp_path: Path) -> None:
    assert len(GUIDE_WORKFLOWS) >= 3
    for name, text in GUIDE_WORKFLOWS.items():
        (tmp_path / f"{name}.yml").write_text(text, encoding="utf-8")
    assert faults("workflows", *WORKFLOWS, *sorted(tmp_path.iterdir())) == ""
    assert faults("actions", ACTION) == ""


def test_the_job_for_gitlab_keeps_to_its_schema_and_reports_as_junit(tmp_path: Path) -> None:
    (job,) = (block.body for block in blocks(FOLDER / "ready-made.md") if block.mark == "workflow: gitlab")
    (tmp_path / ".gitlab-ci.yml").write_text(job, encoding="utf-8")
    assert yaml.safe_load(job)["drives"]["artifacts"]["reports"] == {"junit": "results/junit.xml"}
    pytest.importorskip("check_jsonschema", reason="check-jsonschema is not installed: pip install check-jsonschema")
    words = [
        sys.executable,
        "-m",
        "check_jsonschema",
        "--builtin-schema",
        "vendor.gitlab-ci",
        "--data-transform",
        "gitlab-ci",
    ]
    done = subprocess.run([*words, str(tmp_path / ".gitlab-ci.yml")], check=False, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr


@pytest.mark.ci
def test_a_workflow_that_github_refuses_is_a_fault(tmp_path: Path) -> None:
    text = (ROOT / ".github" / "workflows" / "ci.yml").read_text(encoding="utf-8")
    for right, wrong in (("runs-on:", "runs_on:"), ("steps:", "step:"), ("- run: .ci/run", "- runs: .ci/run")):
        assert right in text
        (tmp_path / "wrong.yml").write_text(text.replace(right, wrong), encoding="utf-8")
        assert faults("workflows", tmp_path / "wrong.yml"), wrong


def test_ci_runs_on_every_python_of_the_classifiers() -> None:
    job = workflow("ci.yml")["jobs"]["run"]
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    pythons = re.findall(r"Python :: (3\.\d+)'", str(project["classifiers"]))
    assert job["strategy"]["matrix"]["python"] == pythons
    assert project["requires-python"] == f">={pythons[0]}"
    setup, line = job["steps"][-2:]
    assert setup["with"] == {"python-version": "${{ matrix.python }}"}
    # the script calls it `python3`, which is what setup-python puts first
    assert line == {"run": ".ci/run"}
    script = (ROOT / ".ci" / "run").read_text(encoding="utf-8")
    assert not re.search(r"python3\.\d", script + (ROOT / "README.md").read_text(encoding="utf-8").partition("![")[0])


@pytest.mark.parametrize("file", [*WORKFLOWS, ACTION], ids=lambda file: file.name)
def test_what_others_wrote_is_pinned_to_a_major_version(file: Path) -> None:
    used = re.findall(r"uses: *(\S+)", file.read_text(encoding="utf-8"))
    assert used
    assert [name for name in used if not re.fullmatch(r"actions/[\w-]+@v\d+", name)] == []
