"""The roads of this outsider: straight along x, with the lanes that go along it on the near side."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from tests.outsiders.twelfth.road import (
    Connection,
    End,
    Frame,
    Lane,
    Map,
    Road,
    Sec,
    crosswalk,
    frame,
    light,
    signal,
    stop_line,
)
from tests.outsiders.twelfth.ways import Path

FOOT: Lane = ("sidewalk", 2.0)
FAST: Lane = ("driving", 3.65)
SHOULDER: Lane = ("shoulder", 3.0)


def straight(lht: bool, fwd: Sequence[Lane], opp: Sequence[Lane], **more: Any) -> Map:
    """One straight road from the origin along x."""
    road = Road(
        "1",
        Path(0, 0, 0).fwd(more["length"]),
        [Sec(0.0, fwd, opp)],
        lht,
        more["typ"],
        more["limit"],
        more.get("unit", "mph"),
        more.get("mid", [(0.0, "broken")]),
        objects=list(more.get("objects", ())),
        signals=list(more.get("signals", ())),
    )
    return Map([road], frame=frame(more.get("tf", (0, 0, 0))))


def rural(**more: Any) -> Map:
    """Great Britain: one lane each way, 60 mph."""
    lane = [("driving", 3.5)]
    return straight(True, lane, lane, **{"length": 900.0, "typ": "rural", "limit": 60, **more})


def town(**more: Any) -> Map:
    """Great Britain: one lane each way and footways, 30 mph."""
    lanes = [("driving", 3.5), FOOT]
    return straight(True, lanes, lanes, **{"length": 600.0, "typ": "town", "limit": 30, **more})


def dual() -> Map:
    """Great Britain: a dual carriageway of two lanes each way."""
    lanes = [("median", 2.0), FAST, FAST]
    return straight(True, lanes, lanes, length=1200.0, typ="rural", limit=70, mid=[(0.0, "none")])


def mway(**more: Any) -> Map:
    """Great Britain: one carriageway of a motorway, three lanes and a hard shoulder."""
    lanes = [FAST] * 3 + [SHOULDER]
    wanted = {"length": 1500.0, "typ": "motorway", "limit": 70, "mid": [(0.0, "solid")], **more}
    return straight(True, lanes, [], **wanted)


def one_way_zebra() -> Map:
    """Great Britain: a street of two lanes one way with a zebra at 200 m."""
    lanes = [("driving", 3.5), ("driving", 3.5), FOOT]
    zebra = crosswalk("z", 200.0, 3.5, 1.6, 3.6)
    return straight(True, lanes, [FOOT], length=500.0, typ="town", limit=30, mid=[(0.0, "solid")], objects=[zebra])


def zebra_street(**more: Any) -> Map:
    """Great Britain: a street with a zebra at 200 m."""
    return town(objects=[crosswalk("z", 200.0, 0.0, 1.6, 3.6)], **more)


def pelican_street(**more: Any) -> Map:
    """Great Britain: a street with a signalled crossing at 200 m."""
    return town(
        objects=[
            crosswalk("z", 200.0, 0.0, 1.6, 3.6, "signal crossing", "signal"),
            stop_line("sl", 195.0, 1.75, 3.5),
            stop_line("sl2", 205.0, -1.75, 3.5),
        ],
        signals=[
            light("P1", 195.5, 4.0, "+", "traffic_light_p1", 1),
            light("P2", 204.5, -4.0, "-", "traffic_light_p2", -1),
        ],
        **more,
    )


def bab(**more: Any) -> Map:
    """Germany: one carriageway of an Autobahn, three lanes and a hard shoulder."""
    lanes = [FAST] * 3 + [SHOULDER]
    wanted = {"length": 1600.0, "typ": "motorway", "limit": None, "unit": "km/h", "mid": [(0.0, "solid")], **more}
    return straight(False, lanes, [], **wanted)


def stadt(limit: int | None = 50) -> Map:
    """Germany: a street."""
    lanes = [("driving", 3.5), FOOT]
    return straight(False, lanes, lanes, length=700.0, typ="town", limit=limit, unit="km/h")


def land(**more: Any) -> Map:
    """Germany: a road outside towns, 100 km/h."""
    lane = [("driving", 3.5)]
    return straight(False, lane, lane, **{"length": 900.0, "typ": "rural", "limit": 100, "unit": "km/h", **more})


def bab_under_bridge() -> Map:
    """An Autobahn with a road 7 m above it at 700 m."""
    drawn = bab(length=2400.0)
    over = Path(700, -60, 90).fwd(120)
    lane = [("driving", 3.5)]
    drawn.roads.append(Road("2", over, [Sec(0.0, lane, lane)], False, "rural", 100, "km/h", elev=7.0))
    return drawn


def exit_motorway(tf: Frame = (0.0, 0.0, 0.0)) -> Map:
    """Great Britain: a motorway with an exit lane from 400 m on, which parts at 660 m; signs at 250 m and 460 m."""
    main = [FAST] * 3 + [SHOULDER]
    wide = [FAST] * 3 + [("exit", 3.65), SHOULDER]
    sign = ("OpenDRIVE", "332", "exit")
    signs = [signal(f"X{i}", s, 3.65 * 4 + 4, "+", sign, lanes=[3]) for i, s in enumerate((400.0 - 150, 400.0 + 60))]
    way: dict[str, Any] = {"lht": True, "type": "motorway", "limit": 70}
    ids = [1, 2, 3]
    same = {i: i for i in ids}
    r1 = Road(
        "1",
        Path(0, 0, 0).fwd(660.0),
        [Sec(0.0, main, []), Sec(400.0, wide, [])],
        mid=[(0.0, "solid")],
        succ=End("junction", "100"),
        signals=signs,
        **way,
    )
    start, go, solid = End("road", "1", "end"), [(0.0, "none")], [(0.0, "solid")]
    c1 = Road(
        "10",
        Path(660.0, 0, 0).fwd(60),
        [Sec(0.0, [FAST] * 3, [])],
        mid=go,
        junction="100",
        pred=start,
        succ=End("road", "2", "start"),
        lane_pred=same,
        lane_succ=same,
        **way,
    )
    off = Path(660.0, 3.65 * 3.5, 0).arc(400, 8.0)
    c2 = Road(
        "11",
        off,
        [Sec(0.0, [("exit", 3.65)], [])],
        mid=go,
        junction="100",
        pred=start,
        succ=End("road", "3", "start"),
        lane_pred={1: 4},
        lane_succ={1: 1},
        offset=-3.65 / 2,
        **way,
    )
    behind = End("junction", "100")
    r2 = Road("2", Path(660.0 + 60, 0, 0).fwd(400.0), [Sec(0.0, main, [])], mid=solid, pred=behind, **way)
    x, y, h = off.end
    lanes = [("exit", 3.65), ("shoulder", 1.0)]
    slip = Path(x, y, math.degrees(h)).fwd(300)
    r3 = Road("3", slip, [Sec(0.0, lanes, [])], mid=solid, pred=behind, offset=-3.65 / 2, **way)
    links = [Connection("1", "10", [(i, i) for i in ids]), Connection("1", "11", [(4, 1)])]
    return Map([r1, r2, r3, c1, c2], [("100", links)], frame(tf))
