"""`report.xqar`: ASAM's quality checker results (2025-08), with a bundle per drive and a checker per rule.

In that format a completed checker without issues means a pass. So a rule without a pass or a failure is `skipped`, with the reasons
of its verdicts and their numbers. If a rule is judged only in part, each unknown verdict is an issue of the level information.
"""

from __future__ import annotations

import re
from collections import Counter
from operator import itemgetter
from typing import TYPE_CHECKING, Final

from lxml import etree

from drivelint import __version__
from drivelint.gate import descriptions
from drivelint.report.outcome import events_by_status
from drivelint.report.worst_first import when
from drivelint.report.xml import add_element, replace_non_xml, xml_bytes
from drivelint.result import counts
from drivelint.result.text import ego_and_object_names, verdict_or_finding_line, with_count

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from drivelint.report.outcome import Event
    from drivelint.result.gate import Gate
    from drivelint.result.model import Result
    from drivelint.result.text import Row

LEVELS: Final = {"critical": "1", "major": "2", "minor": "3"}
"""The levels error, warning and information of each severity. Findings of drafts and waived findings are information."""
INFORMATION_LEVEL: Final = "3"


def render(result: Result) -> bytes:
    """Return the results as UTF-8 XML, without a build date, so that the same result gives the same bytes."""
    root = etree.Element("CheckerResults", version="1.0.0")
    reasons = counts.distinct_rows(result.verdicts, ["drive_id", "rule_id", "verdict", "reason"])
    place = itemgetter("drive_id", "rule_id")
    verdicts, findings = counts.group_rows(reasons, place), counts.group_rows(result.findings.to_pylist(), place)
    rules = result.rules.to_pylist()
    for drive in result.drives.to_pylist():
        about = f"Rules of the road, checked on the drive {drive['drive_id']}"
        name = f"drivelint {drive['drive_id']}"  # ASAM's reader merges bundles of the same name
        bundle = add_element(root, "CheckerBundle", build_date="", name=name, version=__version__, description=about)
        add_element(bundle, "Param", name="InputFile", value=drive["file_name"])
        add_element(bundle, "Param", name="Sha256", value=drive["sha256"] or "unknown")
        add_element(bundle, "Param", name="MapFile", value=drive["map_name"] or "none")
        total: Counter[str] = Counter()
        for rule in rules:
            at = drive["drive_id"], rule["rule_id"]
            total += _write_checker_and_return_verdict_counts(
                bundle, rule, drive, verdicts.get(at, ()), findings.get(at, ()), gate=result.gate
            )
        is_judged = drive["status"] == "judged"
        summary = _counts_text(total) if is_judged else f"not judged: {drive['status_reason'] or 'no reason given'}"
        bundle.set("summary", replace_non_xml(summary))
    for number, issue in enumerate(root.iter("Issue")):  # ASAM's reader needs numbers that are unique in the file
        issue.set("issueId", str(number))
    return xml_bytes(root)


def rule_uid(rule_id: str, pack: str) -> str:
    """Return a rule's id in ASAM's notation: entity, standard, version and name, of letters, digits, dots and underscores."""
    name = rule_id.removeprefix(f"{pack}.")
    parts = (re.sub(r"[^a-z0-9_]", "_", part.lower()) for part in name.split("."))
    dotted = ".".join(part if part[:1].isalpha() else f"r{part}" for part in parts)
    release = ".".join(re.findall(r"\d+", __version__)[:3])
    return f"drivelint.rules:{re.sub('[^a-z]', '', pack.lower()) or 'custom'}:{release}:{dotted}"


