"""Passengers and freight of SUMO: whoever rides is no road user of his own, whoever walks or waits is one."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from typing import TYPE_CHECKING, Any

import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from drivelint.drive.trace import IngestOptions
from drivelint.engine.batch import Drive
from drivelint.formats import load_map, read_trace
from drivelint.road.map_reader import MapSource
from tests.formats.logs import actors, put, quality, read, states
from tests.scenes import verdict_rows
from tests.shared_data import shared

if TYPE_CHECKING:
    from pathlib import Path

    Row = dict[str, Any]

TYPES = '<routes><vType id="cab" length="4" width="1.7"/><vType id="tall" vClass="pedestrian"/></routes>'
ABOARD = range(10, 20)
N = 30


def rows(*, carried: str = "person", with_vehicle: bool = False) -> list[Row]:
    """A cab comes by and stands for a second, somebody waits, rides in it from then on until it stands again, and walks off.

    `with_vehicle`: with the attribute `vehicle`.
    """
    found: list[Row] = []
    for t in range(N):
        cab = {"x": 20.0 + 2.0 * min(max(t, 9), 19), "y": -1.6, "angle": 90.0, "speed": 20.0 * (9 < t < 19)}
        own = {"x": 40.0 + 0.1 * t, "y": -7.8, "angle": 90.0, "speed": 1.0}
        found.append({"tag": "vehicle", "time": t / 10, "id": "cab1", **cab, "type": "cab", "lane": "a_1"})
        more = {"vehicle": "cab1" if t in ABOARD else ""} if with_vehicle else {}
        found.append(
            {
                "tag": carried,
                "time": t / 10,
                "id": "p",
                **(cab if t in ABOARD else own),
                "type": "tall",
                "edge": "a",
                **more,
            }
        )
    return found


def xml(of: list[Row]) -> str:
    text = "<fcd-export>\n"
    for t in dict.fromkeys(row["time"] for row in of):
        text += f'<timestep time="{t:.2f}">\n'
        for row in of:
            if row["time"] == t:
                text += (
                    f"<{row['tag']} "
                    + " ".join(f'{k}="{v}"' for k, v in row.items() if k not in {"tag", "time"})
                    + "/>\n"
                )
        text += "</timestep>\n"
    return text + "</fcd-export>\n"


def one_group(of: list[Row], first: str) -> pa.Table:
    """A table as SUMO 1.28 writes it: all columns are called after the element that came first."""
    names = ["id", "x", "y", "angle", "type", "speed", "lane", "edge"]
    columns = {f"{first}_{name}": [row.get(name) for row in of] for name in names}
    return pa.table({"timestep_time": [row["time"] for row in of], **columns})


def own_groups(of: list[Row]) -> pa.Table:
    """A table as the tool xml2csv makes it: each element has columns of its own."""
    columns: dict[str, list[Any]] = {"timestep_time": [row["time"] for row in of]}
    for tag in ("person", "vehicle"):
        for name in ("angle", "id", "speed", "type", "x", "y"):
            columns[f"{tag}_{name}"] = [row[name] if row["tag"] == tag else None for row in of]
    return pa.table(columns)


def write(path: Path, table: pa.Table) -> Path:
    if path.suffix == ".parquet":
        pq.write_table(table, path)
        return path
    lines = [";".join("" if value is None else str(value) for value in row.values()) for row in table.to_pylist()]
    return put(path, "\n".join([";".join(table.schema.names), *lines, ""]))


def forms(folder: Path, of: list[Row]) -> list[Path]:
    put(folder / "r.rou.xml", TYPES)
    return [
        put(folder / "a.xml", xml(of)),
        *(
            write(folder / f"{name}.{form}", table)
            for form in ("csv", "parquet")
            for name, table in (
                ("vehicles", one_group(of, "vehicle")), ("persons", one_group(of, "person")), ("own", own_groups(of)),
            )
        ),
    ]  # fmt: skip


def test_a_rider_is_no_road_user_and_a_walker_is_one(tmp_path: Path) -> None:
    for path in forms(tmp_path, rows()):
        trace = read(path, ego="cab1")
        times = [row["t_ns"] // 10**8 for row in states(trace, "p")]
        assert times == [t for t in range(N) if t not in ABOARD], path.name
        assert len(states(trace, "cab1")) == N
        kinds = {name: (row["actor_class"], row["length_m"]) for name, row in actors(trace).items()}
        assert kinds == {"cab1": ("car", 4.0), "p": ("pedestrian", 0.215)}, path.name
        assert quality(trace)["riding"]["n"] == len(ABOARD)


def test_the_attribute_counts_more_than_the_place(tmp_path: Path) -> None:
    """The passenger of a vehicle that the log leaves out rides; who is said to ride in none, walks, wherever that is."""
    alone = [row for row in rows(with_vehicle=True) if row["id"] == "p" or row["time"] > 2]
    assert len(states(read(put(tmp_path / "a.xml", xml(alone)), need_ego=False), "p")) == N - len(ABOARD)
    walks = [row | {"vehicle": ""} if "vehicle" in row else row for row in rows(with_vehicle=True)]
    assert len(states(read(put(tmp_path / "b.xml", xml(walks)), need_ego=False), "p")) == N


@pytest.mark.parametrize("column", ["x", "y", "angle", "speed"])
def test_who_is_beside_a_vehicle_is_not_in_it(tmp_path: Path, column: str) -> None:
    """A pedestrian who is hit stays one."""
    off = [row | {column: row[column] + 0.01} if row["tag"] == "person" and row["speed"] > 1 else row for row in rows()]
    trace = read(put(tmp_path / "a.xml", xml(off)), need_ego=False)
    assert len(states(trace, "p")) == N - sum(row["tag"] == "person" and row["speed"] == 0.0 for row in rows())


def test_vehicles_in_one_place_stay(tmp_path: Path) -> None:
    """Two that park in one place, as SUMO lets them, are two."""
    both = [row | {"tag": "vehicle", "lane": "a_1", "edge": ""} for row in rows()]
    for path in (put(tmp_path / "a.xml", xml(both)), write(tmp_path / "a.csv", one_group(both, "vehicle"))):
        assert len(states(read(path, need_ego=False))) == 2 * N


def test_freight_is_an_object(tmp_path: Path) -> None:
    trace = read(put(tmp_path / "a.xml", xml(rows(carried="container"))), need_ego=False)
    assert (actors(trace)["p"]["actor_class"], len(states(trace, "p"))) == ("object", N - len(ABOARD))


def test_kinds_that_nothing_says_are_unknown_and_riders_are_found(tmp_path: Path) -> None:
    table = one_group(rows(), "vehicle").drop_columns(["vehicle_type", "vehicle_lane", "vehicle_edge"])
    trace = read(write(tmp_path / "a.csv", table), ego="cab1")
    assert {name: row["actor_class"] for name, row in actors(trace).items()} == {"cab1": None, "p": None}
    assert (len(states(trace, "p")), len(states(trace, "cab1"))) == (N - len(ABOARD), N)


def test_a_person_and_a_vehicle_of_one_id_are_two(tmp_path: Path) -> None:
    same = [row | {"id": "0"} for row in rows()]
    trace = read(put(tmp_path / "a.xml", xml(same)), ego="0")
    assert {name: row["actor_class"] for name, row in actors(trace).items()} == {"0": None, "person:0": "pedestrian"}
    assert len(states(trace, "0")) == N
    assert any("person:ID" in note for note in trace.notes)


def test_lights_of_a_table_are_those_of_vehicles(tmp_path: Path) -> None:
    """Behind the slope, a person's row has other attributes: `vehicle` stands where a vehicle has its signals."""
    put(tmp_path / "r.rou.xml", TYPES)
    table = one_group(rows(), "vehicle").append_column(
        "vehicle_signals", pa.array(["8" if row["tag"] == "vehicle" else "cab1" for row in rows()])
    )
    for names in (table.schema.names, [n for n in table.schema.names if n not in {"vehicle_lane", "vehicle_edge"}]):
        trace = read(write(tmp_path / "a.csv", table.select(names)), ego="cab1")
        assert {row["brake_light"] for row in states(trace, "cab1")} == {"on"}
        assert {row["brake_light"] for row in states(trace, "p")} == {None}
    first = table.rename_columns(
        [name.replace("vehicle_", "person_", 1).replace("signals", "vehicle") for name in table.schema.names]
    )
    trace = read(write(tmp_path / "b.csv", first), ego="cab1")
    assert len(states(trace, "cab1")) == N  # "8" is no vehicle that it rides in
    assert {row["brake_light"] for row in states(trace, "cab1")} == {None}


