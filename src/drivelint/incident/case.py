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

LETTERS: Final = ("A", "B")
"""What the sheet calls the parties."""


@dataclass(frozen=True)
class Case:
    """A finding, its run, and the results that the sheet judged again.

    `other_party`: what was judged of the second party, or in a sentence why it was not; None: there is none.
    """

    result: Result
    run_options: RunRequest
    finding: NamedFinding
    drive: Drive
    again: EgoRows
    other_party: EgoRows | str | None
    source: str
