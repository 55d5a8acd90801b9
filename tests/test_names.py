"""Names of functions, parameters, classes, fields, modules and constants are nouns and verbs: none is a bare participle or pronoun."""

from __future__ import annotations

import ast
import re
from typing import TYPE_CHECKING

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
FILES = sorted((ROOT / "src/drivelint").rglob("*.py"))


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


def is_bare(name: str, *, of_function: bool) -> bool:
    word = re.sub(r"^_+|_+$", "", name).lower()
    return not name.startswith("__") and word in BARE and not (of_function and word in VERBS)


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


@pytest.mark.parametrize("folder", sorted({path.relative_to(ROOT / "src/drivelint").parts[0] for path in FILES}))
def test_no_name_is_a_bare_participle_or_pronoun(folder: str) -> None:
    mine = [path for path in FILES if path.relative_to(ROOT / "src/drivelint").parts[0] == folder]
    assert not [
        f"{path.relative_to(ROOT)}:{line} {name}"
        for path in mine
        for line, name, of_function in names(path)
        if is_bare(name, of_function=of_function)
    ]