def reported_rows(file: Path) -> tuple[set[tuple[float, str]], int]:
    """Read the log a second time: who is there when, and how many rows ride. One without `vehicle` rides where the vehicle above is."""
    there, riding = set(), 0
    for step in ET.parse(file).getroot():  # noqa: S314 - our own file
        place = None
        for item in step:
            own = tuple(item.get(name) for name in ("x", "y", "angle", "speed"))
            if item.tag == "vehicle":
                place = own
            elif own == place:
                riding += 1
                continue
            there.add((float(step.get("time", "")), item.get("id", "")))
    return there, riding


@pytest.mark.ci
def test_the_reported_ride_has_no_contact() -> None:
    log, net = shared("reported/sumo_riders/ride.fcd.xml"), shared("reported/sumo_riders/net.net.xml")
    environment = load_map(MapSource(net.name, net.read_bytes()))
    expected, riding = reported_rows(log)
    assert riding > 400
    for ego in ("taxi1", "solo"):
        trace = read_trace(log, IngestOptions(ego=ego))
        assert {(row["t_ns"] / 1e9, row["actor_id"]) for row in states(trace)} == expected
        assert quality(trace)["riding"]["n"] == riding
        found = verdict_rows([Drive(trace, environment)], rules=("ukhc.no-collision",))
        assert "fail" not in {row["verdict"] for row in found}
        assert "pass" in {row["verdict"] for row in found if row["object_id"] == "p1"}
