"""What the page says, as plain values for the template: nothing here knows about markup."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

import pyarrow as pa
import pyarrow.compute as pc

from drivelint.report import counts
from drivelint.report.html.anchors import drive_anchor, rule_anchor
from drivelint.report.html.moments import measured, moments, pictures
from drivelint.report.html.road import Road
from drivelint.report.html.timeline import Clock, timelines
from drivelint.report.result import outcome
from drivelint.report.text import number

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from drivelint.report.html.moments import Measured
    from drivelint.report.result import Result

    Row = Mapping[str, Any]

MAX_FINDINGS: Final = 1000
"""Findings in the page: the worst; the Parquet files hold them all."""
MAX_NEAR: Final = 300
"""Near misses in the page."""
MAX_PICTURES: Final = 250
MAX_DRIVES: Final = 200
"""Drives with a section of their own: first those with findings, then those with near misses or something unknown."""
MAX_REASONS: Final = 200
OPEN_DRIVES: Final = 3
"""Up to so many drives are shown unfolded."""

_NAMES: Final = {
    "pass": "pass",
    "fail": "fail",
    "unknown": "unknown",
    "not_applicable": "not applicable",
    "error": "error",
}


def content(result: Result) -> dict[str, Any]:
    """Return everything that the template shows."""
    rules = {row["rule_id"]: row for row in result.rules.to_pylist()}
    drives = result.drives.to_pylist()
    starts = {row["drive_id"]: row["t_start_ns"] for row in drives}
    failed = _worst_first(result.findings, MAX_FINDINGS)
    near_miss = pc.and_(result.verdicts["near_miss"], pc.is_valid(result.verdicts["t_worst_ns"]))
    near = _worst_first(result.verdicts.filter(near_miss), MAX_NEAR)
    lines: list[tuple[Row, Measured]] = [
        (row, measured(row, "fail", rules[row["rule_id"]], starts.get(row["drive_id"]))) for row in failed
    ]
    close: list[tuple[Row, Measured]] = [
        (row, measured(row, "near", rules[row["rule_id"]], starts.get(row["drive_id"]))) for row in near
    ]
    drawn = pictures([row for row, _ in lines + close], result.scenes, result.spaces, Road(result.lanes), MAX_PICTURES)
    listed = _by_drive(lines + close)
    told = counts.by(result.verdicts, "drive_id")
    shown = _with_section(drives, listed, told)
    lines, close = _linked(lines, shown), _linked(close, shown)
    verdicts, found = _rows_by_drive(result.verdicts, shown), _rows_by_drive(result.findings, shown)
    anchors = {line.anchor for _, line in lines}
    titles = {rule_id: rule["title"] for rule_id, rule in rules.items()}
    return {
        "outcome": outcome(result),
        "headline": _headline(result),
        "counts": _shares(counts.total(result.verdicts)),
        "names": _NAMES,
        "passes": counts.total(result.verdicts)["pass"],
        "n_findings": result.findings.num_rows,
        "n_near": int(pc.sum(result.verdicts["near_miss"]).as_py() or 0),
        "findings": [line for _, line in lines],
        "near": [line for _, line in close],
        "filters": _filters([line for _, line in lines]),
        "not_judged": [row for row in drives if row["status"] == "not_judged"],
        "open": _reasons(result.verdicts, titles),
        "km": sum(row["km"] for row in drives),
        "duration_s": sum(row["duration_s"] or 0.0 for row in drives),
        "drives": [_drive_row(row, told, listed, row["drive_id"] in shown) for row in drives],
        "sections": [
            _section(
                row,
                timelines(
                    verdicts.get(row["drive_id"], []), found.get(row["drive_id"], []), titles, anchors, _clock(row)
                ),
                moments(listed.get(row["drive_id"], []), rules, drawn),
                unfolded=len(drives) <= OPEN_DRIVES,
            )
            for row in drives
            if row["drive_id"] in shown
        ],
        "rules": _rules(result, rules),
        "profiles": sorted({profile for rule in rules.values() for profile in rule["profiles"]}),
        "maps": sorted({row["map_name"] for row in drives if row["map_name"] is not None}),
    }


def _headline(result: Result) -> tuple[str, str]:
    """Return the sign and the sentence that stand on top."""
    told, n = counts.total(result.verdicts), result.findings.num_rows
    judged = int(pc.sum(pc.equal(result.drives["status"], "judged")).as_py() or 0)
    open_ = told["unknown"] + told["error"]
    if n:
        drives = len(pc.unique(result.findings["drive_id"]))
        return "fail", f"{n} {'finding' if n == 1 else 'findings'} in {drives} of {result.drives.num_rows} drives"
    if not judged or not result.verdicts.num_rows:
        return "unknown", "Nothing was judged"
    if not told["pass"] and open_:
        return "unknown", "Nothing could be decided"
    if open_ or judged < result.drives.num_rows:
        return "unknown", "No finding, as far as it could be judged"
    return "pass", "No finding"


def _worst_first(rows: pa.Table, most: int) -> list[dict[str, Any]]:
    """Return the rows to show, in the order of severity, drive and time."""
    weight = pc.index_in(rows["severity"], value_set=pa.array(counts.SEVERITIES))
    order = [
        (name, "ascending")
        for name in ("weight", "drive_id", "ego_id", "t_worst_ns", "rule_id", "profile", "object_id")
    ]
    worst: list[dict[str, Any]] = rows.append_column("weight", weight).sort_by(order).slice(0, most).to_pylist()
    return worst


def _by_drive(rows: Sequence[tuple[Row, Measured]]) -> dict[str, list[tuple[Row, Measured]]]:
    grouped: dict[str, list[tuple[Row, Measured]]] = {}
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


def _linked(rows: Sequence[tuple[Row, Measured]], shown: set[str]) -> list[tuple[Row, Measured]]:
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


def _shares(told: Mapping[str, int]) -> list[dict[str, Any]]:
    """Return the verdicts with their number and their stretch of a bar, in percent."""
    total, at, shares = sum(told.values()), 0.0, []
    for verdict in ("fail", "error", "unknown", "pass", "not_applicable"):
        width = 100 * told[verdict] / total if total else 0.0
        shares.append({"verdict": verdict, "n": told[verdict], "x": f"{at:.3f}%", "w": f"{width:.3f}%"})
        at += width
    return shares


def _filters(lines: Sequence[Measured]) -> dict[str, list[tuple[str, str]]]:
    """Return what the table of findings can be filtered by: value and label."""
    severities = {line.severity for line in lines}
    return {
        "severity": [(s, s) for s in counts.SEVERITIES if s in severities],
        "rule": sorted({(line.rule_id, f"{line.title} ({line.rule_id})") for line in lines}, key=lambda item: item[0]),
        "drive": sorted({(line.drive_id, line.drive_id) for line in lines}),
    }


def _reasons(verdicts: pa.Table, titles: Mapping[str, str]) -> list[dict[str, Any]]:
    """Return why verdicts are unknown or errors: reason, rules, how many verdicts and drives; the most frequent first."""
    rows = verdicts.filter(pc.is_in(verdicts["verdict"], value_set=pa.array(["unknown", "error"])))
    grouped: dict[tuple[str, str], dict[str, Any]] = {}
    for row in rows.select(["verdict", "reason", "rule_id", "drive_id"]).to_pylist():
        entry = grouped.setdefault((row["verdict"], row["reason"]), {"n": 0, "rules": set(), "drives": set()})
        entry["n"] += 1
        entry["rules"].add(row["rule_id"])
        entry["drives"].add(row["drive_id"])
    ordered = sorted(grouped.items(), key=lambda item: (item[0][0], -item[1]["n"], item[0][1]))
    return [
        {
            "verdict": verdict,
            "reason": reason,
            "n": entry["n"],
            "rules": [(titles.get(rule, rule), "#" + rule_anchor(rule)) for rule in sorted(entry["rules"])],
            "n_drives": len(entry["drives"]),
        }
        for (verdict, reason), entry in ordered[:MAX_REASONS]
    ]


def _clock(row: Row) -> Clock:
    return Clock(row["t_start_ns"] or 0, max(row["duration_s"] or 0.0, 1e-3))


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


def _section(row: Row, tracks: Sequence[Any], seen: Sequence[Any], *, unfolded: bool) -> dict[str, Any]:
    weight = {"error": 0, "warning": 1, "info": 2}
    return {
        **row,
        "anchor": drive_anchor(row["drive_id"]),
        "timelines": tracks,
        "moments": seen,
        "unfolded": unfolded,
        "quality": sorted(row["quality"], key=lambda check: weight.get(check["severity"], 3)),
    }


def _rules(result: Result, rules: Mapping[str, Row]) -> list[dict[str, Any]]:
    """Return the rules with their counts and the worst margin of any verdict."""
    told = counts.by(result.verdicts, "rule_id")
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
