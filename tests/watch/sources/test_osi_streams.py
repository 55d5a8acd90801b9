"""OSI messages from a file that grows, standard input and TCP."""

from __future__ import annotations

import os
import signal
import socket
import subprocess
import sys
import threading
import time
from itertools import pairwise
from typing import TYPE_CHECKING, Any, Final

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from drivelint.errors import TraceError, UsageError
from drivelint.watch.sources import open_source, osi
from drivelint.watch.sources.background import BackgroundReader
from drivelint.watch.sources.osi_messages import MessageCutter
from drivelint.watch.sources.transports import blocks_of_descriptor
from tests.formats.logs import read, states
from tests.formats.osi import osi_file
from tests.shared_data import ROOT, shared
from tests.watch.sources.windows import assert_windows_are_spans, drained, times

if TYPE_CHECKING:
    from collections.abc import Generator
    from pathlib import Path

    from drivelint.watch.source import Source

N: Final = 20
MESSAGES: Final = [frame.SerializeToString() for frame in osi_file.drive(N)]
WHOLE: Final = b"".join(map(osi.with_length_prefix, MESSAGES))
TIMES: Final = [k * 50_000_000 for k in range(N)]


@settings(max_examples=50)
@given(st.lists(st.integers(0, len(WHOLE)), max_size=20))
def test_any_cut_gives_the_same(cuts: list[int]) -> None:
    cutter = MessageCutter()
    found = [m for a, b in pairwise([0, *sorted(cuts), len(WHOLE)]) for m in cutter.cut(WHOLE[a:b])]
    assert found == MESSAGES
    assert cutter.cut(b"", ended=True) == []
    assert cutter.trouble is None


@given(
    st.integers(1, len(WHOLE) - 1), st.binary(min_size=1, max_size=40), st.lists(st.integers(0, len(WHOLE)), max_size=5)
)
def test_any_cut_of_garbled_bytes_gives_the_same(place: int, garbage: bytes, cuts: list[int]) -> None:
    garbled = WHOLE[:place] + garbage + WHOLE[place + len(garbage) :]
    at_once, piece_by_piece = MessageCutter(), MessageCutter()
    found = at_once.cut(garbled, ended=True)
    ends = [0, *sorted(min(cut, len(garbled)) for cut in cuts), len(garbled)]
    others = [m for a, b in pairwise(ends) for m in piece_by_piece.cut(garbled[a:b])]
    others += piece_by_piece.cut(b"", ended=True)
    assert (found, at_once.trouble) == (others, piece_by_piece.trouble)


def test_a_file_that_grows(tmp_path: Path) -> None:
    path = tmp_path / "log.osi"
    source = open_source(str(path), tmp_path, idle_s=0.2)
    assert source.read(0.0) == []
    found: list[int] = []
    for start in range(0, len(WHOLE), 777):
        with path.open("ab") as file:
            file.write(WHOLE[start : start + 777])
        found += times(source.read(0.0) or [])
    assert found == TIMES
    assert drained(source) == []
    assert source.recording == path
    source.close()


def test_a_file_that_ends_within_a_message(tmp_path: Path) -> None:
    path = tmp_path / "log.osi"
    path.write_bytes(WHOLE[:-10])
    source = osi.open_file(path, idle_s=0.0)
    assert times(drained(source)) == TIMES[:-1]
    assert "of the message that begins" in source.notes()[0]
    assert source.notes() == []


def test_what_is_no_message_ends_it(tmp_path: Path) -> None:
    path = tmp_path / "log.osi"
    path.write_bytes(WHOLE + b"\xff" * 1000)
    source = osi.open_file(path, idle_s=None)
    assert times(drained(source)) == TIMES
    assert "nothing after that is read" in source.notes()[0]


@pytest.mark.sample(2, ci=2)
@pytest.mark.parametrize("name", ["acc-test", "alks_cut-in", "highway_merge", "pedestrian"])
def test_windows_of_reference_files(tmp_path: Path, name: str) -> None:
    assert_windows_are_spans(osi.open_file(shared(f"osi/{name}.osi"), idle_s=0.0), tmp_path, ego="all")


def lights_and_lanes(*, views: bool) -> list[Any]:
    """Return frames of which only the first has lanes and all that is known of the traffic lights, as esmini writes them."""
    frames = osi_file.drive(30)
    frames[0].lane.add().id.value = 3
    boundary = frames[0].lane_boundary.add()
    boundary.id.value = 4
    boundary.boundary_line.add().position.x = 1.0
    frames[0].proj_string = "+proj=utm +zone=32"
    for k, frame in enumerate(frames):
        for number, color in ((50, 2), (51, 4)):
            bulb = frame.traffic_light.add()
            bulb.id.value = number
            bulb.classification.color = color
            bulb.classification.mode = 3 if (number == 50) == (k < 12) else 2
            if k == 0:
                bulb.base.position.x, bulb.base.position.z = 5.0, 3.0 + 0.3 * (number - 50)
        if k == 0:
            more = frame.traffic_light.add()
            more.id.value = 60
            more.classification.color, more.classification.mode = 2, 3
            more.base.position.x = 40.0
    return [osi_file.view(frame) for frame in frames] if views else frames


