"""Annotated logs opened by programs that this project did not write: Rerun, and the reader that Foxglove's own viewer has."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
from collections import Counter
from pathlib import Path

import pytest

from tests.annotate.files import seeking
from tests.annotate.runs import CASE, run, the

SCRIPT = Path(__file__).with_name("read_with_mcap_core.cjs")


pytestmark = pytest.mark.ci


@pytest.fixture(scope="module")
def path(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return the(run(tmp_path_factory.mktemp("read"), CASE / "collision.csv"), "collision")


def test_mcap_core_reads_every_message(path: Path) -> None:
    """Node finds its packages by NODE_PATH: npm install @mcap/core @mcap/nodejs @mcap/support."""
    node = shutil.which("node")
    if node is None:
        pytest.skip("node is not installed")
    packages = "['@mcap/core', '@mcap/nodejs', '@mcap/support'].forEach(require)"
    if subprocess.run([node, "-e", packages], capture_output=True, env=os.environ, check=False).returncode:
        pytest.skip("the npm packages @mcap/core, @mcap/nodejs and @mcap/support are not in NODE_PATH")
    read = subprocess.run([node, str(SCRIPT), str(path)], capture_output=True, text=True, check=True)
    messages: Counter[str] = Counter()
    size: Counter[str] = Counter()
    for topic, *_, data in seeking(path):
        messages[topic] += 1
        size[topic] += len(data)
    assert json.loads(read.stdout) == {topic: {"messages": n, "bytes": size[topic]} for topic, n in messages.items()}


def test_rerun_reads_every_topic(path: Path, tmp_path: Path) -> None:
    """It shows poses and log lines as such, keeps the fields of scenes and events, and JSON as bytes."""
    rerun = shutil.which("rerun", path=os.pathsep.join([str(Path(sys.executable).parent), os.environ.get("PATH", "")]))
    if rerun is None:
        pytest.skip("the package rerun-sdk is not installed")
    target = tmp_path / "log.rrd"
    home = {**os.environ, "HOME": str(tmp_path), "XDG_CONFIG_HOME": str(tmp_path)}
    for command in (["mcap", "check", str(path)], ["mcap", "convert", str(path), "-o", str(target)]):
        done = subprocess.run([rerun, *command], capture_output=True, text=True, env=home, check=False)
        assert done.returncode == 0, done.stderr
        assert "ERROR" not in done.stderr
    printed = subprocess.run([rerun, "rrd", "print", str(target)], capture_output=True, text=True, env=home, check=True)
    messages = seeking(path)
    n = Counter(topic for topic, *_ in messages)
    columns = {"foxglove.FrameTransform": "Transform3D:translation", "foxglove.Log": "TextLog:text"}
    for topic, schema in {(topic, schema) for topic, schema, *_ in messages}:
        said = [line for line in printed.stdout.splitlines() if f" - {topic} - " in line and "McapChannel" not in line]
        rows = [re.search(r" with ([\d_,\u2009]+) rows", line) for line in said]
        assert sum(int(re.sub(r"\D", "", found[1])) for found in rows if found) == n[topic]
        expected = "McapMessage:data" if schema.startswith("drivelint.") else columns.get(schema, f"{schema}:message")
        assert all(expected in line for line in said), topic
