"""Groups the findings about one contact; the contact is as sure as the surest of its findings."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from drivelint.report.worst_first import is_contact
from drivelint.result.certainty import POSSIBLE, SURE, certainty
from drivelint.result.counts import group_rows

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from drivelint.result.text import Row

SAME_CONTACT_GAP_NS: Final = 1_000_000_000
"""Findings of two rules are about the same contact if the times in which they fail are at most this far apart."""


def findings_of_same_contact(rows: Iterable[Row], rules: Mapping[str, Row]) -> dict[str, list[Row]]:
    """Return, by the id of each finding that is a contact, the findings of other rules about the same contact."""
    contacts = [row for row in rows if is_contact(row, rules)]
    met = group_rows(contacts, lambda row: (row["drive_id"], frozenset((row["ego_id"], row["object_id"]))))
    return {
        row["finding_id"]: [
            contact
            for contact in of_both
            if contact["rule_id"] != row["rule_id"]
            and contact["t_start_ns"] <= row["t_end_ns"] + SAME_CONTACT_GAP_NS
            and row["t_start_ns"] <= contact["t_end_ns"] + SAME_CONTACT_GAP_NS
        ]
        for of_both in met.values()
        for row in of_both
    }


def other_certainty_words(finding: Row, other_findings: Iterable[Row]) -> str:
    """Return in words the certainty of another finding of the same contact, if it differs from this finding's; else ''."""
    own_certainty = certainty(finding)
    for other_finding in other_findings:
        of = f"by {other_finding['rule_id']}, in {other_finding['n_stays']} of {other_finding['n_copies']} copies"
        if (own_certainty, certainty(other_finding)) == (POSSIBLE, SURE):
            return f"the contact itself is sure {of}"
        if (own_certainty, certainty(other_finding)) == (SURE, POSSIBLE):
            return f"the same contact is only possible {of}"
    return ""
