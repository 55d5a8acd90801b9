"""`files.json` of an audit that has ended: the sha256 of tables and summary, which tells a later change, as in the folder of a check."""

from __future__ import annotations

from hashlib import file_digest, sha256
from typing import TYPE_CHECKING, Final

from drivelint.errors import UsageError
from drivelint.result.folder import MANIFEST, hashes_in, manifest

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

    from drivelint.audit.store import ResultStore

_TABLES: Final = "tables"


def seal(results: ResultStore, names: Iterable[str]) -> None:
    """Write the list of these files and of all tables. Errors: `OutputError`."""
    listed = {*names, *results.names(_TABLES)}
    hashes = {name: sha256(results.read(name) or b"").hexdigest() for name in sorted(listed)}
    results.write(MANIFEST, manifest(listed, hashes))


def unseal(results: ResultStore) -> None:
    """Remove the list, before anything is changed that it lists. Errors: `OutputError`."""
    results.delete([MANIFEST])


def require_unchanged(results: ResultStore, home: Path, dest: str) -> None:
    """Refuse an audit whose files are not as they were when it ended; one without a list has not ended, or is of an older version.

    `home`: for copies. Errors: `UsageError`, which names the first of these files; `OutputError`.
    """
    said = hashes_in(results.read(MANIFEST) or b"")
    if not said:
        return
    for name in sorted({*results.names(_TABLES), *said}):
        if name not in said or _sha256(results, home, name) != said[name]:
            raise UsageError(
                f"{dest.rstrip('/')}/{name}: is not as drivelint audit wrote it with the others: audit the drives again into another --out"
            )


def _sha256(results: ResultStore, home: Path, name: str) -> str | None:
    """Return the hash of a file; None where there is none: its name may come from a damaged list."""
    try:
        with results.fetch(name, home).open("rb") as file:
            return file_digest(file, "sha256").hexdigest()
    except (OSError, ValueError):
        return None
