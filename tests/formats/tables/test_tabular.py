"""Tables through mappings: forms, units, frames, reference points, damaged rows."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import TYPE_CHECKING

import duckdb
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from drivelint.errors import TraceError
from drivelint.sql.declarations import column_comments
from tests.formats.logs import LONG, actors, at, cars, log, mapping, put, quality, read, states, table, without_id

if TYPE_CHECKING:
    from pathlib import Path

WIDE = """
description = "wide table of the tests"
[table]
separator = ";"
skip_rows = 2
null_values = ["NN"]
[time]
column = "t [ms]"
unit = "ms"
[columns]
actor_id = "#{k} name"
x = "#{k} x"
y = "#{k} y"
yaw = { column = "#{k} h", unit = "deg" }
speed = { column = "#{k} v", unit = "km/h" }
length = { column = "#{k} len", unit = "cm" }
width = 1.8
[ego]
ids = ["Ego"]
otherwise = "first"
"""


def test_long_table(tmp_path: Path) -> None:
    trace = read(table(tmp_path / "drive.csv", cars()), mapping=mapping(tmp_path))
    assert trace.drive_id.startswith("drive-")
    assert log(trace)["format"] == "mapping"
    assert [row["actor_id"] for row in states(trace)] == ["a"] * 20 + ["b"] * 20
    assert [row["t_ns"] for row in states(trace, "b")] == [i * 100_000_000 for i in range(20)]
    row = at(trace, "b", 1.9)
    assert (row["x_m"], row["y_m"], row["z_m"], row["vx_mps"], row["ax_mps2"]) == (19.0, 4.0, None, 10.0, None)
    assert {k: v["is_ego"] for k, v in actors(trace).items()} == {"a": True, "b": False}
    assert set(quality(trace)) == {"assumed_size", "no_indicator", "no_brake_light", "unprotected"}


def test_tables_are_those_of_the_schema(tmp_path: Path) -> None:
    trace = read(table(tmp_path / "drive.csv", cars()), mapping=mapping(tmp_path))
    for name, rows in trace.tables.items():
        assert rows.schema.names == list(column_comments()[name]), name
    assert trace.tables["actor_state"].schema.field("actor_id").type == pa.string()
    assert trace.tables["actor_state"].schema.field("t_ns").type == pa.int64()


def test_wide_table_with_units_and_an_absent_actor(tmp_path: Path) -> None:
    path = put(
        tmp_path / "wide.csv",
        """
        some tool 1.2
        with; notes
        t [ms]; #1 name ;#1 x;#1 y;#1 h;#1 v;#1 len;#10 name;#10 x;#10 y;#10 h;#10 v;#10 len
        0; Ego ; 0.0; 5; 90; 36; 450; Truck; 1; 2; NN; NN; 1200
        100; Ego ; 0.0; 6; 90; 36; 450;;;;;;
        """,
    )
    trace = read(path, mapping=mapping(tmp_path, WIDE))
    assert [(row["actor_id"], row["t_ns"]) for row in states(trace)] == [("Ego", 0), ("Ego", 100_000_000), ("Truck", 0)]
    ego = at(trace, "Ego", 0.1)
    assert ego["yaw_rad"] == pytest.approx(math.pi / 2)
    assert (ego["vx_mps"], ego["vy_mps"]) == pytest.approx((0.0, 10.0))
    assert (actors(trace)["Ego"]["length_m"], actors(trace)["Truck"]["length_m"]) == (4.5, 12.0)
    truck = at(trace, "Truck", 0.0)
    assert (truck["yaw_rad"], truck["vx_mps"]) == (None, None)
    assert "not_finite" not in quality(trace)


def test_first_vehicle_is_the_ego_where_none_has_its_name(tmp_path: Path) -> None:
    group = "#{k} name;#{k} x;#{k} y;#{k} h;#{k} v;#{k} len"
    lines = ["a", "b", ";".join(["t [ms]", *(group.replace("{k}", k) for k in "123")])]
    lines += [f"{100 * i};Cone;9;9;0;0;40;Zoe;{i};0;0;36;450;Abe;{i};4;0;36;450" for i in range(3)]
    kinds = '[class]\ncolumn = "#{k} name"\nvalues = { Cone = "object" }\ndefault = "car"\n'
    trace = read(table(tmp_path / "wide.csv", lines), mapping=mapping(tmp_path, WIDE + kinds))
    assert actors(trace)["Zoe"]["is_ego"]
    assert quality(trace)["ego_assumed"]["actor_id"] == "Zoe"


@pytest.mark.parametrize(
    ("unit", "value"), [("m/s", "10.0"), ("km/h", "36.0"), ("mph", "22.369362920544"), ("kn", "19.43844492440605")]
)
def test_speed_units(tmp_path: Path, unit: str, value: str) -> None:
    lines = [line.replace(",10.0,0.0", f",{value},0.0") for line in cars()]
    fields = {"vx": f'vx = {{ column = "vx", unit = "{unit}" }}'}
    trace = read(table(tmp_path / "d.csv", lines), mapping=mapping(tmp_path, **fields))
    assert at(trace, "a", 0.5)["vx_mps"] == pytest.approx(10.0)


@pytest.mark.parametrize(("unit", "factor"), [("s", 1), ("ms", 1e3), ("us", 1e6), ("ns", 1e9), ("min", 1 / 60)])
def test_time_units(tmp_path: Path, unit: str, factor: float) -> None:
    head, *rows = (line.split(",", 1) for line in cars())
    lines = [",".join(head), *(f"{float(time) * factor!r},{rest}" for time, rest in rows)]
    name = mapping(tmp_path, LONG.replace('column = "t"', f'column = "t"\nunit = "{unit}"'))
    trace = read(table(tmp_path / "d.csv", lines), mapping=name)
    assert [row["t_ns"] for row in states(trace, "a")] == [i * 100_000_000 for i in range(20)]


def test_nanoseconds_of_the_epoch_stay_exact(tmp_path: Path) -> None:
    start = 1_700_000_000_123_456_789
    lines = ["t,id,x,y,yaw,vx,vy", *(f"{start + i * 100_000_001},a,{i},0,0,10,0" for i in range(5))]
    name = mapping(tmp_path, LONG.replace('column = "t"', 'column = "t"\nunit = "ns"'))
    trace = read(table(tmp_path / "d.csv", lines), mapping=name)
    assert [row["t_ns"] for row in states(trace)] == [start + i * 100_000_001 for i in range(5)]
    assert log(trace)["utc_start_ns"] == start


def test_flips(tmp_path: Path) -> None:
    lines = ["t,id,x,y,yaw,vx,vy", *(f"{i / 10},a,{i * 0.6},{i * 0.8},{math.atan2(0.8, 0.6)},6,8" for i in range(30))]
    name = mapping(tmp_path, LONG + "[frame]\nflip_y = true\nflip_yaw = true\n")
    row = at(read(table(tmp_path / "d.csv", lines), mapping=name), "a", 1.0)
    assert (row["x_m"], row["y_m"], row["vx_mps"], row["vy_mps"]) == pytest.approx((6.0, -8.0, 6.0, -8.0))
    assert row["yaw_rad"] == pytest.approx(-math.atan2(0.8, 0.6))


def test_compass_heading(tmp_path: Path) -> None:
    """Degrees clockwise from north, as SUMO writes: east is 90."""
    lines = [line.replace(",0.0,10.0,", ",90.0,10.0,") for line in cars()]
    text = LONG.replace('yaw = "yaw"', 'yaw = { column = "yaw", unit = "deg" }')
    text += '[frame]\nflip_yaw = true\nyaw_zero = "north"\n'
    row = at(read(table(tmp_path / "d.csv", lines), mapping=mapping(tmp_path, text)), "a", 1.0)
    assert row["yaw_rad"] == pytest.approx(0.0, abs=1e-12)


def test_velocity_along_the_vehicle(tmp_path: Path) -> None:
    """Driving north: forward 10 m/s is vy = 10, left 1 m/s is vx = -1."""
    lines = ["t,id,x,y,yaw,vx,vy", *(f"{i / 10},a,{-i / 10},{i},{math.pi / 2},10,1" for i in range(30))]
    name = mapping(tmp_path, LONG + '[frame]\nvelocity = "vehicle"\n')
    row = at(read(table(tmp_path / "d.csv", lines), mapping=name), "a", 1.0)
    assert (row["vx_mps"], row["vy_mps"]) == pytest.approx((-1.0, 10.0))


@pytest.mark.parametrize("rate", ["", 'yaw_rate = "rate"\n'])
def test_rear_axle_on_a_circle(tmp_path: Path, rate: str) -> None:
    """The centre of a box 1.5 m before the axle moves on a wider circle, faster, and its velocity is its motion's."""
    radius, turning = 20.0, 0.5
    lines = ["t,id,x,y,yaw,vx,vy,rate"]
    for i in range(100):
        angle = turning * i / 20
        x, y, yaw = radius * math.sin(angle), -radius * math.cos(angle), (angle + math.pi) % (2 * math.pi) - math.pi
        v = radius * turning
        lines.append(f"{i / 20},a,{x!r},{y!r},{yaw!r},{v * math.cos(angle)!r},{v * math.sin(angle)!r},{turning}")
    text = LONG.replace("length = 4.5\n", f"length = 4.5\n{rate}") + '[reference]\npoint = "rear_axle"\nforward = 1.5\n'
    trace = read(table(tmp_path / "d.csv", lines), mapping=mapping(tmp_path, text))
    wide = math.hypot(radius, 1.5)
    for row in states(trace):
        assert math.hypot(row["x_m"], row["y_m"]) == pytest.approx(wide)
        assert math.hypot(row["vx_mps"], row["vy_mps"]) == pytest.approx(wide * turning, rel=1e-6)
    assert "velocity_mismatch" not in quality(trace)


