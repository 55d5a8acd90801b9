"""Invariants: truth tables with tiny scenes."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import pytest

from tests.evaluate.packs import HOLDS, INVARIANT, MEASURED, brief, findings, verdicts, write

if TYPE_CHECKING:
    from pathlib import Path

SPEED = {"reads": '["ego_state"]'}
SPEED_SQL = "SELECT drive_id, ego_id, t_ns, speed_mps AS observed, 10 AS required FROM ego_state"
GAP = {"reads": '["pair"]'}
GAP_SQL = "SELECT drive_id, ego_id, t_ns, object_id, clearance_m AS observed, 0 AS required FROM pair"


def speeds(values: list[Any], **more: Any) -> dict[str, Any]:
    return {
        "ego_state": {
            "t_s": [i / 10 for i in range(len(values))],
            "speed_mps": values,
            "x_m": list(range(len(values))),
            **more,
        }
    }


@pytest.mark.parametrize(
    ("sense", "value", "verdict"),
    [
        *((">", 10.0, "fail"), (">=", 10.0, "pass"), ("<", 10.0, "fail"), ("<=", 10.0, "pass")),
        *((">", 10.001, "pass"), ("<", 9.999, "pass")),
        *((">", 9.0, "fail"), (">=", 9.0, "fail"), ("<", 11.0, "fail"), ("<=", 11.0, "fail")),
    ],
)
def test_the_operator_decides_and_equality_fails_a_strict_one(
    tmp_path: Path, sense: str, value: float, verdict: str
) -> None:
    rule = write(tmp_path, INVARIANT | {"sense": f'"{sense}"', "unit": '"m/s"'} | SPEED, {"condition": SPEED_SQL})
    (row,) = verdicts(rule, speeds([value] * 3))
    assert row["verdict"] == verdict
    assert row["margin"] == pytest.approx((value - 10) if sense[0] == ">" else (10 - value))
    assert (row["n_expected"], row["n_judged"]) == (3, 3)


@pytest.mark.parametrize(
    ("values", "expected", "worst_s", "judged"),
    [
        ([12, 11, 13], ("pass", "kept"), 0.1, 3),
        ([12, 9, 8, 8], ("fail", "violated"), 0.2, 4),
        ([12, None, 13], ("unknown", "null_value"), 0.0, 2),
        ([12, None, 9], ("fail", "violated"), 0.2, 2),
        ([None, None], ("unknown", "null_value"), 0.0, 0),
        ([12, math.nan, 12], ("unknown", "null_value"), 0.0, 2),
        ([math.inf, 12], ("pass", "kept"), 0.1, 2),
        ([math.inf, math.inf], ("pass", "kept"), 0.0, 2),
        ([12, -math.inf], ("fail", "violated"), 0.1, 2),
    ],
)
def test_always(tmp_path: Path, values: list[Any], expected: tuple[str, str], worst_s: float, judged: int) -> None:
    rule = write(tmp_path, INVARIANT | MEASURED | SPEED, {"condition": SPEED_SQL})
    (row,) = verdicts(rule, speeds(values))
    assert brief([row]) == [expected]
    assert (row["t_worst_ns"], row["n_expected"], row["n_judged"]) == (round(worst_s * 1e9), len(values), judged)
    assert row["x_m"] == round(worst_s * 10)
    for column in ("observed", "required", "margin"):
        assert row[column] is None or math.isfinite(row[column])


@pytest.mark.parametrize(
    ("sense", "column", "verdict"),
    [
        ("<=", "observed", "unknown"),
        (">=", "required", "unknown"),
        (">=", "observed", "fail"),
        ("<=", "required", "fail"),
    ],
)
def test_negative_infinity_keeps_nothing(tmp_path: Path, sense: str, column: str, verdict: str) -> None:
    """It is no measure: where nothing was measured, a rule of an upper limit would pass."""
    values = {"observed": "1.0", "required": "1.0", column: "'-inf'::DOUBLE + 0 * speed_mps"}
    sql = f"SELECT drive_id, ego_id, t_ns, {values['observed']} AS observed, {values['required']} AS required FROM ego_state"
    rule = write(tmp_path, INVARIANT | {"sense": f'"{sense}"', "unit": '"m/s"'} | SPEED, {"condition": sql})
    (row,) = verdicts(rule, speeds([1.0, 1.0]))
    assert row["verdict"] == verdict


@pytest.mark.ci
def test_infinity_is_stored_as_null(tmp_path: Path) -> None:
    rule = write(tmp_path, INVARIANT | MEASURED | SPEED, {"condition": SPEED_SQL})
    (row,) = verdicts(rule, speeds([math.inf]))
    assert (row["verdict"], row["observed"], row["margin"], row["required"]) == ("pass", None, None, 10)
    assert "unlimited" in row["reason"]


@pytest.mark.parametrize(
    ("values", "expected", "worst_s"),
    [
        (["left", "left"], ("pass", "kept"), 0.0),
        (["left", "off", "off"], ("fail", "violated"), 0.1),
        (["left", None, "off"], ("fail", "violated"), 0.2),
        (["left", None, "left", None], ("unknown", "null_value"), 0.1),
    ],
)
def test_holds_takes_the_earliest_deciding_step(
    tmp_path: Path, values: list[Any], expected: tuple[str, str], worst_s: float
) -> None:
    sql = "SELECT drive_id, ego_id, t_ns, indicator = 'left' AS holds FROM ego_state"
    rule = write(tmp_path, INVARIANT | HOLDS | SPEED, {"condition": sql})
    (row,) = verdicts(rule, {"ego_state": {"t_s": [i / 10 for i in range(len(values))], "indicator": values}})
    assert brief([row]) == [expected]
    assert (row["t_worst_ns"], row["margin"]) == (round(worst_s * 1e9), None)


@pytest.mark.parametrize(
    ("sense", "value", "bound", "expected"),
    [
        (">", 12, True, ("pass", "kept")),
        (">", 9, True, ("unknown", "only_a_bound")),
        (">", 9, False, ("fail", "violated")),
        (">", 9, None, ("unknown", "only_a_bound")),
        (">=", 10, True, ("pass", "kept")),
        ("<", 12, True, ("fail", "violated")),
        ("<", 9, True, ("unknown", "only_a_bound")),
        ("<", 9, False, ("pass", "kept")),
        ("<=", 10, True, ("unknown", "only_a_bound")),
        (">", None, True, ("unknown", "null_value")),
    ],
)
def test_a_lower_bound_proves_what_it_can(
    tmp_path: Path, sense: str, value: Any, bound: Any, expected: tuple[str, str]
) -> None:
    sql = SPEED_SQL.replace(" FROM", ", with_direction AS at_least FROM")
    rule = write(tmp_path, INVARIANT | {"sense": f'"{sense}"', "unit": '"m/s"'} | SPEED, {"condition": sql})
    (row,) = verdicts(rule, speeds([value], with_direction=bound))
    assert brief([row]) == [expected]
    assert (row["margin"] is None) == (row["verdict"] == "unknown")


@pytest.mark.ci
def test_the_bound_that_is_told_is_that_of_the_undecided_step(tmp_path: Path) -> None:
    """The least margin of those that are decided is another step's."""
    sql = SPEED_SQL.replace(" FROM", ", with_direction AS at_least FROM")
    rule = write(tmp_path, INVARIANT | {"sense": '">"', "unit": '"m/s"'} | SPEED, {"condition": sql})
    (row,) = verdicts(rule, speeds([10.5, 8.0], with_direction=[False, True]))
    assert (row["reason_code"], row["observed"]) == ("only_a_bound", 10.5)
    assert row["reason"].startswith("Only a bound is known at 0.100 s (8 m/s, required more than 10 m/s)")


