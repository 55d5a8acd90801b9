"""CDR messages (ROS 2) to columns: a batch of messages is read in step, each by a cursor of its own.

A message definition is compiled into a few steps; numpy takes every step for all messages at once, and within a sequence
for its first items, then its second ones, and so on. So strings and sequences may be of any length, and no message is
read by itself. Rules of alignment: CDR of the OMG (XCDR1), positions counted behind the four bytes of the header.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Final, TypeVar

import numpy as np

from drivelint.errors import TraceError
from drivelint.formats.ros2.types import (
    NUMPY_CODES,
    SEQUENCE,
    TEXT_TYPES,
    parse,
    short_type_name,
    whole_number_constants,
)

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from mcap.records import Schema
    from numpy.typing import NDArray

    from drivelint.formats.mcap.reader import Packet
    from drivelint.formats.protobuf.descriptors import FieldTree
    from drivelint.formats.ros2.types import Types

    Offsets = NDArray[np.int64]
    Rows = NDArray[np.intp]

T = TypeVar("T")

HEADER_BYTES = 4
BYTE_ORDERS: Final = {0: ">", 1: "<"}
"""Second byte of the header -> byte order; others are encodings that ROS 2 recorders do not write."""
MAX_KEPT_NUMBERS = 3
"""How many numbers of a sequence are kept: a box has three dimensions."""
_MAX_ALIGN = 8
_TEXT = "S1"
_SIZES: Final = {name: int(code[1]) for name, code in NUMPY_CODES.items()} | dict.fromkeys(TEXT_TYPES, 0)
"""Type of a member that is no message -> its bytes; 0: not always the same."""


@dataclass
class Table:
    """Members of all messages, or of all items of a sequence, as columns.

    `columns`: member path, joined by dots -> values, one row per item; of an array of numbers, one row of them. Texts are
    bytes. `parent`: each item's row in the table above it. `children`: path of a sequence -> its items.
    """

    n: int
    columns: dict[str, NDArray[Any]] = field(default_factory=dict)
    parent: NDArray[np.intp] = field(default_factory=lambda: np.zeros(0, np.intp))
    children: dict[str, Table] = field(default_factory=dict)
    where: str = ""
    """The file and the definition, as errors name them."""

    def column(self, path: str) -> NDArray[Any]:
        """Return a column that must be there. Errors: `TraceError` where the definition does not have it."""
        return self._has(self.columns, path)

    def items(self, path: str) -> Table:
        """Return a sequence that must be there. Errors: `TraceError` where the definition does not have it."""
        return self._has(self.children, path)

    def _has(self, members: dict[str, T], path: str) -> T:
        if path not in members:
            raise TraceError(
                f"{self.where} has no {path} of the kind that is read: record the log with its own definitions"
            )
        return members[path]


@dataclass(frozen=True)
class _Align:
    to: int


@dataclass
class _Block:
    """Bytes of a known number, and what to keep of them: (path, numpy code, offset, how many or None for one)."""

    size: int = 0
    keep: list[tuple[str, str, int, int | None]] = field(default_factory=list)


@dataclass(frozen=True)
class _Numbers:
    """A sequence of primitives, `per_item` of them to an item; kept are the first `MAX_KEPT_NUMBERS`, NaN where fewer, or a text."""

    code: str
    per_item: int
    keep: str | None

    @property
    def size(self) -> int:
        """Bytes of a primitive."""
        return int(self.code[1])


@dataclass(frozen=True)
class _Items:
    keep: str | None
    program: list[Any]


class _Compiler:
    """Turns a type into steps, offsets fixed wherever the alignment is known: the cursor is `rest` modulo `modulus`."""

    def __init__(self, types: Types) -> None:
        self._types = types

    def program(self, kind: str, tree: FieldTree | None) -> list[Any]:
        self._steps: list[Any] = []
        self._modulus, self._rest = 1, 0
        self._members(kind, tree, "")
        return self._steps

    def _members(self, kind: str, tree: FieldTree | None, prefix: str) -> None:
        members = self._types[kind]
        if not members:  # an empty message is sent as one byte
            self._primitive("u1", None, None)
        for member in members:
            wanted = tree is not None and member.name in tree
            subtree = tree[member.name] if tree is not None and wanted else None
            path = f"{prefix}{member.name}"
            if member.count == SEQUENCE:
                self._sequence(member.kind, path, subtree, wanted=wanted)
            elif member.kind in NUMPY_CODES:
                self._primitive(NUMPY_CODES[member.kind], path if wanted else None, member.count)
            else:
                for _ in range(1 if member.count is None else member.count):
                    if member.kind in TEXT_TYPES:
                        self._then(_Numbers(_TEXT, 1, path if wanted and member.count is None else None))
                    else:
                        self._members(member.kind, subtree if member.count is None else None, f"{path}.")

    def _primitive(self, code: str, keep: str | None, count: int | None) -> None:
        size = int(code[1])
        if self._modulus < size:
            self._steps.append(_Align(size))
            self._modulus, self._rest = size, 0
        if not self._steps or not isinstance(self._steps[-1], _Block):
            self._steps.append(_Block())
        block: _Block = self._steps[-1]
        pad = -self._rest % size
        if keep is not None:
            block.keep.append((keep, code, block.size + pad, count))
        length = pad + size * (1 if count is None else count)
        block.size += length
        self._rest = (self._rest + length) % self._modulus

    def _sequence(self, kind: str, path: str, subtree: FieldTree | None, *, wanted: bool) -> None:
        keep = path if wanted else None
        if kind in NUMPY_CODES:
            self._then(_Numbers(NUMPY_CODES[kind], 1, keep))
            return
        sizes = [] if wanted or kind in TEXT_TYPES else self._sizes(kind)
        if 0 not in sizes and len(set(sizes)) == 1:
            self._then(_Numbers(f"u{sizes[0]}", len(sizes), None))
        elif kind in TEXT_TYPES:
            self._then(_Items(None, [_Numbers(_TEXT, 1, None)]))
        else:
            self._then(_Items(keep, _Compiler(self._types).program(kind, subtree)))

    def _sizes(self, kind: str) -> list[int]:
        """Return the sizes of all primitives of a type, 0 for texts and sequences."""
        found: list[int] = [] if self._types[kind] else [1]  # an empty message is sent as one byte
        for member in self._types[kind]:
            if member.count == SEQUENCE:
                found.append(0)
                continue
            inner = [_SIZES[member.kind]] if member.kind in _SIZES else self._sizes(member.kind)
            found += inner * (1 if member.count is None else member.count)
        return found

    def _then(self, step: Any) -> None:
        """Add a step behind which nothing is known of the alignment."""
        self._steps.append(step)
        self._modulus, self._rest = 1, 0


class Decoder:
    """Decodes messages of one type."""

    def __init__(self, path: Path, schema: Schema, tree: FieldTree) -> None:
        """Compile the definition; of `tree` is kept what the definition has. Errors: `TraceError` where it is not understood."""
        self._path, self._name = path, schema.name
        types = parse(path, schema.name, schema.data)
        self.constants = whole_number_constants(path, schema.name, schema.data)
        self._program = _Compiler(types).program(short_type_name(schema.name), tree)

    def table(self, packets: Sequence[Packet]) -> Table:
        """Decode a batch. Errors: `TraceError` naming topic and byte of the first message that does not fit its definition."""
        return _Batch(self._path, self._name, packets).table(self._program)


class _Batch:
    """Messages in one buffer, each beginning at a multiple of eight bytes, so that every number lies where numpy wants it."""

    def __init__(self, path: Path, name: str, packets: Sequence[Packet]) -> None:
        self._path, self._name, self._packets = path, name, packets
        sizes = np.array([len(packet.data) - HEADER_BYTES for packet in packets], np.int64)
        if len(sizes) and sizes.min() < 0:
            raise self._misfit(int(np.argmin(sizes)), "is shorter than its header")
        heads = [packet.data[:2] for packet in packets]
        wrong = {head for head in set(heads) if head != heads[0] or head[0] != 0 or head[1] not in BYTE_ORDERS}
        if wrong:
            odd = next(i for i, head in enumerate(heads) if head in wrong)
            header = packets[odd].data[:4].hex()
            raise self._misfit(odd, f"is encoded otherwise than plain CDR like the others (header {header})")
        padded = -(-sizes // _MAX_ALIGN) * _MAX_ALIGN
        self._start = np.cumsum(padded) - padded
        self._end = self._start + sizes
        bodies = [p.data[HEADER_BYTES:] + b"\0" * int(n) for p, n in zip(packets, padded - sizes, strict=True)]
        self._bytes = np.frombuffer(b"".join([*bodies, b"\0" * _MAX_ALIGN]), np.uint8)
        order = BYTE_ORDERS[packets[0].data[1]] if packets else "<"
        self._views = {code: self._bytes.view(f"{order}{code}") for code in set(NUMPY_CODES.values())}

    def table(self, program: list[Any]) -> Table:
        messages = np.arange(len(self._packets))
        cursor, table = self._run(program, self._start.copy(), messages)
        left = self._end - cursor
        # writers may pad the end of a message
        if (left >= _MAX_ALIGN).any():
            i = int(np.argmax(left >= _MAX_ALIGN))
            raise self._misfit(i, f"has {left[i]} bytes more than its definition")
        return table

    def _run(self, program: list[Any], cursor: Offsets, message: Rows) -> tuple[Offsets, Table]:
        """Take the steps from each cursor on (owned, changed in place); `message`: the message each is in."""
        table = Table(len(cursor), where=f"{self._path}: the definition of {self._name}")
        end = self._end[message]
        for step in program:
            if isinstance(step, _Block):
                self._check(cursor + step.size, end, message)
                for path, code, offset, count in step.keep:
                    table.columns[path] = self._taken(code, cursor + offset, count)
                cursor += step.size
            elif isinstance(step, _Align):
                cursor += -cursor % step.to
            elif isinstance(step, _Numbers):
                self._numbers(step, cursor, end, message, table)
            else:
                self._items(step, cursor, end, message, table)
        return cursor, table

    def _numbers(self, step: _Numbers, cursor: Offsets, end: Offsets, message: Rows, table: Table) -> None:
        length = self._length(cursor, end, message, step.size * step.per_item)
        cursor += np.where(length > 0, -cursor % step.size, 0)
        size = length * step.size * step.per_item
        self._check(cursor + size, end, message)
        if step.keep is not None and step.code == _TEXT:
            table.columns[step.keep] = self._texts(cursor, length)
        elif step.keep is not None:
            first = np.full((len(cursor), MAX_KEPT_NUMBERS), np.nan)
            for k in range(MAX_KEPT_NUMBERS):
                has = np.flatnonzero(length > k)
                first[has, k] = self._taken(step.code, cursor[has] + k * step.size, None)
            table.columns[step.keep] = first
        cursor += size

    def _items(self, step: _Items, cursor: Offsets, end: Offsets, message: Rows, table: Table) -> None:
        length = self._length(cursor, end, message, 1)
        parts: list[Table] = []
        for k in range(int(length.max(initial=0))):
            active = np.flatnonzero(length > k)
            after, part = self._run(step.program, cursor[active], message[active])
            cursor[active] = after
            part.parent = active
            parts.append(part)
        if step.keep is not None:
            # of no items at all, an empty table has the columns
            parts = parts or [self._run(step.program, cursor[:0].copy(), message[:0])[1]]
            table.children[step.keep] = _stacked(parts, [0] * len(parts), np.arange(len(cursor)))

    def _taken(self, code: str, at: Offsets, count: int | None) -> NDArray[Any]:
        view, index = self._views[code], at // int(code[1])
        return view[index] if count is None else view[index[:, None] + np.arange(count)]

    def _length(self, cursor: Offsets, end: Offsets, message: Rows, item_bytes: int) -> Offsets:
        """Read a length, move on behind it, and check that so many items can follow (an item has a byte at least)."""
        cursor += -cursor % 4
        self._check(cursor + 4, end, message)
        length = self._taken("u4", cursor, None).astype(np.int64)
        cursor += 4
        self._check(cursor + length * item_bytes, end, message)
        return length

    def _texts(self, start: Offsets, length: Offsets) -> NDArray[Any]:
        """Return texts as fixed-width bytes; numpy drops the zero at their ends."""
        width = max(int(length.max(initial=0)), 1)
        place = np.arange(width)
        index = np.minimum(start[:, None] + place, len(self._bytes) - 1)
        letters = np.where(place < length[:, None], self._bytes[index], np.uint8(0))
        return np.ascontiguousarray(letters).view(f"S{width}").reshape(-1)

    def _check(self, reach: Offsets, end: Offsets, message: Rows) -> None:
        beyond = reach > end
        if beyond.any():
            raise self._misfit(int(message[np.argmax(beyond)]), "ends before its definition does")

    def _misfit(self, i: int, what: str) -> TraceError:
        return self._packets[i].error(self._path, f"the {self._name} {what}")


def _stacked(parts: list[Table], offsets: Sequence[int], place: NDArray[np.intp]) -> Table:
    """Put the first, second, ... items of all sequences, and what is in them, into the order of their sequences.

    `offsets`: how many rows above belong to earlier parts; `place`: where each row above has gone.
    """
    parent = place[np.concatenate([part.parent + offset for part, offset in zip(parts, offsets, strict=False)])]
    order = np.argsort(parent, kind="stable")
    moved = np.empty_like(order)
    moved[order] = np.arange(len(order))
    below = np.cumsum([0, *(part.n for part in parts)]).tolist()
    return Table(
        len(parent),
        {path: np.concatenate([part.columns[path] for part in parts])[order] for path in parts[0].columns},
        parent[order],
        {path: _stacked([part.children[path] for part in parts], below, moved) for path in parts[0].children},
        parts[0].where,
    )
