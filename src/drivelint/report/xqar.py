"""`report.xqar`: ASAM's quality checker results (2025-08), a bundle per drive, a checker per rule.

In that format a completed checker without issues reads as a pass. So a rule that judged nothing is `skipped`, with how often
it was unknown or not applicable and why, and where it judged in part, each unknown is an issue of the level information.
"""

from __future__ import annotations

import re
from collections import Counter, defaultdict
from typing import TYPE_CHECKING, Any, Final

from lxml import etree

from drivelint import __version__
from drivelint.gate import descriptions
from drivelint.report.xml import replace_non_xml
from drivelint.result import counts
from drivelint.result.text import line, seconds, subject, with_count

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from drivelint.result.model import Result
    from drivelint.result.text import Row

LEVELS: Final = {"critical": "1", "major": "2", "minor": "3"}
"""Severity -> error, warning, information. Drafts and waived findings are information: they do not gate."""
INFORMATION: Final = "3"


def render(result: Result) -> bytes:
    """Return the results as UTF-8 XML; the same result gives the same bytes, so no build date is given."""
    root = etree.Element("CheckerResults", version="1.0.0")
    said: dict[tuple[str, str], Counter[tuple[str, str]]] = defaultdict(Counter)
    for row in _reasons(result):
        said[row["drive_id"], row["rule_id"]][row["verdict"], row["reason"]] += row["count_all"]
    found: dict[tuple[str, str], list[Row]] = defaultdict(list)
    for row in result.findings.to_pylist():
        found[row["drive_id"], row["rule_id"]].append(row)
    rules, number = result.rules.to_pylist(), 0
    for drive in result.drives.to_pylist():
        judged = drive["status"] == "judged"
        bundle = etree.SubElement(root, "CheckerBundle", build_date="", name="drivelint", version=__version__)
        bundle.set("description", replace_non_xml(f"Rules of the road, held against the drive {drive['drive_id']}"))
        _param(bundle, "InputFile", drive["file_name"])
        _param(bundle, "Sha256", drive["sha256"] or "unknown")
        _param(bundle, "MapFile", drive["map_name"] or "none")
        total: Counter[str] = Counter()
        for rule in rules:
            at = drive["drive_id"], rule["rule_id"]
            checker = _Checker(bundle, rule, drive, number)
            checker.write(said.get(at, Counter()), found.get(at, ()), result)
            number = checker.number
            total.update(checker.told)
        summary = _counted(total) if judged else f"not judged: {drive['status_reason'] or 'no reason given'}"
        bundle.set("summary", replace_non_xml(summary))
    return bytes(etree.tostring(root, xml_declaration=True, encoding="UTF-8", pretty_print=True))


def rule_uid(rule_id: str, pack: str) -> str:
    """Return a rule's id as ASAM writes one: entity, standard, version, name; of letters, digits, dots and underscores."""
    name = rule_id.removeprefix(f"{pack}.")
    parts = (re.sub(r"[^a-z0-9_]", "_", part.lower()) for part in name.split("."))
    dotted = ".".join(part if part[:1].isalpha() else f"r{part}" for part in parts)
    return f"drivelint.rules:{re.sub('[^a-z]', '', pack.lower()) or 'custom'}:{_release()}:{dotted}"


def _release() -> str:
    """Return the release as digits and dots."""
    return ".".join(re.findall(r"\d+", __version__)[:3])


def _reasons(result: Result) -> list[Row]:
    columns = ["drive_id", "rule_id", "verdict", "reason"]
    rows = result.verdicts.group_by(columns, use_threads=False).aggregate([([], "count_all")])
    return list(rows.to_pylist())


