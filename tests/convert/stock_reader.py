"""Reads MCAP as others do."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

from google.protobuf import descriptor_pb2, descriptor_pool, message_factory
from mcap.reader import make_reader

if TYPE_CHECKING:
    from pathlib import Path


def messages(path: Path) -> list[tuple[str, int, Any]]:
    """Read an MCAP with the stock reader and Google's parser: topic, log time, message."""
    found = []
    with path.open("rb") as file:
        for schema, channel, message in make_reader(file, validate_crcs=True).iter_messages(log_time_order=False):
            assert schema is not None
            if schema.encoding == "jsonschema":
                found.append((channel.topic, message.log_time, json.loads(message.data)))
                continue
            pool = descriptor_pool.DescriptorPool()
            for each in descriptor_pb2.FileDescriptorSet.FromString(schema.data).file:
                pool.Add(each)
            kind = message_factory.GetMessageClass(pool.FindMessageTypeByName(schema.name))
            found.append((channel.topic, message.log_time, kind.FromString(message.data)))
    return found
