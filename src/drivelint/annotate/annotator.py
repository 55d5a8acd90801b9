"""Writes the annotated logs of a run, batch by batch, while the batch's tables still exist."""

from __future__ import annotations

import errno
import os
from contextlib import contextmanager, suppress
from typing import TYPE_CHECKING, BinaryIO

import pyarrow as pa
import pyarrow.compute as pc

from drivelint.annotate.layout import layout_json
from drivelint.annotate.measures import margin_series
from drivelint.annotate.road import Road
from drivelint.annotate.write import DriveToAnnotate, write_log
from drivelint.engine.barrier import refusal_of
from drivelint.engine.batch import have_many_states
from drivelint.errors import ChangedLogError, DriveLintError
from drivelint.result import collect
from drivelint.result.model import Result
from drivelint.result.publishing import OutputError
from drivelint.sql.statements import statement

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence
    from pathlib import Path

    import duckdb

    from drivelint.annotate.measures import MarginSeries
    from drivelint.engine.batch import Drive
    from drivelint.road.map_reader import MapTables

LAYOUT_FILE = "viewer-layout.json"
"""Panels and topics for import into Foxglove and Lichtblick, where topics are hidden until a user shows them."""
_BUFFER_BYTES = 1 << 20
_PART_QUERIES = ("evidence/overtake_space", "evidence/chain_point", "evidence/first_ego_measures")
"""Queries on tables of one part of a batch: danger spaces in overtakes, the lane chains of these spaces, measures of the ego."""


class Annotator:
    """Writes `<folder>/<drive_id>.mcap` for every drive, and a layout for the viewer.

    `rules` is the run's rule table, `fail_on`, `strict` and `required` are as those of its result. A drive that cannot be
    annotated keeps its verdicts: `note` is called with the drive and the reason. `release_memory` frees unused memory of the database.
    """

    def __init__(
        self,
        folder: Path,
        rules: pa.Table,
        *,
        fail_on: str,
        strict: bool,
        required: tuple[str, ...] = (),
        note: Callable[[str], None],
        release_memory: Callable[[], None],
    ) -> None:
        self._folder = folder
        self._rules = rules
        self._fail_on = fail_on
        self._strict = strict
        self._required = required
        self._note = note
        self._release_memory = release_memory
        self._roads: dict[str, Road] = {}
        self._parts: list[list[pa.Table]] = []
        self._series: set[MarginSeries] = set()

    def __call__(self, con: duckdb.DuckDBPyConnection, drives: Sequence[Drive], *, first: bool, last: bool) -> None:
        """Annotate the drives of a judged batch. If it is judged in parts, collect data, and annotate after the last part.

        Errors: `OutputError` if the folder cannot be written; other problems of a drive are reported.
        """
        ids = [drive.trace.drive_id for drive in drives]
        if first:
            self._parts.clear()
        self._parts.append([con.execute(sql, {"ids": ids}).to_arrow_table() for sql in map(statement, _PART_QUERIES)])
        if not last:
            return
        tables = [collect.verdicts(con, ids), collect.findings(con, ids), collect.drives(con, ids)]
        tables += [pa.concat_tables(parts) for parts in zip(*self._parts, strict=True)]
        tables.append(con.execute(statement("evidence/least_margin"), {"ids": ids}).to_arrow_table())
        self._series |= margin_series(tables[-1], self._rules.to_pylist())
        self._parts.clear()
        if have_many_states(drives):
            self._release_memory()
        for drive in drives:
            name = drive.trace.drive_id
            drive_tables = (rows.filter(pc.equal(rows["drive_id"], name)) for rows in tables)
            verdicts, findings, row, spaces, chains, measures, margins = drive_tables
            alone = Result(
                verdicts,
                findings,
                row,
                self._rules,
                fail_on=self._fail_on,
                strict=self._strict,
                required=self._required,
            )
            try:
                road = self._cached_road(drive.environment)
                with _open_for_atomic_write(self._folder / f"{name}.mcap") as file:
                    write_log(
                        file, DriveToAnnotate(drive.trace, alone, spaces, chains, measures, margins, road, drive.geo)
                    )
            except (ChangedLogError, OutputError):
                raise  # the log has changed after the verdicts, or no log can be written at all
            except Exception as error:  # noqa: BLE001 - the verdicts are kept, even if their annotation fails
                self._note(f"not annotated: {refusal_of(drive.trace.path, error).error}")
        with _open_for_atomic_write(self._folder / LAYOUT_FILE) as file:
            file.write(layout_json(self._series))

    def _cached_road(self, environment: MapTables | None) -> Road | None:
        """Return the road of a map; only the road of the last map is cached."""
        if environment is None:
            return None
        if environment.environment_id not in self._roads:
            self._roads = {environment.environment_id: Road(environment)}
        return self._roads[environment.environment_id]


@contextmanager
def _open_for_atomic_write(path: Path) -> Iterator[BinaryIO]:
    """Open a file for writing, which gets its name only when it is complete. Errors: `OutputError`."""
    temporary = path.with_name(f".drivelint.{os.getpid()}.tmp")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with temporary.open("wb", buffering=_BUFFER_BYTES) as file:
            yield file
            file.flush()
            os.fsync(file.fileno())
        temporary.replace(path)
    except OSError as error:
        if error.errno == errno.ENAMETOOLONG:
            raise DriveLintError(f"{path.name}: the name is too long for a file: give the log a shorter one") from error
        raise OutputError(
            f"{path}: cannot write the annotated log: {error.strerror or error}; free the disk, choose another --out, "
            "or use --no-annotate"
        ) from error
    finally:
        with suppress(OSError):  # the folder itself may be the problem: the first error is reported
            temporary.unlink(missing_ok=True)
