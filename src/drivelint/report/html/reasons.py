"""Why something could not be judged, in one line per reason: first what can be provided, then what the logs did not tell."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final, NamedTuple

from drivelint.phrases import plural
from drivelint.report.html.anchors import rule_anchor
from drivelint.result import counts

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    import pyarrow as pa

MAX_REASONS: Final = 60


class VerdictReason(NamedTuple):
    """The reason of one verdict; reasons of one kind have the same codes and differ in times, numbers and ids."""

    kind: tuple[str, ...]
    text: str


class ReasonGroup(NamedTuple):
    """Alike reasons as one row: the reason in words, its rules with links, and the numbers of verdicts and drives."""

    verdict: str
    why: str
    provide: bool
    rules: list[tuple[str, str]]
    n: int
    n_drives: int


def verdict_reason(row: Mapping[str, Any]) -> VerdictReason:
    """Return the reason of a verdict; a text that a rule writes itself is a kind of its own."""
    text = row["reason"] if row["cause_code"] == "text" else ""
    return VerdictReason((row["reason_code"], row["cause_code"] or "", text), row["reason"])


def summarise_reasons(reasons_given: Iterable[VerdictReason]) -> str:
    """Return the shortest of the reasons as text, with the number of the others. What stands before it says the verdict.

    The shortest is the first, and of these the first by letter: the order of the rows does not matter.
    """
    first, *others = sorted(set(reasons_given), key=lambda reason: (len(reason.text), reason.text, reason.kind))
    alike = sum(reason.kind == first.kind for reason in others)
    more = [f"{alike} more like it"] if alike else []
    more += [plural(len(others) - alike, "other reason")] if len(others) > alike else []
    shown = f"{first.text.removesuffix('.')} (and {' and '.join(more)})" if more else first.text
    return shown[:1].upper() + shown[1:]


def can_be_provided(code: str) -> bool:
    """Whether a log, a map or an option could tell what was missing: a signal, or a condition of the drive."""
    return (code.startswith("missing_") and code != "missing_step") or (
        code.endswith("_unknown") and code not in _OF_THE_MOMENT
    )


_OF_THE_MOMENT: Final = {"applies_unknown", "anchor_unknown", "reference_time_unknown"}


def reason_groups(verdicts: pa.Table, titles: Mapping[str, str]) -> list[ReasonGroup]:
    """Return why verdicts are unknown or errors; what can be provided first, then the most frequent."""
    keys = ["verdict", "reason_code", "cause_code", "reason", "rule_id", "drive_id"]
    rows = counts.distinct_rows(counts.undecided(verdicts), keys)
    groups = counts.grouped(rows, lambda row: (row["verdict"], verdict_reason(row).kind))
    found = [
        ReasonGroup(
            verdict,
            summarise_reasons(verdict_reason(row) for row in told),
            can_be_provided(told[0]["reason_code"]),
            rule_links({row["rule_id"] for row in told}, titles),
            sum(row["count_all"] for row in told),
            len({row["drive_id"] for row in told}),
        )
        for (verdict, _), told in groups.items()
    ]
    return sorted(found, key=lambda r: (r.verdict, not r.provide, -r.n, r.why))[:MAX_REASONS]


def rule_links(rules: Iterable[str], titles: Mapping[str, str]) -> list[tuple[str, str]]:
    """Return titles of rules with links to them."""
    return [(titles.get(rule, rule), "#" + rule_anchor(rule)) for rule in sorted(rules)]
