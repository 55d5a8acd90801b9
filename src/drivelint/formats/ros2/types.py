"""Parses ROS 2 message definitions, which MCAP has as text in its `ros2msg` schema records.

Syntax: https://docs.ros.org/en/rolling/Concepts/Basic/About-Interfaces.html
"""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from functools import cache, lru_cache
from typing import TYPE_CHECKING, Final

from drivelint.errors import TraceError

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path

    MakeError = Callable[[str], TraceError]

NUMPY_CODES: Final = {
    "bool": "u1", "byte": "u1", "char": "u1", "uint8": "u1", "int8": "i1", "uint16": "u2", "int16": "i2", "uint32": "u4",
    "int32": "i4", "uint64": "u8", "int64": "i8", "float32": "f4", "float64": "f8",
}  # fmt: skip
"""Primitive type -> numpy code without byte order. The digit is the size in bytes, which is also the alignment in CDR."""
TEXT_TYPES: Final = ("string", "wstring")
SEQUENCE: Final = -1
_STAMPS: Final = ("time", "duration", "builtin_interfaces/Time", "builtin_interfaces/Duration")
"""Types of times that a definition may use without containing their definition."""
_OTHER_IN_OLDER: Final = frozenset({"autoware_auto_perception_msgs/TrafficSignalArray"})
"""Messages of older packages whose meaning differs from the newer message with the same name: these lights have the ids of lines
in the map, not of regulatory elements."""
_NOT_UNDERSTOOD: Final = "has a line that is not understood: {!r}"
_MOST_DIGITS: Final = 18
"""The most digits of the length of an array."""
_CONSTANT = re.compile(r"^[a-z]\w*\s+(?P<name>[A-Za-z]\w*)\s*=\s*(?P<value>-?\d+)$")
_RULE = re.compile(r"^={10,}\s*$", re.MULTILINE)
_FIELD = re.compile(
    r"^(?P<type>[A-Za-z][\w/]*)(?P<bound><=\d+)?(?P<array>\[(?:<=)?(?P<count>\d*)\])?\s+(?P<name>[A-Za-z]\w*)(?P<rest>.*)$"
)


@dataclass(frozen=True)
class Field:
    """A member of a message. `kind`: a primitive, a text type, or a message's full name.

    `count`: the length of an array; `SEQUENCE` for a variable length; None: no array.
    """

    name: str
    kind: str
    count: int | None = None


MAX_ARRAY_VALUES: Final = 1 << 31
"""The greatest number of primitives in the arrays of fixed length of one message: more cannot be in a message of 2 GiB."""
MAX_ARRAY_MESSAGES: Final = 100_000
"""The greatest number of messages in arrays of fixed length of one message: each is a step of decoding, and takes 50 µs in all."""
Types = dict[str, list[Field]]
"""Full name (`package/Name`) of a message -> its members in order."""


@lru_cache(maxsize=1024)  # called for every message
def message_kind(schema: str) -> str:
    """Return the message type `package/Name` of a schema; for Autoware's older packages, the newer type with the same fields."""
    name = short_type_name(schema)
    return name if name in _OTHER_IN_OLDER else name.replace("autoware_auto_", "autoware_")


def short_type_name(name: str) -> str:
    """Return `package/Name` for a schema named `package/msg/Name` or `package/Name`."""
    return name.replace("/msg/", "/")


def parse(path: Path, name: str, text: bytes) -> Types:
    """Parse the definition of `name` and of all messages that it contains. Errors: `TraceError` for an invalid line or unknown type."""

    def wrong(problem: str) -> TraceError:
        return TraceError(f"{path}: the definition of {name} in the log {problem}")

    sections = _sections(name, text, wrong)
    defined = {title for title, _ in sections}
    types: Types = {stamp: [Field("sec", "int32"), Field("nanosec", "uint32")] for stamp in _STAMPS}
    for title, body in sections:
        types[title] = [replace(f, kind=_resolved(f.kind, title, defined, wrong)) for f in _fields(body, wrong)]
    _refuse_loops(short_type_name(name), types, wrong)
    _refuse_giants(short_type_name(name), types, wrong)
    return types


