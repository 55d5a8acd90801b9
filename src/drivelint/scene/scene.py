"""A scene: its roads, its actors, and the map and the log that are made from them."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, Final

import numpy as np
import pyarrow as pa

from drivelint.drive.conditions import condition_problem, value_problem
from drivelint.errors import UsageError
from drivelint.phrases import hint
from drivelint.result.files import parquet_bytes_with_metadata
from drivelint.scene import recorder
from drivelint.scene.actor import Actor
from drivelint.scene.layout import roads_of
from drivelint.scene.opendrive import opendrive_text
from drivelint.sql.store import arrow_schemas

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from drivelint.scene.document import RoadLayout, SceneEntry
    from drivelint.scene.road import Road

DEFAULT_CONDITIONS: Final = {"weather": "dry", "light": "day"}
"""The default conditions of a scene."""
NOT_IN_LOG: Final = "unknown"
"""The value of a condition that the log shall not have."""
MAP_FILE: Final = "map.xodr"


@dataclass(frozen=True)
class Scene:
    """A scene for right-hand or left-hand traffic."""

    text: SceneEntry
    layout: RoadLayout
    left: bool
    """Whether the traffic is left-hand."""
    name: str

    @cached_property
    def roads(self) -> dict[str, Road]:
        """Name -> road of the scene, including the roads through junctions. Errors: `UsageError`."""
        return roads_of(self.layout)

    @property
    def map_text(self) -> str:
        """The map of the scene as OpenDRIVE."""
        return opendrive_text(self.roads, left=self.left)

    def tables(self) -> dict[str, pa.Table]:
        """Return the tables of the scene's log, named and typed as in `schemas/model.sql`. Errors: `UsageError`."""
        text = self.text
        if "ego" not in text.actors:
            raise UsageError(f"no actor is called ego: {hint('ego', text.actors)}")
        actors = [Actor(name, actor, self.roads) for name, actor in text.actors.items()]
        with_height = any(z for road in self.roads.values() for _, z in road.heights)
        parts = [
            recorder.state_columns(actor, text.seconds, text.rate, left=self.left, with_height=with_height, seed=n)
            for n, actor in enumerate(actors)
        ]
        columns = {
            name: np.concatenate([np.asarray(part[name], object) for part in parts]).tolist() for name in parts[0]
        }
        for name, lights in text.lights.items():
            if all(thing.kind != f"light {name}" for road in self.roads.values() for thing in road.things) and lights:
                raise UsageError(f"light {name}: no road has a thing of this name")
        return {
            "actor": _typed_table_of_rows("actor", [recorder.actor_row(actor) for actor in actors]),
            "actor_state": _typed_table("actor_state", columns),
            "drive_condition": _typed_table_of_rows("drive_condition", self._condition_rows()),
            "signal_state": _typed_table_of_rows("signal_state", list(recorder.light_rows(text.lights, text.seconds))),
            "declared_event": _typed_table_of_rows("declared_event", self._event_rows()),
        }

    def files(self) -> dict[str, bytes]:
        """Return the log as Parquet tables, and its map, name -> content. Errors: `UsageError`."""
        tables = {name: table for name, table in self.tables().items() if table.num_rows}
        log = {f"{name}.parquet": parquet_bytes_with_metadata(table, name, {}) for name, table in tables.items()}
        return {**log, MAP_FILE: self.map_text.encode()}

    def _condition_rows(self) -> list[dict[str, Any]]:
        conditions = {
            name: value for name, value in (DEFAULT_CONDITIONS | self.text.conditions).items() if value != NOT_IN_LOG
        }
        for condition, value in conditions.items():
            if problem := condition_problem(condition) or value_problem(condition, value):
                raise UsageError(f"given: {problem}")
        return [{"condition": name, "value": value} for name, value in conditions.items()]

    def _event_rows(self) -> list[dict[str, Any]]:
        events = []
        for declaration in self.text.says:
            if len(declaration) not in {2, 3} or not isinstance(declaration[0], int | float):
                raise UsageError(f"says {declaration}: write [second, event] or [second, event, value]")
            value = declaration[2] if len(declaration) == 3 else None
            if self.left and declaration[1] == "blind_spot_check":
                value = {"left": "right", "right": "left"}.get(str(value), value)
            row = {"actor_id": "ego", "t_ns": round(float(declaration[0]) * 1e9), "event": str(declaration[1])}
            events.append(row | {"value": None if value is None else str(value)})
        return events


def scenes_of(texts: Sequence[SceneEntry], layouts: Mapping[str, RoadLayout]) -> list[Scene]:
    """Return the scenes; a scene for both right-hand and left-hand traffic is returned twice, once for each."""
    scenes = []
    for text in texts:
        layout = layouts[text.roads]
        side = text.traffic or layout.traffic
        for hand in ("right", "left") if side == "both" else (side,):
            name = f"{text.name}-{hand}" if side == "both" else text.name
            scenes.append(Scene(text, layout, hand == "left", name))
    return scenes


def _typed_table(name: str, columns: Mapping[str, Sequence[Any]]) -> pa.Table:
    schema = arrow_schemas()[name]
    return pa.table({column: pa.array(values, schema.field(column).type) for column, values in columns.items()})


def _typed_table_of_rows(name: str, rows: Sequence[Mapping[str, Any]]) -> pa.Table:
    columns = list(rows[0]) if rows else ["actor_id"] if name == "actor" else []
    return _typed_table(name, {column: [row[column] for row in rows] for column in columns})
