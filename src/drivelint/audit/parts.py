"""Records which parts of an audit have begun and which have ended, so that an unfinished audit never looks complete."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from drivelint.audit.store import ResultStore

ALL_DRIVES, CLAIMED_DRIVES = "all", "claim"
"""The part names of an audit of all drives, and of audits that share their drives by claims. A shard has a name such as `2-of-3`."""


def part_name(shard: tuple[int, int] | None, *, claim: bool) -> str:
    """Return the name of an audit's part: a shard, a share by claims, or all drives."""
    if shard is not None:
        return f"{shard[0]}-of-{shard[1]}"
    return CLAIMED_DRIVES if claim else ALL_DRIVES


def record_begin(results: ResultStore, part: str) -> None:
    """Record that a part has begun. If it is a shard, record all other shards as expected."""
    _, is_shard, n = part.partition("-of-")
    for name in [f"{i}-of-{n}" for i in range(1, int(n) + 1)] if is_shard else [part]:
        results.create(f"parts/begun/{name}", b"\n")
    results.delete([f"parts/ended/{part}"])


def record_drive_count(results: ResultStore, part: str, n_drives: int) -> None:
    """Record how many drives a part that has begun has to judge."""
    results.write(f"parts/begun/{part}", f"{n_drives}\n".encode())


def n_expected_drives(results: ResultStore) -> int | None:
    """Return how many drives the audit has to judge; None: not known.

    Unfinished parts count, or all parts if none is unfinished. If one of these is a shard, all shards count.
    """
    count_texts = {Path(name).name: (results.read(name) or b"").strip() for name in results.names("parts/begun")}
    open_ = unfinished_parts(results) or sorted(count_texts)
    if not open_:
        return None
    counts = [n for name, n in count_texts.items() if ("-of-" in name if "-of-" in open_[0] else name == open_[0])]
    return sum(map(int, counts)) if all(n.isdigit() for n in counts) else None


def record_end(results: ResultStore, part: str) -> None:
    """Record that a part has ended."""
    results.write(f"parts/ended/{part}", b"\n")


def begun_or_expected_parts(results: ResultStore) -> set[str]:
    """Return the names of the parts that have begun or are expected."""
    return {Path(name).name for name in results.names("parts/begun")}


def unfinished_parts(results: ResultStore) -> list[str]:
    """Return the names of the parts that have begun or are expected, but have not ended."""
    return sorted(begun_or_expected_parts(results) - {Path(name).name for name in results.names("parts/ended")})
