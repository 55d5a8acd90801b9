"""On which side the oncoming traffic runs, on maps with one road per direction: the side that is driven on, the lanes' direction known."""

from __future__ import annotations

import math

import numpy as np
import pyarrow as pa
import pytest

from drivelint.drive.trace import DriveInput
from drivelint.engine.map_library import MapLibrary
from drivelint.errors import MapError
from drivelint.road.boundary_lanes import BoundedLane, build_lanes, side_driven_on
from drivelint.road.map_reader import MapSource
from drivelint.road.quality import MapQuality
from tests.engine.few_states import log_of
from tests.formats.opendrive.xodr import checks, geometry, lane, lanelets, load, road, rows, section, xodr

HANDS = pytest.mark.parametrize("hand", ["lht", "rht"])
LANE = 3.5
LINE = "<line/>"


def one_lane_road(number: str = "1", y: float = 0.0, *, back: bool = False, rule: str = "", height: float = 0.0) -> str:
    """Return a road along x of one lane, number -1 as SUMO writes it, whose middle is at y; `back`: its line runs towards -x."""
    at = (100.0, y - LANE / 2, math.pi) if back else (0.0, y + LANE / 2, 0.0)
    return road(
        number,
        geometry(LINE, at=at),
        section(0, lane(-1)),
        attributes=f'rule="{rule}"' if rule else "",
        more=f'<elevationProfile><elevation s="0" a="{height}" b="0" c="0" d="0"/></elevationProfile>',
    )


def pair(hand: str, gap: float = 0.0, rule: str = "", height: float = 0.0) -> tuple[str, str]:
    """Return two roads, one there and one back, so that vehicles that follow their lines meet as in that traffic."""
    y = (LANE + gap) / 2 * (1 if hand == "lht" else -1)
    return one_lane_road("1", y, rule=rule), one_lane_road("2", -y, back=True, rule=rule, height=height)


def along(environment: object) -> set[int]:
    return {row["along_road"] for row in lanelets(environment).values()}  # type: ignore[arg-type]


@HANDS
@pytest.mark.parametrize("gap", [0.0, 1.5, 10.0])
def test_traces_tell_the_direction_and_the_layout_the_side(hand: str, gap: float) -> None:
    seen = load(*pair(hand, gap), voted_handedness="rht")
    assert (seen.handedness, seen.handedness_source, seen.lanes) == (hand, "traces", "rht")
    assert along(seen) == {1}
    turned = load(*pair(hand, gap), voted_handedness="lht")
    assert (turned.handedness, along(turned)) == ("rht" if hand == "lht" else "lht", {-1})
    guess = load(*pair(hand, gap))
    assert (guess.handedness_source, guess.lanes_source) == ("default", "default")
    assert checks(guess)["handedness_default"] == [None]


@HANDS
def test_by_the_option_the_lanes_run_as_the_layout_has_it(hand: str) -> None:
    given = load(*pair(hand), handedness=hand)
    assert (given.handedness, given.handedness_source, along(given)) == (hand, "option", {1})
    assert not checks(given)
    other = load(*pair(hand), handedness="rht" if hand == "lht" else "lht")
    assert along(other) == {-1}


@HANDS
def test_junctions_tell_the_direction(hand: str) -> None:
    links = '<connection id="0" incomingRoad="1" connectingRoad="10" contactPoint="start"><laneLink from="-1" to="-1"/></connection>'
    inside = road("10", geometry(LINE, at=(0.0, 99.0, 0.0)), section(0, lane(-1)), junction="9")
    told = load(*pair(hand), inside, f'<junction id="9">{links}</junction>')
    assert (told.handedness, told.handedness_source, along(told)) == (hand, "junctions", {1})


@HANDS
@pytest.mark.parametrize("rule", ["LHT", "RHT"])
def test_a_rule_that_the_layout_contradicts_is_said_and_not_counted(hand: str, rule: str) -> None:
    """By the rule RHT these lanes run along their roads, and by LHT against them."""
    told = load(*pair(hand, rule=rule), voted_handedness="rht")
    if hand == "rht":
        assert (told.handedness, told.handedness_source) == (rule.lower(), "attribute")
        return
    assert (told.handedness, told.handedness_source, along(told)) == ("lht", "traces", {1})
    assert checks(told)["handedness_disagrees"] == [None]
    assert load(*pair(hand, rule=rule)).handedness_source == "default"