def test_a_row_that_an_inner_join_lost_is_unknown(tmp_path: Path) -> None:
    sql = SPEED_SQL + " WHERE limit_mps IS NOT NULL"
    rule = write(tmp_path, INVARIANT | MEASURED | SPEED, {"condition": sql})
    (row,) = verdicts(rule, speeds([12, 12, 12], limit_mps=[1, None, 1]))
    assert (row["verdict"], row["reason_code"], row["n_expected"], row["n_judged"]) == ("unknown", "missing_step", 3, 2)
    assert "0.100 s" in row["reason"]
    (row,) = verdicts(rule, speeds([12, 12, 9], limit_mps=[1, None, 1]))
    assert row["verdict"] == "fail"


def test_two_rows_for_a_step_are_refused(tmp_path: Path) -> None:
    sql = SPEED_SQL + " UNION ALL SELECT drive_id, ego_id, t_ns, 50, 10 FROM ego_state WHERE t_ns = 100000000"
    rule = write(tmp_path, INVARIANT | MEASURED | SPEED, {"condition": sql})
    (row,) = verdicts(rule, speeds([12, 12, 12]))
    assert row["verdict"] == "error"
    assert "2 rows for one step" in row["reason"]


@pytest.mark.ci
def test_a_doubled_row_cannot_stand_in_for_a_lost_one(tmp_path: Path) -> None:
    double = "SELECT drive_id, ego_id, t_ns, 50, 10 FROM ego_state WHERE t_ns = 100000000"
    sql = f"{SPEED_SQL} WHERE t_ns <> 200000000 UNION ALL {double}"
    rule = write(tmp_path, INVARIANT | MEASURED | SPEED, {"condition": sql})
    assert verdicts(rule, speeds([12, 12, 12, 12]))[0]["verdict"] == "error"


