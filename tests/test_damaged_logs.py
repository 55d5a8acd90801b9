"""A damaged log among others: what was lost is no pass, what was seen stands, and nobody else is concerned."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest

import drivelint
from drivelint.annotate import annotator
from drivelint.engine.derive import derive
from drivelint.sql import declarations, store
from tests.formats.mcap.damage import CHUNK, FOOTER, MESSAGE, places, replaced
from tests.formats.osi import osi_log

if TYPE_CHECKING:
    from pathlib import Path

    import duckdb

NO_COLLISION = "ukhc.no-collision"
N = 40
PERIOD_NS = 100_000_000
Row = dict[str, Any]


@pytest.fixture
def good(tmp_path: Path) -> Path:
    return osi_log.write(tmp_path / "good.mcap", osi_log.truths(osi_log.drive(N + 1)))


def frames(collision_at: int | None = None) -> list[Any]:
    """Return cars beside each other; one comes over, into the ego, and goes back."""
    found = osi_log.drive(N)
    for i, truth in enumerate(found if collision_at is not None else ()):
        other, steps = truth.moving_object[1].base, i - (collision_at or 0)
        other.position.y = 0.4 * min(abs(steps), 10)
        other.velocity.y = 0.0 if steps == 0 or abs(steps) > 10 else 4.0 * (1 if steps > 0 else -1)
    return found


def whole_log(tmp_path: Path, collision_at: int | None = None, **options: Any) -> bytes:
    path = tmp_path / "whole.mcap"
    options = {"chunk_size": 600, "enable_data_crcs": False, **options}
    return osi_log.write(path, osi_log.truths(frames(collision_at)), **options).read_bytes()


def check_result(tmp_path: Path, data: bytes, *more_logs: Path) -> drivelint.CheckResult:
    path = tmp_path / "bad.mcap"
    path.write_bytes(data)
    return drivelint.check([path, *more_logs], rules=NO_COLLISION, annotate=False, robustness=False)


def verdicts(result: drivelint.CheckResult, name: str) -> list[Row]:
    rows = result.verdicts.arrow().to_pylist()
    return [row for row in rows if row["drive_id"].startswith(name)]


def drive(result: drivelint.CheckResult, name: str) -> Row:
    row: Row
    (row,) = (row for row in result.drives.arrow().to_pylist() if row["file_name"] == f"{name}.mcap")
    return row


def without_chunk(data: bytes, k: int) -> bytes:
    return replaced(data, places(data, CHUNK)[k][0] + 9 + 24, b"\1\2\3\4")


def test_the_whole_log_passes(tmp_path: Path) -> None:
    result = check_result(tmp_path, whole_log(tmp_path))
    assert (result.exit_code, {row["verdict"] for row in verdicts(result, "bad")}) == (0, {"pass"})


def test_no_verdict_over_a_lost_chunk(tmp_path: Path, good: Path) -> None:
    data = whole_log(tmp_path)
    result = check_result(tmp_path, without_chunk(data, 4), good)
    assert (result.exit_code, drive(result, "bad")["lossy"], drive(result, "good")["lossy"]) == (3, True, False)
    (lost,) = (found for found in drive(result, "bad")["quality"] if found["check_id"] == "lost_time")
    begin, end = places(data, CHUNK)[4]
    assert f"bad.mcap: {end - begin} bytes from byte {begin} on" in lost["message"]
    rows = verdicts(result, "bad")
    holes = [row for row in rows if row["reason_code"] == "log_hole"]
    assert holes
    assert {row["verdict"] for row in holes} == {"unknown"}
    (hole,) = {(row["t_start_ns"], row["t_end_ns"]) for row in holes}
    assert hole[0] <= lost["t_first_ns"] <= hole[0] + PERIOD_NS
    for row in rows:
        assert row["verdict"] != "pass" or row["t_end_ns"] <= hole[0] or row["t_start_ns"] >= hole[1]
    alone = drivelint.check([good], rules=NO_COLLISION, annotate=False, robustness=False)
    assert verdicts(result, "good") == verdicts(alone, "good")


@pytest.mark.ci
def test_one_lost_frame_is_a_hole_too(tmp_path: Path) -> None:
    """Two periods without a frame are none where nobody knows that one was recorded; here it is known."""
    data = whole_log(tmp_path, use_chunking=False)
    begin, _ = places(data, MESSAGE)[10]
    result = check_result(tmp_path, replaced(data, begin + 9 + 22, b"\xff" * 12))
    holes = {
        (row["verdict"], row["t_start_ns"], row["t_end_ns"])
        for row in verdicts(result, "bad")
        if row["reason_code"] == "log_hole"
    }
    assert holes == {("unknown", 9 * PERIOD_NS, 11 * PERIOD_NS)}
    assert result.exit_code == 3


@pytest.mark.sample(1, ci=1)
@pytest.mark.parametrize("at", [5, N - 6])
def test_a_judged_step_that_fails_stands(tmp_path: Path, at: int) -> None:
    data = whole_log(tmp_path, at)
    result = check_result(tmp_path, without_chunk(data, 4))
    failed = [row for row in verdicts(result, "bad") if row["verdict"] == "fail"]
    assert failed
    assert all(abs(row["t_worst_ns"] - at * PERIOD_NS) < 5 * PERIOD_NS for row in failed)
    assert result.exit_code == 1


@pytest.mark.sample(1, ci=4)
@pytest.mark.parametrize(
    ("damage", "code", "phrase"),
    [
        (lambda _: b"", 4, "the file is empty"),
        (lambda _: b"<html>404 Not Found</html>", 4, "begins b'<html>40' at byte 0"),
        (lambda data: data[: len(data) // 2], 3, "cannot be read"),
        (lambda data: data[: places(data, FOOTER)[0][0]], 0, "nothing is lost"),
        (lambda data: data[: len(data) // 2] + bytes(len(data) // 2), 3, "cannot be read"),
        (lambda data: without_chunk(data, 4), 3, "wrong CRC"),
        (lambda data: replaced(data, places(data, FOOTER)[0][1] - 4, b"\1\2\3\4"), 0, "the index has a wrong CRC"),
        (lambda data: data + data, 4, "a second MCAP file begins"),
        (lambda data: data + b"more", 0, "4 bytes follow"),
        (lambda data: replaced(data, places(data, CHUNK)[4][0] + 1, (2**60).to_bytes(8, "little")), 4, str(2**60)),
        (lambda data: replaced(data, places(data, CHUNK)[4][0] + 25, (2**40).to_bytes(8, "little")), 4, "beyond 512 MiB"),
        (lambda data: data.replace(b"\4\0\0\0zstd", b"\4\0\0\0brot"), 4, "compressed by 'brot'"),
    ],
    ids=[
        "empty", "html", "cut", "no footer", "zero tail", "chunk CRC", "index CRC", "two files", "trailing", "2^60", "bomb",
        "compression",
    ],
)  # fmt: skip
def test_faults(tmp_path: Path, good: Path, damage: Any, code: int, phrase: str) -> None:
    """The faults of one file have one exit code each, and its sentence; the other drive is judged as if alone."""
    result = check_result(tmp_path, damage(whole_log(tmp_path)), good)
    assert result.exit_code == code
    row = drive(result, "bad")
    assert row["status"] == ("not_judged" if code == 4 else "judged")
    assert phrase in (row["status_reason"] or "") + " ".join(found["message"] for found in row["quality"])
    assert (drive(result, "good")["status"], drive(result, "good")["lossy"]) == ("judged", False)
    assert {found["verdict"] for found in verdicts(result, "good")} == {"pass"}


@pytest.mark.ci
def test_a_damaged_log_is_annotated_without_its_own_messages(tmp_path: Path) -> None:
    path = tmp_path / "bad.mcap"
    path.write_bytes(without_chunk(whole_log(tmp_path), 4))
    result = drivelint.check([path], rules=NO_COLLISION, out=tmp_path / "out")
    (annotated,) = (tmp_path / "out" / "annotated").glob("bad-*.mcap")
    assert not any("not annotated" in note for note in result.notes)
    assert drivelint.read_trace(annotated, ego="0").drive_id if annotated else False


@pytest.mark.slow
def test_an_annotation_that_fails_voids_no_verdict(tmp_path: Path, good: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(*_: object) -> None:
        raise ValueError("no picture")

    alone = drivelint.check([good], rules=NO_COLLISION, annotate=False)
    monkeypatch.setattr(annotator, "write_log", fail)
    result = drivelint.check([good], rules=NO_COLLISION, out=tmp_path / "out")
    assert result.verdicts.arrow() == alone.verdicts.arrow()
    assert [note for note in result.notes if "not annotated" in note and "no picture" in note]
    assert not list((tmp_path / "out" / "annotated").glob("*.mcap"))
    assert not list((tmp_path / "out" / "annotated").glob(".*"))


def test_what_was_declared_before_a_loss_is_not_known_after_it() -> None:
    with store.temporary_database(None) as con:
        fill(con)
        derive(con, {"ego_mode", "_signal_phase"}, are_map_tables=False)
        modes = con.execute("SELECT t_ns, is_on FROM ego_mode ORDER BY t_ns").fetchall()
        assert modes == [(0, True), (10, True), (20, None), (30, False)]
        phases = con.execute("SELECT t_from_ns, t_to_ns, state FROM _signal_phase ORDER BY t_from_ns").fetchall()
        assert phases == [(0, 13, "red"), (13, 30, None), (30, None, "green")]


def fill(con: duckdb.DuckDBPyConnection) -> None:
    store.recreate_with_enums(con, declarations.tables_of_lifetime("drive", "part"), ["d"], {"e"})
    rows: dict[str, list[Row]] = {
        "actor": [{"actor_id": "e", "is_ego": True}],
        "actor_state": [{"actor_id": "e", "t_ns": t} for t in (0, 10, 20, 30)],
        "declared_event": [
            {"t_ns": 0, "actor_id": "e", "event": "engaged", "value": "on"},
            {"t_ns": 30, "actor_id": "e", "event": "engaged", "value": "off"},
        ],
        "signal_state": [
            {"signal_id": "s", "t_ns": 0, "state": "red"},
            {"signal_id": "s", "t_ns": 30, "state": "green"},
        ],
        "quality": [
            {"check_id": "lost_time", "severity": "error", "n": 1, "t_first_ns": 12, "t_last_ns": 18, "message": "lost"}
        ],
    }
    for name, content in rows.items():
        empty = dict.fromkeys(store.arrow_schemas()[name].names)
        store.insert(con, name, store.table_with_owner_id(name, "d", [empty | row for row in content], "test"))
