"""What the page says, as plain values for the template: nothing here knows about markup."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

import pyarrow as pa
import pyarrow.compute as pc

from drivelint.report.html import overview
from drivelint.report.html.anchors import drive_anchor, rule_anchor
from drivelint.report.html.baseline_status import finding_status, gate_summary
from drivelint.report.html.glossary import glossary_entries
from drivelint.report.html.incidents import finding_line, incidents, key_incidents, plan_views
from drivelint.report.html.involved_actors import involved_actors
from drivelint.report.html.log_notes import notes_on_logs
from drivelint.report.html.margin_series import margin_series
from drivelint.report.html.opportunities import opportunities
from drivelint.report.html.overtakes import overtake_views
from drivelint.report.html.plan_view import actor_shapes
from drivelint.report.html.reasons import (
    VerdictReason,
    can_be_provided,
    reason_groups,
    summarise_reasons,
    verdict_reason,
)
from drivelint.report.html.replay import replays
from drivelint.report.html.road import Road
from drivelint.report.html.timeline import TimeAxis, empty_timeline, separate_shared_rules, timelines
from drivelint.result import counts
from drivelint.result.model import exit_status
from drivelint.result.text import number

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from drivelint.report.html.incidents import FindingLine, Incident, Key
    from drivelint.report.html.involved_actors import InvolvedActor
    from drivelint.report.html.margin_series import MarginSeries
    from drivelint.report.html.timeline import Timeline
    from drivelint.result.model import Result

    Row = Mapping[str, Any]

MAX_FINDINGS: Final = 1000
"""Findings in the page: the worst; the Parquet files hold them all."""
MAX_NEAR_MISSES: Final = 300
"""Near misses in the page."""
MAX_PICTURES: Final = 250
MAX_CHARTS: Final = 250
"""Findings and near misses with their measure over time and the steps behind it, the worst first."""
MAX_DRIVES: Final = 100
"""Drives with a section of their own: first those with findings, then those with near misses or something unknown."""
MAX_UNFOLDED_DRIVES: Final = 3
"""Up to so many drives are shown unfolded."""

MAX_DETAILED_DRIVES: Final = 20
"""With more drives, rules that were kept throughout are named, not drawn."""

_NAMES: Final = {
    "fail": "not kept",
    "error": "error",
    "unknown": "unknown",
    "pass": "kept",
    "not_applicable": "not applicable",
}


def content(result: Result) -> dict[str, Any]:
    """Return everything that the template shows."""
    rules = {row["rule_id"]: row for row in result.rules.to_pylist()}
    drives = result.drives.to_pylist()
    starts = {row["drive_id"]: row["t_start_ns"] or 0 for row in drives}
    lines, close = _lines(result, rules, starts)
    scenes = {_at(row): row for row in result.scenes.to_pylist()}
    spaces: dict[Key, list[Row]] = {}
    for row in result.spaces.to_pylist():
        spaces.setdefault(_at(row), []).append(row)
    road = Road(result.lanes)
    drawn = plan_views([row for row, _ in lines + close], scenes, spaces, road, rules=rules, most=MAX_PICTURES)
    listed = _by_drive(lines + close)
    told = counts.verdicts_by(result.verdicts, "drive_id")
    shown = _with_section(drives, listed, told)
    lines, close = _linked(lines, shown), _linked(close, shown)
    listed = _by_drive(lines + close)
    anchors = {line.anchor: line.standing.filter_key if line.standing else "" for _, line in lines}
    verdicts, found = _rows_by_drive(result.verdicts, shown), _rows_by_drive(result.findings, shown)
    sections = [
        _section(
            row,
            timelines(verdicts.get(row["drive_id"], []), found.get(row["drive_id"], []), rules, anchors, _clock(row)),
            incidents(
                mine := listed.get(row["drive_id"], []), rules, drawn, starts[row["drive_id"]], key_incidents(mine)
            ),
            involved_actors(row["drive_id"], mine, scenes),
            unfolded=len(drives) <= MAX_UNFOLDED_DRIVES,
        )
        for row in drives
        if row["drive_id"] in shown
    ]
    totals = counts.total(result.verdicts)
    broken, told_of = overview.broken_rules(result, rules, lines), overview.drive_summaries(sections, len(drives))
    return {
        "outcome": exit_status(result),
        "headline": overview.headline(result),
        "contacts": overview.contacts(result, lines),
        "not_decided": overview.undecided_rule_count(result),
        "counts": overview.verdict_shares(totals),
        "names": _NAMES,
        "passes": totals["pass"],
        "n_findings": result.findings.num_rows,
        "n_overtakes": result.overtakes.num_rows,
        "gate": gate_summary(result.gate, result.findings["finding_id"].to_pylist()),
        "n_near": int(pc.sum(result.verdicts["near_miss"]).as_py() or 0),
        "n_assumed": counts.count_assuming(result.verdicts, "line_of_sight"),
        "broken": broken,
        "words": glossary_entries(overview.first_page_texts(broken, told_of, [line for _, line in lines])),
        "several_egos": len({(row["drive_id"], row["ego_id"]) for row, _ in lines + close}) > len(listed),
        "notes": notes_on_logs(drives),
        "packs": overview.verdicts_by_pack(result),
        "stories": told_of,
        "findings": [line for _, line in lines],
        "near": [line for _, line in close],
        "filters": _filters([line for _, line in lines + close], rules),
        "not_judged": [row for row in drives if row["status"] == "not_judged"],
        "open": reason_groups(result.verdicts, {rule_id: rule["title"] for rule_id, rule in rules.items()}),
        "km": sum(row["km"] for row in drives),
        "n_egos": sum(row["n_egos"] for row in drives),
        "duration_s": sum(row["duration_s"] or 0.0 for row in drives),
        "drives": [_drive_row(row, told, listed, row["drive_id"] in shown) for row in drives],
        "sections": sections,
        "n_charts": MAX_CHARTS,
        "brief": len(drives) > MAX_DETAILED_DRIVES,
        "tiles": road.tiles() if drawn else [],
        "shapes": actor_shapes(scenes[at] for at in drawn),
        "replays_of": {
            drive_anchor(drive_id): text
            for drive_id, text in replays([scenes[at] for at in drawn], spaces, starts, road).items()
        },
        "overtakes": overtake_views(result.overtakes.to_pylist(), starts, shown),
        "opportunities": opportunities(result.opportunities.to_pylist()),
        "rules": _rules(result, rules),
        "rule_groups": _rule_groups(result, rules),
        "profiles": sorted({profile for rule in rules.values() for profile in rule["profiles"]}),
        "maps": sorted({(row["map_name"], row["map_sha256"]) for row in drives if row["map_name"] is not None}),
    }


def _at(row: Row) -> Key:
    return row["drive_id"], row["ego_id"], row["t_ns"]


def _lines(
    result: Result, rules: Mapping[str, Row], starts: Mapping[str, int]
) -> tuple[list[tuple[Row, FindingLine]], list[tuple[Row, FindingLine]]]:
    """Return the findings and the near misses that the page shows, the worst first, each with its words."""
    courses = {_whose(row): row for row in result.courses.to_pylist()}
    failed: list[tuple[Row, FindingLine]] = []
    for row in _worst_first(result.findings, MAX_FINDINGS):
        start = starts.get(row["drive_id"], 0)
        way = _course(courses, row, start) if len(failed) < MAX_CHARTS else None
        stands = finding_status(result.gate, row["finding_id"])
        failed.append((row, finding_line(row, "fail", rules[row["rule_id"]], start, course=way, standing=stands)))
    near = pc.and_(result.verdicts["near_miss"], pc.is_valid(result.verdicts["t_worst_ns"]))
    close: list[tuple[Row, FindingLine]] = []
    for row in _worst_first(result.verdicts.filter(near), MAX_NEAR_MISSES):
        start = starts.get(row["drive_id"], 0)
        way = _course(courses, row, start) if len(failed) + len(close) < MAX_CHARTS else None
        close.append((row, finding_line(row, "near", rules[row["rule_id"]], start, course=way)))
    return failed, close


def _whose(row: Row) -> tuple[Any, ...]:
    """Return what tells a course's finding or near miss apart."""
    told = (row[name] for name in ("drive_id", "ego_id", "rule_id", "profile", "object_id", "occurrence"))
    return (row.get("finding_id"), *told)


