"""Faults of recorders, put into the scenes of `tests/scenes`: no verdict of a stable rule rests on what a check doubts.

A fault may make a verdict unknown. It never makes a fail of a drive that was sound, nor a pass, or a rule that does not apply, of a breach.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np
import pyarrow as pa
import pytest

from drivelint.scene import document
from drivelint.scene.judge import VerdictsOfScenes, judge_scenes
from drivelint.scene.scene import Scene, scenes_of
from tests.scene_drives import SCENES, TOPICS

if TYPE_CHECKING:
    from collections.abc import Callable

    Attack = Callable[[dict[str, Any], dict[str, Any]], None]

Columns = dict[str, Any]


def rows_of(states: Columns, name: str) -> Any:
    """Return the rows (n) of an actor, by time."""
    rows = np.flatnonzero(states["actor_id"] == name)
    return rows[np.argsort(states["t_ns"][rows])]


def nearest_other(states: Columns) -> str | None:
    """Return who comes nearest to the ego's middle, of those that are there half of the time."""
    ego = rows_of(states, "ego")
    at = {t: (x, y) for t, x, y in zip(states["t_ns"][ego], states["x_m"][ego], states["y_m"][ego], strict=True)}
    least = {}
    for name in sorted(set(states["actor_id"]) - {"ego"}):
        rows = rows_of(states, name)
        away = [
            np.hypot(states["x_m"][i] - at[t][0], states["y_m"][i] - at[t][1])
            for i in rows
            if (t := states["t_ns"][i]) in at
        ]
        if len(away) > len(ego) / 2:
            least[name] = min(away)
    return min(least, key=lambda name: least[name], default=None)


def shift(states: Columns, rows: Any, ahead_m: float, left_m: float) -> None:
    yaw = states["yaw_rad"][rows]
    states["x_m"][rows] += ahead_m * np.cos(yaw) - left_m * np.sin(yaw)
    states["y_m"][rows] += ahead_m * np.sin(yaw) + left_m * np.cos(yaw)


def swapped_sizes(actors: Columns, states: Columns) -> None:
    """Length and width of all vehicles are exchanged, as ScenarioNet does with the ego's of nuScenes."""
    long = actors["length_m"] > 1.3 * actors["width_m"]
    actors["length_m"][long], actors["width_m"][long] = actors["width_m"][long].copy(), actors["length_m"][long].copy()


def no_velocity_at_the_end(actors: Columns, states: Columns) -> None:
    """The last sample of each track has the velocity 0."""
    for name in set(states["actor_id"]):
        states["vx_mps"][rows_of(states, name)[-1]] = states["vy_mps"][rows_of(states, name)[-1]] = 0.0


