"""Executions, pre- and postconditions, temporal and physical: truth tables with tiny scenes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest

from tests.evaluate.packs import (
    AFTER,
    BEFORE,
    EXECUTION,
    HOLDS,
    MEASURED,
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


def test_execution_is_judged_at_each_reference_point(tmp_path: Path) -> None:
    rule = write(tmp_path, EXECUTION | MEASURED | READS, {"reference": REFERENCE, "condition": SPEED})
    rows = verdicts(rule, scene("off", [3.0, 1.0], speed_mps={"else": 12, "3": 9}))
    assert [(r["verdict"], r["ref_id"], r["t_ref_ns"], r["occurrence"], r["margin"]) for r in rows] == [
        ("pass", 0, 10**9, 0, 2.0), ("fail", 1, 3 * 10**9, 1, -1.0),
    ]  # fmt: skip
    assert all((r["n_expected"], r["n_judged"]) == (1, 1) for r in rows)
    (finding,) = findings(rule, scene("off", [3.0, 1.0], speed_mps={"else": 12, "3": 9}))
    assert (finding["ref_id"], finding["t_worst_ns"]) == (1, 3 * 10**9)


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
    rule = write(tmp_path, EXECUTION | MEASURED | READS, {"reference": sql, "condition": SPEED})
    given = scene("off", 1.0, speed_mps=speed)
    given["exit_taken"] = [] if at == [] else {"t_s": 1.0, "t_sign_s": at}
    assert brief(verdicts(rule, given)) == [expected]


@pytest.mark.parametrize(
    ("applies", "expected"), [(False, ("not_applicable", "outside_conditions")), (None, ("unknown", "applies_unknown"))]
)
def test_execution_may_not_apply(tmp_path: Path, applies: Any, expected: tuple[str, str]) -> None:
    rule = write(
        tmp_path,
        EXECUTION | MEASURED | READS,
        {"reference": REFERENCE, "condition": SPEED.replace(" FROM", ", in_junction AS applies FROM")},
    )
    assert brief(verdicts(rule, scene("off", 2.0, in_junction=applies))) == [expected]


@pytest.mark.ci
def test_the_references_object_goes_into_the_row(tmp_path: Path) -> None:
    sections = {
        "reference": "SELECT drive_id, ego_id, t_ns, lanelet_id AS object_id FROM exit_taken",
        "condition": SPEED,
    }
    rule = write(tmp_path, EXECUTION | MEASURED | READS, sections)
    given = scene("off", 2.0)
    given["exit_taken"] = {"t_s": [2.0, 2.0], "lanelet_id": ["b", "a"]}
    assert [(r["object_id"], r["ref_id"], r["occurrence"]) for r in verdicts(rule, given)] == [("a", 0, 0), ("b", 1, 0)]


def test_header_names_the_event_table(tmp_path: Path) -> None:
    rule = write(tmp_path, EXECUTION | MEASURED | READS | {"reference": '"exit_taken"'}, {"condition": SPEED})
    assert brief(verdicts(rule, scene("off", 2.0))) == [("pass", "kept")]


PAIR = {"reads": '["exit_taken", "pair"]'}
PAIR_SQL = "SELECT drive_id, ego_id, t_ns, object_id, clearance_m AS observed, 1 AS required FROM pair"


@pytest.mark.parametrize(
    ("clearances", "each", "every", "some"),
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
    tmp_path: Path, clearances: list[Any], each: list[str], every: str, some: str
) -> None:
    got = []
    given: dict[str, Any] = {"step": {"t_s": [0, 1, 2]}, "exit_taken": {"t_s": 1.0}}
    given["pair"] = [{"t_s": 1.0, "object_id": str(i), "clearance_m": c} for i, c in enumerate(clearances)]
    for combine in ("each", "all", "any"):
        header = EXECUTION | MEASURED | PAIR | {"combine": f'"{combine}"'}
        rule = write(tmp_path, header, {"reference": REFERENCE, "condition": PAIR_SQL}, name=combine)
        got.append([r["verdict"] for r in verdicts(rule, given)])
    assert got == [each, [every], [some]]


def test_nobody_there_is_not_known_beyond_sensor_range(tmp_path: Path) -> None:
    given = {
        "step": {"t_s": [0, 1, 2]},
        "exit_taken": {"t_s": 1.0},
        "data_log": {"sensor_range_m": 80.0, "sha256": "x"},
    }
    header = EXECUTION | MEASURED | PAIR | {"combine": '"all"'}
    rule = write(tmp_path, header, {"reference": REFERENCE, "condition": PAIR_SQL})
    assert brief(verdicts(rule, given)) == [("unknown", "beyond_sensor_range")]


@pytest.mark.ci
def test_combination_names_the_deciding_object(tmp_path: Path) -> None:
    given = {
        "step": {"t_s": [0, 1, 2]},
        "exit_taken": {"t_s": 1.0},
        "pair": {"t_s": 1.0, "object_id": ["a", "b", "c"], "clearance_m": [5, 2, 3]},
    }
    for combine, who in (("all", "b"), ("any", "a")):
        header = EXECUTION | MEASURED | PAIR | {"combine": f'"{combine}"'}
        rule = write(tmp_path, header, {"reference": REFERENCE, "condition": PAIR_SQL}, name=combine)
        (row,) = verdicts(rule, given)
        assert (row["object_id"], row["verdict"]) == (who, "pass")


@pytest.mark.ci
def test_a_failed_verdict_names_its_findings(tmp_path: Path) -> None:
    """Of each object, or of all together; also of those that are about another object than the worst."""
    given = {
        "step": {"t_s": [0, 1, 2, 3]},
        "exit_taken": {"t_s": [0.0]},
        "pair": {"t_s": [1.0, 1.0, 3.0, 3.0], "object_id": ["a", "b", "a", "b"], "clearance_m": [-3, 2, 4, -1]},
    }
    for combine, failed in (("each", [["a"], ["b"]]), ("all", [["a", "b"]])):
        header = AFTER | MEASURED | PAIR | {"combine": f'"{combine}"', "window_s": "3.5", "merge_gap_s": "0"}
        rule = write(tmp_path, header, {"reference": REFERENCE, "condition": PAIR_SQL}, name=combine)
        about = {found["finding_id"]: found["object_id"] for found in findings(rule, given)}
        rows = verdicts(rule, given)
        assert [row["verdict"] for row in rows] == ["fail"] * len(failed)
        assert [[about[name] for name in row["finding_ids"]] for row in rows] == failed


@pytest.mark.ci
def test_two_rows_for_one_object_are_refused_also_where_objects_are_combined(tmp_path: Path) -> None:
    sql = PAIR_SQL + " UNION ALL SELECT drive_id, ego_id, t_ns, 'a', 9, 1 FROM pair WHERE object_id = 'a'"
    given = {
        "step": {"t_s": [0, 1, 2]},
        "exit_taken": {"t_s": 1.0},
        "pair": {"t_s": 1.0, "object_id": ["a", "b"], "clearance_m": 5},
    }
    for combine in ("each", "all"):
        header = EXECUTION | MEASURED | PAIR | {"combine": f'"{combine}"'}
        rule = write(tmp_path, header, {"reference": REFERENCE, "condition": sql}, name=combine)
        (row,) = verdicts(rule, given)
        assert row["verdict"] == "error"
        assert "2 rows for one step" in row["reason"]


# ---- temporal windows


@pytest.mark.parametrize(
    ("signal", "at", "expected", "judged"),
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
    tmp_path: Path, signal: Any, at: float, expected: tuple[str, str], judged: tuple[int, int]
) -> None:
    rule = write(tmp_path, BEFORE | HOLDS | READS, {"reference": REFERENCE, "condition": SIGNAL})
    (row,) = verdicts(rule, scene(signal, at))
    assert brief([row]) == [expected]
    assert (row["n_expected"], row["n_judged"]) == judged
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


def test_eventually_takes_the_best_step(tmp_path: Path) -> None:
    rule = write(tmp_path, AFTER | MEASURED | READS | EVENTUALLY, {"reference": REFERENCE, "condition": SPEED})
    (row,) = verdicts(rule, scene("off", 2.0, speed_mps={"else": 3, "2.3": 11, "2.5..2.6": 12}))
    assert (row["verdict"], row["t_worst_ns"], row["margin"]) == ("pass", 2_500_000_000, 2.0)
    (row,) = verdicts(rule, scene("off", 2.0, speed_mps={"else": 3, "2.5..2.6": 9}))
    assert (row["verdict"], row["t_worst_ns"], row["margin"]) == ("fail", 2_500_000_000, -1.0)


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


@pytest.mark.ci
def test_a_window_wholly_outside_the_log(tmp_path: Path) -> None:
    rule = write(tmp_path, AFTER | HOLDS | READS, {"reference": REFERENCE, "condition": SIGNAL})
    (row,) = verdicts(rule, scene("left", 9.0))
    assert (row["verdict"], row["reason_code"], row["n_expected"]) == ("unknown", "window_truncated", 0)
    assert "s, and the log has the ego from 0.000 s to " in row["reason"]


@pytest.mark.ci
def test_the_window_may_be_a_parameter(tmp_path: Path) -> None:
    params = '[params.ahead_s]\ndefault = 1\nunit = "s"\nwhy = "a test"'
    rule = write(
        tmp_path,
        BEFORE | HOLDS | READS | {"window_s": '"ahead_s"'},
        {"reference": REFERENCE, "condition": SIGNAL},
        tables=params,
    )
    given = scene({"else": "left", "0.5": "off"}, 2.0)
    assert brief(verdicts(rule, given)) == [("pass", "kept")]
    assert brief(verdicts(rule, given, params={"ahead_s": 1.5})) == [("fail", "violated")]


@pytest.mark.ci
def test_many_windows_at_any_offset(tmp_path: Path) -> None:
    """Time buckets are an optimisation: every window sees exactly its steps, also where it straddles time zero."""
    rule = write(tmp_path, BEFORE | HOLDS | READS | {"window_s": "0.7"}, {"reference": REFERENCE, "condition": SIGNAL})
    at = [round(-2.0 + i * 0.3, 1) for i in range(20)]
    rows = verdicts(rule, scene("left", at, "-3..5 by 0.1"))
    assert [(r["verdict"], r["n_expected"]) for r in rows] == [("pass", 8)] * 20


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


@pytest.mark.ci
def test_references_of_two_drives_do_not_mix(tmp_path: Path) -> None:
    rule = write(
        tmp_path, PLACE_BEFORE | HOLDS | READS, {"reference": PLACE_REFERENCE, "anchor": ANCHOR, "condition": SIGNAL}
    )
    given = {
        "ego_state": [{"drive_id": d, "t_s": "0..4 by 0.1", "indicator": s} for d, s in (("a", "left"), ("b", "off"))],
        "exit_taken": [{"drive_id": d, "t_s": [2.0, 3.0], "t_sign_s": [1.0, 1.5], "side": "left"} for d in ("a", "b")],
    }
    rows = verdicts(rule, given)
    assert [(r["drive_id"], r["ref_id"], r["verdict"]) for r in rows] == [
        ("a", 0, "pass"),
        ("a", 1, "pass"),
        ("b", 0, "fail"),
        ("b", 1, "fail"),
    ]


def test_profiles_at_a_reference_point(tmp_path: Path) -> None:
    sql = """SELECT r.drive_id, r.ego_id, r.t_ns, r.ref_id, p.profile, 10 AS observed, p.pull_out_headroom_m AS required
        FROM reference r CROSS JOIN profile p WHERE p.selected AND p.profile <> 'lost'"""
    rule = write(
        tmp_path,
        EXECUTION | MEASURED | {"reads": '["exit_taken", "profile"]'},
        {"reference": REFERENCE, "condition": sql},
    )
    given = scene("off", 2.0) | {
        "profile": {"profile": ["lost", "hard", "easy"], "pull_out_headroom_m": [1, 15, 5], "selected": True}
    }
    assert [(r["profile"], r["verdict"], r["reason_code"]) for r in verdicts(rule, given)] == [
        ("easy", "pass", "kept"), ("hard", "fail", "violated"), ("lost", "unknown", "missing_step"),
    ]  # fmt: skip


@pytest.mark.ci
def test_a_window_over_objects(tmp_path: Path) -> None:
    header = BEFORE | MEASURED | PAIR
    rule = write(tmp_path, header, {"reference": REFERENCE, "condition": PAIR_SQL})
    times = "0..3 by 0.1"
    given = {
        "step": {"t_s": times},
        "exit_taken": {"t_s": 2.0},
        "pair": [
            {"t_s": times, "object_id": "a", "clearance_m": {"else": 3, "1.5": 2}},
            {"t_s": "1.6..3 by 0.1", "object_id": "b", "clearance_m": 0},
        ],
    }
    rows = verdicts(rule, given)
    assert [(r["object_id"], r["verdict"], r["n_expected"], r["t_worst_ns"]) for r in rows] == [
        ("a", "pass", 11, 1_500_000_000),
        ("b", "fail", 5, 1_600_000_000),
    ]


@pytest.mark.ci
def test_nobody_there_is_no_near_miss_and_loses_to_a_real_step(tmp_path: Path) -> None:
    header = BEFORE | MEASURED | PAIR | {"combine": '"all"', "near_margin": "0.5"}
    rule = write(tmp_path, header, {"reference": REFERENCE, "condition": PAIR_SQL})
    given: dict[str, Any] = {"step": {"t_s": "0..3 by 0.1"}, "exit_taken": {"t_s": 2.0}}
    (row,) = verdicts(rule, given)
    assert (row["verdict"], row["reason_code"], row["margin"], row["near_miss"]) == (
        "pass",
        "nobody_there",
        None,
        False,
    )
    (row,) = verdicts(rule, given | {"pair": {"t_s": [1.5, 1.6], "object_id": "a", "clearance_m": [3, 1.2]}})
    assert (row["verdict"], row["object_id"], row["t_worst_ns"], row["near_miss"]) == ("pass", "a", 1_600_000_000, True)


@pytest.mark.parametrize(
    ("combine", "expected"),
    [
        ("each", [("a", "pass", "kept"), ("b", "unknown", "lost_near_ego")]),
        ("all", [("b", "unknown", "lost_near_ego")]),
        ("any", [("a", "pass", "kept")]),
    ],
)
def test_an_object_that_was_lost_may_still_be_there(
    tmp_path: Path, combine: str, expected: list[tuple[str, str, str]]
) -> None:
    rule = write(
        tmp_path,
        BEFORE | MEASURED | PAIR | {"combine": f'"{combine}"'},
        {"reference": REFERENCE, "condition": PAIR_SQL},
    )
    times = "0..3 by 0.1"
    given = {
        "step": {"t_s": times},
        "exit_taken": {"t_s": 2.0},
        "pair": [
            {"t_s": times, "object_id": "a", "clearance_m": 3},
            {"t_s": "0..1.5 by 0.1", "object_id": "b", "clearance_m": 5},
        ],
        "lost_object": {"object_id": "b", "t_from_s": 1.5, "t_to_s": 3, "code": "lost_near_ego"},
    }
    rows = verdicts(rule, given)
    assert [(r["object_id"], r["verdict"], r["reason_code"]) for r in rows] == expected
    assert rows[-1]["n_expected"] == 11