def _course(courses: Mapping[tuple[Any, ...], Row], row: Row, start_ns: int) -> MarginSeries | None:
    seen = courses.get(_whose(row))
    return None if seen is None else margin_series(seen, row["t_worst_ns"], row["unit"], start_ns)


def _worst_first(rows: pa.Table, most: int) -> list[dict[str, Any]]:
    """Return the rows to show, in the order of severity, drive and time."""
    weight = pc.index_in(rows["severity"], value_set=pa.array(counts.SEVERITIES))
    order = [
        (name, "ascending")
        for name in ("weight", "drive_id", "ego_id", "t_worst_ns", "rule_id", "profile", "object_id")
    ]
    worst: list[dict[str, Any]] = rows.append_column("weight", weight).sort_by(order).slice(0, most).to_pylist()
    return worst


def _by_drive(rows: Sequence[tuple[Row, FindingLine]]) -> dict[str, list[tuple[Row, FindingLine]]]:
    grouped: dict[str, list[tuple[Row, FindingLine]]] = {}
    for row, line in rows:
        grouped.setdefault(row["drive_id"], []).append((row, line))
    return grouped


def _with_section(drives: Sequence[Row], listed: Mapping[str, Any], told: Mapping[str, Mapping[str, int]]) -> set[str]:
    """Return the ids of the drives that get a section: those with the worst findings first."""
    place = {drive_id: n for n, drive_id in enumerate(listed)}

    def weight(row: Row) -> tuple[int, int]:
        verdicts = told.get(row["drive_id"], {})
        if row["drive_id"] in place:
            return 0, place[row["drive_id"]]
        return (1, 0) if verdicts.get("unknown") or verdicts.get("error") else (2, 0)

    judged = [row for row in drives if row["status"] == "judged"]
    return {row["drive_id"] for row in sorted(judged, key=weight)[:MAX_DRIVES]}


