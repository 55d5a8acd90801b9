"""A finding is fixed only where the newer result looked: its ego and its object are recorded there."""

from __future__ import annotations

from datetime import date
from typing import Any

import pytest

from drivelint.gate import GateInputs, compare_results, descriptions, diff
from drivelint.result.gate import ComparedFinding
from drivelint.result.model import Result, exit_status
from tests.report.synthetic import SECOND, drive, finding, recorded, result, rule, verdict

CONTACT: dict[str, Any] = {
    "t_ref_ns": None, "t_start_ns": 111 * SECOND, "t_end_ns": 118 * SECOND, "t_worst_ns": 112 * SECOND,
}  # fmt: skip
BASE = result([verdict("fail", **CONTACT)], [finding(**CONTACT)])
PASS = verdict("pass", **CONTACT)
NEVER = verdict("not_applicable", object_id=None, profile=None, **dict.fromkeys(CONTACT))
BEFORE = verdict("pass", **CONTACT | {"t_start_ns": 100 * SECOND, "t_end_ns": 105 * SECOND, "t_worst_ns": 105 * SECOND})


def recorded_rows(
    ego_spans: list[tuple[float, float]], object_spans: list[tuple[float, float]]
) -> list[dict[str, Any]]:
    """When the ego and object 3 are recorded, in seconds of the drive."""
    spans = (("1", ego_spans), ("3", object_spans))
    return [
        row for actor_id, times in spans for a, b in times for row in recorded(actor_id, start_s=100 + a, end_s=100 + b)
    ]


def only(new: Result) -> ComparedFinding:
    (entry,) = diff.compare(BASE, new).entries
    return entry


WHOLE = [(0.0, 25.0)]


@pytest.mark.parametrize("verdict_row", [PASS, NEVER, BEFORE], ids=["pass", "never applicable", "passed before"])
@pytest.mark.parametrize(
    ("ego_spans", "object_spans", "standing", "why"),
    [
        (WHOLE, WHOLE, "fixed", ""),
        (WHOLE, [(11.5, 17.5)], "fixed", ""),
        (WHOLE, [(0.0, 14.0), (14.9, 25.0)], "fixed", ""),
        (WHOLE, [(0.0, 5.9)], "unknown", "object 3 is recorded only from 0.00 s to 5.90 s"),
        (WHOLE, [(0.0, 11.9)], "unknown", "object 3 is recorded"),
        (WHOLE, [(12.1, 25.0)], "unknown", "object 3 is recorded"),
        (WHOLE, [(0.0, 16.9)], "unknown", "object 3 is recorded"),
        ([(0.0, 10.4), (14.1, 25.0)], WHOLE, "unknown", "ego 1 is recorded only from 0.00 s to 10.40 s, 14.10 s to 25.00 s"),
        ([(0.0, 13.0), (14.1, 25.0)], WHOLE, "unknown", "ego 1 is recorded"),
        ([(0.0, 1.0), (2.0, 3.0), (4.0, 5.0), (6.0, 7.0), (8.0, 9.0)], WHOLE, "unknown", "4.00 s to 5.00 s and 2 more times"),
        (WHOLE, [], "lost", "object 3 is not in this log, or has another id"),
    ],
)  # fmt: skip
def test_kept_counts_only_where_both_are_recorded(
    ego_spans: list[tuple[float, float]],
    object_spans: list[tuple[float, float]],
    standing: str,
    why: str,
    verdict_row: dict[str, Any],
) -> None:
    entry = only(
        result([verdict_row], drives=[drive(sha256="ef" * 32, recorded=recorded_rows(ego_spans, object_spans))])
    )
    assert entry.standing == standing
    assert why in entry.why


def test_that_nobody_came_says_nothing_of_an_object_that_the_log_has_not() -> None:
    """No oncoming vehicle: the rule passes, without an object."""
    entry = only(result([verdict("pass", object_id=None)], drives=[drive(recorded=recorded("1", "2"))]))
    assert (entry.standing, entry.there) == ("lost", "none")


