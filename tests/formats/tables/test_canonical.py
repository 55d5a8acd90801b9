"""Canonical Parquet: what was read can be written and read again, and what is no canonical table is refused."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pyarrow as pa
import pyarrow.compute as pc
import pyarrow.parquet as pq
import pytest

from drivelint.errors import TraceError
from drivelint.sql.store import connect, insert
from tests.formats.logs import actors, log, quality, read, states
from tests.formats.osi import osi_log

if TYPE_CHECKING:
    from pathlib import Path

    from drivelint.drive.trace import Trace


def folder(
    path: Path, trace: Trace, names: tuple[str, ...] = ("actor", "actor_state", "signal_state", "declared_event")
) -> Path:
    path.mkdir()
    for name in names:
        pq.write_table(trace.tables[name], path / f"{name}.parquet")
    return path


@pytest.fixture
def source(tmp_path: Path) -> Trace:
    frames = osi_log.drive(20, a=(0.5, 0.0), indicator=4, brake=2)
    for truth in frames:
        light = truth.traffic_light.add()
        light.id.value, light.classification.color, light.classification.mode = 5, 2, 3
    frames[3].moving_object[2].base.ClearField("position")
    return read(osi_log.write(tmp_path / "source.mcap", osi_log.truths(frames)))


def test_round_trip(tmp_path: Path, source: Trace) -> None:
    path = folder(
        tmp_path / "drive.one", source, ("actor", "actor_state", "signal_state", "declared_event", "data_log")
    )
    trace = read(path)
    assert trace.drive_id.startswith("drive.one-")
    added = pc.equal(trace.tables["quality"]["check_id"], "unprotected")
    assert pc.sum(added).as_py() == 1
    trace.tables["quality"] = trace.tables["quality"].filter(pc.invert(added))
    for name in ("actor", "actor_state", "signal_state", "declared_event", "quality"):
        assert trace.tables[name].drop_columns("drive_id") == source.tables[name].drop_columns("drive_id"), name
    assert log(trace) | {"drive_id": "", "sha256": "", "file_name": "", "format": ""} == log(source) | {
        "drive_id": "",
        "sha256": "",
        "file_name": "",
        "format": "",
    }


def conditions(path: Path, source: Trace, rows: list[dict[str, str | None]], **options: Any) -> list[tuple[str, ...]]:
    drive = folder(path, source)
    pq.write_table(pa.Table.from_pylist(rows), drive / "drive_condition.parquet")
    found = read(drive, **options).tables["drive_condition"].drop_columns("drive_id").to_pylist()
    return [tuple(row.values()) for row in found]


def test_what_holds_in_the_drive_is_said_by_the_log_or_given_and_then_that_counts(
    tmp_path: Path, source: Trace
) -> None:
    rows: list[dict[str, str | None]] = [
        {"condition": "weather", "value": "wet"}, {"condition": "nation", "value": "gb-sct"},
    ]  # fmt: skip
    assert conditions(tmp_path / "a", source, rows) == [("nation", "gb-sct", "trace"), ("weather", "wet", "trace")]
    given = (("light", "night"), ("weather", "dry"))
    assert conditions(tmp_path / "b", source, rows, conditions=given) == [
        ("light", "night", "env"), ("nation", "gb-sct", "trace"), ("weather", "dry", "env"),
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("condition", "value", "says"),
    [
        ("weather", "wett", "did you mean 'wet'"),
        ("wether", "wet", "did you mean 'weather'"),
        ("weather", None, "lacks its name or its value"),
        ("weather", "dry", "both 'wet' and 'dry'"),
    ],
)
def test_conditions_that_are_not_understood_are_refused(
    tmp_path: Path, source: Trace, condition: str, value: str | None, says: str
) -> None:
    rows: list[dict[str, str | None]] = [{"condition": "weather", "value": "wet"}]
    with pytest.raises(TraceError, match=f"drive_condition.parquet: .*{says}"):
        conditions(tmp_path / "a", source, [*rows, {"condition": condition, "value": value}])


def test_words_are_read_in_any_case(tmp_path: Path, source: Trace) -> None:
    """Tables written in capitals are those written in small letters."""
    small = read(folder(tmp_path / "small", source))
    loud = folder(tmp_path / "loud", source)
    for name in ("actor", "actor_state", "signal_state"):
        table = source.tables[name]
        for column in {"actor_class", "indicator", "brake_light", "state"} & set(table.column_names):
            words = pa.array([word and word.upper() for word in table[column].to_pylist()], pa.string())
            assert words.null_count < len(words)
            table = table.set_column(table.column_names.index(column), column, words)
        pq.write_table(table, loud / f"{name}.parquet")
    read_loud = read(loud)
    for name in ("actor", "actor_state", "signal_state"):
        assert read_loud.tables[name].drop_columns("drive_id") == small.tables[name].drop_columns("drive_id"), name
    given: list[dict[str, str | None]] = [
        {"condition": "Nation", "value": "GB"}, {"condition": "road_type", "value": "townlocal"},
    ]  # fmt: skip
    assert conditions(tmp_path / "c", source, given) == [
        ("nation", "gb", "trace"), ("road_type", "townLocal", "trace"),
    ]  # fmt: skip


def test_a_signal_state_that_is_no_word_is_refused(tmp_path: Path, source: Trace) -> None:
    path = folder(tmp_path / "d", source)
    states = source.tables["signal_state"].to_pylist()
    pq.write_table(pa.Table.from_pylist([states[0] | {"state": "REDD"}]), path / "signal_state.parquet")
    with pytest.raises(TraceError, match=r"signal_state\.parquet: state is 'REDD'; did you mean 'red'\?"):
        read(path)


def test_tables_go_into_the_database(source: Trace) -> None:
    con = connect()
    for name, rows in source.tables.items():
        insert(con, name, rows)
    assert con.execute("SELECT count(*), count(x_m), min(indicator) FROM actor_state").fetchone() == (60, 59, "right")
    assert con.execute("SELECT environment_id FROM data_log").fetchall() == [(None,)]


def test_single_file(tmp_path: Path, source: Trace) -> None:
    pq.write_table(source.tables["actor_state"], tmp_path / "d.parquet")
    trace = read(tmp_path / "d.parquet", ego="1")
    assert trace.tables["actor_state"].drop_columns("drive_id") == source.tables["actor_state"].drop_columns("drive_id")
    assert (actors(trace)["1"]["is_ego"], actors(trace)["1"]["length_m"]) == (True, None)
    assert "no_size" in quality(trace)


def rows(**columns: list[Any]) -> pa.Table:
    base = {"actor_id": ["a", "b"], "t_ns": [0, 0], "x_m": [0.0, 1.0], "y_m": [0.0, 1.0], "yaw_rad": [0.0, 0.0]}
    return pa.table({name: values for name, values in {**base, **columns}.items() if values})


def test_single_file_with_actor_columns(tmp_path: Path) -> None:
    table = rows(actor_class=["car", None], length_m=[4.0, -1.0], width_m=[2.0, 2.0], is_ego=[True, None])
    pq.write_table(table, tmp_path / "d.parquet")
    trace = read(tmp_path / "d.parquet")
    assert [(v["actor_class"], v["length_m"], v["is_ego"]) for v in actors(trace).values()] == [
        ("car", 4.0, True),
        (None, None, False),
    ]


def test_integer_ids_become_text(tmp_path: Path) -> None:
    pq.write_table(rows(actor_id=[10, 9]), tmp_path / "d.parquet")
    assert [row["actor_id"] for row in states(read(tmp_path / "d.parquet", ego="10"))] == ["10", "9"]


def test_rows_without_actor_or_time_are_counted(tmp_path: Path) -> None:
    pq.write_table(rows(actor_id=["a", ""], t_ns=[0, 1]), tmp_path / "d.parquet")
    trace = read(tmp_path / "d.parquet", ego="a")
    assert (len(states(trace)), quality(trace)["dropped_row"]["n"]) == (1, 1)


def test_actors_without_states_stay(tmp_path: Path, source: Trace) -> None:
    path = folder(tmp_path / "d", source)
    extra = source.tables["actor"].to_pylist()
    extra.append({**extra[0], "actor_id": "ghost", "is_ego": False})
    pq.write_table(pa.Table.from_pylist(extra, source.tables["actor"].schema), path / "actor.parquet")
    assert set(actors(read(path))) == {"0", "1", "2", "ghost"}


@pytest.mark.parametrize(
    ("columns", "message"),
    [
        ({"indicator": ["left", "lefft"]}, r"indicator is 'lefft'; did you mean 'left'\? \(NULL: unknown\)"),
        ({"actor_class": ["car", "lorry"]}, "actor_class is 'lorry'"),
        ({"x_m": ["a", "b"]}, "column 'x_m' is string, not double"),
        ({"drive_id": ["d", "e"]}, "contains 2 drives"),
    ],
)
def test_tables_that_are_wrong(tmp_path: Path, columns: dict[str, list[Any]], message: str) -> None:
    pq.write_table(rows(**columns), tmp_path / "d.parquet")
    with pytest.raises(TraceError, match=message) as error:
        read(tmp_path / "d.parquet", ego="a")
    assert "\n" not in str(error.value)


def test_folder_without_the_columns(tmp_path: Path) -> None:
    (tmp_path / "d").mkdir()
    pq.write_table(rows(yaw_rad=[]), tmp_path / "d" / "actor_state.parquet")
    with pytest.raises(TraceError, match=r"actor_state\.parquet: no column yaw_rad: a canonical table needs"):
        read(tmp_path / "d")


def test_the_drive_is_its_tables(tmp_path: Path, source: Trace) -> None:
    one = read(folder(tmp_path / "d", source))
    (tmp_path / "d" / "notes.txt").write_text("x")
    assert read(tmp_path / "d").drive_id == one.drive_id
    (tmp_path / "d" / "signal_state.parquet").unlink()
    assert read(tmp_path / "d").drive_id != one.drive_id


@pytest.mark.parametrize("rows", [1, 3])
def test_a_table_of_states_that_is_not_the_one_counted_is_refused(rows: int, tmp_path: Path) -> None:
    state = {"t_ns": 0, "actor_id": "a", "x_m": 0.0, "y_m": 0.0, "yaw_rad": 0.0, "is_ego": True}
    pq.write_table(
        pa.Table.from_pylist([state | {"t_ns": k * 100_000_000} for k in range(rows)]), tmp_path / "actor_state.parquet"
    )
    pq.write_table(pa.Table.from_pylist([{"n_states": 2}]), tmp_path / "data_log.parquet")
    with pytest.raises(TraceError, match=rf"actor_state\.parquet: {rows} rows, but data_log\.parquet states 2"):
        read(tmp_path)
    pq.write_table(pa.Table.from_pylist([{"n_states": rows}]), tmp_path / "data_log.parquet")
    assert len(states(read(tmp_path))) == rows
