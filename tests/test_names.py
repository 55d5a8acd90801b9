"""Names in the product and in its tests are nouns and verbs: none is a bare participle or pronoun.

It holds for functions, parameters, classes, fields, modules and constants, and in the product also for locals.
"""

from __future__ import annotations

import ast
import re
from typing import TYPE_CHECKING, Any

import pytest

from tests.shared_data import ROOT

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

VERBS = frozenset({"cut", "put", "read", "set", "split"})
"""As the name of a function these are what it does."""
_PARTICIPLES = """
    added allowed asked called changed checked chosen closed counted cut deaf done drawn driven expected found given gone grouped held
    joined judged kept known lost made meant measured merged missing moved named needed opened placed printed put read refused removed
    said seen set shown sorted split taken told wanted written
"""
_PRONOUNS = """
    all any anybody anything both each everybody everything few he it many mine most nobody none nothing one ones other others ours own
    she somebody something such that them these they this those what which who whom whose
"""
BARE = frozenset((_PARTICIPLES + _PRONOUNS).split())
IN_TESTS = BARE - {"expected"}  # the usual name of the parameter that a test compares with
PRODUCT = "src/drivelint"
ROOTS = ((PRODUCT, BARE), ("tests", IN_TESTS))


def folders() -> Iterator[Any]:
    """Yield what lies in the roots, a folder or a file each: its files, and the words that are no names there."""
    for root, bare in ROOTS:
        for path in sorted((ROOT / root).iterdir()):
            files = sorted(path.rglob("*.py")) if path.is_dir() else [path] * (path.suffix == ".py")
            if files:
                yield pytest.param(files, bare, id=path.relative_to(ROOT).as_posix())


def names(path: Path) -> Iterator[tuple[int, str, bool]]:
    """Yield line, name and whether it is a function's, of all that a module defines but for its locals."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    yield 1, path.stem, False
    for node in ast.walk(tree):
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            yield node.lineno, node.name, True
            of = node.args
            given = [*of.posonlyargs, *of.args, *of.kwonlyargs, *filter(None, (of.vararg, of.kwarg))]
            yield from ((argument.lineno, argument.arg, False) for argument in given)
        elif isinstance(node, ast.Module | ast.ClassDef):
            if isinstance(node, ast.ClassDef):
                yield node.lineno, node.name, False
            for line in node.body:
                targets = (
                    line.targets
                    if isinstance(line, ast.Assign)
                    else [line.target]
                    if isinstance(line, ast.AnnAssign)
                    else []
                )
                yield from ((target.lineno, target.id, False) for target in targets if isinstance(target, ast.Name))


def locals_of(path: Path) -> Iterator[tuple[int, str]]:
    """Yield line and name of all that a module assigns anywhere, with the variables of comprehensions and parameters of lambdas."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store):
            yield node.lineno, node.id
        elif isinstance(node, ast.arg):
            yield node.lineno, node.arg


def is_bare(name: str, bare: frozenset[str] = BARE, *, of_function: bool) -> bool:
    word = re.sub(r"^_+|_+$", "", name).lower()
    return not name.startswith("__") and word in bare and not (of_function and word in VERBS)


@pytest.mark.parametrize(
    ("name", "of_function", "expected"),
    [
        ("found", False, True),
        ("_told", True, True),
        ("read", True, False),
        ("read", False, True),
        ("found_lanes", False, False),
        ("__all__", False, False),
        ("NAMED", False, True),
    ],
)
def test_what_is_bare(name: str, of_function: bool, expected: bool) -> None:
    assert is_bare(name, of_function=of_function) is expected


def test_expected_is_a_name_in_tests_alone() -> None:
    assert [is_bare("expected", bare, of_function=False) for _, bare in ROOTS] == [True, False]


@pytest.mark.parametrize(("files", "bare"), list(folders()))
def test_no_name_is_a_bare_participle_or_pronoun(files: list[Path], bare: frozenset[str]) -> None:
    assert not [
        f"{path.relative_to(ROOT)}:{line} {name}"
        for path in files
        for line, name, of_function in names(path)
        if is_bare(name, bare, of_function=of_function)
    ]


@pytest.mark.parametrize(
    "files", [pytest.param(*param.values[:1], id=param.id) for param in folders() if param.id.startswith(PRODUCT)]
)
def test_no_local_of_the_product_is_a_bare_participle_or_pronoun(files: list[Path]) -> None:
    assert not [
        f"{path.relative_to(ROOT)}:{line} {name}"
        for path in files
        for line, name in locals_of(path)
        if is_bare(name, of_function=False)
    ]


def test_locals_are_all_that_is_assigned(tmp_path: Path) -> None:
    path = tmp_path / "a.py"
    path.write_text("def f(a):\n    b = [c for c in a]\n    for d in b: pass\n    return lambda e: (g := e)\n", "utf-8")
    assert {name for _, name in locals_of(path)} == set("abcdeg")
