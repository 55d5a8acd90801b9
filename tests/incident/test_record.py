"""Elements of what a vehicle should record: each is found where it is, and named where it is absent."""

from __future__ import annotations

from typing import Any

import pyarrow as pa

from drivelint.drive import declared_events
from drivelint.drive.conditions import DRIVE_CONDITION_VALUES
from drivelint.facts import toml_beside
from drivelint.incident import record
from drivelint.incident.record import data_elements_by_presence
from drivelint.sql.store import arrow_schemas

ELEMENTS = toml_beside(record.__file__, "elements.toml")
EVENTS = toml_beside(declared_events.__file__, "declared_events.toml")


def tables(**rows: list[dict[str, Any]]) -> dict[str, pa.Table]:
    """Return tables of a trace with these rows; what they do not say is NULL, or of the ego."""
    names = ("actor", "actor_state", "declared_event", "drive_condition", "quality")
    schemas = {name: pa.schema([field.with_nullable(True) for field in arrow_schemas()[name]]) for name in names}
    return {
        name: pa.Table.from_pylist(
            [dict.fromkeys(schema.names) | {"actor_id": "ego"} | row for row in rows.get(name, [])]
            if "actor_id" in schema.names
            else [dict.fromkeys(schema.names) | row for row in rows.get(name, [])],
            schema=schema,
        )
        for name, schema in schemas.items()
    }


def absent(log_tables: dict[str, pa.Table], log: dict[str, Any]) -> set[str]:
    return {name for source in data_elements_by_presence(log_tables, log, "ego") for name in source.absent}


def test_every_place_exists() -> None:
    for element in ELEMENTS["element"]:
        assert element["source"] in ELEMENTS["source"]
        for place in element["held_by"]:
            kind, _, name = place.partition(":")
            table, _, column = place.partition(".")
            if kind == "event":
                assert name in EVENTS["on_off"] | EVENTS["other"]
            elif kind == "condition":
                assert name in DRIVE_CONDITION_VALUES
            elif place != "others":
                assert column in arrow_schemas()[table].names


def test_an_empty_log_holds_nothing() -> None:
    names = {element["name"] for element in ELEMENTS["element"]}
    assert absent(tables(), {}) == names


def test_what_is_held_is_not_absent() -> None:
    given = tables(
        actor=[{}, {"actor_id": "2"}],
        actor_state=[{"vx_mps": 1.0, "brake_light": "off"}, {"actor_id": "2", "ax_mps2": 1.0, "indicator": "left"}],
        declared_event=[{"event": "engaged", "value": "on"}],
    )
    gone = absent(given, {"utc_start_ns": 1})
    assert not gone & {"vehicle speed", "brake lights", "automated or manual mode", "system switched on"}
    assert "date and time of day with time zone" not in gone
    assert gone >= {"indicators", "acceleration", "horn"}  # the other's, and none


def test_speed_that_was_computed_is_no_record() -> None:
    given = tables(actor_state=[{"vx_mps": 1.0}], quality=[{"check_id": "velocity_derived"}])
    derived = {name for source in data_elements_by_presence(given, {}, "ego") for name in source.derived}
    assert derived == {"vehicle speed"}
