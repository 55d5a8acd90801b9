"""What is left of a damaged MCAP file is read as it was written, and all that is missing lies in a time that is said to be lost."""

from __future__ import annotations

import struct
from typing import TYPE_CHECKING, Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from mcap.writer import CompressionType

from drivelint.errors import TraceError
from tests.formats.logs import log, read
from tests.formats.mcap.damage import (
    CHUNK,
    DATA_END,
    FOOTER,
    MESSAGE,
    STATISTICS,
    places,
    put,
    replaced,
    with_index_crc,
)
from tests.formats.osi import osi_log

if TYPE_CHECKING:
    from pathlib import Path

    from drivelint.drive.trace import Trace

N = 40
PERIOD_NS = 100_000_000
HEAD_BYTES = 49


@pytest.fixture
def whole(tmp_path: Path) -> Path:
    """As recorders write it: with a CRC of each chunk and of the index, none of all data."""
    messages = osi_log.truths(osi_log.drive(N))
    return osi_log.write(tmp_path / "whole.mcap", messages, chunk_size=600, enable_data_crcs=False)


@pytest.fixture
def flat(tmp_path: Path) -> Path:
    return osi_log.write(
        tmp_path / "flat.mcap", osi_log.truths(osi_log.drive(N)), use_chunking=False, enable_data_crcs=False
    )


def rows(trace: Trace) -> dict[tuple[str, int], dict[str, Any]]:
    return {
        (row["actor_id"], row["t_ns"]): {name: value for name, value in row.items() if name != "drive_id"}
        for row in trace.tables["actor_state"].to_pylist()
    }


def findings(trace: Trace) -> dict[str, list[dict[str, Any]]]:
    found: dict[str, list[dict[str, Any]]] = {}
    for row in trace.tables["quality"].to_pylist():
        found.setdefault(row["check_id"], []).append(row)
    return found


def missing_times(trace: Trace, whole: Path) -> list[int]:
    return sorted({t for _, t in rows(read(whole)).keys() - rows(trace).keys()})


def is_lost(trace: Trace, t_ns: int) -> bool:
    return any(
        (row["t_first_ns"] is None or row["t_first_ns"] < t_ns)
        and (row["t_last_ns"] is None or t_ns < row["t_last_ns"])
        for row in findings(trace).get("lost_time", [])
    )


def assert_missing_is_lost(trace: Trace, whole: Path) -> None:
    missing = missing_times(trace, whole)
    assert missing
    assert all(is_lost(trace, t) for t in missing)


