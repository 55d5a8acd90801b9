"""Reads arrays and lists of points of a pickle in one step, for speed: they are most of a scenario.

Each pattern matches the operations that CPython's and numpy's picklers write for one value. Comments use the names of `pickletools`.
Values that match no pattern are read operation by operation.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from drivelint.formats.scenarionet.pickled_numpy import NumberType, array_from_state

if TYPE_CHECKING:
    from drivelint.arrays import Floats


@dataclass(frozen=True, slots=True)
class Points:
    """A list of `n` points in the file, of two or three numbers each, which is decoded on access.

    `at`: the byte at which the first point begins. The memo numbers of the points are successive, from `first_memo_number` on.
    """

    content: bytes
    at: int
    n: int
    point_layout: np.dtype[Any]
    are_tuples: bool
    first_memo_number: int

    @property
    def array(self) -> Floats:
        """The points (n, k)."""
        rows = np.frombuffer(self.content, self.point_layout, self.n, self.at)
        return np.column_stack([rows[name] for name in self.point_layout.names or ()])

    def as_list(self) -> list[Any]:
        """Return the points as lists or tuples, as in the file."""
        return [tuple(row) if self.are_tuples else row for row in self.array.tolist()]

    def point_of_memo_number(self, memo_number: int) -> tuple[float, ...] | list[float]:
        """Return the point with this memo number, as a tuple or list as in the file."""
        at = self.at + (memo_number - self.first_memo_number) * self.point_layout.itemsize
        numbers: tuple[float, ...] = np.frombuffer(self.content, self.point_layout, 1, at)[0].tolist()
        return numbers if self.are_tuples else list(numbers)


def _point_layout(first_offset: int, size: int, n_numbers: int) -> np.dtype[Any]:
    """Return the layout of a point of `size` bytes with `n_numbers` numbers; `first_offset`: the offset of the first number in bytes."""
    places = [first_offset + 9 * i for i in range(n_numbers)]
    return np.dtype(
        {"names": list("xyz"[:n_numbers]), "formats": [">f8"] * n_numbers, "offsets": places, "itemsize": size}
    )


_POINT_LIST_PATTERNS_AND_LAYOUTS: Final = (
    # MEMOIZE, MARK, then BINFLOAT thrice, TUPLE3 and MEMOIZE for each point, APPENDS
    (re.compile(rb"\x94\((?:G.{8}G.{8}G.{8}\x87\x94)+e", re.DOTALL), _point_layout(1, 29, 3), True),
    # MEMOIZE, MARK, then EMPTY_LIST, MEMOIZE, MARK, BINFLOAT twice and APPENDS for each point, APPENDS
    (re.compile(rb"\x94\((?:\]\x94\(G.{8}G.{8}e)+e", re.DOTALL), _point_layout(4, 22, 2), False),
)
_LIST_HEAD_BYTES: Final = 2  # bytes of a list before its first point; one byte follows the last point


def points_at(content: bytes, at: int, memo_number: int) -> tuple[Points, int] | None:
    """Return the list of points whose EMPTY_LIST ends at byte `at`, and where the list ends; None if this is not a list of points.

    `memo_number`: the memo number of the list.
    """
    for pattern, point, are_tuples in _POINT_LIST_PATTERNS_AND_LAYOUTS:
        if match := pattern.match(content, at):
            n = (match.end() - at - _LIST_HEAD_BYTES - 1) // point.itemsize
            return Points(content, at + _LIST_HEAD_BYTES, n, point, are_tuples, memo_number + 1), match.end()
    return None


_MEMO_GET: Final = rb"(?:h.|j.{4})"  # BINGET or LONG_BINGET: pushes the value with a memo number
_ARRAY_PATTERN: Final = re.compile(
    # the name numpy.ndarray, BININT1 0, TUPLE1, MEMOIZE, the byte b, TUPLE3, MEMOIZE, REDUCE, MEMOIZE
    rb"(" + _MEMO_GET + rb")K\x00\x85\x94" + _MEMO_GET + rb"\x87\x94R\x94"
    # MARK, BININT1 1, the shape, a tuple of it, MEMOIZE, the type, NEWTRUE or NEWFALSE, the length of the bytes
    rb"\(K\x01((?:K.|M.{2}|J.{4}){1,3})[\x85\x86\x87]\x94(" + _MEMO_GET + rb")([\x88\x89])(C.|B.{4})",
    re.DOTALL,
)  # fmt: skip
_ARRAY_END: Final = b"\x94t\x94b"  # after the bytes: MEMOIZE, TUPLE, MEMOIZE, BUILD
_N_MEMO_NUMBERS_PER_ARRAY: Final = 6
"""The number of parts of an array with a memo number. The file refers only to the third, the array, and the fifth, its bytes."""


def array_at(
    content: bytes, at: int, memo: dict[int, Any], next_memo_number: int
) -> tuple[np.ndarray[Any, Any], int, int] | None:
    """Return the array that is stored at byte `at`, the byte after it, and the next free memo number; None: no array is stored there.

    `at`: the byte after the name of numpy's function that rebuilds an array. `memo`: memo number -> value; the array and its bytes are
    added. `next_memo_number`: the next free memo number before the array. Errors: as `array_from_state`.
    """
    match = _ARRAY_PATTERN.match(content, at)
    if match is None:
        return None
    _, shape, kind, order, size = match.groups()
    begin = match.end()
    end = begin + int.from_bytes(size[1:], "little")
    number_type = memo.get(int.from_bytes(kind[1:], "little"))
    if content[end : end + len(_ARRAY_END)] != _ARRAY_END or type(number_type) is not NumberType:
        return None
    raw = content[begin:end]
    array = array_from_state((1, _integers_of_operations(shape), number_type, order == b"\x88", raw))
    memo[next_memo_number + 2], memo[next_memo_number + 4] = array, raw
    return array, end + len(_ARRAY_END), next_memo_number + _N_MEMO_NUMBERS_PER_ARRAY


def _integers_of_operations(operations: bytes) -> tuple[int, ...]:
    """Return the integers of successive operations BININT1, BININT2 and BININT."""
    integers, at = [], 0
    while at < len(operations):
        width = {0x4B: 1, 0x4D: 2, 0x4A: 4}[operations[at]]
        integers.append(int.from_bytes(operations[at + 1 : at + 1 + width], "little"))
        at += 1 + width
    return tuple(integers)
