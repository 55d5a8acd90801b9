"""Two results: what is new gates, what cannot be told any more is not fixed."""

from __future__ import annotations

import json
from datetime import date
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from drivelint.gate import GateInputs, compare_results, descriptions, diff
from drivelint.result import gate as store
from drivelint.result import model
from drivelint.result.gate import DIFF_STATUSES, NOT_FIXED_WORDS, ComparedFinding, Gate, Waiver
from drivelint.result.model import Result
from tests.report.synthetic import SECOND, drive, finding, recorded, result, rule, verdict

SPEED = "ukhc.r124.speed-limit"
RULES = [rule(), rule(SPEED, kind="invariant", unit="m/s", profiles=[])]


def at(start: float, end: float | None = None, **over: Any) -> dict[str, Any]:
    """A finding of the speed rule from `start` to `end` seconds into the drive."""
    t = {"t_start_ns": start, "t_end_ns": start if end is None else end, "t_worst_ns": start}
    times = {name: round((100 + s) * SECOND) for name, s in t.items()}
    base = {"rule_id": SPEED, "kind": "invariant", "profile": None, "object_id": None, "ref_id": None, "unit": "m/s"}
    return finding(**(base | times | {"x_m": 10.0 * start, "y_m": 0.0} | over))


def speed_verdict(verdict_: str, start: float = 0.0, end: float = 25.0, **over: Any) -> dict[str, Any]:
    """A verdict of the speed rule from `start` to `end` seconds into the drive."""
    times = {
        name: round((100 + s) * SECOND) for name, s in (("t_start_ns", start), ("t_end_ns", end), ("t_worst_ns", end))
    }
    base = {"rule_id": SPEED, "kind": "invariant", "profile": None, "object_id": None, "ref_id": None, "t_ref_ns": None}
    return verdict(verdict_, **(base | times | over))


def run(findings: list[dict[str, Any]], *verdicts: dict[str, Any], **more: Any) -> Result:
    told = list(verdicts) or [speed_verdict("fail", n_expected=9, n_judged=9) if findings else speed_verdict("pass")]
    return result(told, findings, rules=more.pop("rules", RULES), **more)


def standings(base: Result, new: Result) -> list[tuple[str, float, str]]:
    return [(e.standing, e.t_s, e.there) for e in diff.compare(base, new).entries]


def only(base: Result, new: Result) -> ComparedFinding:
    (entry,) = diff.compare(base, new).entries
    return entry


def test_the_same_finding_is_unchanged() -> None:
    assert standings(run([at(8)]), run([at(8)])) == [("unchanged", 8.0, "fail")]


def test_an_earlier_finding_that_moves_the_ids_is_the_new_one() -> None:
    """Ids number the findings of a drive: with a new one before it, the old one has another id."""
    base, new = run([at(10, finding_id="first")]), run([at(5, finding_id="first"), at(10, finding_id="second")])
    assert standings(base, new) == [("new", 5.0, "pass"), ("unchanged", 10.0, "fail")]


def test_one_fixed_and_another_broken_is_not_one_changed() -> None:
    """Though both are the first of their drive and so have the same id."""
    assert standings(run([at(10)]), run([at(5)])) == [("new", 5.0, "pass"), ("fixed", 10.0, "pass")]


@pytest.mark.parametrize(("moved_s", "same"), [(0.99, True), (1.01, False)])
def test_so_close_in_time_is_the_same(moved_s: float, same: bool) -> None:
    entries = diff.compare(run([at(8)]), run([at(8 + moved_s)])).counts()
    assert (entries["new"], entries["fixed"]) == ((0, 0) if same else (1, 1))


