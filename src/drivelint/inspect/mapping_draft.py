"""Drafts a mapping from the column names of a table; the user must correct the draft before use."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Final

from drivelint.facts import toml_beside
from drivelint.formats.tables.mapping import FIELD_QUANTITIES, TIME_UNITS, UNITS
from drivelint.result.text_templates import text_template
from drivelint.sql.words import vocabularies

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Mapping, Sequence

_WORD_PATTERN: Final = re.compile(r"[A-Z]?[a-z]+|[A-Z]+(?![a-z])|\d+")
_FACTS: Final = toml_beside(__file__, "mapping_words.toml")
_WORDS_BY_FUSED_WORD: Final[dict[str, str]] = _FACTS["fused"]
_UNIT_BY_WORD: Final[dict[str, str]] = _FACTS["units"]
_TIME, _FRAMES, _ID, _SPEED, _ACCELERATION, _FILLERS, _OTHER_WORDS = (
    frozenset[str](_FACTS[name]) for name in ("time", "frames", "id", "speed", "acceleration", "fillers", "others")
)
_WORDS_OF_FIELD: Final[dict[str, Collection[str]]] = _FACTS["fields"] | {"speed": _SPEED}
REQUIRED_FIELDS: Final = ("time", "actor_id", "x", "y")
_FIELD_ORDER: Final = (
    "actor_id", "x", "y", "z", "yaw", "vx", "vy", "speed", "ax", "ay", "length", "width", "height",
)  # fmt: skip


def draft_mapping(columns: Sequence[str], texts_of: Callable[[str], Sequence[str]]) -> str | None:
    """Return a draft mapping as TOML, with comments at the places to fill in; None for a table with too few columns.

    `texts_of`: a function that returns the distinct texts of a column.
    """
    column_by_field: dict[str, str] = {}
    for column in columns:
        field = _field_of_column(column)
        if field is not None:
            column_by_field.setdefault(field, column)
    for pair in (("vx", "vy"), ("ax", "ay")):
        if sum(name in column_by_field for name in pair) == 1:
            column_by_field = {name: column for name, column in column_by_field.items() if name not in pair}
    if "vx" in column_by_field or "yaw" not in column_by_field:
        column_by_field.pop("speed", None)
    if len(columns) < len(REQUIRED_FIELDS):
        return None
    frames = next(
        (column for column in columns if "frame" in (words := _column_words(column)) and words <= _FRAMES), None
    )
    time_unit = "time" in column_by_field and _unit_in_column_name(column_by_field["time"], dict(TIME_UNITS))
    if frames is not None and "time" not in column_by_field:
        column_by_field["time"], time_unit = frames, "frames"
    classes = (
        {text: _actor_class_of(text) for text in texts_of(column_by_field["class"])}
        if "class" in column_by_field
        else {}
    )
    of_fields = {name: UNITS.get(FIELD_QUANTITIES.get(name, ""), {}) for name in column_by_field}
    draft = text_template(__file__, "mapping_draft.toml.j2", text=_toml_string).render(
        column_by_field=column_by_field,
        others=[column for column in columns if column not in column_by_field.values()],
        time_unit=time_unit or "s",
        units={
            name: (_unit_in_column_name(column_by_field[name], units), next(iter(units), None))
            for name, units in of_fields.items()
        },
        order=_FIELD_ORDER,
        classes={text: word for text, word in classes.items() if word is not None},
        strange_classes=[text for text, word in classes.items() if word is None],
        required=REQUIRED_FIELDS,
    )
    return draft.removesuffix("\n")


def _actor_class_of(text: str) -> str | None:
    """Return the actor class that a text names, ignoring case, spaces and hyphens; None if it names no class."""
    return vocabularies()["actor_class"].known_spelling("_".join(text.split()).replace("-", "_"))


def _field_of_column(column: str) -> str | None:
    """Return the field of a mapping that a column's name suggests; None without a suggestion."""
    words = _column_words(column)
    bare = words - set(_UNIT_BY_WORD) - _FILLERS
    axes = words & {"x", "y", "z"}
    if len(axes) == 1:
        return _field_of_axis(next(iter(axes)), words, bare)
    if words & _OTHER_WORDS:
        return None
    for field, some in _WORDS_OF_FIELD.items():
        if not words.isdisjoint(some):
            return field
    if (bare and bare <= _TIME) or "nanos" in words:
        return "time"
    return "actor_id" if bare and bare <= _ID else None


def _field_of_axis(axis: str, words: set[str], bare_words: set[str]) -> str | None:
    kind = "v" if words & _SPEED else "a" if words & _ACCELERATION else ""
    if kind:
        return None if axis == "z" else f"{kind}{axis}"
    return axis if bare_words <= {axis} else None


def _column_words(column: str) -> set[str]:
    words = [word.lower() for word in _WORD_PATTERN.findall(column)]
    return {part for word in words for part in _WORDS_BY_FUSED_WORD.get(word, word).split()}


def _unit_in_column_name(column: str, unit_factors: Mapping[str, float]) -> str | None:
    in_brackets = re.findall(r"[\[(]([^\])]+)[\])]", column)
    units = [*in_brackets, *(_UNIT_BY_WORD.get(word) for word in sorted(_column_words(column)))]
    return next((unit for unit in units if unit in unit_factors), None)


def _toml_string(value: str) -> str:
    """Return a text as a TOML string."""
    escaped = value.replace("\\", "\\\\").replace('"', '\\"')
    return '"' + "".join(c if c.isprintable() else f"\\U{ord(c):08x}" for c in escaped) + '"'
