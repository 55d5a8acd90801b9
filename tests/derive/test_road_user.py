"""What everybody is, and what is said of those whose class is not known."""

from __future__ import annotations

import pytest

from drivelint.formats import load_map
from drivelint.road.map_reader import MapSource
from tests.formats.opendrive import xodr
from tests.scenes import LANE, Road, derived, drive, moving, plan, rows, times, verdict_rows

HANDS = pytest.mark.parametrize("hand", ["rht", "lht"])
T = times(14)


def cycle_road(hand: str, between: str | None, mark: str = "broken") -> Road:
    """Return a straight two-way road of one lane each way, beside each of them a cycle lane of 2 m, after `between` of 0.3 m."""
    inside = f'<width sOffset="0" a="{LANE}"/><roadMark sOffset="0" type="{mark}" width="0.1"/>'
    lanes = [xodr.lane(n, inside) for n in (1, -1)]
    for sign in (1, -1):
        kinds = [(between, 0.3)] if between else []
        for k, (kind, width) in enumerate([*kinds, ("biking", 2.0)], start=2):
            lanes.append(xodr.lane(sign * k, f'<width sOffset="0" a="{width}"/>', kind))
    lanes.sort(key=lambda text: -int(text.split('"')[1]))
    text = xodr.xodr(
        xodr.road(
            geometry=plan(((600.0, 0.0),)),
            lanes=xodr.section(0, *lanes),
            length=600.0,
            attributes=f'rule="{hand.upper()}"',
            more='<type s="0" type="town"><speed max="30" unit="mph"/></type>',
        )
    )
    return Road(load_map(MapSource("cycle.xodr", text.encode())), ((600.0, 0.0),))


@pytest.mark.sample(0, ci=2)
@HANDS
@pytest.mark.parametrize(
    ("between", "mark", "cycle_lane", "on_strip", "british", "german"),
    [
        (None, "broken", "broken", True, "fail", "fail"),
        (None, "solid", "solid", True, "fail", "unknown"),
        (None, "curb", None, False, "not_applicable", "not_applicable"),
        # what the map calls a border may be a kerb
        ("border", "solid", None, None, "unknown", "not_applicable"),
        ("border", "curb", None, False, "not_applicable", "not_applicable"),
        ("shoulder", "solid", None, True, "fail", "not_applicable"),
        ("sidewalk", "solid", None, False, "not_applicable", "not_applicable"),
    ],
)
def test_a_cyclist_on_a_cycle_lane(  # noqa: PLR0917
    hand: str, between: str | None, mark: str, cycle_lane: str | None, on_strip: bool | None, british: str, german: str
) -> None:
    """Passed at 1.05 m: on the carriageway's lane it counts, on a track behind a verge or kerb it does not."""
    way = cycle_road(hand, between, mark)
    side, d = -way.over, 2.0 if between else 1.8  # the rider is 2.25 m beside the ego's centre
    ego = moving("ego", way, T, 20 + 10 * T, side * d)
    other = moving("b", way, T, 60 + 5 * T, side * (d + 2.25), kind="bicycle", length=1.8, width=0.6)
    told = drive([ego, other], way.environment)
    con = derived(told, tables=["beside"])
    found = rows(con, "FROM beside")
    assert found
    assert {(r["cycle_lane"], r["on_carriageway"]) for r in found} == {(cycle_lane, cycle_lane is not None)}
    assert {r["on_strip"] for r in found} == {on_strip}
    assert all(r["clearance_m"] == pytest.approx(1.05, abs=0.01) for r in found)
    said = {r["rule_id"]: r["verdict"] for r in verdict_rows([told], rules=["ukhc.r163.cyclist", "stvo.s5-passing"])}
    assert said == {"ukhc.r163.cyclist": british, "stvo.s5-passing": german}
