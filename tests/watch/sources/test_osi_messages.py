"""What is read of an OSI message without decoding it is what a decoder says."""

from __future__ import annotations

import pytest
from google.protobuf.message import DecodeError
from hypothesis import given
from hypothesis import strategies as st

from drivelint.formats.osi.schema import GROUND_TRUTH, SENSOR_VIEW, message_class
from drivelint.formats.protobuf.scan import fields
from drivelint.watch.sources.osi_messages import is_complete_message, message_kind, message_time_ns
from tests.formats.osi import osi_file

SECONDS = st.integers(-(2**63), 2**63 - 1)
NANOS = st.integers(0, 2**32 - 1)


@given(SECONDS, NANOS)
def test_times(seconds: int, nanos: int) -> None:
    frame = osi_file.truth(0)
    frame.timestamp.seconds, frame.timestamp.nanos = seconds, nanos
    assert message_time_ns(frame.SerializeToString(), GROUND_TRUTH) == seconds * 10**9 + nanos


@given(st.booleans(), st.booleans())
def test_times_of_views(inner: bool, outer: bool) -> None:
    """The ground truth's own time counts before that of the view."""
    view = osi_file.view(osi_file.truth(3_000_000_000))
    view.timestamp.seconds = 5
    if not inner:
        view.global_ground_truth.ClearField("timestamp")
    if not outer:
        view.ClearField("timestamp")
    expected = 3_000_000_000 if inner else 5_000_000_000 if outer else None
    assert message_time_ns(view.SerializeToString(), SENSOR_VIEW) == expected


def test_kinds() -> None:
    frame = osi_file.truth(0)
    assert message_kind(frame.SerializeToString()) == GROUND_TRUTH
    assert message_kind(osi_file.view(frame).SerializeToString()) == SENSOR_VIEW
    frame.ClearField("moving_object")
    frame.traffic_light.add().id.value = 3  # the field number of a view's ground truth
    assert message_kind(frame.SerializeToString()) is None
    assert message_kind(b"\xff\xff") is None


@given(st.binary(max_size=60))
def test_any_bytes(data: bytes) -> None:
    """What a decoder takes is whole, if it has a time and no groups, which OSI never had."""
    try:
        decoded = message_class("GroundTruth").FromString(data)
    except DecodeError:
        return
    try:
        found = {field.number for field in fields(data)}
    except ValueError as error:
        assert "of kind" in str(error)  # noqa: PT017 (most examples raise nothing)
        return
    assert is_complete_message(data) == (2 in found)
    assert not decoded.HasField("timestamp") or 2 in found


@pytest.mark.parametrize("n_cut", range(1, 40))
def test_a_cut_message_is_not_whole_unless_it_ends_with_a_field(n_cut: int) -> None:
    data = osi_file.truth(10**9).SerializeToString()
    ends = {field.end for field in fields(data)}
    assert is_complete_message(data[:-n_cut]) == (len(data) - n_cut in ends)
