"""Loads and checks mapping files: TOML that states how the columns of a table become actor states.

A field is a column name (`x = "pos_x"`), a constant in SI (`length = 4.8`) or a table
`{ column = "v", unit = "km/h" }` / `{ value = "7" }`. `{k}` in a column name means the number of a column group:
the table is wide, with one group per actor.
"""

from __future__ import annotations

import math
import os
import re
import tomllib
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, get_args, get_origin

import msgspec

from drivelint.drive.trace import ACTOR_CLASSES, BRAKE_LIGHTS, INDICATORS
from drivelint.errors import UsageError
from drivelint.formats.search import is_pipe_or_device
from drivelint.phrases import hint, path_hint
from drivelint.sql.words import nearest_word_hint
from drivelint.toml_text import parse_toml

if TYPE_CHECKING:
    from collections.abc import Set as AbstractSet

MAPPINGS_FOLDER = Path(__file__).parent / "mappings"

UNITS: dict[str, dict[str, float]] = {
    "length": {"m": 1.0, "cm": 0.01, "mm": 0.001, "km": 1000.0, "ft": 0.3048},
    "angle": {"rad": 1.0, "deg": 0.017453292519943295},
    "speed": {"m/s": 1.0, "km/h": 1.0 / 3.6, "mph": 0.44704, "kn": 1852.0 / 3600.0, "ft/s": 0.3048},
    "acceleration": {"m/s2": 1.0, "g": 9.80665, "ft/s2": 0.3048},
    "rate": {"rad/s": 1.0, "deg/s": 0.017453292519943295},
}
"""Quantity -> unit -> factor to SI. The first unit of each quantity is the SI unit and the default."""
TIME_UNITS = {"s": 1_000_000_000, "ms": 1_000_000, "us": 1_000, "ns": 1, "min": 60_000_000_000}
"""Unit of time -> nanoseconds."""
GROUP_PLACEHOLDER = "{k}"


