"""Decodes pickles of plain values and numpy arrays. Nothing of a file is imported, called or run.

`_PickleMachine` knows the operations of protocols 2 to 5 that such values need. It refuses all other operations, and all names except
those in `pickled_numpy`. A key of a dict must be a text or a number, so that no container is hashed. The decoded values are no larger
than the file: an array is a view of its bytes.
"""

from __future__ import annotations

import struct
from bisect import bisect_right
from functools import partial
from typing import TYPE_CHECKING, Any, Final, NoReturn

from drivelint.formats.scenarionet.pickle_shortcuts import Points, array_at, points_at
from drivelint.formats.scenarionet.pickled_numpy import (
    AllowedName,
    ArrayWithoutContent,
    NumberType,
    PickleError,
    allowed_name,
    array_from_state,
    build_value,
)

if TYPE_CHECKING:
    from collections.abc import Callable

_ARRAY_NAME: Final = AllowedName("array")
_KEY_TYPES: Final = frozenset({str, int, float, bool, type(None)})
_DAMAGE_ERRORS: Final = (ValueError, TypeError, AttributeError, OverflowError, MemoryError, LookupError)
_DAMAGE_REMEDY: Final = "copy or write it again"
_READ_UINT: Final = struct.Struct("<I").unpack_from
_READ_FLOAT: Final = struct.Struct(">d").unpack_from


class _EndOfPickleError(Exception):
    """Raised by the operation that ends a pickle."""


def load(content: bytes) -> Any:
    """Return the content of a pickle: dicts, lists (also for sets), tuples, texts, numbers, None and numpy arrays, which are read-only.

    A list of points may be `Points`. Errors: `PickleError` with the byte and what is wrong there.
    """
    machine = _PickleMachine(content)
    try:
        return machine.run()
    except PickleError as error:
        raise PickleError(f"byte {machine.at}: {error}") from None
    except (IndexError, struct.error):
        raise PickleError(
            f"it is cut off or damaged at byte {machine.at} of {len(content)}: {_DAMAGE_REMEDY}"
        ) from None
    except _DAMAGE_ERRORS as error:
        raise PickleError(f"it is damaged at byte {machine.at} ({error}): {_DAMAGE_REMEDY}") from None


