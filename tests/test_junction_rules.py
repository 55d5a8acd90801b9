"""What the rules on junctions say of whole scenes: where one violation is planted, exactly that rule fails."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

import numpy as np
import pyarrow as pa
import pytest

from tests.derive.junction_scenes import R, cross, signal, stop_line
from tests.scenes import Actor, drive, judged, moving, times

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from numpy.typing import ArrayLike, NDArray

    from drivelint.batch import Drive
    from tests.scenes import Road

    Floats = NDArray[np.float64]

T = times(30)
LINE = 183.0  # 2 m before the junction
RULES = tuple(
    f"ukhc.{name}"
    for name in (
        "h2.turn-pedestrian", "h3.no-cut-across", "r171.safe-gap", "r171.stop-sign", "r172.give-way", "r175.amber",
        "r175.red", "r180.corner-cut", "r180.right-turn-gap", "r182.no-pass-before-turn", "r183.keep-in",
    )
)  # fmt: skip


def going(way: Road, s: ArrayLike, name: str = "ego", *, d: Floats | float | None = None, **more: object) -> Actor:
    return moving(name, way, T, s, way.own if d is None else d, **more)


def steady(s0: float, v: float = 8.0) -> Floats:
    way: Floats = s0 + v * T
    return way


def halting(front_m: float) -> Floats:
    """Return the way of one that halts with its front there, two metres ahead of its centre and a bit, and goes on."""
    v = np.interp(T, (0, 6, 9.4, 12, 15), (8, 8, 0, 0, 6))
    s = np.concatenate([[0.0], np.cumsum((v[1:] + v[:-1]) / 2 * np.diff(T))])
    way: Floats = s - s[100] + front_m - 2.4
    return way


def swung(way: Road, s: Floats, over: float) -> Floats:
    """Return offsets from the own lane's centre to so far over the line about the end of the junction, and back."""
    to = over * way.over
    return np.interp(s, (185, 203, 212, 235), (way.own, to, to, way.own))


def lit(scene: Drive, *changes: tuple[float, str]) -> Drive:
    """Return the drive with the states of its light, recorded at every step."""
    begins = np.array([begin for begin, _ in changes])
    states = [changes[int(np.searchsorted(begins, t + 1e-6)) - 1][1] for t in T]
    log = scene.trace.drive_id
    rows = [
        {"drive_id": log, "signal_id": "sign", "t_ns": round(t * 1e9), "state": state}
        for t, state in zip(T, states, strict=True)
    ]
    tables = scene.trace.tables
    tables["signal_state"] = pa.Table.from_pylist(rows, schema=tables["signal_state"].schema)
    return scene


def walker(y: float, x0: float, v: float = 1.4) -> Actor:
    """Somebody who walks west at this y, at x0 when the drive is ten seconds old."""
    still = np.zeros(T.shape)
    return Actor("walker", T, x0 - v * (T - 10), y + still, np.pi + still, still - v, still, 0.5, 0.5, "pedestrian")


def ways(hand: str, code: str = "") -> dict[str, Road]:
    """Return the ways through a crossroads, named as where the left is driven on: elsewhere north and south change."""
    side = 1 if hand == "lht" else -1
    signs = (("1", signal("sign", LINE + 1, code, t=6 * side)), ("1", stop_line("line", LINE, 1.75 * side)))
    found = cross(hand, signals=signs if code else ())
    return {name.translate(str.maketrans("ns", "sn")) if side < 0 else name: way for name, way in found.items()}


