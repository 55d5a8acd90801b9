"""Reads drives with their maps ahead of judging, groups them into batches, and splits a drive of many egos into parts."""

from __future__ import annotations

from collections import Counter, deque
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import cached_property
from hashlib import file_digest
from typing import TYPE_CHECKING, Final
from weakref import WeakSet

import numpy as np
import pyarrow.compute as pc

from drivelint.drive.finish import with_quality_finding
from drivelint.drive.trace import IngestOptions, QualityFinding, Trace
from drivelint.engine.barrier import RefusedLog, refusal_of
from drivelint.engine.earth import frame_and_reference_problem
from drivelint.errors import MapError
from drivelint.formats import read_trace

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence
    from concurrent.futures import Future
    from pathlib import Path

    from drivelint.engine.map_library import MapLibrary
    from drivelint.road.geo_reference import GeoFrame
    from drivelint.road.map_reader import MapTables

MAX_BATCH_STATES: Final = (
    400_000  # the tables of such a batch fit into 1 GiB, and larger batches would save little time
)
LARGE_BATCH_STATES: Final = 1_000_000
"""With more states than this, the drives themselves need much memory: the database releases its memory between stages."""
MOST_STATES_ON_ONE_CORE: Final = 100_000
"""Up to this number of states, several cores do not make a statement faster, but cost a fifth more CPU time."""
EGO_ACTOR_PAIRS_PER_PART: Final = 1_500_000
"""The most pairs (an ego's step and an actor present then) in a part of a drive, which is the row count of the largest tables."""
LOGS_READ_AHEAD: Final = 4
FIRST_BATCH_DRIVES: Final = 16
FIRST_BATCH_STATES: Final = 100_000
"""The most states of a run's first batch, so that there are results soon."""
MOST_BATCH_GROWTH_FACTOR: Final = 6
"""A batch is at most this many times larger than all batches before it together."""


@dataclass(frozen=True)
class Drive:
    """One log that was read, its map (None: no map), and the frame that relates it to the earth (None: unknown)."""

    trace: Trace
    environment: MapTables | None
    geo: GeoFrame | None = None

    @property
    def n_states(self) -> int:
        """The number of rows of `actor_state`."""
        return int(self.trace.tables["actor_state"].num_rows)

    @cached_property
    def pairs_by_ego(self) -> dict[str, int]:
        """Ego id -> the sum, over its steps, of the actors present at the step. Sorted; empty if there are not several egos."""
        actors, states = self.trace.tables["actor"], self.trace.tables["actor_state"]
        egos = set(actors.filter(actors["is_ego"])["actor_id"].to_pylist())
        if len(egos) < 2:
            return {}
        coded = pc.dictionary_encode(states["actor_id"].combine_chunks())
        names, code, t_ns = coded.dictionary.to_pylist(), coded.indices.to_numpy(), states["t_ns"].to_numpy()
        order = np.lexsort((t_ns, code))
        code, t_ns = code[order], t_ns[order]
        ends = np.r_[np.flatnonzero(np.diff(code)), len(code) - 1]
        starts = np.r_[0, ends[:-1] + 1]
        first, last = np.sort(t_ns[starts]), np.sort(t_ns[ends])
        n_pairs = {}
        for name, start, end in zip(names, starts, ends, strict=True):
            if name in egos:
                steps = t_ns[start : end + 1]
                there = np.searchsorted(first, steps, side="right") - np.searchsorted(last, steps, side="left")
                n_pairs[name] = int(there.sum())
        return dict(sorted(n_pairs.items()))

    @property
    def size_in_states_or_pairs(self) -> int:
        """The drive's size for batching: its states, or its pairs of ego steps and actors."""
        return max(self.n_states, sum(self.pairs_by_ego.values()))


def sorted_logs(paths: Sequence[Path]) -> list[Path]:
    """Return the logs sorted by stem, then by content, so that the order does not depend on folders or the command line."""
    stems = Counter(path.stem for path in paths)
    return sorted(paths, key=lambda p: (p.stem, _sha256_of_log(p) if stems[p.stem] > 1 else "", str(p)))


def read_drives(paths: Sequence[Path], options: IngestOptions, library: MapLibrary) -> Iterator[Drive | RefusedLog]:
    """Yield the drive or the refusal of each log, in the order of `paths`; the next logs are read in threads meanwhile."""
    with ThreadPoolExecutor(max_workers=2) as pool:
        waiting: deque[tuple[Path, Future[Trace]]] = deque()
        todo = iter(paths)
        try:
            while True:
                while len(waiting) < LOGS_READ_AHEAD and (path := next(todo, None)) is not None:
                    waiting.append((path, pool.submit(read_trace, path, options)))
                    _pending_reads.add(waiting[-1][1])
                if not waiting:
                    return
                path, future = waiting.popleft()
                yield _drive_when_read(path, future, library)
        finally:
            for _, future in waiting:
                future.cancel()


