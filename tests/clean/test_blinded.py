"""What could not be seen must not pass: planted drives with things taken away around what was planted, and what is said of it."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING, Any

import pytest

from drivelint.engine.batch import Drive
from tests import blinding
from tests.blinding import EVER
from tests.clean.blinded import AFTER_S, BEFORE_S, STORIES, breach, on_the_road
from tests.clean.judging import stable
from tests.clean.planted import Planted
from tests.scenes import verdict_rows as judged_by

if TYPE_CHECKING:
    from collections.abc import Iterator

    from tests.blinding import Span
    from tests.scenes import Row

SIZE, SPEED = ("length_m", "width_m"), ("vx_mps", "vy_mps")
ABOUT_S = 10.0
"""Only what is said of this long before and after what was planted counts: somebody else is not known at other times."""
ANY_TIME = {
    "criticality.pet": "what is not known of an actor without a place stands at its first step",
    "ukhc.r168.drop-back": "one row stands for all the time in which it is not known who is ahead, from its first step",
    "alks-r157.cut-in-gap": "the same",
    "stvo.ri2": "one row stands for all the time in which the ego may pass somebody without a place, at its last step",
    "declared.r202.checks-before-reversing": "one row stands for all the time in which the ego's speed is not known, from its first step",
}
"""Rules whose unknown rows may begin earlier, and why."""
MAPS: dict[str, dict[str, Any]] = {
    "markings of the left": {"lane_boundary": blinding.of("side", "right")},
    "markings of the right": {"lane_boundary": blinding.of("side", "left")},
    "markings": {"lane_boundary": blinding.unsaid("marking")},
    "limits and types": {"speed_limit": blinding.empty, "lanelet": blinding.unsaid("road_type")},
    "handedness": {"environment": blinding.guessed},
    "links": {"lane_link": blinding.empty},
    "signals": {"traffic_signal": blinding.empty, "road_object": blinding.empty},
}
# (what is taken away, rule): why the rule need not be broken nor unknown any more
EVIDENCE = {
    ("conditions", "ukhc.r265.right-lane-ban"): "by its class the ego is a car",
    ("conditions", "stvo.s4-truck"): "by its class the ego is a car",
    (
        "end of the others",
        "ukhc.r128.back-before-solid",
    ): "170 m ahead and going the same way: who is lost there may have left the road",
    ("end of the others", "ukhc.r162.return-gap"): "the same",
    ("end of the others", "ukhc.r165.no-overtaking-sign"): "the same",
    (
        "end of the others",
        "declared.r162.go-before-overtaking",
    ): "last seen 157 m ahead, 0.4 s before the ego pulls out: not the one that it overtakes, who is within 100 m",
    ("end of the others", "declared.r166.confidence-at-commit"): "the same",
    (
        "others that jump for ever",
        "ukhc.r162.return-gap",
    ): "at its other place it is passed, and the next one is 165 m ahead of it",
    (
        "others that jump for ever",
        "ukhc.h3.no-cut-across",
    ): "on the road for 0.4 s before it jumps: it is at the other place for all the rest",
}


def blinded(drive: Drive, row: Row, span: Span) -> Iterator[tuple[str, Drive]]:
    """Return the drive with something taken away, in many ways; what, and from whom."""
    long = (span[0] - 2.5, span[1] + 2.5)
    everybody = drive.trace.tables["actor"]["actor_id"].to_pylist()
    others = [row["object_id"]] if row["object_id"] else [a for a in everybody if a != "ego"]

    def change_others(make: Any, *more: Any) -> Drive:
        less = drive
        for other in others:
            less = make(less, other, *more)
        return less

    def lacking(table: str, columns: tuple[str, ...], time: Span = EVER) -> Drive:
        less = drive
        for other in others:
            less = blinding.without(less, table, columns, other, time)
        return less

    yield "nothing", drive
    yield "ego's place", blinding.nulled(drive, "ego", long)
    yield "ego's heading", blinding.without(drive, "actor_state", ("yaw_rad",), "ego", long)
    yield "ego's speed", blinding.without(drive, "actor_state", SPEED, "ego")
    yield "ego's size", blinding.without(drive, "actor", SIZE, "ego")
    yield "ego's nose for a second", blinding.turned(drive, "ego", (span[0] - 0.5, span[0] + 0.5))
    yield "indicator", blinding.without(drive, "actor_state", ("indicator",), "ego", (span[0] - 7, span[1] + 7))
    if others:
        yield "place of the others", change_others(blinding.nulled, long)
        yield "place of the others for ever", change_others(blinding.nulled, EVER)
        yield "a second of the others", change_others(blinding.dropped, (span[0] - 0.5, span[0] + 0.5))
        yield "id of the others", change_others(blinding.renamed_actor, span[0] - 0.05)
        yield "heading of the others", lacking("actor_state", ("yaw_rad",))
        yield "speed of the others", lacking("actor_state", SPEED)
        yield "size of the others", lacking("actor", SIZE)
        yield "class of the others", lacking("actor", ("actor_class",))
        yield "nose of the others", change_others(blinding.turned, EVER)
        yield "nose of the others for a second", change_others(blinding.turned, (span[0] - 0.5, span[0] + 0.5))
        yield "others that freeze", change_others(blinding.frozen, long)
        yield "others that jump", change_others(blinding.jumped, long)
        yield "others that jump for ever", change_others(blinding.jumped, (span[0] - 0.35, 1e6))
        rest = change_others(blinding.dropped, (span[0] - 0.35, 1e6))
        if rest.trace.tables["actor"].num_rows == len(everybody):
            yield "end of the others", rest
    if drive.trace.tables["signal_state"].num_rows:
        yield "lights", blinding.without(drive, "signal_state", ("state",), None, long)
        yield "all lights", blinding.change_table(drive, "signal_state", blinding.empty)
    yield "events", blinding.change_table(drive, "declared_event", blinding.empty)
    yield "conditions", blinding.change_table(drive, "drive_condition", blinding.empty)
    yield "map", blinding.on(drive, None)
    road = drive.environment
    assert road is not None
    for what, changes in MAPS.items():
        yield what, blinding.on(drive, blinding.remade(road, f"{road.environment_id} {what}", **changes))


def is_about(row: Row, span: Span) -> bool:
    """Return whether a verdict is about the time of what was planted, or about all of the drive."""
    if row["rule_id"] in ANY_TIME or row["t_start_ns"] is None or row["t_end_ns"] is None:
        return True
    return bool(row["t_start_ns"] / 1e9 <= span[1] + ABOUT_S and row["t_end_ns"] / 1e9 >= span[0] - ABOUT_S)


@cache
def chapter_verdicts(pack: str, chapter: str) -> dict[str, set[str]]:
    """Return the verdicts on what is planted in a chapter by a pack's rules, by rule and what was taken away."""
    drives: list[Drive] = []
    spans: dict[str, Span] = {}
    mine = [p for p in STORIES if (p.pack, p.chapter) == (pack, chapter)]
    for planted in mine:
        row, span = breach(planted)
        spans[planted.rule] = span
        whole = on_the_road(planted.drives()[planted.rule]())
        part = blinding.cut(whole, (span[0] - BEFORE_S, span[1] + AFTER_S))
        drives += [blinding.renamed(one, f"{planted.rule}/{what}") for what, one in blinded(part, row, span)]
    verdicts: dict[str, set[str]] = {drive.trace.drive_id: set() for drive in drives}
    for row in judged_by(drives, rules=[p.rule for p in mine]):
        if row["drive_id"].startswith(f"{row['rule_id']}/") and is_about(row, spans[row["rule_id"]]):
            verdicts[row["drive_id"]].add(row["verdict"])
    return verdicts


