"""The data behind an incident sheet."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from drivelint.engine.batch import Drive
    from drivelint.incident.finding import NamedFinding
    from drivelint.incident.judge import EgoRows
    from drivelint.result.model import Result
    from drivelint.result.request import RunRequest

PARTY_LETTERS: Final = ("A", "B")
"""The names of the parties on the sheet."""


@dataclass(frozen=True)
class Case:
    """A finding, its run, and the results of judging the parties again.

    `ego_rows`: the result for the ego; `other_party`: the result for the second party, or a sentence why it was not judged; None: there is
    no second party.
    """

    result: Result
    run_options: RunRequest
    finding: NamedFinding
    drive: Drive
    ego_rows: EgoRows
    other_party: EgoRows | str | None
    source: str
