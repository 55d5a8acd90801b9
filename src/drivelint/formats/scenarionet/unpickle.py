"""Decodes pickles of plain values and numpy arrays. Nothing of a file is imported, called or run.

`_Machine` knows the operations of protocols 2 to 5 that such values need. It refuses all other operations, and all names except those in
`pickled_numpy`. A key of a dict must be a text or a number, so that no container is hashed. The decoded values are no larger than the
file: an array is a view of its bytes.
"""

from __future__ import annotations

import struct
from bisect import bisect_right
from functools import partial
from typing import TYPE_CHECKING, Any, Final, NoReturn

from drivelint.formats.scenarionet.pickle_shortcuts import Points, array_at, points_at
from drivelint.formats.scenarionet.pickled_numpy import (
    Array,
    Name,
    NumberType,
    PickleError,
    array_of,
    build_value,
    name_of,
)

if TYPE_CHECKING:
    from collections.abc import Callable

_ARRAY: Final = Name("array")
_KEYS: Final = frozenset({str, int, float, bool, type(None)})
_DAMAGED: Final = (ValueError, TypeError, AttributeError, OverflowError, MemoryError, LookupError)
_REMEDY: Final = "copy or write it again"
_UINT: Final = struct.Struct("<I").unpack_from
_FLOAT: Final = struct.Struct(">d").unpack_from


class _EndError(Exception):
    """Raised by the operation that ends a pickle."""


def load(content: bytes) -> Any:
    """Return the content of a pickle: dicts, lists (also for sets), tuples, texts, numbers, None and numpy arrays, which are read-only.

    A list of points may be `Points`. Errors: `PickleError` with the byte and what is wrong there.
    """
    machine = _Machine(content)
    try:
        return machine.run()
    except PickleError as error:
        raise PickleError(f"byte {machine.at}: {error}") from None
    except (IndexError, struct.error):
        raise PickleError(f"it is cut off or damaged at byte {machine.at} of {len(content)}: {_REMEDY}") from None
    except _DAMAGED as error:
        raise PickleError(f"it is damaged at byte {machine.at} ({error}): {_REMEDY}") from None