@pytest.mark.slow
@pytest.mark.parametrize("planted", STORIES, ids=lambda p: p.rule)
def test_what_was_broken_is_broken_or_unknown(planted: Planted) -> None:
    every = chapter_verdicts(planted.pack, planted.chapter)
    mine = {name.partition("/")[2]: v for name, v in every.items() if name.startswith(f"{planted.rule}/")}
    assert "fail" in mine["nothing"]
    clear = {what for what, verdicts in mine.items() if not verdicts & {"fail", "unknown"}}
    assert clear == {what for what, rule in EVIDENCE if rule == planted.rule and what in mine}


@pytest.mark.slow
@pytest.mark.parametrize("rule", ["ukhc.overtake-zone", "ukhc.r180.right-turn-gap", "ukhc.r163.cyclist"])
def test_what_is_kept_is_never_broken_by_not_being_seen(rule: str) -> None:
    """The same drives without what was planted, by every stable rule of these packs."""
    planted = next(p for p in STORIES if p.rule == rule)
    row, span = breach(planted)
    whole = on_the_road(planted.drives()[planted.clean]())
    part = blinding.cut(whole, (span[0] - BEFORE_S, span[1] + AFTER_S))
    less = blinded(part, row | {"object_id": None}, span)
    # a track that goes on elsewhere is somebody there, and may well be in the ego's way
    drives = [blinding.renamed(one, what) for what, one in less if not what.startswith("others that jump")]
    rows = judged_by(drives, rules=stable(["ukhc", "rss", "criticality"]))
    broken = {(r["drive_id"], r["rule_id"], r["reason"]) for r in rows if r["verdict"] in {"fail", "error"}}
    assert not broken