def _linked(rows: Sequence[tuple[Row, FindingLine]], shown: set[str]) -> list[tuple[Row, FindingLine]]:
    """Return the rows, without links into drives that have no section."""
    return [
        (row, line if line.drive_id in shown else line._replace(anchor="", href="", drive_href=""))
        for row, line in rows
    ]


def _rows_by_drive(rows: pa.Table, drives: set[str]) -> dict[str, list[dict[str, Any]]]:
    grouped: dict[str, list[dict[str, Any]]] = {}
    for row in rows.filter(pc.is_in(rows["drive_id"], value_set=pa.array(sorted(drives), pa.string()))).to_pylist():
        grouped.setdefault(row["drive_id"], []).append(row)
    return grouped


def _filters(lines: Sequence[FindingLine], rules: Mapping[str, Row]) -> dict[str, list[tuple[str, str]]]:
    """Return what can be chosen in the filters: value and label."""
    severities = {rule["severity"] for rule in rules.values()}
    drives = sorted({line.drive_id for line in lines})
    return {
        "verdict": [(v, _NAMES.get(v, "near miss")) for v in ("fail", "near", "unknown", "pass", "error")],
        "severity": [(s, s) for s in counts.SEVERITIES if s in severities],
        "pack": [(p, p) for p in sorted({rule["pack"] for rule in rules.values()})],
        "standing": sorted({(line.standing.filter_key, line.standing.label) for line in lines if line.standing}),
        "drive": [(d, d) for d in drives] if len(drives) > 1 else [],
    }


def _clock(row: Row) -> TimeAxis:
    return TimeAxis(row["t_start_ns"] or 0, max(row["duration_s"] or 0.0, 1e-3))


def _drive_row(
    row: Row, told: Mapping[str, Mapping[str, int]], listed: Mapping[str, Any], shown: bool
) -> dict[str, Any]:
    verdicts = told.get(row["drive_id"], dict.fromkeys(counts.VERDICTS, 0))
    near = sum(line.kind == "near" for _, line in listed.get(row["drive_id"], []))
    return {
        **row,
        "href": "#" + drive_anchor(row["drive_id"]) if shown else "",
        "verdicts": verdicts,
        "near": near,
        "warnings": sum(check["severity"] != "info" for check in row["quality"]),
    }


