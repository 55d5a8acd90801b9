"""The watch's own server: viewers get the road users of the newest step, alarms and margins."""

from __future__ import annotations

import json
import os
import socket
import subprocess
import sys
import time
from contextlib import ExitStack
from typing import TYPE_CHECKING, Any

import pytest

from drivelint.annotate import measures
from drivelint.drive.time_span import cut_trace
from drivelint.drive.trace import IngestOptions
from drivelint.errors import UsageError
from drivelint.formats import read_trace
from drivelint.watch.server import ALARMS_TOPIC, LiveServer, alarm_schema, open_server
from tests.shared_data import ROOT

pytest.importorskip("websockets")

from websockets.exceptions import InvalidStatus
from websockets.sync.client import connect
from websockets.typing import Origin, Subprotocol

from drivelint.watch.sources.foxglove_client import FoxgloveClient
from drivelint.watch.sources.transports import is_loopback
from tests.watch.foxglove_server import until

if TYPE_CHECKING:
    from collections.abc import Iterator

    from drivelint.watch.sources.recordings import LiveMessage

RULE = "ukhc.r162.safe-distance-ahead"
MARGIN = {
    "rule_id": RULE, "profile": "nominal", "t_ns": 2_000_000_000, "ego_id": "1", "object_id": None,
    "observed": 12.5, "required": 20.0, "margin": -7.5, "holds": False,
}  # fmt: skip
ALARM = {
    "type": "alarm", "alarm": 1, "rule_id": RULE, "title": "Enough room", "t_s": 1.0, "said_s": 1.5, "latency_s": 0.01,
    "status": "stable", "severity": "critical", "ego_id": "1", "object_id": None, "t_start_ns": 1_000_000_000,
    "t_end_ns": 1_500_000_000, "observed": float("nan"), "reason": "too near",
}  # fmt: skip


@pytest.fixture
def server() -> Iterator[LiveServer]:
    made = LiveServer("127.0.0.1", 0)
    yield made
    made.close()
    made.close()


class AnyClient(FoxgloveClient):
    """A client that reads every channel."""

    def __init__(self, server: LiveServer, n_channels: int, monkeypatch: pytest.MonkeyPatch) -> None:
        monkeypatch.setattr("drivelint.watch.sources.foxglove_client.is_watched", lambda _: True)
        super().__init__(f"ws://127.0.0.1:{server.port}")
        until(lambda: len(self._by_subscription) == n_channels)
        until(lambda: sum(server._server.n_subscriptions(each) for each in server._channels.values()) == n_channels)

    def messages(self, n: int) -> list[LiveMessage]:
        found: list[LiveMessage] = []

        def enough() -> bool:
            found.extend(self.take(0.05) or ())
            return len(found) >= n

        until(enough)
        return found


def test_the_road_users_of_the_newest_step(server: LiveServer, monkeypatch: pytest.MonkeyPatch) -> None:
    client = AnyClient(server, 3, monkeypatch)
    trace = read_trace(ROOT / "fixtures" / "scenes" / "collision.mcap", IngestOptions())
    log = trace.tables["data_log"].to_pylist()[0]
    window = cut_trace(trace, log["t_start_ns"], log["t_start_ns"] + 3_000_000_000)
    server.publish_scene(window)
    by_topic = {each.channel.topic: each for each in client.messages(2)}
    client.close()
    assert by_topic.keys() == {"/drivelint/scene", "/drivelint/tf"}
    scene = decoded(by_topic["/drivelint/scene"])
    states = window.tables["actor_state"].to_pylist()
    newest = {row["actor_id"]: row for row in states if row["t_ns"] == max(each["t_ns"] for each in states)}
    assert [each.type for each in scene.deletions] == [1]
    assert {each.id for each in scene.entities} == newest.keys()
    assert by_topic["/drivelint/scene"].log_ns == log["t_start_ns"] + 3_000_000_000
    for each in scene.entities:
        (cube,) = each.cubes
        assert cube.pose.position.x == pytest.approx(newest[each.id]["x_m"])
        assert cube.pose.position.y == pytest.approx(newest[each.id]["y_m"])
    egos = {row["actor_id"] for row in window.tables["actor"].to_pylist() if row["is_ego"]}
    blue = {each.id for each in scene.entities if each.cubes[0].color.b > 0.9}
    assert blue == egos
    assert decoded(by_topic["/drivelint/tf"]).child_frame_id == "base_link"