@pytest.mark.parametrize("views", [False, True])
def test_windows_have_what_the_first_message_says(tmp_path: Path, views: bool) -> None:
    path = osi_file.write(tmp_path / "log.osi", lights_and_lanes(views=views))
    source = osi.open_file(path, idle_s=0.0)
    frames = drained(source)
    source.write_window(frames[10:20], tmp_path / "window.osi")
    whole, window = read(path), read(tmp_path / "window.osi")
    assert window.embedded_map == whole.embedded_map
    assert window.embedded_map is not None
    assert window.geo_reference == "+proj=utm +zone=32"
    lights = [
        {(row["t_ns"], row["signal_id"]): row["state"] for row in trace.tables["signal_state"].to_pylist()}
        for trace in (window, whole)
    ]
    expected = {key: state for key, state in lights[1].items() if TIMES[10] <= key[0] <= TIMES[19]}
    assert set(expected.values()) == {"red", "green"}
    shown = {key: state for key, state in lights[0].items() if key[1] != "60"}
    assert shown == expected
    assert lights[0].keys() - shown.keys() == {(TIMES[10], "60")}
    assert lights[0][TIMES[10], "60"] is None  # nobody says what it shows


class Writer(threading.Thread):
    """Sends bytes in pieces to whoever connects, or to whom it connects."""

    def __init__(self, connection: socket.socket | None, address: Any, data: bytes) -> None:
        super().__init__(daemon=True)
        self.server, self.address, self.data = connection, address, data
        self.start()

    def run(self) -> None:
        connection = socket.create_connection(self.address) if self.server is None else self.server.accept()[0]
        with connection:
            for start in range(0, len(self.data), 1000):
                connection.sendall(self.data[start : start + 1000])


def test_tcp_that_connects(tmp_path: Path) -> None:
    with socket.create_server(("127.0.0.1", 0)) as server:
        source = open_source(f"tcp://127.0.0.1:{server.getsockname()[1]}", tmp_path / "out", idle_s=5.0)
        Writer(server, None, WHOLE)
        assert times(drained(source)) == TIMES
    source.close()
    assert source.recording.read_bytes() == WHOLE
    assert len({row["t_ns"] for row in states(read(source.recording))}) == N


def free_port(kind: socket.SocketKind = socket.SOCK_STREAM) -> int:
    with socket.socket(socket.AF_INET, kind) as found:
        found.bind(("127.0.0.1", 0))
        port: int = found.getsockname()[1]
        return port


@pytest.mark.parametrize("form", ["tcp://:{}", "tcp-listen://:{}", "tcp-listen://127.0.0.1:{}"])
def test_tcp_that_listens(tmp_path: Path, form: str) -> None:
    port = free_port()
    source = open_source(form.format(port), tmp_path, idle_s=5.0)
    Writer(None, ("127.0.0.1", port), WHOLE[:-10])
    assert times(drained(source)) == TIMES[:-1]
    assert "of the message that begins" in source.notes()[0]
    source.close()
    assert source.recording.read_bytes() == WHOLE[:-10]  # the checker is to see that it was cut off
    assert "lost_time" in {row["check_id"] for row in read(source.recording).tables["quality"].to_pylist()}


@pytest.mark.parametrize("name", ["tcp://:{}", "tcp-listen://:{}", "udp://:{}", "TCP-LISTEN://:{}"])
def test_without_a_host_this_machine_alone_is_listened_to(tmp_path: Path, name: str) -> None:
    kind = socket.SOCK_DGRAM if name.startswith("udp") else socket.SOCK_STREAM
    port = free_port(kind)
    source = open_source(name.format(port), tmp_path, idle_s=5.0)
    with socket.socket(socket.AF_INET, kind) as other:
        other.bind(("127.0.0.2", port))  # taken, if the source had all addresses
    assert source.notes() == []
    source.close()


@pytest.mark.parametrize("form", ["tcp-listen://0.0.0.0:{}", "udp://0.0.0.0:{}"])
def test_an_address_that_others_reach_is_said(tmp_path: Path, form: str) -> None:
    name = form.format(free_port(socket.SOCK_DGRAM if form.startswith("udp") else socket.SOCK_STREAM))
    source = open_source(name, tmp_path, idle_s=5.0)
    assert source.notes() == [f"{name}: whoever reaches this address can send what is judged"]
    assert source.notes() == []
    source.close()


def test_tcp_waits_for_who_is_not_there_yet(tmp_path: Path) -> None:
    source = open_source(f"tcp://127.0.0.1:{free_port()}", tmp_path, idle_s=0.2)
    assert drained(source) == []
    source.close()