@pytest.mark.parametrize(
    ("columns", "same"),
    [
        ({"x_m": 84.9}, True),
        ({"x_m": 85.1}, False),
        ({"y_m": -5.1}, False),
        ({"x_m": None}, True),
        ({"t_worst_ns": round(108.9 * SECOND), "t_end_ns": round(108.9 * SECOND)}, True),
        ({"t_worst_ns": round(109.1 * SECOND), "t_end_ns": round(109.1 * SECOND)}, False),
        ({"object_id": "3"}, False),
        ({"ego_id": "2"}, False),
        ({"profile": "nominal"}, False),
    ],
)
def test_in_another_log_of_the_same_name_the_place_must_agree_too(columns: dict[str, Any], same: bool) -> None:
    base = run([at(8)])
    again = {"drive_id": "d1-again", "finding_id": "other"}
    new = run([at(8, **(again | columns))], speed_verdict("fail", **again_only(again)), drives=[again_drive()])
    counted = diff.compare(base, new).counts()
    assert counted["new"] == (0 if same else 1)
    assert sum(counted[gone] for gone in ("fixed", *NOT_FIXED_WORDS)) == (0 if same else 1)


def again_only(row: dict[str, Any]) -> dict[str, Any]:
    return {"drive_id": row["drive_id"], "n_expected": 9, "n_judged": 9}


def again_drive(**over: Any) -> dict[str, Any]:
    return drive("d1-again", file_name="d1.csv", sha256="ef" * 32, **over)


def test_in_another_log_a_long_stretch_is_the_same_by_its_time() -> None:
    """Its worst step may be anywhere in it."""
    there = {"drive_id": "d1-again", "x_m": 500.0}
    new = run(
        [at(8.2, 18, t_worst_ns=118 * SECOND, **there)],
        speed_verdict("fail", drive_id="d1-again"),
        drives=[again_drive()],
    )
    assert only(run([at(8, 18)]), new).standing == "changed"
    short = run(
        [at(8.2, 12, t_worst_ns=112 * SECOND, **there)],
        speed_verdict("fail", drive_id="d1-again"),
        drives=[again_drive()],
    )
    assert diff.compare(run([at(8, 18)]), short).counts()["new"] == 0, "a part of what was one"


def test_times_are_those_since_the_log_began() -> None:
    late = drive("d1-again", file_name="d1.csv", sha256="ef" * 32, t_start_ns=900 * SECOND)
    times = dict.fromkeys(("t_start_ns", "t_end_ns", "t_worst_ns"), 908 * SECOND)
    new = run([at(8, drive_id="d1-again", **times)], speed_verdict("fail", drive_id="d1-again"), drives=[late])
    assert only(run([at(8)]), new).standing == "unchanged"


def test_the_same_log_under_another_name_is_the_same_drive() -> None:
    same = drive("renamed", file_name="renamed.csv", sha256="ab" * 32)
    found = diff.compare(run([at(8)]), run([at(8, drive_id="renamed")], drives=[same]))
    assert ([e.standing for e in found.entries], found.base_only, found.new_only) == (["unchanged"], (), ())
    twins = [same, same | {"drive_id": "again"}]
    assert diff.compare(run([at(8)]), run([], drives=twins)).new_only == ("renamed",)


def test_a_file_stem_that_two_drives_have_names_neither() -> None:
    twins = [drive("d1-a", file_name="d1.csv"), drive("d1-b", file_name="d1.csv")]
    new = run([at(8, drive_id="d1-a")], speed_verdict("fail", drive_id="d1-a"), drives=twins)
    found = diff.compare(run([at(8)]), new)
    assert [(e.standing, e.why) for e in found.entries] == [
        ("new", "the drive was not checked"), ("lost", "the drive was not checked"),
    ]  # fmt: skip
    assert (found.base_only, found.new_only) == (("d1",), ("d1-a", "d1-b"))


@pytest.mark.parametrize(
    ("over", "why"),
    [
        ({}, ""),
        ({"margin": -6.009}, ""),
        ({"margin": -6.7}, "margin -6.70 m/s, was -6.00 m/s"),
        ({"margin": None}, "margin -, was -6.00 m/s"),
        ({"margin": float("-inf")}, "margin -inf m/s, was -6.00 m/s"),
        ({"t_end_ns": round(108.05 * SECOND)}, ""),
        ({"t_end_ns": round(108.2 * SECOND)}, "8.00 s to 8.20 s, was 8.00 s to 8.00 s"),
        ({"severity": "minor"}, "severity minor, was critical"),
    ],
)
def test_changed_is_more_than_can_be_overlooked(over: dict[str, Any], why: str) -> None:
    entry = only(run([at(8)]), run([at(8, **over)]))
    assert (entry.standing, entry.why) == ("changed" if why else "unchanged", why)


