"""Reads a file of cases: a YAML list of mappings, each of which becomes one object of a given type."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, TypeVar

import msgspec
import yaml

from drivelint.errors import RuleError
from drivelint.phrases import nearest_word

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

C = TypeVar("C", bound=msgspec.Struct)


class OnOffAsTextLoader(getattr(yaml, "CSafeLoader", yaml.SafeLoader)):  # type: ignore[misc]  # builds without libyaml lack it
    """A YAML loader that reads `off` and `on` as strings, not as booleans, because an indicator may be `off`."""


OnOffAsTextLoader.yaml_implicit_resolvers = {
    first: [(tag, pattern) for tag, pattern in resolvers if tag != "tag:yaml.org,2002:bool"]
    for first, resolvers in yaml.SafeLoader.yaml_implicit_resolvers.items()
}
OnOffAsTextLoader.add_implicit_resolver("tag:yaml.org,2002:bool", re.compile(r"^(?:true|false)$"), list("tf"))


def parse_cases_file(file: Path, case_type: type[C]) -> tuple[list[C], list[str]]:
    """Return the cases of a file with their lines, and the problems of the other cases. Errors: `RuleError` if it is no list of cases."""
    try:
        text = file.read_text(encoding="utf-8")
        return _parse_cases(file, text, case_type)
    except UnicodeDecodeError as error:
        raise RuleError(f"{file}:1: not UTF-8 at byte {error.start}") from error
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        line = (
            min(mark.line + 1, len(text.splitlines())) if mark else 1
        )  # PyYAML reports an early end after the last line
        raise RuleError(f"{file}:{line}: not YAML: {' '.join(str(error).split())}") from error


def _parse_cases(file: Path, text: str, case_type: type[C]) -> tuple[list[C], list[str]]:
    loader = OnOffAsTextLoader(text)
    root = loader.get_single_node()
    raw = loader.construct_document(root) if root else None
    if not isinstance(raw, list):
        raise RuleError(f"{file}:1: cases are a list: each begins with '- name: ...'")
    lines = [item.start_mark.line + 1 for item in root.value]
    keys = [about.encode_name for about in msgspec.structs.fields(case_type) if about.name != "line"]
    cases: list[C] = []
    problems: list[str] = []
    for line, item in zip(lines, raw, strict=True):
        if not isinstance(item, dict) or "line" in item:
            problems.append(f"{file}:{line}: a case consists of 'key: value' pairs: {', '.join(keys)}")
            continue
        place = f"{file}:{line}: case {item.get('name')!r}"
        unknown = [key for key in item if key not in keys]
        problems += [f"{place}: unknown field `{key}`{_near_key(str(key), keys)}" for key in unknown]
        if not unknown:
            try:
                cases.append(msgspec.convert({**item, "line": line}, case_type))
            except msgspec.ValidationError as error:
                problems.append(f"{place}: {error}")
    return cases, problems


def _near_key(word: str, keys: Sequence[str]) -> str:
    near = nearest_word(word, keys)
    return f"; did you mean {near!r}?" if near else f"; known are {', '.join(keys)}"
