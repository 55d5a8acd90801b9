"""Decodes batches of CDR messages (ROS 2) to columns.

A message definition is compiled into a few steps. numpy runs each step for all messages of a batch at once, with one cursor per message;
within a sequence, first for the first items, then for the second items, and so on. So strings and sequences may have any length. The steps
only find the place of each value; then the wanted values are read for all items at once. Alignment follows OMG's CDR (XCDR1), with
positions counted from the end of the four-byte header.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import chain
from typing import TYPE_CHECKING, Any, Final, TypeVar

import numpy as np

from drivelint.errors import TraceError
from drivelint.formats.ros2.types import (
    NUMPY_CODES,
    SEQUENCE,
    TEXT_TYPES,
    integer_constants,
    parse_definition,
    short_type_name,
)

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from mcap.records import Schema
    from numpy.typing import NDArray

    from drivelint.formats.mcap.reader import LogMessage
    from drivelint.formats.protobuf.descriptors import FieldTree
    from drivelint.formats.ros2.types import Types

    Offsets = NDArray[np.int64]
    Rows = NDArray[np.intp]

T = TypeVar("T")

HEADER_BYTES = 4
BYTE_ORDERS: Final = {0: ">", 1: "<"}
"""Second byte of the header -> numpy's sign for the byte order. Other values mean encodings that ROS 2 recorders do not write."""
MAX_KEPT_NUMBERS = 3
"""Only this many numbers of a sequence are read: a box has three dimensions."""
_MOST_ALIGNMENT_BYTES = 8
_PADDING_BY_LENGTH: Final = [b"\0" * n for n in range(_MOST_ALIGNMENT_BYTES)]
_TEXT_CODE = "S1"
MOST_NAME_BYTES = 4096
"""The longest text that can be the name of a frame, a class or an actor. Each text of a batch takes as much memory as the longest."""
_MEMBERS_WITH_LONG_TEXT: Final = frozenset({"opendrive"})
"""Members whose text is not a name, but a whole map."""
_SIZE_BY_TYPE: Final = {name: int(code[1]) for name, code in NUMPY_CODES.items()} | dict.fromkeys(TEXT_TYPES, 0)
"""Primitive or text type -> its size in bytes; 0: variable."""


@dataclass
class Table:
    """The members of all messages, or of all items of a sequence, as columns.

    `columns`: member path, joined by dots -> values, one row per message or item; for an array of numbers, a 2-D array. Texts are
    bytes. `parent`: for each item, the row that contains it in the parent table. `children`: path of a sequence -> the table of its items.
    """

    n: int
    columns: dict[str, NDArray[Any]] = field(default_factory=dict)
    parent: NDArray[np.intp] = field(default_factory=lambda: np.zeros(0, np.intp))
    children: dict[str, Table] = field(default_factory=dict)
    where: str = ""
    """File and message definition, for errors."""

    def column(self, path: str) -> NDArray[Any]:
        """Return the column of a member. Errors: `TraceError` if the definition does not have the member."""
        return self._member(self.columns, path)

    def items(self, path: str) -> Table:
        """Return the items of a sequence. Errors: `TraceError` if the definition does not have the sequence."""
        return self._member(self.children, path)

    def _member(self, members: dict[str, T], path: str) -> T:
        if path not in members:
            raise TraceError(
                f"{self.where} has no {path} of the expected type: record the log with its own definitions"
            )
        return members[path]


@dataclass(frozen=True)
class _AlignmentDecodeStep:
    to: int


@dataclass
class _FixedBlockDecodeStep:
    """A step over `size` bytes. `keep`: the values to read in them, as (path, numpy code, offset, count; None: a scalar)."""

    size: int = 0
    keep: list[tuple[str, str, int, int | None]] = field(default_factory=list)


@dataclass(frozen=True)
class _NumbersOrTextDecodeStep:
    """A step over a text, or a sequence whose items have `per_item` primitives each.

    `keep`: the path under which the text or the first `MAX_KEPT_NUMBERS` numbers (NaN if there are fewer) are stored; None: not stored.
    """

    code: str
    per_item: int
    keep: str | None

    @property
    def bytes_per_primitive(self) -> int:
        """The bytes of one primitive."""
        return int(self.code[1])


@dataclass(frozen=True)
class _SequenceItemsDecodeStep:
    keep: str | None
    decode_steps: list[Any]


@dataclass
class _ValuePlaces:
    """The places of values in n messages or items: for each step by its index, the first byte (`start`) and the item count (`length`)."""

    n: int
    parent: NDArray[np.intp] = field(default_factory=lambda: np.zeros(0, np.intp))
    start: dict[int, Offsets] = field(default_factory=dict)
    length: dict[int, Offsets] = field(default_factory=dict)
    children: dict[int, _ValuePlaces] = field(default_factory=dict)