_pending_reads: WeakSet[Future[Trace]] = WeakSet()


def are_logs_being_read() -> bool:
    """Return whether logs are being read in other threads."""
    return any(not future.done() for future in list(_pending_reads))


def _drive_when_read(path: Path, future: Future[Trace], library: MapLibrary) -> Drive | RefusedLog:
    try:
        return drive_with_map(future.result(), library)
    except BaseException as error:  # noqa: BLE001 - some libraries raise errors that are no `Exception`
        return refusal_of(path, error)


def cut_batches(drives: Iterable[Drive | RefusedLog]) -> Iterator[list[Drive | RefusedLog]]:
    """Yield batches of at most `MAX_BATCH_STATES` states or pairs; a longer drive is a batch of its own.

    The first batch is small, and the next ones grow, so that an interrupted run has some results. This costs a long run two or three more
    batches, each as much as about twenty short drives.
    """
    batch: list[Drive | RefusedLog] = []
    states, most_drives, most_states = 0, FIRST_BATCH_DRIVES, FIRST_BATCH_STATES
    done_drives = done_states = 0
    for drive in drives:
        n = drive.size_in_states_or_pairs if isinstance(drive, Drive) else 0
        if batch and (states + n > min(MAX_BATCH_STATES, most_states) or len(batch) >= most_drives):
            yield batch
            done_drives, done_states = done_drives + len(batch), done_states + states
            most_drives, most_states = (
                max(most_drives, MOST_BATCH_GROWTH_FACTOR * done_drives),
                max(most_states, MOST_BATCH_GROWTH_FACTOR * done_states),
            )
            batch, states = [], 0
        batch.append(drive)
        states += n
    if batch:
        yield batch


def have_many_states(drives: Iterable[Drive]) -> bool:
    """Return whether the drives themselves need so much memory that the database gets less."""
    return sum(drive.n_states for drive in drives) > LARGE_BATCH_STATES


def have_few_states(drives: Iterable[Drive]) -> bool:
    """Return whether the drives have so few states that one core is best for a statement."""
    return sum(drive.n_states for drive in drives) <= MOST_STATES_ON_ONE_CORE


def egos_to_skip_by_part(drives: Sequence[Drive], pairs_per_part: int | None = None) -> list[list[str]]:
    """Return, for each part of a batch, the egos that are not judged in it; each part judges at least one ego.

    Only a batch of a single drive is split: its egos, sorted by id, into parts of at most `pairs_per_part` pairs (default:
    `EGO_ACTOR_PAIRS_PER_PART`). The results do not depend on the split.
    """
    pairs = drives[0].pairs_by_ego if len(drives) == 1 else {}
    parts: list[list[str]] = []
    left = 0
    for ego, n in pairs.items():
        if not parts or n > left:
            parts.append([])
            left = EGO_ACTOR_PAIRS_PER_PART if pairs_per_part is None else pairs_per_part
        parts[-1].append(ego)
        left -= n
    return [[ego for ego in pairs if ego not in part] for part in map(set, parts)] or [[]]


def drive_with_map(trace: Trace, library: MapLibrary) -> Drive:
    """Return the drive with its map, in the map's coordinates; if the log's own map is unusable, without a map and with a finding.

    Errors: `MapError` if the user's map cannot be read, or does not fit the drive's place or its side of the road.
    """
    try:
        environment, trace = library.find(trace)
        doubts = library.doubts_on_map(trace, environment)
    except MapError as error:
        if not library.uses_map_in_log(trace):
            raise
        unused = QualityFinding.unusable_map(f"the log's own map is not used: {error}")
        trace, environment, doubts = with_quality_finding(trace, unused), None, {}
    for check, doubt in doubts.items():
        trace = with_quality_finding(trace, QualityFinding(check, "warning", doubt))
    geo, trouble = frame_and_reference_problem(trace, environment)
    if trouble:
        trace = with_quality_finding(trace, QualityFinding("geo_reference_unusable", "info", trouble))
    return Drive(trace, environment, geo)


def _sha256_of_log(path: Path) -> str:
    """Return the SHA-256 of a log; '' if it cannot be read, which its reader will report."""
    try:
        if path.is_dir():
            return "".join(_sha256_of_log(child) for child in sorted(path.iterdir()) if child.is_file())
        if not path.is_file():
            return ""
        with path.open("rb") as file:
            return file_digest(file, "sha256").hexdigest()
    except OSError:
        return ""
