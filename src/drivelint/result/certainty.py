"""Says whether a finding is sure or only possible, from how many copies with the errors of the recording keep it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

if TYPE_CHECKING:
    from collections.abc import Mapping

SURE: Final = "sure"
POSSIBLE: Final = "possible"
LEAST_SHARE: Final = 0.95
"""A finding that fewer of its copies keep is only possible."""


def certainty(finding: Mapping[str, Any], least_share: float = LEAST_SHARE) -> str | None:
    """Return `SURE` or `POSSIBLE` of a row of the table `finding`; None: no copies of it were judged."""
    if finding["n_copies"] is None:
        return None
    return SURE if finding["n_stays"] >= least_share * finding["n_copies"] else POSSIBLE


def doubt(row: Mapping[str, Any]) -> str:
    """Return, in words, that a finding is only possible; '' if it is sure or was not examined, and for a verdict."""
    if row.get("n_copies") is None or certainty(row) == SURE:
        return ""
    return f"possible, in {row['n_stays']} of {row['n_copies']} copies with recording errors"
