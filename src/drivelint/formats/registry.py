"""Every reader, found by what the file holds (magic bytes, columns), never by topic or extension."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

from drivelint.errors import TraceError, UsageError
from drivelint.formats.files import identify, is_canonical_folder, is_drive_folder

if TYPE_CHECKING:
    from pathlib import Path

    from drivelint.drive.trace import IngestOptions, Recording, Trace

HEAD_BYTES = 4096


@dataclass(frozen=True)
class Probe:
    """What is known of a trace before it is read: where it is and its first bytes (none for a folder)."""

    path: Path
    head: bytes
    options: IngestOptions


class Reader(Protocol):
    """One trace format."""

    def accepts(self, probe: Probe) -> bool:
        """Say whether this reader is the one for the trace."""
        ...

    def read(self, probe: Probe) -> Recording:
        """Read the trace. Errors: `TraceError` or `UsageError` with one clear line."""
        ...


class CanonicalReader:
    """A folder of canonical Parquet tables, or one Parquet file with the columns of `actor_state`."""

    def accepts(self, probe: Probe) -> bool:
        """Accept a folder, or Parquet with canonical columns unless a mapping was asked for."""
        from drivelint.formats.tables import canonical

        if probe.path.is_dir():
            return is_canonical_folder(probe.path)
        return probe.options.mapping is None and probe.head.startswith(b"PAR1") and canonical.has_columns(probe.path)

    def read(self, probe: Probe) -> Recording:
        """Read the canonical tables."""
        from drivelint.formats.tables import canonical

        return canonical.read(probe.path)


class McapReader:
    """MCAP, a file or a folder of rosbag2: ASAM OSI ground truth, ROS 2 messages or Foxglove scenes."""

    def accepts(self, probe: Probe) -> bool:
        """Accept by the container's magic bytes, or the folder's description."""
        return probe.head.startswith(b"\x89MCAP") or (probe.path.is_dir() and not is_canonical_folder(probe.path))

    def read(self, probe: Probe) -> Recording:
        """Read what the log holds, OSI before the others."""
        from drivelint.formats.mcap import bag
        from drivelint.formats.osi import reader as osi

        family = bag.family(probe.path)
        if family == "ros2":
            from drivelint.formats.ros2 import reader as ros

            return ros.read(probe.path, probe.options)
        if family == "foxglove":
            from drivelint.formats.foxglove import scene as foxglove_scene

            return foxglove_scene.read(probe.path, probe.options.topic)
        if probe.path.is_dir():
            raise TraceError(
                f"{probe.path}: a bag without ROS 2 or Foxglove messages that are read: give one of its files"
            )
        return osi.read(probe.path, probe.options.topic)


class OsiFileReader:
    """ASAM OSI trace file: length-prefixed ground truth or sensor views."""

    def accepts(self, probe: Probe) -> bool:
        """Accept by the first length and the message behind it."""
        from drivelint.formats.osi import file as osi_file

        return not probe.path.is_dir() and osi_file.looks_like(probe.head, probe.path.stat().st_size)

    def read(self, probe: Probe) -> Recording:
        """Read the messages."""
        from drivelint.formats.osi import file as osi_file

        return osi_file.read(probe.path)


class CommonRoadReader:
    """A CommonRoad scenario."""

    def accepts(self, probe: Probe) -> bool:
        """Accept by its root element."""
        from drivelint.formats.commonroad import scenario as commonroad

        return commonroad.looks_like(probe.head)

    def read(self, probe: Probe) -> Recording:
        """Read obstacles and map."""
        from drivelint.formats.commonroad import scenario as commonroad

        return commonroad.read(probe.path)


class SumoReader:
    """SUMO floating car data."""

    def accepts(self, probe: Probe) -> bool:
        """Accept by its element or its columns."""
        from drivelint.formats.sumo import fcd as sumo

        return not probe.path.is_dir() and sumo.looks_like(probe.path, probe.head)

    def read(self, probe: Probe) -> Recording:
        """Read the log; its mapping is the file with the vehicle types."""
        from drivelint.formats.sumo import fcd as sumo

        return sumo.read(probe.path, probe.options.mapping)


class FilmReader:
    """What was detected in the frames of a film, as a table or as boxes in MCAP, through a mapping of that kind."""

    def accepts(self, probe: Probe) -> bool:
        """Accept by the mapping; a table without one by the columns of a shipped one."""
        from drivelint.formats.film import mapping as video_mapping
        from drivelint.formats.film import reader as video

        if probe.path.is_dir():
            return False
        if probe.options.mapping is not None:
            return video_mapping.is_film(probe.options.mapping)
        return probe.head[:16].lstrip(b"\xef\xbb\xbf").startswith(b"frame") and video.fits(probe.path) is not None

    def read(self, probe: Probe) -> Recording:
        """Read the detections."""
        from drivelint.formats.film import reader as video

        return video.read(probe.path, probe.options.mapping or video.fits(probe.path) or "")


class TableReader:
    """Any CSV or Parquet table through a mapping."""

    def accepts(self, probe: Probe) -> bool:
        """Accept Parquet, and whatever reads as text without markup."""
        head = probe.head
        return head.startswith(b"PAR1") or not (b"\0" in head or head.lstrip()[:1] in {b"<", b"{"})

    def read(self, probe: Probe) -> Recording:
        """Read the table through the mapping named, or the only shipped one that fits."""
        from drivelint.formats.tables import tabular

        return tabular.read(probe.path, probe.options.mapping)


READERS: tuple[Reader, ...] = (
    FilmReader(),
    CanonicalReader(),
    McapReader(),
    OsiFileReader(),
    CommonRoadReader(),
    SumoReader(),
    TableReader(),
)


def read_trace(path: Path, options: IngestOptions) -> Trace:
    """Read one drive into the tables of `schemas/model.sql`, checked, with its egos chosen.

    Errors: `TraceError` for a log that is missing, unreadable or has nothing to judge; `UsageError` for a bad mapping.
    """
    if options.sensor_range_m is not None and not options.sensor_range_m > 0.0:
        raise UsageError(f"--sensor-range {options.sensor_range_m}: the range must be more than 0 m")
    probe = _probe(path, options)
    identity = identify(path)
    for reader in READERS:
        if reader.accepts(probe):
            recording = reader.read(probe)
            if options.mapping is not None and not isinstance(reader, TableReader | SumoReader | FilmReader):
                recording.notes.append(f"mapping {options.mapping!r} is not needed: the log is {recording.format}")
            from drivelint.drive.finish import finish

            return finish(path, identity, recording, options)
    if b"<OpenDRIVE" in probe.head:
        raise TraceError(f"{path}: this is a map, not a log: give it with --map, beside a log")
    raise TraceError(
        f"{path}: no reader for this file, which begins with {probe.head[:16]!r}: give MCAP, OSI, Parquet, CSV, "
        "SUMO's floating car data or a CommonRoad scenario"
    )


def _probe(path: Path, options: IngestOptions) -> Probe:
    if path.is_dir():
        if not is_drive_folder(path):
            raise TraceError(
                f"{path}: a folder without actor_state.parquet is not a drive (nor has it a bag's metadata.yaml): name the files in it"
            )
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
    from drivelint.formats.osi import file as osi_file

    suffix = path.suffix.lower()
    if suffix == ".osi" and not osi_file.looks_like(head, path.stat().st_size):
        raise TraceError(
            f"{path}: not an OSI trace: it should begin with a message's length and the message, and begins {head[:32]!r} at "
            "byte 0: copy it again"
        )
    magic = {".mcap": b"\x89MCAP", ".parquet": b"PAR1"}.get(suffix)
    if magic is not None and not head.startswith(magic):
        raise TraceError(
            f"{path}: not {suffix[1:]}: it should begin {magic!r} and begins {head[:32]!r} at byte 0: copy it again"
        )
    return Probe(path, head, options)
