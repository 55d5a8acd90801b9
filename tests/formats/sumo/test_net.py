"""SUMO networks: lanes beside each other and in junctions, limits, who may drive there, lights, stop and give-way signs."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest

from drivelint.errors import MapError
from drivelint.formats import load_map
from drivelint.inspect import InspectRequest, inspect
from drivelint.road.map_reader import MapSource, MapTables
from tests.formats.maps import checks, hand, lanelet, lanelets, links, messages, points, rows, values
from tests.formats.sumo.fcd_text import xml

if TYPE_CHECKING:
    from pathlib import Path

WIDTH = 3.2
INNER = ' fromLane="1" toLane="1"'


def lane(name: str, index: int, shape: str, more: str = "", inside: str = "") -> str:
    return f'<lane id="{name}_{index}" index="{index}" speed="13.89" length="50" shape="{shape}" {more}>{inside}</lane>'


def edge(name: str, *lanes: str, ends: tuple[str, str] | None = None, more: str = "") -> str:
    way = f'from="{ends[0]}" to="{ends[1]}"' if ends else 'function="internal"'
    return f'<edge id="{name}" {way} {more}>{"".join(lanes)}</edge>'


def link(start: str, end: str, state: str, way: str = "s", more: str = "") -> str:
    if "fromLane" not in more:
        more += ' fromLane="0" toLane="0"'
    return f'<connection from="{start}" to="{end}" dir="{way}" state="{state}" {more}/>'


def net(*parts: str, more: str = "", **options: object) -> MapTables:
    text = f'<?xml version="1.0"?>\n<!-- made by hand -->\n<net version="1.20" {more}>{"".join(parts)}</net>'
    return load_map(MapSource("small.net.xml", text.encode()), **options)  # type: ignore[arg-type]


def tee(kind: str, stem: tuple[str, str], light: str = "", major: str = "M") -> MapTables:
    """Return a main road along x, its eastbound direction of two lanes, on which a side road from the south ends."""
    tl = f'tl="{light}" linkIndex="%d"' if light else "%s"

    def way(name: str, n: int) -> str:
        return f'via="{name}" ' + (tl % n if light else "")

    return net(
        edge("we", lane("we", 0, "0,-4.8 50,-4.8"), lane("we", 1, "0,-1.6 50,-1.6"), ends=("w", "c")),
        edge("ea", lane("ea", 0, "60,-4.8 110,-4.8"), lane("ea", 1, "60,-1.6 110,-1.6"), ends=("c", "e")),
        edge("ew", lane("ew", 0, "110,1.6 60,1.6", inside='<neigh lane="ea_1"/>'), ends=("e", "c")),
        edge("wa", lane("wa", 0, "50,1.6 0,1.6"), ends=("c", "w")),
        edge("st", lane("st", 0, "56.6,-60 56.6,-10", 'width="3"'), ends=("s", "c")),
        edge(":c_0", lane(":c_0", 0, "50,-4.8 60,-4.8"), lane(":c_0", 1, "50,-1.6 60,-1.6")),
        edge(":c_2", lane(":c_2", 0, "60,1.6 50,1.6")),
        edge(":c_3", lane(":c_3", 0, "56.6,-10 57,-7.5 58.4,-5.3 60,-4.8")),
        edge(":c_4", lane(":c_4", 0, "56.6,-10 56,-3")),
        edge(":c_5", lane(":c_5", 0, "56,-3 54,1 50,1.6")),
        f'<junction id="c" type="{kind}" x="55" y="0"/><junction id="e" type="dead_end" x="110" y="0"/>',
        link("we", "ea", major, more=way(":c_0_0", 0)),
        link("we", "ea", major, more=way(":c_0_1", 1) + INNER),
        link("ew", "wa", major, more=way(":c_2_0", 2)),
        link("st", "ea", stem[0], "r", way(":c_3_0", 3)),
        link("st", "wa", stem[1], "l", way(":c_4_0", 4)),
        link(":c_0", "ea", "M"), link(":c_0", "ea", "M", more=INNER), link(":c_2", "wa", "M"),
        link(":c_3", "ea", "M", "r"), link(":c_4", "wa", "m", "l", 'via=":c_5_0"'), link(":c_5", "wa", "M", "l"),
    )  # fmt: skip


def test_lanes_and_their_ways_on() -> None:
    found = tee("priority", ("m", "m"))
    assert hand(found) == ("rht", "attribute")
    assert lanelet(found, "we_0", "left_id left_against right_id") == ("we_1", False, None)
    assert lanelet(found, "we_1", "right_id right_against left_id") == ("we_0", False, None)
    assert lanelet(found, "ew_0", "left_id left_against") == ("ea_1", True)
    inside = values(found, "lanelet", "lanelet_id", junction_id="c")
    assert set(inside) == {name for name in lanelets(found) if name[0] == ":"}
    assert set(links(found)) >= {
        ("we_0", ":c_0_0"), (":c_0_0", "ea_0"), ("st_0", ":c_4_0"), (":c_4_0", ":c_5_0"), (":c_5_0", "wa_0"),
    }  # fmt: skip
    assert (*lanelet(found, "we_0", "width_m"), *lanelet(found, "st_0", "width_m")) == pytest.approx((WIDTH, 3.0))
    first = values(found, "lane_point", "left_x_m left_y_m right_y_m", lanelet_id="we_0", k=0)
    assert first == [(0.0, -3.2, -6.4)]
    assert not checks(found)
    assert set(values(found, "lane_boundary", "marking")) == {None}


def test_the_limit_holds_through_a_junction() -> None:
    limits = dict(values(tee("priority", ("m", "m")), "speed_limit", "lanelet_id limit_mps"))
    assert set(limits.values()) == {13.89}
    assert {":c_4_0", ":c_5_0"} <= limits.keys()
    ways = (
        edge("a", lane("a", 0, "0,0 50,0"), ends=("a", "b")),
        edge(":b_0", lane(":b_0", 0, "50,0 60,0").replace("13.89", "4")),
    )
    alone = values(net(*ways), "speed_limit", "lanelet_id limit_mps")
    assert alone == [("a_0", 13.89)]  # what bends allow is no limit


def test_where_the_ways_meet_there_is_no_wedge() -> None:
    """A way through begins and ends in the direction of the lanes that it joins, as its chords do not."""
    found = points(tee("priority", ("m", "m")))
    for before, after in (("st_0", ":c_3_0"), (":c_3_0", "ea_0"), ("st_0", ":c_4_0"), (":c_5_0", "wa_0")):
        a, b = found[before][-1], found[after][0]
        assert a["tx"] * b["tx"] + a["ty"] * b["ty"] == pytest.approx(1.0), (before, after)


@pytest.mark.parametrize(
    ("kind", "stem", "sign"),
    [
        ("priority", ("m", "m"), "give_way"),
        ("priority_stop", ("w", "w"), "stop"),
        ("allway_stop", ("s", "s"), "stop"),
        ("right_before_left", ("m", "m"), None),
        ("unregulated", ("=", "="), None),
    ],
)
def test_signs_of_the_lesser_road(kind: str, stem: tuple[str, str], sign: str | None) -> None:
    found = tee(kind, stem)
    signs = values(found, "traffic_signal", "kind lanelet_id x_m y_m lane_s_m")
    assert signs == ([(sign, "st_0", 56.6, -10.0, 50.0)] if sign else [])
    lines = values(found, "stop_line", "lanelet_id source")
    assert lines == ([("st_0", "connection")] if sign == "stop" else [])


@pytest.mark.parametrize(
    ("of_lane", "of_edge", "s_m"),
    [
        ("", "", 50.0),
        ('<stopOffset value="4"/>', "", 46.0),
        ("", '<stopOffset value="4" vClasses="all"/>', 46.0),
        ('<stopOffset value="3" vClasses="bus passenger"/>', '<stopOffset value="4"/>', 47.0),
        ('<stopOffset value="3" vClasses="truck"/>', '<stopOffset value="4" exceptions="bicycle"/>', 46.0),
        ('<stopOffset value="3" exceptions="passenger taxi"/>', "", 50.0),
        ('<stopOffset value="80"/>', "", 0.0),
        ('<stopOffset value="-1"/>', "", 50.0),
        ('<stopOffset value="far"/>', "", 50.0),
    ],
)
def test_cars_stop_before_the_end_of_the_lane_by_its_offset(of_lane: str, of_edge: str, s_m: float) -> None:
    found = net(
        edge("a", of_edge, lane("a", 0, "0,0 50,0", inside=of_lane), ends=("x", "c")),
        edge("b", lane("b", 0, "60,0 99,0"), ends=("c", "y")),
        link("a", "b", "o", more='tl="L" linkIndex="7"'),
    )
    assert values(found, "stop_line", "lanelet_id lane_s_m") == [("a_0", s_m)]
    assert values(found, "traffic_signal", "lane_s_m") == [50.0]


def test_who_turns_across_the_main_road_has_no_sign() -> None:
    found = net(
        edge("a", lane("a", 0, "0,0 50,0"), lane("a", 1, "0,3.2 50,3.2"), ends=("x", "c")),
        edge("b", lane("b", 0, "60,0 99,0"), ends=("c", "y")),
        edge("d", lane("d", 0, "55,9 55,60"), ends=("c", "z")),
        '<junction id="c" type="priority"/>',
        link("a", "b", "M"), link("a", "d", "m", "l", 'fromLane="1" toLane="0"'),
    )  # fmt: skip
    assert not rows(found, "traffic_signal")


def test_lights_by_connection() -> None:
    found = tee("traffic_light", ("o", "o"), light="L", major="O")
    heads = values(found, "traffic_signal", "signal_id lanelet_id turns")
    assert {(name, lane_id, *turns) for name, lane_id, turns in heads} == {
        ("L_0", ":c_0_0", "straight"), ("L_1", ":c_0_1", "straight"), ("L_2", ":c_2_0", "straight"),
        ("L_3", ":c_3_0", "right"), ("L_4", ":c_4_0", "left"),
    }  # fmt: skip
    assert values(found, "stop_line", "lanelet_id") == ["ew_0", "st_0", "we_0", "we_1"]
    assert set(values(found, "traffic_signal", "dynamic")) == {True}
    # without the lanes inside the junction, the heads stand at the ends of those before it
    bare = net(
        edge("a", lane("a", 0, "0,0 50,0"), ends=("x", "c")), edge("b", lane("b", 0, "60,0 99,0"), ends=("c", "y")),
        link("a", "b", "o", more='tl="L" linkIndex="7"'),
    )  # fmt: skip
    assert values(bare, "traffic_signal", "signal_id lanelet_id lane_s_m") == [("L_7", "a_0", 50.0)]


@pytest.mark.parametrize(
    ("may", "kind", "drivable"),
    [
        ("", "driving", True),
        ('allow="all"', "driving", True),
        ('disallow="pedestrian"', "driving", True),
        ('allow="bus taxi"', "bus", True),
        ('allow="bicycle"', "biking", False),
        ('allow="pedestrian"', "sidewalk", False),
        ('allow="tram"', "tram", False),
        ('allow="emergency"', "restricted", False),
        ('disallow="all"', "none", False),
    ],
)
def test_who_may_drive_on_a_lane(may: str, kind: str, drivable: bool) -> None:
    found = net(edge("a", lane("a", 0, "0,0 50,0", may), ends=("x", "y")))
    assert lanelet(found, "a_0", "lane_type drivable") == (kind, drivable)


@pytest.mark.parametrize(
    ("may", "kind", "unread"),
    [
        ('allow="bus taxi motorcycle bicycle"', "bus", False),
        ('allow="truck delivery"', "driving", True),
        ('allow="pedestrian delivery bicycle"', "driving", True),
        ('allow="bus truck"', "driving", True),
        ('allow="motorcycle"', "driving", True),
        ('allow="private"', "driving", True),
        ('disallow="passenger"', "driving", True),
        ('disallow="truck"', "driving", False),
        ('allow="passenger"', "driving", False),
        ('allow="hov motorcycle"', "HOV", False),
    ],
)
def test_a_lane_that_cars_may_not_use_is_of_another_type_or_named(may: str, kind: str, unread: bool) -> None:
    found = net(edge("a", lane("a", 0, "0,0 50,0", may), ends=("x", "y")))
    assert lanelet(found, "a_0", "lane_type drivable") == (kind, True)
    assert values(found, "map_quality", "check_id lanelet_id") == [("access_unread", "a_0")] * unread
    if unread:
        assert messages(found, "access_unread") == [f"cars may not use it ({may}), which no lane type shows"]


@pytest.mark.parametrize(
    ("more", "kind"),
    [
        ('acceleration="1"', "entry"),
        ('acceleration="true"', "entry"),
        ('acceleration="0"', "driving"),
        ('acceleration="1" allow="bus"', "bus"),
    ],
)
def test_an_acceleration_lane_is_an_entry(more: str, kind: str) -> None:
    found = net(edge("a", lane("a", 0, "0,0 50,0", more), ends=("x", "y")))
    assert lanelet(found, "a_0", "lane_type drivable") == (kind, True)


def test_left_hand_nets_say_so() -> None:
    lanes = lane("a", 0, "0,4.8 50,4.8"), lane("a", 1, "0,1.6 50,1.6")
    parts = edge("a", *lanes, ends=("x", "y"), more='type="highway.motorway"')
    found = net(parts, more='lefthand="true"')
    assert hand(found) == ("lht", "attribute")
    assert lanelet(found, "a_0", "right_id left_id road_type") == ("a_1", None, "motorway")
    doubted = net(parts, more='lefthand="true"', handedness="rht")
    assert hand(doubted) == ("rht", "option")
    assert "handedness_disagrees" in checks(doubted)


def test_what_is_broken_is_named() -> None:
    good = edge("a", lane("a", 0, "0,0 50,0"), ends=("x", "y"))
    shapes = [lane("b", 0, shape) for shape in ("0,0", "0,0 nan,1", "0,0 0,0", "x", "", "0 1 2 3", "0,0 1")]
    broken = [lane("b", 0, "0,9 9,9", f'width="{width}"') for width in ("nan", "inf", "0")]
    for bad in (*shapes, *broken, lane("b", 0, "0,9 9,9").replace("13.89", "nan")):
        found = net(good, edge("b", bad, ends=("x", "y")))
        assert (checks(found)["invalid_lane"], list(lanelets(found))) == (["b_0"], ["a_0"])
    with pytest.raises(MapError, match="has no lane that can be built"):
        net(edge("b", lane("b", 0, "0,0"), ends=("x", "y")))
    with pytest.raises(MapError, match="not well-formed"):
        load_map(MapSource("x.net.xml", b"<net><edge></net>"))


def test_crossings_lie_across_the_lanes() -> None:
    inner = lane(":c_c0", 0, "20,-3 20,3", 'width="4" allow="pedestrian"')
    walk = f'<edge id=":c_c0" function="crossing" crossingEdges="a">{inner}</edge>'
    found = net(edge("a", lane("a", 0, "0,0 50,0"), ends=("x", "y")), walk)
    assert values(found, "crossing", "crossing_id lanelet_id s_start_m s_end_m") == [(":c_c0_0", "a_0", 18, 22)]


def test_the_stand_in_of_netconvert_for_a_road_without_a_limit_is_unknown() -> None:
    """netconvert 1.28.0 writes 39.44 m/s for OpenStreetMap's `maxspeed=none`, and for a motorway without a limit (findings/)."""
    free, posted = (lane(name, 0, f"{x},0 {x + 50},0") for name, x in (("free", 0), ("posted", 60)))
    tables = net(edge("free", free.replace("13.89", "39.44"), ends=("a", "b")), edge("posted", posted, ends=("c", "d")))
    assert values(tables, "speed_limit", "lanelet_id limit_mps") == [("posted_0", 13.89)]
    assert "invalid_speed" in checks(tables)


