"""The difference of two audits in the terms of `drivelint diff`: all counts, and the most severe findings of each standing."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Final, NamedTuple

import duckdb

from drivelint.errors import UsageError
from drivelint.fleet.compare import UNCHANGED_INTERVAL_TOLERANCE_S, compare
from drivelint.fleet.distinct_logs import create_counted_views
from drivelint.fleet.rate_change import RateChange, RateTest, compare_rates
from drivelint.fleet_report.audit_views import BASE_PREFIX
from drivelint.fleet_report.rows import counted_finding_of_each_finding_sql, query_rows
from drivelint.gate.descriptions import DIFF_STATUS_TITLES, counts_sentence
from drivelint.phrases import plural
from drivelint.result.counts import SEVERITIES, VERDICTS, rows_and_findings_sentence
from drivelint.result.gate import DIFF_STATUSES, ComparedFinding
from drivelint.result.text import number
from drivelint.sql.statements import statement
from drivelint.sql.store import quoted

if TYPE_CHECKING:
    from pathlib import Path

    from drivelint.fleet.compare import Comparison
    from drivelint.fleet_report.audit_views import Audit
    from drivelint.fleet_report.rows import Row

NOTHING_IN_COMMON: Final = "the two audits have no drive in common: findings cannot be matched"
_LEAST_COMMON_SHARE: Final = 0.5
"""If a smaller share of the drives of the smaller audit is in both, the rates say more about the fleets than the findings."""
MIN_SHOWN_TESTS: Final = 5
"""The smallest number of shown tests of rates, even if fewer tests report a difference."""
_REASON_TEXTS: Final = {
    "drive_not_checked": "the drive was not checked",
    "drive_not_judged": "the drive could not be judged",
    "rule_not_run": "the rule was not run",
    "profile_not_run": "the profile was not run",
    "ego_not_judged": "the ego was not judged",
    "log_ends_before": "the log ends before the finding",
    "no_verdict": "the rule has no verdict",
    "ego_not_there": "the ego is not in this log, or has another id",
    "ego_not_recorded": "the ego is not recorded throughout the finding",
    "object_not_recorded": "the object is not recorded throughout the finding",
    "object_not_there": "the object is not in this log, or has another id",
    "not_applicable": "the rule does not apply there",
}
"""Reason code of `drivelint.fleet.compare` -> the reason as text."""
_SENTENCE_BY_OTHER_AUDITS_VERDICT: Final = {
    "pass": "the rule is kept there",
    "fail": "the rule still fails, at another step or place",
    "unknown": "the rule is unknown there",
    "error": "the rule could not be run there",
}
"""Verdict of the other audit -> the verdict as text, if the rule was judged there."""


class FindingEntry(NamedTuple):
    """A finding in the difference of two audits. `causes`: what else is known to differ; `causes_not_known`: what may differ but is not
    known.

    `new_key`: the drive's key in the newer audit; None: the newer audit does not have the drive.
    """

    finding: ComparedFinding
    log: str
    causes: tuple[str, ...]
    causes_not_known: tuple[str, ...]
    new_key: str | None


class DriveNoMoreJudged(NamedTuple):
    """A drive that the base judged and the newer audit could not judge. `log`, `new_key`: in the newer audit. `base_log`: in the base.
    `reason`: why it could not be judged."""

    log: str
    new_key: str
    base_log: str
    reason: str

    @property
    def log_and_reason(self) -> str:
        """The log and the reason. A reason that already begins with the log stays as it is."""
        return self.reason if self.reason.startswith(self.log) else f"{self.log}: {self.reason}"


class NewUnknowns(NamedTuple):
    """Verdicts that are unknown or errors only in the newer audit, in drives that both audits have. `reason`: an example."""

    reason_code: str
    cause_code: str | None
    reason: str
    n: int
    rules: list[str]
    n_drives: int


@dataclass(frozen=True)
class AuditDifference:
    """The difference of two audits. `entries`: standing -> its most severe findings, a limited number.

    `counts`: standing -> number of rows. All other numbers count one finding of each event, as the headline of an audit does.
    `event_counts`: standing -> number of findings. `has_profiles`: whether several profiles found one event.
    `of_lone_drives`: standing -> number of findings in drives that only one audit has; `rows_of_lone_drives`: of rows.
    `gating`: severity -> number of new findings of stable rules; `gating_added`: those in drives that the base does not have.
    `gone_by_severity`: severity -> number of the base's findings of stable rules that the newer audit did not judge or cannot decide.
    `causes`: what else differs -> standing -> number of findings.
    `base_only`, `new_only`: some of the logs that only one audit has.
    """

    base: Audit
    new: Audit
    counts: dict[str, int]
    event_counts: dict[str, int]
    has_profiles: bool
    worse: int
    of_lone_drives: dict[str, int]
    rows_of_lone_drives: dict[str, int]
    fixed: tuple[int, int]
    gating: dict[str, int]
    gating_added: dict[str, int]
    gone_by_severity: dict[str, int]
    verdicts: tuple[dict[str, int], dict[str, int]]
    entries: dict[str, list[FindingEntry]]
    causes: dict[tuple[str, ...], Counter[str]]
    causes_not_known: Counter[str]
    comparison: Comparison
    base_only: list[str]
    new_only: list[str]
    no_more_judged: list[DriveNoMoreJudged]
    new_unknowns: list[NewUnknowns]
    rates: list[RateChange]
    gating_rules: dict[str, str]
    """Id of a stable rule in the newer audit -> severity."""

    @property
    def headline(self) -> str:
        """One sentence with the counts, or that the audits have no drive in common."""
        if self.is_disjoint:
            return f"{NOTHING_IN_COMMON}; compare rates"
        n_added = self.of_lone_drives["new"]
        if self.has_few_common_drives:
            comparison = self.comparison
            counts = {standing: self.n_listed_findings(standing) for standing in self.event_counts}
            verb, n_gone = "is" if comparison.drives_both == 1 else "are", self.of_lone_drives["lost"]
            return (
                f"only {plural(comparison.drives_both, 'drive')} {verb} in both audits: there {counts['new']} new, "
                f"{counts_sentence(counts, self.worse, self.fixed)}; "
                f"{plural(n_added, 'finding')} in {plural(comparison.drives_new_only, 'drive')} of the newer audit alone, "
                f"{plural(n_gone, 'finding')} in {plural(comparison.drives_base_only, 'drive')} of the base alone; compare rates"
            )
        added_text = f" ({n_added} in drives that the base does not contain)" if n_added else ""
        return (
            f"{self.event_counts['new']} new{added_text}, {counts_sentence(self.event_counts, self.worse, self.fixed)}"
        )

    @property
    def drives_sentence(self) -> str:
        """How many drives are in both audits, and how many in only one of them."""
        comparison = self.comparison
        only = [
            f"{n} only in the {side}"
            for n, side in ((comparison.drives_new_only, "newer audit"), (comparison.drives_base_only, "base"))
            if n
        ]
        return ", ".join([f"{plural(comparison.drives_both, 'drive')} in both audits", *only])

    @property
    def has_few_common_drives(self) -> bool:
        """Whether so few drives are in both audits that the findings of other drives are not listed as new or gone: rates are compared."""
        comparison = self.comparison
        smaller = comparison.drives_both + min(comparison.drives_base_only, comparison.drives_new_only)
        return 0 < comparison.drives_both < _LEAST_COMMON_SHARE * smaller

    def listed_entries(self, standing: str) -> list[FindingEntry]:
        """Return the entries of a standing that are listed: with few common drives, only theirs."""
        entries = self.entries[standing]
        return [entry for entry in entries if "drive" not in entry.causes] if self.has_few_common_drives else entries

    def n_listed_findings(self, standing: str) -> int:
        """Return the number of findings of a standing: with few common drives, only of these drives."""
        return self.event_counts[standing] - self._left_out(self.of_lone_drives, standing)

    def n_listed_rows(self, standing: str) -> int:
        """Return the number of rows of a standing: with few common drives, only of these drives."""
        return self.counts[standing] - self._left_out(self.rows_of_lone_drives, standing)

    def _left_out(self, numbers: dict[str, int], standing: str) -> int:
        return numbers.get(standing, 0) if self.has_few_common_drives else 0

    @property
    def listed_causes(self) -> dict[tuple[str, ...], Counter[str]]:
        """`causes`; with few common drives, only of these drives."""
        return {k: counts for k, counts in self.causes.items() if not (self.has_few_common_drives and "drive" in k)}

    def extra_rows_sentence(self, standing: str) -> str:
        """Return a sentence that explains why a standing has more rows than findings; '' if it does not."""
        return rows_and_findings_sentence(
            self.n_listed_rows(standing), self.n_listed_findings(standing), has_profile_repeats=self.has_profiles
        )

    @property
    def is_disjoint(self) -> bool:
        """Whether no drive is in both audits, so that findings cannot be compared."""
        comparison = self.comparison
        return not comparison.drives_both and bool(comparison.drives_base_only and comparison.drives_new_only)

    def n_failing(self, fail_on: str) -> int:
        """Return the number of new findings of stable rules at or above a severity."""
        return _count_at_or_above(self.gating, fail_on)

    def n_failing_in_added_drives(self, fail_on: str) -> int:
        """Return how many of the findings of `n_failing` are in drives that the base does not have."""
        return _count_at_or_above(self.gating_added, fail_on)

    def n_gone_unfixed(self, fail_on: str) -> int:
        """Return the number of findings of the base audit that are missing in the new audit without being fixed.

        Only findings of stable rules at or above a severity count.
        """
        return _count_at_or_above(self.gone_by_severity, fail_on)

    def risen_rate_tests(self, fail_on: str) -> list[tuple[RateChange, RateTest]]:
        """Return the tests that report a higher rate of a stable rule at or above a severity."""
        severe = () if fail_on == "never" else SEVERITIES[: SEVERITIES.index(fail_on) + 1]
        return [
            (change, test)
            for change, test in self.tests_by_p_value
            if test.is_significant and (test.ratio or 0.0) > 1 and self.gating_rules.get(change.rule_id) in severe
        ]

    @property
    def has_rates(self) -> bool:
        """Whether any rule has a rate in both audits, so that rates can be compared."""
        return any(change.p_value is not None or change.occasion_p_value is not None for change in self.rates)

    @property
    def significant_changes(self) -> list[RateChange]:
        """The changes of rates that are statistically significant."""
        return [change for change in self.rates if change.is_significant]

    @property
    def tests_by_p_value(self) -> list[tuple[RateChange, RateTest]]:
        """The tests that could report a difference, sorted by p-value."""
        tests = [(change, test) for change in self.rates for test in change.tests]
        return sorted(tests, key=lambda pair: (pair[1].p_value, pair[0].rule_id, pair[0].profile or "", pair[1].per))

    @property
    def shown_tests(self) -> list[tuple[RateChange, RateTest]]:
        """The tests that report a difference; if these are fewer than `MIN_SHOWN_TESTS`, also the next ones by p-value."""
        return self.tests_by_p_value[
            : max(MIN_SHOWN_TESTS, sum(test.is_significant for _, test in self.tests_by_p_value))
        ]


def _count_at_or_above(counts: dict[str, int], least_severity: str) -> int:
    severe = () if least_severity == "never" else SEVERITIES[: SEVERITIES.index(least_severity) + 1]
    return sum(counts[severity] for severity in severe)


def difference(con: duckdb.DuckDBPyConnection, new: Audit, base: Audit, max_entries: int) -> AuditDifference:
    """Return the difference of the audits from `open_audits`, with at most `max_entries` findings per standing."""
    sides = {"base": create_counted_views(con, BASE_PREFIX), "new": create_counted_views(con)}
    comparison = compare(con, base=sides["base"], new=sides["new"], tools=(base.version, new.version))
    counted_sql = {f"{side}_counted": counted_finding_of_each_finding_sql(of) for side, of in sides.items()}
    (gating,) = query_rows(con, "gating", None, **sides, **counted_sql)
    only = [query_rows(con, "lone_drives", {"most": max_entries}, of=sides[side], side=side) for side in sides]
    causes: dict[tuple[str, ...], Counter[str]] = {}
    not_known: Counter[str] = Counter()
    for group in comparison.differences:
        if group.standing != "unchanged":
            causes.setdefault(group.causes, Counter())[group.standing] += group.n
            not_known.update(dict.fromkeys(group.causes_not_known, group.n))
    standing_counts = comparison.counts_by_standing()
    audit_difference = AuditDifference(
        base=base,
        new=new,
        counts={standing: standing_counts[standing] for standing in DIFF_STATUSES},
        event_counts={standing: gating[standing] for standing in DIFF_STATUSES},
        has_profiles=gating["of_profiles"],
        worse=gating["worse"],
        of_lone_drives={"new": gating["of_new_drives"], "lost": gating["of_base_drives"]},
        rows_of_lone_drives={"new": gating["alone_new"], "lost": gating["alone_lost"]},
        fixed=(gating["passes"], gating["not_applicable"]),
        gating={severity: gating[severity] for severity in SEVERITIES},
        gating_added={severity: gating[f"added_{severity}"] for severity in SEVERITIES},
        gone_by_severity={severity: gating[f"gone_{severity}"] for severity in SEVERITIES},
        verdicts=(verdict_counts(con, sides["base"]), verdict_counts(con, sides["new"])),
        entries={},
        causes=dict(sorted(causes.items(), key=lambda item: (-item[1].total(), item[0]))),
        causes_not_known=not_known,
        comparison=comparison,
        base_only=[row["log"] for row in only[0]],
        new_only=[row["log"] for row in only[1]],
        no_more_judged=[DriveNoMoreJudged(**row) for row in query_rows(con, "no_more_judged", None, **sides)],
        new_unknowns=[NewUnknowns(**row) for row in query_rows(con, "opened", None, **sides)],
        rates=compare_rates(con, base=BASE_PREFIX, new=""),
        gating_rules=dict(con.execute("SELECT rule_id, severity FROM rules WHERE status = 'stable'").fetchall()),
    )
    common_first = audit_difference.has_few_common_drives
    return replace(
        audit_difference,
        entries={
            standing: _entries(con, sides, standing, max_entries, common_first) for standing in DIFF_STATUS_TITLES
        },
    )


def verdict_counts(con: duckdb.DuckDBPyConnection, view_prefix: str) -> dict[str, int]:
    """Return verdict -> number of rows, including zeros."""
    counts = {row["verdict"]: row["n"] for row in query_rows(con, "verdicts", of=view_prefix)}
    return {verdict: counts.get(verdict, 0) for verdict in VERDICTS}


def write_finding_rows(con: duckdb.DuckDBPyConnection, path: Path) -> None:
    """Write one row per finding of either audit as Parquet. `difference` must run before. Errors: `UsageError` if the file cannot be
    written."""
    entries = statement("fleet_report/all_entries")
    try:
        con.execute(f"COPY ({entries}) TO {quoted(path)} (FORMAT parquet, COMPRESSION zstd)")
    except duckdb.IOException as error:
        raise UsageError(f"--rows {path}: cannot be written: {' '.join(str(error).split())[:200]}") from error


def _entries(
    con: duckdb.DuckDBPyConnection,
    prefix_by_side: dict[str, str],
    standing: str,
    max_entries: int,
    common_first: bool,
) -> list[FindingEntry]:
    parameters = {"standing": standing, "most": max_entries, "common_first": common_first}
    entry_rows = query_rows(con, "entries", parameters, **prefix_by_side)
    return [
        FindingEntry(
            _compared_finding(row), row["log"], tuple(row["causes"]), tuple(row["causes_not_known"]), row["new_key"]
        )
        for row in entry_rows
    ]


def _compared_finding(row: Row) -> ComparedFinding:
    same = (
        "standing", "finding_id", "base_id", "drive_id", "ego_id", "rule_id", "profile", "object_id", "severity", "stable", "margin",
        "base_margin", "unit", "there", "worse",
    )  # fmt: skip
    return ComparedFinding(**{name: row[name] for name in same}, t_s=round(row["t_s"], 3), why=_change_or_reason(row))


def _change_or_reason(row: Row) -> str:
    """Return how a finding changed, or why the other audit does not have the finding."""
    if row["standing"] != "changed":
        return (
            _SENTENCE_BY_OTHER_AUDITS_VERDICT[row["there"]]
            if row["why_code"] == "judged"
            else _REASON_TEXTS[row["why_code"]]
        )
    if row["is_part"]:
        whole, part = (
            ("base_id", "finding_id") if _duration_s(row, "base_") > _duration_s(row, "") else ("finding_id", "base_id")
        )
        return f"{row[part]} is a part of {row[whole]}"
    notes = []
    if row["severity"] != row["base_severity"]:
        notes.append(f"severity {row['severity']}, was {row['base_severity']}")
    if row["margin"] != row["base_margin"]:
        notes.append(f"margin {number(row['margin'], row['unit'])}, was {number(row['base_margin'], row['unit'])}")
    ends = [abs(row[name] - row[f"base_{name}"]) for name in ("from_s", "to_s")]
    if max(ends) > UNCHANGED_INTERVAL_TOLERANCE_S:
        now, was = (f"{row[f'{of}from_s']:.2f} s to {row[f'{of}to_s']:.2f} s" for of in ("", "base_"))
        notes.append(f"{now}, was {was}")
    return "; ".join(notes)


def _duration_s(row: Row, column_prefix: str) -> float:
    return float(row[f"{column_prefix}to_s"] - row[f"{column_prefix}from_s"])
