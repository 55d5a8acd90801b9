"""What is read of a damaged OSI trace file, what is lost, and when; a file is never silently another."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest

from drivelint.errors import TraceError
from tests.formats.logs import read, states
from tests.formats.osi.osi_file import drive, write

if TYPE_CHECKING:
    from pathlib import Path

    from drivelint.drive.trace import Trace

PERIOD_NS = 50_000_000
N = 8


@pytest.fixture
def whole(tmp_path: Path) -> bytes:
    return write(tmp_path / "whole.osi", drive(N)).read_bytes()


def starts(data: bytes) -> list[int]:
    """Return where each message's length stands, and the end of the file."""
    found, at = [], 0
    while at < len(data):
        found.append(at)
        at += 4 + int.from_bytes(data[at : at + 4], "little")
    return [*found, at]


def salvaged(tmp_path: Path, data: bytes) -> tuple[list[int], list[tuple[int | None, int | None]], list[str]]:
    """Return which frames are read, and times and words of what is lost."""
    path = tmp_path / "damaged.osi"
    path.write_bytes(data)
    trace = read(path)
    lost = [row for row in trace.tables["quality"].to_pylist() if row["check_id"] == "lost_time"]
    frames = sorted({row["t_ns"] // PERIOD_NS for row in states(trace)})
    return frames, [(row["t_first_ns"], row["t_last_ns"]) for row in lost], [row["message"] for row in lost]


def test_a_cut_file_has_all_before_the_cut(tmp_path: Path, whole: bytes) -> None:
    at = starts(whole)
    frames, lost, (told,) = salvaged(tmp_path, whole[: at[5] + 30])
    assert (frames, lost) == ([0, 1, 2, 3, 4], [(4 * PERIOD_NS, None)])
    assert f"damaged.osi: 30 bytes from byte {at[5]} on cannot be read" in told
    assert "from 0.200 s to the end is lost" in told


@pytest.mark.ci
def test_wherever_a_file_is_cut_it_is_lossy_or_a_whole_one(tmp_path: Path, whole: bytes) -> None:
    at = starts(whole)
    for cut in range(at[2], len(whole), 17):
        frames, lost, _ = salvaged(tmp_path, whole[:cut])
        n = sum(begin <= cut for begin in at) - 1
        assert frames == list(range(n))
        # a cut between two messages leaves no trace
        assert lost == ([] if cut in at else [((n - 1) * PERIOD_NS, None)])


def test_nothing_of_the_first_message_is_refused(tmp_path: Path, whole: bytes) -> None:
    path = tmp_path / "first.osi"
    path.write_bytes(whole[: starts(whole)[1] - 1])
    with pytest.raises(TraceError, match=r"first\.osi"):
        read(path)
    path.write_bytes(whole[:4] + b"\x0a" + b"\xff" * (starts(whole)[1] - 5))
    with pytest.raises(TraceError, match=r"first\.osi"):
        read(path)


@pytest.mark.parametrize(
    ("tail", "phrase"),
    [
        (bytes(500), "a message of 0 bytes at byte"),
        (b"\xff\xff\xff\xff\x0a", "should have 4294967295 bytes"),
        (b"\x08", "the file ends within the length of the message at byte"),
        (b"\x10\0\0\0" + b"\xff" * 40, "no message begins at byte"),
    ],
    ids=["zeros", "beyond the end", "one byte", "garbage"],
)
def test_what_follows_the_last_message(tmp_path: Path, whole: bytes, tail: bytes, phrase: str) -> None:
    frames, ((since, until),), (message,) = salvaged(tmp_path, whole + tail)
    assert (frames, until) == (list(range(N)), None)
    assert since in {(N - 1) * PERIOD_NS, (N - 1) * PERIOD_NS - 1}
    assert phrase in message
    assert f"{len(tail)} bytes from byte {len(whole)} on" in message


def test_a_message_beyond_the_cap_is_not_read(tmp_path: Path, whole: bytes, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("drivelint.formats.osi.trace_file.MOST_MESSAGE_BYTES", len(whole) - 1)
    long = len(whole).to_bytes(4, "little") + whole[4:] + b"more"
    frames, lost, (told,) = salvaged(tmp_path, whole + long)
    assert (frames, lost) == (list(range(N)), [((N - 1) * PERIOD_NS, None)])
    assert "which is too many" in told


@pytest.mark.sample(1)
@pytest.mark.parametrize("k", [0, 3, N - 1])
def test_one_malformed_message_is_lost_alone(tmp_path: Path, whole: bytes, k: int) -> None:
    at = starts(whole)
    begin = at[k] + (20 if k == 0 else 4)  # the first bytes of the first message tell the format
    frames, lost, (told,) = salvaged(tmp_path, whole[:begin] + b"\xff" * 14 + whole[begin + 14 :])
    assert frames == [i for i in range(N) if i != k]
    assert lost == [((k - 1) * PERIOD_NS if k else None, (k + 1) * PERIOD_NS if k < N - 1 else None)]
    assert f"{at[k + 1] - at[k]} bytes from byte {at[k]} on cannot be read (a message that cannot be decoded)" in told


def test_a_malformed_message_of_late_ones_may_have_been_late(tmp_path: Path) -> None:
    frames = drive(N)
    frames[2], frames[3] = frames[3], frames[2]
    data = write(tmp_path / "late.osi", frames).read_bytes()
    begin = starts(data)[5] + 4
    _, lost, _ = salvaged(tmp_path, data[:begin] + b"\xff" * 14 + data[begin + 14 :])
    assert lost == [(3 * PERIOD_NS, 7 * PERIOD_NS)]


@pytest.mark.sample(0, ci=1)
@pytest.mark.parametrize("k", [1, 4, N - 1])
def test_a_wrong_length_loses_all_behind_it(tmp_path: Path, whole: bytes, k: int) -> None:
    """No length but the right one leads to the next message: of whatever it leads to, nothing is believed."""
    at = starts(whole)
    path = tmp_path / "wrong.osi"
    path.write_bytes(whole)
    sound = rows(read(path))
    right = at[k + 1] - at[k] - 4
    for wrong in {*range(1, right + 40, 5), right + 1, right - 1, right + 4} - {right}:
        path.write_bytes(whole[: at[k]] + wrong.to_bytes(4, "little") + whole[at[k] + 4 :])
        found = read(path)
        (lost,) = (row for row in found.tables["quality"].to_pylist() if row["check_id"] == "lost_time")
        since = lost["t_first_ns"]
        assert [row for row in rows(found) if row["t_ns"] <= since] == [row for row in sound if row["t_ns"] <= since]
        assert max(row["t_ns"] for row in rows(found)) <= since + 1
        assert lost["t_last_ns"] is None


def rows(trace: Trace) -> list[dict[str, Any]]:
    """Return the states without the drive's name."""
    return [{**row, "drive_id": None} for row in states(trace)]
