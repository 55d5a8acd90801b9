"""The content of the page as plain values, without markup, for the template."""

from __future__ import annotations

from operator import itemgetter
from typing import TYPE_CHECKING, Any, Final

import pyarrow as pa
import pyarrow.compute as pc

from drivelint.report.html import overview
from drivelint.report.html.anchors import anchor
from drivelint.report.html.baseline_status import finding_status, gate_summary
from drivelint.report.html.explanations import glossary_entries, notes_on_published_logs
from drivelint.report.html.incidents import finding_line, incidents, involved_actors, plan_views
from drivelint.report.html.overtakes import MOST_SHOWN_SAFE_DISTANCE_AHEAD_M, overtake_views, overtaking_opportunities
from drivelint.report.html.pictures import add_pictures, cameras_by_moment
from drivelint.report.html.plan_view import actor_shapes
from drivelint.report.html.reasons import (
    VerdictReason,
    can_missing_data_be_provided,
    reason_groups,
    summarise_reasons,
    verdict_reason,
)
from drivelint.report.html.replay import replays
from drivelint.report.html.road import DrawnMaps
from drivelint.report.html.timeline import empty_timeline, separate_shared_rules, timelines
from drivelint.report.html.worst_moment import MomentEvidence, finding_key, worst_moment
from drivelint.report.inputs import input_notes
from drivelint.report.outcome import one_finding_per_event_and_status, rule_counts
from drivelint.report.same_contact import findings_of_same_contact
from drivelint.report.worst_first import worst_first
from drivelint.result import counts
from drivelint.result.counts import group_rows
from drivelint.result.model import exit_status
from drivelint.result.text import number

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence

    from drivelint.report.html.incidents import FindingLine, Key
    from drivelint.report.html.timeline import Timeline
    from drivelint.result.model import Result
    from drivelint.result.text import Row

MAX_FINDINGS: Final = 600
"""The page shows this many of the worst findings; the Parquet files contain all."""
MAX_NEAR_MISSES: Final = 150
"""The page shows this many of the worst near misses."""
MAX_PLAN_VIEWS: Final = 150
MAX_CHARTS: Final = 150
"""The page shows the measured values over time of this many of the worst findings and near misses."""
MAX_DRIVE_SECTIONS: Final = 60
"""This many drives get a section: drives with findings first, then drives with near misses, then drives with unknown verdicts."""
UNFOLDED_SECTIONS_UP_TO_N_DRIVES: Final = 3
"""If the result has at most this many drives, their sections are unfolded."""

BRIEF_TIMELINES_ABOVE_N_DRIVES: Final = 20
"""If the result has more drives, the timelines name the rules that were always kept instead of drawing them."""

_VERDICT_WORDS: Final = {
    "fail": "not kept",
    "error": "error",
    "unknown": "unknown",
    "pass": "kept",
    "not_applicable": "not applicable",
}


