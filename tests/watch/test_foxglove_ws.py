"""A Foxglove WebSocket server as a source: the recording says what the log says that the server plays."""

from __future__ import annotations

import sys
import threading
from typing import TYPE_CHECKING

import pytest

from drivelint.drive.trace import IngestOptions
from drivelint.errors import TraceError, UsageError
from drivelint.formats import read_trace
from drivelint.watch.sources import foxglove_ws
from tests.formats.foxglove.foxglove_log import entity, scene, transform, write
from tests.shared_data import ROOT

if TYPE_CHECKING:
    from pathlib import Path

    from drivelint.watch.source import Frame

pytest.importorskip("foxglove")
pytest.importorskip("websockets")

from tests.watch.foxglove_server import player, until

COLLISION = ROOT / "fixtures" / "scenes" / "collision.mcap"


def scene_log(path: Path, encoding: str) -> Path:
    """Write a drive of two cars, one of them in a frame that is said once."""
    messages = [transform(1.0, "map", "odom", 5.0, 2.0)]
    for k in range(20):
        t_s = 1.0 + k / 10
        messages.append(scene(t_s, entity("ego", t_s, k / 2), entity("other", t_s, 20.0 - k, frame="odom")))
    return write(path, messages, encoding)


def received(source: foxglove_ws.FoxgloveWebSocket, least: int) -> list[Frame]:
    """Return frames until there are so many."""
    frames: list[Frame] = []

    def enough() -> bool:
        frames.extend(source.read(0.05) or ())
        return len(frames) >= least

    until(enough)
    return frames


def ended(source: foxglove_ws.FoxgloveWebSocket) -> bool:
    until(lambda: source.read(0.05) is None)
    return True


def test_the_recording_has_the_states_of_what_is_played(tmp_path: Path) -> None:
    with player(COLLISION) as server:
        source = foxglove_ws.open(server.uri, tmp_path)
        playing = threading.Thread(target=server.play)
        playing.start()
        frames = received(source, server.n_messages)
        playing.join()
    assert ended(source)
    source.close()
    source.close()
    assert [frame.t_ns for frame in frames] == sorted(frame.t_ns for frame in frames)
    options = IngestOptions()
    mine, original = (read_trace(path, options).tables for path in (source.recording, COLLISION))
    for table in ("actor_state", "actor", "signal_state"):
        there = original[table].drop_columns("drive_id")
        assert mine[table].drop_columns("drive_id").equals(there)

    since = frames[-60].t_ns
    window = source.window(frames[-60:], tmp_path, options)().tables["actor_state"].to_pylist()
    whole = [row for row in mine["actor_state"].to_pylist() if row["t_ns"] >= min(row["t_ns"] for row in window)]
    key = ("t_ns", "actor_id", "x_m", "y_m")
    assert since > frames[0].t_ns
    assert [[row[k] for k in key] for row in window] == [[row[k] for k in key] for row in whole]


@pytest.mark.parametrize("encoding", ["protobuf", "json"])
def test_scenes_and_transforms(tmp_path: Path, encoding: str) -> None:
    log = scene_log(tmp_path / "scene.mcap", encoding)
    with player(log) as server:
        source = foxglove_ws.open(server.uri, tmp_path / "out")
        threading.Thread(target=server.play).start()
        received(source, server.n_messages)
    source.close()
    options = IngestOptions(ego="ego")
    mine, original = (read_trace(path, options).tables["actor_state"] for path in (source.recording, log))
    assert mine.num_rows > 20
    assert mine.drop_columns("drive_id").equals(original.drop_columns("drive_id"))


def test_channels_that_nobody_reads_are_told(tmp_path: Path) -> None:
    import foxglove

    context = foxglove.Context()
    server = foxglove.start_server(port=0, context=context)
    channel = foxglove.Channel("/camera", schema={"type": "object"}, context=context)
    source = foxglove_ws.open(f"ws://127.0.0.1:{server.port}", tmp_path)
    found: list[str] = []

    def told() -> bool:
        found.extend(source.notes())
        return bool(found)

    until(told)
    assert "/camera" in found[0]
    assert not channel.has_sinks()
    server.stop()
    assert ended(source)
    source.close()
    assert not source.recording.exists()


def test_it_ends_where_nothing_comes_for_long(tmp_path: Path) -> None:
    with player(COLLISION) as server:
        source = foxglove_ws.open(server.uri, tmp_path, idle_s=0.3)
        assert source.read(0.05) == []
        assert ended(source)
        source.close()


def test_a_recording_that_cannot_be_written_is_one_line(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("no folder")
    with player(COLLISION) as server:
        source = foxglove_ws.open(server.uri, tmp_path / "file")
        server.play()
        with pytest.raises(TraceError, match="the recording cannot be written"):
            received(source, 1)
        source._client.close()


def test_no_server_is_one_line(tmp_path: Path) -> None:
    with pytest.raises(TraceError, match=r"ws://127\.0\.0\.1:1: no Foxglove WebSocket server answers"):
        foxglove_ws.open("ws://127.0.0.1:1", tmp_path)
    with pytest.raises(UsageError, match="give ws://HOST:PORT"):
        foxglove_ws.open("http://127.0.0.1:1", tmp_path)


def test_another_websocket_server_is_refused(tmp_path: Path) -> None:
    from websockets.sync.server import ServerConnection, serve

    def silent(connection: ServerConnection) -> None:
        connection.recv()

    with serve(silent, "127.0.0.1", 0) as other:
        thread = threading.Thread(target=other.serve_forever)
        thread.start()
        uri = f"ws://127.0.0.1:{other.socket.getsockname()[1]}"
        with pytest.raises(TraceError, match=r"no Foxglove WebSocket server|speaks none of"):
            foxglove_ws.open(uri, tmp_path)
        other.shutdown()
        thread.join()


def test_without_the_extra_it_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "websockets.sync.client", None)
    with pytest.raises(UsageError, match=r"drivelint\[live\]"):
        foxglove_ws.open("ws://127.0.0.1:1", tmp_path)
