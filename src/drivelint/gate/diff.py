"""Compares two results: which findings are new, fixed, changed, unchanged, unknown now or lost."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace
from typing import TYPE_CHECKING, Any, Final

import pyarrow as pa
import pyarrow.compute as pc

from drivelint.gate import match
from drivelint.gate.lookup import LookupResult, ResultLookup
from drivelint.result import counts
from drivelint.result.gate import ComparedFinding, Difference, NewUnknowns
from drivelint.result.text import number

if TYPE_CHECKING:
    from collections.abc import Mapping

    from drivelint.gate.match import TimedFinding
    from drivelint.result.model import Result

    Row = Mapping[str, Any]

MARGIN_TOLERANCE: Final = 0.01
"""A margin has changed by more than this, in its unit, and by more than this part of what is required."""
INTERVAL_TOLERANCE_S: Final = 0.1
"""A failing stretch has changed if one of its ends moved by more."""

_OPEN: Final = pa.array(["unknown", "error"])


def compare(base: Result, new: Result, base_name: str = "base", name: str = "new") -> Difference:
    """Return the difference of two results; names are for the reader.

    Drives are the same by `drive_id`, else by their file's stem. NEW's findings come in their order, then what BASE had.
    """
    had, has = ResultLookup(base), ResultLookup(new)
    same = match.match_drives(list(had.drives.values()), list(has.drives.values()))
    entries: list[ComparedFinding] = []
    gone: list[ComparedFinding] = []
    for drive_id in dict.fromkeys([*has.findings, *same]):
        found, left = _drive(had, has, same.get(drive_id), drive_id)
        entries += found
        gone += left
    known = set(same.values())
    for drive_id, stretches in had.findings.items():
        if drive_id not in known:
            gone += [_gone(each, drive_id, has.verdict_at(None, each, same_log=False), had) for each in stretches]
    return Difference(
        entries=(*entries, *gone),
        opened=tuple(_opened(base, new, same, has)),
        base_verdicts=counts.total(base.verdicts),
        verdicts=counts.total(new.verdicts),
        base_only=tuple(sorted(drive for drive in had.drives if drive not in known)),
        new_only=tuple(sorted(drive for drive in has.drives if drive not in same)),
        base_name=base_name,
        name=name,
    )


def _drive(
    had: ResultLookup, has: ResultLookup, base_id: str | None, drive_id: str
) -> tuple[list[ComparedFinding], list[ComparedFinding]]:
    """Return the entries of one drive: of NEW's findings, and of those that BASE had and NEW has not."""
    theirs = [] if base_id is None else had.findings.get(base_id, [])
    ours = has.findings.get(drive_id, [])
    same_log = base_id is not None and had.drives[base_id]["sha256"] == has.drives[drive_id]["sha256"]
    pairs = match.match_findings(theirs, ours, same_log=same_log)
    told = set(pairs.values())
    entries: list[ComparedFinding] = []
    for i, now in enumerate(ours):
        if i in pairs:
            entries.append(_kept(now, theirs[pairs[i]], has))
        elif wholes := [j for j, each in enumerate(theirs) if match.is_part_of(now, each, same_log=same_log)]:
            told.add(wholes[0])
            was = theirs[wholes[0]]
            entries.append(_entry("changed", now, was, has, LookupResult("fail", f"a part of {was.id}, which was one")))
        else:
            said = had.verdict_at(base_id, now, same_log=same_log)
            entries.append(_entry("new", now, None, has, _noting_rule(said, now, had, has)))
    gone: list[ComparedFinding] = []
    for was in (each for j, each in enumerate(theirs) if j not in told):
        wholes = [i for i in sorted(pairs) if match.is_part_of(was, ours[i], same_log=same_log)]
        if wholes:
            gone.append(
                _entry("changed", ours[wholes[0]], was, has, LookupResult("fail", f"{was.id} is a part of it now"))
            )
        else:
            said = _noting_rule(has.verdict_at(drive_id, was, same_log=same_log), was, had, has)
            gone.append(_gone(was, drive_id, said, had))
    return entries, gone