def step_ahead(actors: Columns, states: Columns) -> None:
    """The ego is 1.5 m too far ahead in one sample."""
    rows = rows_of(states, "ego")
    shift(states, rows[len(rows) // 2 : len(rows) // 2 + 1], 1.5, 0.0)


def step_aside(actors: Columns, states: Columns) -> None:
    """The ego is 2 m too far to the left in one sample."""
    rows = rows_of(states, "ego")
    shift(states, rows[len(rows) // 2 : len(rows) // 2 + 1], 0.0, 2.0)


def slow_velocities(actors: Columns, states: Columns) -> None:
    """The ego's column of velocities is a fifth too small all the time."""
    for column in ("vx_mps", "vy_mps"):
        states[column][rows_of(states, "ego")] *= 0.8


def one_fast_sample(actors: Columns, states: Columns) -> None:
    """The ego's velocity is a fifth too high in one sample."""
    rows = rows_of(states, "ego")
    for column in ("vx_mps", "vy_mps"):
        states[column][rows[len(rows) // 3]] *= 1.2


def shifted_neighbour(actors: Columns, states: Columns) -> None:
    """Who comes nearest to the ego is displaced by 1 m for a second."""
    name = nearest_other(states)
    if name is not None:
        rows = rows_of(states, name)
        at = states["t_ns"][rows] - states["t_ns"][rows[len(rows) // 2]]
        shift(states, rows[(at >= 0) & (at < 1_000_000_000)], 0.0, 1.0)


def narrow_ego(actors: Columns, states: Columns) -> None:
    """The ego is 0.18 m wide."""
    actors["width_m"][actors["actor_id"] == "ego"] = 0.18


def spinning_cars(actors: Columns, states: Columns) -> None:
    """The headings of cars that stand turn by 25 degrees a second."""
    for name in set(states["actor_id"]) - {"ego"}:
        rows = rows_of(states, name)
        if np.nanmax(np.hypot(states["vx_mps"][rows], states["vy_mps"][rows])) < 0.1:
            states["yaw_rad"][rows] += np.radians(25) * (states["t_ns"][rows] - states["t_ns"][rows[0]]) / 1e9


def second_body(actors: Columns, states: Columns) -> None:
    """Who comes nearest to the ego is in the log twice, 0.3 m apart."""
    name = nearest_other(states)
    if name is not None:
        rows = rows_of(states, name)
        for columns, of in ((actors, np.flatnonzero(actors["actor_id"] == name)), (states, rows)):
            for column, values in columns.items():
                columns[column] = np.concatenate([values, values[of]])
        actors["actor_id"][-1] = "double"
        twice = np.arange(len(states["t_ns"]) - len(rows), len(states["t_ns"]))
        states["actor_id"][twice] = "double"
        shift(states, twice, 0.3, 0.1)


ATTACKS: Final = (
    swapped_sizes, no_velocity_at_the_end, step_ahead, step_aside, slow_velocities, one_fast_sample, shifted_neighbour, narrow_ego,
    spinning_cars, second_body,
)  # fmt: skip


@dataclass(frozen=True)
class Attacked(Scene):
    """A scene whose log has a fault."""

    attack: Any = None

    def tables(self) -> dict[str, pa.Table]:
        """Return the tables of its log."""
        tables = super().tables()
        actors, states = (columns_of(tables[name]) for name in ("actor", "actor_state"))
        self.attack(actors, states)
        for name, columns in (("actor", actors), ("actor_state", states)):
            schema = tables[name].schema
            tables[name] = pa.table(
                {field.name: pa.array(columns[field.name].tolist(), field.type, from_pandas=True) for field in schema}
            )
        return tables


def columns_of(table: pa.Table) -> Columns:
    """Return the columns; numbers that are not there are NaN."""
    columns = {}
    for name, column in zip(table.column_names, table.columns, strict=True):
        kind = object if not pa.types.is_floating(column.type) else float
        columns[name] = np.array(column.to_pylist(), kind)
    columns |= {"t_ns": columns["t_ns"].astype(np.int64)} if "t_ns" in columns else {}
    return columns


@cache
def scenes(topic: str, max_scenes: int | None) -> tuple[Scene, ...]:
    file = document.read(SCENES / f"{topic}.yml")
    return tuple(scenes_of(file.scenes[:max_scenes], file.roads))


def worse(clean: VerdictsOfScenes, attacked: VerdictsOfScenes) -> list[str]:
    """Return the verdicts that rest on the fault."""
    wrong = []
    for key in sorted(clean.rows.keys() | attacked.rows.keys()):
        before, after = clean.verdict(key), attacked.verdict(key)
        if after == "fail" != before or (before == "fail" and after in {"pass", "not_applicable"}):
            wrong.append(f"{key}: {before} -> {after}: {attacked.reasons_text(key)}")
    return wrong


@pytest.fixture(scope="module")
def clean(
    tmp_path_factory: pytest.TempPathFactory,
) -> Callable[[tuple[str, ...], int], tuple[list[Scene], VerdictsOfScenes]]:
    """Return what judges the first scenes of topics, as they are."""

    @cache
    def judge(topics: tuple[str, ...], max_scenes: int) -> tuple[list[Scene], VerdictsOfScenes]:
        chosen = [scene for topic in topics for scene in scenes(topic, max_scenes)]
        return chosen, judge_scenes(chosen, ["status:stable"], tmp_path_factory.mktemp("clean") / "scenes")

    return judge


@pytest.mark.parametrize(
    ("topics", "max_scenes"),
    [
        pytest.param(("following", "speeds"), 2, marks=pytest.mark.ci),
        pytest.param(tuple(TOPICS), 4, marks=pytest.mark.slow),
    ],
)
@pytest.mark.parametrize(
    "attack",
    [pytest.param(attack, marks=[] if attack is one_fast_sample else pytest.mark.slow) for attack in ATTACKS],
    ids=lambda attack: attack.__name__,
)
def test_no_verdict_rests_on_a_fault_of_the_recorder(
    attack: Attack, topics: tuple[str, ...], max_scenes: int, clean: Any, tmp_path: Path
) -> None:
    chosen, before = clean(topics, max_scenes)
    faulty = [Attacked(scene.text, scene.layout, scene.left, scene.name, attack) for scene in chosen]
    after = judge_scenes(faulty, ["status:stable"], tmp_path / "scenes")
    decided = [key for key in after.rows if after.verdict(key) in {"pass", "fail"}]
    assert len(decided) > len(chosen), "a log that is refused shows nothing"
    assert not worse(before, after)