IMPORTED = (
    '<?xml version="1.0"?>\n<!-- generated by Eclipse SUMO netconvert 1.28.0\n<input><{key} value="a.xodr"/></input>\n-->\n'
    "<net {more}>{parts}</net>"
)


def imported(key: str = "opendrive-files", more: str = "", **options: Any) -> MapTables:
    """Return what netconvert 1.28.0 makes of a road with `rule="LHT"` and a limit of 30 mph, and another lane with a limit of its own."""
    lanes = [lane(name, 0, f"0,{y} 100,{y}", 'type="driving"') for name, y in (("a", -1.75), ("b", 1.75))]
    parts = '<type id="driving" speed="13.89"/>' + edge("a", lanes[0], ends=("x", "y"))
    parts += edge("b", lanes[1].replace('speed="13.89"', 'speed="8.33"'), ends=("y", "x"))
    return load_map(MapSource("small.net.xml", IMPORTED.format(key=key, more=more, parts=parts).encode()), **options)


@pytest.mark.parametrize("key", ["opendrive-files", "opendrive"])
def test_a_net_that_was_imported_from_opendrive_has_lost_side_and_limits(key: str) -> None:
    found = imported(key)
    assert hand(found) == ("rht", "default")
    (message,) = messages(found, "imported_net")
    assert "from the OpenDRIVE file a.xodr" in message
    assert values(found, "speed_limit", "lanelet_id limit_mps") == [("b_0", 8.33)]


