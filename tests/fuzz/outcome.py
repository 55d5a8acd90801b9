"""What becomes of a damaged file."""

from __future__ import annotations

import traceback
from typing import Final, NamedTuple

from drivelint.errors import DriveLintError, ExitCode, InternalError

BAD: Final = {
    "crash": "an exception that is no refusal",
    "died": "the process died of a signal",
    "hang": "no answer in time",
    "memory": "more memory than the process may have",
    "wrong exit": "a refusal with the exit code of another fault",
    "silent": "other content, although checksums cover it, and the drive is not flagged",
    "unsaid": "other content of a file without checksums, and the drive does not say that it has none",
    "wrong verdict": "a verdict that the whole file contradicts",
    "rule error": "a shipped rule that fails on the drive",
}
"""Outcome -> what it means: a bug of drivelint."""
GOOD: Final = {
    "same": "read as the whole file",
    "refused": "one sentence and the exit code of its kind",
    "lossy": "judged and flagged: parts are lost or known to be wrong",
    "unprotected": "another valid file; the drive says that it has no checksums",
    "other": "another valid map, mapping, rule or list, of which no checksum is expected",
}
LONGEST_MESSAGE: Final = 4000
"""A refusal beyond it floods a terminal."""


class Outcome(NamedTuple):
    """What became of one case; `detail`: for whoever looks into it."""

    kind: str
    number: int
    source: str
    outcome: str
    detail: str = ""


def of_error(error: BaseException) -> tuple[str, str]:
    """Return outcome and detail for an exception that ends the reading of a file."""
    if isinstance(error, MemoryError):
        return "memory", place_of(error)
    if isinstance(error, DriveLintError) and not isinstance(error, InternalError):
        if error.exit_code not in {ExitCode.USAGE, ExitCode.NOT_JUDGED}:
            return "wrong exit", f"{error.exit_code}: {error}"[:500]
        if len(str(error)) > LONGEST_MESSAGE:
            return "crash", f"a message of {len(str(error))} characters: {str(error)[:300]}"
        return "refused", f"{type(error).__name__}: {error}"[:300]
    return "crash", place_of(error)


def place_of(error: BaseException) -> str:
    """Return an exception and where it was raised, within drivelint and beyond it."""
    frames = [
        f"{f.filename.rpartition('site-packages/')[2].rpartition('src/')[2]}:{f.lineno}"
        for f in traceback.extract_tb(error.__traceback__)
    ]
    ours = [frame for frame in frames if frame.startswith("drivelint/")]
    return f"{type(error).__name__}: {str(error)[:200]} at {' < '.join(dict.fromkeys([*frames[-1:], *ours[-2:]]))}"
