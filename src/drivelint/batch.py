"""Drives in batches: read ahead, with the map each is judged on, cut by their number of states."""

from __future__ import annotations

from collections import deque
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from hashlib import sha256
from typing import TYPE_CHECKING, Final

from drivelint.errors import DriveLintError
from drivelint.ingest import IngestOptions, Trace, read_trace

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence
    from concurrent.futures import Future
    from pathlib import Path

    from drivelint.maps import Environment
    from drivelint.maps.library import MapLibrary

STATES: Final = 400_000  # a batch costs little more than its longest drive, and its tables still fit in a GiB
AHEAD: Final = 4


@dataclass(frozen=True)
class Drive:
    """One log that was read, and its map (None: none was given)."""

    trace: Trace
    environment: Environment | None

    @property
    def n_states(self) -> int:
        """Rows of `actor_state`."""
        return int(self.trace.tables["actor_state"].num_rows)


@dataclass(frozen=True)
class Refused:
    """One log that cannot be judged, and why."""

    path: Path
    error: DriveLintError


def in_order(paths: Sequence[Path]) -> list[Path]:
    """Return the logs in an order that does not depend on how they were named or where they lie: by stem, then by content."""
    stems: dict[str, int] = {}
    for path in paths:
        stems[path.stem] = stems.get(path.stem, 0) + 1
    return sorted(paths, key=lambda p: (p.stem, _digest(p) if stems[p.stem] > 1 else "", str(p)))


def read(paths: Sequence[Path], options: IngestOptions, library: MapLibrary) -> Iterator[Drive | Refused]:
    """Yield every log in the order of `paths`; a few are read ahead while others are judged."""
    with ThreadPoolExecutor(max_workers=2) as pool:
        waiting: deque[tuple[Path, Future[Trace]]] = deque()
        todo = iter(paths)
        try:
            while True:
                while len(waiting) < AHEAD and (path := next(todo, None)) is not None:
                    waiting.append((path, pool.submit(read_trace, path, options)))
                if not waiting:
                    return
                path, future = waiting.popleft()
                yield _drive(path, future, library)
        finally:
            for _, future in waiting:
                future.cancel()


def cut(drives: Iterable[Drive | Refused]) -> Iterator[list[Drive | Refused]]:
    """Cut into batches of at most `STATES` states, a longer drive being a batch of its own."""
    batch: list[Drive | Refused] = []
    states = 0
    for drive in drives:
        n = drive.n_states if isinstance(drive, Drive) else 0
        if batch and states + n > STATES:
            yield batch
            batch, states = [], 0
        batch.append(drive)
        states += n
    if batch:
        yield batch


def _drive(path: Path, future: Future[Trace], library: MapLibrary) -> Drive | Refused:
    try:
        trace = future.result()
        return Drive(trace, library.find(path, trace.embedded_map, trace.map_offset, trace.tables["actor_state"]))
    except DriveLintError as error:
        return Refused(path, error)


def _digest(path: Path) -> str:
    if path.is_dir():
        return "".join(_digest(child) for child in sorted(path.iterdir()) if child.is_file())
    with path.open("rb") as file:
        digest = sha256()
        while block := file.read(1 << 20):
            digest.update(block)
    return digest.hexdigest()
