"""Reads the header of a rule file and reports all of its errors at once, each with its line and the nearest known key.

What cannot be used is left out, or replaced by a placeholder, so that the rest of the file can still be checked.
"""

from __future__ import annotations

import re
import tomllib
from typing import TYPE_CHECKING, Any, Final, Literal, NamedTuple, get_args, get_origin

import msgspec

from drivelint.catalogue.header import TABLE_LINE, Conditions, Header, Param, contradictions, line_of_key
from drivelint.phrases import hint, nearest_word
from drivelint.reasons.reason_text import ReasonText
from drivelint.toml_text import parse_toml

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

KEYS_OF_KIND: Final = frozenset(
    [
        "kind",
        "subtype",
        "sense",
        "unit",
        "window_s",
        "quantifier",
        "combine",
        "near_margin",
        "reference",
        "observes",
        "without_time",
        "without_anchor",
    ]
)
"""The keys that the rule's kind or sense allows or requires. If one of them is unusable, their contradictions are not reported."""
_TABLES: Final[dict[str, type[msgspec.Struct]]] = {"params": Param, "reasons": ReasonText}
"""Key -> class of the tables under it, one for each name."""
_TABLE_PLACEHOLDERS: Final = {"params": {"default": 0.0, "unit": "", "why": ""}, "reasons": {"says": ""}}
_UNCLOSED: Final = re.compile(r"Unclosed|Unterminated")


class ReadHeader(NamedTuple):
    """A header, its problems as `file:line: message`, and its doubtful keys: unusable, absent, or probably misspelled.

    `header` is None if the text is not TOML. For a doubtful key it has a placeholder.
    """

    header: Header | None
    problems: list[str]
    doubtful_keys: frozenset[str]


class _Problem(NamedTuple):
    """A problem: its key with the tables around it, the message, and the key that was probably meant."""

    key: str
    message: str
    meant_key: str | None = None


def read_header(text: str, where: str) -> ReadHeader:
    """Read the TOML `text`, whose line n is line n of the file `where`."""
    raw, problems, doubtful = _parse_line_by_line(text, where)
    if raw is None:
        return ReadHeader(None, problems, frozenset(doubtful))
    header_problems = [problem for problem in _problems(raw, Header, "") if problem.key not in doubtful]
    doubtful |= {
        key for problem in header_problems for key in (problem.key, problem.meant_key) if key and "." not in key
    }
    absent = [problem for problem in header_problems if problem.key not in raw and "." not in problem.key]
    meant_keys = {problem.meant_key for problem in header_problems}
    header_problems = [problem for problem in header_problems if problem not in absent or problem.key not in meant_keys]
    header = msgspec.convert(_usable_values(raw), Header)
    for key, message in contradictions(header):
        root = key.split(".")[0]
        if root not in doubtful and not (root in KEYS_OF_KIND and KEYS_OF_KIND & doubtful):
            header_problems.append(_Problem(key, message))
    problems += [f"{where}:{line_of_key(text, problem.key)}: {problem.message}" for problem in header_problems]
    return ReadHeader(header, problems, frozenset(doubtful))


def _parse_line_by_line(text: str, where: str) -> tuple[dict[str, Any] | None, list[str], set[str]]:
    """Return the content of a TOML text, its errors, and the keys on the lines with errors; None if it cannot be read without them."""
    lines = text.splitlines()
    problems: list[str] = []
    doubtful: set[str] = set()
    while True:
        try:
            return parse_toml("\n".join(lines)), problems, doubtful
        except (tomllib.TOMLDecodeError, RecursionError) as error:
            n = _line_of_toml_error(str(error), lines)
            message = re.sub(r"\s*\(at [^)]*\)$", "", str(error))
            problems.append(f"{where}:{n}: the header is not TOML: {message}: {_shortened_text(lines[n - 1].strip())}")
            if _UNCLOSED.search(message) or lines[n - 1].strip().startswith("[") or not lines[n - 1].strip():
                return None, problems, doubtful
            doubtful |= _keys_at(lines, n)
            lines[n - 1] = ""


