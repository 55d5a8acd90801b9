"""The readers of trace formats, in the order in which they are tried. A file's content shows its format; some suffixes must match it."""

from __future__ import annotations

import codecs
from importlib import import_module
from typing import TYPE_CHECKING, Final, cast

from drivelint.drive.trace import QualityFinding
from drivelint.errors import ChangedLogError, TraceError, UsageError
from drivelint.formats.files import file_names_sizes_and_change_times, identify
from drivelint.formats.folders import is_drive_folder
from drivelint.formats.limits import read_within_limits
from drivelint.formats.mcap.bag_folder import METADATA_FILE, is_bag
from drivelint.formats.osi.trace_file import may_be_osi_trace
from drivelint.formats.probe import HEAD_BYTES, Probe, Reader, wrapping_and_remedy
from drivelint.formats.search import why_link_not_followed, why_unreadable
from drivelint.formats.tables.mapping import refuse_unknown_mapping

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from drivelint.drive.trace import IngestOptions, Trace

READER_MODULES: Final = (
    "film.reader",
    "tables.canonical",
    "d123.reader",
    "ros2.mapped_reader",
    "mcap.trace",
    "osi.reader",
    "scenarionet.reader",
    "commonroad.scenario",
    "sumo.fcd",
    "argoverse2.sensor",
    "argoverse2.forecasting",
    "tables.mapped_table",  # last: it accepts any text without markup
)
"""The modules of the readers. The first that accepts a file reads it; the later ones are not imported."""
FIRST_BYTES_BY_SUFFIX: Final = {
    ".mcap": b"\x89MCAP",
    ".db3": b"SQLite format 3\0",
    ".parquet": b"PAR1",
    ".pkl": b"\x80",
}
"""Suffix -> the first bytes that a file with this suffix must have, after any byte order mark. Other files are refused as damaged."""
UNPROTECTED_FINDING: Final = QualityFinding(
    "unprotected", "info", "checksums do not cover the whole log: damage may remain undetected"
)
"""The finding of every log that is not MCAP. The MCAP reader adds its own finding, for chunks without a CRC."""


def readers() -> Iterator[Reader]:
    """Yield the readers in the order in which they are tried; each is imported only when it is reached."""
    for name in READER_MODULES:
        yield cast("Reader", import_module(f"drivelint.formats.{name}"))


def format_title_and_ego(name: str) -> tuple[str, str] | None:
    """Return a format's title, and how its ego is determined. `name`: its name in `data_log.format`. None for the name of a mapping."""
    return next((reader.formats[name] for reader in readers() if name in reader.formats), None)


def read_trace(path: Path, options: IngestOptions) -> Trace:
    """Read one drive into the tables of `schemas/model.sql`, checked, with its egos chosen.

    Errors: `TraceError` for a log that is missing, unreadable or has nothing to judge; `UsageError` for a bad mapping.
    """
    if options.sensor_range_m is not None and not options.sensor_range_m > 0.0:
        raise UsageError(f"--sensor-range {options.sensor_range_m}: the range must be more than 0 m")
    probe = _probe(path, options)
    before = file_names_sizes_and_change_times(path)
    n_bytes = sum(size for _, size, _ in before)
    return read_within_limits(lambda: _read_unchanged_log(probe, before), str(path), n_bytes, TraceError)


def _read_unchanged_log(probe: Probe, before: list[tuple[str, int, int]]) -> Trace:
    """Read a log. Errors: as `read_trace`, and `ChangedLogError` if the states of its files differ from `before`."""
    path, options = probe.path, probe.options
    identity = identify(path)
    if reader := next((candidate for candidate in readers() if candidate.accepts(probe)), None):
        recording = reader.read(probe)
        if file_names_sizes_and_change_times(path) != before:  # the hash may be that of other content
            raise ChangedLogError(f"{path}: the log changed while it was read: check it again when it is complete")
        if "osi-mcap" not in reader.formats and not probe.head.startswith(FIRST_BYTES_BY_SUFFIX[".mcap"]):
            recording.findings.append(UNPROTECTED_FINDING)
        if options.mapping is not None and not reader.takes_mapping:
            refuse_unknown_mapping(options.mapping)
            recording.notes.append(
                f"mapping {options.mapping!r} is not used: the log has the format {recording.format}"
            )
        from drivelint.drive.finish import finish_trace

        return finish_trace(path, identity, recording, options)
    if b"<OpenDRIVE" in probe.head:
        raise TraceError(f"{path}: this is a map, not a log: use it with --map, together with a log")
    if probe.head.startswith(b"ARROW1"):
        raise TraceError(
            f"{path}: an Arrow table is read only as part of a log of Argoverse 2 or 123D: give the folder of the log"
        )
    if probe.head.startswith(b"#ROSBAG V"):
        from drivelint.formats.mcap.bag import conversion_command

        raise TraceError(f"{path}: a ROS 1 bag: convert it with {conversion_command(path)}, and give that")
    raise TraceError(
        f"{path}: no reader for this file, which begins with {probe.head[:16]!r}: give MCAP, a bag of ROS 2, OSI, Parquet, CSV, "
        "SUMO's floating car data, a CommonRoad scenario, a ScenarioNet pickle, or the folder of a log of Argoverse 2 or 123D"
    )


def may_be_mapped_table(path: Path, options: IngestOptions) -> bool:
    """Return whether a file is left to the last reader, that of tables with a mapping. False if the file cannot be probed."""
    try:
        probe = _probe(path, options)
    except TraceError:
        return False
    return not any(reader.accepts(probe) for reader in list(readers())[:-1])


def _probe(path: Path, options: IngestOptions) -> Probe:
    if (why := why_unreadable(path)) is not None:
        raise TraceError(f"{path}: {why}")
    if path.is_dir():
        if not is_drive_folder(path):
            why = why_link_not_followed(path) or (
                "not a folder of one drive: it has no actor_state.parquet, no metadata.yaml of a bag, and no log "
                "of Argoverse 2 or 123D: give the files in it"
            )
            raise TraceError(f"{path}: {why}")
        return Probe(path, b"", options)
    try:
        with path.open("rb") as file:
            head = file.read(HEAD_BYTES)
    except FileNotFoundError:
        raise TraceError(f"{path}: no such file or folder: check the path") from None
    except OSError as error:
        raise TraceError(f"{path}: cannot be read: {error.strerror or error}") from error
    if not head:
        raise TraceError(f"{path}: the file is empty (0 bytes): record or copy it again")
    if path.name == METADATA_FILE and is_bag(path.parent):
        raise TraceError(f"{path}: it describes a bag: give the bag's folder, {path.parent}")
    if (remedy := wrapping_and_remedy(head)) is not None:
        raise TraceError(f"{path}: {remedy}")
    suffix = path.suffix.lower()
    if suffix == ".osi" and not may_be_osi_trace(head, path.stat().st_size):
        raise TraceError(
            f"{path}: not an OSI trace: it should begin with a message's length and the message, and begins {head[:8]!r} at "
            "byte 0: copy it again"
        )
    magic = FIRST_BYTES_BY_SUFFIX.get(suffix)
    if magic is not None and not head.removeprefix(codecs.BOM_UTF8).startswith(magic):
        raise TraceError(
            f"{path}: not {suffix[1:]}: it should begin {magic!r} and begins {head[:8]!r} at byte 0: copy it again"
        )
    return Probe(path, head, options)
