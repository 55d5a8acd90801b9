"""Executions, pre- and postconditions, temporal and physical: truth tables with tiny scenes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest

from tests.evaluate.packs import (
    AFTER,
    BEFORE,
    EXECUTION,
    HOLDS,
    MEASURE,
    PLACE_BEFORE,
    brief,
    findings,
    verdicts,
    write,
)

if TYPE_CHECKING:
    from pathlib import Path

READS = {"reads": '["ego_state", "exit_taken"]'}
REFERENCE = "SELECT drive_id, ego_id, t_ns, side FROM exit_taken"
SPEED = "SELECT drive_id, ego_id, t_ns, speed_mps AS observed, 10 AS required FROM ego_state"
SIGNAL = """SELECT r.drive_id, r.ego_id, e.t_ns, r.ref_id, e.indicator = r.side AS holds
FROM reference r JOIN reference_step s USING (ref_id) JOIN ego_state e ON e.drive_id = s.drive_id
    AND e.ego_id = s.ego_id AND e.t_ns = s.t_ns"""
EVENTUALLY = {"quantifier": '"eventually"'}


def scene(signal: Any, at: Any, times: Any = "0..4 by 0.1", **more: Any) -> dict[str, Any]:
    return {
        "ego_state": {"t_s": times, "indicator": signal, "speed_mps": 12} | more,
        "exit_taken": {"t_s": at, "side": "left"},
    }


# ---- executions


@pytest.mark.parametrize(
    ("speed", "at", "expected"),
    [
        ({"else": 12, "2": None}, 2.0, ("unknown", "null_value")),
        (12, 2.05, ("unknown", "missing_step")),
        (12, None, ("unknown", "reference_time_unknown")),
        (12, [], ("not_applicable", "not_triggered")),
    ],
)
def test_execution_without_a_value(tmp_path: Path, speed: Any, at: Any, expected: tuple[str, str]) -> None:
    sql = REFERENCE.replace("t_ns", "t_sign_ns AS t_ns")
    rule = write(tmp_path, EXECUTION | MEASURE | READS, {"reference": sql, "condition": SPEED})
    given = scene("off", 1.0, speed_mps=speed)
    given["exit_taken"] = [] if at == [] else {"t_s": 1.0, "t_sign_s": at}
    assert brief(verdicts(rule, given)) == [expected]


@pytest.mark.parametrize(
    ("applies", "expected"), [(False, ("not_applicable", "outside_conditions")), (None, ("unknown", "applies_unknown"))]
)
def test_execution_may_not_apply(tmp_path: Path, applies: Any, expected: tuple[str, str]) -> None:
    rule = write(
        tmp_path,
        EXECUTION | MEASURE | READS,
        {"reference": REFERENCE, "condition": SPEED.replace(" FROM", ", in_junction AS applies FROM")},
    )
    assert brief(verdicts(rule, scene("off", 2.0, in_junction=applies))) == [expected]


PAIR = {"reads": '["exit_taken", "pair"]'}
PAIR_SQL = "SELECT drive_id, ego_id, t_ns, object_id, clearance_m AS observed, 1 AS required FROM pair"


@pytest.mark.parametrize(
    ("clearances", "verdicts_of_each", "verdict_of_all", "verdict_of_any"),
    [
        ([2, 3], ["pass", "pass"], "pass", "pass"),
        ([2, 0], ["pass", "fail"], "fail", "pass"),
        ([2, None], ["pass", "unknown"], "unknown", "pass"),
        ([0, None], ["fail", "unknown"], "fail", "unknown"),
        ([0, 0], ["fail", "fail"], "fail", "fail"),
        ([], ["not_applicable"], "pass", "fail"),
    ],
)
def test_combination_over_objects(
    tmp_path: Path, clearances: list[Any], verdicts_of_each: list[str], verdict_of_all: str, verdict_of_any: str
) -> None:
    got = []
    given: dict[str, Any] = {"step": {"t_s": [0, 1, 2]}, "exit_taken": {"t_s": 1.0}}
    given["pair"] = [{"t_s": 1.0, "object_id": str(i), "clearance_m": c} for i, c in enumerate(clearances)]
    for combine in ("each", "all", "any"):
        header = EXECUTION | MEASURE | PAIR | {"combine": f'"{combine}"'}
        rule = write(tmp_path, header, {"reference": REFERENCE, "condition": PAIR_SQL}, name=combine)
        got.append([r["verdict"] for r in verdicts(rule, given)])
    assert got == [verdicts_of_each, [verdict_of_all], [verdict_of_any]]


# ---- temporal windows


@pytest.mark.parametrize(
    ("signal", "at", "expected", "counts"),
    [
        ("left", 2.0, ("pass", "kept"), (11, 11)),
        ({"else": "left", "1.5": "off"}, 2.0, ("fail", "violated"), (11, 11)),
        ({"else": "left", "1.5": None}, 2.0, ("unknown", "null_value"), (11, 10)),
        ({"else": "left", "1.5": None, "1.7": "off"}, 2.0, ("fail", "violated"), (11, 10)),
        ({"else": "left", "0.9": "off", "2.1": "off"}, 2.0, ("pass", "kept"), (11, 11)),
        ("left", 0.5, ("unknown", "window_truncated"), (6, 6)),
        ({"else": "left", "0.2": "off"}, 0.5, ("fail", "violated"), (6, 6)),
        ("left", 0.8, ("pass", "kept"), (9, 9)),
        ("left", 0.75, ("pass", "kept"), (8, 8)),
    ],
)
def test_temporal_precondition(
    tmp_path: Path, signal: Any, at: float, expected: tuple[str, str], counts: tuple[int, int]
) -> None:
    rule = write(tmp_path, BEFORE | HOLDS | READS, {"reference": REFERENCE, "condition": SIGNAL})
    (row,) = verdicts(rule, scene(signal, at))
    assert brief([row]) == [expected]
    assert (row["n_expected"], row["n_judged"]) == counts
    assert (row["t_start_ns"], row["t_end_ns"], row["t_ref_ns"]) == (
        round((at - 1) * 1e9),
        round(at * 1e9),
        round(at * 1e9),
    )


@pytest.mark.parametrize(
    ("signal", "at", "expected"),
    [
        ({"else": "off", "2.5": "left"}, 2.0, ("pass", "kept")),
        ("off", 2.0, ("fail", "violated")),
        ({"else": "off", "2.5": None}, 2.0, ("unknown", "null_value")),
        ({"else": "off", "2.5": None, "2.7": "left"}, 2.0, ("pass", "kept")),
        ("off", 3.5, ("unknown", "window_truncated")),
        ({"else": "off", "3.9": "left"}, 3.5, ("pass", "kept")),
    ],
)
def test_eventually_in_a_temporal_postcondition(
    tmp_path: Path, signal: Any, at: float, expected: tuple[str, str]
) -> None:
    rule = write(tmp_path, AFTER | HOLDS | READS | EVENTUALLY, {"reference": REFERENCE, "condition": SIGNAL})
    assert brief(verdicts(rule, scene(signal, at))) == [expected]
    assert len(findings(rule, scene(signal, at))) == (expected[0] == "fail")


HOLED = [i / 10 for i in range(12)] + [i / 10 for i in range(17, 41)]


@pytest.mark.parametrize(
    ("at", "signal", "expected"),
    [
        (2.0, "left", ("unknown", "log_hole")),
        (2.0, {"else": "left", "1.8": "off"}, ("fail", "violated")),
        (2.4, "left", ("unknown", "log_hole")),
        (2.9, "left", ("pass", "kept")),
        (1.1, "left", ("pass", "kept")),
    ],
)
def test_a_hole_in_the_window(tmp_path: Path, at: float, signal: Any, expected: tuple[str, str]) -> None:
    rule = write(tmp_path, BEFORE | HOLDS | READS, {"reference": REFERENCE, "condition": SIGNAL})
    assert brief(verdicts(rule, scene(signal, at, HOLED))) == [expected]


# ---- physical


ANCHOR = "SELECT ref_id, t_sign_ns AS t_ns FROM reference WHERE lanelet_id <> 'none'"
PLACE_REFERENCE = "SELECT drive_id, ego_id, t_ns, side, t_sign_ns, lanelet_id FROM exit_taken"


@pytest.mark.parametrize(
    ("signal", "sign", "lanelet", "expected"),
    [
        ("left", 1.0, "a", ("pass", "kept")),
        ({"else": "left", "1": "off"}, 1.0, "a", ("fail", "violated")),
        ({"else": "left", "1": None}, 1.0, "a", ("unknown", "null_value")),
        ("left", None, "a", ("unknown", "anchor_unknown")),
        ("left", 1.0, "none", ("not_applicable", "no_anchor")),
        ("left", 7.0, "a", ("unknown", "missing_step")),
    ],
)
def test_physical_precondition(tmp_path: Path, signal: Any, sign: Any, lanelet: str, expected: tuple[str, str]) -> None:
    rule = write(
        tmp_path, PLACE_BEFORE | HOLDS | READS, {"reference": PLACE_REFERENCE, "anchor": ANCHOR, "condition": SIGNAL}
    )
    given = scene(signal, 3.0)
    given["exit_taken"] |= {"t_sign_s": sign, "lanelet_id": lanelet}
    assert brief(verdicts(rule, given)) == [expected]


@pytest.mark.parametrize(
    ("first", "second", "always", "eventually"),
    [
        ("left", "left", "pass", "pass"),
        ("left", "off", "fail", "pass"),
        ("off", "off", "fail", "fail"),
        ("left", None, "unknown", "pass"),
        ("off", None, "fail", "unknown"),
    ],
)
def test_several_anchors_go_by_the_quantifier(
    tmp_path: Path, first: Any, second: Any, always: str, eventually: str
) -> None:
    anchor = "SELECT ref_id, unnest([1000000000, 2000000000]) AS t_ns FROM reference"
    sections = {"reference": PLACE_REFERENCE, "anchor": anchor, "condition": SIGNAL}
    given = scene({"else": "off", "1": first, "2": second}, 3.0)
    got = []
    for quantifier in ("always", "eventually"):
        rule = write(
            tmp_path, PLACE_BEFORE | HOLDS | READS | {"quantifier": f'"{quantifier}"'}, sections, name=quantifier
        )
        (row,) = verdicts(rule, given)
        got.append(row["verdict"])
    assert got == [always, eventually]
