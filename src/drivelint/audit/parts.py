"""The parts of an audit that have started, and those that have ended, so that an unfinished audit never looks complete."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from drivelint.audit.store import ResultStore

ALL, CLAIM = "all", "claim"
"""The names of an audit of all drives, and of audits that share their drives. That of a shard is `2-of-3`."""


def name_of(shard: tuple[int, int] | None, *, claim: bool) -> str:
    """Return the name of a part."""
    if shard is not None:
        return f"{shard[0]}-of-{shard[1]}"
    return CLAIM if claim else ALL


def begin(results: ResultStore, part: str) -> None:
    """Say that a part has begun. With a shard, all the others are expected, too."""
    _, is_shard, n = part.partition("-of-")
    for name in [f"{i}-of-{n}" for i in range(1, int(n) + 1)] if is_shard else [part]:
        results.create(f"parts/begun/{name}", b"\n")
    results.delete([f"parts/ended/{part}"])


def ask(results: ResultStore, part: str, n_drives: int) -> None:
    """Say how many drives a part that has begun is to judge."""
    results.write(f"parts/begun/{part}", f"{n_drives}\n".encode())


def n_expected_drives(results: ResultStore) -> int | None:
    """Return how many drives the parts without an end are to judge, or all parts; of shards all of them; None: not known."""
    said = {Path(name).name: (results.read(name) or b"").strip() for name in results.names("parts/begun")}
    open_ = unfinished_parts(results) or sorted(said)
    if not open_:
        return None
    counted = [n for name, n in said.items() if ("-of-" in name if "-of-" in open_[0] else name == open_[0])]
    return sum(map(int, counted)) if all(n.isdigit() for n in counted) else None


def end(results: ResultStore, part: str) -> None:
    """Say that a part has come to its end."""
    results.write(f"parts/ended/{part}", b"\n")


def begun(results: ResultStore) -> set[str]:
    """Return the parts that have begun, or are expected."""
    return {Path(name).name for name in results.names("parts/begun")}


def unfinished_parts(results: ResultStore) -> list[str]:
    """Return the parts that have begun, or are expected, and have not come to their end."""
    return sorted(begun(results) - {Path(name).name for name in results.names("parts/ended")})