def content(result: Result) -> dict[str, Any]:
    """Return all values of the template."""
    rules = {row["rule_id"]: row for row in result.rules.to_pylist()}
    drives = result.drives.to_pylist()
    starts = {row["drive_id"]: row["t_start_ns"] or 0 for row in drives}
    verdicts_by_drive = counts.verdict_counts_by(result.verdicts, "drive_id")
    events = one_finding_per_event_and_status(result.gate, result.findings.to_pylist())
    by_drive = counts.group_rows(events, lambda row: row["drive_id"])
    rows = _worst_findings_and_near_misses(result, rules)
    section_drives = _drives_with_section(drives, [row["drive_id"] for _, row in rows], verdicts_by_drive)
    courses = {finding_key(row): row for row in result.courses.to_pylist()}
    lines = _finding_lines(result, rows, rules, starts, courses, linked_drives=section_drives)
    failed = [line for line in lines if line.kind == "fail"]
    moment: Callable[[Row], Key] = itemgetter("drive_id", "ego_id", "t_ns")
    scenes = {moment(row): row for row in result.scenes.to_pylist()}
    spaces = group_rows(result.spaces.to_pylist(), moment)
    road = DrawnMaps(result.lanes)
    views = plan_views(lines, scenes, spaces, road, starts, max_views=MAX_PLAN_VIEWS)
    listed = group_rows(lines, lambda line: line.row["drive_id"])
    anchors = {line.anchor: line.standing.filter_key if line.standing else "" for line in failed}
    verdicts, findings = (
        _rows_by_drive(result.verdicts, section_drives),
        _rows_by_drive(result.findings, section_drives),
    )
    sections = [
        _drive_section(
            row,
            timelines(row, verdicts.get(row["drive_id"], []), findings.get(row["drive_id"], []), rules, anchors),
            incidents(listed.get(row["drive_id"], []), views, row),
            involved_actors(listed.get(row["drive_id"], []), scenes),
            unfolded=len(drives) <= UNFOLDED_SECTIONS_UP_TO_N_DRIVES,
        )
        for row in drives
        if row["drive_id"] in section_drives
    ]
    totals = counts.verdict_counts(result.verdicts)
    worst = worst_moment(
        lines, MomentEvidence(scenes, views, courses), {row["drive_id"]: row for row in drives}, result.folder
    )
    cameras = cameras_by_moment(result.pictures)
    add_pictures(worst, sections, cameras)
    broken, told_of = (
        overview.broken_rules(result, rules, failed, events),
        overview.drive_summaries(sections, len(drives)),
    )
    return {
        "outcome": exit_status(result),
        "headline": overview.page_headline(result),
        "inputs": input_notes(result),
        "worst": worst,
        "pictured": bool(cameras),
        "rates": overview.finding_rates(result, events),
        "contacts": overview.contact_summary(result, failed, rules),
        "rule_counts": rule_counts(result),
        "counts": overview.verdict_shares(totals),
        "names": _VERDICT_WORDS,
        "severities": list(counts.SEVERITIES),
        "passes": totals["pass"],
        "n_findings": len(events),
        "n_rows": result.findings.num_rows,
        "rows_sentence": counts.extra_rows_sentence(result.findings.to_pylist(), events),
        "n_overtakes": result.overtakes.num_rows,
        "gate": gate_summary(result.gate, [row["finding_id"] for row in events]),
        "n_near": int(pc.sum(result.verdicts["near_miss"]).as_py() or 0),
        "n_assumed": counts.count_verdicts_assuming(result.verdicts, "line_of_sight"),
        "broken": broken,
        "words": glossary_entries(overview.first_page_texts(broken, told_of, failed)),
        "several_egos": len({(line.row["drive_id"], line.row["ego_id"]) for line in lines}) > len(listed),
        "notes": notes_on_published_logs([row for row in drives if row["status"] == "judged"]),
        "packs": overview.pack_summaries(result),
        "stories": told_of,
        "findings": failed,
        "near": [line for line in lines if line.kind == "near"],
        "filters": _filter_choices(lines, rules),
        "not_judged": [row for row in drives if row["status"] == "not_judged"],
        "open": reason_groups(result.verdicts, {rule_id: rule["title"] for rule_id, rule in rules.items()}),
        "duration_s": sum(row["duration_s"] or 0.0 for row in drives),
        "drives": [
            {
                **row,
                "href": "#" + anchor("drive", row["drive_id"]) if row["drive_id"] in section_drives else "",
                "verdicts": verdicts_by_drive[row["drive_id"]],
                "findings": [
                    sum(f["severity"] == severity for f in by_drive.get(row["drive_id"], []))
                    for severity in counts.SEVERITIES
                ],
                "near": sum(line.kind == "near" for line in listed.get(row["drive_id"], [])),
                "warnings": sum(check["severity"] != "info" for check in row["quality"]),
            }
            for row in drives
        ],
        "sections": sections,
        "n_charts": MAX_CHARTS,
        "brief": len(drives) > BRIEF_TIMELINES_ABOVE_N_DRIVES,
        "tiles": road.tiles() if views else [],
        "shapes": actor_shapes(scenes[at] for at in views),
        "replays": replays([scenes[at] for at in views], spaces, starts, road),
        "far_m": MOST_SHOWN_SAFE_DISTANCE_AHEAD_M,
        "overtakes": overtake_views(
            result.overtakes.to_pylist(), starts, {p for ps in result.rules["profiles"].to_pylist() for p in ps}
        ),
        "opportunities": overtaking_opportunities(result.opportunities.to_pylist()),
        "n_rules": len(rules),
        "rule_groups": _rule_groups(result, rules),
        "profiles": sorted({profile for rule in rules.values() for profile in rule["profiles"]}),
        "maps": sorted({(row["map_name"], row["map_sha256"]) for row in drives if row["map_name"] is not None}),
    }


