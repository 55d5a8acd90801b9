"""Reads OSI's stationary objects (pylons, poles, walls, trees) as outlines: a box, or the polygon of its base.

Not read are kinds that vehicles drive under or over: bridges, overhead structures, speed bumps and curbstones.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc
import shapely

from drivelint.arrays import rotate_vectors
from drivelint.drive.outlines.shapes import Outline, box_shape
from drivelint.formats.osi.schema import GROUND_TRUTH
from drivelint.formats.protobuf.descriptors import enum_names, integer_values, list_items_and_row_indices, struct_field

if TYPE_CHECKING:
    from collections.abc import Mapping

    from drivelint.arrays import Floats
    from drivelint.formats.protobuf.descriptors import FieldTree, SchemaTypes

STATIONARY_FIELDS: Final[FieldTree] = {
    "id": {"value": None},
    "base": {
        "dimension": {"length": None, "width": None, "height": None},
        "position": {"x": None, "y": None, "z": None},
        "orientation": {"yaw": None},
        "base_polygon": {"x": None, "y": None},
    },
    "classification": {"type": None},
}
_TYPE_PREFIX: Final = "TYPE_"
_KINDS_TO_DRIVE_UNDER_OR_OVER: Final = frozenset({"bridge", "overhead structure", "speed bump", "curbstone"})
_COLUMNS: Final = (
    ("position", "x"), ("position", "y"), ("position", "z"), ("orientation", "yaw"),
    ("dimension", "length"), ("dimension", "width"), ("dimension", "height"),
)  # fmt: skip


class Outlines(dict[tuple[object, ...], Outline]):
    """The outlines of a log by all that it states of each; `n_unplaced`: how many lack a position."""

    n_unplaced = 0


def kind_by_number(types: SchemaTypes) -> dict[int, str]:
    """Return the words for the types of stationary objects in a schema; empty if it has none."""
    names = enum_names(types, GROUND_TRUTH, "stationary_object", "classification", "type")
    return {number: name.removeprefix(_TYPE_PREFIX).replace("_", " ").lower() for number, name in names.items()}


def outlines(truth: pa.Array, kinds: Mapping[int, str]) -> Outlines:
    """Return the different outlines in a batch of ground truths."""
    different = Outlines()
    objects, _ = list_items_and_row_indices(truth, "stationary_object")
    if not len(objects):
        return different
    base = struct_field(objects, "base")
    columns = [_numbers(struct_field(base, vector), name) for vector, name in _COLUMNS]
    is_placed = struct_field(base, "position").is_valid().to_numpy(zero_copy_only=False)
    different.n_unplaced = int((~is_placed).sum())
    numbers = integer_values(struct_field(objects, "id"), "value", pa.uint64())
    kind = integer_values(struct_field(objects, "classification"), "type", pa.int64())
    facts = np.column_stack([numbers.astype(np.float64), kind, *columns])
    _, first = np.unique(np.where(np.isfinite(facts), facts, 0.0), axis=0, return_index=True)
    polygons, owner = list_items_and_row_indices(base, "base_polygon")
    corners = np.column_stack([_numbers(polygons, name) for name in "xy"]) if len(polygons) else np.zeros((0, 2))
    for row in first[is_placed[first]]:
        word = kinds.get(int(kind[row]), "object")
        if word not in _KINDS_TO_DRIVE_UNDER_OR_OVER:
            place = corners[owner == row]
            x, y, z, yaw, length, width, height = (float(column[row]) for column in columns)
            name = f"{'stationary object' if word in {'unknown', 'other', 'object'} else word} {numbers[row]}"
            if len(place) > 2:
                along, across = rotate_vectors(place[:, 0], place[:, 1], np.full(len(place), yaw))
                shape = shapely.convex_hull(shapely.multipoints(np.column_stack([x + along, y + across])))
            else:
                shape = box_shape(x, y, yaw, length, width)
            different[name, shape.wkb, z, height] = Outline(name, shape, z, height)
    return different


def _numbers(vector: pa.Array, name: str) -> Floats:
    """Return a coordinate; 0 where it is missing, as writers omit zeros, or not finite."""
    values = pc.fill_null(struct_field(vector, name).cast(pa.float64()), 0.0).to_numpy(zero_copy_only=False)
    return np.where(np.isfinite(values), values, 0.0)
