"""Box centres behind the front bumpers of SUMO 1.28: copies of types (`BASE@ID`), changing types, types that nobody knows."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from typing import TYPE_CHECKING, Any

import pytest

from drivelint.drive.trace import EgoSize
from tests.formats.logs import actors, at, put, quality, read, states
from tests.formats.sumo.fcd_text import ROWS, csv, xml
from tests.shared_data import shared

if TYPE_CHECKING:
    from pathlib import Path

BUS = (
    '<routes><vType id="bus" length="12" width="2.5" vClass="bus"/><vType id="quick" length="4" width="1.7"/></routes>'
)
LAST = 1.9


def rows_with_types(change: dict[float, str], actor_id: str = "b.0") -> list[dict[str, Any]]:
    """The rows, in which a vehicle has another type from some times on."""
    return [
        row | {"type": [kind for since, kind in change.items() if float(row["time"]) >= since][-1]}
        if row["id"] == actor_id
        else row
        for row in ROWS
    ]


@pytest.mark.parametrize("form", ["xml", "csv"])
@pytest.mark.parametrize("base", ["bus", "bus@home", "DEFAULT_BIKETYPE"])
def test_a_copy_for_one_vehicle_has_the_size_of_its_type(tmp_path: Path, form: str, base: str) -> None:
    put(tmp_path / "r.rou.xml", BUS.replace('id="bus"', 'id="bus@home"') if base == "bus@home" else BUS)
    plain, copy = rows_with_types({0.0: base}), rows_with_types({0.0: base, 1.0: f"{base}@b.0"})
    write = xml if form == "xml" else csv
    expected = read(put(tmp_path / f"a.{form}", write(plain)), ego="a.0")
    trace = read(put(tmp_path / f"a.{form}", write(copy)), ego="a.0")
    assert [row["x_m"] for row in states(trace, "b.0")] == [row["x_m"] for row in states(expected, "b.0")]
    assert actors(trace)["b.0"] | {"drive_id": ""} == actors(expected)["b.0"] | {"drive_id": ""}
    assert "bumper_position" not in quality(trace)
    assert (quality(trace)["copied_type"]["actor_id"], quality(trace)["copied_type"]["severity"]) == ("b.0", "info")


def test_a_copy_that_is_known_has_its_own_size(tmp_path: Path) -> None:
    put(tmp_path / "r.rou.xml", BUS.replace("</routes>", '<vType id="bus@b.0" length="9" width="2"/></routes>'))
    trace = read(put(tmp_path / "a.xml", xml(rows_with_types({0.0: "bus@b.0"}))), ego="a.0")
    assert actors(trace)["b.0"]["length_m"] == 9.0
    assert "copied_type" not in quality(trace)


def test_the_copy_of_another_vehicle_is_no_copy(tmp_path: Path) -> None:
    """Somebody who calls types so himself: there is no vehicle `x`."""
    put(tmp_path / "r.rou.xml", BUS)
    trace = read(put(tmp_path / "a.xml", xml(rows_with_types({0.0: "bus@x"}))), ego="a.0")
    assert actors(trace)["b.0"]["length_m"] is None


@pytest.mark.parametrize("later_type", ["strange", "quick"])
def test_a_track_has_one_reference_point(tmp_path: Path, later_type: str) -> None:
    """Where its type is not known or has another length, the place is not known: no jump from the centre to the bumper."""
    put(tmp_path / "r.rou.xml", BUS)
    trace = read(put(tmp_path / "a.xml", xml(rows_with_types({0.0: "bus", 1.2: later_type}))), ego="a.0")
    places = [(row["x_m"], row["y_m"]) for row in states(trace, "b.0")]
    assert places[:12] == [(pytest.approx(50.0 + t - 6.0), pytest.approx(0.0)) for t in range(12)]
    assert places[12:] == [(None, None)] * 8
    assert actors(trace)["b.0"]["length_m"] == 12.0
    assert (quality(trace)["size_changes"]["n"], quality(trace)["size_changes"]["severity"]) == (8, "warning")
    assert later_type in quality(trace)["size_changes"]["message"]
    assert not quality(trace).keys() & {"teleport", "size_varies", "bumper_position"}


def test_two_types_of_one_length_are_one_track(tmp_path: Path) -> None:
    put(tmp_path / "r.rou.xml", BUS.replace("</routes>", '<vType id="tram" length="12" width="2.4"/></routes>'))
    trace = read(put(tmp_path / "a.xml", xml(rows_with_types({0.0: "bus", 1.0: "tram"}))), ego="a.0")
    assert at(trace, "b.0", LAST)["x_m"] == pytest.approx(50.0 + 19 - 6.0)
    assert "size_changes" not in quality(trace)


def test_types_that_two_files_know_differently_are_unknown(tmp_path: Path) -> None:
    put(tmp_path / "a.rou.xml", BUS)
    put(tmp_path / "b.rou.xml", BUS.replace('length="12"', 'length="14"'))
    trace = read(put(tmp_path / "a.xml", xml()), ego="a.0")
    assert (actors(trace)["b.0"]["length_m"], actors(trace)["a.0"]["length_m"]) == (None, 4.0)
    assert any("the type bus differs between b.rou.xml and a.rou.xml" in note for note in trace.notes)


@pytest.mark.parametrize("ego", ["b.0", "all"])
def test_the_size_that_the_user_gives_moves_the_centre(tmp_path: Path, ego: str) -> None:
    """Of a tram nothing says the length."""
    put(tmp_path / "r.rou.xml", BUS.replace('length="12" width="2.5" vClass="bus"', 'vClass="tram"'))
    log = put(tmp_path / "a.xml", xml())
    assert at(read(log, ego=ego), "b.0", 0.0)["x_m"] == pytest.approx(50.0)
    sized = read(log, ego=ego, ego_size=EgoSize(20.0, 2.5))
    assert (at(sized, "b.0", 0.0)["x_m"], actors(sized)["b.0"]["length_m"]) == (pytest.approx(40.0), 20.0)
    assert at(sized, "a.0", 0.0)["x_m"] == pytest.approx(-2.0)


def test_the_reported_bus_keeps_its_distance() -> None:
    """12.53 m ahead, says TraCI, and its own centre is half of 12 m behind the bumper all the time."""
    log = shared("reported/sumo_base_at_id/two.fcd.xml")
    trace = read(log, ego="a0")
    front, rear = at(trace, "a0", 4.8), at(trace, "b0", 4.8)
    assert rear["x_m"] - 6.0 - (front["x_m"] + 2.3) == pytest.approx(12.53, abs=1e-9)
    bumpers = {
        float(step.get("time", "")): float(item.get("x", ""))
        for step in ET.parse(log).getroot()  # noqa: S314 - our own file
        for item in step
        if item.get("id") == "b0"
    }
    placed = [row for row in states(trace, "b0") if row["x_m"] is not None]
    assert len(placed) > 290
    assert all(row["x_m"] == pytest.approx(bumpers[row["t_ns"] / 1e9] - 6.0, abs=1e-9) for row in placed)