def _section(
    row: Row, tracks: Sequence[Timeline], seen: Sequence[Incident], involved: Sequence[InvolvedActor], *, unfolded: bool
) -> dict[str, Any]:
    """Return a drive with its egos: the timeline, the moments and the parties of each."""
    weight = {"error": 0, "warning": 1, "info": 2}
    folded, tracks = separate_shared_rules(tracks)
    without = sorted({m.ego_id for m in seen} - {t.ego_id for t in tracks})
    tracks = [*tracks, *(empty_timeline(ego_id) for ego_id in without)]
    egos = [{"timeline": t, "moments": [m for m in seen if m.ego_id == t.ego_id]} for t in tracks]
    missing: dict[str, list[str]] = {}
    for gap in row["not_judged"]:
        missing.setdefault(gap["reason"], []).append(gap["ego_id"])
    return {
        **row,
        "anchor": drive_anchor(row["drive_id"]),
        "folded": folded,
        "parties": involved,
        "missing": [{"reason": why, "n": len(who), "egos": ", ".join(who)} for why, who in missing.items()],
        "egos": sorted(egos, key=lambda ego: (-len(ego["moments"]), ego["timeline"].ego_id)) if len(egos) > 1 else egos,
        "moments": seen,
        "unfolded": unfolded,
        "quality": sorted(row["quality"], key=lambda check: weight.get(check["severity"], 3)),
    }


def _rules(result: Result, rules: Mapping[str, Row]) -> list[dict[str, Any]]:
    """Return the rules with their counts and the worst margin of any verdict."""
    told = counts.verdicts_by(result.verdicts, "rule_id")
    worst = result.verdicts.group_by(["rule_id"], use_threads=False).aggregate([("margin", "min")]).to_pylist()
    margins = {row["rule_id"]: row["margin_min"] for row in worst}
    return [
        {
            **rule,
            "anchor": rule_anchor(rule_id),
            "verdicts": told.get(rule_id, dict.fromkeys(counts.VERDICTS, 0)),
            "worst": number(margins.get(rule_id), rule["unit"]),
        }
        for rule_id, rule in rules.items()
    ]


def _rule_groups(result: Result, rules: Mapping[str, Row]) -> list[dict[str, Any]]:
    """Return the rules by pack: those that were judged somewhere, then the others in one fold per reason."""
    told = {rule["rule_id"]: rule for rule in _rules(result, rules)}
    why = _first_reason(result.verdicts)
    groups: dict[str, dict[str, Any]] = {}
    for rule_id, rule in told.items():
        group = groups.setdefault(
            rule["pack"], {"pack": rule["pack"], "about": rule["pack_title"], "rules": [], "folds": {}}
        )
        if (reason := why.get(rule_id)) is None:
            group["rules"].append(rule)
        else:
            group["folds"].setdefault((reason[0], reason[1].kind), []).append((reason[1], rule))
    order = ("not_applicable", "unknown")
    for group in groups.values():
        folds = sorted(group["folds"].items(), key=lambda item: (order.index(item[0][0]), -len(item[1]), item[0][1]))
        group["folds"] = [
            ((verdict, summarise_reasons(reason for reason, _ in folded)), [rule for _, rule in folded])
            for (verdict, _), folded in folds
        ]
    return list(groups.values())


def _first_reason(verdicts: pa.Table) -> dict[str, tuple[str, VerdictReason]]:
    """Return verdict and reason of the rules that were judged nowhere, for want of an occasion or of something to be provided."""
    keys = ["rule_id", "verdict", "reason_code", "cause_code", "reason"]
    rows = verdicts.group_by(keys, use_threads=False).aggregate([([], "count_all")]).to_pylist()
    found: dict[str, tuple[str, VerdictReason]] = {}
    judged = set()
    for row in sorted(
        rows, key=lambda r: (r["rule_id"], r["verdict"] == "not_applicable", -r["count_all"], r["reason"])
    ):
        idle = row["verdict"] == "not_applicable" or (
            row["verdict"] == "unknown" and can_be_provided(row["reason_code"])
        )
        if not idle:
            judged.add(row["rule_id"])
        found.setdefault(row["rule_id"], (row["verdict"], verdict_reason(row)))
    return {rule_id: reason for rule_id, reason in found.items() if rule_id not in judged}