def test_class_and_lights(tmp_path: Path) -> None:
    words = """
[class]
column = ["kind", "sub"]
values = { "v/1" = "car" }
patterns = [{ match = "^v/", is = "truck" }]
default = "object"
[indicator]
column = "ind"
values = { "1" = "left", "2" = "right", "0" = "off" }
"""
    lines = ["t,id,x,y,yaw,vx,vy,kind,sub,ind"]
    for i in range(3):
        lines += [f"{i},a,{i},0,0,1,0,v,1,{i}", f"{i},b,{i},4,0,1,0,v,9,7", f"{i},c,{i},9,0,1,0,w,1,"]
    trace = read(table(tmp_path / "d.csv", lines), mapping=mapping(tmp_path, LONG + words))
    assert {k: v["actor_class"] for k, v in actors(trace).items()} == {"a": "car", "b": "truck", "c": "object"}
    assert [row["indicator"] for row in states(trace, "a")] == ["off", "left", "right"]
    assert [row["indicator"] for row in states(trace, "b")] == [None] * 3
    assert log(trace)["has_indicator"] is True
    assert "no_indicator" not in quality(trace)


def test_padded_and_blank_rows_are_no_loss(tmp_path: Path) -> None:
    lines = [",".join(f"  {cell} " for cell in line.split(",")) for line in cars()]
    padded = read(table(tmp_path / "d.csv", [*lines, "", "   ", " , , , , , , ", ""]), mapping=mapping(tmp_path))
    plain = read(table(tmp_path / "d.csv", cars()), mapping=mapping(tmp_path))
    assert without_id(padded) == without_id(plain)
    assert set(quality(padded)) == {"assumed_size", "no_indicator", "no_brake_light", "unprotected"}


