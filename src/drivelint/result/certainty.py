"""Says whether a finding is sure or only possible, from how many copies with the errors of the recording keep it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

if TYPE_CHECKING:
    from collections.abc import Mapping

SURE: Final = "sure"
POSSIBLE: Final = "possible"
LEAST_SHARE: Final = 0.95
"""A finding that fewer of its copies keep is only possible."""


def certainty(finding: Mapping[str, Any]) -> str | None:
    """Return `SURE` or `POSSIBLE` of a row of the table `finding`; None: no copies of it were judged."""
    if finding["n_copies"] is None:
        return None
    return SURE if finding["n_stays"] >= LEAST_SHARE * finding["n_copies"] else POSSIBLE