def test_a_taken_port(tmp_path: Path) -> None:
    with (
        socket.create_server(("127.0.0.1", 0)) as server,
        pytest.raises(TraceError, match="this address cannot be opened to receive data"),
    ):
        open_source(f"tcp-listen://127.0.0.1:{server.getsockname()[1]}", tmp_path, idle_s=None)


def test_an_idle_writer_ends_it(tmp_path: Path) -> None:
    with socket.create_server(("127.0.0.1", 0)) as server:
        source = open_source(f"tcp://127.0.0.1:{server.getsockname()[1]}", tmp_path, idle_s=0.3)
        connection, _ = server.accept()
        with connection:
            connection.sendall(WHOLE)
            assert times(drained(source)) == TIMES
        source.close()


def test_a_pipe(tmp_path: Path) -> None:
    reading, writing = os.pipe()
    os.write(writing, WHOLE[:5000])
    recording = (tmp_path / "recording.osi").open("wb")
    source = osi.OsiSource(
        tmp_path / "recording.osi", osi.StreamReceiver("a pipe", blocks_of_descriptor(reading, None), recording, [])
    )
    first = source.read(5.0)
    assert first
    time.sleep(0.05)
    assert (tmp_path / "recording.osi").read_bytes() == WHOLE[:5000]  # while it goes on
    os.write(writing, WHOLE[5000:])
    os.close(writing)
    assert times([*first, *drained(source)]) == TIMES
    source.close()
    os.close(reading)


CHILD: Final = """
import sys
from pathlib import Path
from drivelint.watch.sources import open_source
source = open_source("-", Path(sys.argv[1]), idle_s=None)
try:
    while (frames := source.read(1.0)) is not None:
        print(len(frames), flush=True)
except KeyboardInterrupt:
    source.close()
    print("interrupted", flush=True)
"""


@pytest.mark.sample(1, ci=1)
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGKILL])
def test_standard_input_of_a_watch_that_is_ended(tmp_path: Path, number: signal.Signals) -> None:
    """Its recording can be read, whatever ended it."""
    with subprocess.Popen(
        [sys.executable, "-c", CHILD, tmp_path], stdin=subprocess.PIPE, stdout=subprocess.PIPE, cwd=ROOT
    ) as child:
        assert child.stdin
        assert child.stdout
        child.stdin.write(WHOLE)
        child.stdin.flush()
        seen = 0
        while seen < N:
            seen += int(child.stdout.readline())
        child.send_signal(number)
        rest, _ = child.communicate(timeout=20)
    assert (b"interrupted" in rest) == (number == signal.SIGINT)
    assert len({row["t_ns"] for row in states(read(tmp_path / "recording.osi"))}) == N


def test_an_old_recording_stays(tmp_path: Path) -> None:
    (tmp_path / "recording.osi").write_bytes(WHOLE)
    source = open_source(f"tcp-listen://127.0.0.1:{free_port()}", tmp_path, idle_s=None)
    source.close()
    assert source.recording == tmp_path / "recording-2.osi"
    assert (tmp_path / "recording.osi").read_bytes() == WHOLE


def test_nothing_is_lost_while_nobody_asks() -> None:
    """Of what comes faster than it is taken, no more is read than has room."""
    given_out = 0

    def pieces() -> Generator[bytes, None, None]:
        nonlocal given_out
        for _ in range(100):
            given_out += 1
            yield b"x" * 10

    reader = BackgroundReader(pieces(), most_bytes=50)
    time.sleep(0.1)
    assert given_out == 5
    found: list[bytes] = []
    while (some := reader.take(1.0)) is not None:
        found += some
    assert len(found) == 100
    reader.stop()


def test_an_error_of_the_thread_reaches_who_reads() -> None:
    def pieces() -> Generator[bytes, None, None]:
        yield b"first"
        raise TraceError("the line is dead")

    reader = BackgroundReader(pieces())
    assert reader.take(1.0) == [b"first"]
    with pytest.raises(TraceError, match="the line is dead"):
        reader.take(1.0)


@pytest.mark.parametrize("name", ["log.csv", "ftp://a:1", "tcp://a", "udp://a:b", "tcp://a:1/b", "x-"])
def test_an_unknown_name(tmp_path: Path, name: str) -> None:
    with pytest.raises(UsageError, match=r"(use tcp|write a host)"):
        open_source(name, tmp_path, idle_s=None)


def test_a_source_that_is_closed_twice(tmp_path: Path) -> None:
    sources: list[Source] = [
        open_source(f"tcp-listen://127.0.0.1:{free_port()}", tmp_path / "tcp", idle_s=None),
        open_source(f"udp://127.0.0.1:{free_port(socket.SOCK_DGRAM)}", tmp_path / "udp", idle_s=None),
        open_source(str(tmp_path / "a.mcap"), tmp_path, idle_s=None),
    ]
    for source in sources:
        assert source.read(0.0) == []
        assert not source.is_advanced_by_reads
        source.end_sender_if_possible()
        source.close()
        source.close()
