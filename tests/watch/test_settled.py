"""Verdicts that are said before the end of a log: each once, when nothing of it can be missing, and held against the whole log."""

from __future__ import annotations

from typing import Any

import pyarrow as pa

from drivelint.sql.store import arrow_schemas
from drivelint.watch.judge import JudgedWindow
from drivelint.watch.settled import SETTLE_DELAY_NS, SettledVerdicts
from drivelint.watch.window import NS_PER_S

SCHEMA = arrow_schemas()["verdict"]
SETTLE_S = SETTLE_DELAY_NS // NS_PER_S


def row(start_s: float, end_s: float, **more: Any) -> dict[str, Any]:
    """Return a row of `verdict` that passed, of an episode between these seconds."""
    found: dict[str, Any] = dict.fromkeys(SCHEMA.names)
    for field in SCHEMA:
        if not field.nullable:
            found[field.name] = "" if pa.types.is_string(field.type) else [] if pa.types.is_list(field.type) else 0
    found |= {
        "rule_id": "r",
        "ego_id": "e",
        "verdict": "pass",
        "reason_code": "kept",
        "near_miss": False,
        "reason_measures": False,
    }
    return found | {"t_start_ns": round(start_s * NS_PER_S), "t_end_ns": round(end_s * NS_PER_S)} | more


def table(*rows: dict[str, Any]) -> pa.Table:
    return pa.Table.from_pylist(list(rows), schema=SCHEMA)


def window(start_s: float, end_s: float, *rows: dict[str, Any]) -> JudgedWindow:
    return JudgedWindow(round(start_s * NS_PER_S), round(end_s * NS_PER_S), pa.table({}), table(*rows), pa.table({}))


def test_a_verdict_is_said_once_and_only_when_it_has_settled() -> None:
    settled = SettledVerdicts()
    episode = row(2, 5)
    assert settled.new_settled_rows(window(0, 5 + SETTLE_S, episode), 0) == []
    assert [each["t_start_ns"] for each in settled.new_settled_rows(window(0, 6 + SETTLE_S, episode), 0)] == [
        2 * NS_PER_S
    ]
    assert settled.new_settled_rows(window(0, 7 + SETTLE_S, episode), 0) == []
    assert len(settled) == 1


def test_what_may_have_begun_before_the_window_has_no_verdict_yet() -> None:
    assert SettledVerdicts().new_settled_rows(window(100, 130, row(105, 108)), 105 * NS_PER_S) == []
    assert len(SettledVerdicts().new_settled_rows(window(100, 130, row(106, 108)), 105 * NS_PER_S)) == 1
    assert (
        SettledVerdicts().new_settled_rows(window(100, 130, row(106, 108, t_ref_ns=104 * NS_PER_S)), 105 * NS_PER_S)
        == []
    )
    assert (
        len(SettledVerdicts().new_settled_rows(window(100, 130, row(100, 108)), 100 * NS_PER_S)) == 1
    )  # the log begins there


def test_an_unknown_is_said_at_the_end() -> None:
    assert SettledVerdicts().new_settled_rows(window(0, 60, row(2, 5, verdict="unknown")), 0) == []


def test_they_are_held_against_the_whole_log() -> None:
    settled = SettledVerdicts()
    said = [row(2, 5), row(8, 9), row(12, 13, observed=3.0), row(14, 15)]
    assert len(settled.new_settled_rows(window(0, 60, *said), 0)) == 4
    whole = [
        row(2, 5),
        row(8, 9, verdict="fail"),
        row(12, 13, observed=4.0),
        row(40, 50),
        row(51, 52, verdict="not_applicable"),
    ]
    late, other = settled.late_and_revised_rows(table(*whole))
    assert [each["t_start_ns"] // NS_PER_S for each in late] == [40]
    assert [(each["t_start_ns"] // NS_PER_S, each["verdict"]) for each in other] == [
        (8, "fail"),
        (12, "pass"),
        (14, None),
    ]
