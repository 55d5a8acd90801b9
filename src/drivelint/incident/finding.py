"""Looks up the finding that a user names, with its drive and rule."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

import pyarrow.compute as pc

from drivelint.catalogue.header import CONTACT_TAG
from drivelint.errors import UsageError
from drivelint.explain.target import VerdictFilter, find_verdict
from drivelint.phrases import name_list
from drivelint.report.worst_first import is_contact, worst_first

if TYPE_CHECKING:
    from drivelint.result.model import Result
    from drivelint.result.text import Row

_SAME: Final = ("drive_id", "ego_id", "rule_id", "profile", "ref_id")


@dataclass(frozen=True)
class NamedFinding:
    """One finding of a result: its rows of `finding`, `drive` and `rule`."""

    row: Row
    drive: Row
    rule: Row

    @property
    def is_contact(self) -> bool:
        """Whether the finding is a contact."""
        return CONTACT_TAG in self.rule["tags"]

    @property
    def moment_ns(self) -> int:
        """The moment of the finding, from which the sheet counts time: the first step of a contact, else the worst step."""
        return int(self.row["t_start_ns" if self.is_contact else "t_worst_ns"])

    @property
    def start_ns(self) -> int:
        """The drive's first time stamp."""
        return self.drive["t_start_ns"] or 0

    @property
    def parties(self) -> list[str]:
        """The ego, and the other actor if there is one."""
        return [name for name in (self.row["ego_id"], self.row["object_id"]) if name is not None]


def named_finding(result: Result, name: str) -> NamedFinding:
    """Return the finding with a name that `explain` accepts; a rule means its worst finding, `contact[@DRIVE]` the worst contact.

    Errors: `UsageError` if nothing has this name, or if the verdict is no finding.
    """
    drives = {drive["drive_id"]: drive for drive in result.drives.to_pylist()}
    rules = {rule["rule_id"]: rule for rule in result.rules.to_pylist()}
    word, _, drive_id = name.partition("@")
    if word == CONTACT_TAG:
        found = [row for row in contacts(result) if row["drive_id"].startswith(drive_id)]
        if not found:
            raise UsageError(f"--incident {name}: {_without_contact(result, drive_id)}")
        row = found[0]
    else:
        target = find_verdict(result, name, VerdictFilter())
        row = target.finding or _worst_of(target.verdict, result)
    return NamedFinding(row, drives[row["drive_id"]], rules[row["rule_id"]])


def contacts(result: Result) -> list[Row]:
    """Return the findings that are contacts, the worst first, sure findings before findings that are only possible."""
    rules = {rule["rule_id"]: rule for rule in result.rules.to_pylist()}
    found: list[Row] = worst_first(result.findings, rules).to_pylist()
    return [row for row in found if is_contact(row, rules)]


def _without_contact(result: Result, drive_id: str) -> str:
    """Return what to do if no finding is a contact. `drive_id`: the beginning of the drive's id; '' for all drives."""
    begins = pc.starts_with(result.verdicts["drive_id"], drive_id)
    near = result.verdicts.filter(pc.and_(begins, pc.fill_null(result.verdicts["near_miss"], False))).to_pylist()
    found = any(row["drive_id"].startswith(drive_id) for row in result.findings.to_pylist())
    told = [f"no finding is a contact{f' in {drive_id}' if drive_id else ''}"]
    told += ["name another finding"] if found else ["nothing was found there that a sheet could be about"]
    if near:
        nearest = min(near, key=lambda row: (row["margin"] is None, row["margin"], row["rule_id"]))
        named = f"{nearest['rule_id']}@{nearest['drive_id']}"
        told.append(f"of a near miss there is no sheet, but report.html and `drivelint explain {named}` tell of it")
    return ": ".join(told[:2]) + "".join(f"; {each}" for each in told[2:])


def _worst_of(verdict: Row, result: Result) -> dict[str, Any]:
    """Return the worst finding of a verdict. Errors: `UsageError` if it has none."""
    rows = [row for row in result.findings.to_pylist() if all(row[key] == verdict[key] for key in _SAME)]
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