@pytest.mark.parametrize(
    ("margin", "worse"), [(-6.7, True), (-6.009, False), (-5.0, False), (None, False), (float("-inf"), True)]
)
def test_worse_is_more_than_can_be_overlooked(margin: float | None, worse: bool) -> None:
    found = diff.compare(run([at(8, 10)]), run([at(8, 12, margin=margin)]))
    assert [entry.worse for entry in found.entries] == [worse]
    assert descriptions.difference_headline(found) == f"0 new, 1 changed{' (1 worse)' if worse else ''}"


def test_what_still_fails_at_another_step_is_a_class_of_its_own() -> None:
    """Of two findings close together one is left, another step of it the worst."""
    base, new = run([at(8), at(8.5, finding_id="second")]), run([at(8.2)])
    entry = next(e for e in diff.compare(base, new).entries if e.standing == "elsewhere")
    assert (entry.base_id, entry.there) == ("second", "fail")
    told = descriptions.difference_text(diff.compare(base, new), [], "critical")
    assert "gone but not fixed: 1 still failing elsewhere" in told
    assert "Not fixed: the rule still fails, at another step or place (1)" in told
    assert "Not fixed: now unknown" not in told
    gone = model.exit_status(GateInputs(date(2026, 11, 26), base).apply_to(new))
    assert (gone.code, gone.why[-31:]) == (4, "not fixed: 1 still failing elsewhere"[-31:])


def test_a_stretch_that_falls_apart_is_nothing_new() -> None:
    base, new = run([at(8, 18)]), run([at(8, 10), at(16, 18, finding_id="second")])
    assert [e.standing for e in diff.compare(base, new).entries] == ["changed", "changed"]


def test_stretches_that_become_one_are_all_accounted_for() -> None:
    base, new = run([at(8, 10), at(16, 18, finding_id="second")]), run([at(8, 18, finding_id="whole")])
    entries = diff.compare(base, new).entries
    assert [(e.standing, e.finding_id) for e in entries] == [("changed", "whole"), ("changed", "whole")]
    assert {e.base_id for e in entries} == {f"d1-{SPEED}-None-0", "second"}


OPEN = speed_verdict("unknown", 5, 12, reason="the limit is not known")


@pytest.mark.parametrize(
    ("new", "standing", "there", "why"),
    [
        (run([], speed_verdict("pass")), "fixed", "pass", "because pass"),
        (run([], speed_verdict("pass", 0, 4)), "fixed", "not_applicable", "The rule does not apply there."),
        (run([], verdict("not_applicable", rule_id=SPEED, profile=None, t_start_ns=None, t_end_ns=None, t_worst_ns=None,
                         t_ref_ns=None, object_id=None, reason="never")), "fixed", "not_applicable", "never"),
        (run([], speed_verdict("pass", 0, 4), OPEN), "unknown", "unknown", "the limit is not known"),
        (run([], speed_verdict("pass"), OPEN), "unknown", "unknown", "the limit is not known"),
        (run([], speed_verdict("pass"), speed_verdict("unknown", 15, 20)), "fixed", "pass", "because pass"),
        (run([], speed_verdict("error", t_start_ns=None, t_end_ns=None, t_worst_ns=None)), "unknown", "error", "because error"),
        (run([at(20)], speed_verdict("fail", n_expected=9, n_judged=9)), "fixed", "pass", "the rule is kept at this time, but"),
        (run([at(20)], speed_verdict("fail", n_expected=9, n_judged=7)), "unknown", "unknown", "2 of 9 steps were not judged"),
        (run([], speed_verdict("pass"), rules=RULES[:1]), "lost", "none", "the rule was not run"),
        (run([], speed_verdict("pass", ego_id="2")), "lost", "none", "ego 1 was not judged"),
        (run([], verdict("pass")), "lost", "none", "the rule has no verdict"),
        (run([], speed_verdict("pass"), drives=[drive(duration_s=5.0)]), "lost", "none", "the log ends before the finding"),
        (run([], drives=[drive(status="not_judged", status_reason="no ego")]), "unknown", "unknown", "no ego"),
        (run([], drives=[drive("d2")]), "lost", "none", "the drive was not checked"),
    ],
)  # fmt: skip
def test_gone_is_fixed_only_where_it_was_looked_at(new: Result, standing: str, there: str, why: str) -> None:
    entry = diff.compare(run([at(8)]), new).entries[-1]
    assert (entry.standing, entry.there) == (standing, there)
    assert why in entry.why


