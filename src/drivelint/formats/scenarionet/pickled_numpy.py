"""The names that a pickle may use, and the numpy arrays, numbers and containers that are created for them."""

from __future__ import annotations

from math import prod
from typing import TYPE_CHECKING, Any, Final, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable

_NUMPY_CORES: Final = ("numpy.core", "numpy._core")  # before numpy 2, and since
_BUILTINS: Final = ("builtins", "__builtin__")  # Python 3's name, and Python 2's, which protocol 2 writes
_MEANING_BY_NAME: Final = {
    **{(f"{core}.multiarray", "_reconstruct"): "array" for core in _NUMPY_CORES},
    **{(f"{core}.multiarray", "scalar"): "scalar" for core in _NUMPY_CORES},
    **{(f"{core}.numeric", "_frombuffer"): "view" for core in _NUMPY_CORES},
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
"""(module, name) in a file -> its meaning here. A set becomes a list of its members, in the order of the file."""
_NUMPY_KINDS: Final = "biufUS"
"""The kinds of numpy types that are read: numbers and texts."""
_CONTAINER_BY_MEANING: Final[dict[str, Callable[[], Any]]] = {"dict": dict, "list": list, "bytes": bytes}
_OBJECT_ARRAY_REFUSAL: Final = "it has an array of Python objects, which is refused: write numbers"


class PickleError(ValueError):
    """Raised for a pickle that is damaged, cut off, or contains more than plain values; the caller adds the name of the file."""


class AllowedName(NamedTuple):
    """A name in the file, represented by its meaning in `_MEANING_BY_NAME`."""

    meaning: str


def allowed_name(module: Any, name: Any) -> AllowedName:
    """Return the meaning of a name in the file. Errors: `PickleError` for a name that is refused."""
    meaning = _MEANING_BY_NAME.get((module, name)) if isinstance(module, str) and isinstance(name, str) else None
    if meaning is None:
        full_name = f"{str(module)[:100]}.{str(name)[:100]}"
        raise PickleError(f"it requests {full_name!r}, which is refused: only numpy arrays and plain values are read")
    return AllowedName(meaning)


class NumberType:
    """A numpy type: its code, such as f8, and its byte order, which follows later in the file."""

    def __init__(self, code: Any) -> None:
        if not (isinstance(code, str) and code[:1] in _NUMPY_KINDS and code[1:].isdecimal()):
            raise PickleError(_OBJECT_ARRAY_REFUSAL)
        self.code = code
        self.numpy = np.dtype(code)

    def set_byte_order(self, state: Any) -> None:
        """Set the byte order. Errors: `PickleError` for a type with fields."""
        _, order, *structure = state
        if order not in {"<", ">", "|", "="} or any(part is not None for part in structure[:3]):
            raise PickleError(_OBJECT_ARRAY_REFUSAL)
        self.numpy = np.dtype(order + self.code)


class ArrayWithoutContent:
    """An array whose content follows in the file. `memo_number`: the number by which the file refers to the array."""

    def __init__(self, memo_number: int | None) -> None:
        self.memo_number = memo_number


def array_from_state(state: Any) -> np.ndarray[Any, Any]:
    """Return an array from its pickled state: (version, shape, type, whether in Fortran's order, bytes). Errors: `PickleError`."""
    _, shape, kind, is_fortran, raw = state
    return _array_view(raw, kind, shape, "F" if is_fortran else "C")


def build_value(meaning: str, arguments: tuple[Any, ...]) -> Any:
    """Return the value that a name creates from these arguments; not for arrays without content and bytes from texts."""
    if meaning == "number type":
        return NumberType(arguments[0])
    if meaning == "scalar":
        kind, raw = arguments
        return _array_view(raw, kind, (1,), "C")[0].item()
    if meaning == "view":
        raw, kind, shape, order = arguments
        return _array_view(raw, kind, shape, order)
    # the container among the arguments, else an empty one; the default value of a defaultdict is not kept
    argument = next((value for value in arguments if not isinstance(value, (AllowedName, str))), None)
    if argument is not None and type(argument).__name__ != meaning:
        raise TypeError(f"a {meaning} made of something else")
    return _CONTAINER_BY_MEANING[meaning]() if argument is None else argument


def _array_view(raw: Any, kind: Any, shape: Any, order: Any) -> np.ndarray[Any, Any]:
    if type(kind) is not NumberType or type(raw) is not bytes or order not in {"C", "F"}:
        raise PickleError(_OBJECT_ARRAY_REFUSAL)
    if type(shape) is not tuple or {*map(type, shape)} - {int} or min(shape, default=0) < 0:
        raise TypeError("an array without a shape")
    if prod(shape) * kind.numpy.itemsize != len(raw):
        raise ValueError(f"the size of an array does not match its shape {shape}")
    return np.ndarray(shape, kind.numpy, raw, order=order)