def test_on_a_road_of_one_direction_the_lanes_do_not_tell_the_side() -> None:
    for side, way in (("rht", 1), ("lht", -1)):
        seen = load(one_lane_road(), voted_handedness=side)
        assert (seen.handedness_source, seen.lanes_source, along(seen)) == ("default", "traces", {way})
        assert "handedness_default" in checks(seen)
        given = load(one_lane_road(), handedness="lht", voted_handedness=side)
        assert (given.handedness, given.handedness_source, along(given)) == ("lht", "option", {way})
        doubts = [row["message"] for row in rows(given, "map_quality") if row["check_id"] == "handedness_disagrees"]
        assert doubts == (
            []
            if side == "lht"
            else [
                (
                    "--handedness says lht, the traces fit rht: lht is used. If this is not right, the side for overtaking is wrong: "
                    "leave the option out, or set rht."
                )
            ]
        )
        ids = {load(one_lane_road(), voted_handedness=s).environment_id for s in (side, "rht", None)}
        assert len(ids) == (1 if side == "rht" else 2)
    # without traces as the standard has it
    assert along(load(one_lane_road(), handedness="lht")) == along(load(one_lane_road(rule="LHT"))) == {-1}
    assert load(one_lane_road(rule="LHT")).lanes_source == "attribute"
    doubted = load(one_lane_road(rule="LHT"), handedness="rht", voted_handedness="lht")
    assert (doubted.handedness, along(doubted)) == ("rht", {-1})


def test_not_far_off_nor_above_nor_the_same_way() -> None:
    apart = (
        pair("lht", 20.0),
        pair("lht", height=5.0),
        (one_lane_road("1", 0.0), one_lane_road("2", LANE)),
        (one_lane_road("1", 0.0), one_lane_road("2", 1.0, back=True)),
    )
    for roads in apart:
        assert "no lane has a lane of the other direction beside it" in _default(load(*roads, voted_handedness="rht"))


def _default(environment: object) -> str:
    rows = environment.tables["map_quality"].to_pylist()  # type: ignore[attr-defined]
    return str(next(row["message"] for row in rows if row["check_id"] == "handedness_default"))


@HANDS
def test_lanes_given_by_their_bounds(hand: str) -> None:
    def straight(name: str, y: float, *, back: bool = False) -> BoundedLane:
        x = np.array([100.0, 0.0] if back else [0.0, 100.0])
        half = -LANE / 2 if back else LANE / 2
        return BoundedLane(name, left=np.column_stack([x, [y + half] * 2]), right=np.column_stack([x, [y - half] * 2]))

    y = LANE / 2 * (1 if hand == "lht" else -1)
    lanes = build_lanes([straight("1", y), straight("2", -y, back=True)], (0.0, 0.0), MapQuality())
    assert side_driven_on(lanes) == hand


def _states(hand: str, way: int) -> pa.Table:
    """Return states of two vehicles, one on each road, that follow their lines (1) or run against them (-1)."""
    x = np.linspace(5, 95, 60)
    y = LANE / 2 * (1 if hand == "lht" else -1)
    heading = np.repeat([0.0 if way > 0 else math.pi, math.pi if way > 0 else 0.0], len(x))
    return pa.table({
        "x_m": np.r_[x, x], "y_m": np.repeat([y, -y], len(x)), "yaw_rad": heading,
        "vx_mps": 10 * np.cos(heading), "vy_mps": np.zeros(2 * len(x)),
    })  # fmt: skip


@HANDS
def test_the_traffic_of_a_log_settles_it_and_contradicts_a_wrong_option(hand: str, tmp_path: object) -> None:
    log = log_of(_states(hand, 1))
    content = xodr(*pair(hand)).encode()
    path = tmp_path / "small.xodr"  # type: ignore[operator]
    path.write_bytes(content)
    library = MapLibrary(DriveInput(map=path))
    found, _ = library.find(log)
    assert found is not None
    assert (found.handedness, found.handedness_source) == (hand, "traces")
    assert not library.doubts_on_map(log, found)

    wrong = MapLibrary(DriveInput(map=path, handedness="rht" if hand == "lht" else "lht"))
    with pytest.raises(
        MapError, match=r"^map small\.xodr: the traffic of \S+ runs against its lanes, on road 1 both ways"
    ):
        wrong.doubts_on_map(log, wrong.find(log)[0])

    alone = MapSource("small.xodr", xodr(one_lane_road("1", (LANE if hand == "lht" else -LANE) / 2)).encode())
    path.write_bytes(alone.content)
    for said, source in (("auto", "default"), ("lht", "option")):
        library = MapLibrary(DriveInput(map=path, handedness=said))
        for way in (1, -1):
            log = log_of(_states(hand, way).slice(0, 60))
            found, _ = library.find(log)
            assert found is not None
            assert (found.handedness_source, along(found)) == (source, {way})
            assert not library.doubts_on_map(log, found)