@pytest.mark.parametrize(
    "verdict_row", [verdict("unknown", **CONTACT), verdict("fail", n_expected=9, n_judged=5, **CONTACT)]
)
def test_the_rules_own_unknown_comes_first(verdict_row: dict[str, Any]) -> None:
    entry = only(result([verdict_row], drives=[drive(recorded=recorded("1", "3", end_s=106.0))]))
    assert (entry.standing, "recorded" in entry.why) == ("unknown", False)


def test_gone_and_not_recorded_is_exit_code_4() -> None:
    new = result([PASS], drives=[drive(recorded=recorded("1", "3", end_s=106.0))])
    assert exit_status(GateInputs(date(2026, 11, 26), BASE).apply_to(new)).code == 4
    found, failing = compare_results(BASE, new, ("a", "b"), "critical")
    assert descriptions.exit_code(found, failing, "critical") == 4


def less(base: Result, new: Result) -> str:
    return descriptions.judged_less_sentence(diff.compare(base, new))


DECIDED = [
    verdict("pass"),
    verdict("fail", object_id="4"),
    verdict("unknown", object_id="5"),
    verdict("pass", rule_id="m"),
]
RULES = [rule(), rule("m", severity="minor")]


@pytest.mark.parametrize(
    ("now", "message"),
    [
        (DECIDED, ""),
        ([*DECIDED, verdict("unknown", object_id="6")], ""),  # nothing was decided of it
        ([verdict("not_applicable"), *DECIDED[1:]], ""),
        ([verdict("unknown"), *DECIDED[1:]], "1 verdict unknown that was pass or fail before (1 critical)"),
        ([verdict("unknown"), verdict("error", object_id="4"), DECIDED[2], verdict("unknown", rule_id="m")],
         "3 verdicts unknown that were pass or fail before (2 critical)"),
        ([*DECIDED[:3], verdict("unknown", rule_id="m")], "1 verdict unknown that was pass or fail before"),
    ],
)  # fmt: skip
def test_what_is_judged_less_is_said(now: list[dict[str, Any]], message: str) -> None:
    found = less(result(DECIDED, rules=RULES), result(now, rules=RULES))
    assert found == (f"judged less than the baseline: {message}" if message else "")


def test_drives_and_rules_that_are_left_out_are_judged_less() -> None:
    base = result([verdict("pass"), verdict("pass", drive_id="d2")], drives=[drive(), drive("d2")], rules=RULES)
    new = result([verdict("pass", drive_id="d3")], drives=[drive("d3")])
    assert (
        less(base, new)
        == "judged less than the baseline: 2 drives of the baseline not checked, 1 rule of the baseline not selected"
    )
    assert less(new, base) == "judged less than the baseline: 1 drive of the baseline not checked"


def test_another_map_is_said_and_a_drive_that_was_perhaps_cut_off() -> None:
    base = result([PASS], drives=[drive(duration_s=14.0, map_sha256="a")])
    for now, message in (
        (drive(duration_s=13.0, map_sha256="a"), ""),
        (drive(duration_s=12.0, map_sha256="a"), "judged less than the baseline: 1 drive shorter by more than a tenth"),
        (drive(duration_s=14.0, map_sha256="b"), "judged on another map than in the baseline: 1 drive"),
        (drive(duration_s=14.0, map_sha256=None), "judged on another map than in the baseline: 1 drive"),
    ):
        assert less(base, result([PASS], drives=[now])) == message


def test_results_without_a_common_drive_say_so_and_count_no_more_unknowns() -> None:
    base = result([verdict("unknown")])
    new = result([verdict("unknown", drive_id="converted")], drives=[drive("converted")])
    found = diff.compare(base, new)
    assert found.new_unknowns == ()
    assert "The two results have no drive in common, by name or content" in descriptions.difference_text(
        found, [], "critical"
    )
    assert "The two results have no drive in common" not in descriptions.difference_text(
        diff.compare(base, base), [], "critical"
    )
