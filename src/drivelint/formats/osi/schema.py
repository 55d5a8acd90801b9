"""Protobuf descriptors for the part of ASAM OSI 3 that drivelint writes, and that it reads from logs without a schema.

They are built from `schema.toml`. Some messages are only read.
"""

from __future__ import annotations

import re
from functools import cache
from typing import Any, Final

from google.protobuf import descriptor_pb2, message_factory

from drivelint.facts import toml_beside
from drivelint.formats.protobuf.descriptors import Declarations, add_field

PACKAGE: Final = "osi3"
GROUND_TRUTH: Final = f"{PACKAGE}.GroundTruth"
SENSOR_VIEW: Final = f"{PACKAGE}.SensorView"
OPEN_DRIVE: Final = f"{PACKAGE}.MapAsamOpenDrive"
OPEN_DRIVE_REFERENCE: Final = "net.asam.opendrive"
"""The type of an `ExternalReference` to an object in an OpenDRIVE map."""
LIGHT_REFERENCE: Final = "drivelint.light"
"""drivelint's own type of an `ExternalReference`, from a bulb without an OpenDRIVE signal to its light."""
WRITTEN_OSI_VERSION: Final = (3, 7, 0)
"""The version of OSI that is written."""


@cache
def _declarations(*schema_sections: str) -> Declarations:
    return Declarations(*(toml_beside(__file__, "schema.toml")[part] for part in schema_sections))


@cache
def enum_numbers(enum_name: str) -> dict[str, int]:
    """Return name -> number for a written enumeration; names are those in `schema.toml`."""
    return {word: int(number) for word, number in _declarations("written").enums[enum_name]}


def _file_descriptor(*schema_sections: str) -> descriptor_pb2.FileDescriptorProto:
    file = descriptor_pb2.FileDescriptorProto(name="osi_written.proto", package=PACKAGE, syntax="proto2")
    declared = _declarations(*schema_sections)
    types: dict[str, Any] = {}
    for name in [*declared.messages, *declared.enums]:
        outer, _, own_name = name.rpartition(".")
        home = types[outer] if outer else file
        kind = "enum_type" if name in declared.enums else "nested_type" if outer else "message_type"
        types[name] = getattr(home, kind).add(name=own_name)
    for name, values in declared.enums.items():
        prefix = re.sub(r"(?<=[a-z])(?=[A-Z])", "_", types[name].name).upper()
        for word, number in values:
            types[name].value.add(name=f"{prefix}_{word}", number=int(number))
    for name, fields in declared.messages.items():
        for field in fields:
            add_field(types[name], field, PACKAGE, declared.enums)
    return file


@cache
def descriptor_set(*extra_sections: str) -> bytes:
    """Return the serialised `FileDescriptorSet` of the written messages, for an MCAP schema record. "read" adds the read messages."""
    return descriptor_pb2.FileDescriptorSet(file=[_file_descriptor("written", *extra_sections)]).SerializeToString(
        deterministic=True
    )


@cache
def _message_classes() -> dict[str, Any]:
    return message_factory.GetMessages([_file_descriptor("written", "read")])


def message_class(name: str) -> Any:
    """Return the Python class of an OSI message, such as GroundTruth. It is for single messages; batches are decoded by columns."""
    return _message_classes()[f"{PACKAGE}.{name}"]
