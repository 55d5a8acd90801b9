"""Loads mappings of ROS 2 messages of other types: TOML that states for each topic which fields are the quantities of its actors."""

from __future__ import annotations

import os
import tomllib
from pathlib import Path
from typing import Final

import msgspec

from drivelint.errors import UsageError
from drivelint.formats.tables.mapping import (
    Columns,
    CoordinateFrame,
    EgoChoice,
    Mapping,
    PositionReference,
    TimeColumn,
    WordMapping,
    read_toml,
    refuse_unknown_keys,
    validate,
)

TIME_COLUMN: Final = "t_ns"
"""The column with the time of a message."""


class MappedTopic(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """One topic: the tables of a mapping, with fields in place of columns.

    `items`: the list in the message with one item per actor, whose fields `columns` names; None: the message is of one actor.
    `time`: the field with the time.
    """

    topic: str
    columns: Columns
    items: str | None = None
    time: str = "header.stamp"
    reference: PositionReference = PositionReference()
    actor_class: WordMapping | None = msgspec.field(default=None, name="class")
    indicator: WordMapping | None = None
    brake_light: WordMapping | None = None


class RosMappingFile(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """A whole mapping file.

    `message_files`: a folder, relative to the mapping, with files `PACKAGE/msg/NAME.msg`, for logs without message definitions.
    `one_frame`: all positions are in one fixed frame, whatever frames the messages name.
    """

    ros: list[MappedTopic]
    message_files: str | None = None
    one_frame: bool = False
    description: str = ""
    frame: CoordinateFrame = CoordinateFrame()
    ego: EgoChoice = EgoChoice()

    def table_mapping(self, topic: MappedTopic) -> Mapping:
        """Return the mapping of the table that a topic's messages become."""
        return Mapping(
            time=TimeColumn(TIME_COLUMN, "ns"), columns=topic.columns, frame=self.frame, reference=topic.reference,
            actor_class=topic.actor_class, indicator=topic.indicator, brake_light=topic.brake_light, ego=self.ego,
        )  # fmt: skip


# built at import, because msgspec analyses a type at its first use without a lock
DECODER = msgspec.json.Decoder(RosMappingFile)


def is_message_mapping(name: str) -> bool:
    """Return whether a mapping is a file with `[[ros]]`. False if it cannot be read, because the reader of mappings reports that."""
    if not os.path.isfile(name):  # noqa: PTH113 - also of a name that is too long for a file
        return False
    try:
        return "ros" in tomllib.loads(Path(name).read_text(encoding="utf-8"))
    except (OSError, ValueError, RecursionError):
        return False


def load(path: Path) -> RosMappingFile:
    """Return the content of a mapping. Errors: `UsageError` with file, wrong key and the most similar valid key."""
    raw = read_toml(path)
    refuse_unknown_keys(path, raw, RosMappingFile, "")
    try:
        message_mapping = msgspec.convert(raw, RosMappingFile)
    except msgspec.ValidationError as error:
        raise UsageError(f"mapping {path}: {error}") from error
    topics = [entry.topic for entry in message_mapping.ros]
    if not topics or len(set(topics)) < len(topics):
        raise UsageError(f"mapping {path}: each [[ros]] needs a topic of its own")
    for topic in message_mapping.ros:
        validate(path, message_mapping.table_mapping(topic))
    return message_mapping