def _worst_findings_and_near_misses(result: Result, rules: Mapping[str, Row]) -> list[tuple[str, Row]]:
    """Return the findings (`fail`), then the near misses (`near`) that the page shows, the worst first."""
    near = pc.and_(result.verdicts["near_miss"], pc.is_valid(result.verdicts["t_worst_ns"]))
    failed = worst_first(result.findings, rules).slice(0, MAX_FINDINGS).to_pylist()
    close = worst_first(result.verdicts.filter(near), rules).slice(0, MAX_NEAR_MISSES).to_pylist()
    return [*(("fail", row) for row in failed), *(("near", row) for row in close)]


def _finding_lines(
    result: Result,
    rows: Sequence[tuple[str, Row]],
    rules: Mapping[str, Row],
    starts: Mapping[str, int],
    courses: Mapping[tuple[Any, ...], Row],
    *,
    linked_drives: set[str],
) -> list[FindingLine]:
    """Return the rows with their texts; rows of drives in `linked_drives` get links."""
    same = findings_of_same_contact((row for kind, row in rows if kind == "fail"), rules)
    return [
        finding_line(
            row,
            kind,
            rules[row["rule_id"]],
            starts.get(row["drive_id"], 0),
            has_section=row["drive_id"] in linked_drives,
            course=courses.get(finding_key(row)) if n < MAX_CHARTS else None,
            status=finding_status(result.gate, row["finding_id"]) if kind == "fail" else None,
            same_contact_findings=same.get(row["finding_id"], ()) if kind == "fail" else (),
        )
        for n, (kind, row) in enumerate(rows)
    ]


def _drives_with_section(
    drives: Sequence[Row], worst_drives: Iterable[str], verdict_counts: Mapping[str, Mapping[str, int]]
) -> set[str]:
    """Return the ids of at most `MAX_DRIVE_SECTIONS` drives that get a section.

    Drives in `worst_drives` are preferred, in that order, then drives with unknown verdicts or errors.
    """
    place = {drive_id: n for n, drive_id in enumerate(dict.fromkeys(worst_drives))}

    def sort_key(row: Row) -> tuple[int, int]:
        verdicts = verdict_counts[row["drive_id"]]
        if row["drive_id"] in place:
            return 0, place[row["drive_id"]]
        return (1, 0) if verdicts["unknown"] or verdicts["error"] else (2, 0)

    judged_drives = [row for row in drives if row["status"] == "judged"]
    return {row["drive_id"] for row in sorted(judged_drives, key=sort_key)[:MAX_DRIVE_SECTIONS]}


def _rows_by_drive(rows: pa.Table, drive_ids: set[str]) -> dict[str, list[Row]]:
    drive_rows = rows.filter(pc.is_in(rows["drive_id"], value_set=pa.array(sorted(drive_ids), pa.string())))
    return group_rows(drive_rows.to_pylist(), lambda row: row["drive_id"])


def _filter_choices(lines: Sequence[FindingLine], rules: Mapping[str, Row]) -> dict[str, list[tuple[str, str]]]:
    """Return the choices of each filter of the page as pairs of value and label."""
    severities = {rule["severity"] for rule in rules.values()}
    drives = sorted({line.row["drive_id"] for line in lines})
    return {
        "verdict": [(v, _VERDICT_WORDS.get(v, "near miss")) for v in ("fail", "near", "unknown", "pass", "error")],
        "severity": [(s, s) for s in counts.SEVERITIES if s in severities],
        "pack": [(p, p) for p in sorted({rule["pack"] for rule in rules.values()})],
        "sure": sorted(
            {(f"sure-{line.sure['kind']}", line.sure["kind"]) for line in lines if line.sure and line.sure["kind"]}
        ),
        "standing": sorted({(line.standing.filter_key, line.standing.label) for line in lines if line.standing}),
        "drive": [(d, d) for d in drives] if len(drives) > 1 else [],
    }