class _DecodeStepCompiler:
    """Compiles a message type to steps, with fixed offsets wherever the alignment is known: the cursor is `rest` modulo `modulus`."""

    def __init__(self, types: Types) -> None:
        self._types = types

    def decode_steps(self, kind: str, tree: FieldTree | None) -> list[Any]:
        self._steps: list[Any] = []
        self._modulus, self._rest = 1, 0
        self._add_members(kind, tree, "")
        return self._steps

    def _add_members(self, kind: str, tree: FieldTree | None, prefix: str) -> None:
        members = self._types[kind]
        if not members:  # an empty message is sent as one byte
            self._add_primitive("u1", None, None)
        for member in members:
            keep_member = tree is not None and member.name in tree
            subtree = tree[member.name] if tree is not None and keep_member else None
            path = f"{prefix}{member.name}"
            if member.count == SEQUENCE:
                self._add_sequence(member.kind, path, subtree, keep_items=keep_member)
            elif member.kind in NUMPY_CODES:
                self._add_primitive(NUMPY_CODES[member.kind], path if keep_member else None, member.count)
            else:
                for _ in range(1 if member.count is None else member.count):
                    if member.kind in TEXT_TYPES:
                        self._add_step(
                            _NumbersOrTextDecodeStep(
                                _TEXT_CODE, 1, path if keep_member and member.count is None else None
                            )
                        )
                    else:
                        self._add_members(member.kind, subtree if member.count is None else None, f"{path}.")

    def _add_primitive(self, code: str, keep: str | None, count: int | None) -> None:
        size = int(code[1])
        if self._modulus < size:
            self._steps.append(_AlignmentDecodeStep(size))
            self._modulus, self._rest = size, 0
        if not self._steps or not isinstance(self._steps[-1], _FixedBlockDecodeStep):
            self._steps.append(_FixedBlockDecodeStep())
        block: _FixedBlockDecodeStep = self._steps[-1]
        pad = -self._rest % size
        if keep is not None:
            block.keep.append((keep, code, block.size + pad, count))
        length = pad + size * (1 if count is None else count)
        block.size += length
        self._rest = (self._rest + length) % self._modulus

    def _add_sequence(self, kind: str, path: str, subtree: FieldTree | None, *, keep_items: bool) -> None:
        keep = path if keep_items else None
        if kind in NUMPY_CODES:
            self._add_step(_NumbersOrTextDecodeStep(NUMPY_CODES[kind], 1, keep))
            return
        sizes = [] if keep_items or kind in TEXT_TYPES else self._primitive_sizes(kind)
        if 0 not in sizes and len(set(sizes)) == 1:
            self._add_step(_NumbersOrTextDecodeStep(f"u{sizes[0]}", len(sizes), None))
        elif kind in TEXT_TYPES:
            self._add_step(_SequenceItemsDecodeStep(None, [_NumbersOrTextDecodeStep(_TEXT_CODE, 1, None)]))
        else:
            self._add_step(_SequenceItemsDecodeStep(keep, _DecodeStepCompiler(self._types).decode_steps(kind, subtree)))

    def _primitive_sizes(self, kind: str) -> list[int]:
        """Return the sizes in bytes of all members of a type, with nested messages expanded; 0 for texts and sequences."""
        sizes: list[int] = [] if self._types[kind] else [1]  # an empty message is sent as one byte
        for member in self._types[kind]:
            if member.count == SEQUENCE:
                sizes.append(0)
                continue
            inner = [_SIZE_BY_TYPE[member.kind]] if member.kind in _SIZE_BY_TYPE else self._primitive_sizes(member.kind)
            sizes += inner * (1 if member.count is None else member.count)
        return sizes

    def _add_step(self, step: Any) -> None:
        """Add a step of variable length, after which the alignment is unknown."""
        self._steps.append(step)
        self._modulus, self._rest = 1, 0


class Decoder:
    """Decodes messages of one type."""

    def __init__(self, path: Path, schema: Schema, tree: FieldTree) -> None:
        """Compile a message definition, to read those fields of `tree` that it has. Errors: `TraceError` for invalid definitions."""
        self._path, self._name = path, schema.name
        types = parse_definition(path, schema.name, schema.data)
        self.constants = integer_constants(path, schema.name, schema.data)
        self._decode_steps = _DecodeStepCompiler(types).decode_steps(short_type_name(schema.name), tree)

    def table(self, log_messages: Sequence[LogMessage]) -> Table:
        """Decode a batch of messages. Errors: `TraceError` with topic and byte of the first message that does not fit the definition."""
        return _MessageBatch(self._path, self._name, log_messages).table(self._decode_steps)


