"""Decodes pickles of plain values and numpy arrays. Nothing of a file is imported, called or run.

The loop below knows the operations of protocols 2 to 5 that such values need, and the names that stand for arrays and containers; it
refuses every other name. A key is a text or a number, so that nothing has to be hashed that holds other values. What a file makes is
no larger than the file: an array is a view of its bytes.
"""

from __future__ import annotations

import struct
from math import prod
from typing import TYPE_CHECKING, Any, Final, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable

_NUMPY: Final = ("numpy.core", "numpy._core")  # before numpy 2, and since
_BUILTINS: Final = ("builtins", "__builtin__")  # Python 3's name, and Python 2's, which protocol 2 writes
_NAMES: Final = {
    **{(f"{core}.multiarray", "_reconstruct"): "array" for core in _NUMPY},
    **{(f"{core}.multiarray", "scalar"): "scalar" for core in _NUMPY},
    **{(f"{core}.numeric", "_frombuffer"): "view" for core in _NUMPY},
    ("numpy", "ndarray"): "type",
    ("numpy", "dtype"): "number type",
    ("collections", "defaultdict"): "dict",
    ("collections", "OrderedDict"): "dict",
    ("_codecs", "encode"): "encode",
    **{(module, name): "list" for module in _BUILTINS for name in ("set", "frozenset", "list")},
    **{(module, name): "bytes" for module in _BUILTINS for name in ("bytes", "bytearray")},
    **{(module, name): "type" for module in _BUILTINS for name in ("int", "long", "float", "bool", "str", "unicode")},
    **{(module, "dict"): "dict" for module in _BUILTINS},
}
"""(module, name) in a file -> what it stands for here; a set is a list of its members, in the order of the file."""
_KINDS: Final = "biufUS"
"""Kinds of numpy types that are read: numbers and texts."""
_KEYS: Final = (str, int, float, type(None))
_DAMAGED: Final = (ValueError, TypeError, KeyError, AttributeError, OverflowError, MemoryError, LookupError)
_REMEDY: Final = "copy or write it again"


class PickleError(ValueError):
    """A pickle that is damaged, cut off, or holds something else than plain values; caught where the file is named."""


class _Name(NamedTuple):
    """A name that the file gives, as it stands for something here."""

    meaning: str


class _NumberType:
    """A numpy type: its code, such as f8, and its byte order, which the file gives later."""

    def __init__(self, code: Any) -> None:
        if not (isinstance(code, str) and code[:1] in _KINDS and code[1:].isdecimal()):
            what = "Python objects" if str(code).startswith(("O", "V")) else f"the numpy type {str(code)[:20]!r}"
            raise PickleError(f"it holds an array of {what}, which is refused: write numbers")
        self.code, self.order = code, "="

    def numpy(self) -> np.dtype[Any]:
        """Return the type of numpy."""
        return np.dtype(self.order + self.code)


class _Array:
    """An array of which the content follows; `memo`: the number under which the file will refer to it."""

    def __init__(self, memo: int | None) -> None:
        self.memo = memo


def load(content: bytes) -> Any:
    """Return what a pickle holds: dicts, lists (also for sets), tuples, texts, numbers, None and numpy arrays, which are read-only.

    Errors: `PickleError` with the byte and what is wrong there.
    """
    machine = _Machine(content)
    try:
        return machine.run()
    except PickleError:
        raise
    except (IndexError, struct.error):
        raise PickleError(f"it is cut off or damaged at byte {machine.at} of {len(content)}: {_REMEDY}") from None
    except _DAMAGED as error:
        raise PickleError(f"it is damaged before byte {machine.at} ({error}): {_REMEDY}") from None


