"""Finds the verdict that a user names by a finding's id, a rule, or a rule in a drive."""

from __future__ import annotations

from dataclasses import dataclass
from difflib import get_close_matches
from typing import TYPE_CHECKING, Any

from drivelint.errors import UsageError
from drivelint.phrases import plural
from drivelint.result.counts import one_finding_per_event
from drivelint.result.text import seconds

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from drivelint.explain.model import Row
    from drivelint.result.model import Result

MAX_OTHER_VERDICTS = 6
_VERDICT_RANKS = {"error": 0, "fail": 1, "unknown": 2, "pass": 3, "not_applicable": 4}


@dataclass(frozen=True)
class Target:
    """The verdict to explain, the named finding if any, and the other verdicts of the rule in the drive.

    `worst_finding`: the named finding, else the finding with the verdict's worst step; None: the verdict is no fail.
    """

    verdict: Row
    finding: Row | None
    other_verdicts: list[Row]
    worst_finding: Row | None

    @property
    def verdict_row(self) -> Row:
        """The verdict; if a finding was named, with the finding's interval, numbers and reason."""
        return self.verdict if self.finding is None else self.verdict | self.finding

    @property
    def judged_span_ns(self) -> tuple[int, int] | None:
        """Start and end of the judged interval; None if the verdict is about the whole drive."""
        start, end = self.verdict_row["t_start_ns"], self.verdict_row["t_end_ns"]
        return None if start is None or end is None else (start, end)


@dataclass(frozen=True)
class VerdictFilter:
    """Conditions that select among the verdicts of one rule; None: no condition. Of the remaining verdicts, the worst is explained."""

    profile: str | None = None
    object_id: str | None = None
    at_s: float | None = None
    ego_id: str | None = None
    verdict: str | None = None


def find_verdict(result: Result, name: str, verdict_filter: VerdictFilter) -> Target:
    """Return the verdict with this name: FINDING_ID, RULE or RULE@DRIVE, where an unambiguous beginning is enough.

    Errors: `UsageError` for an unknown name, with the most similar known name, and for an ambiguous beginning.
    """
    findings = result.findings.to_pylist()
    verdicts = result.verdicts.to_pylist()
    ids = sorted({row["finding_id"] for row in findings})
    if matches := [i for i in ids if i.startswith(name)]:
        exact = name if name in matches else _only_match(name, matches, "findings")
        finding = next(row for row in findings if row["finding_id"] == exact)
        row = min(_verdicts_of_finding(finding, verdicts), key=_worst_first_key)
        return Target(row, finding, _other_verdicts(row, verdicts), finding)
    rule, _, drive = name.partition("@")
    rule = _rule_of_name(rule, sorted({row["rule_id"] for row in verdicts}), len(one_finding_per_event(findings)))
    rows = [row for row in verdicts if row["rule_id"] == rule]
    if drive:
        drive = _complete_name(drive, sorted({row["drive_id"] for row in rows}), f"{rule}: drive")
        rows = [row for row in rows if row["drive_id"] == drive]
    row = min(_matching_verdicts(rows, verdict_filter, result.start_times), key=_worst_first_key)
    return Target(row, None, _other_verdicts(row, verdicts), _finding_with_worst_step(row, findings))


def _verdicts_of_finding(finding: Row, verdicts: Iterable[Row]) -> list[Row]:
    """Return the verdicts to which a finding belongs. Errors: `UsageError` if there is none."""
    same = ("drive_id", "ego_id", "rule_id", "profile", "ref_id")
    rows = [row for row in verdicts if all(row[key] == finding[key] for key in same) and row["verdict"] == "fail"]
    exact = [
        row
        for row in rows
        if row["ref_id"] is not None
        or (row["object_id"] == finding["object_id"] and row["t_start_ns"] <= finding["t_start_ns"] <= row["t_end_ns"])
    ]
    if not (exact or rows):
        raise UsageError(
            f"finding {finding['finding_id']}: the result contains no verdict of it: check the drives again"
        )
    return exact or rows


def _finding_with_worst_step(row: Row, findings: Iterable[Row]) -> Row | None:
    """Return the finding that contains the worst step of a failed verdict; None for other verdicts."""
    same = ("drive_id", "ego_id", "rule_id", "profile", "ref_id", "object_id", "t_worst_ns")
    return next((f for f in findings if row["verdict"] == "fail" and all(f[key] == row[key] for key in same)), None)