class _MessageBatch:
    """Messages in one buffer. Each body begins at a multiple of eight bytes, so that numpy can read every number as aligned."""

    def __init__(self, path: Path, name: str, log_messages: Sequence[LogMessage]) -> None:
        self._path, self._name, self._log_messages = path, name, log_messages
        sizes = np.array([len(log_message.data) - HEADER_BYTES for log_message in log_messages], np.int64)
        if len(sizes) and sizes.min() < 0:
            raise self._misfit_error(int(np.argmin(sizes)), "is shorter than its header")
        heads = [log_message.data[:2] for log_message in log_messages]
        wrong = {head for head in set(heads) if head != heads[0] or head[0] != 0 or head[1] not in BYTE_ORDERS}
        if wrong:
            odd = next(i for i, head in enumerate(heads) if head in wrong)
            header = log_messages[odd].data[:4].hex()
            raise self._misfit_error(odd, f"is not encoded as plain CDR like the other messages (header {header})")
        # with four bytes before the first header, every message body begins at a multiple of eight bytes
        padded = -(-(sizes + HEADER_BYTES) // _MOST_ALIGNMENT_BYTES) * _MOST_ALIGNMENT_BYTES
        self._start = np.cumsum(padded) - padded + 2 * HEADER_BYTES
        self._end = self._start + sizes
        pads = [_PADDING_BY_LENGTH[n] for n in (padded - sizes - HEADER_BYTES).tolist()]
        pieces = chain.from_iterable(
            (log_message.data, pad) for log_message, pad in zip(log_messages, pads, strict=True)
        )
        content = b"".join([b"\0" * HEADER_BYTES, *pieces, b"\0" * (2 * _MOST_ALIGNMENT_BYTES - HEADER_BYTES)])
        self._bytes = np.frombuffer(content, np.uint8)
        order = BYTE_ORDERS[log_messages[0].data[1]] if log_messages else "<"
        self._views = {code: self._bytes.view(f"{order}{code}") for code in set(NUMPY_CODES.values())}

    def table(self, decode_steps: list[Any]) -> Table:
        messages = np.arange(len(self._log_messages))
        cursor, walk = self._find_values(decode_steps, self._start.copy(), messages)
        left = self._end - cursor
        self._check_within_message(cursor, self._end, messages)
        # writers may pad the end of a message
        if (left >= _MOST_ALIGNMENT_BYTES).any():
            i = int(np.argmax(left >= _MOST_ALIGNMENT_BYTES))
            raise self._misfit_error(i, f"has {left[i]} bytes more than its definition")
        return self._table_of_values(decode_steps, walk)

    def _find_values(self, decode_steps: list[Any], cursor: Offsets, message: Rows) -> tuple[Offsets, _ValuePlaces]:
        """Run the steps from each cursor on, and return the moved cursors and the places of values.

        `cursor` is changed in place; `message`: the message of each cursor. A cursor that leaves its message is only noticed
        at the next length field, or at the message's end; no other value is read before.
        """
        walk = _ValuePlaces(len(cursor))
        end = self._end[message]
        for i, step in enumerate(decode_steps):
            if isinstance(step, _FixedBlockDecodeStep):
                if step.keep:
                    walk.start[i] = cursor.copy()
                cursor += step.size
            elif isinstance(step, _AlignmentDecodeStep):
                cursor += -cursor & (step.to - 1)
            elif isinstance(step, _NumbersOrTextDecodeStep):
                length = self._read_lengths(cursor, end, message, step.bytes_per_primitive * step.per_item)
                if step.bytes_per_primitive > 4:  # a length is four bytes, and stands at a multiple of four
                    cursor += np.where(length > 0, -cursor & (step.bytes_per_primitive - 1), 0)
                if step.keep is not None:
                    if step.code == _TEXT_CODE:
                        self._check_name_lengths(step.keep, length, message)
                    walk.start[i], walk.length[i] = cursor.copy(), length
                cursor += length * (step.bytes_per_primitive * step.per_item)
            else:
                parts = self._find_item_values(step, cursor, end, message)
                if step.keep is not None:
                    walk.children[i] = _join_item_places(parts, [0] * len(parts), np.arange(len(cursor)))
        return cursor, walk

    def _find_item_values(
        self, step: _SequenceItemsDecodeStep, cursor: Offsets, end: Offsets, message: Rows
    ) -> list[_ValuePlaces]:
        """Run the steps of an item for the first items of all sequences, then for the second items, and so on; return these walks."""
        length = self._read_lengths(cursor, end, message, 1)
        parts: list[_ValuePlaces] = []
        for k in range(int(length.max(initial=0))):
            active = np.flatnonzero(length > k)
            after, part = self._find_values(step.decode_steps, cursor[active], message[active])
            cursor[active] = after
            part.parent = active
            parts.append(part)
        # without items, an empty walk still yields a table with all columns
        return parts or [self._find_values(step.decode_steps, cursor[:0].copy(), message[:0])[1]]

    def _table_of_values(self, decode_steps: list[Any], walk: _ValuePlaces) -> Table:
        """Return the table of the wanted fields, read at the places in `walk`."""
        table = Table(walk.n, parent=walk.parent, where=f"{self._path}: the definition of {self._name}")
        for i, step in enumerate(decode_steps):
            if isinstance(step, _FixedBlockDecodeStep):
                for path, code, offset, count in step.keep:
                    table.columns[path] = self._values_at(code, walk.start[i] + offset, count)
            elif isinstance(step, _NumbersOrTextDecodeStep) and step.keep is not None:
                table.columns[step.keep] = self._sequence_values(step, walk.start[i], walk.length[i])
            elif isinstance(step, _SequenceItemsDecodeStep) and step.keep is not None:
                table.children[step.keep] = self._table_of_values(step.decode_steps, walk.children[i])
        return table

    def _sequence_values(self, step: _NumbersOrTextDecodeStep, start: Offsets, length: Offsets) -> NDArray[Any]:
        if step.code == _TEXT_CODE:
            return self._texts(start, length)
        first = np.full((len(start), MAX_KEPT_NUMBERS), np.nan)
        for k in range(MAX_KEPT_NUMBERS):
            has = np.flatnonzero(length > k)
            first[has, k] = self._values_at(step.code, start[has] + k * step.bytes_per_primitive, None)
        return first

    def _values_at(self, code: str, at: Offsets, count: int | None) -> NDArray[Any]:
        view, index = self._views[code], at // int(code[1])
        return view[index] if count is None else view[index[:, None] + np.arange(count)]

    def _read_lengths(self, cursor: Offsets, end: Offsets, message: Rows, item_bytes: int) -> Offsets:
        """Return the length field at each cursor, move the cursors past it, and check that the items fit into the message."""
        cursor += -cursor & 3
        self._check_within_message(cursor + 4, end, message)
        length = self._values_at("u4", cursor, None).astype(np.int64)
        cursor += 4
        self._check_within_message(cursor + length * item_bytes, end, message)
        return length

    def _texts(self, start: Offsets, length: Offsets) -> NDArray[Any]:
        """Return texts as fixed-width bytes; numpy drops the zero byte that ends each text."""
        width = max(int(length.max(initial=0)), 1)
        if width > MOST_NAME_BYTES:  # few texts, for which an index of every letter would take eight times their size
            rows = np.zeros((len(start), width), np.uint8)
            for row, first, n in zip(rows, start.tolist(), length.tolist(), strict=True):
                row[:n] = self._bytes[first : first + n]
            return rows.view(f"S{width}").reshape(-1)
        place = np.arange(width)
        index = np.minimum(start[:, None] + place, len(self._bytes) - 1)
        letters = np.where(place < length[:, None], self._bytes[index], np.uint8(0))
        return np.ascontiguousarray(letters).view(f"S{width}").reshape(-1)

    def _check_name_lengths(self, path: str, length: Offsets, message: Rows) -> None:
        """Check that texts are short enough to be names. One long text would multiply the memory of its whole batch."""
        beyond = length > MOST_NAME_BYTES
        if beyond.any() and path.rpartition(".")[2] not in _MEMBERS_WITH_LONG_TEXT:
            i = int(np.argmax(beyond))
            raise self._misfit_error(
                int(message[i]), f"has {length[i]} bytes in {path}, where a name has at most {MOST_NAME_BYTES}"
            )

    def _check_within_message(self, reach: Offsets, end: Offsets, message: Rows) -> None:
        beyond = reach > end
        if beyond.any():
            raise self._misfit_error(int(message[np.argmax(beyond)]), "ends before its definition does")

    def _misfit_error(self, i: int, problem: str) -> TraceError:
        return self._log_messages[i].error(self._path, f"the {self._name} {problem}")


def _join_item_places(parts: list[_ValuePlaces], offsets: Sequence[int], place: NDArray[np.intp]) -> _ValuePlaces:
    """Join the walks of the first items, the second items, and so on, and sort the items by the sequence that contains them.

    `offsets`: for each part, the number of parent rows in earlier parts; `place`: the new row of each parent row.
    """
    parent = place[np.concatenate([part.parent + offset for part, offset in zip(parts, offsets, strict=False)])]
    order = np.argsort(parent, kind="stable")
    new_index = np.empty_like(order)
    new_index[order] = np.arange(len(order))
    below = np.cumsum([0, *(part.n for part in parts)]).tolist()
    return _ValuePlaces(
        len(parent),
        parent[order],
        {i: np.concatenate([part.start[i] for part in parts])[order] for i in parts[0].start},
        {i: np.concatenate([part.length[i] for part in parts])[order] for i in parts[0].length},
        {i: _join_item_places([part.children[i] for part in parts], below, new_index) for i in parts[0].children},
    )
