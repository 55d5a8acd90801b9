"""The manifests of the guide, run as their schedulers would run them."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
import yaml

from drivelint.audit import merge
from drivelint.guide import __file__ as guide
from drivelint.report.progress import Silent
from tests.audit import fleet
from tests.audit.here import run_audit

pytestmark = pytest.mark.ci

N_DRIVES = 9


def _block(name: str) -> str:
    text = Path(guide).with_name("fleet-machines.md").read_text(encoding="utf-8")
    found = re.search(rf"<!-- shards: {name} -->\n```\w+\n(.*?)```", text, re.DOTALL)
    assert found is not None
    return found[1]


def _kubernetes() -> tuple[list[str], str, int]:
    job = yaml.safe_load(_block("kubernetes"))["spec"]
    assert job["completionMode"] == "Indexed"
    assert job["podFailurePolicy"]["rules"][0]["onExitCodes"]["values"] == [2, 4]
    (container,) = job["template"]["spec"]["containers"]
    return container["command"], "JOB_COMPLETION_INDEX", 0


def _slurm() -> tuple[list[str], str, int]:
    return ["sh", "-c", _block("slurm")], "SLURM_ARRAY_TASK_ID", 1


@pytest.mark.sample(1)
@pytest.mark.parametrize("scheduler", [_kubernetes, _slurm])
def test_the_parts_of_a_manifest_are_the_whole(
    scheduler: object, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    command, variable, first = scheduler()  # type: ignore[operator]
    drives = fleet.write(tmp_path / "fleet", N_DRIVES)
    program = tmp_path / "bin" / "drivelint"
    program.parent.mkdir()
    program.write_text(
        f'#!/bin/sh\nexec "{sys.executable}" -m drivelint "$@" --workers 1 --rules {fleet.RULE} --memory 200MB\n',
        encoding="ascii",
    )
    program.chmod(0o755)
    about = {"SOURCE": str(drives.manifest), "MAP": str(drives.road), "DEST": str(tmp_path / "out")}
    about["PATH"] = f"{program.parent}:{os.environ['PATH']}"
    for n in range(first, first + 3):
        done = subprocess.run(
            command, env={**os.environ, **about, variable: str(n)}, capture_output=True, text=True, check=False
        )
        assert done.returncode == 0, done.stderr
    assert merge(about["DEST"], Silent()).digest == run_audit(drives, tmp_path / "whole").digest
