"""Copies the content that only the first OSI message of a drive has into a later message."""

from __future__ import annotations

from typing import Any, Final

from google.protobuf.message import DecodeError

from drivelint.formats.osi.schema import SENSOR_VIEW, message_class

_FIELDS_OF_FIRST_MESSAGE: Final = (
    "lane_boundary", "lane", "reference_line", "logical_lane_boundary", "logical_lane", "traffic_sign", "road_marking",
    "proj_string", "proj_frame_offset",
)  # fmt: skip
"""Fields that the reader takes from the first message only, see `formats.osi.decode.read_first_message`."""
_LIGHT_STATE_FIELDS: Final = ("color", "mode")
"""The fields of a traffic light that change over time; the others are copied from the first message, too."""
_ADDED_FIELD: Final = "stationary_object"
"""Things that do not move: a later message may have others, or none, because they stand in the first message."""


class StaticContent:
    """The map, projection, traffic lights and stationary objects of the first message; empty if this message cannot be decoded."""

    def __init__(self, first: bytes, name: str) -> None:
        self._name = name
        self._first: Any = None
        try:
            truth = _ground_truth(_decoded_message(first, name), name)
        except DecodeError:
            return
        static = message_class("GroundTruth")()
        for field in _FIELDS_OF_FIRST_MESSAGE:
            _copy_field(truth, static, field)
        _copy_field(truth, static, _ADDED_FIELD)
        static.traffic_light.extend(truth.traffic_light)
        for bulb in static.traffic_light:
            for field in _LIGHT_STATE_FIELDS:
                bulb.classification.ClearField(field)
        self._first = static

    def add_to_message(self, data: bytes) -> bytes:
        """Return a later message with the static content of the first one, so that a log can start with it.

        The states of its traffic lights are kept. A traffic light that it does not contain is added with an unknown state.
        """
        if self._first is None:
            return data
        try:
            message = _decoded_message(data, self._name)
        except DecodeError:
            return data
        truth = _ground_truth(message, self._name)
        for field in _FIELDS_OF_FIRST_MESSAGE:
            truth.ClearField(field)
            _copy_field(self._first, truth, field)
        _copy_field(self._first, truth, _ADDED_FIELD)  # the reader counts what is there twice once
        bulb_by_id = {bulb.id.value: bulb for bulb in truth.traffic_light}
        for bulb in self._first.traffic_light:
            if bulb.id.value not in bulb_by_id:
                truth.traffic_light.append(bulb)
            elif not bulb_by_id[bulb.id.value].HasField("base"):
                _add_place_and_lanes(bulb_by_id[bulb.id.value], bulb)
        whole: bytes = message.SerializeToString(deterministic=True)
        return whole


def _decoded_message(data: bytes, name: str) -> Any:
    return message_class(name.removeprefix("osi3.")).FromString(data)


def _ground_truth(message: Any, name: str) -> Any:
    return message.global_ground_truth if name == SENSOR_VIEW else message


def _copy_field(source: Any, target: Any, field: str) -> None:
    value = getattr(source, field)
    if isinstance(value, str):
        if source.HasField(field):
            setattr(target, field, value)
    elif hasattr(value, "extend"):
        getattr(target, field).extend(value)
    elif source.HasField(field):
        getattr(target, field).CopyFrom(value)


def _add_place_and_lanes(bulb: Any, first: Any) -> None:
    """Add the place and lanes from the first message to a traffic-light bulb that has only a state."""
    state = type(bulb).FromString(bulb.SerializeToString())
    bulb.CopyFrom(first)
    for field in _LIGHT_STATE_FIELDS:
        if state.classification.HasField(field):
            setattr(bulb.classification, field, getattr(state.classification, field))