@pytest.mark.parametrize(
    ("applies", "expected"),
    [
        ([True, True, True], [("pass", "kept", 3)]),
        ([False, False, False], [("not_applicable", "not_triggered", 0)]),
        ([True, None, True], [("unknown", "applies_unknown", 3)]),
        ([False, True, True], [("fail", "violated", 2)]),
    ],
)
@pytest.mark.parametrize("own_grid", [False, True])
def test_applies_is_three_valued(
    tmp_path: Path, applies: list[Any], expected: list[tuple[str, str, int]], own_grid: bool
) -> None:
    values = [5, 12, 5] if expected[0][0] == "fail" else [12 if a is not False else 5 for a in applies]
    if own_grid:
        sections = {
            "applies": "SELECT drive_id, ego_id, t_ns, in_junction AS applies FROM ego_state",
            "condition": SPEED_SQL,
        }
    else:
        sections = {"condition": SPEED_SQL.replace(" FROM", ", in_junction AS applies FROM")}
    rule = write(tmp_path, INVARIANT | MEASURED | SPEED, sections)
    rows = verdicts(rule, speeds(values, in_junction=applies))
    assert [(r["verdict"], r["reason_code"], r["n_expected"]) for r in rows] == expected


def test_own_grid_that_is_no_step_is_an_error(tmp_path: Path) -> None:
    sections = {"applies": "SELECT drive_id, ego_id, t_ns + 1 AS t_ns FROM ego_state", "condition": SPEED_SQL}
    rule = write(tmp_path, INVARIANT | MEASURED | SPEED, sections)
    (row,) = verdicts(rule, speeds([12, 12]))
    assert row["verdict"] == "error"
    assert "no step of the ego" in row["reason"]


def test_a_gap_in_applicability_makes_two_episodes_but_a_short_one_does_not(tmp_path: Path) -> None:
    sql = SPEED_SQL.replace(" FROM", ", in_junction AS applies FROM")
    rule = write(tmp_path, INVARIANT | MEASURED | SPEED, {"condition": sql})
    here = [True, True, False, True, False, False, True, True]
    rows = verdicts(rule, speeds([12] * 8, in_junction=here))
    assert [(r["t_start_ns"], r["t_end_ns"], r["n_expected"], r["occurrence"]) for r in rows] == [
        (0, 300_000_000, 3, 0),
        (600_000_000, 700_000_000, 2, 1),
    ]