class _Machine:
    """A pickle that is decoded: its bytes and the place in them, the stack with its marks, and what the file refers to by number."""

    def __init__(self, content: bytes) -> None:
        self.content = content
        self.at = 0
        self.stack: list[Any] = []
        self.marks: list[int] = []
        self.memo: dict[int, Any] = {}
        self.to_copy = len(content)

    def run(self) -> Any:
        content, stack, memo = self.content, self.stack, self.memo
        push, number, real = stack.append, struct.Struct("<I").unpack_from, struct.Struct(">d").unpack_from
        at, end = 0, len(content)
        try:
            while at < end:
                code = content[at]
                at += 1
                # the operations that nearly all of a scenario is made of stand here, for speed; the others are in a table
                if code == 0x94:  # MEMOIZE
                    memo[len(memo)] = stack[-1]
                elif code == 0x47:  # BINFLOAT
                    push(real(content, at)[0])
                    at += 8
                elif code == 0x68:  # BINGET
                    push(memo[content[at]])
                    at += 1
                elif code == 0x6A:  # LONG_BINGET
                    push(memo[number(content, at)[0]])
                    at += 4
                elif code == 0x87:  # TUPLE3
                    stack[-3:] = [(stack[-3], stack[-2], stack[-1])]
                elif code == 0x4B:  # BININT1
                    push(content[at])
                    at += 1
                elif code == 0x2E:  # STOP
                    break
                else:
                    self.at = at
                    action = _ACTIONS.get(code)
                    if action is None:
                        what = f"the operation {bytes([code])!r}, which plain values do not need"
                        raise PickleError(f"byte {at - 1} has {what}: {_REMEDY}")
                    action(self)
                    at = self.at
            else:
                raise IndexError
        finally:
            self.at = at
        if len(stack) != 1 or self.marks:
            raise PickleError(f"it is damaged before byte {at}: {_REMEDY}")
        return stack[0]

    # ---- parts of the file and of the stack

    def part(self, n: int) -> bytes:
        """Return the next n bytes."""
        found = self.content[self.at : self.at + n]
        if len(found) < n:
            raise IndexError
        self.at += n
        return found

    def size(self, width: int) -> int:
        """Return the next `width` bytes as a number."""
        return int.from_bytes(self.part(width), "little")

    def since_mark(self) -> list[Any]:
        """Take from the stack all that stands above its last mark."""
        mark = self.marks.pop()
        found = self.stack[mark:]
        del self.stack[mark:]
        return found

    def take(self, n: int) -> tuple[Any, ...]:
        """Take the last n values from the stack, but none from below its last mark."""
        first = len(self.stack) - n
        if first < (self.marks[-1] if self.marks else 0):
            raise IndexError
        found = tuple(self.stack[first:])
        del self.stack[first:]
        return found

    # ---- operations

    def tuple_of(self, n: int) -> None:
        self.stack.append(self.take(n))

    def text(self, width: int) -> None:
        self.stack.append(self.part(self.size(width)).decode("utf-8", "surrogatepass"))

    def raw(self, width: int) -> None:
        self.stack.append(self.part(self.size(width)))

    def integer(self, width: int) -> None:
        self.stack.append(int.from_bytes(self.part(width), "little", signed=True))

    def long(self, width: int) -> None:
        self.integer(self.size(width))

    def put(self, width: int) -> None:
        self.memo[self.size(width)] = self.stack[-1]

    def append(self) -> None:
        (value,) = self.take(1)
        self._list().append(value)

    def appends(self) -> None:
        values = self.since_mark()
        self._list().extend(values)

    def set_item(self) -> None:
        self._set(list(self.take(2)))

    def set_items(self) -> None:
        self._set(self.since_mark())

    def new_dict(self) -> None:
        values = self.since_mark()
        self.stack.append({})
        self._set(values)

    def _list(self) -> list[Any]:
        target = self.stack[-1]
        if type(target) is not list:
            raise TypeError("values for what is no list")
        return target

    def _set(self, values: list[Any]) -> None:
        target = self.stack[-1]
        if type(target) is not dict or len(values) % 2:
            raise TypeError("keys and values for what is no dict")
        for key in values[::2]:
            if not isinstance(key, _KEYS):
                raise PickleError(f"byte {self.at} ends a dict with a key that is neither text nor number: {_REMEDY}")
        target.update(zip(values[::2], values[1::2], strict=True))

    def line_name(self) -> None:
        end = self.content.index(b"\n", self.content.index(b"\n", self.at) + 1) + 1
        module, name = self.part(end - self.at).decode().split("\n")[:2]
        self._name(module, name)

    def stack_name(self) -> None:
        self._name(*self.take(2))

    def _name(self, module: Any, name: Any) -> None:
        meaning = _NAMES.get((module, name)) if isinstance(module, str) and isinstance(name, str) else None
        if meaning is None:
            what = f"{str(module)[:100]}.{str(name)[:100]}"
            raise PickleError(
                f"byte {self.at} calls for {what!r}, which is refused: only numpy arrays and plain values are read"
            )
        self.stack.append(_Name(meaning))

    def reduce(self) -> None:
        name, arguments = self.take(2)
        if not isinstance(name, _Name) or not isinstance(arguments, tuple):
            raise TypeError("a call of what is no name")
        self.stack.append(self._made(name.meaning, arguments))

    def _made(self, meaning: str, arguments: tuple[Any, ...]) -> Any:
        if meaning == "array":
            return _Array(self._memo_of_next())
        if meaning == "number type":
            return _NumberType(arguments[0])
        if meaning == "scalar":
            kind, raw = arguments
            return self._view(raw, kind, (1,), "C")[0].item()
        if meaning == "view":
            raw, kind, shape, order = arguments
            return self._view(raw, kind, shape, order)
        if meaning == "encode":
            self.to_copy -= len(arguments[0])
            if self.to_copy < 0:
                raise PickleError(f"byte {self.at} asks for more bytes than the file has: {_REMEDY}")
            return arguments[0].encode("latin-1")
        if meaning in {"dict", "list", "bytes"}:
            return self._container(meaning, arguments)
        raise TypeError("a call of what is no container")

    def _container(self, meaning: str, arguments: tuple[Any, ...]) -> Any:
        """Return an empty container, or the one that the file gives as its content; the default of a dict is not kept."""
        given = next((value for value in arguments if not isinstance(value, (_Name, str))), None)
        if given is not None and type(given).__name__ != meaning:
            raise TypeError(f"a {meaning} made of something else")
        return {"dict": dict, "list": list, "bytes": bytes}[meaning]() if given is None else given

    def _memo_of_next(self) -> int | None:
        """Return the number under which the file will refer to the value that is made now; None: it will not."""
        following = self.content[self.at : self.at + 5]
        if following[:1] == b"\x94":
            return len(self.memo)
        width = {b"q": 1, b"r": 4}.get(following[:1])
        return None if width is None else int.from_bytes(following[1 : 1 + width], "little")

    def build(self) -> None:
        (state,) = self.take(1)
        target = self.stack[-1]
        if isinstance(target, _NumberType):
            _, order, *structure = state
            if order not in {"<", ">", "|", "="} or any(part is not None for part in structure[:3]):
                raise PickleError(f"byte {self.at} ends an array of Python objects, which is refused: write numbers")
            target.order = order
        elif isinstance(target, _Array):
            _, shape, kind, is_fortran, raw = state
            array = self._view(raw, kind, shape, "F" if is_fortran else "C")
            self.stack[-1] = array
            if target.memo is not None:
                self.memo[target.memo] = array
        else:
            raise TypeError("content for what is no array")

    def _view(self, raw: Any, kind: Any, shape: Any, order: Any) -> np.ndarray[Any, Any]:
        if not isinstance(kind, _NumberType) or not isinstance(raw, bytes) or order not in {"C", "F"}:
            raise PickleError(f"byte {self.at} ends an array of Python objects, which is refused: write numbers")
        kind_of_number = kind.numpy()
        if not (isinstance(shape, tuple) and all(type(n) is int and n >= 0 for n in shape)):
            raise TypeError("an array without a shape")
        if prod(shape) * kind_of_number.itemsize != len(raw):
            raise PickleError(f"byte {self.at} ends an array of another size than its shape {shape} says: {_REMEDY}")
        return np.frombuffer(raw, kind_of_number, prod(shape)).reshape(shape, order=order)