def test_a_profile_that_was_not_run_fixes_nothing() -> None:
    base = result([verdict("fail")], [finding()])
    new = result([verdict("pass", profile="relaxed")], rules=[rule(profiles=["relaxed"])])
    assert (only(base, new).standing, only(base, new).why) == ("lost", "the profile nominal was not run")


@pytest.mark.parametrize(("row", "standing"), [
    (verdict("pass"), "fixed"),
    (verdict("pass", object_id="4"), "fixed"),  # object 3 is in the log still: the rule has nothing to say about it
    (verdict("unknown", object_id="4"), "unknown"),
    (verdict("unknown", object_id=None), "unknown"),
    (verdict("unknown", profile=None, t_ref_ns=None, t_start_ns=None, t_end_ns=None, t_worst_ns=None), "unknown"),
])  # fmt: skip
def test_what_is_said_of_another_object(row: dict[str, Any], standing: str) -> None:
    assert only(result([verdict("fail")], [finding()]), result([row])).standing == standing


def test_an_unknown_of_another_object_does_not_open_what_is_judged() -> None:
    rows = [verdict("pass"), verdict("unknown", object_id="4")]
    assert only(result([verdict("fail")], [finding()]), result(rows)).standing == "fixed"


def test_an_object_that_is_not_in_another_log_is_not_fixed() -> None:
    again = {"drive_id": "d1-again"}
    new = result([verdict("pass", object_id="4", **again)], drives=[again_drive(recorded=recorded("1", "4"))])
    entry = only(result([verdict("fail")], [finding()]), new)
    assert (entry.standing, entry.why) == ("lost", "object 3 is not in this log, or has another id")
    assert entry.drive_id == "d1-again"


def test_a_changed_rule_is_named_as_a_cause() -> None:
    entry = only(run([at(8)]), run([], rules=[RULES[0], RULES[1] | {"rule_version": "w"}]))
    assert entry.why == "because pass The rule or its parameters changed."


def test_unknowns_that_appeared_are_counted_with_their_reason() -> None:
    base = run([], speed_verdict("pass"), speed_verdict("unknown", 1, 2, occurrence=1, reason="dark"))
    new = run(
        [],
        speed_verdict("unknown", reason="fog"),
        speed_verdict("unknown", 1, 2, reason="fog"),
        speed_verdict("unknown", 3, 4, reason="dark"),
    )
    (opened,) = diff.compare(base, new).new_unknowns
    assert (opened.rule_id, opened.n, opened.base_n, opened.reason, opened.stable) == (SPEED, 3, 1, "fog", True)
    assert diff.compare(new, base).new_unknowns == ()
    said_ = descriptions.difference_text(diff.compare(base, new), [], "critical")
    assert (
        "Verdicts that are unknown now and were not before (2); unknown does not mean pass\n  2: ukhc.r124.speed-limit: fog"
        in said_
    )


def gating(base: Result, new: Result, fail_on: str) -> list[str]:
    return [entry.finding_id for entry in compare_results(base, new, ("a", "b"), fail_on)[1]]