def test_what_an_imported_net_or_the_user_says_of_the_side_counts() -> None:
    for found, expected in (
        (imported(more='lefthand="true"'), ("lht", "attribute")),
        (imported(handedness="lht"), ("lht", "option")),
        (imported(key="node-files"), ("rht", "attribute")),
    ):
        assert hand(found) == expected
        assert "handedness_default" not in checks(found)
    assert "imported_net" not in checks(imported(key="node-files"))
    assert set(values(imported(key="node-files"), "speed_limit", "lanelet_id")) == {"a_0", "b_0"}


def test_inspect_says_that_a_net_was_imported(tmp_path: Path) -> None:
    road, log = tmp_path / "a.net.xml", tmp_path / "log.xml"
    parts = edge("a", lane("a", 0, "0,0 100,0"), ends=("x", "y"))
    road.write_text(IMPORTED.format(key="opendrive-files", more="", parts=parts), encoding="utf-8")
    drive = [{"time": f"{t / 10}", "id": "a", "x": 10.0 + t, "y": 0.0, "angle": 90.0, "speed": 10.0} for t in range(30)]
    log.write_text(xml(drive), encoding="utf-8")
    found = inspect(InspectRequest(str(log), map=road, ego="a")).drive
    assert found is not None
    assert {"imported_net", "handedness_default"} <= {row.check_id for row in found.quality if row.about == "map"}