class Field(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """The source of one quantity: a column or a constant `value`, in `unit` (default: SI)."""

    column: str | None = None
    value: str | float | None = None
    unit: str | None = None


FieldSpec = str | float | Field


class TextLayout(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """The layout of a text file: cell separator, number of lines before the header, and words that mean: no value."""

    separator: str = ","
    skip_rows: int = 0
    null_values: list[str] = []


class TimeColumn(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """The time column and its unit. If it counts frames, `rate_hz` is the number of frames per second."""

    column: str
    unit: Literal["s", "ms", "us", "ns", "min", "frames"] = "s"
    rate_hz: float | None = None

    @property
    def unit_ns(self) -> float:
        """The nanoseconds of one unit; of a frame, they may be no whole number."""
        return TIME_UNITS[self.unit] if self.rate_hz is None else 1e9 / self.rate_hz


class CoordinateFrame(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """The log's frame relative to the map's.

    `flip_y`: change the signs of y, vy and ay; `flip_yaw`: change the sign of the heading. `yaw_zero`: the direction of heading 0.
    `velocity`: whether velocity and acceleration are in the world frame or along the vehicle's own axes. `map_offset_m`: added to
    the map's coordinates to get the log's.
    """

    flip_y: bool = False
    flip_yaw: bool = False
    yaw_zero: Literal["east", "north"] = "east"
    velocity: Literal["world", "vehicle"] = "world"
    map_offset_m: tuple[float, float] | None = None


class PositionReference(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """The point of the vehicle whose position the log has, and the offset from this point to the box centre."""

    point: Literal["centre", "rear_axle", "front_bumper"] = "centre"
    forward: FieldSpec | None = None
    left: FieldSpec | None = None
    up: FieldSpec | None = None


class Columns(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """The quantities of an actor state. Velocity is `vx` and `vy`, or `speed` along the heading; without these, it is derived."""

    actor_id: FieldSpec
    x: FieldSpec
    y: FieldSpec
    z: FieldSpec | None = None
    yaw: FieldSpec | None = None
    vx: FieldSpec | None = None
    vy: FieldSpec | None = None
    speed: FieldSpec | None = None
    ax: FieldSpec | None = None
    ay: FieldSpec | None = None
    yaw_rate: FieldSpec | None = None
    length: FieldSpec | None = None
    width: FieldSpec | None = None
    height: FieldSpec | None = None


class WordPattern(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """A regular expression that is searched in the column's text, and the word for a text that matches."""

    match: str
    word: str = msgspec.field(name="is")


class WordMapping(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """The translation of a column's text to one of drivelint's words: by `values` first, then `patterns`, then `default`.

    The texts of several columns are joined by `/` before the translation. Without a column, every row has the word `default`.
    """

    column: str | list[str] = []
    values: dict[str, str] = {}
    patterns: list[WordPattern] = []
    default: str | None = None

    @property
    def columns(self) -> list[str]:
        """The columns as a list."""
        return [self.column] if isinstance(self.column, str) else self.column


class EgoChoice(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """The choice of the ego: the first of `ids` that the log has; without any, if `otherwise = "first"`, the first vehicle of the table."""

    ids: list[str] = []
    otherwise: Literal["first"] | None = None


class Mapping(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """A whole mapping file."""

    time: TimeColumn
    columns: Columns
    description: str = ""
    table: TextLayout = TextLayout()
    frame: CoordinateFrame = CoordinateFrame()
    reference: PositionReference = PositionReference()
    actor_class: WordMapping | None = msgspec.field(default=None, name="class")
    indicator: WordMapping | None = None
    brake_light: WordMapping | None = None
    ego: EgoChoice = EgoChoice()


# built at import, because msgspec analyses a type at its first use without a lock, and crashes if two threads do so at once
DECODER = msgspec.json.Decoder(Mapping)
FIELD_QUANTITIES = {
    "x": "length", "y": "length", "z": "length", "yaw": "angle", "vx": "speed", "vy": "speed", "speed": "speed",
    "ax": "acceleration", "ay": "acceleration", "yaw_rate": "rate",
    "length": "length", "width": "length", "height": "length", "forward": "length", "left": "length", "up": "length",
}  # fmt: skip
"""Field -> its quantity, as in `UNITS`."""


def shipped_mappings() -> list[str]:
    """Return the names of the mappings that come with drivelint."""
    return sorted(file.stem for file in MAPPINGS_FOLDER.glob("*.toml"))


def refuse_unknown_mapping(name: str) -> None:
    """Raise `UsageError` if `name` is neither a file nor a shipped mapping; it proposes the most similar name."""
    shipped = sorted(
        file.stem for file in MAPPINGS_FOLDER.parents[1].glob("*/mappings/*.toml")
    )  # also mappings of films
    if is_pipe_or_device(name):
        raise UsageError(f"mapping {name}: a pipe or a device: write its output to a file, and give that file")
    if not os.path.isfile(name) and name not in shipped:  # noqa: PTH113 - also of a name that is too long for a file
        suggestion = path_hint(Path(name)) if name.endswith(".toml") else ""
        raise UsageError(f"mapping {name!r}: neither a file nor a shipped mapping: {suggestion or hint(name, shipped)}")


def load(name: str) -> tuple[str, Mapping]:
    """Return name and content of a mapping. `name`: a path, or if there is no such file, the name of a shipped mapping.

    Errors: `UsageError` with file, wrong key and the most similar valid key.
    """
    path = Path(name)
    if not os.path.isfile(name):  # noqa: PTH113 - as above
        refuse_unknown_mapping(name)
        path = MAPPINGS_FOLDER / f"{name}.toml"
    raw = read_toml(path)
    refuse_unknown_keys(path, raw, Mapping, "")
    try:
        mapping = msgspec.convert(raw, Mapping)
    except msgspec.ValidationError as error:
        raise UsageError(f"mapping {path}: {error}") from error
    validate(path, mapping)
    return path.stem, mapping


def read_toml(path: Path) -> dict[str, Any]:
    """Return the content of a mapping file. Errors: `UsageError` if it cannot be read or is not TOML."""
    try:
        return parse_toml(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise UsageError(f"mapping {path}: cannot be read: {error.strerror or error}") from error
    except (tomllib.TOMLDecodeError, UnicodeDecodeError, RecursionError) as error:
        raise UsageError(f"mapping {path}: not valid TOML: {error}") from error


def to_field(spec: FieldSpec) -> Field:
    """Convert a column name, a number or a Field into a Field."""
    if isinstance(spec, Field):
        return spec
    return Field(column=spec) if isinstance(spec, str) else Field(value=spec)


def fields(mapping: Mapping) -> dict[str, Field]:
    """Return name -> field for all fields in the mapping, including the offsets of the reference point."""
    specs = {**msgspec.structs.asdict(mapping.columns), **msgspec.structs.asdict(mapping.reference)}
    return {name: to_field(spec) for name, spec in specs.items() if spec is not None and name != "point"}


def word_mappings(mapping: Mapping) -> dict[str, tuple[WordMapping, tuple[str, ...]]]:
    """Return drivelint's column -> its translation in the mapping, and the allowed words."""
    specs = {
        "actor_class": (mapping.actor_class, ACTOR_CLASSES),
        "indicator": (mapping.indicator, INDICATORS),
        "brake_light": (mapping.brake_light, BRAKE_LIGHTS),
    }
    return {name: (spec, allowed_words) for name, (spec, allowed_words) in specs.items() if spec is not None}


def needed_columns(mapping: Mapping) -> list[str]:
    """Return the distinct names of all columns that the mapping reads; `{k}` is not replaced."""
    names = [mapping.time.column, *(f.column for f in fields(mapping).values() if f.column is not None)]
    names += [name for spec, _ in word_mappings(mapping).values() for name in spec.columns]
    return list(dict.fromkeys(names))


def refuse_unknown_keys(path: Path, raw: Any, kind: Any, key_prefix: str) -> None:
    """Raise `UsageError` for a key that a struct does not have. `key_prefix`: the keys above, each with a dot."""
    parts = _component_types(kind)
    struct = next((part for part in parts if isinstance(part, type) and issubclass(part, msgspec.Struct)), None)
    if struct is None or isinstance(raw, list) != any(get_origin(part) is list for part in parts):
        return
    field_by_key = {info.encode_name: info for info in msgspec.structs.fields(struct)}
    for table in raw if isinstance(raw, list) else [raw]:
        for key, value in table.items() if isinstance(table, dict) else ():
            if key not in field_by_key:
                raise UsageError(
                    f"mapping {path}: unknown key {key_prefix + key!r}: {hint(key, field_by_key, cutoff=0.5)}"
                )
            refuse_unknown_keys(path, value, field_by_key[key].type, f"{key_prefix}{key}.")


def _component_types(kind: Any) -> tuple[Any, ...]:
    return (kind, *(part for item in get_args(kind) for part in _component_types(item)))


def validate(path: Path, mapping: Mapping) -> None:
    """Raise `UsageError` for mistakes that the types do not detect."""
    if len(mapping.table.separator) != 1 or mapping.table.skip_rows < 0:
        raise UsageError(f"mapping {path}: table.separator must be one character and table.skip_rows not negative")
    for name, spec in fields(mapping).items():
        _validate_field(path, name, spec)
    for is_wrong, contradiction in _possible_contradictions(mapping, fields(mapping).keys()):
        if is_wrong:
            raise UsageError(f"mapping {path}: {contradiction}")
    for name, (choice, allowed_words) in word_mappings(mapping).items():
        _validate_words(path, name, choice, allowed_words)


def _validate_field(path: Path, name: str, spec: Field) -> None:
    units = UNITS.get(FIELD_QUANTITIES.get(name, ""), {})
    if (spec.column is None) == (spec.value is None):
        raise UsageError(f"mapping {path}: {name}: give either a column or a value")
    if spec.unit is not None and spec.unit not in units:
        advice = f"use {', '.join(units)}" if units else "this field takes no unit"
        raise UsageError(f"mapping {path}: {name}: unknown unit {spec.unit!r}: {advice}")
    if name in FIELD_QUANTITIES and isinstance(spec.value, str):
        raise UsageError(f"mapping {path}: {name}: the value {spec.value!r} is not a number")


def _possible_contradictions(mapping: Mapping, names: AbstractSet[str]) -> list[tuple[bool, str]]:
    """Return each possible contradiction: whether the mapping has it, and its description. `names`: the fields of the mapping."""
    point = mapping.reference.point
    heading = "speed" in names or mapping.frame.velocity == "vehicle" or point != "centre"
    has_groups = any(GROUP_PLACEHOLDER in name for name in needed_columns(mapping))
    rate = mapping.time.rate_hz
    return [
        ((mapping.time.unit == "frames") != (rate is not None),
          "time.unit = 'frames' needs time.rate_hz, the frames per second, and no other unit takes it"),
        (rate is not None and not 0.0 < rate < math.inf, "time.rate_hz must be more than 0"),
        (("vx" in names) != ("vy" in names) or ("ax" in names) != ("ay" in names), "vx and vy need each other, and so do ax and ay"),
        ("vx" in names and "speed" in names, "give vx and vy or speed, not both"),
        (heading and "yaw" not in names,
         "speed, frame.velocity = 'vehicle' and a reference point other than the centre need columns.yaw"),
        (point == "rear_axle" and "forward" not in names, "reference.point = 'rear_axle' needs reference.forward"),
        (point == "front_bumper" and ("length" not in names or "forward" in names),
         "reference.point = 'front_bumper' needs columns.length and must not have reference.forward"),
        (point == "centre" and not names.isdisjoint({"forward", "left", "up"}),
         "reference.forward, left and up need reference.point = 'rear_axle'"),
        (mapping.ego.otherwise is not None and not has_groups,
         "ego.otherwise = 'first' needs column groups ({k}): the rows of a long table have no first actor"),
    ]  # fmt: skip


def _validate_words(path: Path, name: str, spec: WordMapping, words: tuple[str, ...]) -> None:
    for word in (*spec.values.values(), *(p.word for p in spec.patterns), spec.default):
        if word is not None and word not in words:
            raise UsageError(
                f"mapping {path}: {name}: {word!r} is not one of its words: {nearest_word_hint(word, words)}"
            )
    for pattern in spec.patterns:
        try:
            re.compile(pattern.match)
        except re.error as error:
            raise UsageError(
                f"mapping {path}: {name}: pattern {pattern.match!r} is not a regular expression: {error}"
            ) from error
