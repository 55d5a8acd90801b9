"""The help in groups, and what a shell completes."""

from __future__ import annotations

import os
import re
import subprocess
import sys

import pytest
import typer

from drivelint import cli
from drivelint.catalogue import load_rules
from tests.shared_data import ROOT


def drivelint(*args: str, **environment: str) -> str:
    done = subprocess.run(
        [sys.executable, "-c", "from drivelint.cli import main; main()", *args],
        capture_output=True,
        text=True,
        check=False,
        env={**os.environ, "PYTHONPATH": str(ROOT / "src"), "COLUMNS": "80", **environment},
    )
    assert not done.stderr, done.stderr
    return done.stdout


def completed(*words: str) -> list[str]:
    """Return what bash offers for the last word."""
    variables = {"COMP_WORDS": " ".join(words), "COMP_CWORD": str(len(words) - 1)}
    code = "import sys; sys.argv = ['drivelint']; from drivelint.cli import main; main()"
    done = subprocess.run(
        [sys.executable, "-c", code],
        capture_output=True,
        text=True,
        check=False,
        env={**os.environ, "PYTHONPATH": str(ROOT / "src"), "_DRIVELINT_COMPLETE": "complete_bash", **variables},
    )
    return done.stdout.split()


def test_the_help_of_check_has_every_option_once_under_its_heading() -> None:
    text = drivelint("check", "--help")
    assert max(map(len, text.splitlines())) <= 80
    blocks = re.split(r"^(\w[\w ]*):$", text, flags=re.MULTILINE)
    sections = dict(zip(blocks[1::2], blocks[2::2], strict=True))
    assert list(sections) == ["Arguments", "Input", "Rules", "Gate", "Output", "Other options"]
    shown = {name: re.findall(r"^  (?:-\w, )?(--[\w-]+)", part, re.MULTILINE) for name, part in sections.items()}
    every = [flag for flags in shown.values() for flag in flags]
    check = typer.main.get_command(cli.app).commands["check"]  # type: ignore[attr-defined]
    wanted = {max(p.opts, key=len) for p in check.params if p.param_type_name == "option"} | {"--help"}
    assert sorted(every) == sorted(wanted)
    assert {"--map", "--env"} <= set(shown["Input"])
    assert {"--fail-on", "--strict", "--require", "--baseline", "--waivers"} <= set(shown["Gate"])


@pytest.mark.ci
def test_a_shell_completes_commands_options_and_rules() -> None:
    assert "check" in completed("drivelint", "ch")
    assert completed("drivelint", "check", "--req") == ["--require"]
    ids = [name for name in load_rules() if name.startswith("ukhc.r162.")]
    assert len(ids) > 1
    for words in (["check", "--rules"], ["check", "--require"], ["rules", "show"], ["explain"]):
        assert completed("drivelint", *words, "ukhc.r162.") == ids, words


def test_completion_can_be_installed() -> None:
    assert "--install-completion" in drivelint("--help")
    assert "COMPLETE=complete_bash" in drivelint("--show-completion", "bash")