class _Machine:
    """Decodes a pickle: its bytes, the stack with its marks, and the memo, the objects to which the file refers by number.

    Each operation is a method that takes the position after its code and returns the position after its argument.
    """

    def __init__(self, content: bytes) -> None:
        self.content = content
        self.at = 0
        self.stack: list[Any] = []
        self.marks: list[int] = []
        self.memo: dict[int, Any] = {}
        self.count = 0  # of objects with a memo number, including the points in `points`
        self.points: list[Points] = []
        self.to_copy = len(content)

    def run(self) -> Any:
        """Return the value of the pickle."""
        content, memo, stack, number = self.content, self.memo, self.stack, _UINT
        push, actions = stack.append, [self._action(code) for code in range(256)]
        at = 0
        try:
            while True:
                code = content[at]
                at += 1
                # for speed, the most frequent operations are inline, and MEMOIZE, which follows most values
                if code == 0x68 and (value := memo.get(content[at])) is not None:  # BINGET
                    at += 1
                    if type(value) is Name and value == _ARRAY and (found := array_at(content, at, memo, self.count)):
                        value, at, self.count = found
                    push(value)
                elif code == 0x6A and (value := memo.get(number(content, at)[0])) is not None:  # LONG_BINGET
                    at += 4
                    push(value)
                elif code == 0x8C:  # SHORT_BINUNICODE
                    begin, at = at + 1, at + 1 + content[at]
                    push(str(content[begin:at], "utf-8", "surrogatepass"))
                elif code == 0x4B:  # BININT1
                    push(content[at])
                    at += 1
                else:
                    at = actions[code](at)
                if content[at] == 0x94:  # MEMOIZE
                    memo[self.count] = stack[-1]
                    self.count += 1
                    at += 1
        except _EndError:
            if len(stack) != 1 or self.marks:
                raise ValueError("it ends within a value") from None
            return stack[0]
        finally:
            self.at = at

    def _action(self, code: int) -> Callable[[int], int]:
        name, *widths = _OPERATIONS.get(code, "refuse").split()
        method: Callable[..., int] = getattr(self, name)
        return partial(method, width=int(widths[0])) if widths else method

    def stop(self, _: int) -> NoReturn:
        raise _EndError

    def refuse(self, at: int) -> NoReturn:
        raise PickleError(f"the operation {self.content[at - 1 : at]!r}, which plain values do not need: {_REMEDY}")

    # ---- values

    def protocol(self, at: int) -> int:
        return at + 1

    def frame(self, at: int) -> int:
        return at + 8

    def push_none(self, at: int) -> int:
        self.stack.append(None)
        return at

    def true(self, at: int) -> int:
        self.stack.append(True)
        return at

    def false(self, at: int) -> int:
        self.stack.append(False)
        return at

    def unsigned(self, at: int, width: int) -> int:
        self.stack.append(int.from_bytes(self._part(at, width), "little"))
        return at + width

    def signed(self, at: int, width: int) -> int:
        self.stack.append(int.from_bytes(self._part(at, width), "little", signed=True))
        return at + width

    def long(self, at: int, width: int) -> int:
        begin, end = self._span_after_length(at, width)
        self.stack.append(int.from_bytes(self.content[begin:end], "little", signed=True))
        return end

    def real(self, at: int) -> int:
        self.stack.append(_FLOAT(self.content, at)[0])
        return at + 8

    def text(self, at: int, width: int) -> int:
        begin, end = self._span_after_length(at, width)
        self.stack.append(str(self.content[begin:end], "utf-8", "surrogatepass"))
        return end

    def raw(self, at: int, width: int) -> int:
        begin, end = self._span_after_length(at, width)
        self.stack.append(self.content[begin:end])
        return end

    def _span_after_length(self, at: int, width: int) -> tuple[int, int]:
        """Return begin and end of the bytes that follow a length of `width` bytes."""
        begin = at + width
        end = begin + int.from_bytes(self._part(at, width), "little")
        if end > len(self.content):
            raise IndexError
        return begin, end

    def _part(self, at: int, n: int) -> bytes:
        if at + n > len(self.content):
            raise IndexError
        return self.content[at : at + n]

    # ---- the memo and the stack

    def memoize(self, at: int) -> int:
        self.memo[self.count] = self.stack[-1]
        self.count += 1
        return at

    def put(self, at: int, width: int) -> int:
        number = int.from_bytes(self._part(at, width), "little")
        self.count += number not in self.memo
        self.memo[number] = self.stack[-1]
        return at + width

    def get(self, at: int, width: int) -> int:
        number = int.from_bytes(self._part(at, width), "little")
        self.stack.append(self.memo[number] if number in self.memo else self._point_of(number))
        return at + width

    def _point_of(self, number: int) -> Any:
        """Return the point with this memo number, of a list in `points`."""
        k = bisect_right(self.points, number, key=lambda each: each.first_memo_number) - 1
        if k < 0 or number >= self.points[k].first_memo_number + self.points[k].n:
            raise IndexError
        return self.points[k].point_of_memo_number(number)

    def mark(self, at: int) -> int:
        self.marks.append(len(self.stack))
        return at

    def pop(self, at: int) -> int:
        self._take(1)
        return at

    def pop_mark(self, at: int) -> int:
        self._pop_to_mark()
        return at

    def _pop_to_mark(self) -> list[Any]:
        """Remove the values above the last mark from the stack, and return them."""
        mark = self.marks.pop()
        found = self.stack[mark:]
        del self.stack[mark:]
        return found

    def _take(self, n: int) -> tuple[Any, ...]:
        """Remove the last n values from the stack, and return them. Errors: `IndexError` if one is below the last mark."""
        first = len(self.stack) - n
        if first < (self.marks[-1] if self.marks else 0):
            raise IndexError
        found = tuple(self.stack[first:])
        del self.stack[first:]
        return found

    # ---- containers

    def new_list(self, at: int) -> int:
        found = points_at(self.content, at, self.count)
        if found is None:
            self.stack.append([])
            return at
        points, end = found
        self.points.append(points)
        self.stack.append(points)
        self.memo[self.count] = points
        self.count += 1 + points.n
        return end

    def new_set(self, at: int) -> int:
        self.stack.append([])
        return at

    def push_list_since_mark(self, at: int) -> int:
        self.stack.append(self._pop_to_mark())
        return at

    def append(self, at: int) -> int:
        (value,) = self._take(1)
        self._extend((value,))
        return at

    def appends(self, at: int) -> int:
        self._extend(self._pop_to_mark())
        return at

    def _extend(self, values: Any) -> None:
        target: Any = self.stack[-1]
        if type(target) is Points:  # a pickle writes a long list in several parts
            rows = target.as_list()
            self.memo[target.first_memo_number - 1] = self.stack[-1] = target = rows
        if type(target) is not list:
            raise TypeError("values for something that is not a list")
        target.extend(values)

    def new_tuple(self, at: int) -> int:
        self.stack.append(())
        return at

    def push_tuple_since_mark(self, at: int) -> int:
        self.stack.append(tuple(self._pop_to_mark()))
        return at

    def tuple1(self, at: int) -> int:
        self.stack.append(self._take(1))
        return at

    def tuple2(self, at: int) -> int:
        self.stack.append(self._take(2))
        return at

    def tuple3(self, at: int) -> int:
        self.stack.append(self._take(3))
        return at

    def new_dict(self, at: int) -> int:
        self.stack.append({})
        return at

    def push_dict_since_mark(self, at: int) -> int:
        values = self._pop_to_mark()
        self.stack.append({})
        self._set(values)
        return at

    def set_item(self, at: int) -> int:
        self._set(self._take(2))
        return at

    def set_items(self, at: int) -> int:
        self._set(self._pop_to_mark())
        return at

    def _set(self, values: Any) -> None:
        target, keys = self.stack[-1], values[::2]
        if type(target) is not dict or len(values) % 2:
            raise TypeError("keys and values for something that is not a dict")
        if not _KEYS.issuperset(map(type, keys)):
            raise PickleError(f"a key that is neither text nor number: {_REMEDY}")
        target.update(zip(keys, values[1::2], strict=True))

    # ---- names and what is made with them

    def name_in_lines(self, at: int) -> int:
        middle = self.content.index(b"\n", at)
        end = self.content.index(b"\n", middle + 1)
        self.stack.append(name_of(self.content[at:middle].decode(), self.content[middle + 1 : end].decode()))
        return end + 1

    def name_on_stack(self, at: int) -> int:
        self.stack.append(name_of(*self._take(2)))
        return at

    def reduce(self, at: int) -> int:
        name, arguments = self._take(2)
        if type(name) is not Name or type(arguments) is not tuple:
            raise TypeError("a call of something that is not a name")
        if name.meaning == "array":
            value: Any = Array(self._memo_at(at))
        elif name.meaning == "encode":
            value = self._encoded(arguments[0])
        else:
            value = build_value(name.meaning, arguments)
        self.stack.append(value)
        return at

    def _memo_at(self, at: int) -> int | None:
        """Return the memo number that the operation at this position gives to the new value; None: it gives no number."""
        following = self.content[at : at + 5]
        if following[:1] == b"\x94":
            return self.count
        width = {b"q": 1, b"r": 4}.get(following[:1])
        return None if width is None else int.from_bytes(following[1 : 1 + width], "little")

    def _encoded(self, text: str) -> bytes:
        """Return the bytes that protocol 2 writes as a text."""
        self.to_copy -= len(text)
        if self.to_copy < 0:
            raise PickleError(f"more bytes than the file has: {_REMEDY}")
        return text.encode("latin-1")

    def build(self, at: int) -> int:
        (state,) = self._take(1)
        target = self.stack[-1]
        if isinstance(target, NumberType):
            target.set_state(state)
        elif isinstance(target, Array):
            self.stack[-1] = array_of(state)
            if target.memo is not None:
                self.memo[target.memo] = self.stack[-1]
        else:
            raise TypeError("content for something that is not an array")
        return at


