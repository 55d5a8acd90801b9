"""Looks up the finding or near miss that a user names, with its drive and rule."""

from __future__ import annotations

import hashlib
import json
import math
import shlex
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Final

import pyarrow.compute as pc

from drivelint.catalogue.header import CONTACT_TAG
from drivelint.errors import UsageError
from drivelint.explain.target import VerdictFilter, find_verdict
from drivelint.incident.motion import MotionOfParties
from drivelint.phrases import name_list, plural
from drivelint.report.worst_first import is_contact, worst_first

if TYPE_CHECKING:
    import pyarrow as pa

    from drivelint.result.model import Result
    from drivelint.result.text import Row

_NEAR_MISS_ID_PREFIX: Final = "near-miss-"
"""The beginning of the id of a near miss; the ids of findings are hexadecimal numbers."""
_COLUMNS_EQUAL_IN_FINDING_AND_VERDICT: Final = ("drive_id", "ego_id", "rule_id", "profile", "ref_id")


@dataclass(frozen=True)
class NamedFinding:
    """One finding of a result: its rows of `finding`, `drive` and `rule`.

    `is_near_miss`: it is a near miss; `row` is then its row of `verdict`, with the columns that only findings have.
    """

    row: Row
    drive: Row
    rule: Row
    is_near_miss: bool = False

    @property
    def is_contact(self) -> bool:
        """Whether the finding is a contact."""
        return CONTACT_TAG in self.rule["tags"] and not self.is_near_miss

    @property
    def moment_ns(self) -> int:
        """The moment of the finding, from which the sheet counts time: the first step of a contact, else the worst step."""
        return int(self.row["t_start_ns" if self.is_contact else "t_worst_ns"])

    @property
    def drive_start_ns(self) -> int:
        """The drive's first time stamp."""
        return self.drive["t_start_ns"] or 0

    @property
    def parties(self) -> list[str]:
        """The ego, and the other actor if there is one."""
        return [name for name in (self.row["ego_id"], self.row["object_id"]) if name is not None]


def named_finding(result: Result, name: str, *, with_near_misses: bool = False) -> NamedFinding:
    """Return the finding with a name that `explain` accepts; a rule means its worst finding, `contact[@DRIVE]` the worst contact.

    `with_near_misses`: if the rule was not broken, return its nearest miss.
    Errors: `UsageError` if nothing has this name, or if the verdict is neither a finding nor a near miss.
    """
    drives = {drive["drive_id"]: drive for drive in result.drives.to_pylist()}
    rules = {rule["rule_id"]: rule for rule in result.rules.to_pylist()}
    word, _, drive_id = name.partition("@")
    is_near_miss = with_near_misses and name.startswith(_NEAR_MISS_ID_PREFIX)
    if word == CONTACT_TAG:
        contacts = [row for row in contact_findings(result) if row["drive_id"].startswith(drive_id)]
        if not contacts:
            raise UsageError(f"--incident {name}: {_no_contact_message(result, drive_id)}")
        row = contacts[0]
    elif is_near_miss:
        row = _near_miss_with_id(result, name)
    else:
        target = find_verdict(result, name, VerdictFilter())
        may_be_near = with_near_misses and target.finding is None and target.verdict["verdict"] != "fail"
        near = _nearest_miss_of_rule(result, target.verdict, is_same_drive=bool(drive_id)) if may_be_near else None
        is_near_miss = near is not None
        row = near or target.finding or _worst_finding_of_verdict(target.verdict, result)
    return NamedFinding(row, drives[row["drive_id"]], rules[row["rule_id"]], is_near_miss)


def near_misses(result: Result) -> list[Row]:
    """Return the near misses of a result as rows of `verdict`, with the columns that only findings have; the nearest first."""
    rows = result.verdicts.filter(
        pc.and_(pc.fill_null(result.verdicts["near_miss"], False), pc.is_valid(result.verdicts["t_worst_ns"]))
    ).to_pylist()
    content = {drive["drive_id"]: drive["sha256"] for drive in result.drives.to_pylist()}
    tags = {rule["rule_id"]: rule["tags"] for rule in result.rules.to_pylist()}
    unknown = dict.fromkeys(("n_copies", "n_stays", "closing_mps", "lat", "lon"))
    misses = [{**unknown, **row, "finding_id": _near_miss_id(row, content[row["drive_id"]])} for row in rows]
    # margins of different units do not compare: a near miss of a contact is the nearest
    return sorted(
        misses,
        key=lambda row: (CONTACT_TAG not in tags[row["rule_id"]], row["margin"], row["drive_id"], row["finding_id"]),
    )


