"""A Foxglove WebSocket server as a source: the recording says what the log says that the server plays."""

from __future__ import annotations

import socket
import ssl
import sys
import threading
from datetime import UTC, datetime, timedelta
from typing import TYPE_CHECKING

import pytest
from cryptography import x509
from cryptography.hazmat.primitives import hashes, serialization
from cryptography.hazmat.primitives.asymmetric import ec

from drivelint.drive.trace import IngestOptions
from drivelint.errors import TraceError, UsageError
from drivelint.formats import read_trace
from drivelint.watch.sources import foxglove_ws, open_source
from tests.formats.foxglove.foxglove_log import entity, scene, transform, write
from tests.shared_data import ROOT

if TYPE_CHECKING:
    from pathlib import Path

    from drivelint.watch.source import Frame, Source

pytest.importorskip("foxglove")
pytest.importorskip("websockets")

from websockets.typing import Subprotocol

from drivelint.watch.sources.foxglove_client import SUBPROTOCOLS
from tests.watch.foxglove_server import player, until

COLLISION = ROOT / "fixtures" / "scenes" / "collision.mcap"


def scene_log(path: Path, encoding: str) -> Path:
    """Write a drive of two cars, one of them in a frame that is said once."""
    messages = [transform(1.0, "map", "odom", 5.0, 2.0)]
    for k in range(20):
        t_s = 1.0 + k / 10
        messages.append(scene(t_s, entity("ego", t_s, k / 2), entity("other", t_s, 20.0 - k, frame="odom")))
    return write(path, messages, encoding)


def received(source: foxglove_ws.FoxgloveSource, least: int) -> list[Frame]:
    """Return frames until there are so many."""
    frames: list[Frame] = []

    def enough() -> bool:
        frames.extend(source.read(0.05) or ())
        return len(frames) >= least

    until(enough)
    return frames


def ended(source: Source) -> bool:
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
    window = source.window_reader(frames[-60:], tmp_path, options)().tables["actor_state"].to_pylist()
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

    def has_notes() -> bool:
        found.extend(source.notes())
        return bool(found)

    until(has_notes)
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


def test_a_server_that_is_not_up_yet_is_waited_for(tmp_path: Path) -> None:
    with socket.create_server(("127.0.0.1", 0)) as free:
        port = free.getsockname()[1]
    uri = f"ws://127.0.0.1:{port}"
    source = foxglove_ws.open(uri, tmp_path, idle_s=10.0)
    found: list[str] = []

    def has_notes() -> bool:
        assert source.read(0.05) == []
        found.extend(source.notes())
        return bool(found)

    until(has_notes)
    with player(COLLISION, port) as server:
        playing = threading.Thread(target=server.play)
        playing.start()
        received(source, server.n_messages)
        playing.join()
    assert ended(source)
    assert [*found, *source.notes()] == [f"{uri}: no server answers yet: waiting for it"]
    source.close()


def test_no_server_is_one_line(tmp_path: Path) -> None:
    for scheme in ("ws", "wss"):
        source = open_source(f"{scheme}://127.0.0.1:1", tmp_path, idle_s=0.2)
        with pytest.raises(TraceError, match=rf"{scheme}://127\.0\.0\.1:1: no Foxglove WebSocket server answers"):
            ended(source)
        source.close()
        assert not source.recording.exists()
    with pytest.raises(UsageError, match="write ws://HOST:PORT"):
        foxglove_ws.open("http://127.0.0.1:1", tmp_path)


def test_a_host_that_nobody_knows_is_not_waited_for(tmp_path: Path) -> None:
    source = foxglove_ws.open("ws://nobody.invalid:1", tmp_path)
    with pytest.raises(TraceError, match="no Foxglove WebSocket server answers"):
        ended(source)


def test_another_websocket_server_is_refused(tmp_path: Path) -> None:
    from websockets.sync.server import ServerConnection, serve

    def silent(connection: ServerConnection) -> None:
        connection.recv()

    with serve(silent, "127.0.0.1", 0) as other:
        thread = threading.Thread(target=other.serve_forever)
        thread.start()
        source = foxglove_ws.open(f"ws://127.0.0.1:{other.socket.getsockname()[1]}", tmp_path)
        with pytest.raises(TraceError, match=r"no Foxglove WebSocket server|speaks none of"):
            ended(source)
        other.shutdown()
        thread.join()


def certificate(folder: Path) -> Path:
    """Write a key and a certificate of this machine, which nobody else signed."""
    key = ec.generate_private_key(ec.SECP256R1())
    name = x509.Name([x509.NameAttribute(x509.NameOID.COMMON_NAME, "localhost")])
    now = datetime.now(UTC)
    signed = (
        x509.CertificateBuilder(name, name, key.public_key(), 1, now - timedelta(days=1), now + timedelta(days=1))
        .add_extension(x509.SubjectAlternativeName([x509.DNSName("localhost")]), critical=False)
        .sign(key, hashes.SHA256())
    )
    plain = serialization.NoEncryption()
    content = key.private_bytes(serialization.Encoding.PEM, serialization.PrivateFormat.PKCS8, plain)
    file = folder / "localhost.pem"
    file.write_bytes(content + signed.public_bytes(serialization.Encoding.PEM))
    return file


def test_a_server_behind_tls(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from websockets.sync.server import ServerConnection, serve

    def greet(connection: ServerConnection) -> None:
        connection.send('{"op": "status", "level": 1, "message": "hello"}')

    file = certificate(tmp_path)
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
    context.load_cert_chain(file)
    with serve(greet, "localhost", 0, ssl=context, subprotocols=[Subprotocol(SUBPROTOCOLS[0])]) as other:
        thread = threading.Thread(target=other.serve_forever)
        thread.start()
        uri = f"wss://localhost:{other.socket.getsockname()[1]}"
        stranger = open_source(uri, tmp_path, idle_s=None)
        with pytest.raises(TraceError, match=r"no Foxglove WebSocket server answers: .*certificate"):
            ended(stranger)
        monkeypatch.setenv("SSL_CERT_FILE", str(file))
        known = open_source(uri, tmp_path, idle_s=None)
        assert ended(known)
        assert known.notes() == [f"{uri} says: hello"]
        other.shutdown()
        thread.join()


def test_without_the_extra_it_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "websockets.sync.client", None)
    with pytest.raises(UsageError, match=r"drivelint\[live\]"):
        foxglove_ws.open("ws://127.0.0.1:1", tmp_path)