class _PickleMachine:
    """Decodes a pickle: its bytes, the stack with its marks, and the memo, the objects to which the file refers by number.

    Each operation is a method that takes the position after its code and returns the position after its argument.
    """

    def __init__(self, content: bytes) -> None:
        self.content = content
        self.at = 0
        self.stack: list[Any] = []
        self.marks: list[int] = []
        self.memo: dict[int, Any] = {}
        self.next_memo_number = 0  # also the number of objects that have one, including the points in `points`
        self.points: list[Points] = []
        self.bytes_left_to_copy = len(content)

    def run(self) -> Any:
        """Return the value of the pickle."""
        content, memo, stack, number = self.content, self.memo, self.stack, _READ_UINT
        push, actions = stack.append, [self._method_of_operation(code) for code in range(256)]
        at = 0
        try:
            while True:
                code = content[at]
                at += 1
                # for speed, the most frequent operations are inline, and MEMOIZE, which follows most values
                if code == 0x68 and (value := memo.get(content[at])) is not None:  # BINGET
                    at += 1
                    if (
                        type(value) is AllowedName
                        and value == _ARRAY_NAME
                        and (shortcut := array_at(content, at, memo, self.next_memo_number))
                    ):
                        value, at, self.next_memo_number = shortcut
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
                    memo[self.next_memo_number] = stack[-1]
                    self.next_memo_number += 1
                    at += 1
        except _EndOfPickleError:
            if len(stack) != 1 or self.marks:
                raise ValueError("it ends within a value") from None
            return stack[0]
        finally:
            self.at = at

    def _method_of_operation(self, code: int) -> Callable[[int], int]:
        name, *widths = _OPERATIONS.get(code, "refuse_operation").split()
        method: Callable[..., int] = getattr(self, name)
        return partial(method, width=int(widths[0])) if widths else method

    def stop(self, _: int) -> NoReturn:
        raise _EndOfPickleError

    def refuse_operation(self, at: int) -> NoReturn:
        raise PickleError(
            f"the operation {self.content[at - 1 : at]!r}, which plain values do not need: {_DAMAGE_REMEDY}"
        )

    # ---- values

    def skip_protocol(self, at: int) -> int:
        return at + 1

    def skip_frame_length(self, at: int) -> int:
        return at + 8

    def push_none(self, at: int) -> int:
        self.stack.append(None)
        return at

    def push_true(self, at: int) -> int:
        self.stack.append(True)
        return at

    def push_false(self, at: int) -> int:
        self.stack.append(False)
        return at

    def push_unsigned(self, at: int, width: int) -> int:
        self.stack.append(int.from_bytes(self._bytes_at(at, width), "little"))
        return at + width

    def push_signed(self, at: int, width: int) -> int:
        self.stack.append(int.from_bytes(self._bytes_at(at, width), "little", signed=True))
        return at + width

    def push_long(self, at: int, width: int) -> int:
        begin, end = self._span_after_length(at, width)
        self.stack.append(int.from_bytes(self.content[begin:end], "little", signed=True))
        return end

    def push_float(self, at: int) -> int:
        self.stack.append(_READ_FLOAT(self.content, at)[0])
        return at + 8

    def push_text(self, at: int, width: int) -> int:
        begin, end = self._span_after_length(at, width)
        self.stack.append(str(self.content[begin:end], "utf-8", "surrogatepass"))
        return end

    def push_bytes(self, at: int, width: int) -> int:
        begin, end = self._span_after_length(at, width)
        self.stack.append(self.content[begin:end])
        return end

    def _span_after_length(self, at: int, width: int) -> tuple[int, int]:
        """Return begin and end of the bytes that follow a length of `width` bytes."""
        begin = at + width
        end = begin + int.from_bytes(self._bytes_at(at, width), "little")
        if end > len(self.content):
            raise IndexError
        return begin, end

    def _bytes_at(self, at: int, n: int) -> bytes:
        if at + n > len(self.content):
            raise IndexError
        return self.content[at : at + n]

    # ---- the memo and the stack

    def memoize(self, at: int) -> int:
        self.memo[self.next_memo_number] = self.stack[-1]
        self.next_memo_number += 1
        return at

    def memoize_as(self, at: int, width: int) -> int:
        number = int.from_bytes(self._bytes_at(at, width), "little")
        self.next_memo_number += number not in self.memo
        self.memo[number] = self.stack[-1]
        return at + width

    def push_memo_value(self, at: int, width: int) -> int:
        number = int.from_bytes(self._bytes_at(at, width), "little")
        self.stack.append(self.memo[number] if number in self.memo else self._point_of_memo_number(number))
        return at + width

    def _point_of_memo_number(self, number: int) -> Any:
        """Return the point with this memo number, of a list in `points`."""
        k = bisect_right(self.points, number, key=lambda point: point.first_memo_number) - 1
        if k < 0 or number >= self.points[k].first_memo_number + self.points[k].n:
            raise IndexError
        return self.points[k].point_of_memo_number(number)

    def set_mark(self, at: int) -> int:
        self.marks.append(len(self.stack))
        return at

    def pop(self, at: int) -> int:
        self._pop_values(1)
        return at

    def pop_mark(self, at: int) -> int:
        self._pop_to_mark()
        return at

    def _pop_to_mark(self) -> list[Any]:
        """Remove the values above the last mark from the stack, and return them."""
        mark = self.marks.pop()
        values = self.stack[mark:]
        del self.stack[mark:]
        return values

    def _pop_values(self, n: int) -> tuple[Any, ...]:
        """Remove the last n values from the stack, and return them. Errors: `IndexError` if one is below the last mark."""
        first = len(self.stack) - n
        if first < (self.marks[-1] if self.marks else 0):
            raise IndexError
        values = tuple(self.stack[first:])
        del self.stack[first:]
        return values

    # ---- containers

    def push_empty_list(self, at: int) -> int:
        points_and_end = points_at(self.content, at, self.next_memo_number)
        if points_and_end is None:
            self.stack.append([])
            return at
        points, end = points_and_end
        self.points.append(points)
        self.stack.append(points)
        self.memo[self.next_memo_number] = points
        self.next_memo_number += 1 + points.n
        return end

    def push_empty_set(self, at: int) -> int:
        self.stack.append([])
        return at

    def push_list_since_mark(self, at: int) -> int:
        self.stack.append(self._pop_to_mark())
        return at

    def append_item(self, at: int) -> int:
        (value,) = self._pop_values(1)
        self._extend_list((value,))
        return at

    def append_items(self, at: int) -> int:
        self._extend_list(self._pop_to_mark())
        return at

    def _extend_list(self, values: Any) -> None:
        target: Any = self.stack[-1]
        if type(target) is Points:  # a pickle writes a long list in several parts
            rows = target.as_list()
            self.memo[target.first_memo_number - 1] = self.stack[-1] = target = rows
        if type(target) is not list:
            raise TypeError("values for something that is not a list")
        target.extend(values)

    def push_empty_tuple(self, at: int) -> int:
        self.stack.append(())
        return at

    def push_tuple_since_mark(self, at: int) -> int:
        self.stack.append(tuple(self._pop_to_mark()))
        return at

    def push_tuple1(self, at: int) -> int:
        self.stack.append(self._pop_values(1))
        return at

    def push_tuple2(self, at: int) -> int:
        self.stack.append(self._pop_values(2))
        return at

    def push_tuple3(self, at: int) -> int:
        self.stack.append(self._pop_values(3))
        return at

    def push_empty_dict(self, at: int) -> int:
        self.stack.append({})
        return at

    def push_dict_since_mark(self, at: int) -> int:
        values = self._pop_to_mark()
        self.stack.append({})
        self._set_dict_items(values)
        return at

    def set_item(self, at: int) -> int:
        self._set_dict_items(self._pop_values(2))
        return at

    def set_items(self, at: int) -> int:
        self._set_dict_items(self._pop_to_mark())
        return at

    def _set_dict_items(self, values: Any) -> None:
        target, keys = self.stack[-1], values[::2]
        if type(target) is not dict or len(values) % 2:
            raise TypeError("keys and values for something that is not a dict")
        if not _KEY_TYPES.issuperset(map(type, keys)):
            raise PickleError(f"a key that is neither text nor number: {_DAMAGE_REMEDY}")
        target.update(zip(keys, values[1::2], strict=True))

    # ---- names and what is made with them

    def push_name_from_two_lines(self, at: int) -> int:
        middle = self.content.index(b"\n", at)
        end = self.content.index(b"\n", middle + 1)
        self.stack.append(allowed_name(self.content[at:middle].decode(), self.content[middle + 1 : end].decode()))
        return end + 1

    def push_name_from_stack_top(self, at: int) -> int:
        self.stack.append(allowed_name(*self._pop_values(2)))
        return at

    def create_named_value(self, at: int) -> int:
        name, arguments = self._pop_values(2)
        if type(name) is not AllowedName or type(arguments) is not tuple:
            raise TypeError("a call of something that is not a name")
        if name.meaning == "array":
            value: Any = ArrayWithoutContent(self._memo_number_at(at))
        elif name.meaning == "encode":
            value = self._latin1_bytes(arguments[0])
        else:
            value = build_value(name.meaning, arguments)
        self.stack.append(value)
        return at

    def _memo_number_at(self, at: int) -> int | None:
        """Return the memo number that the operation at this position gives to the new value; None: it gives no number."""
        following = self.content[at : at + 5]
        if following[:1] == b"\x94":
            return self.next_memo_number
        width = {b"q": 1, b"r": 4}.get(following[:1])
        return None if width is None else int.from_bytes(following[1 : 1 + width], "little")

    def _latin1_bytes(self, text: str) -> bytes:
        """Return the bytes that protocol 2 writes as a text."""
        self.bytes_left_to_copy -= len(text)
        if self.bytes_left_to_copy < 0:
            raise PickleError(f"more bytes than the file has: {_DAMAGE_REMEDY}")
        return text.encode("latin-1")

    def set_state_of_value(self, at: int) -> int:
        (state,) = self._pop_values(1)
        target = self.stack[-1]
        if isinstance(target, NumberType):
            target.set_byte_order(state)
        elif isinstance(target, ArrayWithoutContent):
            self.stack[-1] = array_from_state(state)
            if target.memo_number is not None:
                self.memo[target.memo_number] = self.stack[-1]
        else:
            raise TypeError("content for something that is not an array")
        return at


