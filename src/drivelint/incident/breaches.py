"""The sheet's line for each rule: how the rule was broken, or the measured value if it was kept."""

from __future__ import annotations

import re
from collections import Counter
from textwrap import shorten
from typing import TYPE_CHECKING, Final

from drivelint.catalogue.header import EXCUSABLE_RULE_TAG
from drivelint.incident.words import (
    SENSE_WORDS,
    amount_text,
    certainty_text,
    measured_and_required_text,
    profile_text,
    required_value_text,
    text_with_minus_signs,
)
from drivelint.phrases import plural
from drivelint.result.certainty import POSSIBLE, SURE, certainty
from drivelint.result.counts import representative_indices
from drivelint.result.text import seconds

if TYPE_CHECKING:
    from collections.abc import Sequence

    from drivelint.result.text import Row

ADVICE_VERBS: Final = ("begin", "choose", "correct", "give", "make", "provide", "record", "see", "set", "use")
"""The words with which the advice at the end of a reason begins."""
_ADVICE_PATTERN: Final = re.compile(rf": (?:{'|'.join(ADVICE_VERBS)}) .*$")
_CERTAINTY_ORDER: Final = (SURE, None, POSSIBLE)
"""An event is as certain as the surest of its findings; a finding that was not examined may be surer than one that is only possible."""
_MOST_LISTED_JUDGED_TIMES: Final = 2
LOWER_BOUND_CAUSE_CODE: Final = "lower_bound"
"""The cause code of a verdict whose measured value is a lower bound, because the data end."""


def quoted_title(rule: Row) -> str:
    """Return the title of a rule in quotation marks, because it states a demand, not a fact."""
    return f"\u201c{rule['title']}\u201d"


def broken_rule_line(rule: Row, rows: Sequence[Row], drive_start_ns: int) -> str:
    """Return the line of a broken rule: its worst finding (of each profile, if several), with number and certainty of the findings."""
    ordered = sorted(rows, key=lambda r: (r["margin"] is None, r["margin"] or 0.0, r["t_worst_ns"] or 0))
    row = ordered[0]
    per_profile = list({finding["profile"]: finding for finding in reversed(ordered)}.values())
    breach = (
        _values_by_profile_text(rule, per_profile)
        or measured_and_required_text(row, rule)
        or shorten(row["reason"], 120, placeholder=" ...")
    )
    profile = profile_text(row["profile"]) if len(per_profile) == 1 else ""
    about = f"{clause_number(rule['clause'])}, {rule['severity']}"
    return f"{quoted_title(rule)}{profile} ({about}): {_finding_time_text(row, rule, drive_start_ns)}, {breach}{_certainties_text(rows)}"


def kept_rule_line(rule: Row, rows: Sequence[Row], span_ns: tuple[int, int], drive_start_ns: int) -> str:
    """Return the line of a rule that all `rows` kept: its worst measured value, and when it was judged if not in all of `span_ns`.

    The title replaces the value if the rule measures nothing, or may excuse a breach, because the value does not show the excuse.
    """
    row = min(rows, key=lambda r: (r["margin"] is None, r["margin"] or 0.0, r["t_worst_ns"] or 0))
    statement, about = quoted_title(rule), [_judged_times_text(rows, span_ns, drive_start_ns)]
    if EXCUSABLE_RULE_TAG not in rule["tags"] and rule["observes"] and row["observed"] is not None:
        object_words = f" with {row['object_id']}:" if row["object_id"] is not None else ""
        least = "at least " if row["cause_code"] == LOWER_BOUND_CAUSE_CODE else ""
        statement = text_with_minus_signs(
            f"{rule['observes']}{object_words} {least}{amount_text(row['observed'], row['unit'])}"
        )
        about.insert(0, f"{SENSE_WORDS.get(rule['sense'], '')}{required_value_text(row, rule)}")
    if any(verdict["near_miss"] for verdict in rows):
        about.append("near miss")
    details = "; ".join(detail for detail in about if detail)
    return f"{statement} ({details})" if details else statement


def reason_without_advice(reason: str) -> str:
    """Return a reason without its advice, which is useless for a finished recording."""
    return _ADVICE_PATTERN.sub("", reason).removesuffix(".")


def clause_number(clause: str) -> str:
    """Return the number of a clause without its text."""
    return clause.partition(":")[0].partition(" (")[0]


def _values_by_profile_text(rule: Row, rows: Sequence[Row]) -> str:
    """Return measured and required values of each profile, the greatest margin first; '' for one profile or without values."""
    if len(rows) < 2 or any(row["observed"] is None or row["required"] is None for row in rows):
        return ""
    ordered = sorted(rows, key=lambda row: (-row["margin"], row["profile"]))
    amounts = {amount_text(row["observed"], row["unit"]) for row in rows}
    if len(amounts) > 1:
        return "; ".join(f"{measured_and_required_text(row, rule)}{profile_text(row['profile'])}" for row in ordered)
    needs = ", ".join(f"{amount_text(row['required'], row['unit'])}{profile_text(row['profile'])}" for row in ordered)
    return text_with_minus_signs(f"{amounts.pop()}, must be {SENSE_WORDS.get(rule['sense'], '')}{needs}")


def _finding_time_text(row: Row, rule: Row, drive_start_ns: int) -> str:
    worst = seconds(row["t_worst_ns"], drive_start_ns)
    if rule["kind"] == "execution":
        return f"for the manoeuvre at {worst}"
    if row["t_start_ns"] in {None, row["t_end_ns"]}:
        return f"at {worst}"
    start, end = (seconds(row[key], drive_start_ns) for key in ("t_start_ns", "t_end_ns"))
    return f"from {start} to {end}, worst at {worst}"


def _certainties_text(rows: Sequence[Row]) -> str:
    """Return in words how sure findings are, one per event; '' for verdicts without findings."""
    findings = [row for row in rows if "finding_id" in row]
    event_rows: list[Row] = []
    for place in sorted(set(places := representative_indices(findings))):
        event = [row for row, index in zip(findings, places, strict=True) if index == place]
        event_rows.append(min(event, key=lambda row: _CERTAINTY_ORDER.index(certainty(row))))
    if not event_rows:
        return ""
    if len(event_rows) == 1:
        return f"; {certainty_text(event_rows[0]) or 'certainty not examined'}"
    n = Counter(certainty(row) or "not examined" for row in event_rows)
    return (
        f" ({plural(len(event_rows), 'finding')}: {', '.join(f'{n[word]} {word}' for word in sorted(n, reverse=True))})"
    )


def _judged_times_text(rows: Sequence[Row], span_ns: tuple[int, int], drive_start_ns: int) -> str:
    """Return in words when a rule was judged; '' if it was judged in all of the span."""
    times = sorted({(row["t_start_ns"], row["t_end_ns"]) for row in rows if row["t_start_ns"] is not None})
    if not times or any(start <= span_ns[0] and end >= span_ns[1] for start, end in times):
        return ""
    if len(times) > _MOST_LISTED_JUDGED_TIMES:
        first, last = seconds(times[0][0], drive_start_ns), seconds(max(end for _, end in times), drive_start_ns)
        return f"{len(times)} times, {first[:-2]} to {last}"
    return ", ".join(
        seconds(start, drive_start_ns)
        if start == end
        else f"{seconds(start, drive_start_ns)[:-2]} to {seconds(end, drive_start_ns)}"
        for start, end in times
    )