def _drive_section(
    row: Row,
    ego_timelines: Sequence[Timeline],
    moments: Sequence[Row],
    actors: Sequence[dict[str, Any]],
    *,
    unfolded: bool,
) -> dict[str, Any]:
    """Return the section of a drive: its row, the actors involved, and the timeline and incidents of each ego."""
    weight = {"error": 0, "warning": 1, "info": 2}
    folded, ego_timelines = separate_shared_rules(ego_timelines)
    without = sorted({m["ego_id"] for m in moments} - {t.ego_id for t in ego_timelines})
    ego_timelines = [*ego_timelines, *(empty_timeline(ego_id) for ego_id in without)]
    egos = [{"timeline": t, "moments": [m for m in moments if m["ego_id"] == t.ego_id]} for t in ego_timelines]
    gaps_by_reason = group_rows(row["not_judged"], lambda gap: gap["reason"])
    return {
        **row,
        "folded": folded,
        "parties": actors,
        "missing": [
            {"reason": why, "n": len(gaps), "egos": ", ".join(gap["ego_id"] for gap in gaps)}
            for why, gaps in gaps_by_reason.items()
        ],
        "egos": sorted(egos, key=lambda ego: (-len(ego["moments"]), ego["timeline"].ego_id)) if len(egos) > 1 else egos,
        "moments": moments,
        "unfolded": unfolded,
        "quality": sorted(row["quality"], key=lambda check: weight.get(check["severity"], 3)),
    }


def _rules_with_counts(result: Result, rules: Mapping[str, Row]) -> list[dict[str, Any]]:
    """Return the rules with their counts and the worst margin of any verdict."""
    verdicts_by_rule = counts.verdict_counts_by(result.verdicts, "rule_id")
    worst = result.verdicts.group_by(["rule_id"], use_threads=False).aggregate([("margin", "min")]).to_pylist()
    margins = {row["rule_id"]: row["margin_min"] for row in worst}
    return [
        {
            **rule,
            "verdicts": verdicts_by_rule[rule_id],
            "worst": number(margins.get(rule_id), rule["unit"]),
        }
        for rule_id, rule in rules.items()
    ]


def _rule_groups(result: Result, rules: Mapping[str, Row]) -> list[dict[str, Any]]:
    """Return the rules by pack: first the rules that were judged in at least one drive, then the others, folded by reason."""
    why = _reasons_of_rules_judged_in_no_drive(result.verdicts)
    order = ("not_applicable", "unknown")
    groups = []
    for pack, pack_rules in group_rows(_rules_with_counts(result, rules), lambda rule: rule["pack"]).items():
        n_judged = sum(bool(rule["verdicts"]["pass"] + rule["verdicts"]["fail"]) for rule in pack_rules)
        idle = [(*why[rule["rule_id"]], rule) for rule in pack_rules if rule["rule_id"] in why]
        folds = group_rows(
            idle, lambda item: (item[0], item[1].kind, _words_on_rule_judged_in_no_drive(item[2]["verdicts"]))
        )
        weightiest = sorted(folds.items(), key=lambda item: (order.index(item[0][0]), -len(item[1]), *item[0][1:]))
        groups.append(
            {
                "pack": pack,
                "about": pack_rules[0]["pack_title"],
                "judged": n_judged,
                "idle": len(pack_rules) - n_judged,
                "rules": [rule for rule in pack_rules if rule["rule_id"] not in why],
                "folds": [
                    (
                        (verdict, words, summarise_reasons(reason for _, reason, _ in folded)),
                        [rule for *_, rule in folded],
                    )
                    for (verdict, _, words), folded in weightiest
                ],
            }
        )
    return groups


def _words_on_rule_judged_in_no_drive(verdict_counts: Mapping[str, int]) -> str:
    """Return in words why a rule was judged in no drive; it may be not applicable for some egos and unknown for others."""
    if not verdict_counts["unknown"]:
        return "never applied"
    return "not applicable or not judged" if verdict_counts["not_applicable"] else "not judged"


def _reasons_of_rules_judged_in_no_drive(verdicts: pa.Table) -> dict[str, tuple[str, VerdictReason]]:
    """Return verdict and reason of the rules that were judged in no drive, because they never applied or data are missing."""
    rows = counts.distinct_rows(verdicts, ["rule_id", "verdict", "reason_code", "cause_code", "reason"])
    rows.sort(key=lambda r: (r["rule_id"], r["verdict"] == "not_applicable", -r["count_all"], r["reason"]))
    return {
        rule_id: (rule_rows[0]["verdict"], verdict_reason(rule_rows[0]))
        for rule_id, rule_rows in group_rows(rows, lambda row: row["rule_id"]).items()
        if all(
            row["verdict"] == "not_applicable"
            or (row["verdict"] == "unknown" and can_missing_data_be_provided(row["reason_code"]))
            for row in rule_rows
        )
    }
