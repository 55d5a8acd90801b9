"""CDR by columns against the tests' own writer and against rosbags, for any definition; and damage is named."""

from __future__ import annotations

import struct
import tracemalloc
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from mcap.records import Channel, Schema

from drivelint.errors import TraceError
from drivelint.formats.mcap.malformed import decode_without_malformed
from drivelint.formats.mcap.reader import LogMessage
from drivelint.formats.ros2 import cdr
from drivelint.formats.ros2 import types as ros_types
from tests.formats.ros2 import ros_log as ros

LOG = Path("log.mcap")
CHANNEL = Channel(id=1, topic="/t", message_encoding="cdr", metadata={}, schema_id=1)
PRIMITIVES = ("bool", "uint8", "int8", "uint16", "int16", "uint32", "int32", "uint64", "int64", "float32", "float64")


def log_messages(messages: list[bytes]) -> list[LogMessage]:
    return [LogMessage(CHANNEL, i, data, 1000 + i) for i, data in enumerate(messages)]


def decoder(types: dict[str, str], name: str, tree: dict[str, Any]) -> cdr.Decoder:
    schema = Schema(id=1, name=name, encoding="ros2msg", data=ros.definition(name, types).encode())
    return cdr.Decoder(LOG, schema, tree)


def numbers(kind: str) -> st.SearchStrategy[Any]:
    if kind == "bool":
        return st.integers(0, 1)
    if kind.startswith("float"):
        return st.floats(width=32, allow_nan=False, allow_infinity=False)
    bits, low = int(kind.removeprefix("u")[3:]), 0 if kind.startswith("u") else -1
    return st.integers(low * 2 ** (bits - 1), 2 ** (bits if low == 0 else bits - 1) - 1)


@st.composite
def cases(draw: st.DrawFn) -> tuple[dict[str, str], list[dict[str, Any]]]:
    """Return definitions of p/Top, which lists p/Item, which lists p/Part, with members of any kind, and messages."""
    types: dict[str, str] = {}
    members: dict[str, list[tuple[str, str]]] = {}
    for name, below in (("Part", None), ("Item", "Part"), ("Top", "Item")):
        kinds = draw(
            st.lists(st.sampled_from((*PRIMITIVES, "string", "sequence", "array", "texts")), min_size=1, max_size=5)
        )
        found = []
        for i, kind in enumerate(kinds):
            of = draw(st.sampled_from(PRIMITIVES))
            text = {"sequence": f"{of}[]", "array": f"{of}[3]", "texts": "string[<=9]"}.get(kind, kind)
            found.append((text, f"m{i}"))
        if below is not None:
            found.insert(
                draw(st.integers(0, len(found))), (draw(st.sampled_from([f"{below}[]", f"p/{below}[]"])), "list")
            )
        members[name] = found
        types[f"p/{name}"] = "\n".join(f"{text} {member} # it" for text, member in found)

    def value(name: str) -> dict[str, Any]:
        made: dict[str, Any] = {}
        for text, member in members[name]:
            kind, _, array = text.partition("[")
            if member == "list":
                made[member] = [value(kind.removeprefix("p/")) for _ in range(draw(st.integers(0, 3)))]
            elif kind == "string":
                one = st.text(st.characters(codec="utf-8", exclude_characters="\0"), max_size=5)
                made[member] = draw(st.lists(one, max_size=3)) if array else draw(one)
            elif array:
                low, high = (3, 3) if array == "3]" else (0, 5)
                made[member] = draw(st.lists(numbers(kind), min_size=low, max_size=high))
            else:
                made[member] = draw(numbers(kind))
        return made

    return types, [value("Top") for _ in range(draw(st.integers(1, 3)))]


def member_tree(types: dict[str, str], name: str) -> dict[str, Any]:
    """Return a tree of all that is kept: texts in sequences are not."""
    return {
        member: member_tree(types, kind) if kind in types else None
        for kind, member, array in ros.fields(name, types)
        if not (kind == "string" and array is not None)
    }


def expect(table: cdr.Table, name: str, values: list[dict[str, Any]], types: dict[str, str]) -> None:
    """Compare a table with the values it should have."""
    assert table.n == len(values)
    for kind, member, array in ros.fields(name, types):
        if kind in types:
            below = table.children[member]
            assert below.parent.tolist() == [i for i, value in enumerate(values) for _ in value[member]]
            expect(below, kind, [item for value in values for item in value[member]], types)
        elif kind == "string" and array is None:
            assert [text.decode() for text in table.columns[member].tolist()] == [value[member] for value in values]
        elif kind != "string" and array == "":
            padded = [[*value[member], np.nan, np.nan, np.nan][: cdr.MAX_KEPT_NUMBERS] for value in values]
            assert np.array_equal(
                table.columns[member], np.array(padded, np.float64).reshape(-1, cdr.MAX_KEPT_NUMBERS), equal_nan=True
            )
        elif kind != "string":
            assert table.columns[member].tolist() == [value[member] for value in values]