def decoded(message: LiveMessage) -> Any:
    """Decode a message by the schema that the server sent."""
    from google.protobuf import descriptor_pb2, descriptor_pool, message_factory

    pool = descriptor_pool.DescriptorPool()
    for file in descriptor_pb2.FileDescriptorSet.FromString(message.channel.schema.data).file:
        pool.Add(file)
    kind = message_factory.GetMessageClass(pool.FindMessageTypeByName(message.channel.schema.name))
    return kind.FromString(message.content)


def test_alarms_and_margins(server: LiveServer, monkeypatch: pytest.MonkeyPatch) -> None:
    server.publish_margins([MARGIN])
    client = AnyClient(server, 4, monkeypatch)
    server.publish_alarm(ALARM)
    server.publish_margins([{**MARGIN, "drive_id": "d"}])
    alarm, margin = client.messages(2)
    client.close()
    assert (alarm.channel.topic, alarm.channel.schema.name, alarm.log_ns) == (
        ALARMS_TOPIC,
        "drivelint.Alarm",
        1_000_000_000,
    )
    assert json.loads(alarm.content) == {k: v for k, v in ALARM.items() if k not in {"object_id", "observed"}}
    topic = f"/drivelint/{measures.margin_topic(RULE)}"
    assert (margin.channel.topic, margin.channel.schema.name, margin.log_ns) == (
        topic,
        "drivelint.Margin",
        2_000_000_000,
    )
    assert json.loads(margin.content) == {k: v for k, v in MARGIN.items() if v is not None}


def test_the_margins_of_a_rule_can_be_chosen_before_it_is_judged(monkeypatch: pytest.MonkeyPatch) -> None:
    with open_server("127.0.0.1:0", [RULE, "ukhc.no-collision"]) as server:
        assert server is not None
        client = AnyClient(server, 5, monkeypatch)
        topics = {each.topic for each in client._by_subscription.values()}
        server.publish_margins([MARGIN])
        (margin,) = client.messages(1)
        client.close()
    expected = {f"/drivelint/{measures.margin_topic(rule)}" for rule in (RULE, "ukhc.no-collision")}
    assert expected < topics
    assert margin.channel.topic == f"/drivelint/{measures.margin_topic(RULE)}"


def test_messages_are_of_their_schemas() -> None:
    jsonschema = pytest.importorskip("jsonschema")
    known = {k: v for k, v in ALARM.items() if k not in {"object_id", "observed"}}
    jsonschema.validate(known, json.loads(alarm_schema().data))


def test_a_port_that_is_taken_is_one_line() -> None:
    with socket.create_server(("127.0.0.1", 0)) as other:
        port = other.getsockname()[1]
        with pytest.raises(UsageError, match=rf"--serve 127\.0\.0\.1:{port}: the server cannot start there"):
            LiveServer("127.0.0.1", port)


def test_without_the_extra_it_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delitem(sys.modules, "drivelint.watch.viewer_server", raising=False)
    monkeypatch.setitem(sys.modules, "websockets.asyncio.server", None)
    with pytest.raises(UsageError, match=r"drivelint\[live\]"):
        LiveServer("127.0.0.1", 0)


