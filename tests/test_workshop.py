"""The workshop keeps its promises: README's commands are those that CI runs, the fixture is what its script makes."""

from __future__ import annotations

import re
import runpy
import shlex
from pathlib import Path
from typing import Any

import pytest
from typer.main import get_command

from drivelint import cli
from drivelint import demo as demo_files
from tests.guide.blocks import PAGES, shell_lines
from tests.shared_data import ROOT

README = (ROOT / "README.md").read_text(encoding="utf-8")


def command(name: str) -> str:
    """Return the code block of README after the marker `<!-- command: name -->`."""
    found = re.search(rf"^<!-- command: {name} -->\n```sh\n(.+?)\n```$", README, re.MULTILINE | re.DOTALL)
    assert found, f"README.md has no command {name!r}"
    return found[1]


def test_the_first_two_commands_of_the_readme_run_and_test() -> None:
    blocks = re.findall(r"^```sh\n(.+?)\n```$", README, re.MULTILINE | re.DOTALL)
    assert blocks[:2] == [command("run"), command("test")]


@pytest.mark.parametrize("name", ["run", "test"])
def test_a_command_is_one_line_that_leaves_the_systems_python_alone(name: str) -> None:
    line = command(name)
    assert "\n" not in line
    assert line.startswith("python3 -m venv --without-pip .venv && python3 -m pip --python .venv install ")
    assert "break-system-packages" not in line
    assert "sudo" not in line


def test_the_first_command_checks_the_demo_as_the_demo_says() -> None:
    install, demo, check = command("run").split(" && ", 1)[1].split(" && ")
    assert install.endswith(" install -q .")
    assert demo == ".venv/bin/drivelint demo"
    shown = demo_files.check_command(Path("demo"), "drivelint").partition(" ")[2]
    assert check == f".venv/bin/drivelint {shown}"
    assert f"`{shown.rpartition(' ')[2]}/report.html`" in README


def test_the_readme_says_what_it_is_then_how_to_try_it_then_shows_it() -> None:
    lines = README.splitlines()
    assert len(lines) <= 90
    about = README.partition("\n\n")[2].partition("\n\n")[0]
    assert len(about.splitlines()) == 3
    places = [README.index(mark) for mark in ("<!-- command: run -->", "<!-- command: test -->", "![", "## ")]
    assert places == sorted(places)


def test_the_pictures_are_small() -> None:
    pictures = [
        page.parent / picture
        for page in PAGES
        for picture in re.findall(r"^!\[.+?\]\((.+?)\)$", page.read_text(encoding="utf-8"), re.MULTILINE)
    ]
    assert len(pictures) == 2
    assert all(picture.stat().st_size < 300_000 for picture in pictures)


def test_the_command_line_takes_every_line_that_readme_and_guides_show() -> None:
    lines = [line for page in PAGES for line in shell_lines(page)]
    assert len(lines) > 20
    for line in lines:
        called: Any = get_command(cli.app)
        _, *words = shlex.split(line.split(" > ")[0], comments=True)
        while hasattr(called, "commands"):
            called = called.commands[words.pop(0)]
        called.make_context(called.name, words)  # parses, runs nothing


def test_ci_takes_the_test_command_from_the_readme_and_every_mark_has_its_run() -> None:
    script = (ROOT / ".ci" / "run").read_text(encoding="utf-8")
    assert "<!-- command: test -->" in script
    assert "pytest" in command("test")
    for tool in (
        "ruff check",
        "ruff format --check",
        "mypy",
        "lint-imports",
        'pytest -n 2 --dist loadfile -m "ci and not slow"',
    ):
        assert f"step .venv/bin/{tool}" in script
    assert script.count(".venv/bin/pytest") == 1
    full = (ROOT / ".ci" / "full").read_text(encoding="utf-8")
    everything = 'pytest -n 2 --dist loadfile -m "" --hypothesis-profile thorough'
    for tool in (everything, "drivelint rules test\n", "drivelint rules test --mutate"):
        assert f"step .venv/bin/{tool}" in full


def test_the_fixture_is_what_its_script_makes() -> None:
    folder = ROOT / "fixtures" / "overtake"
    for name, content in runpy.run_path(str(folder / "make.py"))["files"]().items():
        assert (folder / name).read_text(encoding="utf-8") == content, f"{name}: run python fixtures/overtake/make.py"