def _line_of_toml_error(message: str, lines: Sequence[str]) -> int:
    """Return the line of an error of the TOML parser; for a value without an end, the line on which it begins."""
    match = re.search(r"at line (\d+)", message)
    last = int(match[1]) if match else len(lines)
    if message.startswith("Unclosed array"):
        begins = [n for n in range(1, last + 1) if re.search(r"=\s*\[[^\]]*$", lines[n - 1])]
    elif message.startswith("Unterminated"):
        begins = [n for n in range(1, last + 1) if re.search(r"=\s*(\"\"\"|''')", lines[n - 1])]
    else:
        begins = []
    return begins[-1] if begins else max(last, 1)


def _keys_at(lines: Sequence[str], n: int) -> set[str]:
    """Return the key to which line n belongs, such as `reads` or `params.limit_mps.unit`; an empty set if none is found."""
    table, key = "", ""
    for line in lines[:n]:
        if head := TABLE_LINE.match(line):
            table, key = f"{head[1].strip()}.", ""
        elif match := re.match(r"\s*[\"']?([\w-]+)[\"']?(?=\s*=|\s+\S)", line):
            key = table + match[1]
    return {key} if key else set()


def _problems(raw: Mapping[str, Any], struct: type[msgspec.Struct], path: str) -> Iterator[_Problem]:
    """Yield the problems of a table of the header, key by key. `path`: the table's name and a point; '' for the header itself."""
    fields = {field.name: field for field in msgspec.structs.fields(struct)}
    for key, value in raw.items():
        if key not in fields:
            message = f"unknown key {key!r} in the header; {hint(key, fields)}"
            yield _Problem(f"{path}{key}", message, path + (nearest_word(key, fields) or ""))
        elif key in _TABLES and not path and isinstance(value, dict):
            for name, table in value.items():
                yield from _table_problems(table, _TABLES[key], f"{key}.{name}")
        elif key == "applies" and not path:
            yield from _table_problems(value, Conditions, key)
        elif message := _value_problem(key, value, fields[key].type):
            yield _Problem(f"{path}{key}", message)
    for name, field in fields.items():
        if name not in raw and field.required:
            of_table = f" of [{path[:-1]}]" if path else ""
            yield _Problem(f"{path}{name}", f"header: missing required field `{name}`{of_table}")


def _table_problems(table: Any, struct: type[msgspec.Struct], path: str) -> Iterator[_Problem]:
    if not isinstance(table, dict):
        yield _Problem(path, f"header: {path} must be a table, with {', '.join(struct.__struct_fields__)}")
        return
    problems = list(_problems(table, struct, f"{path}."))
    meant_keys = {problem.meant_key for problem in problems}
    yield from (problem for problem in problems if problem.key not in meant_keys)
    if not problems and (message := _value_problem(path, table, struct)):
        yield _Problem(path, message)


def _value_problem(key: str, value: Any, field_type: Any) -> str:
    """Return why a value is not of the type that its key needs; '' if it is."""
    try:
        msgspec.convert(value, field_type)
    except msgspec.ValidationError as error:
        words = get_args(field_type) if get_origin(field_type) is Literal else ()
        if words and isinstance(value, str):
            turned = [word for word in words if sorted(word) == sorted(value)]  # such as =< for <=
            return f"{key} = {value!r}: {hint(value, turned or words, cutoff=0 if turned else 0.6)}"
        return f"header: {error}: {key} = {_shortened_text(repr(value))}"
    return ""


def _shortened_text(text: str) -> str:
    return text if len(text) <= 60 else f"{text[:57]}..."


def _usable_values(raw: Mapping[str, Any]) -> dict[str, Any]:
    """Return the header without the keys and values that cannot be used, and with placeholders for absent values."""
    fields = {field.name: field for field in msgspec.structs.fields(Header)}
    values = {
        key: raw[key] for key, field in fields.items() if key in raw and not _value_problem("", raw[key], field.type)
    }
    for key, struct in _TABLES.items():
        if key not in values and isinstance(raw.get(key), dict):
            tables, placeholder = raw[key].items(), _TABLE_PLACEHOLDERS[key]
            values[key] = {name: placeholder if _value_problem("", table, struct) else table for name, table in tables}
    placeholders = {name: _placeholder(field.type) for name, field in fields.items() if field.required}
    return placeholders | values


def _placeholder(field_type: Any) -> Any:
    if get_origin(field_type) is Literal:
        return get_args(field_type)[0]
    return () if get_origin(field_type) is tuple else ""
