"""The workshop keeps its promises: README's commands are those that CI runs, the fixture is what its script makes."""

from __future__ import annotations

import re
import runpy
import shlex

import pytest

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


def test_the_first_command_names_files_that_are_there() -> None:
    words = shlex.split(command("run"))
    paths = [word for word in words if word.startswith("fixtures/")]
    assert len(paths) == 3
    assert all(list(ROOT.glob(path)) for path in paths)


def test_ci_takes_the_test_command_from_the_readme() -> None:
    script = (ROOT / ".ci" / "run").read_text(encoding="utf-8")
    assert "<!-- command: test -->" in script
    assert ".venv/bin/pytest" not in script
    assert "pytest" in command("test")
    for tool in ("ruff check", "ruff format --check", "mypy", "lint-imports"):
        assert f"step .venv/bin/{tool}" in script


def test_the_fixture_is_what_its_script_makes() -> None:
    folder = ROOT / "fixtures" / "overtake"
    for name, content in runpy.run_path(str(folder / "make.py"))["files"]().items():
        assert (folder / name).read_text(encoding="utf-8") == content, f"{name}: run python fixtures/overtake/make.py"


def test_the_changelog_has_a_heading_for_rules() -> None:
    assert "\n### Rules\n" in (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