def whole_number_constants(path: Path, name: str, text: bytes) -> dict[str, dict[str, int]]:
    """Return the integer constants of `name` and of all messages that it contains: message's full name -> constant -> value."""

    def wrong(problem: str) -> TraceError:
        return TraceError(f"{path}: the definition of {name} in the log {problem}")

    found: dict[str, dict[str, int]] = {}
    for title, body in _sections(name, text, wrong):
        lines = (_CONSTANT.match(line.split("#")[0].strip()) for line in body.splitlines())
        found[title] = {match["name"]: int(match["value"]) for match in lines if match is not None}
    return found


def _sections(name: str, text: bytes, wrong: MakeError) -> list[tuple[str, str]]:
    """Return the full name and the text of each message in a definition, `name` first."""
    try:
        first, *others = _RULE.split(text.decode())
    except UnicodeDecodeError as error:
        raise wrong(f"is not text ({error}): record it again") from error
    sections = [(short_type_name(name), first)]
    for section in others:
        title, _, body = section.lstrip().partition("\n")
        if not title.startswith("MSG:"):
            raise wrong(_NOT_UNDERSTOOD.format(title[:80]))
        sections.append((short_type_name(title.removeprefix("MSG:").strip()), body))
    return sections


def _fields(body: str, wrong: MakeError) -> Iterator[Field]:
    for raw in body.splitlines():
        line = raw.split("#")[0].strip()
        if not line:
            continue
        match = _FIELD.match(line)
        if match is None:
            raise wrong(_NOT_UNDERSTOOD.format(line[:80]))
        if match["rest"].lstrip().startswith("="):
            continue  # a constant
        count = None
        if match["array"]:
            bounded = match["count"] == "" or "<=" in match["array"]
            if not bounded and len(match["count"]) > _MOST_DIGITS:
                raise wrong(_NOT_UNDERSTOOD.format(line[:80]))
            count = SEQUENCE if bounded else int(match["count"])
        yield Field(match["name"], match["type"], count)


def _resolved(kind: str, container: str, defined: set[str], wrong: MakeError) -> str:
    """Return a member's type with its package. A type without a package is a primitive or belongs to the container's package."""
    if kind in NUMPY_CODES or kind in TEXT_TYPES:
        return kind
    full = short_type_name(kind)
    if full == "Header":
        full = "std_msgs/Header"
    if "/" not in full and full not in _STAMPS:
        full = f"{container.split('/', maxsplit=1)[0]}/{full}"
    if full not in defined and full not in _STAMPS:
        raise wrong(f"uses the type {kind}, but has no definition of it: record the log with its message definitions")
    return full


def _refuse_loops(name: str, types: Types, wrong: MakeError) -> None:
    checked_kinds: set[str] = set()

    def visit(kind: str, inside: tuple[str, ...]) -> None:
        if kind in inside:
            raise wrong(f"contains itself ({kind}): record it again")
        if kind in checked_kinds:
            return
        for field in types.get(kind, []):
            visit(field.kind, (*inside, kind))
        checked_kinds.add(kind)

    visit(name, ())


def _refuse_giants(name: str, types: Types, wrong: MakeError) -> None:
    """Refuse arrays of fixed length that no message can contain: decoding would take as many steps as they have items."""

    @cache
    def sizes(kind: str) -> tuple[int, int]:
        """Return how many primitives and how many messages a type contains, with arrays of fixed length; its sequences count once."""
        n_values, n_messages = 1, 1
        for field in types.get(kind, []):
            times = 1 if field.count in {None, SEQUENCE} else field.count
            values, messages = (1, 0) if field.kind in NUMPY_CODES or field.kind in TEXT_TYPES else sizes(field.kind)
            n_values += times * values
            n_messages += times * (messages or field.kind in TEXT_TYPES)
        return n_values, n_messages

    n_values, n_messages = sizes(name)
    if n_values > MAX_ARRAY_VALUES or n_messages > MAX_ARRAY_MESSAGES:
        raise wrong(
            f"has arrays of {max(n_values, n_messages)} items, more than a message can contain: record it again"
        )