def test_a_page_of_another_site_is_refused_and_a_program_is_not(server: LiveServer) -> None:
    uri = f"ws://127.0.0.1:{server.port}"
    for origin in ("https://evil.example", "http://127.0.0.1:80", "null"):
        with pytest.raises(InvalidStatus, match="403"):
            connect(uri, origin=Origin(origin), subprotocols=[Subprotocol("foxglove.sdk.v1")])
    until(lambda: len(server._server._notes) == 3)
    assert server.notes()[0].startswith("--serve: a page of https://evil.example was refused: give --allow-origin")
    assert server.notes() == []
    with connect(uri, subprotocols=[Subprotocol("foxglove.sdk.v1")]) as program:
        assert json.loads(program.recv())["op"] == "serverInfo"


def test_a_page_that_is_allowed_may_watch() -> None:
    with open_server("127.0.0.1:0", [], ["https://app.foxglove.dev/"]) as server:
        assert server is not None
        uri = f"ws://127.0.0.1:{server.port}"
        with connect(
            uri, origin=Origin("https://app.foxglove.dev"), subprotocols=[Subprotocol("foxglove.websocket.v1")]
        ) as page:
            assert json.loads(page.recv())["op"] == "serverInfo"


def test_words_that_nobody_understands_end_no_connection(server: LiveServer) -> None:
    with connect(f"ws://127.0.0.1:{server.port}", subprotocols=[Subprotocol("foxglove.sdk.v1")]) as viewer:
        viewer.send("no JSON")
        viewer.send(b"\x00")
        viewer.send(json.dumps({"op": "subscribe", "subscriptions": [{"id": -1, "channelId": 1}, 7]}))
        viewer.send(json.dumps({"op": "subscribe", "subscriptions": [{"id": 4, "channelId": server._alarms}]}))
        until(lambda: server._server.n_subscriptions(server._alarms) == 1)
        server.publish_alarm(ALARM)
        found = [viewer.recv(timeout=5) for _ in range(3)]
    assert isinstance(found[-1], bytes)
    assert found[-1][:5] == b"\x01\x04\x00\x00\x00"


@pytest.mark.parametrize("address", [":0", "127.0.0.1:0", "localhost:0", "[::1]:0"])
def test_without_a_host_this_machine_alone_can_watch(address: str) -> None:
    if address == "[::1]:0" and not socket.has_ipv6:
        pytest.skip("this machine has no IPv6")
    with open_server(address, []) as server:
        assert server is not None
        (host, *_) = next(iter(server._server._server.sockets)).getsockname()
        assert is_loopback(host)
        assert server.notes() == []


def test_an_address_that_others_reach_is_said() -> None:
    with open_server("0.0.0.0:0", []) as server:
        assert server is not None
        assert server.notes() == ["--serve 0.0.0.0:0: every machine that reaches this address can connect"]


IDLE = """
import socket, sys
from drivelint.watch.server import LiveServer

server = LiveServer("127.0.0.1", 0)
print(server.port, flush=True)
sys.stdin.readline()
server.close()
print("closed", flush=True)
"""


def test_a_hundred_idle_connections_do_not_keep_the_program_from_ending() -> None:
    with subprocess.Popen(
        [sys.executable, "-c", IDLE],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env={**os.environ, "PYTHONPATH": str(ROOT / "src")},
    ) as program:
        assert program.stdout is not None
        assert program.stdin is not None
        port = int(program.stdout.readline())
        silent = [socket.create_connection(("127.0.0.1", port)) for _ in range(50)]
        begun = [socket.create_connection(("127.0.0.1", port)) for _ in range(48)]
        for each in begun:
            each.sendall(b"GET / HTTP/1.1\r\nHost: a\r\n")
        idle = ExitStack()
        for _ in range(2):
            idle.enter_context(connect(f"ws://127.0.0.1:{port}", subprotocols=[Subprotocol("foxglove.sdk.v1")]))
        program.stdin.write("\n")
        program.stdin.flush()
        began = time.monotonic()
        assert program.wait(30) == 0
        took_s = time.monotonic() - began
        assert program.stderr is not None
        assert program.stderr.read() == ""
        for each in [*silent, *begun]:
            each.close()
        idle.close()
    assert took_s < 10.0  # two seconds on a machine that does nothing else
