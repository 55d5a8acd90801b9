"""What keeps the code findable: no circle between files, no long file, no crowded folder. `lint-imports` holds the layers."""

from __future__ import annotations

import ast
import re
import subprocess
from collections import Counter
from graphlib import TopologicalSorter
from pathlib import Path

import grimp
import pytest

from drivelint.resources import folder

SOURCE = Path(__file__).resolve().parents[1] / "src" / "drivelint"
FILES = sorted(SOURCE.rglob("*.py"))


def test_no_circle_between_files() -> None:
    graph = grimp.build_graph("drivelint", cache_dir=None)
    imports = {module: graph.find_modules_directly_imported_by(module) for module in graph.modules}
    assert len(imports) == len(FILES)
    TopologicalSorter(imports).prepare()  # raises CycleError, which names the circle


def test_no_file_over_400_lines() -> None:
    lines = {str(file.relative_to(SOURCE)): len(file.read_text(encoding="utf-8").splitlines()) for file in FILES}
    assert {name: n for name, n in lines.items() if n > 400} == {}


def test_no_folder_of_more_than_twenty_files() -> None:
    n = Counter(file.parent for file in FILES if file.name != "__init__.py")
    assert {str(folder.relative_to(SOURCE)): files for folder, files in n.items() if files > 20} == {}


def test_no_test_file_imports_another() -> None:
    """What several tests use stands in a file that is no test."""
    tests = SOURCE.parents[1] / "tests"
    files = sorted(tests.rglob("*.py"))
    modules = {file.stem for file in files if file.name.startswith("test_")}
    # to parse them all takes seconds
    statement = re.compile(r"^\s*from (tests[\w.]*) import (\([^)]*\)|.*)$", re.MULTILINE)
    for file in files:
        for source, names in statement.findall(file.read_text(encoding="utf-8")):
            named = {*source.split("."), *re.findall(r"\w+", names)} - {file.stem}
            assert not named & modules, f"{file.relative_to(tests)} imports from {source}"


def test_no_report_knows_a_rule_by_its_id() -> None:
    """What a report must know of a rule is a tag in the rule's header."""
    ids = {f"{file.parent.name}.{file.stem}" for file in (folder("queries") / "assertions").glob("*/*.sql")}
    for place in ("report", "annotate", "result", "gate", "engine", "evaluate"):
        for file in sorted((SOURCE / place).rglob("*.py")):
            constants = [
                node.value
                for node in ast.walk(ast.parse(file.read_text(encoding="utf-8")))
                if isinstance(node, ast.Constant)
            ]
            assert not ids & {value for value in constants if isinstance(value, str)}, file.name


def test_nothing_else_stands_at_the_top() -> None:
    """Files of the work tree that git does not know, such as an environment, do not count."""
    root = SOURCE.parents[1]
    told = subprocess.run(["git", "ls-files"], cwd=root, capture_output=True, text=True, check=False)
    if told.returncode:
        pytest.skip("this is no git checkout")
    entries = {name.partition("/")[0] for name in told.stdout.splitlines()}
    folders = {"src", "schemas", "queries", "tests", "fixtures", "findings"}
    files = {"pyproject.toml", "README.md", "LICENSE", "CHANGELOG.md", "CONTRIBUTING.md"}
    assert {name for name in entries if not name.startswith(".")} == folders | files