def _matching_verdicts(rows: list[Row], verdict_filter: VerdictFilter, starts: dict[str, int | None]) -> list[Row]:
    for key in ("ego_id", "profile", "object_id", "verdict"):
        value = getattr(verdict_filter, key)
        if value is not None:
            values = sorted({row[key] for row in rows if row[key] is not None})
            rows = [row for row in rows if row[key] == value]
            if not rows:
                raise UsageError(
                    f"no verdict for {key.replace('_id', '')} {value!r}; there are {', '.join(values) or 'none'}"
                )
    if verdict_filter.at_s is None:
        return rows
    around = [row for row in rows if _covers_time(row, verdict_filter.at_s, starts)]
    if not around:
        spans = sorted({_span_text(row, starts) for row in rows if row["t_start_ns"] is not None})
        there = ", ".join(spans[:MAX_OTHER_VERDICTS]) or "none"
        raise UsageError(
            f"no such verdict of {rows[0]['rule_id']} includes {verdict_filter.at_s:g} s of the drive; its verdicts have the times {there}"
        )
    return around


def _span_text(row: Row, starts: dict[str, int | None]) -> str:
    start, end = (seconds(row[key], starts[row["drive_id"]]) for key in ("t_start_ns", "t_end_ns"))
    return start if start == end else f"{start} to {end}"


def _covers_time(row: Row, at_s: float, starts: dict[str, int | None]) -> bool:
    if row["t_start_ns"] is None or row["t_end_ns"] is None:
        return False
    t_ns = round(at_s * 1e9) + (starts.get(row["drive_id"]) or 0)
    return bool(row["t_start_ns"] - 1_000_000 <= t_ns <= row["t_end_ns"] + 1_000_000)


def _worst_first_key(row: Row) -> tuple[Any, ...]:
    """Return a sort key that puts the worst verdict first: by kind of verdict, then by margin, name and time."""
    margin = row["margin"]
    return (
        _VERDICT_RANKS[row["verdict"]],
        float("-inf") if margin is None else margin,
        row["drive_id"],
        row["ego_id"],
        row["t_start_ns"] or 0,
        row["profile"] or "",
        row["object_id"] or "",
        row["occurrence"],
    )


def _other_verdicts(row: Row, verdicts: Iterable[Row]) -> list[Row]:
    """Return the other verdicts of the rule in the drive, worst first."""
    keys = ("ego_id", "profile", "object_id", "t_start_ns", "verdict")
    others_of_rule = [
        v for v in verdicts if v["drive_id"] == row["drive_id"] and v["rule_id"] == row["rule_id"] and v is not row
    ]
    return [{key: v[key] for key in keys} for v in sorted(others_of_rule, key=_worst_first_key)]


def _rule_of_name(name: str, rules: Sequence[str], n_findings: int) -> str:
    if name in rules:
        return name
    matches = [r for r in rules if r.startswith(name)] or [r for r in rules if name in r]
    if matches:
        return _only_match(name, matches, "rules")
    near = get_close_matches(name, [*rules, *(r.partition(".")[2] for r in rules)], n=1, cutoff=0.4)
    hint = (
        f"it has {plural(n_findings, 'finding')} and {plural(len(rules), 'rule')}, such as {rules[0]}" if rules else ""
    )
    if near:
        hint = f"did you mean {near[0]!r}?"
    raise UsageError(f"no finding begins with {name!r}, and no rule of this result has this name; {hint}")


def _complete_name(name: str, names: Sequence[str], kind: str) -> str:
    if name in names:
        return name
    # a drive's id is its log's name and a part of its hash: a whole log name takes precedence over beginnings of ids
    matches = [k for k in names if k.rpartition("-")[0] == name] or [k for k in names if k.startswith(name)]
    if not matches:
        near = get_close_matches(name, names, n=1, cutoff=0.3)
        raise UsageError(f"{kind} {name!r} is not in this result; did you mean {(near or names)[0]!r}?")
    return _only_match(name, matches, "drives")


def _only_match(name: str, matches: Sequence[str], kinds: str) -> str:
    if len(matches) > 1:
        listed = ", ".join(matches[:5]) + (", ..." if len(matches) > 5 else "")
        raise UsageError(f"{name!r} is the beginning of several {kinds}: {listed}: give more characters of the name")
    return matches[0]
