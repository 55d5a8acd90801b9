"""`report.sarif`: findings as SARIF 2.1.0 (OASIS), for code scanning and for viewers of static analysis.

Only findings are results. Drives and rules that could not be judged are notifications, not results of the kind "open", because servers
such as GitHub's code scanning show results of any kind as alerts. The properties of the run and of each rule contain the counts of
all verdicts, so that the absence of results is not mistaken for a pass.
"""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any, Final
from urllib.parse import quote

from drivelint import __version__
from drivelint.gate import descriptions
from drivelint.report.outcome import LET_THROUGH_WORDS, events_by_status, status_at_gate
from drivelint.report.worst_first import moment_ns, when
from drivelint.result import counts, request
from drivelint.result.certainty import certainty, doubt_words
from drivelint.result.model import exit_status, gating_findings
from drivelint.result.names import RUN_FILE
from drivelint.result.text import (
    breach_title,
    ego_and_object_names,
    measured_values_text,
    number,
    replace_non_finite,
    rule_name,
    utc_at,
    with_count,
)

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from drivelint.report.outcome import Event
    from drivelint.result.gate import Gate
    from drivelint.result.model import Result
    from drivelint.result.text import Row

SCHEMA: Final = "https://docs.oasis-open.org/sarif/sarif/v2.1.0/errata01/os/schemas/sarif-schema-2.1.0.json"
LEVELS: Final = {"critical": "error", "major": "warning", "minor": "note"}
"""The level of each severity. Findings that do not gate (of drafts, or let through by the gate) have the level note."""

ROOT_BASE_ID: Final = "%SRCROOT%"
"""The base of the logs' paths: the folder in which the check ran; for code scanning, this is the root of the repository."""
_BASELINE_STATES: Final = {"new": "new", "changed": "updated", "unchanged": "unchanged"}
_ROOT_DESCRIPTION: Final = {"description": {"text": "The folder in which drivelint check ran."}}
_NOTIFICATION_KINDS: Final = {
    "unknown": "A rule could not be judged",
    "error": "A rule could not be run",
    "not-judged": "A drive could not be judged",
    "data-quality": "Something is wrong with a log or its map",
    "waiver": "A waiver expired or matches nothing",
}


def render(result: Result) -> bytes:
    """Return the SARIF log as UTF-8 JSON with a final newline; the same result gives the same bytes."""
    content = {"$schema": SCHEMA, "version": "2.1.0", "runs": [_SarifRun(result).content()]}
    return (json.dumps(replace_non_finite(content), indent=1, ensure_ascii=True, allow_nan=False) + "\n").encode()