def test_cut_within_a_chunk(whole: Path) -> None:
    data = whole.read_bytes()
    begin, end = places(data, CHUNK)[4]
    trace = read(put(whole, data[: (begin + end) // 2]))
    (found,) = findings(trace)["lost_time"]
    assert f"from byte {begin} on" in found["message"]
    assert (found["severity"], found["t_last_ns"]) == ("error", None)
    assert found["t_first_ns"] == max(t for _, t in rows(trace))
    assert 0 < len(rows(trace)) < 3 * N


def test_cut_between_two_records(whole: Path) -> None:
    """Nothing tells whether the recorder went on."""
    data = whole.read_bytes()
    (found,) = findings(read(put(whole, data[: places(data, CHUNK)[4][1]])))["lost_time"]
    assert "ends without a footer" in found["message"]


def test_without_a_footer_nothing_is_lost(whole: Path) -> None:
    data = whole.read_bytes()
    ((at, end),) = places(data, FOOTER)
    for cut in (at, end, end + 3):
        trace = read(put(whole, data[:cut]))
        assert rows(trace) == rows(read(whole))
        assert findings(trace)["no_footer"][0]["severity"] == "warning"
        assert "lost_time" not in findings(trace)


@pytest.mark.parametrize("opcode", [38, 134])
def test_a_chunk_of_another_kind_is_lost_also_where_the_index_is(whole: Path, opcode: int) -> None:
    """Readers skip records of unknown kinds: a chunk whose opcode had changed was not missed."""
    data = whole.read_bytes()
    (begin, _), ((_, end),) = places(data, CHUNK)[4], places(data, FOOTER)
    data = replaced(data, end - 4, bytes([data[end - 4] ^ 1]))
    trace = read(put(whole, replaced(data, begin, bytes([opcode]))))
    assert "index_damaged" in findings(trace)
    (found,) = findings(trace)["lost_time"]
    assert f"(opcode {opcode}) record at byte {begin}" in found["message"]
    assert_missing_is_lost(trace, whole)


def test_a_record_of_an_application_is_no_loss(whole: Path) -> None:
    data = whole.read_bytes()
    at = places(data, CHUNK)[4][0]
    foreign = struct.pack("<BQ", 134, 5) + b"hello"
    trace = read(put(whole, data[:at] + foreign + data[at:]))
    assert rows(trace) == rows(read(whole))
    assert "lost_time" not in findings(trace)


def test_an_end_that_stands_over_the_middle_is_seen(whole: Path) -> None:
    """The footer was taken for the end of all data, though no record had said that they end."""
    data = whole.read_bytes()
    at, footer = places(data, CHUNK)[4][0], places(data, FOOTER)[0][0]
    (found,) = findings(trace := read(put(whole, data[:at] + data[footer:])))["lost_time"]
    assert "no end of the data before the footer" in found["message"]
    assert_missing_is_lost(trace, whole)


def test_zero_filled_tail(whole: Path) -> None:
    data = whole.read_bytes()
    begin = places(data, CHUNK)[4][0]
    (found,) = findings(read(put(whole, data[:begin] + bytes(len(data) - begin))))["lost_time"]
    assert f"{len(data) - begin} bytes from byte {begin} on" in found["message"]


@pytest.mark.parametrize("compression", [CompressionType.ZSTD, CompressionType.LZ4, CompressionType.NONE])
def test_a_changed_chunk_is_lost_alone(whole: Path, compression: CompressionType) -> None:
    messages = osi_log.truths(osi_log.drive(N))
    path = osi_log.write(whole.with_name("c.mcap"), messages, compression=compression, chunk_size=600)
    data = path.read_bytes()
    begin, end = places(data, CHUNK)[4]
    trace = read(put(whole, replaced(data, end - 60, bytes(b ^ 0x55 for b in data[end - 60 : end - 40]))))
    (found,) = findings(trace)["lost_time"]
    gone = missing_times(trace, path)
    assert gone
    assert (found["t_first_ns"], found["t_last_ns"]) == (gone[0] - 1, gone[-1] + 1), "the index knows the chunk's times"
    assert f"{end - begin} bytes from byte {begin} on" in found["message"]


def test_without_an_index_the_neighbours_bound_what_is_lost(whole: Path) -> None:
    data = whole.read_bytes()
    begin, _ = places(data, CHUNK)[4]
    ((summary, _),) = places(data, FOOTER)
    trace = read(put(whole, replaced(data, begin + 9 + 24, b"\1\2\3\4")[:summary]))
    (found,) = findings(trace)["lost_time"]
    gone = missing_times(trace, whole)
    assert (found["t_first_ns"], found["t_last_ns"]) == (gone[0] - PERIOD_NS, gone[-1] + PERIOD_NS)


@pytest.mark.parametrize(
    ("place", "new"),
    [
        (1, b"\xff\xff"),
        (0, b"\x86"),
        (0, b"\x07"),
        (0, b"\x0e"),
        (0, b"\x02"),
        (0, b"\0"),
        (-20, bytes(range(100, 160))),
    ],
    ids=["length", "private", "message index", "summary offset", "footer", "zero", "noise"],
)
def test_a_damaged_record_head_costs_one_chunk(whole: Path, place: int, new: bytes) -> None:
    data = whole.read_bytes()
    begin, _ = places(data, CHUNK)[4]
    trace = read(put(whole, replaced(data, begin + place, new)))
    gone = missing_times(trace, whole)
    assert 0 < len(gone) < 6
    assert all(is_lost(trace, t) for t in gone)
    kept = rows(read(whole))
    assert all(kept[key] == row for key, row in rows(trace).items())


def test_the_first_chunk_announces_what_the_index_repeats(whole: Path) -> None:
    data = whole.read_bytes()
    begin, _ = places(data, CHUNK)[0]
    trace = read(put(whole, replaced(data, begin + 9 + 24, b"\1\2\3\4")))
    assert missing_times(trace, whole)[0] == 0
    ((at, _),) = places(data, FOOTER)
    with pytest.raises(TraceError, match=rf"a chunk with a wrong CRC .* at byte {begin}"):
        read(put(whole, replaced(data, begin + 9 + 24, b"\1\2\3\4")[:at]))


def test_damage_before_the_first_chunk_is_refused_without_an_index(whole: Path) -> None:
    """Records that describe the whole log may stand there."""
    data = replaced(whole.read_bytes(), 9, b"\xff\xff")
    assert rows(read(put(whole, data))) == rows(read(whole))
    ((at, _),) = places(whole.read_bytes(), FOOTER)
    with pytest.raises(TraceError, match=r"a header record of 65535 bytes, .* at byte 8"):
        read(put(whole, data[:at]))


def test_messages_without_chunks(flat: Path) -> None:
    data = flat.read_bytes()
    begin, _ = places(data, MESSAGE)[10]
    trace = read(put(flat, replaced(data, begin + 3, b"\xff\xff")))
    assert missing_times(trace, flat) == [10 * PERIOD_NS]
    assert is_lost(trace, 10 * PERIOD_NS)
    assert findings(trace)["unprotected"][0]["n"] == N - 1


def test_one_malformed_message(flat: Path) -> None:
    data = flat.read_bytes()
    begin, _ = places(data, MESSAGE)[10]
    trace = read(put(flat, replaced(data, begin + 9 + 22, b"\xff" * 12)))
    assert missing_times(trace, flat) == [10 * PERIOD_NS]
    (found,) = findings(trace)["lost_time"]
    assert f"record at byte {begin}" in found["message"]
    assert "at 1.000 s" in found["message"]
    for start, _ in places(data, MESSAGE)[10:20]:
        data = replaced(data, start + 9 + 22, b"\xff" * 12)
    with pytest.raises(TraceError, match=rf"record at byte {begin}: failed to decode"):
        read(put(flat, data))


def test_an_index_that_counts_more_messages(whole: Path) -> None:
    data = whole.read_bytes()
    at = places(data, STATISTICS)[0][0] + 9
    trace = read(put(whole, with_index_crc(replaced(data, at, struct.pack("<Q", N + 5)))))
    assert findings(trace)["index_mismatch"][0]["severity"] == "error"
    damaged = findings(read(put(whole, replaced(data, at, struct.pack("<Q", N + 5)))))
    assert damaged["index_damaged"][0]["severity"] == "warning"
    assert "index_mismatch" not in damaged, "an index with a wrong CRC is no witness"


def test_footer_that_points_past_the_file(whole: Path) -> None:
    data = whole.read_bytes()
    ((at, _),) = places(data, FOOTER)
    trace = read(put(whole, replaced(data, at + 9, struct.pack("<QQ", 2**40, 2**41))))
    assert rows(trace) == rows(read(whole))


def test_a_cut_file_with_another_behind_it(whole: Path) -> None:
    data = whole.read_bytes()
    begin, end = places(data, CHUNK)[4]
    for cut in ((begin + end) // 2, end):
        with pytest.raises(TraceError, match=rf"a second MCAP file begins at byte {cut}"):
            read(put(whole, data[:cut] + data))


def test_log_times_that_go_back_bound_nothing(tmp_path: Path) -> None:
    messages = osi_log.truths(osi_log.drive(N))
    late = [*messages[5:], *messages[:5]]
    path = osi_log.write(tmp_path / "late.mcap", late, chunk_size=600)
    data = path.read_bytes()
    begin, _ = places(data, CHUNK)[4]
    ((at, _),) = places(data, DATA_END)
    (found,) = findings(read(put(path, replaced(data, begin + 9 + 24, b"\1\2\3\4")[: at + 13])))["lost_time"]
    assert (found["t_first_ns"], found["t_last_ns"]) == (None, None)


def test_a_file_of_false_chunk_heads_ends(whole: Path) -> None:
    """Each head claims the rest of the file; looking into each to its end would take hours."""
    data = whole.read_bytes()
    begin, _ = places(data, CHUNK)[4]
    n = 40_000
    total = begin + 1 + n * HEAD_BYTES
    left = [total - (begin + 1 + k * HEAD_BYTES) for k in range(n)]
    heads = b"".join(struct.pack("<BQQQQIIQ", CHUNK, k - 9, 0, 0, k, 1, 0, max(k - HEAD_BYTES, 0)) for k in left)
    trace = read(put(whole, data[:begin] + b"\0" + heads))
    assert findings(trace)["lost_time"][0]["t_last_ns"] is None


mutations = st.lists(
    st.tuples(
        st.sampled_from(["flip", "zero", "cut", "drop", "insert"]),
        st.floats(0, 1, exclude_max=True),
        st.integers(0, 255),
    ),
    min_size=1,
    max_size=3,
)


@pytest.mark.ci
@settings(max_examples=150, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(changes=mutations)
def test_nothing_is_missing_unsaid_and_nothing_else_is_read(whole: Path, changes: list[tuple[str, float, int]]) -> None:
    data = whole.read_bytes()
    for how, share, k in changes:
        at = int(share * len(data))
        match how:
            case "flip":
                data = replaced(data, at, bytes([data[at] ^ (1 << k % 8)]))
            case "zero":
                data = data[:at] + bytes(min(k, len(data) - at)) + data[at + k :]
            case "cut":
                data = data[:at] if at > 100 else data
            case "drop":
                data = data[:at] + data[at + k :]
            case _:
                data = data[:at] + bytes(range(k)) + data[at:]
    try:
        trace = read(put(whole, data))
    except TraceError:
        return
    expected, found = rows(read(whole)), rows(trace)
    assert all(
        expected[key] == row for key, row in found.items() if not differs_at_an_end(trace, key, expected[key], row)
    )
    checks = findings(trace)
    for t in sorted({t for _, t in expected.keys() - found.keys()}):
        assert is_lost(trace, t) or "index_mismatch" in checks, f"{t}: {list(checks)}"
    assert log(trace)["n_states"] == len(found)


def differs_at_an_end(trace: Trace, key: tuple[str, int], row: dict[str, Any], damaged_row: dict[str, Any]) -> bool:
    """What is derived over time may differ beside a loss; what the log says may not."""
    said = ("actor_id", "t_ns", "x_m", "y_m", "z_m", "yaw_rad", "indicator", "brake_light")
    return all(row[name] == damaged_row[name] for name in said) and bool(findings(trace).get("lost_time"))
