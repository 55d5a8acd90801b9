"""Looks at the newest frames for contacts, held against shapely; and what becomes of an alarm that they say."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from threading import Event
from typing import TYPE_CHECKING, Any

import numpy as np
import pyarrow as pa
import pytest
from shapely import affinity
from shapely.geometry import box

from drivelint import catalogue
from drivelint.engine.interruption import Interruption
from drivelint.sql import store
from drivelint.watch.alarms import AlarmLog
from drivelint.watch.contact import JOLT_RULE, OVERLAP_RULE, ContactFinder
from drivelint.watch.judge import JudgedWindow, WindowJudge
from drivelint.watch.options import WatchOptions
from drivelint.watch.run import Watch
from drivelint.watch.source import Frame
from drivelint.watch.sources.replay import Replay
from drivelint.watch.window import NS_PER_S
from tests.scenes import Actor, drive, moving, road, standing, times

if TYPE_CHECKING:
    from collections.abc import Iterator

    import duckdb

    from drivelint.drive.trace import IngestOptions, Trace

CATALOGUE = catalogue.load_rules(())
WAY = road()
T = times(10.0)
SCENES = Path(__file__).parents[2] / "fixtures" / "scenes"


@pytest.fixture(scope="module")
def con() -> Iterator[duckdb.DuckDBPyConnection]:
    with store.temporary_database(None) as con:
        yield con


@pytest.fixture
def look(con: duckdb.DuckDBPyConnection) -> ContactFinder:
    return ContactFinder(con, CATALOGUE)


def ego(lateral: float = 0.0) -> Actor:
    return moving("ego", WAY, T, 50 + 10 * T, WAY.ego_d + lateral)


def trace(*actors: Actor) -> Trace:
    return drive(actors, None).trace


def with_column(log: Trace, table: str, column: str, values: list[Any]) -> Trace:
    rows = log.tables[table]
    made = rows.set_column(rows.column_names.index(column), column, pa.array(values, rows.schema.field(column).type))
    return replace(log, tables={**log.tables, table: made})


def overlaps(a: Actor, b: Actor) -> set[int]:
    """The steps at which two boxes overlap, by shapely."""

    def outline(actor: Actor, k: int) -> Any:
        assert actor.length
        assert actor.width
        lying = box(-actor.length / 2, -actor.width / 2, actor.length / 2, actor.width / 2)
        return affinity.translate(
            affinity.rotate(lying, actor.yaw[k], (0, 0), use_radians=True), actor.x[k], actor.y[k]
        )

    return {round(a.t_s[k] * NS_PER_S) for k in range(len(a.t_s)) if outline(a, k).intersects(outline(b, k))}


@pytest.mark.parametrize("turned", [0.0, 0.6, 2.2])
@pytest.mark.parametrize("beside", [0.0, 1.7, 2.9])
def test_contacts_are_where_the_boxes_overlap(look: ContactFinder, turned: float, beside: float) -> None:
    car = standing("car", WAY, T, 110.0, WAY.ego_d + beside, turned=turned)
    found = look.new_contacts(trace(ego(), car), None)
    assert {row["t_start_ns"] for row in found} == overlaps(ego(), car)
    assert {(row["ego_id"], row["object_id"], row["severity"]) for row in found} <= {("ego", "car", "critical")}
    assert bool(found) == (beside < 2.9 or turned > 0)


def ends_at(gap_m: float, *, loss_mps: float = 10.0, name: str = "ego") -> Actor:
    """Return an ego that drives on until it is `gap_m` behind the car at 110 m and loses so much speed from one step to the next."""
    stop = 110.0 - 4.8 - gap_m
    speed = np.where(T < 5.0, 10.0, 10.0 - loss_mps)
    return replace(moving(name, WAY, T, np.minimum(stop - 50 + 10 * T, stop), WAY.ego_d), vx=speed, vy=0 * T)


STRUCK = standing("car", WAY, T, 110.0, WAY.ego_d)


def jolts(look: ContactFinder, log: Trace) -> list[tuple[float, float]]:
    return [
        (row["t_start_ns"] / NS_PER_S, round(row["observed"], 6))
        for row in look.new_contacts(log, None)
        if row["rule_id"] == JOLT_RULE
    ]


@pytest.mark.sample(1, ci=99)
@pytest.mark.parametrize(
    ("gap_m", "loss_mps", "expected"),
    [
        (0.3, 10.0, [(5.0, 100.0)]),
        (0.3, 1.25, [(5.0, 12.5)]),
        (0.3, 1.125, []),
        (0.45, 3.0, [(5.0, 30.0)]),
        (0.55, 10.0, []),
    ],
)
def test_a_jolt_is_told_where_the_boxes_are_near(
    look: ContactFinder, gap_m: float, loss_mps: float, expected: list[tuple[float, float]]
) -> None:
    log = trace(ends_at(gap_m, loss_mps=loss_mps), STRUCK)
    assert jolts(look, log) == expected
    with WindowJudge(WatchOptions(source="", rules=(JOLT_RULE,))) as judge:
        (window,) = judge.judge([log])
    assert isinstance(window, JudgedWindow)
    same = [(row["t_start_ns"] / NS_PER_S, round(row["observed"], 6)) for row in window.findings.to_pylist()]
    assert same == expected


@pytest.mark.parametrize(
    ("speed_mps", "kind", "is_jolt"), [(8.0, "car", True), (2.9, "pedestrian", False), (3.1, "pedestrian", True)]
)
def test_who_is_struck_gains_speed(look: ContactFinder, speed_mps: float, kind: str, *, is_jolt: bool) -> None:
    gains = replace(STRUCK, vx=np.where(T < 5.0, 0.0, speed_mps), kind=kind)
    assert jolts(look, trace(ends_at(0.3, loss_mps=0.5), gains)) == (
        [(5.0, round(10 * speed_mps, 6))] if is_jolt else []
    )


def test_a_jolt_waits_for_the_window_if_the_velocity_is_derived(look: ContactFinder) -> None:
    log = trace(ends_at(0.3), STRUCK)
    schema = log.tables["quality"].schema
    for names, expected in (("velocity_derived", []), ("velocity_filtered", []), ("other", [(5.0, 100.0)])):
        row = {"drive_id": "d", "check_id": names, "severity": "warning", "actor_id": None, "n": 2, "message": ""}
        told = replace(log, tables={**log.tables, "quality": pa.Table.from_pylist([row], schema=schema)})
        assert jolts(look, told) == expected


def test_a_jolt_waits_for_the_window_if_the_step_is_long(look: ContactFinder) -> None:
    missed = (T > 4.85) & (T < 4.95)
    log = trace(ends_at(0.3).keep(~missed), STRUCK)
    assert jolts(look, log) == []


def test_an_actor_that_was_always_near_may_be_towed(look: ContactFinder) -> None:
    jolted = np.where(T < 5.0, 10.0, 0.0)
    towed = replace(moving("trailer", WAY, T, 50 + 10 * T - 5.1, WAY.ego_d), vx=jolted)
    assert jolts(look, trace(replace(ego(), vx=jolted), towed)) == []


def test_only_rules_that_are_asked_for_are_told(con: duckdb.DuckDBPyConnection) -> None:
    log = trace(ends_at(-0.2), STRUCK)
    assert {row["rule_id"] for row in ContactFinder(con, CATALOGUE).new_contacts(log, None)} == {
        OVERLAP_RULE,
        JOLT_RULE,
    }
    assert {row["rule_id"] for row in ContactFinder(con, CATALOGUE, (JOLT_RULE,)).new_contacts(log, None)} == {
        JOLT_RULE
    }
    assert ContactFinder(con, CATALOGUE, (JOLT_RULE,), {JOLT_RULE: {"tyre_mps2": 101.0}}).new_contacts(log, None) == []


def test_steps_that_were_looked_at_are_not_told_again(look: ContactFinder) -> None:
    log = trace(ego(), standing("car", WAY, T, 110.0, WAY.ego_d))
    steps = [row["t_start_ns"] for row in look.new_contacts(log, None)]
    assert [row["t_start_ns"] for row in look.new_contacts(log, steps[1])] == steps[2:]


def test_an_actor_that_was_never_seen_apart_may_be_the_trailer(look: ContactFinder) -> None:
    trailer = moving("trailer", WAY, T, 50 + 10 * T - 4.5, WAY.ego_d)
    assert overlaps(ego(), trailer) == {round(t * NS_PER_S) for t in T}
    assert look.new_contacts(trace(ego(), trailer), None) == []


def test_a_contact_that_lasts_is_told_by_the_looks_after_it(
    con: duckdb.DuckDBPyConnection, look: ContactFinder
) -> None:
    pushed = moving("car", WAY, T, np.maximum(90.0, 50 + 10 * T + 4.0), WAY.ego_d)
    log = trace(ego(), pushed)
    assert look.new_contacts(part_of(log, 0.0, 3.0), None) == []
    late = part_of(log, 8.0, 9.0)
    assert [row["t_start_ns"] for row in look.new_contacts(late, round(8.9 * NS_PER_S))] == [9 * NS_PER_S]
    assert ContactFinder(con, CATALOGUE).new_contacts(late, None) == []  # it has not seen the two apart


def part_of(log: Trace, from_s: float, to_s: float) -> Trace:
    rows = log.tables["actor_state"]
    t_ns = rows["t_ns"].to_numpy()
    kept = rows.filter((t_ns >= round(from_s * NS_PER_S)) & (t_ns <= round(to_s * NS_PER_S)))
    return replace(log, tables={**log.tables, "actor_state": kept})


def test_on_another_level_there_is_no_contact(look: ContactFinder) -> None:
    log = trace(ego(), standing("car", WAY, T, 110.0, WAY.ego_d))
    ids = log.tables["actor_state"]["actor_id"].to_pylist()
    for height, touches in ((6.0, False), (0.5, True)):
        there = with_column(log, "actor_state", "z_m", [height if each == "car" else 0.0 for each in ids])
        assert bool(look.new_contacts(there, None)) == touches


@pytest.mark.parametrize(("table", "column"), [("actor_state", "yaw_rad"), ("actor", "width_m")])
def test_without_a_box_there_is_no_contact(look: ContactFinder, table: str, column: str) -> None:
    log = trace(ego(), standing("car", WAY, T, 110.0, WAY.ego_d))
    rows = log.tables[table].to_pylist()
    unknown = with_column(log, table, column, [None if row["actor_id"] == "car" else row[column] for row in rows])
    assert look.new_contacts(unknown, None) == []


def window(t_end_s: float, findings: list[dict[str, Any]]) -> JudgedWindow:
    kinds = store.arrow_schemas()
    rows = pa.Table.from_pylist(findings, schema=kinds["finding"])
    return JudgedWindow(0, round(t_end_s * NS_PER_S), rows, kinds["verdict"].empty_table(), pa.table({}))


def test_only_a_window_with_the_step_withdraws_an_early_alarm(look: ContactFinder) -> None:
    rows = look.new_contacts(trace(ego(), standing("car", WAY, T, 110.0, WAY.ego_d)), None)
    log = AlarmLog({OVERLAP_RULE: 2 * NS_PER_S}, ())
    (alarm,) = log.add_contacts_and_return_new_alarms(rows, 10 * NS_PER_S)
    assert (alarm.is_early, alarm.row["t_start_ns"], alarm.t_end_ns) == (
        True,
        rows[0]["t_start_ns"],
        rows[-1]["t_end_ns"],
    )
    assert log.add_contacts_and_return_new_alarms(rows, 10 * NS_PER_S) == []
    before = log.add_window(window(rows[0]["t_start_ns"] / NS_PER_S - 0.1, []), None, None)
    assert (before.new, before.withdrawn) == ([], [])
    seen = log.add_window(window(10.0, [{"rule_id": OVERLAP_RULE, **rows[0]}]), None, None)
    assert (seen.new, seen.withdrawn, len(log.alarms)) == ([], [], 1)
    assert log.add_window(window(10.1, []), None, None).withdrawn == [alarm]


@pytest.mark.ci
def test_a_contact_is_said_before_its_window_is_judged() -> None:
    """A log of 11.6 s, judged every 9 s and at its end: the contact at 9.7 s is in the second window."""
    asked = WatchOptions(
        source=str(SCENES / "collision-25mph.mcap"),
        map=SCENES / "overtake-road.xodr",
        rules=(OVERLAP_RULE,),
        every_s=9.0,
    )
    said: list[dict[str, Any]] = []
    source = Replay(Path(asked.source), asked.ingest_options(), speed=0, every_ns=9 * NS_PER_S)
    with Watch(asked, source, said.append, Interruption()) as watch:
        watch.watch()
    (alarm,) = (each for each in said if each["type"] == "alarm")
    assert (alarm["is_early"], alarm["t_s"]) == (True, 9.7)
    assert [each for each in said if each["type"] == "withdrawn"] == []


class Going(Replay):
    """A source that goes on by itself: its frames until 9.9 s, and the others while the window with those is judged."""

    def __init__(self, path: Path, options: IngestOptions) -> None:
        super().__init__(path, options, speed=0, every_ns=NS_PER_S)
        self.is_advanced_by_reads = self.is_window_due = False
        self.rest_came = Event()
        self._parts = [
            self._times[self._times <= 9.9 * NS_PER_S],
            self._times[self._times > 9.9 * NS_PER_S],
            self._times[:0],
        ]

    def read(self, timeout_s: float) -> list[Frame] | None:  # noqa: ARG002 - of all sources
        if not self._parts:
            return None
        part = self._parts.pop(0)
        if not len(part):
            self.rest_came.set()
        return [Frame(int(t_ns), None, 0) for t_ns in part]


@pytest.mark.slow
def test_the_latency_of_an_alarm_counts_what_came_while_its_window_was_judged(monkeypatch: pytest.MonkeyPatch) -> None:
    asked = WatchOptions(
        source=str(SCENES / "collision-25mph.mcap"), map=SCENES / "overtake-road.xodr", rules=(OVERLAP_RULE,)
    )
    source = Going(Path(asked.source), asked.ingest_options())
    plain = WindowJudge.judge

    def late(*words: Any) -> Any:
        assert source.rest_came.wait(60)
        return plain(*words)

    monkeypatch.setattr(WindowJudge, "judge", late)
    with Watch(asked, source, lambda _message: None, Interruption()) as watch:
        watch.watch()
    (alarm,) = watch.alarms.alarms
    assert alarm.row["t_end_ns"] <= 9.9 * NS_PER_S
    assert alarm.said_ns == 15 * NS_PER_S  # the log's end