def _write_checker_and_return_verdict_counts(
    bundle: etree._Element,
    rule: Row,
    drive: Row,
    verdict_rows: Sequence[Row],
    findings: Sequence[Row],
    *,
    gate: Gate | None,
) -> Counter[str]:
    """Write the checker of one rule in one drive: parameters, issues, rule id and counts. Return the counts of its verdicts."""
    verdict_counts: Counter[str] = Counter()
    for row in verdict_rows:
        verdict_counts[row["verdict"]] += row["count_all"]
    is_judged = verdict_counts["pass"] or verdict_counts["fail"] or findings
    status = "error" if verdict_counts["error"] else "completed" if is_judged else "skipped"
    why = (
        "" if status == "completed" else "; ".join(with_count(row["reason"], row["count_all"]) for row in verdict_rows)
    )
    no_verdict_text = "the drive was not judged" if drive["status"] != "judged" else "no verdict"
    summary = _counts_text(verdict_counts) if verdict_rows else no_verdict_text
    checker = add_element(
        bundle,
        "Checker",
        checkerId=rule["rule_id"],
        description=f"{rule['title']}: {rule['clause']}",
        summary=f"{summary}; {why}" if why else summary,
        status=status,
    )
    for param in rule["params"]:
        add_element(checker, "Param", name=param["name"], value=f"{param['value']} {param['unit'] or ''}".rstrip())
    for event in events_by_status(gate, findings):
        _write_event(checker, event, rule, drive["t_start_ns"], gate)
    for row in verdict_rows if status != "skipped" else ():
        if row["verdict"] in {"unknown", "error"}:
            text = f"{row['verdict']}, neither kept nor broken: {with_count(row['reason'], row['count_all'])}"
            _add_issue(checker, rule, INFORMATION_LEVEL, text)
    add_element(checker, "AddressedRule", ruleUID=rule_uid(rule["rule_id"], rule["pack"]))
    for verdict in counts.VERDICTS:
        add_element(
            checker, "Metadata", key=verdict, value=str(verdict_counts[verdict]), description="verdicts of this kind"
        )
    return verdict_counts


def _write_event(checker: etree._Element, event: Event, rule: Row, start_ns: int | None, gate: Gate | None) -> None:
    row = event.finding
    waiver = gate.waiver(row["finding_id"]) if gate else None
    stable = rule["status"] == "stable"
    profile = "" if row["profile"] is None else f"profile {row['profile']}: "
    moment = when(row, {rule["rule_id"]: rule}, start_ns)
    text = profile + verdict_or_finding_line(row, moment)
    also = [event.other_rows_words] if event.other_rows else []
    notes = also + ([] if stable else [f"{rule['status']}, does not gate"])
    notes += [descriptions.waiver_reason_phrase(waiver)] if waiver else []
    notes += ["known: the baseline contains it"] if gate and gate.is_in_baseline(row["finding_id"]) else []
    level = LEVELS[row["severity"]] if stable and waiver is None else INFORMATION_LEVEL
    issue = _add_issue(checker, rule, level, f"{text} ({'; '.join(notes)})" if notes else text)
    where = f"{ego_and_object_names(row)}, {moment} into the drive; map metres"
    place = add_element(issue, "Locations", description=where)
    if row["x_m"] is not None and row["y_m"] is not None:
        add_element(place, "InertialLocation", x=repr(row["x_m"]), y=repr(row["y_m"]), z="0.0")
    add_element(place, "TimeLocation", time=repr(row["t_worst_ns"] / 1e9))
    names = ("finding_id", "profile", "ego_id", "object_id", "observed", "required", "margin", "unit", "lanelet_id")
    info = add_element(issue, "DomainSpecificInfo", name="drivelint")
    for finding in (row, *event.other_rows):
        add_element(info, "Finding", **{name: str(finding[name]) for name in names if finding[name] is not None})


def _add_issue(checker: etree._Element, rule: Row, level: str, text: str) -> etree._Element:
    uid = rule_uid(rule["rule_id"], rule["pack"])
    return add_element(checker, "Issue", issueId="", description=text, level=level, ruleUID=uid)


def _counts_text(verdict_counts: Mapping[str, int]) -> str:
    return ", ".join(f"{verdict_counts.get(verdict, 0)} {verdict.replace('_', ' ')}" for verdict in counts.VERDICTS)