@pytest.mark.ci
@settings(max_examples=150, deadline=None)
@given(cases(), st.sampled_from("<>"))
def test_any_definition(case: tuple[dict[str, str], list[dict[str, Any]]], order: str) -> None:
    types, values = case
    messages = [ros.encode("p/Top", value, types, order) for value in values]
    expect(decoder(types, "p/Top", member_tree(types, "p/Top")).table(log_messages(messages)), "p/Top", values, types)
    # what is not kept is stepped over to the byte
    only: dict[str, Any] = {"list": {}}
    assert decoder(types, "p/Top", only).table(log_messages(messages)).children["list"].n == sum(
        len(v["list"]) for v in values
    )


@pytest.mark.parametrize("order", ["<", ">"])
def test_the_tests_writer_writes_what_rosbags_writes(order: str) -> None:
    typesys = pytest.importorskip("rosbags.typesys", reason="rosbags is not installed: pip install rosbags")
    store = typesys.get_typestore(typesys.Stores.EMPTY)
    for name, text in ros.BASE.items():
        store.register(typesys.get_types_from_msg(text.strip(), name.replace("/", "/msg/")))
    polygon = {"points": [ros.xyz(1, 2, 3)] * 2}
    for _, name, _, content in (
        ros.things(
            1.25, ros.thing(7, 1, 2, 0.3, 5, polygon=polygon), ros.thing(8, 4, 5, header=ros.header(1, "longer"))
        ),
        ros.odometry(2, 1, 2, 0.5, 4),
        ros.tracks(1, ros.track(3, 1, 2), ros.track(4, 1, 2, classes=[])),
        ros.detections(1, ros.detection("abc", 1, 2, ("car", 0.5)), ros.detection("", 1, 2)),
        ros.transform(1, "map", "odom", 2, 3),
    ):
        data, full = ros.encode(name, content, order=order), name.replace("/", "/msg/")
        assert bytes(store.serialize_cdr(store.deserialize_cdr(data, full), full, little_endian=order == "<")) == data


TREE = {"header": {"stamp": {"sec": None}, "frame_id": None}, "objects": {"id": None, "shape": {"dimensions": None}}}
WHOLE = ros.encode("derived_object_msgs/ObjectArray", ros.things(1.0, ros.thing(1, 2, 3), ros.thing(2, 3, 4))[3])


def arrays(messages: list[bytes]) -> cdr.Table:
    return decoder(ros.BASE, "derived_object_msgs/ObjectArray", TREE).table(log_messages(messages))


def test_an_empty_message_in_what_is_not_read_is_one_byte() -> None:
    types = {"p/Top": "p/Item[] list\nuint8 after", "p/Item": "p/Empty e\nuint8 a", "p/Empty": ""}
    data = bytes([0, 1, 0, 0, 2, 0, 0, 0, 0, 5, 0, 6, 7])
    table = decoder(types, "p/Top", {"after": None}).table(log_messages([data]))
    assert table.columns["after"].tolist() == [7]


def test_an_empty_sequence_pads_nothing() -> None:
    """pybag-sdk 0.13.0 reads what follows one four bytes late (findings/pybag-empty-sequence.sh)."""
    types = {"p/Top": "float64[] gaps\nint32 lane\nint32 vehicles\nfloat64 speed"}
    data = bytes([0, 1, 0, 0]) + struct.pack("<Iii4xd", 0, 2, 7, 20.0)
    table = decoder(types, "p/Top", member_tree(types, "p/Top")).table(log_messages([data]))
    assert [table.columns[name].tolist() for name in ("lane", "vehicles", "speed")] == [[2], [7], [20.0]]


@pytest.mark.parametrize("members", [{"speed": None}, {"objects": {"gap": None}, "speed": None}])
def test_a_number_behind_an_empty_list_of_messages_is_aligned(members: dict[str, Any]) -> None:
    """mcap-ros2-support-fast 0.8.0 reads it four bytes early if the listed message ends with eight bytes: a speed of 0."""
    types = {"p/Top": "p/Object[] objects\nfloat64 speed", "p/Object": "uint32 id\nfloat64 gap"}
    alone = bytes([0, 1, 0, 0]) + struct.pack("<I4xd", 0, 20.0)
    beside_another = bytes([0, 1, 0, 0]) + struct.pack("<IIdd", 1, 7, 42.0, 20.0)
    table = decoder(types, "p/Top", members).table(log_messages([alone, beside_another]))
    assert table.columns["speed"].tolist() == [20.0, 20.0]