def test_only_new_findings_of_stable_rules_at_or_above_the_severity_gate() -> None:
    rules = [*RULES, rule("ukhc.draft", status="draft")]
    minor = at(5, finding_id="minor", severity="minor")
    draft = finding(rule_id="ukhc.draft", finding_id="draft")
    base, new = run([at(8)], rules=rules), run([at(8), at(15, finding_id="new"), minor, draft], rules=rules)
    assert gating(base, new, "critical") == ["new"]
    assert gating(base, new, "minor") == ["new", "minor"]
    assert gating(base, new, "never") == []
    waiver = Waiver("w:1", "*", "because", "jo", "2027-01-01")
    waived = run([at(8), at(15, finding_id="new")], rules=rules, gate=Gate("2026-01-01", None, (waiver,), {"new": 0}))
    assert gating(base, waived, "critical") == []


def test_json_holds_every_entry_and_the_counts() -> None:
    found = diff.compare(run([at(8), at(12, finding_id="x")]), run([at(8, margin=-20.0), at(15, finding_id="n")]))
    told = json.loads(descriptions.to_json(found, found.with_diff_status("new"), "critical"))
    assert told["counts"] == {
        "new": 1,
        "changed": 1,
        "unchanged": 0,
        "fixed": 1,
        "elsewhere": 0,
        "unknown": 0,
        "lost": 0,
    }
    assert told["gating"] == ["n"]
    assert told["exit"] == {"code": 1, "why": "1 new finding at or above severity critical"}
    assert [entry["standing"] for entry in told["entries"]] == ["changed", "new", "fixed"]
    assert told["verdicts"].keys() == {"pass", "fail", "unknown", "not_applicable", "error"}


def test_text_says_what_is_not_fixed() -> None:
    told = descriptions.difference_text(diff.compare(run([at(8)]), run([], OPEN)), [], "critical")
    assert "gone but not fixed: 1 unknown now" in told
    assert "Not fixed: now unknown (1)" in told
    assert "(now unknown: the limit is not known)" in told
    assert told.endswith(
        "exit 4: no new finding at or above severity critical, but 1 earlier finding gone but not fixed"
    )


@given(st.lists(st.tuples(st.integers(0, 24), st.integers(0, 6), st.sampled_from("34")), max_size=8),
       st.lists(st.tuples(st.integers(0, 24), st.integers(0, 6), st.sampled_from("34")), max_size=8), st.booleans())  # fmt: skip
def test_every_finding_of_both_is_one_entry(
    base: list[tuple[int, int, str]], new: list[tuple[int, int, str]], same_log: bool
) -> None:
    def run_with_findings(rows: list[tuple[int, int, str]], sha: str) -> Result:
        found = [
            at(s, min(s + n, 25), object_id=who, finding_id=f"f{i}") for i, (s, n, who) in enumerate(sorted(set(rows)))
        ]
        return run(found, drives=[drive(sha256=sha)])

    a, b = run_with_findings(base, "aa"), run_with_findings(new, "aa" if same_log else "bb")
    found = diff.compare(a, b)
    ours = [e.finding_id for e in found.entries if e.standing in {"new", "changed", "unchanged"}]
    assert set(ours) == set(b.findings["finding_id"].to_pylist())
    theirs = [e.base_id for e in found.entries if e.base_id is not None]
    assert set(theirs) == set(a.findings["finding_id"].to_pylist())
    assert sum(found.counts().values()) == len(found.entries)
    assert {e.standing for e in diff.compare(a, a).entries} <= {"unchanged"}
    assert set(found.counts()) == set(DIFF_STATUSES)


def test_a_gate_survives_its_file() -> None:
    found = diff.compare(run([at(8)]), run([at(8), at(15, finding_id="n", margin=float("-inf"))]))
    waiver = Waiver("w:1", "*", "because", "jo", "2027-01-01", from_s=1.0)
    gate = Gate("2026-11-20", found, (waiver,), {"n": 0})
    assert gate.is_in_baseline(f"d1-{SPEED}-None-0")  # fills what is remembered, which must not reach the file
    content = store.render(gate)
    assert b"_standing" not in content
    assert json.loads(content)["gate_schema"] == store.GATE_VERSION
