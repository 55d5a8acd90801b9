"""Sessions that follow each other in one database: none sees the map of an earlier one."""

from __future__ import annotations

import pytest

from drivelint import catalogue
from drivelint.engine.session import JudgingSession
from drivelint.sql import store
from tests.scenes import drive, moving, road, times


@pytest.mark.ci
def test_a_map_that_an_earlier_session_left_is_not_there_twice() -> None:
    way, t = road(), times(3.0)
    scene = drive([moving("ego", way, t, 100 + 10 * t, way.ego_d)], way.environment)
    rules = catalogue.select_rules(catalogue.load_rules(), ["ukhc.r124.speed-limit"], [])
    counts = []
    with store.connect() as con:
        for _ in range(2):
            session = JudgingSession(con, rules, {}, None)
            session.judge([scene])
            session.close()
            counts.append(
                [
                    con.execute(f"SELECT count(*) FROM {table}").fetchone()
                    for table in ("lanelet", "lane_point", "_lane_segment")
                ]
            )
            con.execute("DELETE FROM verdict; DELETE FROM finding")
    assert counts[0] == counts[1] > [(0,)] * 3