def _noting_rule(said: LookupResult, at: TimedFinding, had: ResultLookup, has: ResultLookup) -> LookupResult:
    """Add what may be the cause: that the two results had not the same rule."""
    a, b = (lookup.rules.get(at.row["rule_id"]) for lookup in (had, has))
    if a is None or b is None or (a["rule_version"], a["params"]) == (b["rule_version"], b["params"]):
        return said
    return said._replace(why=f"{said.why} The rule or its parameters changed.")


def _kept(now: TimedFinding, was: TimedFinding, has: ResultLookup) -> ComparedFinding:
    """Return a finding that both results have, and how it changed."""
    notes = []
    if now.row["severity"] != was.row["severity"]:
        notes.append(f"severity {now.row['severity']}, was {was.row['severity']}")
    if _differs(now.row, was.row):
        unit = now.row["unit"]
        notes.append(f"margin {number(now.row['margin'], unit)}, was {number(was.row['margin'], unit)}")
    if max(abs(now.start - was.start), abs(now.end - was.end)) > INTERVAL_TOLERANCE_S:
        notes.append(f"{now.start:.2f} s to {now.end:.2f} s, was {was.start:.2f} s to {was.end:.2f} s")
    return _entry("changed" if notes else "unchanged", now, was, has, LookupResult("fail", "; ".join(notes)))


def _differs(now: Row, was: Row) -> bool:
    """Return whether two margins differ by more than can be overlooked."""
    a, b = now["margin"], was["margin"]
    if a is None or b is None or a == b:
        return bool(a != b)
    allowed = max(MARGIN_TOLERANCE, MARGIN_TOLERANCE * max(abs(row["required"] or 0.0) for row in (now, was)))
    return not abs(a - b) <= allowed


def _gone(was: TimedFinding, drive_id: str, said: LookupResult, had: ResultLookup) -> ComparedFinding:
    """Return a finding that only BASE has: fixed only if NEW looked there and found the rule kept, or not applicable."""
    standing = {"pass": "fixed", "not_applicable": "fixed", "none": "lost"}.get(said.verdict, "unknown")
    return replace(_entry(standing, was, was, had, said), drive_id=drive_id)


def _entry(
    standing: str, at: TimedFinding, was: TimedFinding | None, lookup: ResultLookup, said: LookupResult
) -> ComparedFinding:
    same = ("finding_id", "drive_id", "ego_id", "rule_id", "profile", "object_id", "severity", "margin", "unit")
    return ComparedFinding(
        standing=standing,
        **{name: at.row[name] for name in same},
        base_id=None if was is None else was.id,
        stable=lookup.is_stable(at.row["rule_id"]),
        t_s=round(at.worst, 3),
        base_margin=None if was is None else was.row["margin"],
        there=said.verdict,
        why=said.why,
    )


def _opened(base: Result, new: Result, same: Mapping[str, str], has: ResultLookup) -> list[NewUnknowns]:
    """Return where more verdicts are unknown or in error than were."""
    was, _ = _unknown(base)
    now, reasons = _unknown(new)
    found = []
    for at, n in now.items():
        drive_id, ego_id, rule_id, profile = at
        before = was[same.get(drive_id, ""), ego_id, rule_id, profile]
        if n > before:
            found.append(
                NewUnknowns(drive_id, ego_id, rule_id, profile, has.is_stable(rule_id), n, before, reasons[at])
            )
    return sorted(found, key=lambda each: (each.drive_id, each.ego_id, each.rule_id, each.profile or ""))


def _unknown(result: Result) -> tuple[Counter[Any], dict[Any, str]]:
    """Return (drive, ego, rule, profile) -> rows that are unknown or in error, and the reason given most often."""
    rows = result.verdicts.filter(pc.is_in(result.verdicts["verdict"], value_set=_OPEN))
    columns = ["drive_id", "ego_id", "rule_id", "profile"]
    n: Counter[Any] = Counter()
    reasons: dict[Any, tuple[int, str]] = {}
    for row in rows.group_by([*columns, "reason"], use_threads=False).aggregate([([], "count_all")]).to_pylist():
        at = tuple(row[name] for name in columns)
        n[at] += row["count_all"]
        said = (-row["count_all"], row["reason"])
        reasons[at] = min(reasons.get(at, said), said)
    return n, {at: reason for at, (_, reason) in reasons.items()}