def test_cut_off_at_any_byte() -> None:
    begins = "log.mcap: topic '/t', log time 1 ns, record at byte 1001: the derived"
    told = {length: refusal([WHOLE, WHOLE[:length], WHOLE]) for length in range(len(WHOLE))}
    assert {length: text for length, text in told.items() if begins not in text} == {}
    assert len(told) == len(WHOLE)


def refusal(messages: list[bytes]) -> str:
    """Return why messages are refused; '' if they are read."""
    try:
        arrays(messages)
    except TraceError as error:
        return str(error)
    return ""


def test_too_long() -> None:
    assert arrays([WHOLE + b"\0" * 7]).n == 1
    with pytest.raises(TraceError, match="has 8 bytes more than its definition"):
        arrays([WHOLE + b"\0" * 8])


@pytest.mark.parametrize("head", ["00030000", "00070000", "01010000"])
def test_other_encodings(head: str) -> None:
    with pytest.raises(TraceError, match=f"record at byte 1001: .* not encoded as plain CDR .* {head}"):
        arrays([WHOLE, bytes.fromhex(head) + WHOLE[4:]])


@settings(max_examples=300, deadline=None)
@given(st.integers(4, len(WHOLE) - 1), st.integers(0, 255))
def test_a_changed_byte_is_read_or_named(place: int, value: int) -> None:
    changed = bytearray(WHOLE)
    changed[place] = value
    try:
        table = arrays([bytes(changed)])
    except TraceError:
        return
    assert table.n == 1


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("uint8", "a line that is not understood: 'uint8'"),
        ("other/Thing x", "uses the type other/Thing, but has no definition of it"),
        (f"Inner a\n{'=' * 80}\nMSG: p/Inner\nTop b", r"contains itself \(p/Top\)"),
        (f"uint8 a\n{'=' * 80}\nINNER\nuint8 b", "a line that is not understood: 'INNER'"),
        ("float64[18446744073709551616] a", "a line that is not understood"),
        ("uint8[99999999999] a", "has arrays of 100000000000 items, more than a message can contain"),
        (f"Inner[1000000000] a\n{'=' * 80}\nMSG: p/Inner\nuint8 b", "more than a message can contain"),
        ("string[1000000] a", "more than a message can contain"),
        (
            f"A[1000] a\n{'=' * 80}\nMSG: p/A\nB[1000] b\n{'=' * 80}\nMSG: p/B\nC[1000] c\n{'=' * 80}\nMSG: p/C\nuint8 d",
            "more than a message can contain",
        ),
    ],
)
def test_definitions_that_cannot_be_used(text: str, message: str) -> None:
    with pytest.raises(TraceError, match=message):
        ros_types.parse_definition(LOG, "p/msg/Top", text.encode())
    with pytest.raises(TraceError, match="is not text"):
        ros_types.parse_definition(LOG, "p/msg/Top", b"\xff\xfe")


def test_what_definitions_may_hold() -> None:
    text = '# comment\nuint8 A=1\nstring NAME="a = b # c"\nstring<=10 name "x"\nfloat64[<=3] d\nHeader header\ntime t\nuint8[8388608] two'
    body = f"{text}\n{'=' * 80}\nMSG: std_msgs/Header\nstring frame_id"
    members = ros_types.parse_definition(LOG, "p/msg/Top", body.encode())["p/Top"]
    assert [(each.name, each.kind, each.count) for each in members] == [
        ("name", "string", None), ("d", "float64", -1), ("header", "std_msgs/Header", None), ("t", "time", None), ("two", "uint8", 8388608),
    ]  # fmt: skip


def test_a_text_too_long_for_a_name_loses_its_message_and_no_memory() -> None:
    types = {"p/Top": "string frame\nuint32 number"}
    texts = ["map"] * 400 + ["x" * 4_000_000] + ["map"] * 99
    messages = log_messages([ros.encode("p/Top", {"frame": text, "number": n}, types) for n, text in enumerate(texts)])
    readers = decoder(types, "p/Top", {"frame": None, "number": None})
    tracemalloc.start()
    table, malformed = decode_without_malformed(messages, readers.table)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert table is not None
    assert table.column("number").tolist() == [n for n in range(500) if n != 400]
    assert set(table.column("frame").tolist()) == {b"map"}
    assert "has 4000001 bytes in frame, where a name has at most 4096" in str(malformed[400])
    assert peak < 100e6


def test_a_map_is_no_name() -> None:
    """A text of more than 4096 letters is read whole, beside a shorter one."""
    types = {"p/Top": "string opendrive"}
    texts = ["<OpenDRIVE>" + "x" * 100_000, "", "short"]
    messages = log_messages([ros.encode("p/Top", {"opendrive": text}, types) for text in texts])
    table = decoder(types, "p/Top", {"opendrive": None}).table(messages)
    assert [text.decode() for text in table.column("opendrive").tolist()] == texts