def scenes(hand: str) -> dict[str, tuple[Callable[[str], Drive], tuple[str, ...]]]:
    """Return name -> (what makes the drive, the rules that it breaks); the ego comes from the west.

    Left and right are said as where the left is driven on; elsewhere all is mirrored.
    """
    free, stop, minor, light = ways(hand), ways(hand, "206"), ways(hand, "205"), ways(hand, "1000001")
    side = 1 if hand == "lht" else -1

    def scene(way: Road, *actors: Actor, lights: Iterable[tuple[float, str]] = ()) -> Callable[[str], Drive]:
        def make(name: str) -> Drive:
            made = drive(actors, way.environment, drive_id=name)
            return lit(made, *lights) if lights else made

        return make

    at = steady(120)
    straight, right, left = (going(free[way], at) for way in ("we", "ws", "wn"))
    cyclist = going(free["we"], steady(140, 5), "cyclist", d=3.0 * side, length=1.8, width=0.6, kind="bicycle")
    through = going(light["we"], at)
    return {
        "straight": (scene(free["we"], straight), ()),
        "right": (scene(free["ws"], right), ()),
        "left": (scene(free["wn"], left), ()),
        "right with time": (scene(free["ws"], right, going(free["ew"], steady(100), "other")), ()),
        "right before somebody": (
            scene(free["ws"], right, going(free["ew"], steady(112), "other")),
            ("r180.right-turn-gap",),
        ),
        "right behind somebody": (scene(free["ws"], right, going(free["ew"], steady(140), "other")), ()),
        "corner cut": (scene(free["ws"], going(free["ws"], at, d=swung(free["ws"], at, 1.5))), ("r180.corner-cut",)),
        "left and wide": (scene(free["wn"], going(free["wn"], at, d=swung(free["wn"], at, 1.0))), ("r183.keep-in",)),
        "left across a cyclist": (
            scene(free["wn"], left, cyclist),
            ("h3.no-cut-across", "r182.no-pass-before-turn"),
        ),
        "left before a walker": (scene(free["wn"], left, walker(side * (R + 4), 1.8)), ("h2.turn-pedestrian",)),
        "left behind a walker": (scene(free["wn"], left, walker(side * (R + 4), -6.0)), ()),
        "stop sign, rolls": (scene(stop["we"], going(stop["we"], steady(120, 4))), ("r171.stop-sign",)),
        "stop sign, halts": (scene(stop["we"], going(stop["we"], halting(LINE - 1))), ()),
        "stop sign, halts too early": (scene(stop["we"], going(stop["we"], halting(LINE - 5))), ("r171.stop-sign",)),
        "stop sign, halts too late": (scene(stop["we"], going(stop["we"], halting(LINE + 1))), ("r171.stop-sign",)),
        "give way, nobody": (scene(minor["we"], going(minor["we"], at)), ()),
        "give way, before somebody": (
            scene(minor["we"], going(minor["we"], at), going(minor["sn"], steady(112), "other")),
            ("r172.give-way",),
        ),
        "green": (scene(light["we"], through, lights=[(0, "green")]), ()),
        "red": (scene(light["we"], through, lights=[(0, "amber"), (2, "red")]), ("r175.red",)),
        "red after the line": (scene(light["we"], through, lights=[(0, "green"), (7, "amber"), (7.7, "red")]), ()),
        "red and amber": (
            scene(light["we"], through, lights=[(0, "red"), (7, "red_amber"), (8, "green")]),
            ("r175.red",),
        ),
        "amber, near": (scene(light["we"], through, lights=[(0, "green"), (7, "amber")]), ()),
        "amber, far": (scene(light["we"], through, lights=[(0, "green"), (4, "amber")]), ("r175.amber",)),
    }


@cache
def failed(hand: str) -> dict[str, set[str]]:
    """Return drive -> the rules that failed; all drives in one batch."""
    made = [make(name) for name, (make, _) in scenes(hand).items()]
    found: dict[str, set[str]] = {drive.trace.drive_id: set() for drive in made}
    for row in judged(made, rules=RULES):
        assert row["verdict"] != "error", row
        if row["verdict"] == "fail":
            found[row["drive_id"]].add(row["rule_id"].removeprefix("ukhc."))
    return found


@pytest.mark.parametrize("hand", ["lht", "rht"])
@pytest.mark.parametrize("name", list(scenes("lht")))
def test_what_is_planted_is_found_and_nothing_else(name: str, hand: str) -> None:
    assert failed(hand)[name] == set(scenes(hand)[name][1])