HOLE = {"ego_state": [{"t_s": "0..1 by 0.1", "speed_mps": 12}, {"t_s": "3..4 by 0.1", "speed_mps": 12}]}


def test_a_hole_splits_and_is_a_row_of_its_own(tmp_path: Path) -> None:
    rule = write(tmp_path, INVARIANT | MEASURED | SPEED, {"condition": SPEED_SQL})
    rows = verdicts(rule, HOLE)
    assert brief(rows) == [("pass", "kept"), ("unknown", "log_hole"), ("pass", "kept")]
    hole = rows[1]
    assert (hole["t_start_ns"], hole["t_end_ns"], hole["n_expected"], hole["n_judged"]) == (10**9, 3 * 10**9, 19, 0)


@pytest.mark.ci
def test_no_hole_row_where_the_rule_does_not_reach_the_hole(tmp_path: Path) -> None:
    sql = SPEED_SQL.replace(" FROM", ", in_junction AS applies FROM")
    rule = write(tmp_path, INVARIANT | MEASURED | SPEED, {"condition": sql})
    away = [
        HOLE["ego_state"][0] | {"in_junction": {"else": False, "0..0.3": True}},
        HOLE["ego_state"][1] | {"in_junction": {"else": False, "3.8..4": True}},
    ]
    assert brief(verdicts(rule, {"ego_state": away})) == [("pass", "kept"), ("pass", "kept")]
    near = [away[0], HOLE["ego_state"][1] | {"in_junction": True}]
    assert brief(verdicts(rule, {"ego_state": near})) == [("pass", "kept"), ("unknown", "log_hole"), ("pass", "kept")]


@pytest.mark.parametrize("there", ["0.8..1", "3..3.2"])
def test_a_rule_that_applies_on_one_side_of_a_hole_may_apply_in_it(tmp_path: Path, there: str) -> None:
    """As for a danger space that is left while nothing is recorded: what was not seen is no pass."""
    sql = SPEED_SQL.replace(" FROM", ", in_junction AS applies FROM")
    rule = write(tmp_path, INVARIANT | MEASURED | SPEED, {"condition": sql})
    one_side = [block | {"in_junction": {"else": False, there: True}} for block in HOLE["ego_state"]]
    rows = verdicts(rule, {"ego_state": one_side})
    assert sorted(brief(rows)) == [("pass", "kept"), ("unknown", "log_hole")]
    assert {(r["t_start_ns"], r["t_end_ns"]) for r in rows if r["verdict"] == "unknown"} == {(10**9, 3 * 10**9)}


@pytest.mark.parametrize(("seen_s", "holes"), [("3..4 by 0.1", 1), ("3.5..4 by 0.1", 0)])
def test_an_object_that_is_not_seen_behind_a_hole_is_lost_and_not_in_the_hole(
    tmp_path: Path, seen_s: str, holes: int
) -> None:
    sql = GAP_SQL.replace(" FROM", ", clearance_m < 2.5 AS applies FROM")
    rule = write(tmp_path, INVARIANT | MEASURED | GAP, {"condition": sql})
    near = {"t_s": "0..1 by 0.1", "object_id": "b", "clearance_m": 2}
    far = {"t_s": seen_s, "object_id": "b", "clearance_m": 9}
    rows = verdicts(rule, {"step": [{"t_s": "0..1 by 0.1"}, {"t_s": "3..4 by 0.1"}], "pair": [near, far]})
    assert brief(rows) == [("pass", "kept"), ("unknown", "log_hole")][: 1 + holes]