_ACTIONS: Final[dict[int, Callable[[_Machine], Any]]] = {
    0x80: lambda m: m.part(1),  # PROTO
    0x95: lambda m: m.part(8),  # FRAME
    0x28: lambda m: m.marks.append(len(m.stack)),  # MARK
    0x30: lambda m: m.take(1),  # POP
    0x31: lambda m: m.since_mark(),  # POP_MARK
    0x4E: lambda m: m.stack.append(None),  # NONE
    0x88: lambda m: m.stack.append(True),  # NEWTRUE
    0x89: lambda m: m.stack.append(False),  # NEWFALSE
    0x4D: lambda m: m.stack.append(m.size(2)),  # BININT2
    0x4A: lambda m: m.integer(4),  # BININT
    0x8A: lambda m: m.long(1),  # LONG1
    0x8B: lambda m: m.long(4),  # LONG4
    0x8C: lambda m: m.text(1),  # SHORT_BINUNICODE
    0x58: lambda m: m.text(4),  # BINUNICODE
    0x8D: lambda m: m.text(8),  # BINUNICODE8
    0x43: lambda m: m.raw(1),  # SHORT_BINBYTES
    0x42: lambda m: m.raw(4),  # BINBYTES
    0x8E: lambda m: m.raw(8),  # BINBYTES8
    0x96: lambda m: m.raw(8),  # BYTEARRAY8
    0x5D: lambda m: m.stack.append([]),  # EMPTY_LIST
    0x8F: lambda m: m.stack.append([]),  # EMPTY_SET
    0x7D: lambda m: m.stack.append({}),  # EMPTY_DICT
    0x29: lambda m: m.stack.append(()),  # EMPTY_TUPLE
    0x85: lambda m: m.tuple_of(1),  # TUPLE1
    0x86: lambda m: m.tuple_of(2),  # TUPLE2
    0x74: lambda m: m.stack.append(tuple(m.since_mark())),  # TUPLE
    0x6C: lambda m: m.stack.append(m.since_mark()),  # LIST
    0x91: lambda m: m.stack.append(m.since_mark()),  # FROZENSET
    0x64: _Machine.new_dict,  # DICT
    0x61: _Machine.append,  # APPEND
    0x65: _Machine.appends,  # APPENDS
    0x90: _Machine.appends,  # ADDITEMS
    0x73: _Machine.set_item,  # SETITEM
    0x75: _Machine.set_items,  # SETITEMS
    0x71: lambda m: m.put(1),  # BINPUT
    0x72: lambda m: m.put(4),  # LONG_BINPUT
    0x63: _Machine.line_name,  # GLOBAL
    0x93: _Machine.stack_name,  # STACK_GLOBAL
    0x52: _Machine.reduce,  # REDUCE
    0x62: _Machine.build,  # BUILD
}
"""Operation -> what it does, named as `pickletools` names it."""
