"""Type names for numpy arrays, and conversions of arrays, such as codes to texts and back."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    import pyarrow as pa

Floats = NDArray[np.float64]
Times = NDArray[np.int64]  # usually nanoseconds
Mask = NDArray[np.bool_]
Indices = NDArray[np.intp]
Codes = NDArray[np.int8]  # indices into a tuple of words, -1: unknown


def words_of_codes(codes: NDArray[np.integer], words: Sequence[str]) -> pa.Array:
    """Return the word of each code as an Arrow string array, -1 as NULL."""
    import pyarrow as pa

    indices = pa.array(codes, mask=codes < 0)
    return pa.DictionaryArray.from_arrays(indices, pa.array(words, pa.string())).cast(pa.string())


def floats(column: pa.Array | pa.ChunkedArray) -> Floats:
    """Return a column as numbers, with NaN for NULL."""
    return np.asarray(column.to_numpy(zero_copy_only=False), np.float64)


def rotate_vectors(x: Floats, y: Floats, angle_rad: Floats) -> tuple[Floats, Floats]:
    """Return vectors rotated counterclockwise by an angle (rad)."""
    cos, sin = np.cos(angle_rad), np.sin(angle_rad)
    return x * cos - y * sin, x * sin + y * cos


def wrap_angles(angle_rad: Floats) -> Floats:
    """Return angles (rad) wrapped into [-pi, pi]; an angle in this range keeps all its bits."""
    return angle_rad - 2.0 * np.pi * np.round(angle_rad / (2.0 * np.pi))


def replace_columns(table: pa.Table, columns: Mapping[str, Any]) -> pa.Table:
    """Return a table with new values in the given columns, whose types stay the same; NaN becomes NULL."""
    import pyarrow as pa

    for name, values in columns.items():
        at = table.schema.get_field_index(name)
        field = table.schema.field(at)
        table = table.set_column(at, field, pa.array(values, field.type, from_pandas=True))
    return table


def codes_of_texts(texts: pa.Array, code_of: Callable[[str], int]) -> Codes:
    """Return the code of each text, -1 for NULL; `code_of` is called once per distinct text."""
    import pyarrow.compute as pc

    encoded = pc.dictionary_encode(texts)
    codes = np.array([*map(code_of, encoded.dictionary.to_pylist()), -1], np.int8)
    return np.asarray(codes[pc.fill_null(encoded.indices, len(codes) - 1).to_numpy(zero_copy_only=False)], np.int8)