_OPERATIONS: Final = {
    0x80: "skip_protocol", 0x95: "skip_frame_length", 0x2E: "stop",
    0x4E: "push_none", 0x88: "push_true", 0x89: "push_false",
    0x4B: "push_unsigned 1", 0x4D: "push_unsigned 2", 0x4A: "push_signed 4", 0x8A: "push_long 1", 0x8B: "push_long 4", 0x47: "push_float",
    0x8C: "push_text 1", 0x58: "push_text 4", 0x8D: "push_text 8",
    0x43: "push_bytes 1", 0x42: "push_bytes 4", 0x8E: "push_bytes 8", 0x96: "push_bytes 8",
    0x94: "memoize", 0x71: "memoize_as 1", 0x72: "memoize_as 4", 0x68: "push_memo_value 1", 0x6A: "push_memo_value 4",
    0x28: "set_mark", 0x30: "pop", 0x31: "pop_mark",
    0x5D: "push_empty_list", 0x6C: "push_list_since_mark", 0x61: "append_item", 0x65: "append_items",
    0x29: "push_empty_tuple", 0x74: "push_tuple_since_mark", 0x85: "push_tuple1", 0x86: "push_tuple2", 0x87: "push_tuple3",
    0x7D: "push_empty_dict", 0x64: "push_dict_since_mark", 0x73: "set_item", 0x75: "set_items",
    0x8F: "push_empty_set", 0x90: "append_items", 0x91: "push_list_since_mark",
    0x63: "push_name_from_two_lines", 0x93: "push_name_from_stack_top", 0x52: "create_named_value", 0x62: "set_state_of_value",
}  # fmt: skip
"""Code of an operation (see `pickletools`) -> its method, and the width in bytes of its argument or of the argument's length."""