class _SarifRun:
    """One result, with the indices of its rules and logs in the lists of the SARIF run."""

    def __init__(self, result: Result) -> None:
        self._result = result
        self._rules = result.rules.to_pylist()
        self._logs = result.drives.to_pylist()
        self._drives = {row["drive_id"]: row for row in self._logs}
        self._rule_by_id = {rule["rule_id"]: rule for rule in self._rules}
        self._gating = frozenset(gating_findings(result)["finding_id"].to_pylist())
        self._rule_index = {rule["rule_id"]: n for n, rule in enumerate(self._rules)}
        self._artifact_index = {drive["drive_id"]: n for n, drive in enumerate(self._logs)}
        self._paths = _relative_log_paths(result)

    def content(self) -> dict[str, Any]:
        """Return the SARIF run as plain data."""
        result, end = self._result, exit_status(self._result)
        verdicts_by_rule = counts.verdict_counts_by(result.verdicts, "rule_id")
        total = counts.verdict_counts(result.verdicts)
        properties = {"verdicts": total, "failOn": result.fail_on, "strict": result.strict}
        if result.gate is not None:
            properties["gate"] = descriptions.gate_counts(result.gate)
        driver = {
            "name": "drivelint",
            "semanticVersion": __version__,
            "rules": [_rule_descriptor(rule, verdicts_by_rule[rule["rule_id"]]) for rule in self._rules],
            "notifications": [
                {"id": name, "shortDescription": {"text": text}} for name, text in _NOTIFICATION_KINDS.items()
            ],
        }
        invocation = {
            "executionSuccessful": not total["error"],
            "exitCode": int(end.code),
            "exitCodeDescription": end.why,
            "toolExecutionNotifications": list(self._notifications()),
        }
        return {
            "tool": {"driver": driver},
            "invocations": [invocation],
            **({"originalUriBaseIds": {ROOT_BASE_ID: _ROOT_DESCRIPTION}} if self._paths else {}),
            "artifacts": [_artifact(drive, self._log_uri(drive)) for drive in self._logs],
            "results": list(map(self._result_of_event, events_by_status(result.gate, result.findings.to_pylist()))),
            "properties": properties,
        }

    def _result_of_event(self, event: Event) -> dict[str, Any]:
        row = event.finding
        drive, rule_index = self._drives[row["drive_id"]], self._rule_index[row["rule_id"]]
        rule, gate = self._rules[rule_index], self._result.gate
        start_ns = drive["t_start_ns"]
        values_text = "" if row["reason_measures"] else measured_values_text(row)
        profile = "" if row["profile"] is None else f", profile {row['profile']}"
        subject = f"{ego_and_object_names(row)}{profile}, {when(row, self._rule_by_id, start_ns)}"
        parts = [
            f"{breach_title(rule)}: {row['reason']}",
            values_text,
            subject,
            f"({doubt_words(row)})" if doubt_words(row) else "",
            f"({event.other_rows_words})" if event.other_rows else "",
        ]
        sarif_result: dict[str, Any] = {
            "ruleId": row["rule_id"],
            "ruleIndex": rule_index,
            "kind": "fail",
            "level": "note"
            if status_at_gate(gate, row["finding_id"]) in LET_THROUGH_WORDS
            else _level(row["severity"], rule["status"]),
            "message": {"text": " ".join(part for part in parts if part)},
            "locations": [self._location(drive, row)],
            # code scanning of GitHub only reads primaryLocationLineHash: without it, all findings of a rule in a log are one alert
            "partialFingerprints": {"findingId/v1": event.id, "primaryLocationLineHash": event.id},
            "properties": {
                "profile": row["profile"],
                "severity": row["severity"],
                "start_s": _seconds_since_start(row["t_start_ns"], start_ns),
                "end_s": _seconds_since_start(row["t_end_ns"], start_ns),
                "worst_s": _seconds_since_start(row["t_worst_ns"], start_ns),
                "t_utc": utc_at(moment_ns(row, self._rule_by_id), drive),
                **{name: row[name] for name in ("observed", "required", "margin", "unit")},
                **{name: row[name] for name in ("x_m", "y_m", "lon", "lat", "lanelet_id")},
                **{name: row[name] for name in ("n_copies", "n_stays")},
                "certainty": certainty(row),
                "gates": row["finding_id"] in self._gating,
                "findingIds": [finding["finding_id"] for finding in event.rows],
                "profiles": sorted({finding["profile"] for finding in event.rows} - {None}),
            },
        }
        return sarif_result if gate is None else sarif_result | _gate_properties(gate, event)

    def _log_uri(self, drive: Row) -> dict[str, str]:
        """Return the URI of a log: its path relative to the folder of the check, or its name if that path is not known."""
        if path := self._paths.get(drive["drive_id"]):
            return {"uri": _path_as_uri(path), "uriBaseId": ROOT_BASE_ID}
        return {"uri": _path_as_uri(drive["file_name"])}

    def _location(self, drive: Row, row: Row | None = None) -> dict[str, Any]:
        """Return the SARIF location of a log; if `row`, a finding, is given, also its actors, time and position."""
        drive_id = drive["drive_id"]
        artifact = {**self._log_uri(drive), "index": self._artifact_index[drive_id]}
        place: dict[str, Any] = {"physicalLocation": {"artifactLocation": artifact}}
        if row is not None:
            # a log has no lines, but GitHub's code scanning does not show results without a line
            place["physicalLocation"]["region"] = {"startLine": 1}
            inside = {"ego": row["ego_id"], "object": row["object_id"], "lanelet": row["lanelet_id"]}
            place["logicalLocations"] = [
                {"name": drive_id, "kind": "drive", "fullyQualifiedName": drive_id},
                *(
                    {"name": name, "kind": kind, "fullyQualifiedName": f"{drive_id}/{kind}/{name}"}
                    for kind, name in inside.items()
                    if name is not None
                ),
            ]
            at = f"{when(row, self._rule_by_id, drive['t_start_ns'])} into {drive['file_name']}"
            if row["x_m"] is not None and row["y_m"] is not None:
                at += f", ego at x {number(row['x_m'], 'm')}, y {number(row['y_m'], 'm')}"
            place["message"] = {"text": at}
        return place

    def _notifications(self) -> Iterator[dict[str, Any]]:
        """Yield notifications: drives and rules that could not be judged, with the reasons; data quality; waivers."""
        for drive in self._logs:
            if drive["status"] == "not_judged":
                yield _notification(
                    "not-judged", "error", drive["status_reason"] or "no reason given", self._location(drive)
                )
        result, columns = self._result, ["drive_id", "rule_id", "profile", "verdict", "reason"]
        for row in counts.distinct_rows(counts.undecided_verdicts(result.verdicts), columns):
            text = f"{rule_name(row)}: {row['verdict']}: {with_count(row['reason'], row['count_all'])}"
            level = "error" if row["verdict"] == "error" else "warning"
            notice = _notification(row["verdict"], level, text, self._location(self._drives[row["drive_id"]]))
            yield notice | {"associatedRule": {"id": row["rule_id"], "index": self._rule_index[row["rule_id"]]}}
        for drive in self._logs:
            for check in drive["quality"]:
                level = "note" if check["severity"] == "info" else check["severity"]
                text = f"{check['check_id']}: {check['message']}"
                yield _notification("data-quality", level, text, self._location(drive))
        for text in descriptions.waiver_warnings(result.gate) if result.gate else ():
            yield _notification("waiver", "warning", text)