def near_miss_with_closing_speed(finding: NamedFinding, steps: pa.Table) -> NamedFinding:
    """Return a near miss with the closing speed at its moment. `steps`: rows of `queries/incident/step.sql`."""
    motion = MotionOfParties.of_steps(steps, finding.moment_ns)
    at = motion.nearest_step(0.0)
    closing_mps = math.nan if at is None else float(motion.closing[at])
    return replace(finding, row={**finding.row, "closing_mps": None if math.isnan(closing_mps) else closing_mps})


def _near_miss_id(row: Row, content_sha256: str) -> str:
    parts = [content_sha256, *(row[name] for name in ("ego_id", "rule_id", "profile", "object_id", "occurrence"))]
    return f"{_NEAR_MISS_ID_PREFIX}{hashlib.sha256(json.dumps(parts).encode()).hexdigest()[:16]}"


def _near_miss_with_id(result: Result, id_prefix: str) -> Row:
    """Return the near miss whose id begins with `id_prefix`. Errors: `UsageError` if there is none, or more than one."""
    misses = [row for row in near_misses(result) if row["finding_id"].startswith(id_prefix)]
    if len(misses) != 1:
        raise UsageError(
            f"--incident {id_prefix}: {'several near misses have' if misses else 'no near miss has'} an id with this beginning: "
            "name it by its rule and drive (RULE@DRIVE)"
        )
    return misses[0]


def _nearest_miss_of_rule(result: Result, verdict: Row, *, is_same_drive: bool) -> Row | None:
    """Return the nearest miss of a verdict's rule, in its drive only if `is_same_drive`; None if there is none."""
    keys = ("rule_id", "drive_id") if is_same_drive else ("rule_id",)
    return next((row for row in near_misses(result) if all(row[key] == verdict[key] for key in keys)), None)


def contact_findings(result: Result) -> list[Row]:
    """Return the findings that are contacts, the worst first, sure findings before findings that are only possible."""
    rules = {rule["rule_id"]: rule for rule in result.rules.to_pylist()}
    findings: list[Row] = worst_first(result.findings, rules).to_pylist()
    return [row for row in findings if is_contact(row, rules)]


def _no_contact_message(result: Result, drive_id_prefix: str) -> str:
    """Return what to do if no finding is a contact. `drive_id_prefix`: the beginning of the drive's id; '' for all drives."""
    near = [row for row in near_misses(result) if row["drive_id"].startswith(drive_id_prefix)]
    broken = {(row["rule_id"], row["drive_id"]) for row in result.findings.to_pylist()}
    has_findings = any(drive.startswith(drive_id_prefix) for _, drive in broken)
    message = f"no finding is a contact{f' in {drive_id_prefix}' if drive_id_prefix else ''}"
    if near:
        rule, drive = near[0]["rule_id"], near[0]["drive_id"]
        name = near[0]["finding_id"] if (rule, drive) in broken else f"{rule}@{drive}"
        folder = "DIR" if result.folder is None else shlex.quote(str(result.folder))
        message += f": the nearest miss has a sheet: drivelint report {folder} --incident {name}"
        return f"{message}; or name another finding" if has_findings else message
    drives = [drive for drive in result.drives.to_pylist() if drive["drive_id"].startswith(drive_id_prefix)]
    unjudged = [drive for drive in drives if drive["status"] == "not_judged"]
    if unjudged and not has_findings:
        of_all = f"{len(unjudged)} of {plural(len(drives), 'drive')}"
        return f"{message}, but not judged: {of_all} ({unjudged[0]['status_reason']})"
    return f"{message}: {'name another finding' if has_findings else 'nothing was found there that a sheet could be about'}"


def _worst_finding_of_verdict(verdict: Row, result: Result) -> dict[str, Any]:
    """Return the worst finding of a verdict. Errors: `UsageError` if it has none."""
    rows = [
        row
        for row in result.findings.to_pylist()
        if all(row[key] == verdict[key] for key in _COLUMNS_EQUAL_IN_FINDING_AND_VERDICT)
    ]
    about = [row for row in rows if row["object_id"] == verdict["object_id"]] or rows
    if verdict["verdict"] != "fail" or not about:
        tags = {rule["rule_id"]: rule["tags"] for rule in result.rules.to_pylist()}
        there: set[str] = {
            row["rule_id"] for row in result.findings.to_pylist() if row["drive_id"] == verdict["drive_id"]
        }
        failed = sorted(there, key=lambda rule_id: (CONTACT_TAG not in tags[rule_id], rule_id))
        raise UsageError(
            f"{verdict['rule_id']} in {verdict['drive_id']} is {verdict['verdict'].replace('_', ' ')}, so it has no finding: "
            f"name a finding by its id, or a rule that failed there ({name_list(failed) or 'none did'})"
        )
    return min(about, key=lambda row: (row["margin"] is not None, row["margin"], row["t_worst_ns"], row["finding_id"]))
