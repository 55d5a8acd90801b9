"""OSI over UDP: messages of which every datagram came are as they were sent, and what was lost is unknown to the checker."""

from __future__ import annotations

import random
import socket
import time
from itertools import accumulate, pairwise
from typing import TYPE_CHECKING, Final

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import drivelint
from drivelint.errors import TraceError
from drivelint.watch.sources import open_source
from drivelint.watch.sources.osi import with_length_prefix
from drivelint.watch.sources.osi_datagrams import DATAGRAM_HEADER, Datagram, MessageAssembler
from tests.faults import drives
from tests.formats.logs import read, states
from tests.watch.sources.windows import times

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence
    from pathlib import Path

N: Final = 40
STEP_NS: Final = 100_000_000
MESSAGES: Final = [truth.SerializeToString() for truth in drives.truths(drives.drive(N))]
TIMES: Final = [k * STEP_NS for k in range(N)]
PARTS: Final = 3
"""The datagrams of these tests are so small that every message needs three."""
MICROSECOND_NS: Final = 1000


def split(message: bytes, n: int = PARTS) -> list[bytes]:
    """Return the datagrams of a message as esmini sends them."""
    most = -(-len(message) // n)
    parts = [message[at : at + most] for at in range(0, len(message), most)]
    counters = [*range(1, len(parts)), -len(parts)]
    return [DATAGRAM_HEADER.pack(counter, len(part)) + part for counter, part in zip(counters, parts, strict=True)]


def sent(messages: Iterable[bytes], n: int = PARTS) -> list[Datagram]:
    """Return all datagrams, those of a message one after another at once."""
    return [
        Datagram(data, "esmini", k * STEP_NS + place * MICROSECOND_NS)
        for k, message in enumerate(messages)
        for place, data in enumerate(split(message, n))
    ]


def assembled(datagrams: Iterable[Datagram]) -> tuple[list[bytes], MessageAssembler]:
    assembler = MessageAssembler("udp://:1")
    found = [message for each in datagrams if (message := assembler.add_datagram(each)) is not None]
    return found, assembler


@pytest.mark.parametrize("n", [PARTS, 1])
def test_all_that_came(n: int) -> None:
    found, assembler = assembled(sent(MESSAGES, n))
    assert found == MESSAGES
    assert assembler.losses.total == 0


def test_what_comes_twice_counts_once() -> None:
    twice = [each for message in MESSAGES for part in sent([message], 1) for each in (part, part)]
    found, assembler = assembled(twice)
    assert (found, assembler.losses.total) == (MESSAGES, 0)


def disturbed(seed: int, loss: float, again: float, swapped: float) -> list[Datagram]:
    """Return the datagrams with some lost, some twice, and some in the place of the next.

    None is late by a whole step: nothing tells it from the next message's own.
    """
    draw = random.Random(seed)  # noqa: S311
    there = [each for each in sent(MESSAGES) if draw.random() >= loss]
    there = [each for one in there for each in ([one, one] if draw.random() < again else [one])]
    for k in range(len(there) - 1):
        near = there[k + 1].at_ns - there[k].at_ns < STEP_NS // 2
        if near and draw.random() < swapped:
            there[k], there[k + 1] = there[k + 1], there[k]
    at = accumulate(
        (each.at_ns for each in there), max
    )  # none comes before it was sent, nor before the one that came before it
    return [Datagram(each.data, each.sender, at_ns) for each, at_ns in zip(there, at, strict=True)]


@settings(max_examples=150)
@given(
    st.integers(0, 10**6),
    st.sampled_from([0.0, 0.01, 0.1, 0.4]),
    st.sampled_from([0.0, 0.2]),
    st.sampled_from([0.0, 0.1]),
)
def test_nothing_is_made_up(seed: int, loss: float, again: float, swapped: float) -> None:
    came = disturbed(seed, loss, again, swapped)
    found, assembler = assembled(came)
    places = [MESSAGES.index(message) for message in found]
    assert places == sorted(set(places))
    if len(came) != len(sent(MESSAGES)) and len(found) == N:
        assert again
    if loss == 0.0 and swapped == 0.0 and again == 0.0:
        assert len(found) == N
    if 0 < len(found) < N - max(places[0], N - 1 - places[-1]) - 1:
        assert assembler.losses.total
    # any hole is one for the checker, unless whole messages were lost without a trace
    datagrams = {each.data for each in came}
    for before, after in pairwise(places):
        traces = [part for message in MESSAGES[before + 1 : after] for part in split(message) if part in datagrams]
        assert after == before + 1 or not traces or after - before >= 3


def test_a_burst_that_takes_the_end_of_one_and_the_beginning_of_the_next() -> None:
    """What is left of both counts 1, 2, -3."""
    datagrams = sent(MESSAGES)
    came = datagrams[: 10 * PARTS + 1] + datagrams[11 * PARTS + 1 :]
    assert assembled(came)[0] == MESSAGES[:10] + MESSAGES[13:]


def test_a_loss_before_any_step_of_time_is_known() -> None:
    datagrams = sent(MESSAGES)
    del datagrams[PARTS + 1]
    assert assembled(datagrams)[0] == [MESSAGES[0], *MESSAGES[4:]]


def test_the_end_of_a_message_that_comes_within_the_next_one() -> None:
    datagrams = sent(MESSAGES)
    late, missing = 10 * PARTS + 2, 11 * PARTS + 2
    came = datagrams[:late] + datagrams[late + 1 : missing] + [datagrams[late]] + datagrams[missing + 1 :]
    assert assembled(came)[0] == MESSAGES[:10] + MESSAGES[13:]


def test_what_the_system_drops_of_a_sender_on_this_machine() -> None:
    """It is counted, so that the same burst is seen even where nobody knows when the datagrams came."""
    datagrams = [Datagram(each.data, each.sender, 0, 0, local=True) for each in sent(MESSAGES)]
    behind = [Datagram(each.data, each.sender, 0, PARTS, local=True) for each in datagrams[11 * PARTS + 1 :]]
    found, assembler = assembled(datagrams[: 10 * PARTS + 1] + behind)
    assert found == MESSAGES[:10] + MESSAGES[13:]
    assert f"{PARTS} datagrams for which the buffer had no room" in assembler.losses.summary_text()


def test_another_sender_is_another_drive() -> None:
    other = [Datagram(each.data, "another", each.at_ns) for each in sent(MESSAGES[20:], 1)]
    both = [each for pair in zip(sent(MESSAGES, 1), other, strict=False) for each in pair]
    found, assembler = assembled(both)
    assert found == MESSAGES[:20]
    assert "20 datagrams of another sender" in assembler.losses.summary_text()


@pytest.mark.parametrize(
    "data",
    [b"", b"GET / HTTP/1.0", DATAGRAM_HEADER.pack(-1, 3) + b"\xff\xff\xff", DATAGRAM_HEADER.pack(-1, 9) + b"abc"],
)
def test_what_is_no_osi_is_left_out(data: bytes) -> None:
    found, assembler = assembled([Datagram(data, "esmini"), *sent(MESSAGES)])
    assert found == MESSAGES
    assert assembler.losses.strange == 1


def test_an_old_esmini_is_refused() -> None:
    with pytest.raises(TraceError, match="counted from 0"):
        assembled([Datagram(DATAGRAM_HEADER.pack(0, 4) + b"\x0a\x00\x0a\x00", "esmini")])


def free_port() -> int:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as found:
        found.bind(("127.0.0.1", 0))
        port: int = found.getsockname()[1]
        return port


def received(folder: Path, datagrams: Sequence[bytes]) -> tuple[list[int], list[str], Path]:
    """Send datagrams to a source; return the times of its frames, its notes and the recording."""
    port = free_port()
    source = open_source(f"udp://127.0.0.1:{port}", folder, idle_s=0.5)
    found: list[int] = []
    notes: list[str] = []
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
        for k, each in enumerate(datagrams):
            sender.sendto(each, ("127.0.0.1", port))
            if k % 10 == 9:
                found += times(source.read(0.01) or [])
                notes += source.notes()
    until = time.monotonic() + 10
    while (frames := source.read(0.2)) is not None:
        found += times(frames)
        assert time.monotonic() < until
    source.close()
    notes += source.notes()
    return found, notes, source.recording


def test_a_socket(tmp_path: Path) -> None:
    found, notes, recording = received(tmp_path, [part for message in MESSAGES for part in split(message)])
    assert (found, notes) == (TIMES, [])
    assert recording.read_bytes() == b"".join(map(with_length_prefix, MESSAGES))


def test_lost_frames_become_unknown_and_never_pass(tmp_path: Path) -> None:
    """One datagram of one message is lost: a single missing step would be bridged by the checker."""
    datagrams = [part for message in MESSAGES for part in split(message)]
    lost = 20
    del datagrams[lost * PARTS + 1]
    found, notes, recording = received(tmp_path, datagrams)
    assert found == TIMES[:lost] + TIMES[lost + 2 :]
    assert len(notes) <= 2
    assert "datagrams missing or out of order in 1 place" in notes[-1]
    assert {row["t_ns"] for row in states(read(recording))} == set(found)
    whole = tmp_path / "whole.osi"
    whole.write_bytes(b"".join(map(with_length_prefix, MESSAGES)))
    rows = drivelint.check([recording, whole], rules="ukhc.no-collision", annotate=False).verdicts.arrow().to_pylist()
    assert {row["verdict"] for row in rows if row["drive_id"].startswith("whole")} == {"pass"}
    rows = [row for row in rows if row["drive_id"].startswith("recording")]
    begin, end = TIMES[lost - 1], TIMES[lost + 2]
    holes = [row for row in rows if row["reason_code"] == "log_hole"]
    assert {(row["verdict"], row["t_start_ns"], row["t_end_ns"]) for row in holes} == {("unknown", begin, end)}
    assert all(row["t_end_ns"] <= begin or row["t_start_ns"] >= end for row in rows if row["verdict"] == "pass")
