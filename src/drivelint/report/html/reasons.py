"""The reasons why rules could not be judged: first missing data that the user can provide, then what the logs did not show."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final, NamedTuple

from drivelint.phrases import plural
from drivelint.report.html.anchors import anchor
from drivelint.result import counts

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    import pyarrow as pa

    from drivelint.result.text import Row

MAX_REASONS: Final = 60
_REASON_CODES_NO_INPUT_REMOVES: Final = {"missing_step", "applies_unknown", "anchor_unknown", "reference_time_unknown"}


class VerdictReason(NamedTuple):
    """The reason of one verdict; reasons of one kind have the same codes and differ in times, numbers and ids."""

    kind: tuple[str, ...]
    text: str


def verdict_reason(row: Row) -> VerdictReason:
    """Return the reason of a verdict; each reason whose text comes from the rule itself is a separate kind."""
    text = row["reason"] if row["cause_code"] == "text" else ""
    return VerdictReason((row["reason_code"], row["cause_code"] or "", text), row["reason"])


def summarise_reasons(reasons: Iterable[VerdictReason]) -> str:
    """Return the shortest reason as text, with the number of other reasons; the text does not name the verdict.

    Among reasons of equal length, the alphabetically first is chosen, so that the order of the rows does not matter.
    """
    first, *other_reasons = sorted(set(reasons), key=lambda reason: (len(reason.text), reason.text, reason.kind))
    alike = sum(reason.kind == first.kind for reason in other_reasons)
    more = [f"{alike} similar"] if alike else []
    more += [plural(len(other_reasons) - alike, "other reason")] if len(other_reasons) > alike else []
    text = f"{first.text.removesuffix('.')} (and {' and '.join(more)})" if more else first.text
    return text[:1].upper() + text[1:]


def can_missing_data_be_provided(code: str) -> bool:
    """Return whether a log, a map or an option could provide the missing signal or condition."""
    return code not in _REASON_CODES_NO_INPUT_REMOVES and (code.startswith("missing_") or code.endswith("_unknown"))


def reason_groups(verdicts: pa.Table, titles: Mapping[str, str]) -> list[dict[str, Any]]:
    """Return why verdicts are unknown or errors, with one row per kind of reason.

    Reasons that the user can remove by providing data come first, then the most frequent.
    """
    keys = ["verdict", "reason_code", "cause_code", "reason", "rule_id", "drive_id"]
    rows = counts.distinct_rows(counts.undecided_verdicts(verdicts), keys)
    groups = counts.group_rows(rows, lambda row: (row["verdict"], verdict_reason(row).kind))
    entries = [
        {
            "verdict": verdict,
            "why": summarise_reasons(verdict_reason(row) for row in group),
            "provide": can_missing_data_be_provided(group[0]["reason_code"]),
            "rules": [
                (titles.get(rule, rule), "#" + anchor("rule", rule))
                for rule in sorted({row["rule_id"] for row in group})
            ],
            "n": sum(row["count_all"] for row in group),
            "n_drives": len({row["drive_id"] for row in group}),
        }
        for (verdict, _), group in groups.items()
    ]
    return sorted(entries, key=lambda r: (r["verdict"], not r["provide"], -r["n"], r["why"]))[:MAX_REASONS]
