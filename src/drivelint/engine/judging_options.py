"""The options on how drives are judged, common to `check` and `watch`."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path  # noqa: TC003 - a dataclass names it

from drivelint.drive.trace import DriveInput
from drivelint.engine.memory import DEFAULT_MEMORY_BYTES
from drivelint.evaluate.limits import DEFAULT_TIMEOUT_S


@dataclass(frozen=True, kw_only=True)
class JudgingOptions(DriveInput):
    """The rules and profiles of a run, the effect of findings on the exit code, and the limits of memory and time."""

    rules: tuple[str, ...] = ()
    ignore: tuple[str, ...] = ()
    profiles: tuple[str, ...] = ()
    params: tuple[str, ...] = ()
    rules_dirs: tuple[Path, ...] = ()
    fail_on: str = "critical"
    strict: bool = False
    require: tuple[str, ...] = ()
    annotate: bool = True
    robustness: bool | None = None
    """Whether copies are judged to show how robust findings are. None: only for the worst finding per ego and rule."""
    memory: int | None = DEFAULT_MEMORY_BYTES
    """The bytes of memory that the database uses before it spills to disk; None: 80 % of the machine's memory."""
    rule_timeout: float = DEFAULT_TIMEOUT_S
    """The time limit in seconds of a rule on a batch of drives."""
