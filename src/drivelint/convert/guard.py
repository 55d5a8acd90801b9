"""Refuses to overwrite the log itself and files that `convert` did not write."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from drivelint.convert.tables import is_converted
from drivelint.errors import UsageError
from drivelint.formats.files import CANONICAL_FILES, is_canonical_folder
from drivelint.formats.osi.writer import LIBRARY

if TYPE_CHECKING:
    from pathlib import Path

_HEAD_BYTES: Final = 64
"""Enough of an MCAP file for its magic bytes and header, in which its writer names itself."""


def refuse_to_overwrite(source: Path, out: Path, target: Path) -> None:
    """Check that nothing foreign would be overwritten. Errors: `UsageError` that names the file in the way."""
    if not out.exists():
        return
    if not out.is_dir():
        raise UsageError(f"--out {out} is a file: name a folder")
    ours = [out / name for name in CANONICAL_FILES] if target == out else [target]
    if out.samefile(source) or any(file.exists() and file.samefile(source) for file in ours):
        raise UsageError(f"--out {out}: that would overwrite the log itself: choose another folder")
    if target != out:
        if target.exists() and not _is_our_mcap(target):
            raise UsageError(f"{target} exists and was not written by convert: choose another --out")
    elif next(out.iterdir(), None) is not None and not (
        is_canonical_folder(out) and is_converted(out / "actor_state.parquet")
    ):
        raise UsageError(f"--out {out} holds other files: a converted log is a folder of its own: choose another")


def _is_our_mcap(path: Path) -> bool:
    with path.open("rb") as file:
        return LIBRARY.encode() in file.read(_HEAD_BYTES)
