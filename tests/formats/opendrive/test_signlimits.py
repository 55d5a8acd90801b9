"""Speed limits that signs give, and limits that cannot be read."""

from __future__ import annotations

from typing import Any

import pytest

from tests.formats.opendrive.signal_text import WIDTH, signal
from tests.formats.opendrive.xodr import LINE, lane, load, road, rows, section


def limits(environment: Any) -> list[tuple[str, float, float, float | None, str]]:
    return [
        (
            r["lanelet_id"], round(r["s_start_m"], 3), round(r["s_end_m"], 3),
            None if r["limit_mps"] is None else round(3.6 * r["limit_mps"], 3), r["source"],
        )
        for r in rows(environment, "speed_limit")
    ]  # fmt: skip


FIFTY = {"type": "274", "value": "50", "unit": "km/h"}


def joined(*signs: str, recorded: str = "") -> Any:
    """Two roads of 100 m, one after the other; the signs stand on the first."""
    first, second = (
        (
            section(0, lane(-1, f'<link><{end} id="-1"/></link>{WIDTH}')),
            f'<{end} elementType="road" elementId="{other}" {at}/>',
        )
        for end, other, at in (("successor", "2", 'contactPoint="start"'), ("predecessor", "1", 'contactPoint="end"'))
    )
    return load(
        road(lanes=first[0], link=first[1], more=f"<signals>{''.join(signs)}</signals>"),
        road("2", LINE.replace('x="0"', 'x="100"'), lanes=second[0], link=second[1], more=recorded),
    )


def test_signs_give_limits_where_the_map_records_none() -> None:
    environment = joined(signal(30, **FIFTY), signal(60, type="274", value="30", unit="mph"))
    assert limits(environment) == [
        ("1.0.-1", 30.0, 60.0, 50.0, "sign"), ("1.0.-1", 60.0, 100.0, 48.28, "sign"), ("2.0.-1", 0.0, 100.0, 48.28, "sign"),
    ]  # fmt: skip


def test_a_limit_ends_at_the_sign_that_ends_it_and_a_recorded_one_counts_instead() -> None:
    assert limits(joined(signal(30, **FIFTY), signal(60, type="278"))) == [("1.0.-1", 30.0, 60.0, 50.0, "sign")]
    recorded = '<type s="0" type="rural"><speed max="100" unit="km/h"/></type>'
    assert limits(joined(signal(30, **FIFTY), recorded=recorded)) == [
        ("1.0.-1", 30.0, 100.0, 50.0, "sign"), ("2.0.-1", 0.0, 100.0, 100.0, "road_type"),
    ]  # fmt: skip


@pytest.mark.parametrize("attributes", [{"value": ""}, {"unit": ""}, {"dynamic": "yes"}])
def test_a_limit_sign_that_cannot_be_read_gives_an_unread_limit(attributes: dict[str, str]) -> None:
    environment = joined(signal(30, **{**FIFTY, **attributes}))
    assert limits(environment) == [("1.0.-1", 30.0, 100.0, None, "unread"), ("2.0.-1", 0.0, 100.0, None, "unread")]


def test_a_lane_limit_that_cannot_be_read_is_not_that_of_the_road() -> None:
    lanes = section(0, lane(-1, WIDTH + '<speed sOffset="0" max="fast" unit="mph"/>'))
    environment = load(road(more='<type s="0" type="town"><speed max="50" unit="km/h"/></type>', lanes=lanes))
    assert limits(environment) == [("1.0.-1", 0.0, 100.0, None, "unread")]