@pytest.mark.parametrize("near_s", ["0..1 by 0.1", "3..4 by 0.1"])
def test_an_object_that_a_rule_was_about_up_to_a_hole_is_not_left_unsaid_because_the_hole_ends_its_track(
    tmp_path: Path, near_s: str
) -> None:
    """A rule with a section @applies has no row for lost objects; the danger space of a car that is not seen behind the hole passed."""
    own = "SELECT drive_id, ego_id, t_ns, object_id FROM pair WHERE clearance_m < 2.5"
    rule = write(tmp_path, INVARIANT | MEASURED | GAP, {"applies": own, "condition": GAP_SQL})
    near = {"t_s": near_s, "object_id": "b", "clearance_m": 2}
    rows = verdicts(rule, {"step": [{"t_s": "0..1 by 0.1"}, {"t_s": "3..4 by 0.1"}], "pair": near})
    assert sorted(brief(rows)) == [("pass", "kept"), ("unknown", "log_hole")]
    assert {(r["t_start_ns"], r["t_end_ns"]) for r in rows if r["verdict"] == "unknown"} == {(10**9, 3 * 10**9)}


def pairs(o1: list[Any], o2: list[Any]) -> dict[str, Any]:
    times = [i / 10 for i in range(len(o1))]
    blocks = [
        {"t_s": t, "object_id": o, "clearance_m": c}
        for o, cs in (("1", o1), ("2", o2))
        for t, c in zip(times, cs, strict=True)
        if c != "absent"
    ]
    return {"step": {"t_s": times}, "pair": blocks}


def test_objects_are_judged_each_on_their_own_steps(tmp_path: Path) -> None:
    rule = write(tmp_path, INVARIANT | MEASURED | GAP, {"condition": GAP_SQL})
    rows = verdicts(rule, pairs([3, 2, 3, 3], ["absent", 1, 0, None]))
    assert [(r["object_id"], r["verdict"], r["n_expected"], r["n_judged"]) for r in rows] == [
        ("1", "pass", 4, 4),
        ("2", "fail", 3, 2),
    ]
    assert verdicts(rule, {"step": {"t_s": "0..1 by 0.1"}})[0]["reason_code"] == "not_triggered"


def test_a_pair_that_the_condition_leaves_out_is_unknown(tmp_path: Path) -> None:
    rule = write(tmp_path, INVARIANT | MEASURED | GAP, {"condition": GAP_SQL + " WHERE object_id = '1'"})
    rows = verdicts(rule, pairs([3, 3], [3, 3]))
    assert [(r["object_id"], r["verdict"], r["reason_code"]) for r in rows] == [
        ("1", "pass", "kept"),
        ("2", "unknown", "missing_step"),
    ]


def test_lost_objects_are_unknown_from_there_on(tmp_path: Path) -> None:
    rule = write(tmp_path, INVARIANT | MEASURED | GAP, {"condition": GAP_SQL})
    given = pairs([3, 3, 3, 3, 3, 3], [2, 2, 2, "absent", "absent", "absent"])
    given["lost_object"] = {"object_id": "2", "t_from_s": 0.2, "t_to_s": 0.5, "code": "lost_near_ego"}
    rows = verdicts(rule, given)
    assert [(r["object_id"], r["verdict"], r["reason_code"]) for r in rows] == [
        ("1", "pass", "kept"), ("2", "pass", "kept"), ("2", "unknown", "lost_near_ego"),
    ]  # fmt: skip
    assert (rows[2]["t_start_ns"], rows[2]["t_end_ns"], rows[2]["n_expected"], rows[2]["n_judged"]) == (
        200_000_000,
        500_000_000,
        3,
        0,
    )
    assert rows[2]["t_worst_ns"] == 199_999_999  # the last step at which it is there, in a real log
    assert (
        rows[2]["reason"] == "object 2 is recorded only until 0.200 s, but the ego until 0.500 s: record it for as long"
    )


@pytest.mark.ci
def test_own_grid_labels_episodes(tmp_path: Path) -> None:
    sections = {
        "applies": "SELECT drive_id, ego_id, t_ns, lanelet_id AS episode FROM ego_state",
        "condition": SPEED_SQL,
    }
    rule = write(tmp_path, INVARIANT | MEASURED | SPEED, sections)
    rows = verdicts(rule, speeds([12, 12, 9, 9, 12, 12], lanelet_id=["pulling_out"] * 3 + ["passing"] * 3))
    assert [(r["verdict"], r["n_expected"]) for r in rows] == [("fail", 3), ("fail", 3)]
    assert rows[0]["reason"].startswith("pulling out: 9 m at 0.200 s")
    (finding,) = findings(rule, speeds([12, 12, 9, 9, 12, 12], lanelet_id=["pulling_out"] * 3 + ["passing"] * 3))
    assert (finding["t_start_ns"], finding["t_end_ns"]) == (200_000_000, 300_000_000)