def test_comma_at_the_end_of_every_row_but_the_header(tmp_path: Path) -> None:
    lines = [line if line[0] == "t" else f"{line}," for line in cars()]
    trace = read(table(tmp_path / "d.csv", lines), mapping=mapping(tmp_path))
    assert log(trace)["n_states"] == 40
    assert "malformed_row" not in quality(trace)


def test_malformed_rows_are_counted_and_placed(tmp_path: Path) -> None:
    lines = cars()
    lines[3] += ",7,7"  # line 4
    lines[5] = lines[5].replace("a,", "a,nonsense", 1)  # line 6, x
    lines[8] = "soon" + lines[8][5:]  # line 9, time
    lines[10] = lines[10].replace(",b,", ",,")  # line 11, id
    lines.insert(2, "")  # every line number above grows by one
    trace = read(table(tmp_path / "d.csv", lines), mapping=mapping(tmp_path))
    found = {row["check_id"] + row["message"]: row["n"] for row in trace.tables["quality"].to_pylist()}
    for check, text in (
        ("malformed_row", "line 5: the number of cells differs from the 7 cells"),
        ("malformed_cell", "line 7: column 'x' is not a number"),
        ("dropped_row", "line 10: the time is missing or not a number"),
        ("dropped_row", "line 12: the actor id is missing"),
    ):
        assert [n for message, n in found.items() if check in message and text in message] == [1], (check, text, found)
    placed = [row for row in states(trace) if row["x_m"] is not None]
    assert len(placed) == 40 - 3 - 1
    assert [row["t_ns"] // 100_000_000 for row in states(trace, "a") if row not in placed] == [1, 2]


def test_a_bad_cell_right_after_a_broken_line(tmp_path: Path) -> None:
    lines = cars()
    lines[4] += ",7"  # line 5
    lines[5] = lines[5].replace("a,", "a,nonsense", 1)  # line 6
    found = quality(read(table(tmp_path / "d.csv", lines), mapping=mapping(tmp_path)))
    assert "line 6: column 'x'" in found["malformed_cell"]["message"]


def test_not_finite_values_are_unknown_and_counted(tmp_path: Path) -> None:
    lines = cars()
    for line, text in ((1, "nan"), (3, "inf"), (5, "-Infinity"), (7, "")):
        cells = lines[line].split(",")
        cells[2] = text
        lines[line] = ",".join(cells)
    trace = read(table(tmp_path / "d.csv", lines), mapping=mapping(tmp_path))
    assert [row["x_m"] for row in states(trace, "a")[:5]] == [None, None, None, None, pytest.approx(4.0)]
    assert (quality(trace)["not_finite"]["n"], quality(trace)["not_finite"]["actor_id"]) == (3, "a")
    assert quality(trace)["no_position"]["n"] == 4


def test_parquet_through_a_mapping(tmp_path: Path) -> None:
    n = 20
    rows = pa.table(
        {
            "t": pa.array([i * 100_000 for i in range(n)], pa.timestamp("us")),
            "id": pa.array([7.0] * n),
            "x": pa.array([float(i) for i in range(n)], pa.float32()),
            "y": pa.array([0] * n, pa.int16()),
            "yaw": pa.array([0.0] * (n - 1) + [None]),
            "vx": pa.array([10.0] * n),
            "vy": pa.array([0.0] * n),
        }
    ).replace_schema_metadata({"xodr": "<OpenDRIVE/>"})
    path = tmp_path / "x=9"
    path.mkdir()
    pq.write_table(rows, path / "d[1].parquet")
    trace = read(path / "d[1].parquet", mapping=mapping(tmp_path), ego="7")
    assert [row["t_ns"] for row in states(trace, "7")] == [i * 100_000_000 for i in range(n)]
    assert states(trace)[-1]["yaw_rad"] is None
    assert trace.embedded_map == b"<OpenDRIVE/>"


@pytest.mark.parametrize("kind", [pa.timestamp("us"), pa.timestamp("ms", "Europe/Berlin"), pa.duration("s")])
@pytest.mark.parametrize("beyond", [-(2**63), 2**63 - 1])
def test_a_time_beyond_the_nanoseconds_of_64_bits_is_a_lost_row(tmp_path: Path, kind: pa.DataType, beyond: int) -> None:
    n, per_s = 40, {"s": 1, "ms": 1000, "us": 1_000_000}[kind.unit]
    t = [beyond, *(per_s * i for i in range(1, n))]
    rows = {"t": pa.array(t, pa.int64()).cast(kind), "id": ["a"] * n, "x": [10.0 * i for i in range(n)]}
    rows |= dict.fromkeys(("y", "yaw", "vy"), [0.0] * n) | {"vx": [10.0] * n}
    pq.write_table(pa.table(rows), tmp_path / "d.parquet")
    trace = read(tmp_path / "d.parquet", mapping=mapping(tmp_path))
    assert [row["t_ns"] for row in states(trace)] == [i * 10**9 for i in range(1, n)]
    assert quality(trace)["dropped_row"]["n"] == 1


@pytest.mark.parametrize("kind", ["TIMESTAMP_S", "TIMESTAMP_MS", "TIMESTAMP", "TIMESTAMP_NS", "TIMESTAMPTZ"])
def test_a_time_column_of_duckdb_has_the_unit_of_its_type(tmp_path: Path, kind: str) -> None:
    """A row without a time is lost, it does not move.

    Source: seen with rerun-sdk 0.41.0, which takes each of them for nanoseconds (findings/rerun-parquet-column-without-its-unit.sh).
    """
    begin = 1_793_534_400  # 1 November 2026, 12:00 UTC
    time = "CASE WHEN i <> 7 THEN TIMESTAMP '2026-11-01 12:00:00' + to_seconds(i) END"
    names = "'a' AS id, 10.0 * i AS x, 0.0 AS y, 0.0 AS yaw, 10.0 AS vx, 0.0 AS vy"
    with duckdb.connect() as connection:
        connection.execute("SET TimeZone = 'UTC'")
        rows = f"SELECT CAST({time} AS {kind}) AS t, {names} FROM range(40) AS row(i)"
        connection.execute(f"COPY ({rows}) TO '{tmp_path / 'd.parquet'}' (FORMAT parquet)")
    trace = read(tmp_path / "d.parquet", mapping=mapping(tmp_path))
    seen = [(row["t_ns"], row["x_m"]) for row in states(trace)]
    assert seen == [((begin + i) * 10**9, 10.0 * i) for i in range(40) if i != 7]
    assert quality(trace)["dropped_row"]["n"] == 1


def test_a_shipped_mapping_is_found_by_its_columns(tmp_path: Path) -> None:
    names = "total_nanos,idx,x,y,z,yaw,vel_x,vel_y,acc_x,acc_y,length,width,height,type,subtype"
    lines = [names, *(f"{i * 50_000_000},0,{i},0,0,0,20,0,0,0,4,2,1,2,4" for i in range(30))]
    trace = read(table(tmp_path / "d.csv", lines), ego="0")
    assert log(trace)["format"] == "omega-prime"
    assert "omega-prime" in trace.notes[0]
    assert actors(trace)["0"]["actor_class"] == "car"


def test_wrong_units_are_refused(tmp_path: Path) -> None:
    lines = [line.replace(",10.0,0.0", ",36.0,0.0") for line in cars(40)]
    with pytest.raises(TraceError, match=r"d\.csv: velocity does not match .*km/h read as m/s: correct the mapping"):
        read(table(tmp_path / "d.csv", lines), mapping=mapping(tmp_path))


@pytest.mark.parametrize(("turns", "fits"), [(1.9, True), (2.1, False)])
def test_degrees_are_not_read_as_radians(tmp_path: Path, turns: float, fits: bool) -> None:
    """An unwrapped heading may go beyond a turn; 170 degrees are no radians."""
    yaw = 2 * math.pi * turns
    lines = ["t,id,x,y,yaw,vx,vy", *(f"{i / 10},a,{i * math.cos(yaw)},{i * math.sin(yaw)},{yaw},," for i in range(40))]
    name = mapping(tmp_path)
    if fits:
        (first, *_) = states(read(table(tmp_path / "d.csv", lines), mapping=name))
        assert first["yaw_rad"] == pytest.approx(2 * math.pi * (turns - 2)), "within half a turn"
        return
    with pytest.raises(TraceError, match=r"'yaw' goes up to 13\.1947, which is not an angle in radians: .*\"deg\""):
        read(table(tmp_path / "d.csv", lines), mapping=name)


@pytest.mark.parametrize(("without", "is_refused"), [(19, False), (21, True)])
def test_a_table_of_which_most_rows_are_lost_is_refused(tmp_path: Path, without: int, is_refused: bool) -> None:
    lines = ["t,id,x,y,yaw,vx,vy", *(f"{i / 10},{'' if i < without else 'a'},{i},0,0,10,0" for i in range(40))]
    name = mapping(tmp_path)
    if is_refused:
        with pytest.raises(TraceError, match=r"mapping 'mapping' cannot read 21 of 40 rows \(.*actor id is missing"):
            read(table(tmp_path / "d.csv", lines), mapping=name)
    else:
        assert read(table(tmp_path / "d.csv", lines), mapping=name).tables["actor_state"].num_rows == 40 - without


def test_a_flipped_heading_is_refused(tmp_path: Path) -> None:
    lines = ["t,id,x,y,yaw,vx,vy", *(f"{i / 10},a,{i * 0.6},{i * 0.8},{-math.atan2(0.8, 0.6)},6,8" for i in range(40))]
    with pytest.raises(TraceError, match=r"heading is off the direction of motion in 100 % .*sign"):
        read(table(tmp_path / "d.csv", lines), mapping=mapping(tmp_path))


@settings(max_examples=15, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(data=st.data())
def test_row_order_does_not_matter(tmp_path: Path, data: st.DataObject) -> None:
    lines = cars(12, ids=("a", "b", "10", "9"))
    lines[5] = lines[5].replace("0.0,10.0,", "nan,10.0,")
    shuffled = [lines[0], *data.draw(st.permutations(lines[1:]))]
    name = mapping(tmp_path)
    expected, found = (read(table(tmp_path / "d.csv", rows), mapping=name) for rows in (lines, shuffled))
    for kind in ("actor", "actor_state"):
        assert without_id(expected, kind) == without_id(found, kind)
    told, others = (
        [row | {"drive_id": None} for row in trace.tables["quality"].to_pylist() if row["check_id"] != "clock_jump"]
        for trace in (expected, found)
    )
    assert told == others
    assert "clock_jump" not in quality(expected)
    own_lines = ([line for line in shuffled[1:] if f",{name}," in line] for name in ("a", "b", "10", "9"))
    times = [[float(line.split(",")[0]) for line in own] for own in own_lines]
    back = sum(after < before for own in times for before, after in pairwise(own))
    assert quality(found).get("clock_jump", {"n": 0})["n"] == back


def test_times_that_run_back_are_said_with_their_lines(tmp_path: Path) -> None:
    lines = cars()
    lines[3], lines[7] = lines[7], lines[3]  # a at 0.1 s and at 0.3 s
    found = quality(read(table(tmp_path / "d.csv", lines), mapping=mapping(tmp_path)))["clock_jump"]
    assert (found["severity"], found["n"]) == ("warning", 2)
    assert "d.csv, lines 6, 8: the time is before that of the actor's previous row" in found["message"]
    by_actor = [lines[0], *sorted(cars()[1:], key=lambda line: line.split(",")[1])]
    assert "clock_jump" not in quality(read(table(tmp_path / "d.csv", by_actor), mapping=mapping(tmp_path)))


def test_an_actor_that_changes_its_column_group_does_not_run_back(tmp_path: Path) -> None:
    rows = [f"{k * 0.1:.1f},{'a' if k > 5 else 'b'},{k},{'b' if k > 5 else 'a'},{50 + k}" for k in range(12)]
    of_group = {"actor_id": 'actor_id = "id{k}"', "x": 'x = "x{k}"', "y": "y = 0.0", "yaw": "yaw = 0.0"}
    name = mapping(tmp_path, **of_group, vx="vx = 10.0", vy="vy = 0.0")
    trace = read(table(tmp_path / "d.csv", ["t,id1,x1,id2,x2", *rows]), mapping=name)
    assert log(trace)["n_states"] == 24
    assert "clock_jump" not in quality(trace)


@pytest.mark.parametrize(
    ("lines", "message"),
    [
        (["t,id,x,yy,yaw,vx,vy", "0,a,0,0,0,0,0"], r"no column 'y', which mapping 'mapping' needs: did you mean 'yy'"),
        (["t,id,x,yaw,vx,vy", "0,a,0,0,0,0"], r"no column 'y', .* needs: known are t, id, x, yaw, vx, vy$"),
        (["t,id,x,y,yaw,vx", "0,a,0,0,0,0"], r"no column 'vy', .* needs: known are t, id, x, y, yaw, vx$"),
        (["t,id,x,y,yaw,vx,vy,y", "0,a,0,0,0,0,0,0"], r"the column 'y' occurs 2 times"),
        (["t,id,x,y,yaw,vx,vy"], r"no row follows the header|no actor states"),
        (
            ["t,id,x,y,yaw,vx,vy", "0,a,0"],
            "line 2: the number of cells differs from the 7 cells of the header: no row is left",
        ),
        (["", "t,id,x,y,yaw,vx,vy"], r"line 1 should contain the names of the columns, but is blank"),
        (["t,id,x,y,yaw,vx,vy", ",,,,,,"], r"no actor states in this log"),
    ],
)
def test_tables_that_do_not_fit(tmp_path: Path, lines: list[str], message: str) -> None:
    with pytest.raises(TraceError, match=message) as error:
        read(table(tmp_path / "d.csv", lines), mapping=mapping(tmp_path))
    assert str(tmp_path / "d.csv") in str(error.value)
    assert "\n" not in str(error.value)


def test_no_mapping_fits(tmp_path: Path) -> None:
    said = r"no shipped mapping fits its columns \(shipped: .*carla-testbench.*--mapping"
    with pytest.raises(TraceError, match=said):
        read(table(tmp_path / "d.csv", ["a,b", "1,2"]))


def test_text_that_is_not_utf8(tmp_path: Path) -> None:
    path = tmp_path / "d.csv"
    path.write_bytes("\n".join(cars()).encode() + b"\n0.1,\xff,0,0,0,0,0\n")
    with pytest.raises(TraceError, match=r"d\.csv: not .*UTF-?8"):
        read(path, mapping=mapping(tmp_path))


def test_a_broken_line_that_is_not_utf8_either(tmp_path: Path) -> None:
    path = tmp_path / "d.csv"
    good = "\n".join(cars()).encode()
    path.write_bytes(good + b"\n0.1,\xac,0\n")
    with pytest.raises(TraceError, match=rf"not UTF-8 text at byte {len(good) + 5}: save it as UTF-8"):
        read(path, mapping=mapping(tmp_path))
