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
_STAMP_TYPES: Final = ("time", "duration", "builtin_interfaces/Time", "builtin_interfaces/Duration")
"""Types of times that a definition may use without containing their definition."""
_OLD_MESSAGE_TYPES_WITHOUT_NEW_EQUIVALENT: Final = frozenset({"autoware_auto_perception_msgs/TrafficSignalArray"})
"""Messages of older packages whose meaning differs from the newer message with the same name: these lights have the ids of lines
in the map, not of regulatory elements."""
_NOT_UNDERSTOOD_TEXT: Final = "has a line that is not understood: {!r}"
_MOST_ARRAY_LENGTH_DIGITS: Final = 18
"""The most digits of the length of an array."""
_CONSTANT_PATTERN = re.compile(r"^[a-z]\w*\s+(?P<name>[A-Za-z]\w*)\s*=\s*(?P<value>-?\d+)$")
_SEPARATOR_PATTERN = re.compile(r"^={10,}\s*$", re.MULTILINE)
_FIELD_PATTERN = re.compile(
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
    return name if name in _OLD_MESSAGE_TYPES_WITHOUT_NEW_EQUIVALENT else name.replace("autoware_auto_", "autoware_")


def short_type_name(name: str) -> str:
    """Return `package/Name` for a schema named `package/msg/Name` or `package/Name`."""
    return name.replace("/msg/", "/")


def parse_definition(path: Path, name: str, text: bytes) -> Types:
    """Parse the definition of `name` and of all messages that it contains. Errors: `TraceError` for an invalid line or unknown type."""

    def make_error(problem: str) -> TraceError:
        return TraceError(f"{path}: the definition of {name} in the log {problem}")

    sections = _sections(name, text, make_error)
    defined = {title for title, _ in sections}
    types: Types = {stamp: [Field("sec", "int32"), Field("nanosec", "uint32")] for stamp in _STAMP_TYPES}
    for title, body in sections:
        types[title] = [
            replace(f, kind=_full_type_name(f.kind, title, defined, make_error)) for f in _fields(body, make_error)
        ]
    _refuse_loops(short_type_name(name), types, make_error)
    _refuse_giant_arrays(short_type_name(name), types, make_error)
    return types


def integer_constants(path: Path, name: str, text: bytes) -> dict[str, dict[str, int]]:
    """Return the integer constants of `name` and of all messages that it contains: message's full name -> constant -> value."""

    def make_error(problem: str) -> TraceError:
        return TraceError(f"{path}: the definition of {name} in the log {problem}")

    constants: dict[str, dict[str, int]] = {}
    for title, body in _sections(name, text, make_error):
        lines = (_CONSTANT_PATTERN.match(line.split("#")[0].strip()) for line in body.splitlines())
        constants[title] = {match["name"]: int(match["value"]) for match in lines if match is not None}
    return constants


def _sections(name: str, text: bytes, make_error: MakeError) -> list[tuple[str, str]]:
    """Return the full name and the text of each message in a definition, `name` first."""
    try:
        first, *rest = _SEPARATOR_PATTERN.split(text.decode())
    except UnicodeDecodeError as error:
        raise make_error(f"is not text ({error}): record it again") from error
    sections = [(short_type_name(name), first)]
    for section in rest:
        title, _, body = section.lstrip().partition("\n")
        if not title.startswith("MSG:"):
            raise make_error(_NOT_UNDERSTOOD_TEXT.format(title[:80]))
        sections.append((short_type_name(title.removeprefix("MSG:").strip()), body))
    return sections


def _fields(body: str, make_error: MakeError) -> Iterator[Field]:
    for raw in body.splitlines():
        line = raw.split("#")[0].strip()
        if not line:
            continue
        match = _FIELD_PATTERN.match(line)
        if match is None:
            raise make_error(_NOT_UNDERSTOOD_TEXT.format(line[:80]))
        if match["rest"].lstrip().startswith("="):
            continue  # a constant
        count = None
        if match["array"]:
            bounded = match["count"] == "" or "<=" in match["array"]
            if not bounded and len(match["count"]) > _MOST_ARRAY_LENGTH_DIGITS:
                raise make_error(_NOT_UNDERSTOOD_TEXT.format(line[:80]))
            count = SEQUENCE if bounded else int(match["count"])
        yield Field(match["name"], match["type"], count)


def _full_type_name(kind: str, container: str, defined: set[str], make_error: MakeError) -> str:
    """Return a member's type with its package. A type without a package is a primitive or belongs to the container's package."""
    if kind in NUMPY_CODES or kind in TEXT_TYPES:
        return kind
    full = short_type_name(kind)
    if full == "Header":
        full = "std_msgs/Header"
    if "/" not in full and full not in _STAMP_TYPES:
        full = f"{container.split('/', maxsplit=1)[0]}/{full}"
    if full not in defined and full not in _STAMP_TYPES:
        raise make_error(
            f"uses the type {kind}, but has no definition of it: record the log with its message definitions"
        )
    return full


def _refuse_loops(name: str, types: Types, make_error: MakeError) -> None:
    checked_kinds: set[str] = set()

    def refuse_type_inside_itself(kind: str, inside: tuple[str, ...]) -> None:
        if kind in inside:
            raise make_error(f"contains itself ({kind}): record it again")
        if kind in checked_kinds:
            return
        for field in types.get(kind, []):
            refuse_type_inside_itself(field.kind, (*inside, kind))
        checked_kinds.add(kind)

    refuse_type_inside_itself(name, ())


def _refuse_giant_arrays(name: str, types: Types, make_error: MakeError) -> None:
    """Refuse arrays of fixed length that no message can contain: decoding would take as many steps as they have items."""

    @cache
    def n_values_and_messages(kind: str) -> tuple[int, int]:
        """Return how many primitives and how many messages a type contains, with arrays of fixed length; its sequences count once."""
        n_values, n_messages = 1, 1
        for field in types.get(kind, []):
            times = 1 if field.count in {None, SEQUENCE} else field.count
            values, messages = (
                (1, 0) if field.kind in NUMPY_CODES or field.kind in TEXT_TYPES else n_values_and_messages(field.kind)
            )
            n_values += times * values
            n_messages += times * (messages or field.kind in TEXT_TYPES)
        return n_values, n_messages

    n_values, n_messages = n_values_and_messages(name)
    if n_values > MAX_ARRAY_VALUES or n_messages > MAX_ARRAY_MESSAGES:
        raise make_error(
            f"has arrays of {max(n_values, n_messages)} items, more than a message can contain: record it again"
        )