@pytest.mark.ci
def test_a_failed_episode_names_its_own_findings(tmp_path: Path) -> None:
    """Not those of another label at the same time, and a finding over two labels is of both."""
    sections = {
        "applies": """SELECT drive_id, ego_id, t_ns, unnest(string_split(lanelet_id, ' ')) AS episode FROM ego_state
            WHERE lanelet_id IS NOT NULL""",
        "condition": SPEED_SQL,
    }
    rule = write(tmp_path, INVARIANT | MEASURED | SPEED | {"merge_gap_s": "0"}, sections)
    scene = speeds([12, 9, 12, 9, 12, 9, 12], lanelet_id=["a", "a", "a b", "b", "a b", "a b", "a"])
    one, two, both = (found["finding_id"] for found in findings(rule, scene))
    rows = verdicts(rule, scene)
    assert [(row["t_start_ns"] // 10**8, row["t_end_ns"] // 10**8) for row in rows] == [(0, 6), (2, 5)]
    assert [row["finding_ids"] for row in rows] == [[one, both], [two, both]]
    (kept,) = verdicts(rule, speeds([12, 12], lanelet_id=["a", "a"]))
    assert (kept["verdict"], kept["finding_ids"]) == ("pass", [])


def test_profiles_are_judged_each_and_a_lost_one_is_unknown(tmp_path: Path) -> None:
    sql = """SELECT e.drive_id, e.ego_id, e.t_ns, p.profile, e.speed_mps AS observed, p.pull_out_headroom_m AS required
        FROM ego_state e CROSS JOIN profile p WHERE p.selected AND p.pull_out_headroom_m IS NOT NULL"""
    rule = write(tmp_path, INVARIANT | MEASURED | {"reads": '["ego_state", "profile"]'}, {"condition": sql})
    profile = {
        "profile": ["easy", "hard", "lost", "other"],
        "pull_out_headroom_m": [5, 15, None, 5],
        "selected": [True, True, True, False],
    }
    rows = verdicts(rule, speeds([12, 12]) | {"profile": profile})
    assert [(r["profile"], r["verdict"], r["reason_code"]) for r in rows] == [
        ("easy", "pass", "kept"), ("hard", "fail", "violated"), ("lost", "unknown", "missing_step"),
    ]  # fmt: skip


def test_the_start_of_an_episode_is_exempt_unless_it_was_not_seen(tmp_path: Path) -> None:
    header = INVARIANT | MEASURED | SPEED | {"exempt_after_s": "0.2"}
    rule = write(tmp_path, header, {"condition": SPEED_SQL.replace(" FROM", ", in_junction AS applies FROM")})
    begins_inside = [False, False, False, True, True, True, True]
    (row,) = verdicts(rule, speeds([12, 12, 12, 9, 9, 12, 12], in_junction=begins_inside))
    assert (row["verdict"], row["n_expected"], row["t_start_ns"]) == ("pass", 2, 500_000_000)
    (row,) = verdicts(rule, speeds([12, 12, 12, 9, 9, 9, 12], in_junction=begins_inside))
    assert (row["verdict"], row["n_expected"]) == ("fail", 2)
    (row,) = verdicts(rule, speeds([9, 9, 12, 12], in_junction=True))
    assert (row["verdict"], row["n_expected"]) == ("fail", 4)


def test_failing_stretches_are_findings_and_close_ones_are_one(tmp_path: Path) -> None:
    values = [12] * 40
    for i in (3, 4, 8, 30):
        values[i] = 9
    loose = write(tmp_path, INVARIANT | MEASURED | SPEED | {"merge_gap_s": "0"}, {"condition": SPEED_SQL}, name="loose")
    joined = write(
        tmp_path, INVARIANT | MEASURED | SPEED | {"merge_gap_s": "1"}, {"condition": SPEED_SQL}, name="joined"
    )
    spans = [
        [(f["t_start_ns"] // 10**8, f["t_end_ns"] // 10**8, f["occurrence"]) for f in findings(r, speeds(values))]
        for r in (loose, joined)
    ]
    assert spans == [[(3, 4, 0), (8, 8, 1), (30, 30, 2)], [(3, 8, 0), (30, 30, 1)]]
    ids = [f["finding_id"] for f in findings(loose, speeds(values))]
    assert len(set(ids)) == 3
    assert all(len(i) == 16 and int(i, 16) >= 0 for i in ids)


def test_near_misses_and_requirements(tmp_path: Path) -> None:
    rule = write(
        tmp_path,
        INVARIANT | MEASURED | SPEED | {"near_margin": "1.0", "requires": '["indicator", "map"]'},
        {"condition": SPEED_SQL},
    )
    assert verdicts(rule, speeds([10.5]))[0]["near_miss"] is True
    assert verdicts(rule, speeds([11.0]))[0]["near_miss"] is False
    assert verdicts(rule, speeds([9.9]))[0]["near_miss"] is False
    (row,) = verdicts(rule, speeds([9.0]), missing=("map",))
    assert (row["verdict"], row["reason_code"], row["reason"]) == ("unknown", "missing_map", "no map in this log")


def test_sql_that_raises_is_an_error_of_that_rule(tmp_path: Path) -> None:
    rule = write(
        tmp_path, INVARIANT | MEASURED | SPEED, {"condition": SPEED_SQL.replace("speed_mps", "lanelet_id::DOUBLE")}
    )
    (row,) = verdicts(rule, speeds([12], lanelet_id="fast"))
    assert (row["verdict"], row["reason_code"]) == ("error", "rule_error")
    assert "pack.rule" in row["reason"]
    assert "fast" in row["reason"]


@pytest.mark.ci
def test_the_authors_reason_is_kept_where_it_decides(tmp_path: Path) -> None:
    sql = SPEED_SQL.replace(
        " FROM", ", lanelet_id AS reason, CASE WHEN lanelet_id <> 'b' THEN upper(lanelet_id) END AS reason_code FROM"
    )
    rule = write(tmp_path, INVARIANT | MEASURED | SPEED, {"condition": sql})
    (row,) = verdicts(rule, speeds([12, 11, None], lanelet_id=["a", "b", "c"]))
    assert (row["verdict"], row["reason_code"], row["reason"]) == ("unknown", "C", "c")
    (row,) = verdicts(rule, speeds([12, 11], lanelet_id=["a", "b"]))
    assert (row["verdict"], row["reason_code"], row["reason"]) == ("pass", "kept", "b")


@pytest.mark.ci
def test_unlimited_on_both_sides_has_no_margin(tmp_path: Path) -> None:
    sql = "SELECT drive_id, ego_id, t_ns, speed_mps AS observed, speed_mps AS required FROM ego_state"
    header = INVARIANT | {"sense": '">="', "unit": '"m"', "near_margin": "1.0"} | SPEED
    (row,) = verdicts(write(tmp_path, header, {"condition": sql}), speeds([math.inf]))
    assert (row["verdict"], row["margin"], row["near_miss"]) == ("pass", None, False)


@pytest.mark.ci
def test_times_off_the_grid_are_refused_also_where_the_start_is_exempt(tmp_path: Path) -> None:
    sections = {"applies": "SELECT drive_id, ego_id, t_ns + 1 AS t_ns FROM ego_state", "condition": SPEED_SQL}
    rule = write(tmp_path, INVARIANT | MEASURED | SPEED | {"exempt_after_s": "0.2"}, sections)
    assert verdicts(rule, speeds([12, 12]))[0]["verdict"] == "error"