_OPERATIONS: Final = {
    0x80: "protocol", 0x95: "frame", 0x2E: "stop",
    0x4E: "push_none", 0x88: "true", 0x89: "false",
    0x4B: "unsigned 1", 0x4D: "unsigned 2", 0x4A: "signed 4", 0x8A: "long 1", 0x8B: "long 4", 0x47: "real",
    0x8C: "text 1", 0x58: "text 4", 0x8D: "text 8", 0x43: "raw 1", 0x42: "raw 4", 0x8E: "raw 8", 0x96: "raw 8",
    0x94: "memoize", 0x71: "put 1", 0x72: "put 4", 0x68: "get 1", 0x6A: "get 4",
    0x28: "mark", 0x30: "pop", 0x31: "pop_mark",
    0x5D: "new_list", 0x6C: "push_list_since_mark", 0x61: "append", 0x65: "appends",
    0x29: "new_tuple", 0x74: "push_tuple_since_mark", 0x85: "tuple1", 0x86: "tuple2", 0x87: "tuple3",
    0x7D: "new_dict", 0x64: "push_dict_since_mark", 0x73: "set_item", 0x75: "set_items",
    0x8F: "new_set", 0x90: "appends", 0x91: "push_list_since_mark",
    0x63: "name_in_lines", 0x93: "name_on_stack", 0x52: "reduce", 0x62: "build",
}  # fmt: skip
"""Code of an operation (see `pickletools`) -> its method, and the width in bytes of its argument or of the argument's length."""