class _Checker:
    """One rule in one drive; issues are numbered through the whole file, as ASAM's reader wants it."""

    def __init__(self, bundle: etree._Element, rule: Row, drive: Row, number: int) -> None:
        self._element = etree.SubElement(bundle, "Checker", checkerId=replace_non_xml(rule["rule_id"]))
        self._element.set("description", replace_non_xml(f"{rule['title']}: {rule['clause']}"))
        self._uid = rule_uid(rule["rule_id"], rule["pack"])
        self._rule = rule
        self._drive = drive
        self.number = number
        self.told: Counter[str] = Counter()

    def write(self, said: Mapping[tuple[str, str], int], findings: Sequence[Row], result: Result) -> None:
        """Write what was said: parameters, issues, the rule, counts."""
        for (verdict, _), n in said.items():
            self.told[verdict] += n
        open_ = {at: n for at, n in said.items() if at[0] in {"unknown", "error"}}
        judged = self.told["pass"] or self.told["fail"] or findings
        status = "error" if self.told["error"] else "completed" if judged else "skipped"
        why = "" if status == "completed" else "; ".join(with_count(reason, n) for (_, reason), n in said.items())
        none = "the drive was not judged" if self._drive["status"] != "judged" else "no verdict"
        summary = _counted(self.told) if said else none
        self._element.set("summary", replace_non_xml(f"{summary}; {why}" if why else summary))
        self._element.set("status", status)
        for param in self._rule["params"]:
            _param(self._element, param["name"], f"{param['value']} {param['unit'] or ''}".rstrip())
        for row in findings:
            self._finding(row, result)
        for (verdict, reason), n in open_.items() if status != "skipped" else ():
            self._issue(INFORMATION, f"{verdict}, neither kept nor violated: {with_count(reason, n)}")
        etree.SubElement(self._element, "AddressedRule", ruleUID=self._uid)
        for verdict in counts.VERDICTS:
            data = etree.SubElement(self._element, "Metadata", key=verdict, value=str(self.told[verdict]))
            data.set("description", "verdicts of this kind")

    def _finding(self, row: Row, result: Result) -> None:
        gate = result.gate
        waiver = gate.waiver(row["finding_id"]) if gate else None
        stable = self._rule["status"] == "stable"
        start_ns = self._drive["t_start_ns"]
        profile = "" if row["profile"] is None else f"profile {row['profile']}: "
        text = profile + line(row, start_ns)
        notes = [] if stable else [f"{self._rule['status']}, does not gate"]
        notes += [descriptions.waiver_reason(waiver)] if waiver else []
        notes += ["known: the baseline has it"] if gate and gate.in_baseline(row["finding_id"]) else []
        level = LEVELS[row["severity"]] if stable and waiver is None else INFORMATION
        issue = self._issue(level, f"{text} ({'; '.join(notes)})" if notes else text)
        place = etree.SubElement(issue, "Locations")
        place.set(
            "description",
            replace_non_xml(f"{subject(row)}, {seconds(row['t_worst_ns'], start_ns)} into the drive; map metres"),
        )
        if row["x_m"] is not None and row["y_m"] is not None:
            etree.SubElement(place, "InertialLocation", x=repr(row["x_m"]), y=repr(row["y_m"]), z="0.0")
        etree.SubElement(place, "TimeLocation", time=repr(row["t_worst_ns"] / 1e9))
        info = etree.SubElement(etree.SubElement(issue, "DomainSpecificInfo", name="drivelint"), "Finding")
        names = ("finding_id", "profile", "ego_id", "object_id", "observed", "required", "margin", "unit", "lanelet_id")
        values: dict[str, Any] = {name: row[name] for name in names}
        for name, value in values.items():
            if value is not None:
                info.set(name, replace_non_xml(str(value)))

    def _issue(self, level: str, text: str) -> etree._Element:
        issue = etree.SubElement(
            self._element, "Issue", issueId=str(self.number), description=replace_non_xml(text), level=level
        )
        issue.set("ruleUID", self._uid)
        self.number += 1
        return issue


def _param(parent: etree._Element, name: str, value: str) -> None:
    etree.SubElement(parent, "Param", name=replace_non_xml(name), value=replace_non_xml(value))


def _counted(told: Mapping[str, int]) -> str:
    return ", ".join(f"{told.get(verdict, 0)} {verdict.replace('_', ' ')}" for verdict in counts.VERDICTS)