def _gate_properties(gate: Gate, event: Event) -> dict[str, Any]:
    """Return what the baseline and the waivers say about an event, as properties of a SARIF result."""
    properties: dict[str, Any] = {}
    ids = [row["finding_id"] for row in event.rows]
    if gate.baseline is not None:
        entries = filter(None, map(gate.compared_finding, ids))
        states = {_BASELINE_STATES[entry.standing] for entry in entries} or {"new"}
        properties["baselineState"] = next(state for state in ("new", "updated", "unchanged") if state in states)
    if gate.waivers:  # SARIF: if some results are suppressed, the others have an empty list
        properties["suppressions"] = [
            {
                "kind": "external",
                "status": "accepted",
                "justification": f"{waiver.reason} ({waiver.owner}, until {waiver.expires})",
            }
            for waiver in dict.fromkeys(filter(None, map(gate.waiver, ids)))
        ]
    return properties


def _relative_log_paths(result: Result) -> Mapping[str, str]:
    """Return the logs' paths relative to the folder in which the check ran, by `drive_id`; unknown paths are left out."""
    if result.run_options is not None:
        return result.run_options.relative_paths
    if result.folder is None or not (result.folder / RUN_FILE).is_file():
        return {}
    return request.load(result.folder).relative_paths


def _rule_descriptor(rule: Row, verdict_counts: Mapping[str, int]) -> dict[str, Any]:
    params = [f"{p['name']} = {p['value']}{' ' + p['unit'] if p['unit'] else ''}" for p in rule["params"]]
    lines = [rule["clause"], rule["hypothesis"], f"Derived as: {rule['derivation']}. Status: {rule['status']}."]
    lines += [f"Parameters: {'; '.join(params)}."] if params else []
    lines += [f"SQL and sources: drivelint rules show {rule['rule_id']}"]
    return {
        "id": rule["rule_id"],
        "shortDescription": {"text": rule["title"]},
        "fullDescription": {"text": rule["hypothesis"]},
        "help": {"text": "\n".join(lines)},
        "defaultConfiguration": {"level": _level(rule["severity"], rule["status"])},
        "properties": {
            "tags": [rule["pack"], rule["kind"], rule["severity"], rule["legal"], rule["status"]],
            "version": rule["rule_version"],
            "clause": rule["clause"],
            "requires": rule["requires"],
            "verdicts": dict(verdict_counts),
        },
    }


def _artifact(drive: Row, location: Mapping[str, str]) -> dict[str, Any]:
    artifact: dict[str, Any] = {
        "location": dict(location),
        "roles": ["analysisTarget"],
        "properties": {"driveId": drive["drive_id"], "status": drive["status"], "map": drive["map_name"]},
    }
    if drive["sha256"] is not None:
        artifact["hashes"] = {"sha-256": drive["sha256"]}
    return artifact


def _notification(kind: str, level: str, text: str, place: dict[str, Any] | None = None) -> dict[str, Any]:
    number = list(_NOTIFICATION_KINDS).index(kind)
    notice = {"descriptor": {"id": kind, "index": number}, "level": level, "message": {"text": text}}
    return notice if place is None else notice | {"locations": [place]}


def _level(severity: str, status: str) -> str:
    return LEVELS[severity] if status == "stable" else "note"


def _seconds_since_start(t_ns: int | None, start_ns: int | None) -> float | None:
    return None if t_ns is None else (t_ns - (start_ns or 0)) / 1e9


def _path_as_uri(path: str) -> str:
    """Return a file's path as a relative URI; a colon is encoded, so that it does not mark a URI scheme."""
    return quote(path, safe="/", errors="surrogateescape")
