"""Writes the annotated logs of a run, batch by batch, while the batch's tables are still there."""

from __future__ import annotations

import os
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING, BinaryIO

from drivelint.annotate.evidence import danger_spaces, gather_evidence
from drivelint.annotate.road import Road
from drivelint.annotate.write import Annotation, write
from drivelint.report import summary
from drivelint.result.files import OutputError
from drivelint.result.model import Result

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    import duckdb
    import pyarrow as pa

    from drivelint.annotate.evidence import Evidence
    from drivelint.engine.batch import Drive
    from drivelint.road.map_reader import MapTables

LAYOUT_FILE = "viewer-layout.json"
"""Panels and topics as Foxglove and Lichtblick import them: there, topics are hidden until somebody asks for them."""
_BUFFER = 1 << 20


class Annotator:
    """Writes `<folder>/<drive_id>.mcap` for every drive, and a layout for the viewer.

    `rules` is the run's rule table, `fail_on` and `strict` its options.
    """

    def __init__(self, folder: Path, rules: pa.Table, *, fail_on: str, strict: bool) -> None:
        self._folder = folder
        self._rules = rules
        names = rules["rule_id"].to_pylist()
        self._versions = dict(zip(names, rules["rule_version"].to_pylist(), strict=True))
        self._sense_by_rule = dict(zip(names, rules["sense"].to_pylist(), strict=True))
        self._fail_on = fail_on
        self._strict = strict
        self._roads: dict[str, Road] = {}
        self._rooms: list[tuple[pa.Table, pa.Table]] = []

    def __call__(self, con: duckdb.DuckDBPyConnection, drives: Sequence[Drive], *, first: bool, last: bool) -> None:
        """Annotate a batch that was just judged in `con`, once the last of its parts was.

        Errors: `TraceError` for a log that cannot be copied; `OutputError` when the folder cannot be written.
        """
        ids = [drive.trace.drive_id for drive in drives]
        if first:
            self._rooms.clear()
        self._rooms.append(danger_spaces(con, ids))
        if not last:
            return
        found = gather_evidence(con, ids, self._rooms)
        self._rooms.clear()
        for drive in drives:
            name, road = drive.trace.drive_id, self._road(drive.environment)
            told = self._summary(found[name])
            said = Annotation(drive.trace, found[name], road, drive.geo, self._versions, self._sense_by_rule, told)
            with _whole(self._folder / f"{name}.mcap") as file:
                write(file, said)
        with _whole(self._folder / LAYOUT_FILE) as file:
            file.write((Path(__file__).parent / "layout.json").read_bytes())

    def _road(self, environment: MapTables | None) -> Road | None:
        """Return the road of a map; of several, only the last is kept."""
        if environment is None:
            return None
        if environment.environment_id not in self._roads:
            self._roads = {environment.environment_id: Road(environment)}
        return self._roads[environment.environment_id]

    def _summary(self, evidence: Evidence) -> bytes:
        """Return the summary of one drive, as if it had been checked alone."""
        tables = (evidence.verdicts, evidence.findings, evidence.drive, self._rules)
        return summary.render(Result(*tables, fail_on=self._fail_on, strict=self._strict))


@contextmanager
def _whole(path: Path) -> Iterator[BinaryIO]:
    """Open a file that appears under its name whole, or not at all. Errors: `OutputError`."""
    temporary = path.with_name(f".drivelint.{os.getpid()}.tmp")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with temporary.open("wb", buffering=_BUFFER) as file:
            yield file
            file.flush()
            os.fsync(file.fileno())
        temporary.replace(path)
    except OSError as error:
        raise OutputError(
            f"{path}: cannot write the annotated log: {error.strerror or error}; free the disk, choose another --out, "
            "or use --no-annotate"
        ) from error
    finally:
        with suppress(OSError):  # the folder itself may be what is wrong: the first error is the one to tell
            temporary.unlink(missing_ok=True)
