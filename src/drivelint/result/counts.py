"""Counts verdicts by any column, including verdicts with zero rows; counts findings, one per event; and groups rows."""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING, Any, Final, TypeVar

import pyarrow as pa
import pyarrow.compute as pc

from drivelint.phrases import plural
from drivelint.reasons.signals import UNRECORDED_PREFIX
from drivelint.result.certainty import POSSIBLE, certainty

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence

VERDICTS: Final = ("pass", "fail", "unknown", "not_applicable", "error")
SEVERITIES: Final = ("critical", "major", "minor")
_Row = TypeVar("_Row")
_Key = TypeVar("_Key")


def verdict_counts(verdicts: pa.Table) -> dict[str, int]:
    """Return verdict -> number of rows, zeros included."""
    return tally(verdicts, VERDICTS, "verdict")


def tally(rows: pa.Table, values: tuple[str, ...], column: str) -> dict[str, int]:
    """Return value -> number of rows with this value in `column`, for each of `values`."""
    count_by_value = {str(item["values"]): int(item["counts"]) for item in pc.value_counts(rows[column]).to_pylist()}
    return {value: count_by_value.get(value, 0) for value in values}


def count_verdicts_assuming(verdicts: pa.Table, assumption: str) -> int:
    """Return the number of verdicts with this assumption in the column `assumes`."""
    return tally(verdicts, (assumption,), "assumes")[assumption]


def verdict_counts_by(verdicts: pa.Table, key: str) -> dict[str, dict[str, int]]:
    """Return value of the column `key` -> verdict -> number of rows, zeros included; values without rows give zeros."""
    counts: dict[str, dict[str, int]] = defaultdict(lambda: dict.fromkeys(VERDICTS, 0))
    for row in distinct_rows(verdicts, [key, "verdict"]):
        counts[row[key]][row["verdict"]] = row["count_all"]
    return counts


def verdict_counts_by_pack(rules: pa.Table, verdicts: pa.Table) -> dict[str, dict[str, int]]:
    """Return pack -> verdict -> number of rows, zeros included, with the packs in the order of `rules`."""
    counts_by_rule = verdict_counts_by(verdicts, "rule_id")
    counts_by_pack: dict[str, dict[str, int]] = {}
    for rule in rules.select(["rule_id", "pack"]).to_pylist():
        sums = counts_by_pack.setdefault(rule["pack"], dict.fromkeys(VERDICTS, 0))
        for verdict, n in counts_by_rule[rule["rule_id"]].items():
            sums[verdict] += n
    return counts_by_pack


def distinct_rows(rows: pa.Table, columns: Sequence[str]) -> list[dict[str, Any]]:
    """Return the distinct rows of these columns, in the order of first occurrence, each with its number of rows as `count_all`."""
    row_counts = rows.group_by(list(columns), use_threads=False).aggregate([([], "count_all")])
    return list(row_counts.to_pylist())


def undecided_verdicts(verdicts: pa.Table) -> pa.Table:
    """Return the verdicts that are unknown or errors."""
    return verdicts.filter(pc.is_in(verdicts["verdict"], value_set=pa.array(["unknown", "error"])))


def verdicts_lacking_signal(verdicts: pa.Table) -> pa.Table:
    """Return the verdicts that are not applicable because the log lacks a signal: the rule's situation may still have occurred."""
    return verdicts.filter(pc.starts_with(verdicts["reason_code"], UNRECORDED_PREFIX))


def one_finding_per_event(findings: Iterable[Mapping[str, Any]]) -> list[Mapping[str, Any]]:
    """Return one finding per event, in the order of the rows. Numbers of findings in reports count these.

    Findings of one rule at the same time are one event in two cases: they have the same ego and object under several profiles, or each
    of two egos is the object of the other. A sure finding represents the event before a possible finding, and an earlier row before a
    later row.
    `queries/fleet/event.sql` does the same for audits.
    """
    rows = list(findings)
    return [
        row
        for place, (row, representative) in enumerate(zip(rows, representative_indices(rows), strict=True))
        if place == representative
    ]


def representative_indices(findings: Sequence[Mapping[str, Any]]) -> list[int]:
    """Return for each finding the index of the finding that represents its event, see `one_finding_per_event`."""
    ordered = sorted(enumerate(findings), key=lambda item: (certainty(item[1]) == POSSIBLE, item[0]))
    places_by_parties: dict[tuple[str, str, frozenset[str | None]], list[int]] = defaultdict(list)
    places = list(range(len(findings)))
    for place, row in ordered:
        earlier_places = places_by_parties[
            row["drive_id"], row["rule_id"], frozenset({row["ego_id"], row["object_id"]})
        ]
        places[place] = next(
            (places[earlier] for earlier in earlier_places if _is_same_event(findings[earlier], row)), place
        )
        earlier_places.append(place)
    return places


def severity_counts_text(findings: Iterable[Mapping[str, Any]]) -> str:
    """Return the number of findings of each severity as text; '' without findings."""
    severities = [row["severity"] for row in findings]
    return ", ".join(f"{severities.count(severity)} {severity}" for severity in SEVERITIES if severity in severities)


def extra_rows_sentence(rows: Sequence[Mapping[str, Any]], events: Sequence[Mapping[str, Any]]) -> str:
    """Return why a table has more rows (`rows`) than there are findings (`events`); '' if the numbers are equal."""
    event_ids = {row["finding_id"] for row in events}
    left_out = [row for row in rows if row["finding_id"] not in event_ids]
    return rows_and_findings_sentence(
        len(rows), len(events), has_profile_repeats=any(row["profile"] is not None for row in left_out)
    )


def rows_and_findings_sentence(n_rows: int, n_findings: int, *, has_profile_repeats: bool) -> str:
    """Return how many findings the rows represent, and why; '' if each row is a finding.

    `has_profile_repeats`: some rows repeat a finding under another profile; else every repeated row is a touch of two egos.
    """
    if n_rows == n_findings:
        return ""
    repetition = "an overtake under two profiles" if has_profile_repeats else "a touch of two egos"
    rows, events = plural(n_rows, "row"), plural(n_findings, "finding")
    return f"{rows}, {events}: {repetition} counts once"


def _is_same_event(other_finding: Mapping[str, Any], finding: Mapping[str, Any]) -> bool:
    """Return whether two findings of the same rule and parties belong to one event."""
    at_once = other_finding["t_start_ns"] <= finding["t_end_ns"] and finding["t_start_ns"] <= other_finding["t_end_ns"]
    of_other_profile = other_finding["profile"] != finding["profile"]
    return bool(at_once and of_other_profile == (other_finding["ego_id"] == finding["ego_id"]))


def group_rows(rows: Iterable[_Row], key: Callable[[_Row], _Key]) -> dict[_Key, list[_Row]]:
    """Return key -> rows with this key; keys and rows keep the order of `rows`."""
    groups: dict[_Key, list[_Row]] = {}
    for row in rows:
        groups.setdefault(key(row), []).append(row)
    return groups
