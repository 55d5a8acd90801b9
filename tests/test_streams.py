"""What stdout and stderr do not take ends in no traceback, and a log's words steer no terminal."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from drivelint.phrases import terminal_safe, terminal_safe_line
from tests.shared_data import ROOT

COMMAND = [sys.executable, "-m", "drivelint"]
ENV = {**os.environ, "PYTHONPATH": str(ROOT / "src"), "COLUMNS": "120"}
HOSTILE = "\x1b]0;t\x07\x1b[31m\n::error::x\r##[error]y\u202e\x9b1m"


def test_a_reader_that_leaves_is_no_error() -> None:
    with subprocess.Popen([*COMMAND, "rules", "list"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, env=ENV) as run:
        assert run.stdout
        assert run.stderr
        run.stdout.close()
        assert run.stderr.read() == b""
    assert run.returncode == 141


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="there is no /dev/full here")
def test_a_full_stdout_is_told_in_one_line() -> None:
    with Path("/dev/full").open("w") as full:
        for args in (["rules", "list"], ["--version"]):
            done = subprocess.run(
                [*COMMAND, *args], stdout=full, stderr=subprocess.PIPE, check=False, env=ENV, text=True
            )
            assert (done.returncode, done.stderr) == (
                75,
                "drivelint: error: stdout cannot be written: No space left on device\n",
            )
        assert subprocess.run([*COMMAND, "nonsense"], stderr=full, check=False, env=ENV).returncode == 2


def assert_inert(text: str) -> None:
    assert not {char for char in text if ord(char) < 32 and char != "\n"} | (set(text) & {"\x9b", "\u202e", "\x7f"})
    assert not [line for line in text.split("\n") if line.lstrip().startswith("::") or "##[" in line]


def test_words_that_steer_a_terminal_are_shown() -> None:
    assert_inert(terminal_safe(HOSTILE))
    assert terminal_safe_line(HOSTILE) == r"\x1b]0;t\x07\x1b[31m ::error::x #\#[error]y\u202e\x9b1m"
    assert terminal_safe("a: b\n  ::warning::") == "a: b\n  :\\:warning::"
    assert terminal_safe("Straße 1 \u2192 2 \u00b7 3") == "Straße 1 \u2192 2 \u00b7 3"


@pytest.mark.ci
@pytest.mark.skipif(os.name != "posix", reason="files cannot have such names")
def test_a_hostile_file_name_and_id_is_text_on_the_terminal(tmp_path: Path) -> None:
    text = (ROOT / "fixtures" / "overtake" / "collision.csv").read_text(encoding="utf-8")
    hostile = HOSTILE.replace("\x9b", "")
    log = tmp_path / f"{hostile}.csv"
    log.write_text(
        text.replace("oncoming", '"' + hostile.replace("\n", " ").replace("\r", " ") + '"'), encoding="utf-8"
    )
    (tmp_path / f"{hostile}2.csv").write_text("no table", encoding="utf-8")
    road = ["--map", str(ROOT / "fixtures" / "overtake" / "road.xodr"), "--rules", "ukhc.no-collision"]
    road += ["--mapping", str(ROOT / "fixtures" / "overtake" / "mapping.toml"), "--no-robustness"]
    for args in (
        ["check", str(log), str(tmp_path / f"{hostile}2.csv"), *road, "--verbose"],
        ["check", str(log) + "3", *road],
    ):
        done = subprocess.run([*COMMAND, *args], capture_output=True, check=False, env=ENV)
        assert b"\r" not in done.stdout + done.stderr
        assert_inert(done.stdout.decode() + done.stderr.decode())
        assert b"error" in done.stdout + done.stderr
