"""`python -m tests.texts KIND N SEED`: draws texts for a reader who does not know the code, without the code around them.

KIND is names (of functions, parameters, classes and constants), docstrings, paragraphs (of the guides) or messages (of errors). The
release asks that at most 3 of 100 are not understood at first reading. Two persons measure this:

* The reader is an engineer of automated driving who sees the list alone. For each item the reader writes one line in own words, at the
  first reading: what a name roughly returns, does or is; what a text says and what one has to do.
* The checker compares each line with the code. An item is not understood if the reader could not write a line, or if the line is wrong
  in the main thing: whoever acts on it would err. A line that is coarser than the code is right. For a name, the details of a parameter
  or the inner form of a value do not count: its docstring gives them.
"""

from __future__ import annotations

import ast
import random
import re
import sys
from typing import TYPE_CHECKING

from drivelint.guide import FOLDER
from tests.shared_data import ROOT

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

SOURCE = ROOT / "src" / "drivelint"
ERRORS = ("Error", "Warning")


def modules() -> Iterator[tuple[str, ast.Module]]:
    """Yield the path and the syntax tree of each module."""
    for path in sorted(SOURCE.rglob("*.py")):
        yield str(path.relative_to(SOURCE)), ast.parse(path.read_text(encoding="utf-8"))


def docstrings() -> Iterator[str]:
    """Yield each docstring, and each string below a constant or field, with the name that it describes."""
    for path, tree in modules():
        for node in ast.walk(tree):
            if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef):
                if text := ast.get_docstring(node):
                    yield f"{path}: {_heading(node)}\n{text}"
                for before, after in zip(node.body, node.body[1:], strict=False):
                    if isinstance(before, ast.Assign | ast.AnnAssign) and isinstance(after, ast.Expr):
                        value = after.value
                        if isinstance(value, ast.Constant) and isinstance(value.value, str):
                            yield f"{path}: {ast.unparse(before).splitlines()[0][:100]}\n{value.value}"


def _heading(node: ast.Module | ast.ClassDef | ast.FunctionDef) -> str:
    if isinstance(node, ast.Module):
        return "(module)"
    if isinstance(node, ast.ClassDef):
        return f"class {node.name}"
    return f"def {node.name}({ast.unparse(node.args)})"


def names() -> Iterator[str]:
    """Yield the head of each function, with the class of a method, of each class and of each constant."""
    for path, tree in modules():
        class_of = {
            id(part): node.name for node in ast.walk(tree) if isinstance(node, ast.ClassDef) for part in node.body
        }
        for node in ast.walk(tree):
            if isinstance(node, ast.FunctionDef):
                returns = f" -> {ast.unparse(node.returns)}" if node.returns else ""
                place = f"{path}: class {class_of[id(node)]}" if id(node) in class_of else path
                yield f"{place}: def {node.name}({ast.unparse(node.args)}){returns}"
            elif isinstance(node, ast.ClassDef):
                yield f"{path}: class {node.name}"
        for node in tree.body:
            if isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name):
                yield f"{path}: {ast.unparse(node)[:120]}"


def paragraphs() -> Iterator[str]:
    """Yield each paragraph of the guides with the headings above it; neither code, nor tables, nor headings."""
    for path in sorted(FOLDER.glob("*.md")):
        heading = path.stem
        plain = re.sub(r"```.*?```|<!--.*?-->", "", path.read_text(encoding="utf-8"), flags=re.DOTALL)
        for block in (block.strip() for block in plain.split("\n\n")):
            if block.startswith("#"):
                heading = f"{path.stem}: {block.lstrip('# ').splitlines()[0]}"
            elif block and not block.startswith("|") and not block.startswith("<"):
                yield f"{heading}\n{block}"


def messages() -> Iterator[str]:
    """Yield the text of each error that is raised, with the names of what it is filled with."""
    for path, tree in modules():
        for node in ast.walk(tree):
            if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id.endswith(ERRORS):
                for text in (each for each in node.args if isinstance(each, ast.Constant | ast.JoinedStr)):
                    yield f"{path}: {node.func.id}: {ast.unparse(text)}"


KINDS: dict[str, Callable[[], Iterator[str]]] = {
    each.__name__: each for each in (names, docstrings, paragraphs, messages)
}


def main() -> None:
    kind, n, seed = sys.argv[1:]
    texts = list(KINDS[kind]())
    print(f"{kind}: {n} of {len(texts)}, seed {seed}\n")
    for number, text in enumerate(random.Random(int(seed)).sample(texts, int(n)), 1):  # noqa: S311 - no secret
        print(f"[{number}] {text}\n")


if __name__ == "__main__":
    main()
